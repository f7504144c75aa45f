//! The cells of a body: one loop over quadrature points for every elastic and viscous force.
//!
//! With natural-shape gradients g_a, weights w and H = sum u_a g_a^T, F = F_0 + H (F_0 the frame of
//! the cell, the identity where it fills space):
//!
//! | | strain | nodal force |
//! | --- | --- | --- |
//! | Green | E = sym(F_0^T H) + H^T H / 2 | -sum w F S g_a, S = lambda tr(E) I + 2 mu E |
//! | objective viscosity | E' = sym(F^T H') | -sum w F S_vis g_a |
//!
//! Cauchy strain and natural viscosity are their linear parts, with constant matrices.

use nalgebra::{SMatrix, SVector};

use super::Inertia;
use super::fields::{CellField, Measure, PointField, mean};
use super::forces::Shared;
use super::regions::{Moduli, Regions};
use super::shares::Shares;
use super::strain::{energy_density, gradient, green_strain, stress, stretch_of, symmetric_part};
use crate::element::{
    Hexahedron, MassPoint, Quadrilateral, ReferenceCell, Segment, StrainPoint, Tetrahedron,
    Tetrahedron10, Triangle, Triangle6, mass_points, strain_points,
};
use crate::force::NodalForces;
use crate::input::InputError;
use crate::material::Lame;
use crate::mesh::{CellKind, Mesh};
use crate::ode::Failure;
use crate::sparse::{BlockMatrix, NodeMatrix, Rows};

/// Cells of one kind, behind a face that knows neither kind nor dimension.
pub(crate) trait Cells: Send + Sync {
    /// Adds the inertia of all cells, `sharing` telling how.
    fn add_inertia(&self, regions: &Regions, sharing: Inertia, inertia: &mut NodeMatrix);

    /// Adds sum w (lambda g_a g_b^T + mu ((g_a . g_b) I + g_b g_a^T)), `lame` telling the constants.
    fn add_stiffness(
        &self,
        regions: &Regions,
        lame: &dyn Fn(&Moduli) -> Lame,
        stiffness: &mut BlockMatrix,
    );

    /// Adds the forces of Green strain, if `law` has them, and of objective viscosity.
    fn add_forces(
        &self,
        regions: &Regions,
        law: Law,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure>;

    /// Adds -df/du and -df/dv of the same forces.
    fn add_tangents(
        &self,
        regions: &Regions,
        law: Law,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );

    /// Energy of Green strain (J).
    fn green_energy(&self, regions: &Regions, u: &[f64]) -> f64;

    /// Present over natural volume of each cell.
    fn volume_ratios(&self, u: &[f64]) -> Vec<f64>;

    /// Strain, stress and energy density of each cell.
    fn fields(&self, regions: &Regions, measure: Measure, u: &[f64]) -> Vec<CellField>;

    /// Natural volume of each cell (m^3).
    fn volumes(&self) -> Vec<f64>;
}

/// Which forces are evaluated cell by cell; the others have constant matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Law {
    pub(crate) green: bool,
    pub(crate) objective: bool,
}

/// The cells of `mesh`; `section` is the area or thickness of the body.
pub(super) fn cells(mesh: &Mesh, section: f64) -> Result<Box<dyn Cells>, InputError> {
    let of = match (mesh.kind(), mesh.dimension()) {
        (CellKind::Segment, 1) => CellsOf::<2, 1, 1, 1>::boxed::<Segment>,
        (CellKind::Segment, 2) => CellsOf::<2, 1, 2, 1>::boxed::<Segment>,
        (CellKind::Segment, _) => CellsOf::<2, 1, 3, 1>::boxed::<Segment>,
        (CellKind::Triangle, 2) => CellsOf::<3, 2, 2, 1>::boxed::<Triangle>,
        (CellKind::Triangle, _) => CellsOf::<3, 2, 3, 1>::boxed::<Triangle>,
        (CellKind::Triangle6, 2) => CellsOf::<6, 2, 2, 3>::boxed::<Triangle6>,
        (CellKind::Triangle6, _) => CellsOf::<6, 2, 3, 3>::boxed::<Triangle6>,
        (CellKind::Quadrilateral, 2) => CellsOf::<4, 2, 2, 4>::boxed::<Quadrilateral>,
        (CellKind::Quadrilateral, _) => CellsOf::<4, 2, 3, 4>::boxed::<Quadrilateral>,
        (CellKind::Tetrahedron, _) => CellsOf::<4, 3, 3, 1>::boxed::<Tetrahedron>,
        (CellKind::Tetrahedron10, _) => CellsOf::<10, 3, 3, 4>::boxed::<Tetrahedron10>,
        (CellKind::Hexahedron, _) => CellsOf::<8, 3, 3, 8>::boxed::<Hexahedron>,
    };
    of(mesh, section)
}

/// Cells of `N` nodes, dimension `M` and `Q` strain points in a space of dimension `D`.
struct CellsOf<const N: usize, const M: usize, const D: usize, const Q: usize> {
    nodes: Vec<[usize; N]>,
    /// Strain points, those of one cell after those of the other; volumes times section.
    points: Vec<StrainPoint<N, M, D>>,
    /// For each cell, sum w N_a N_b (m^3).
    products: Vec<[[f64; N]; N]>,
    quadratic: bool,
    shares: Shares,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> CellsOf<N, M, D, Q> {
    fn boxed<C: ReferenceCell<N, M>>(
        mesh: &Mesh,
        section: f64,
    ) -> Result<Box<dyn Cells>, InputError> {
        const { assert!(C::STIFFNESS_RULE.len() == Q) };
        let positions = mesh.positions().as_chunks::<D>().0;
        let (mut nodes, mut points, mut products) = (Vec::new(), Vec::new(), Vec::new());
        for (number, cell) in mesh.cells().enumerate() {
            let natural: [[f64; D]; N] = std::array::from_fn(|a| positions[cell[a]]);
            let of_cell = strain_points::<C, N, M, D>(&natural)
                .map_err(|volume| bad_cell(number, cell, volume))?;
            points.extend(
                of_cell
                    .into_iter()
                    .map(|point| StrainPoint { volume: section * point.volume, ..point }),
            );
            let mut product = [[0.0; N]; N];
            for MassPoint { values, volume } in mass_points::<C, N, M, D>(&natural) {
                for (a, b) in pairs::<N>() {
                    product[a][b] += section * volume * values[a] * values[b];
                }
            }
            products.push(product);
            nodes.push(std::array::from_fn(|a| cell[a]));
        }
        let quadratic = mesh.kind().is_quadratic();
        let shares = Shares::new(&nodes, mesh.node_count());
        Ok(Box::new(Self { nodes, points, products, quadratic, shares }))
    }

    /// Number, nodes and strain points of each cell.
    fn iter(&self) -> impl Iterator<Item = (usize, &[usize; N], &[StrainPoint<N, M, D>])> {
        let points = self.points.chunks_exact(Q);
        self.nodes.iter().zip(points).enumerate().map(|(k, (nodes, points))| (k, nodes, points))
    }

    /// Adds the block of each pair of nodes of a cell, as far as the matrix has these rows.
    fn scatter(
        nodes: &[usize; N],
        matrix: &mut Rows<'_>,
        block: impl Fn(usize, usize) -> SMatrix<f64, D, D>,
    ) {
        for (a, b) in pairs::<N>() {
            let Some(entries) = matrix.block_mut(nodes[a], nodes[b]) else { continue };
            let block = block(a, b);
            for i in 0..D {
                for j in 0..D {
                    entries[i * D + j] += block[(i, j)];
                }
            }
        }
    }

    /// Adds the tangents of some cells.
    fn add_tangents_of(
        &self,
        cells: impl Iterator<Item = usize>,
        regions: &Regions,
        law: Law,
        [u, v]: [&[f64]; 2],
        mut stiffness: Rows<'_>,
        mut damping: Rows<'_>,
    ) {
        let (u, v) = (u.as_chunks::<D>().0, v.as_chunks::<D>().0);
        for cell in cells {
            let (nodes, points) = (&self.nodes[cell], &self.points[cell * Q..][..Q]);
            let moduli = regions.of(cell);
            for point in points {
                let h = gradient(point, nodes, u);
                let f = point.frame + h;
                let spread = point.gradients.map(|g| f * g);
                let f_square = f * f.transpose();
                let stretch = |a: usize, b: usize| point.gradients[a].dot(&point.gradients[b]);
                if law.green {
                    let stress = stress(moduli.elastic, &green_strain(point, &h));
                    Self::scatter(nodes, &mut stiffness, |a, b| {
                        let (ga, gb) = (&point.gradients[a], &point.gradients[b]);
                        let geometric = SMatrix::identity() * ga.dot(&(stress * gb));
                        let (fa, fb) = (&spread[a], &spread[b]);
                        (material_block(moduli.elastic, fa, fb, stretch(a, b), &f_square)
                            + geometric)
                            * point.volume
                    });
                }
                if law.objective {
                    let rate_gradient = gradient(point, nodes, v);
                    let rate = symmetric_part(&f.tr_mul(&rate_gradient));
                    let stress = stress(moduli.viscous, &rate);
                    let moving = point.gradients.map(|g| rate_gradient * g);
                    let mixed_square = f * rate_gradient.transpose();
                    let Lame { lambda, mu } = moduli.viscous;
                    Self::scatter(nodes, &mut damping, |a, b| {
                        let (fa, fb) = (&spread[a], &spread[b]);
                        material_block(moduli.viscous, fa, fb, stretch(a, b), &f_square)
                            * point.volume
                    });
                    // the rate changes with F, too: not symmetric
                    Self::scatter(nodes, &mut stiffness, |a, b| {
                        let (ga, gb) = (&point.gradients[a], &point.gradients[b]);
                        let geometric = SMatrix::identity() * ga.dot(&(stress * gb));
                        let shear =
                            mixed_square * stretch(a, b) + spread[b] * moving[a].transpose();
                        let volumetric = spread[a] * moving[b].transpose();
                        (geometric + volumetric * lambda + shear * mu) * point.volume
                    });
                }
            }
        }
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Cells for CellsOf<N, M, D, Q> {
    fn add_inertia(&self, regions: &Regions, sharing: Inertia, inertia: &mut NodeMatrix) {
        for (cell, (nodes, products)) in self.nodes.iter().zip(&self.products).enumerate() {
            let density = regions.of(cell).density;
            let products = match sharing {
                Inertia::Consistent => *products,
                Inertia::Lumped => lumped(products, self.quadratic),
            };
            for (a, b) in pairs::<N>() {
                inertia.add(nodes[a], nodes[b], density * products[a][b]);
            }
        }
    }

    fn add_stiffness(
        &self,
        regions: &Regions,
        lame: &dyn Fn(&Moduli) -> Lame,
        stiffness: &mut BlockMatrix,
    ) {
        let mut stiffness = stiffness.rows_mut();
        for (cell, nodes, points) in self.iter() {
            let lame = lame(regions.of(cell));
            for point in points {
                let spread = point.gradients.map(|g| point.frame * g);
                let frame_square = point.frame * point.frame.transpose();
                Self::scatter(nodes, &mut stiffness, |a, b| {
                    let stretch = point.gradients[a].dot(&point.gradients[b]);
                    material_block(lame, &spread[a], &spread[b], stretch, &frame_square)
                        * point.volume
                });
            }
        }
    }

    fn add_forces(
        &self,
        regions: &Regions,
        law: Law,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let Self { nodes, points, shares, .. } = self;
        let cells = Shared { nodes, points: points.as_chunks::<Q>().0, shares };
        cells.add_forces(regions, law, u, v, forces)
    }

    fn add_tangents(
        &self,
        regions: &Regions,
        law: Law,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let add = |share: usize, stiffness: Rows<'_>, damping: Rows<'_>| {
            let cells = self.shares.cells[share].iter().cloned().flatten();
            self.add_tangents_of(cells, regions, law, [u, v], stiffness, damping);
        };
        self.shares.each(stiffness.rows_mut(), damping.rows_mut(), &add);
    }

    fn green_energy(&self, regions: &Regions, u: &[f64]) -> f64 {
        let u = u.as_chunks::<D>().0;
        let of_cell = |(cell, nodes, points): (usize, &[usize; N], &[StrainPoint<N, M, D>])| {
            let lame = regions.of(cell).elastic;
            let energy = |point: &StrainPoint<N, M, D>| {
                let strain = green_strain(point, &gradient(point, nodes, u));
                point.volume * energy_density(lame, &strain)
            };
            points.iter().map(energy).sum::<f64>()
        };
        self.iter().map(of_cell).sum()
    }

    fn volume_ratios(&self, u: &[f64]) -> Vec<f64> {
        let u = u.as_chunks::<D>().0;
        let of_cell = |(_, nodes, points): (usize, &[usize; N], &[StrainPoint<N, M, D>])| {
            let natural: f64 = points.iter().map(|point| point.volume).sum();
            let present = points.iter().map(|point| {
                let f = point.frame + gradient(point, nodes, u);
                point.volume * stretch_of(&f)
            });
            present.sum::<f64>() / natural
        };
        self.iter().map(of_cell).collect()
    }

    fn fields(&self, regions: &Regions, measure: Measure, u: &[f64]) -> Vec<CellField> {
        let u = u.as_chunks::<D>().0;
        let of_cell = |(cell, nodes, points): (usize, &[usize; N], &[StrainPoint<N, M, D>])| {
            let lame = regions.of(cell).elastic;
            mean(points.iter().map(|point| {
                let h = gradient(point, nodes, u);
                (point.volume, PointField::new(measure, lame, point, &h))
            }))
        };
        self.iter().map(of_cell).collect()
    }

    fn volumes(&self) -> Vec<f64> {
        let volume = |points: &[StrainPoint<N, M, D>]| points.iter().map(|p| p.volume).sum();
        self.points.chunks_exact(Q).map(volume).collect()
    }
}

/// The part of a tangent that the change of strain makes, per volume: with f_a = F g_a,
/// lambda f_a f_b^T + mu ((g_a . g_b) F F^T + f_b f_a^T).
fn material_block<const D: usize>(
    lame: Lame,
    fa: &SVector<f64, D>,
    fb: &SVector<f64, D>,
    stretch: f64,
    f_square: &SMatrix<f64, D, D>,
) -> SMatrix<f64, D, D> {
    fa * fb.transpose() * lame.lambda + (f_square * stretch + fb * fa.transpose()) * lame.mu
}

/// A cell that is turned inside out has no meaning.
pub(super) fn check_orientation<const N: usize, const M: usize, const D: usize>(
    cell: usize,
    nodes: &[usize; N],
    f: &SMatrix<f64, D, M>,
) -> Result<(), Failure> {
    let stretch = stretch_of(f);
    if stretch > 0.0 {
        return Ok(());
    }
    let nodes = nodes.map(|node| node + 1);
    Err(Failure::Recoverable(format!(
        "cell {} (nodes {nodes:?}) is inverted, det F = {stretch:.3}: St. Venant-Kirchhoff material \
         collapses under strong compression; load it less or refine the mesh there",
        cell + 1
    )))
}

/// `products` as a diagonal matrix with the same sum: its row sums, or those of quadratic cells
/// being 0 or below at corners, its scaled diagonal.
fn lumped<const N: usize>(products: &[[f64; N]; N], quadratic: bool) -> [[f64; N]; N] {
    let row_sums = products.map(|row| row.iter().sum::<f64>());
    let trace: f64 = (0..N).map(|a| products[a][a]).sum();
    let scale = row_sums.iter().sum::<f64>() / trace;
    let mut lumped = [[0.0; N]; N];
    for (a, row) in lumped.iter_mut().enumerate() {
        row[a] = if quadratic { scale * products[a][a] } else { row_sums[a] };
    }
    lumped
}

fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..N).flat_map(|a| (0..N).map(move |b| (a, b)))
}

fn bad_cell(number: usize, cell: &[usize], volume: f64) -> InputError {
    let nodes: Vec<usize> = cell.iter().map(|node| node + 1).collect();
    let mend = if volume < 0.0 {
        "its nodes run the wrong way round (clockwise, in two dimensions): reverse them"
    } else {
        "it is flat: move its nodes apart or leave the cell out"
    };
    InputError::new(
        format!("signed volume of cell {} (nodes {nodes:?})", number + 1),
        format!("{volume:.3e}"),
        format!("{mend} (numbers count from 1)"),
    )
}
