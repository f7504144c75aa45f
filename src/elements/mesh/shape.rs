//! Which way cells run, and what is wrong with those that have no volume.
//!
//! The lengths, areas or volumes that the edges span at the corners tell the cause: all below 0, the nodes
//! run the wrong way round; of both signs, the cell is a bow-tie (as many of each, in a quadrilateral),
//! concave or twisted; all above 0 in a quadratic cell, its sides are curved too far.

use nalgebra::{Matrix3, Vector3};

use super::{CellKind, Mesh};
use crate::base::input::InputError;
use crate::base::vector::padded;

/// A corner and its neighbours in the order of the axes, for each corner of a quadrilateral and of a hexahedron.
const OF_QUADRILATERAL: &[&[usize]] = &[&[0, 1, 3], &[1, 2, 0], &[2, 3, 1], &[3, 0, 2]];
const OF_HEXAHEDRON: &[&[usize]] = &[
    &[0, 1, 3, 4],
    &[1, 2, 0, 5],
    &[2, 3, 1, 6],
    &[3, 0, 2, 7],
    &[4, 7, 5, 0],
    &[5, 4, 6, 1],
    &[6, 5, 7, 2],
    &[7, 6, 4, 3],
];

/// Corners whose edges span less than this fraction of a cube of the size of the cell are flat.
const FLAT: f64 = 1e-12;

/// Lengths, areas or volumes that the edges at the corners of a cell span, in order; they are below 0 where the cell runs the wrong
/// way round. Of simplices one corner stands for all.
pub(super) fn corner_measures(
    kind: CellKind,
    cell: &[usize],
    position: impl Fn(usize) -> [f64; 3],
) -> Vec<f64> {
    let first = [&[0], kind.neighbours()].concat();
    let corners = match (kind.dimension(), kind.faces().len()) {
        (2, 4) => OF_QUADRILATERAL,
        (3, 6) => OF_HEXAHEDRON,
        _ => &[&first[..]],
    };
    let at = |local: usize| Vector3::from(position(cell[local]));
    let measure = |corner: &&[usize]| {
        let mut edges = Matrix3::identity();
        for (axis, &neighbour) in corner[1..].iter().enumerate() {
            edges.set_column(axis, &(at(neighbour) - at(corner[0])));
        }
        edges.determinant()
    };
    corners.iter().map(measure).collect()
}

/// A reason for which a cell cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Flaw {
    Reversed,
    Crossed,
    Concave,
    Twisted,
    Curved,
    Flat,
}

impl Flaw {
    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Reversed => {
                ["run the wrong way round (clockwise, in two dimensions)", "reverse their nodes"]
            }
            Self::Crossed => [
                "are bow-ties, two sides of which cross",
                "swap two neighbouring nodes of each in its list",
            ],
            Self::Concave => [
                "are concave, with a corner that points inwards",
                "move it outwards, or divide each into two triangles",
            ],
            Self::Twisted => [
                "are twisted or folded, with corners of both orientations",
                "put their nodes in order, or mesh this part again",
            ],
            Self::Curved => [
                "have sides so curved that they are inside out in part",
                "refine the mesh where its boundary is curved, or straighten mid nodes (in Gmsh: Mesh.HighOrderOptimize = 2, or \
                 Mesh.SecondOrderLinear = 1)",
            ],
            Self::Flat => ["are flat", "move their nodes apart or leave the cells out"],
        }
    }
}

impl Mesh {
    fn flaw(&self, cell: &[usize]) -> Flaw {
        let kind = self.kind();
        if kind.dimension() < self.dimension {
            return Flaw::Flat; // on both sides of a membrane is space
        }
        let position = |node: usize| padded(self.position(node));
        let from = Vector3::from(position(cell[0]));
        let size = cell.iter().map(|&node| (Vector3::from(position(node)) - from).norm());
        let least = FLAT * size.fold(0.0, f64::max).powi(kind.dimension() as i32);
        let measures = corner_measures(kind, cell, position);
        let negative = measures.iter().filter(|measure| **measure < -least).count();
        let positive = measures.iter().filter(|measure| **measure > least).count();
        match (negative, positive) {
            (0, 0) => Flaw::Flat,
            (_, 0) => Flaw::Reversed,
            (0, _) if kind.is_quadratic() => Flaw::Curved,
            (0, _) => Flaw::Flat,
            _ if kind.dimension() == 3 => Flaw::Twisted,
            _ if negative == positive => Flaw::Crossed,
            _ => Flaw::Concave,
        }
    }

    /// The error for cells, by their numbers, that are inverted somewhere or have no volume: their flaws, count and positions.
    pub(crate) fn flawed_cells(&self, numbers: &[usize]) -> InputError {
        let cell = |number: usize| self.cells().nth(number).unwrap_or_default();
        let mut flaws: Vec<(Flaw, usize)> = self
            .cells()
            .zip(0..)
            .filter(|(_, number)| numbers.binary_search(number).is_ok())
            .map(|(cell, number)| (self.flaw(cell), number))
            .collect();
        flaws.sort_unstable();
        let told = |same: &[(Flaw, usize)]| {
            let (flaw, first) = same[0];
            let nodes: Vec<usize> = cell(first).iter().map(|node| node + 1).collect();
            let [what, help] = flaw.words();
            let place = self.told_middle(cell(first));
            let count = same.len();
            format!(
                "{count} {what}, such as cell {} (nodes {nodes:?}, around {place} m): {help}",
                first + 1
            )
        };
        let told: Vec<String> = flaws.chunk_by(|a, b| a.0 == b.0).map(told).collect();
        InputError::new(
            format!("cells that are inside out or without volume in the {}", self.origin()),
            format!("{} of {}", numbers.len(), self.cell_count()),
            format!("{} (numbers count from 1)", told.join("; ")),
        )
    }
}
