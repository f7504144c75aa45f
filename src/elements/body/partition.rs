//! Division of the work on cells among threads.
//!
//! Each share is a range of nodes, and computes the contributions of all cells that touch it to these nodes. Cells on
//! the border between shares are computed by each of them. So no two shares write to the same entry,
//! nothing has to be added up afterwards, and the sum at a node is the same to the last bit however many
//! threads there are.

use std::ops::Range;

use rayon::prelude::*;

use crate::base::sparse::Rows;
use crate::integrators::ode::Failure;

/// Number of nodes from which threads pay off: some 100 microseconds of work.
const LARGE: usize = 4000;
/// Numbers of shares that are tried, and the part of the cells that may be computed twice.
const NUMBERS: [usize; 4] = [64, 32, 16, 8];
const TWICE: f64 = 0.25;

/// Adds the forces of a run of cells to those on the nodes from one on: called once for each run of a share, so that the
/// code around it, that of threads above all, is compiled once and not for each kind of cell.
pub(super) type AddForces<'f> =
    dyn Fn(&Range<usize>, usize, &mut [f64]) -> Result<(), Failure> + Sync + 'f;

/// Adds the tangents of a share, given its number, to the rows of a stiffness and of a damping.
pub(super) type AddTangents<'f, const D: usize> =
    dyn Fn(usize, Rows<'_, D>, Rows<'_, D>) + Sync + 'f;

/// The shares of a mesh: one, if it is small or its nodes are numbered in no good order.
#[derive(Debug)]
pub(super) struct Partition {
    /// Nodes of each share but the last, which may have fewer.
    pub(super) nodes: usize,
    /// Cells that touch each share, in ascending order.
    pub(super) cells: Vec<Vec<Range<usize>>>,
}

impl Partition {
    /// The shares of `cells` on `nodes` nodes.
    pub(super) fn new<const N: usize>(cells: &[[usize; N]], nodes: usize) -> Self {
        let whole = Self { nodes, cells: vec![vec![0..cells.len()]] };
        // a sample touches few of the nodes
        if nodes.min(N * cells.len()) < LARGE {
            return whole;
        }
        let few_twice = |shares: &Self| {
            let all: usize = shares.cells.iter().flatten().map(Range::len).sum();
            all as f64 <= (1.0 + TWICE) * cells.len() as f64
        };
        let divided = |number| Self::divided(cells, nodes.div_ceil(number), nodes);
        NUMBERS.into_iter().map(divided).find(few_twice).unwrap_or(whole)
    }

    /// Calls `add` for all runs of cells of each share of the nodes, with the first of these nodes and the
    /// `dimension` forces on each of them; on threads if there are several shares.
    pub(super) fn each_force(
        &self,
        dimension: usize,
        forces: &mut [f64],
        add: &AddForces<'_>,
    ) -> Result<(), Failure> {
        let add_share = |number: usize, forces: &mut [f64]| {
            let first = number * self.nodes;
            self.cells[number].iter().try_for_each(|run| add(run, first, forces))
        };
        if self.cells.len() == 1 {
            return add_share(0, forces);
        }
        let shares = forces.par_chunks_mut(dimension * self.nodes).enumerate();
        let failed = shares.find_map_first(|(number, forces)| add_share(number, forces).err());
        failed.map_or(Ok(()), Err)
    }

    /// Calls `add` with each share's number and its rows of two matrices, on threads if there are
    /// several.
    pub(super) fn each<const D: usize>(
        &self,
        stiffness: Rows<'_, D>,
        damping: Rows<'_, D>,
        add: &AddTangents<'_, D>,
    ) {
        self.each_of(0..self.cells.len(), stiffness, damping, add);
    }

    fn each_of<const D: usize>(
        &self,
        shares: Range<usize>,
        stiffness: Rows<'_, D>,
        damping: Rows<'_, D>,
        add: &AddTangents<'_, D>,
    ) {
        if shares.len() == 1 {
            return add(shares.start, stiffness, damping);
        }
        let middle = shares.start + shares.len() / 2;
        let (low, high) = stiffness.split_at(middle * self.nodes);
        let (low_damping, high_damping) = damping.split_at(middle * self.nodes);
        rayon::join(
            || self.each_of(shares.start..middle, low, low_damping, add),
            || self.each_of(middle..shares.end, high, high_damping, add),
        );
    }

    fn divided<const N: usize>(cells: &[[usize; N]], each: usize, nodes: usize) -> Self {
        let mut shares: Vec<Vec<Range<usize>>> = vec![Vec::new(); nodes.div_ceil(each)];
        for (cell, of_cell) in cells.iter().enumerate() {
            for node in of_cell {
                match shares[node / each].last_mut() {
                    Some(run) if run.end > cell => {}
                    Some(run) if run.end == cell => run.end += 1,
                    _ => shares[node / each].push(cell..cell + 1),
                }
            }
        }
        Self { nodes: each, cells: shares }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh};

    #[test]
    fn every_cell_is_in_the_shares_of_its_nodes() {
        let mesh = Mesh::rectangle([1.0, 1.0], [150, 70], Cells::Triangles).unwrap();
        let cells: Vec<[usize; 3]> = mesh.cells().map(|cell| cell.try_into().unwrap()).collect();
        let shares = Partition::new(&cells, mesh.node_count());
        assert_eq!(shares.cells.len(), 16);
        for (share, runs) in shares.cells.iter().enumerate() {
            let listed: Vec<usize> = runs.iter().cloned().flatten().collect();
            let touching = |cell: &[usize; 3]| cell.iter().any(|node| node / shares.nodes == share);
            let expected = (0..cells.len()).filter(|&cell| touching(&cells[cell]));
            assert!(expected.eq(listed), "share {share}");
        }
        // in a random order of the nodes all cells would be in all shares
        let step = 7919;
        let shuffled: Vec<_> =
            cells.iter().map(|cell| cell.map(|node| node * step % mesh.node_count())).collect();
        assert_eq!(Partition::new(&shuffled, mesh.node_count()).cells.len(), 1);
    }
}
