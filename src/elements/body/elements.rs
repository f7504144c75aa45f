//! The finite elements of a body: all cells of one kind with their quadrature points.
//!
//! With natural-shape gradients g_a, weights w and H = sum u_a g_a^T, every force of the elements is one
//! loop over these points: -sum w P g_a, with the first Piola stress P that the material's law gives for
//! H (and its rate, if the law is viscous). Tangents are loops over the derivatives of P, likewise.
//!
//! Inertia, forces, tangents and fields of the elements are modules of their own.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::f64::consts::TAU;
use std::sync::Arc;

use pulp::Simd;

use super::contiguous::ContiguousCells;
use super::dilatation::Dilatation;
use super::offset::Offset;
use super::partition::Partition;
use super::projection::{linear_modes, modes_side_by_side};
use super::revolved::Revolved;
use super::section::Section;
use crate::base::input::InputError;
use crate::base::lane::{Lane, Packed, SIDE_BY_SIDE};
use crate::base::sparse::NodePattern;
use crate::base::tensor::{Matrix, Real};
use crate::elements::basis::{
    MassPoint, ReferenceCell, StrainPoint, extrapolation, mass_points, strain_points,
};
use crate::elements::mesh::Mesh;

/// Elements of `N` nodes, dimension `M` and `Q` strain points in a space of dimension `D`.
pub(super) struct ElementsOf<const N: usize, const M: usize, const D: usize, const Q: usize> {
    pub(super) nodes: Vec<[usize; N]>,
    /// For each cell the entries of all pairs of its nodes in the pattern of the body, to which tangents are
    /// added.
    pub(super) entries: Vec<[[u32; N]; N]>,
    /// Strain points of [`SIDE_BY_SIDE`] cells each, those of the same cells one after the other; volumes
    /// times section. Cells that are missing at the end repeat the last one.
    pub(super) points: Arc<Vec<StrainPoint<Packed, N, M, D>>>,
    /// Shape functions at the strain points of a cell.
    pub(super) values: [[f64; N]; Q],
    /// The weights by which values at the strain points of a cell are extrapolated to its nodes.
    pub(super) extrapolation: [[f64; Q]; N],
    /// For each cell, sum w N_a N_b (m^3).
    pub(super) products: Arc<Vec<[[f64; N]; N]>>,
    pub(super) quadratic: bool,
    /// Treatment of volumetric strain.
    pub(super) dilatation: Dilatation,
    /// The linear modes of a projected dilatation at the strain points, stored as these are; empty if it has none.
    pub(super) modes: Arc<Vec<[Packed; M]>>,
    pub(super) shares: Partition,
    pub(super) rows: ContiguousCells<N>,
    /// Numbers of the cells of a sample among those of the whole body; empty where they are all.
    pub(super) numbers: Vec<usize>,
    /// The same cells turned about the axis, in a body of revolution, whose forces and fields are theirs.
    pub(super) revolved: Option<Arc<Revolved>>,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Whether a projected dilatation differs from that of the points; where it does not, no loops are compiled
    /// for it.
    pub(super) const CAN_LOCK: bool = M == D && M > 1 && Q > 1;
    /// Whether it may be linear in a cell: with more points than a linear cell has. Elsewhere no loops are compiled for that.
    const CAN_BE_LINEAR: bool = Self::CAN_LOCK && Q > 1 << M;

    /// The elements on the cells of `mesh`, whose nodes `pattern` couples; `section` is the area or thickness
    /// of the body.
    pub(super) fn new<C: ReferenceCell<N, M>>(
        mesh: &Mesh,
        section: Section,
        dilatation: Dilatation,
        pattern: &NodePattern,
    ) -> Result<Self, InputError> {
        const { assert!(C::STIFFNESS_RULE.len() == Q) };
        let positions = mesh.positions().as_chunks::<D>().0;
        let values: [[f64; N]; Q] = std::array::from_fn(|q| C::values(C::STIFFNESS_RULE[q].0));
        let (mut nodes, mut points, mut products) = (Vec::new(), Vec::new(), Vec::new());
        let mut modes = Vec::new();
        let mut entries = Vec::with_capacity(mesh.cell_count());
        let mut flawed = Vec::new();
        let mut circles = Vec::new();
        for (number, cell) in mesh.cells().enumerate() {
            let natural: [[f64; D]; N] = std::array::from_fn(|a| positions[cell[a]]);
            let Some(of_cell) = strain_points::<C, N, M, D>(&natural) else {
                flawed.push(number);
                continue;
            };
            let place = |values: &[f64; N], k: usize| {
                (0..N).map(|a| values[a] * natural[a][k]).sum::<f64>()
            };
            let around: [f64; Q] = std::array::from_fn(|q| section.around(place(&values[q], 0)));
            if dilatation == Dilatation::Linear {
                modes.push(linear_modes::<M, Q>(&std::array::from_fn(|q| {
                    // such cells fill space
                    let position = std::array::from_fn(|k| place(&values[q], k));
                    (position, of_cell[q].volume * around[q])
                })));
            }
            points.extend(of_cell.into_iter().zip(around).map(|(point, around)| StrainPoint {
                volume: section.uniform() * point.volume * around,
                ..point
            }));
            circles.push(around);
            let mut product = [[0.0; N]; N];
            for MassPoint { values, volume } in mass_points::<C, N, M, D>(&natural) {
                let volume = section.uniform() * volume * section.around(place(&values, 0));
                for (a, b) in pairs::<N>() {
                    product[a][b] += volume * values[a] * values[b];
                }
            }
            products.push(product);
            let mut of_pairs = [[0; N]; N];
            for (a, b) in pairs::<N>() {
                let entry = pattern.find(cell[a], cell[b]).and_then(|entry| entry.try_into().ok());
                of_pairs[a][b] = entry.ok_or_else(|| too_many(pattern))?;
            }
            entries.push(of_pairs);
            nodes.push(std::array::from_fn(|a| cell[a]));
        }
        if !flawed.is_empty() {
            return Err(mesh.flawed_cells(&flawed));
        }
        let extrapolation = extrapolation::<C, N, M, Q>();
        let revolved = (section == Section::Turn).then(|| Revolved {
            of_cell: N,
            points: Q,
            nodes: nodes.as_flattened().to_vec(),
            entries: entries.as_flattened().as_flattened().to_vec(),
            shapes: points
                .iter()
                .zip(circles.as_flattened())
                .enumerate()
                .flat_map(|(k, (point, circle))| {
                    let hoops = values[k % Q].map(|value| TAU * value / circle);
                    point
                        .gradients
                        .iter()
                        .zip(hoops)
                        .map(|(g, hoop)| [g[0], g[M - 1], hoop])
                        .collect::<Vec<_>>()
                })
                .collect(),
            volumes: points.iter().map(|point| point.volume).collect(),
            circles: circles.as_flattened().to_vec(),
            is_projected: dilatation != Dilatation::AtPoints,
            modes: modes
                .as_flattened()
                .iter()
                .map(|of_point| [of_point[0], of_point[M - 1]])
                .collect(),
            extrapolation: extrapolation.as_flattened().to_vec(),
            numbers: Vec::new(),
        });
        let points = side_by_side::<N, M, D, Q>(&points);
        let modes = modes_side_by_side(&modes);
        let quadratic = mesh.kind().is_quadratic();
        let shares = Partition::new(&nodes, mesh.node_count());
        let rows = ContiguousCells::new(&nodes);
        Ok(Self {
            nodes,
            entries,
            points: points.into(),
            values,
            extrapolation,
            products: products.into(),
            quadratic,
            dilatation,
            modes: modes.into(),
            shares,
            rows,
            numbers: Vec::new(),
            revolved: revolved.map(Arc::new),
        })
    }

    /// Elements of one dimension on the nodes of some of these cells, with strain points of their own, on a
    /// mesh of `node_count` nodes.
    pub(super) fn with_points(
        &self,
        cells: &[usize],
        points: &[StrainPoint<f64, N, 1, D>],
        node_count: usize,
    ) -> ElementsOf<N, 1, D, Q> {
        let nodes: Vec<[usize; N]> = cells.iter().map(|&cell| self.nodes[cell]).collect();
        ElementsOf {
            entries: cells.iter().map(|&cell| self.entries[cell]).collect(),
            points: side_by_side::<N, 1, D, Q>(points).into(),
            values: self.values,
            extrapolation: self.extrapolation,
            products: cells.iter().map(|&cell| self.products[cell]).collect::<Vec<_>>().into(),
            quadratic: self.quadratic,
            dilatation: Dilatation::AtPoints,
            modes: Arc::default(),
            shares: Partition::new(&nodes, node_count),
            rows: ContiguousCells::new(&nodes),
            numbers: Vec::new(),
            revolved: None,
            nodes,
        }
    }

    /// The same elements on the nodes of several bodies, with entries in the pattern of all of them.
    pub(super) fn among_others(&self, offset: Offset) -> Self {
        let Offset { node, entry, count } = offset;
        let nodes: Vec<[usize; N]> =
            self.nodes.iter().map(|cell| cell.map(|own| node + own)).collect();
        let moved = |own: u32| (entry + own as usize) as u32;
        let entries = self.entries.iter().map(|cell| cell.map(|row| row.map(moved)));
        Self {
            entries: entries.collect(),
            points: self.points.clone(),
            values: self.values,
            extrapolation: self.extrapolation,
            products: self.products.clone(),
            quadratic: self.quadratic,
            dilatation: self.dilatation,
            modes: self.modes.clone(),
            shares: Partition::new(&nodes, count),
            rows: ContiguousCells::new(&nodes),
            numbers: self.numbers.clone(),
            revolved: self.revolved.as_ref().map(|own| Arc::new(own.among_others(offset))),
            nodes,
        }
    }

    /// The number of a cell in the whole body.
    pub(super) fn number(&self, cell: usize) -> usize {
        self.numbers.get(cell).copied().unwrap_or(cell)
    }

    /// The strain points, packed for blocks of [`SIDE_BY_SIDE`] cells.
    pub(super) fn abreast(&self) -> &[[StrainPoint<Packed, N, M, D>; Q]] {
        self.points.as_chunks::<Q>().0
    }

    /// The strain points of a cell.
    #[inline(always)]
    pub(super) fn points(&self, cell: usize) -> impl Iterator<Item = StrainPoint<f64, N, M, D>> {
        let lane = cell % SIDE_BY_SIDE;
        self.abreast()[cell / SIDE_BY_SIDE].iter().map(move |point| point.of_cell(lane))
    }

    /// Whether the dilatation is projected.
    #[inline(always)]
    pub(super) fn is_projected(&self) -> bool {
        self.dilatation != Dilatation::AtPoints
    }

    /// Number of coefficients of a projected dilatation.
    #[inline(always)]
    pub(super) fn coefficients(&self) -> usize {
        if self.is_linear() { 1 + M } else { 1 }
    }

    /// Whether a projected dilatation is linear in a cell.
    #[inline(always)]
    pub(super) fn is_linear(&self) -> bool {
        Self::CAN_BE_LINEAR && !self.modes.is_empty()
    }

    /// The linear modes at point `q` of as many cells of a `block` as a register holds; none if the dilatation is a
    /// mean.
    #[inline(always)]
    pub(super) fn modes_of_lane<S: Simd>(
        &self,
        simd: S,
        block: usize,
        part: usize,
        q: usize,
    ) -> Option<[Lane<S>; M]> {
        if !Self::CAN_BE_LINEAR {
            return None;
        }
        let packed = self.modes.get(block * Q + q)?;
        let mut modes = [Lane::splat(simd, 0.0); M];
        for k in 0..M {
            modes[k] = Lane::load(simd, &packed[k].0, part);
        }
        Some(modes)
    }

    /// The linear modes at point `q` of a cell.
    pub(super) fn modes_of(&self, cell: usize, q: usize) -> Option<[f64; M]> {
        let packed = self.modes.get(cell / SIDE_BY_SIDE * Q + q)?;
        Some(std::array::from_fn(|k| packed[k].0[cell % SIDE_BY_SIDE]))
    }
}

impl<const N: usize, const M: usize, const D: usize> StrainPoint<Packed, N, M, D> {
    /// The points of as many cells as a register holds: of the registers of these cells, number `part`.
    #[inline(always)]
    pub(super) fn lane<S: Simd>(&self, simd: S, part: usize) -> StrainPoint<Lane<S>, N, M, D> {
        let zero = Lane::splat(simd, 0.0);
        let (mut gradients, mut frame) = ([[zero; M]; N], [[zero; D]; M]);
        for j in 0..M {
            for a in 0..N {
                gradients[a][j] = Lane::load(simd, &self.gradients[a][j].0, part);
            }
            for i in 0..D {
                frame[j][i] = Lane::load(simd, &self.frame[j][i].0, part);
            }
        }
        StrainPoint { gradients, frame, volume: Lane::load(simd, &self.volume.0, part) }
    }

    /// The point of one of the cells.
    #[inline(always)]
    fn of_cell(&self, lane: usize) -> StrainPoint<f64, N, M, D> {
        let (mut gradients, mut frame) = ([[0.0; M]; N], [[0.0; D]; M]);
        for j in 0..M {
            (0..N).for_each(|a| gradients[a][j] = self.gradients[a][j].0[lane]);
            (0..D).for_each(|i| frame[j][i] = self.frame[j][i].0[lane]);
        }
        StrainPoint { gradients, frame, volume: self.volume.0[lane] }
    }
}

/// The points of cells, `Q` of each, in lanes.
pub(super) fn side_by_side<const N: usize, const M: usize, const D: usize, const Q: usize>(
    points: &[StrainPoint<f64, N, M, D>],
) -> Vec<StrainPoint<Packed, N, M, D>> {
    let cells = points.as_chunks::<Q>().0;
    let mut lanes = Vec::with_capacity(Q * cells.len().div_ceil(SIDE_BY_SIDE));
    for cells in cells.chunks(SIDE_BY_SIDE) {
        for q in 0..Q {
            let of_lane = |lane: usize| &cells[lane.min(cells.len() - 1)][q];
            let each = |number: &dyn Fn(&StrainPoint<f64, N, M, D>) -> f64| {
                Packed(std::array::from_fn(|lane| number(of_lane(lane))))
            };
            lanes.push(StrainPoint {
                gradients: std::array::from_fn(|a| {
                    std::array::from_fn(|j| each(&|point| point.gradients[a][j]))
                }),
                frame: std::array::from_fn(|j| {
                    std::array::from_fn(|i| each(&|point| point.frame[j][i]))
                }),
                volume: each(&|point| point.volume),
            });
        }
    }
    lanes
}

/// H = sum x_a g_a^T, with the vectors x of the nodes from number `first` on and the gradients g of their
/// shape functions. `first` is 1 if the vectors are relative to that of the first node.
#[inline(always)]
pub(super) fn gradient<T: Real, const N: usize, const M: usize, const D: usize>(
    first: usize,
    x: &[[T; D]; N],
    gradients: &[[T; M]; N],
) -> Matrix<T, D, M> {
    let mut h = [x[first]; M];
    for j in 0..M {
        for i in 0..D {
            h[j][i] = x[first][i] * gradients[first][j];
            for a in first + 1..N {
                h[j][i] += x[a][i] * gradients[a][j];
            }
        }
    }
    h
}

/// The same of several fields.
#[inline(always)]
pub(super) fn gradients<T: Real, const N: usize, const M: usize, const D: usize, const K: usize>(
    first: usize,
    x: &[[[T; D]; N]; K],
    gradients: &[[T; M]; N],
) -> [Matrix<T, D, M>; K] {
    let mut all = [[x[0][first]; M]; K];
    for k in 0..K {
        all[k] = gradient(first, &x[k], gradients);
    }
    all
}

/// All pairs of the nodes of a cell.
pub(super) fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..N).flat_map(|a| (0..N).map(move |b| (a, b)))
}

pub(super) fn too_many(pattern: &NodePattern) -> InputError {
    let help = "4,294,967,296 are the most: take a coarser mesh";
    InputError::new("number of pairs of nodes that share a cell", pattern.entries(), help)
}
