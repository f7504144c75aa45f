//! Linear systems under the constraints of [edges](super::edges).
//!
//! The row G of an edge follows the motion, so that it cannot be eliminated once and for all. With Z = X^-1 E, E the
//! degrees of freedom of the frames, the multipliers are the solution of the small system
//!
//! ```text
//! (R Z G^T) multipliers = demands
//! ```
//!
//! piece by piece where pieces do not feel each other through X. R is G itself with X = M and, with the Newton matrix of
//! a step of gamma, the derivative of the stabilized constraint,
//!
//! ```text
//! R = (1 + alpha gamma)^2 x + 2 gamma (1 + alpha gamma) x' + gamma^2 x''
//! ```
//!
//! Central differences ask for lengths at the end of a step instead, x.x = 2 halves with x = start + weight (x'' of
//! the step), which Newton's method finds piece by piece.
//!
//! Rows G turn with the piece and are no part of the factorized matrix. Z takes 6 solves per piece for each
//! factor, 12 in space; the small matrix, 3 x 3 or 6 x 6 for each piece or for several that feel each other
//! through X, is set up anew as pieces turn. CVODE and ARKODE, which evaluate residuals again, take the edges
//! in R at the trial point: a matrix is kept for many steps, and iterations then converge as if the piece had
//! not turned. Rosenbrock methods, whose order rests on the Jacobian at the start of a step, take them there.
//! Forces of the multipliers turn with the edges; their derivative is part of Kt.
//!
//! A dependent node may have strayed from its frame by round-off, on which no force acts, so that (I - gamma
//! J) x = r says x = r: a Newton step gives it its own residual (`stray`). Without that BDF, which
//! extrapolates, would let the round-off grow without bound.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::lu::partial_pivoting::solve::{solve_in_place, solve_in_place_scratch};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use super::edges::{Edge, Edges};
use crate::base::vector::dot;

/// Solver of systems with X under the constraints of edges.
pub(crate) struct EdgeSolver {
    dimension: usize,
    /// For each edge the first columns of Z of its nodes, and its degrees of freedom among the free ones.
    ends: Vec<[usize; 2]>,
    places: Vec<[usize; 2]>,
    /// Z, one column per degree of freedom of a frame, and its part that the general rows hold.
    pub(crate) frames: Vec<usize>,
    pub(crate) z: Mat<f64>,
    pub(crate) of_rows: Mat<f64>,
    /// The diagonal of X^-1 at the frames, as it is without the general rows.
    pub(crate) inverse_diagonal: Vec<f64>,
    pieces: Vec<Piece>,
    rows: Vec<[f64; 3]>,
    columns: Vec<[f64; 3]>,
    /// Right-hand side of R x, and the multipliers that enforce it.
    pub(crate) demands: Vec<f64>,
    pub(crate) multipliers: Vec<f64>,
    /// Prescribed lengths instead, in the first half of a step of central differences.
    pub(crate) arrival: Arrival,
    /// G^T multipliers at the frames.
    pull: Vec<f64>,
}

/// Where edges are to be at the end of a step.
pub(crate) struct Arrival {
    /// The part of accelerations in displacements at the end of the step (s^2), if lengths are asked for.
    pub(crate) weight: Option<f64>,
    /// The edges there without accelerations (m), and what half of the squares of their lengths is to be (m^2).
    pub(crate) starts: Vec<[f64; 3]>,
    pub(crate) halves: Vec<f64>,
    /// Whether no multipliers were found, the last time.
    pub(crate) is_missed: bool,
}

/// Edges that feel each other through X, with their factorized small matrix.
struct Piece {
    edges: Vec<usize>,
    /// Z G^T: by how much the multiplier of each moves each, and their sums over the rounds of Newton's method.
    blocks: Vec<[f64; 3]>,
    sums: Vec<f64>,
    lu: Mat<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
    right: Vec<f64>,
    memory: MemBuffer,
}

impl Piece {
    fn new(edges: Vec<usize>) -> Self {
        let count = edges.len();
        let memory = MemBuffer::new(StackReq::any_of(&[
            lu_in_place_scratch::<usize, f64>(count, count, Par::Seq, Spec::default()),
            solve_in_place_scratch::<usize, f64>(count, 1, Par::Seq),
        ]));
        Self {
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

    fn factorize(&mut self) {
        let stack = MemStack::new(&mut self.memory);
        let Self { lu, forward, backward, .. } = self;
        lu_in_place(lu.as_mut(), forward, backward, Par::Seq, stack, Spec::default());
    }

    /// Replaces `right` by the solution.
    fn solve(&mut self) {
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
    fn arrive(&mut self, weight: f64, arrival: &Arrival, columns: &[[f64; 3]]) -> bool {
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

impl EdgeSolver {
    /// For edges between nodes whose degrees of freedom are at the given `position` among the free ones; `general` is
    /// the number of general rows.
    pub(crate) fn new(
        edges: &[Edge],
        dimension: usize,
        position: impl Fn(usize) -> Option<usize>,
        [free, general]: [usize; 2],
    ) -> Self {
        let mut nodes: Vec<usize> = edges.iter().flat_map(|edge| edge.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        // no component of a frame is fixed by itself: rows of rigid pieces are general ones
        let place = |node: usize| position(node * dimension).unwrap_or_default();
        let frames: Vec<usize> = nodes
            .iter()
            .flat_map(|&node| (0..dimension).map(move |axis| place(node) + axis))
            .collect();
        let column = |node: usize| nodes.binary_search(&node).unwrap_or_default() * dimension;
        let count = frames.len();
        Self {
            dimension,
            ends: edges.iter().map(|edge| edge.nodes.map(column)).collect(),
            places: edges.iter().map(|edge| edge.nodes.map(place)).collect(),
            z: Mat::zeros(free, count),
            of_rows: Mat::zeros(general, count),
            inverse_diagonal: vec![0.0; count],
            frames,
            pieces: Vec::new(),
            rows: vec![[0.0; 3]; edges.len()],
            columns: vec![[0.0; 3]; edges.len()],
            demands: vec![0.0; edges.len()],
            multipliers: vec![0.0; edges.len()],
            arrival: Arrival {
                weight: None,
                starts: vec![[0.0; 3]; edges.len()],
                halves: vec![0.0; edges.len()],
                is_missed: false,
            },
            pull: vec![0.0; count],
        }
    }

    /// Finds which edges feel each other, once Z is set.
    pub(crate) fn divide(&mut self) {
        let feels = |a: usize, b: usize| {
            self.ends[a].into_iter().any(|a| {
                let row = self.frames[a];
                self.ends[b].into_iter().any(|b| {
                    let d = self.dimension;
                    (0..d).any(|i| (0..d).any(|j| self.z[(row + i, b + j)] != 0.0))
                })
            })
        };
        let mut open: Vec<usize> = (0..self.ends.len()).collect();
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
            && self.pieces.iter().zip(&pieces).all(|(piece, edges)| piece.edges == *edges);
        if !is_same {
            self.pieces = pieces.into_iter().map(Piece::new).collect();
        }
    }

    /// Asks for an arrival from where the edges are, instead of rates.
    pub(crate) fn aim(&mut self, edges: &Edges) {
        self.columns.copy_from_slice(&edges.arms);
        let mut pieces = std::mem::take(&mut self.pieces);
        for Piece { edges, blocks, .. } in &mut pieces {
            let all = edges.iter().flat_map(|&row| edges.iter().map(move |&column| (row, column)));
            blocks.iter_mut().zip(all).for_each(|(block, (row, column))| {
                *block = self.block(row, column);
            });
        }
        self.pieces = pieces;
    }

    /// Z G^T of two edges: how the multiplier of one moves the other.
    fn block(&self, row: usize, column: usize) -> [f64; 3] {
        let ([c, d], [a, b]) = (self.ends[column], self.places[row]);
        let g = &self.columns[column][..self.dimension];
        std::array::from_fn(|i| {
            let z = |at: usize| self.z[(a + i, at)] - self.z[(b + i, at)];
            let part = |(j, g): (usize, &f64)| (z(c + j) - z(d + j)) * g;
            if i < self.dimension { g.iter().enumerate().map(part).sum() } else { 0.0 }
        })
    }

    /// R Z G^T of two edges.
    fn entry(&self, row: usize, column: usize) -> f64 {
        let (r, g) = (&self.rows[row], &self.columns[column]);
        let [c, d] = self.ends[column];
        let [a, b] = self.places[row];
        let mut sum = 0.0;
        for (i, r) in r.iter().enumerate().take(self.dimension) {
            for (j, g) in g.iter().enumerate().take(self.dimension) {
                let z = |at: usize| self.z[(at, c + j)] - self.z[(at, d + j)];
                sum += r * (z(a + i) - z(b + i)) * g;
            }
        }
        sum
    }

    /// Sets G, and R: G itself, or with the factors of x, x' and x'' in a `step`.
    pub(crate) fn turn(&mut self, edges: &Edges, step: Option<[f64; 3]>) {
        self.arrival.weight = None;
        self.columns.copy_from_slice(&edges.arms);
        match step {
            Some(factors) => edges.rows(factors, &mut self.rows),
            None => self.rows.copy_from_slice(&edges.arms),
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        for piece in &mut pieces {
            for (i, &row) in piece.edges.iter().enumerate() {
                for (j, &column) in piece.edges.iter().enumerate() {
                    piece.lu[(i, j)] = self.entry(row, column);
                }
            }
            piece.factorize();
        }
        self.pieces = pieces;
    }

    /// Which edges do not follow from the constraints of the general rows and the edges before them.
    pub(crate) fn independent(&mut self, edges: &Edges) -> Vec<bool> {
        self.columns.copy_from_slice(&edges.arms);
        self.rows.copy_from_slice(&edges.arms);
        let mut is_kept = vec![false; self.ends.len()];
        for Piece { edges, .. } in &self.pieces {
            // Cholesky's factorization, row by row, of those that have a pivot
            let mut factor: Vec<(usize, Vec<f64>)> = Vec::new();
            for &edge in edges {
                let mut row: Vec<f64> = Vec::new();
                for (other, of_other) in &factor {
                    let known: f64 = row.iter().zip(of_other).map(|(a, b)| a * b).sum();
                    let pivot = of_other[row.len()];
                    row.push((self.entry(edge, *other) - known) / pivot);
                }
                let whole = self.entry(edge, edge);
                let left = whole - dot(&row, &row);
                // relative to what the edge would have by itself: if its nodes are held, round-off is all there is
                is_kept[edge] = left > LOST * whole && whole > LOST * self.largest(edge);
                if is_kept[edge] {
                    row.push(left.sqrt());
                    factor.push((edge, row));
                }
            }
        }
        is_kept
    }

    /// The scale of the entry of an edge: that of its nodes by themselves, which are light, and without constraints, which may
    /// hold all of a frame.
    fn largest(&self, edge: usize) -> f64 {
        let square = dot(&self.columns[edge], &self.columns[edge]);
        square * self.inverse_diagonal.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    }

    /// Corrects the solution `x` = X^-1 f, and the multipliers `mu` of the general rows `numbers`, by the multipliers that
    /// the demands require.
    pub(crate) fn correct(
        &mut self,
        x: &mut [f64],
        numbers: impl Iterator<Item = usize>,
        mu: &mut [f64],
    ) {
        let Self {
            dimension: d,
            ends,
            places,
            z,
            of_rows,
            pieces,
            rows,
            columns,
            demands,
            multipliers,
            arrival,
            pull,
            ..
        } = self;
        pull.fill(0.0);
        arrival.is_missed = false;
        for piece in pieces {
            match arrival.weight {
                None => {
                    for (right, &k) in piece.right.iter_mut().zip(&piece.edges) {
                        let ([a, b], r) = (places[k], &rows[k]);
                        let along: f64 = (0..*d).map(|i| r[i] * (x[a + i] - x[b + i])).sum();
                        *right = demands[k] - along;
                    }
                    piece.solve();
                }
                Some(weight) => {
                    for &k in &piece.edges {
                        let [a, b] = places[k];
                        let start = arrival.starts[k].iter_mut().take(*d);
                        start.enumerate().for_each(|(i, s)| *s += weight * (x[a + i] - x[b + i]));
                    }
                    arrival.is_missed |= !piece.arrive(weight, arrival, columns);
                }
            }
            for (multiplier, &k) in piece.right.iter().zip(&piece.edges) {
                multipliers[k] = *multiplier;
                let ([a, b], g) = (ends[k], &columns[k]);
                for i in 0..*d {
                    pull[a + i] += multiplier * g[i];
                    pull[b + i] -= multiplier * g[i];
                }
            }
        }
        for (column, pull) in pull.iter().enumerate().filter(|(_, pull)| **pull != 0.0) {
            x.iter_mut().zip(z.col_as_slice(column)).for_each(|(x, z)| *x += pull * z);
        }
        for (row, number) in numbers.enumerate() {
            mu[number] +=
                pull.iter().enumerate().map(|(k, pull)| pull * of_rows[(row, k)]).sum::<f64>();
        }
    }
}

/// Pivots below this, relative to the diagonal, are round-off.
const LOST: f64 = 1e-10;

/// Rounds of Newton's method for an arrival, and how near, relative to the squares of lengths, the round is after which
/// round-off is left, as each squares what is left.
const MOST_ROUNDS: usize = 8;
const NEAR: f64 = 1e-8;
