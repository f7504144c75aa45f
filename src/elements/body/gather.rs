//! The vectors of the nodes of several cells, gathered into lanes.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use pulp::Simd;

use super::contiguous::differences;
use super::elements::ElementsOf;
use crate::base::lane::{Lane, SIDE_BY_SIDE};

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The vectors `x` of the nodes of as many cells as a register holds, from cell `start` on, minus those
    /// of their first nodes. Cells that are missing at the end repeat the last one.
    #[inline(always)]
    pub(super) fn gather<S: Simd>(&self, simd: S, start: usize, x: &[f64]) -> [[Lane<S>; D]; N] {
        if self.rows.at(start / SIDE_BY_SIDE).is_some() {
            return self.gather_row(simd, start, x);
        }
        let (nodes, last) = (&self.nodes[..], self.nodes.len() - 1);
        let x = x.as_chunks::<D>().0;
        let mut cells = [&nodes[start]; SIDE_BY_SIDE];
        for lane in 1..S::F64_LANES {
            cells[lane] = &nodes[last.min(start + lane)];
        }
        let [c0, c1, c2, c3, c4, c5, c6, c7] = cells;
        let mut gathered = [[Lane::splat(simd, 0.0); D]; N];
        let mut first = gathered[0];
        for a in 0..N {
            // no more than the register holds
            let at = |lane: usize, cell: &[usize; N]| {
                if lane < S::F64_LANES { x[cell[a]] } else { [0.0; D] }
            };
            let [n0, n1, n2, n3] = [at(0, c0), at(1, c1), at(2, c2), at(3, c3)];
            let [n4, n5, n6, n7] = [at(4, c4), at(5, c5), at(6, c6), at(7, c7)];
            for i in 0..D {
                let numbers = [n0[i], n1[i], n2[i], n3[i], n4[i], n5[i], n6[i], n7[i]];
                let of_cells = Lane::load(simd, &numbers, 0);
                if a == 0 {
                    first[i] = of_cells;
                } else {
                    gathered[a][i] = of_cells - first[i];
                }
            }
        }
        gathered
    }

    /// The same for cells in a row.
    #[inline(always)]
    fn gather_row<S: Simd>(&self, simd: S, start: usize, x: &[f64]) -> [[Lane<S>; D]; N] {
        let nodes = &self.nodes[start];
        let mut gathered = [[Lane::splat(simd, 0.0); D]; N];
        for a in 1..N {
            gathered[a] = differences(simd, &x[D * nodes[a]..], &x[D * nodes[0]..]);
        }
        gathered
    }
}
