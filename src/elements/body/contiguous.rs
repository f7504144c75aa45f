//! Cells in a row: the numbers of their nodes grow by 1 from cell to cell, as in meshes of rectangles and
//! cuboids, so that the vectors of several cells are contiguous in memory.
//!
//! Eight such cells need no index look-ups: the a-th nodes of all of them lie side by side in memory and are
//! read and written as registers, those with the greater numbers first, so that a node still gets the forces
//! of its cells in their order. Permuted registers for nodes in any order gained nothing.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::cmp::Reverse;

use pulp::Simd;

use crate::base::lane::{Lane, SIDE_BY_SIDE};

/// Which blocks of [`SIDE_BY_SIDE`] cells of `N` nodes are in a row.
#[derive(Debug)]
pub(super) struct ContiguousCells<const N: usize>(Vec<Option<Order<N>>>);

/// The nodes of a cell (local numbers), from the greatest node number to the least. In this order a node that
/// is the a-th of one cell and the b-th of another gets the forces of the two in the order of the cells.
type Order<const N: usize> = [u8; N];

impl<const N: usize> ContiguousCells<N> {
    pub(super) fn new(cells: &[[usize; N]]) -> Self {
        Self(cells.as_chunks::<SIDE_BY_SIDE>().0.iter().map(order).collect())
    }

    /// The order of the nodes of the cells in a `block`, if they are in a row.
    #[inline(always)]
    pub(super) fn at(&self, block: usize) -> Option<&Order<N>> {
        self.0.get(block)?.as_ref()
    }
}

fn order<const N: usize>(cells: &[[usize; N]; SIDE_BY_SIDE]) -> Option<Order<N>> {
    let numbered_on = |pair: &[[usize; N]]| (0..N).all(|a| pair[1][a] == pair[0][a] + 1);
    let mut order = std::array::from_fn(|a| a as u8);
    order.sort_by_key(|&a| Reverse(cells[0][usize::from(a)]));
    cells.windows(2).all(numbered_on).then_some(order)
}

/// [`SIDE_BY_SIDE`] vectors or less, one after the other: the numbers of `D` registers of any machine. (A slice of vectors is flattened by
/// a function that is not inlined.)
pub(super) type Vectors<const D: usize> = [[f64; SIDE_BY_SIDE]; D];

/// As many vectors as a register holds, the first of `vectors`, minus as many of `others`, by their components.
#[inline(always)]
pub(super) fn differences<S: Simd, const D: usize>(
    simd: S,
    vectors: &[f64],
    others: &[f64],
) -> [Lane<S>; D] {
    let (vectors, others) = (&vectors[..D * S::F64_LANES], &others[..D * S::F64_LANES]);
    let mut differences: Vectors<D> = [[0.0; SIDE_BY_SIDE]; D];
    for part in 0..D {
        let difference = Lane::load(simd, vectors, part) - Lane::load(simd, others, part);
        let [row, part] = place::<S>(part);
        difference.store(&mut differences[row], part);
    }
    let mut components = [Lane::splat(simd, 0.0); D];
    for i in 0..D {
        let mut numbers = [0.0; SIDE_BY_SIDE];
        for lane in 0..SIDE_BY_SIDE {
            let number = D * lane + i;
            numbers[lane] = differences[number / SIDE_BY_SIDE][number % SIDE_BY_SIDE];
        }
        components[i] = Lane::load(simd, &numbers, 0);
    }
    components
}

/// The vectors of as many cells as a register holds, given by their components.
#[inline(always)]
pub(super) fn vectors<S: Simd, const D: usize>(components: &[Lane<S>; D]) -> Vectors<D> {
    let mut vectors = [[0.0; SIDE_BY_SIDE]; D];
    for i in 0..D {
        let mut numbers = [0.0; SIDE_BY_SIDE];
        components[i].store(&mut numbers, 0);
        for lane in 0..S::F64_LANES {
            let number = D * lane + i;
            vectors[number / SIDE_BY_SIDE][number % SIDE_BY_SIDE] = numbers[lane];
        }
    }
    vectors
}

/// Subtracts `vectors` from the first of `from`, as many as a register holds.
#[inline(always)]
pub(super) fn subtract<S: Simd, const D: usize>(simd: S, vectors: &Vectors<D>, from: &mut [f64]) {
    let from = &mut from[..D * S::F64_LANES];
    for part in 0..D {
        let [row, of_row] = place::<S>(part);
        let difference = Lane::load(simd, from, part) - Lane::load(simd, &vectors[row], of_row);
        difference.store(from, part);
    }
}

/// The row of [`Vectors`] in which register `part` of its numbers stands, and which register of that row it is.
#[inline(always)]
fn place<S: Simd>(part: usize) -> [usize; 2] {
    let of_row = SIDE_BY_SIDE / S::F64_LANES;
    [part / of_row, part % of_row]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CellSelection;
    use crate::base::sparse::NodePattern;
    use crate::elements::basis::{
        Hexahedron, Quadrilateral, ReferenceCell, Segment, Tetrahedron, Triangle,
    };
    use crate::elements::body::Dilatation;
    use crate::elements::body::elements::ElementsOf;
    use crate::elements::body::forces::{Forces, Terms};
    use crate::elements::body::regions::Regions;
    use crate::elements::body::section::Section;
    use crate::elements::body::tests::noise;
    use crate::elements::force::NodalForces;
    use crate::elements::material::{Material, Plane, Strain};
    use crate::elements::mesh::{Cells, Mesh, SolidCells};
    use crate::studies::samples::SQUARE_MATERIAL;

    /// The forces of cells in a row and of the same cells one by one are the same to the last bit: each node
    /// gets them in the same order. A region begins and ends within a row.
    fn are_those_of_single_cells<
        C: ReferenceCell<N, M>,
        const N: usize,
        const M: usize,
        const D: usize,
        const Q: usize,
    >(
        mesh: &Mesh,
        dilatation: Dilatation,
    ) {
        let pattern = NodePattern::new(mesh.node_count(), mesh.cells());
        let mut elements =
            ElementsOf::<N, M, D, Q>::new::<C>(mesh, Section::Uniform(1.0), dilatation, &pattern)
                .unwrap();
        let base = Material { viscosity: 3.0, ..SQUARE_MATERIAL };
        let stiff =
            (CellSelection::Numbers((13..=27).collect()), Material { young: 2e6, ..base }.into());
        let regions =
            Regions::new(mesh, Strain::Green, Plane::Strain, &base.into(), &[stiff]).unwrap();
        let dofs = mesh.node_count() * D;
        let (u, v) = (noise(dofs, 1e-4, 1.0), noise(dofs, 1.0, 2.0));
        let forces = |elements: &ElementsOf<N, M, D, Q>| {
            let (mut forces, both) =
                (NodalForces::zeros(dofs), Terms { elastic: true, viscous: true });
            elements.add_forces(&regions, both, &u, &v, &mut forces).unwrap();
            [forces.conservative.to_vec(), forces.dissipative.to_vec()]
        };
        let found = elements.rows.0.iter().flatten().count();
        assert!(0 < found && found < elements.abreast().len(), "{found} in a row");
        let by_rows = forces(&elements);
        assert!(by_rows.iter().all(|of_kind| of_kind.iter().any(|force| *force != 0.0)));
        elements.rows = ContiguousCells(Vec::new());
        assert!(by_rows == forces(&elements));
    }

    #[test]
    fn cells_in_a_row() {
        let points = Dilatation::AtPoints;
        let plane = |nodes, cells| Mesh::rectangle([2.0, 1.0], nodes, cells).unwrap();
        let solid = |cells| Mesh::cuboid([2.0, 0.2, 0.2], [20, 3, 3], cells).unwrap();
        are_those_of_single_cells::<Segment, 2, 1, 1, 1>(&Mesh::bar(1.0, 31).unwrap(), points);
        let triangles = plane([20, 4], Cells::Triangles);
        are_those_of_single_cells::<Triangle, 3, 2, 2, 1>(&triangles, points);
        let rectangles = plane([20, 4], Cells::Rectangles);
        are_those_of_single_cells::<Quadrilateral, 4, 2, 2, 4>(&rectangles, points);
        are_those_of_single_cells::<Quadrilateral, 4, 2, 2, 4>(&rectangles, Dilatation::Mean);
        let tetrahedra = solid(SolidCells::Tetrahedra);
        are_those_of_single_cells::<Tetrahedron, 4, 3, 3, 1>(&tetrahedra, points);
        let hexahedra = solid(SolidCells::Hexahedra);
        are_those_of_single_cells::<Hexahedron, 8, 3, 3, 8>(&hexahedra, points);
        // nodes in several shares
        let many = plane([150, 70], Cells::Triangles);
        are_those_of_single_cells::<Triangle, 3, 2, 2, 1>(&many, points);
    }
}
