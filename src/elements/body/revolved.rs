//! The cells of a body of revolution: those of its section in the plane (r, z), rotated about the axis r = 0.
//!
//! A point is one of space, with the axes r, z and around. To the displacement gradient in the plane comes the hoop strain
//! u_r / R, so that laws are those of solids, and volumes are those of a whole turn. The change of F by the motion of node a
//! has five components that are not 0: g_a of each of its two displacements, and N_a / R around of u_r.
//!
//! Loops run cell by cell in numbers of nodes that are not known to the compiler, and are compiled once for all kinds of cells.

use std::ops::Range;

use super::offset::Offset;
use super::projection::Projected;
use crate::base::tensor::Matrix;
use crate::elements::material::Deformation;

/// Most nodes of a cell in the plane.
pub(super) const MOST: usize = 9;

/// The derivatives of r, z and around of a shape function at a point: g_a and N_a / R (1/m).
pub(super) type Shape = [f64; 3];

/// A point of a body of revolution.
pub(super) type Turned = Deformation<f64, 3, 3>;

/// Nothing but the axes themselves.
pub(super) const UNIT: Matrix<f64, 3, 3> = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Cells that are turned about the axis, all of one kind.
#[derive(Clone)]
pub(super) struct Revolved {
    /// Nodes and strain points of each cell.
    pub(super) of_cell: usize,
    pub(super) points: usize,
    pub(super) nodes: Vec<usize>,
    /// The entries of all pairs of nodes of a cell in the pattern of the body.
    pub(super) entries: Vec<u32>,
    /// Those of all nodes of a cell, point by point.
    pub(super) shapes: Vec<Shape>,
    /// Volumes (m^3), and lengths 2 pi R (m) of the circles, of points.
    pub(super) volumes: Vec<f64>,
    pub(super) circles: Vec<f64>,
    pub(super) is_projected: bool,
    /// The linear modes of a projected dilatation at points; empty if it has none.
    pub(super) modes: Vec<[f64; 2]>,
    /// The weights of the points of a cell in values at its nodes, node by node.
    pub(super) extrapolation: Vec<f64>,
    /// Numbers of the cells among those of the whole body; empty where they are all.
    pub(super) numbers: Vec<usize>,
}

impl Revolved {
    pub(super) fn count(&self) -> usize {
        self.nodes.len() / self.of_cell
    }

    pub(super) fn nodes_of(&self, cell: usize) -> &[usize] {
        &self.nodes[cell * self.of_cell..][..self.of_cell]
    }

    pub(super) fn entry(&self, cell: usize, [a, b]: [usize; 2]) -> u32 {
        self.entries[(cell * self.of_cell + a) * self.of_cell + b]
    }

    /// The numbers of the points of a cell.
    pub(super) fn points_of(&self, cell: usize) -> Range<usize> {
        cell * self.points..(cell + 1) * self.points
    }

    pub(super) fn shapes_at(&self, point: usize) -> &[Shape] {
        &self.shapes[point * self.of_cell..][..self.of_cell]
    }

    pub(super) fn modes_at(&self, point: usize) -> Option<&[f64; 2]> {
        self.modes.get(point)
    }

    /// The gradient of a `field` at a point of a cell, column by column. It is exactly 0 for a uniform displacement along z.
    pub(super) fn gradient(&self, cell: usize, point: usize, field: &[f64]) -> Matrix<f64, 3, 3> {
        let (nodes, shapes) = (self.nodes_of(cell), self.shapes_at(point));
        let first = field[2 * nodes[0] + 1];
        let mut h = [[0.0; 3]; 3];
        for (node, [by_r, by_z, hoop]) in nodes.iter().zip(shapes) {
            let [r, z] = [field[2 * node], field[2 * node + 1] - first];
            h[0][0] += r * by_r;
            h[1][0] += r * by_z;
            h[2][2] += r * hoop;
            h[0][1] += z * by_r;
            h[1][1] += z * by_z;
        }
        h
    }

    pub(super) fn deformed(&self, cell: usize, point: usize, u: &[f64]) -> Turned {
        Deformation::new(UNIT, self.gradient(cell, point, u))
    }

    /// The projection of a field with these values at the points of a cell onto functions of that cell.
    pub(super) fn projected(
        &self,
        cell: usize,
        mut value: impl FnMut(usize) -> f64,
    ) -> Projected<f64, 2> {
        let (mut sum, mut whole) = (Projected::new(0.0), 0.0);
        for point in self.points_of(cell) {
            let volume = self.volumes[point];
            sum.add(volume * value(point), self.modes_at(point));
            whole += volume;
        }
        sum.over(whole)
    }

    /// The volume (m^3) of a cell before.
    pub(super) fn volume(&self, cell: usize) -> f64 {
        self.volumes[self.points_of(cell)].iter().sum()
    }

    /// For each cell the length (m) that makes its volume of its area.
    pub(super) fn sections(&self) -> Vec<f64> {
        let of_cell = |cell: usize| {
            let points = self.points_of(cell);
            let area = points.map(|point| self.volumes[point] / self.circles[point]);
            self.volume(cell) / area.sum::<f64>()
        };
        (0..self.count()).map(of_cell).collect()
    }

    /// Ratio of present to natural volume of each cell.
    pub(super) fn volume_ratios(&self, u: &[f64]) -> Vec<f64> {
        let of_cell = |cell: usize| {
            let present = |point| self.volumes[point] * self.deformed(cell, point, u).stretch();
            self.points_of(cell).map(present).sum::<f64>() / self.volume(cell)
        };
        (0..self.count()).map(of_cell).collect()
    }

    /// Cells that are turned inside out, or lie beyond the axis.
    pub(super) fn inverted(&self, u: &[f64]) -> Vec<usize> {
        let is_inverted = |point: usize, cell: usize| {
            let at = self.deformed(cell, point, u);
            at.stretch() <= 0.0 || hoop(&at) <= 0.0
        };
        let has_one = |cell: &usize| self.points_of(*cell).any(|point| is_inverted(point, *cell));
        (0..self.count()).filter(has_one).collect()
    }

    /// The same on the nodes of several bodies.
    pub(super) fn among_others(&self, Offset { node, entry, .. }: Offset) -> Self {
        Self {
            nodes: self.nodes.iter().map(|own| node + own).collect(),
            entries: self.entries.iter().map(|own| (entry + *own as usize) as u32).collect(),
            ..self.clone()
        }
    }

    /// Some of these `cells`, each times a weight, with the entries of their pairs of nodes.
    pub(super) fn sampled(&self, cells: &[usize], weights: &[f64], entries: Vec<u32>) -> Self {
        let points = || cells.iter().flat_map(|&cell| self.points_of(cell));
        let weights = weights.iter().flat_map(|weight| vec![weight; self.points]);
        let modes = points().filter_map(|point| self.modes_at(point));
        Self {
            nodes: cells.iter().flat_map(|&cell| self.nodes_of(cell)).copied().collect(),
            entries,
            shapes: points().flat_map(|point| self.shapes_at(point)).copied().collect(),
            volumes: points().zip(weights).map(|(point, w)| w * self.volumes[point]).collect(),
            circles: points().map(|point| self.circles[point]).collect(),
            modes: modes.copied().collect(),
            numbers: cells.iter().map(|&cell| self.number(cell)).collect(),
            ..self.clone()
        }
    }

    /// The number of a cell in the whole body.
    pub(super) fn number(&self, cell: usize) -> usize {
        self.numbers.get(cell).copied().unwrap_or(cell)
    }
}

/// Ratio of the present to the natural length of a circle about the axis.
pub(super) fn hoop(at: &Turned) -> f64 {
    1.0 + at.h[2][2]
}
