//! Edges that are coupled, directly or by others, with their part of X^-1, from which [`EdgeSolver`](super::edge_solver::EdgeSolver) finds multipliers.

use std::collections::HashMap;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::lu::partial_pivoting::solve::{solve_in_place, solve_in_place_scratch};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMat;
use faer::{Mat, MatMut, Par, Spec};

use crate::base::vector::dot;

/// Degrees of freedom that X, general rows and edges couple.
pub(super) struct Component {
    pub(super) dimension: usize,
    /// Edges, and for each of them the first columns and the first rows of its nodes in Z.
    pub(super) edges: Vec<usize>,
    pub(super) columns: Vec<[usize; 2]>,
    pub(super) rows: Vec<[usize; 2]>,
    /// Positions among the free degrees of freedom of the rows of Z, and the rows of Z that are frames: one column for each.
    pub(super) dofs: Vec<usize>,
    pub(super) frames: Vec<usize>,
    pub(super) z: Mat<f64>,
    /// General rows, by their numbers among these, and their part of Z.
    pub(super) general: Vec<usize>,
    pub(super) of_rows: Mat<f64>,
    /// The diagonal of X^-1 at the frames, as it is without the general rows.
    pub(super) inverse_diagonal: Vec<f64>,
    pub(super) pieces: Vec<Piece>,
    /// G^T multipliers at the frames.
    pub(super) pull: Vec<f64>,
}

/// Required edges at the end of a step.
pub(crate) struct Arrival {
    /// The part of accelerations in displacements at the end of the step (s^2), if lengths are prescribed.
    pub(crate) weight: Option<f64>,
    /// The edges there without accelerations (m), and the required halves of the squares of their lengths (m^2).
    pub(crate) starts: Vec<[f64; 3]>,
    pub(crate) halves: Vec<f64>,
    /// Whether no multipliers were found, the last time.
    pub(crate) is_missed: bool,
}

/// Edges that are coupled through X, with their factorized small matrix.
pub(super) struct Piece {
    /// Numbers of edges in the component, and in the list of all.
    pub(super) numbers: Vec<usize>,
    pub(super) edges: Vec<usize>,
    /// Z G^T: by how much the multiplier of each moves each, and their sums over the rounds of Newton's method.
    pub(super) blocks: Vec<[f64; 3]>,
    pub(super) sums: Vec<f64>,
    pub(super) lu: Mat<f64>,
    pub(super) forward: Vec<usize>,
    pub(super) backward: Vec<usize>,
    pub(super) right: Vec<f64>,
    pub(super) memory: MemBuffer,
}

impl Piece {
    fn new(numbers: Vec<usize>, of_all: &[usize]) -> Self {
        let edges: Vec<usize> = numbers.iter().map(|&number| of_all[number]).collect();
        let count = edges.len();
        let memory = MemBuffer::new(StackReq::any_of(&[
            lu_in_place_scratch::<usize, f64>(count, count, Par::Seq, Spec::default()),
            solve_in_place_scratch::<usize, f64>(count, 1, Par::Seq),
        ]));
        Self {
            numbers,
            edges,
            blocks: vec![[0.0; 3]; count * count],
            sums: vec![0.0; count],
            lu: Mat::zeros(count, count),
            forward: vec![0; count],
            backward: vec![0; count],
            right: vec![0.0; count],
            memory,
        }
    }

    pub(super) fn factorize(&mut self) {
        let stack = MemStack::new(&mut self.memory);
        let Self { lu, forward, backward, .. } = self;
        lu_in_place(lu.as_mut(), forward, backward, Par::Seq, stack, Spec::default());
    }

    /// Replaces `right` by the solution.
    pub(super) fn solve(&mut self) {
        let Self { lu, forward, backward, right, memory, .. } = self;
        let count = right.len();
        solve_in_place(
            lu.as_ref(),
            lu.as_ref(),
            PermRef::new_checked(forward, backward, count),
            MatMut::from_column_major_slice_mut(right, count, 1),
            Par::Seq,
            MemStack::new(memory),
        );
    }

    /// Finds the multipliers of an arrival, into `right`; `columns` are the edges where the step begins. Returns whether
    /// there are any, of a step in which no edge turns by more than 60 degrees.
    pub(super) fn arrive(&mut self, weight: f64, arrival: &Arrival, columns: &[[f64; 3]]) -> bool {
        let count = self.edges.len();
        self.sums.fill(0.0);
        for _ in 0..MOST_ROUNDS {
            let (mut worst, mut is_turned) = (0.0_f64, false);
            for (i, &k) in self.edges.iter().enumerate() {
                let (mut x, half) = (arrival.starts[k], arrival.halves[k]);
                let blocks = &self.blocks[i * count..][..count];
                for (block, sum) in blocks.iter().zip(&self.sums) {
                    x.iter_mut().zip(block).for_each(|(x, b)| *x += weight * sum * b);
                }
                let off = 0.5 * dot(&x, &x) - half;
                worst = worst.max(off.abs() / half);
                is_turned |= dot(&x, &columns[k]) < half;
                self.right[i] = -off / weight;
                blocks.iter().enumerate().for_each(|(j, block)| self.lu[(i, j)] = dot(&x, block));
            }
            self.factorize();
            self.solve();
            self.sums.iter_mut().zip(&self.right).for_each(|(sum, more)| *sum += more);
            if worst <= NEAR {
                self.right.copy_from_slice(&self.sums);
                return !is_turned && self.sums.iter().all(|sum| sum.is_finite());
            }
        }
        self.right.fill(0.0);
        false
    }
}

/// Coupling of the free degrees of freedom by X and general rows.
pub(super) struct Coupled<'a> {
    /// The lower triangle of X.
    pub(super) pattern: &'a SymbolicSparseColMat<usize>,
    /// Degrees of freedom of each general row.
    pub(super) general: &'a [Vec<usize>],
}

impl Component {
    /// Those with edges, whose nodes have their first degrees of freedom at these `places`.
    pub(super) fn all(places: &[[usize; 2]], dimension: usize, coupled: Coupled<'_>) -> Vec<Self> {
        let Coupled { pattern, general } = coupled;
        let free = pattern.nrows();
        let mut sets = Sets::new(free);
        let (offsets, rows) = (pattern.col_ptr(), pattern.row_idx());
        for column in 0..free {
            rows[offsets[column]..offsets[column + 1]]
                .iter()
                .for_each(|&row| sets.join(row, column));
        }
        for row in general {
            row.windows(2).for_each(|pair| sets.join(pair[0], pair[1]));
        }
        for &[a, b] in places {
            (0..dimension).for_each(|axis| {
                sets.join(a, a + axis);
                sets.join(b, b + axis);
            });
            sets.join(a, b);
        }
        let mut number_of: HashMap<usize, usize> = HashMap::new();
        let mut edges: Vec<Vec<usize>> = Vec::new();
        for (edge, [a, _]) in places.iter().enumerate() {
            let number = *number_of.entry(sets.first(*a)).or_insert(edges.len());
            if number == edges.len() {
                edges.push(Vec::new());
            }
            edges[number].push(edge);
        }
        let mut dofs = vec![Vec::new(); edges.len()];
        for at in 0..free {
            if let Some(&number) = number_of.get(&sets.first(at)) {
                dofs[number].push(at);
            }
        }
        let mut of_general = vec![Vec::new(); edges.len()];
        for (row, at) in general.iter().enumerate() {
            let number = at.first().and_then(|&at| number_of.get(&sets.first(at)));
            number.into_iter().for_each(|&number| of_general[number].push(row));
        }
        let parts = edges.into_iter().zip(dofs).zip(of_general);
        parts
            .map(|((edges, dofs), general)| Self::new(dimension, edges, places, dofs, general))
            .collect()
    }

    fn new(
        dimension: usize,
        edges: Vec<usize>,
        places: &[[usize; 2]],
        dofs: Vec<usize>,
        general: Vec<usize>,
    ) -> Self {
        let row = |at: usize| dofs.binary_search(&at).unwrap_or_default();
        let rows: Vec<[usize; 2]> = edges.iter().map(|&edge| places[edge].map(row)).collect();
        let mut nodes: Vec<usize> = rows.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let column = |row: usize| nodes.binary_search(&row).unwrap_or_default() * dimension;
        let frames: Vec<usize> =
            nodes.iter().flat_map(|&node| (0..dimension).map(move |axis| node + axis)).collect();
        let count = frames.len();
        Self {
            dimension,
            columns: rows.iter().map(|row| row.map(column)).collect(),
            rows,
            edges,
            z: Mat::zeros(dofs.len(), count),
            of_rows: Mat::zeros(general.len(), count),
            dofs,
            frames,
            general,
            inverse_diagonal: vec![0.0; count],
            pieces: Vec::new(),
            pull: vec![0.0; count],
        }
    }

    /// Finds the coupled edges, once Z is set.
    pub(super) fn divide(&mut self) {
        let d = self.dimension;
        let feels = |a: usize, b: usize| {
            self.rows[a].into_iter().any(|row| {
                self.columns[b].into_iter().any(|column| {
                    (0..d).any(|i| (0..d).any(|j| self.z[(row + i, column + j)] != 0.0))
                })
            })
        };
        let mut open: Vec<usize> = (0..self.edges.len()).collect();
        let mut pieces = Vec::new();
        while let Some(first) = open.pop() {
            let mut edges = vec![first];
            let mut at = 0;
            while at < edges.len() {
                let (near, far): (Vec<usize>, Vec<usize>) =
                    open.iter().partition(|&&other| feels(edges[at], other));
                edges.extend(near);
                open = far;
                at += 1;
            }
            edges.sort_unstable();
            pieces.push(edges);
        }
        let is_same = self.pieces.len() == pieces.len()
            && self.pieces.iter().zip(&pieces).all(|(piece, edges)| piece.numbers == *edges);
        if !is_same {
            self.pieces =
                pieces.into_iter().map(|numbers| Piece::new(numbers, &self.edges)).collect();
        }
    }

    /// Z G^T of two edges, G by all edges: how the multiplier of one moves the other.
    pub(super) fn block(&self, row: usize, column: usize, g: &[[f64; 3]]) -> [f64; 3] {
        let ([c, d], [a, b]) = (self.columns[column], self.rows[row]);
        let g = &g[self.edges[column]][..self.dimension];
        std::array::from_fn(|i| {
            let z = |at: usize| self.z[(a + i, at)] - self.z[(b + i, at)];
            let part = |(j, g): (usize, &f64)| (z(c + j) - z(d + j)) * g;
            if i < self.dimension { g.iter().enumerate().map(part).sum() } else { 0.0 }
        })
    }

    /// R Z G^T of two edges, R and G by all edges.
    pub(super) fn entry(&self, row: usize, column: usize, r: &[[f64; 3]], g: &[[f64; 3]]) -> f64 {
        let (r, g) = (&r[self.edges[row]], &g[self.edges[column]]);
        let [c, d] = self.columns[column];
        let [a, b] = self.rows[row];
        let mut sum = 0.0;
        for (i, r) in r.iter().enumerate().take(self.dimension) {
            for (j, g) in g.iter().enumerate().take(self.dimension) {
                let z = |at: usize| self.z[(at, c + j)] - self.z[(at, d + j)];
                sum += r * (z(a + i) - z(b + i)) * g;
            }
        }
        sum
    }

    /// Which edges, of all, do not follow from the constraints of the general rows and the edges before them, where R and G are `g`.
    pub(super) fn find_independent(&self, g: &[[f64; 3]], is_kept: &mut [bool]) {
        for Piece { numbers, .. } in &self.pieces {
            // Cholesky's factorization, row by row, of those that have a pivot
            let mut factor: Vec<(usize, Vec<f64>)> = Vec::new();
            for &edge in numbers {
                let mut row: Vec<f64> = Vec::new();
                for (other, of_other) in &factor {
                    let known: f64 = row.iter().zip(of_other).map(|(a, b)| a * b).sum();
                    let pivot = of_other[row.len()];
                    row.push((self.entry(edge, *other, g, g) - known) / pivot);
                }
                let whole = self.entry(edge, edge, g, g);
                let left = whole - dot(&row, &row);
                let number = self.edges[edge];
                // relative to what the edge would have by itself: if its nodes are held, round-off is all there is
                is_kept[number] = left > LOST * whole && whole > LOST * self.largest(&g[number]);
                if is_kept[number] {
                    row.push(left.sqrt());
                    factor.push((edge, row));
                }
            }
        }
    }

    /// The scale of the entry of an edge: that of its nodes by themselves, which are light, and without constraints, which may
    /// hold all of a frame.
    fn largest(&self, edge: &[f64; 3]) -> f64 {
        dot(edge, edge) * self.inverse_diagonal.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    }
}

/// Disjoint sets of numbers.
struct Sets(Vec<usize>);

impl Sets {
    /// One for each number.
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// A number that stands for the set of `x`.
    fn first(&mut self, mut x: usize) -> usize {
        while self.0[x] != x {
            self.0[x] = self.0[self.0[x]];
            x = self.0[x];
        }
        x
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b)] = a.min(b);
    }
}

/// Pivots below this, relative to the diagonal, are round-off.
const LOST: f64 = 1e-10;

/// Rounds of Newton's method for an arrival, and how near, relative to the squares of lengths, the round is after which
/// round-off is left, as each squares what is left.
const MOST_ROUNDS: usize = 8;
const NEAR: f64 = 1e-8;
