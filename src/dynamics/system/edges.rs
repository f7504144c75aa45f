//! Rigid pieces keep their shape: the nodes of their frames keep their distances.
//!
//! The frame of a piece (`elements/body/rigid.rs`) is a simplex, whose 3 edges in the plane, 6 in space, are what rigid
//! motion leaves unchanged (natural coordinates: J. García de Jalón, E. Bayo, "Kinematic and Dynamic Simulation
//! of Multibody Systems", Springer 1994). An edge x from one node to another, of the length L, is a constraint
//! that is stabilized like all others,
//!
//! ```text
//! g = (x.x - L^2)/2 = 0,   x.x'' = -x'.x' - 2 alpha x.x' - alpha^2 g
//! ```
//!
//! with a multiplier that presses with x at both nodes. Its row G = dg/du follows the motion, so that it cannot be
//! eliminated once and for all: with Z = X^-1 E, E the degrees of freedom of the frames, the multipliers
//! are the solution of the small system (R Z G^T) multipliers = demands, piece by piece where pieces do not feel each other
//! through X. R is G itself with X = M and, with the Newton matrix of a step of gamma, the derivative of
//!
//! ```text
//! R = (1 + alpha gamma)^2 x + 2 gamma (1 + alpha gamma) x' + gamma^2 x''
//! ```

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor::{lu_in_place, lu_in_place_scratch};
use faer::linalg::lu::partial_pivoting::solve::{solve_in_place, solve_in_place_scratch};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{difference, dot};
use crate::elements::body::RigidPieces;

/// An edge of a frame between two nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) nodes: [usize; 2],
    /// Its length squared (m^2).
    square: f64,
}

/// All edges in a state, with what the stabilization requires of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Edges {
    pub(super) list: Vec<Edge>,
    dimension: usize,
    /// Undeformed positions (m).
    positions: Vec<f64>,
    /// x, x', x'' of each.
    pub(super) arms: Vec<[f64; 3]>,
    rates: Vec<[f64; 3]>,
    accelerations: Vec<[f64; 3]>,
    /// x.x'' of each.
    pub(super) demands: Vec<f64>,
    /// Force over length of each (N/m), above 0 where it presses.
    pub(super) multipliers: Vec<f64>,
}

impl Edges {
    pub(super) fn new(rigid: Option<&RigidPieces>, positions: &[f64], dimension: usize) -> Self {
        let Some(rigid) = rigid else { return Self::default() };
        let mut list = Vec::new();
        for frame in rigid.frames() {
            for (k, &a) in frame.iter().enumerate() {
                list.extend(frame[..k].iter().map(|&b| Edge { nodes: [a, b], square: 0.0 }));
            }
        }
        let mut edges = Self { dimension, positions: positions.to_vec(), ..Self::of(list) };
        let rest = vec![0.0; positions.len()];
        edges.move_to(0.0, &rest, &rest);
        let squares: Vec<f64> = edges.arms.iter().map(|x| dot(x, x)).collect();
        edges.list.iter_mut().zip(squares).for_each(|(edge, square)| edge.square = square);
        edges
    }

    fn of(list: Vec<Edge>) -> Self {
        let none = vec![[0.0; 3]; list.len()];
        Self {
            arms: none.clone(),
            rates: none.clone(),
            accelerations: none,
            demands: vec![0.0; list.len()],
            multipliers: vec![0.0; list.len()],
            list,
            ..Self::default()
        }
    }

    /// The edges of which `is_kept` is true.
    pub(super) fn retained(&self, is_kept: &[bool]) -> Self {
        let list = self.list.iter().zip(is_kept).filter(|(_, is_kept)| **is_kept);
        let list = list.map(|(edge, _)| *edge).collect();
        Self { dimension: self.dimension, positions: self.positions.clone(), ..Self::of(list) }
    }

    /// Becomes the same as the `other` ones of the same list.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.arms.copy_from_slice(&other.arms);
        self.rates.copy_from_slice(&other.rates);
        self.accelerations.copy_from_slice(&other.accelerations);
        self.multipliers.copy_from_slice(&other.multipliers);
    }

    /// Moves on to displacements `u` (m) and velocities `v` (m/s), with the stabilization rate `alpha` (1/s).
    pub(super) fn move_to(&mut self, alpha: f64, u: &[f64], v: &[f64]) {
        for (k, Edge { nodes, square }) in self.list.iter().enumerate() {
            let [x, rate] = [
                self.along(*nodes, |dof| self.positions[dof] + u[dof]),
                self.along(*nodes, |dof| v[dof]),
            ];
            let off = 0.5 * (dot(&x, &x) - square);
            self.demands[k] =
                -dot(&rate, &rate) - 2.0 * alpha * dot(&x, &rate) - alpha * alpha * off;
            (self.arms[k], self.rates[k]) = (x, rate);
        }
    }

    /// Whether one of them changes its length faster than by `least` times the difference of velocities of its nodes.
    pub(super) fn stretches(&self, least: f64) -> bool {
        let along = |(x, rate): (&[f64; 3], &[f64; 3])| {
            let size = dot(x, x).sqrt() * dot(rate, rate).sqrt();
            dot(x, rate).abs() > least * size
        };
        self.arms.iter().zip(&self.rates).any(along)
    }

    /// Takes the accelerations `a` (m/s^2).
    pub(super) fn accelerate(&mut self, a: &[f64]) {
        for (k, Edge { nodes, .. }) in self.list.iter().enumerate() {
            self.accelerations[k] = self.along(*nodes, |dof| a[dof]);
        }
    }

    /// The difference of a vector at two nodes.
    fn along(&self, [a, b]: [usize; 2], value: impl Fn(usize) -> f64) -> [f64; 3] {
        let d = self.dimension;
        let at = |node: usize| {
            std::array::from_fn(|axis| if axis < d { value(node * d + axis) } else { 0.0 })
        };
        difference(&at(a), &at(b))
    }

    /// The rows R of a step of the parameter `gamma`.
    pub(super) fn rows(&self, gamma: f64, alpha: f64, rows: &mut Vec<[f64; 3]>) {
        let decay = 1.0 + alpha * gamma;
        let factors = [decay * decay, 2.0 * gamma * decay, gamma * gamma];
        rows.clear();
        let all = self.arms.iter().zip(&self.rates).zip(&self.accelerations);
        rows.extend(all.map(|((x, rate), acceleration)| {
            std::array::from_fn(|i| {
                factors[0] * x[i] + factors[1] * rate[i] + factors[2] * acceleration[i]
            })
        }));
    }

    /// What a Newton step is to make of R xv, given the residuals `ru`, `rv` and that of the demands: G rv - gamma
    /// (x'' + 2 alpha x' + alpha^2 x) ru + `share` demands.
    pub(super) fn newton_demands(
        &self,
        [gamma, alpha, share]: [f64; 3],
        [ru, rv]: [&[f64]; 2],
        demands: &mut [f64],
    ) {
        for (k, Edge { nodes, .. }) in self.list.iter().enumerate() {
            let [su, sv] = [ru, rv].map(|r| self.along(*nodes, |dof| r[dof]));
            let (x, rate, acceleration) = (&self.arms[k], &self.rates[k], &self.accelerations[k]);
            let lag =
                dot(acceleration, &su) + 2.0 * alpha * dot(rate, &su) + alpha * alpha * dot(x, &su);
            demands[k] = dot(x, &sv) + share * self.demands[k] - gamma * lag;
        }
    }

    /// Adds -df/du of the forces of the multipliers to `stiffness`.
    pub(super) fn add_tangents(&self, stiffness: &mut BlockMatrix) {
        let d = self.dimension;
        for (Edge { nodes: [a, b], .. }, multiplier) in self.list.iter().zip(&self.multipliers) {
            for (row, column, sign) in [(a, a, -1.0), (b, b, -1.0), (a, b, 1.0), (b, a, 1.0)] {
                let Some(block) = stiffness.block_mut(*row, *column) else { continue };
                (0..d).for_each(|axis| block[axis * d + axis] += sign * multiplier);
            }
        }
    }

    /// Largest difference of the length of an edge from what it was (m).
    pub(super) fn drift(&self, u: &[f64]) -> f64 {
        let drift = |Edge { nodes, square }: &Edge| {
            let x = self.along(*nodes, |dof| self.positions[dof] + u[dof]);
            (dot(&x, &x).sqrt() - square.sqrt()).abs()
        };
        self.list.iter().map(drift).fold(0.0, f64::max)
    }
}

/// What solves systems with X under the constraints of edges.
pub(super) struct EdgeSolver {
    dimension: usize,
    /// For each edge the first columns of Z of its nodes, and its degrees of freedom among the free ones.
    ends: Vec<[usize; 2]>,
    places: Vec<[usize; 2]>,
    /// Z, one column per degree of freedom of a frame, and its part that the general rows hold.
    pub(super) frames: Vec<usize>,
    pub(super) z: Mat<f64>,
    pub(super) of_rows: Mat<f64>,
    pieces: Vec<Piece>,
    rows: Vec<[f64; 3]>,
    columns: Vec<[f64; 3]>,
    /// What R x is to be, and the multipliers that make it so.
    pub(super) demands: Vec<f64>,
    pub(super) multipliers: Vec<f64>,
    /// G^T multipliers at the frames.
    pull: Vec<f64>,
}

/// Edges that feel each other through X, with their factorized small matrix.
struct Piece {
    edges: Vec<usize>,
    lu: Mat<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
    right: Vec<f64>,
    memory: MemBuffer,
}

impl Piece {
    fn new(edges: Vec<usize>) -> Self {
        let count = edges.len();
        let memory = MemBuffer::new(faer::dyn_stack::StackReq::any_of(&[
            lu_in_place_scratch::<usize, f64>(count, count, Par::Seq, Spec::default()),
            solve_in_place_scratch::<usize, f64>(count, 1, Par::Seq),
        ]));
        Self {
            edges,
            lu: Mat::zeros(count, count),
            forward: vec![0; count],
            backward: vec![0; count],
            right: vec![0.0; count],
            memory,
        }
    }
}

impl EdgeSolver {
    /// For edges between nodes whose degrees of freedom are at the given `position` among the free ones; `general` is
    /// the number of general rows.
    pub(super) fn new(
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
            frames,
            pieces: Vec::new(),
            rows: vec![[0.0; 3]; edges.len()],
            columns: vec![[0.0; 3]; edges.len()],
            demands: vec![0.0; edges.len()],
            multipliers: vec![0.0; edges.len()],
            pull: vec![0.0; count],
        }
    }

    /// Finds which edges feel each other, once Z is set.
    pub(super) fn divide(&mut self) {
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

    /// Sets R and G.
    pub(super) fn turn(&mut self, edges: &Edges, step: Option<[f64; 2]>) {
        self.columns.copy_from_slice(&edges.arms);
        match step {
            Some([gamma, alpha]) => edges.rows(gamma, alpha, &mut self.rows),
            None => self.rows.copy_from_slice(&edges.arms),
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        for Piece { edges, lu, forward, backward, memory, .. } in &mut pieces {
            for (i, &row) in edges.iter().enumerate() {
                for (j, &column) in edges.iter().enumerate() {
                    lu[(i, j)] = self.entry(row, column);
                }
            }
            let stack = MemStack::new(memory);
            lu_in_place(lu.as_mut(), forward, backward, Par::Seq, stack, Spec::default());
        }
        self.pieces = pieces;
    }

    /// Which edges do not follow from the constraints of the general rows and the edges before them.
    pub(super) fn independent(&mut self, edges: &Edges) -> Vec<bool> {
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

    /// The scale of the entry of an edge: that of its nodes by themselves, which are light.
    fn largest(&self, edge: usize) -> f64 {
        let square = dot(&self.columns[edge], &self.columns[edge]);
        let all = self.frames.iter().enumerate().map(|(column, &at)| self.z[(at, column)].abs());
        square * all.fold(0.0, f64::max)
    }

    /// Corrects the solution `x` = X^-1 f, and the multipliers `mu` of the general rows `numbers`, by the multipliers that
    /// the demands require.
    pub(super) fn correct(
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
            pull,
            ..
        } = self;
        pull.fill(0.0);
        for Piece { edges, lu, forward, backward, right, memory } in pieces {
            for (right, &k) in right.iter_mut().zip(&*edges) {
                let ([a, b], r) = (places[k], &rows[k]);
                let along: f64 = (0..*d).map(|i| r[i] * (x[a + i] - x[b + i])).sum();
                *right = demands[k] - along;
            }
            let count = right.len();
            solve_in_place(
                lu.as_ref(),
                lu.as_ref(),
                PermRef::new_checked(forward, backward, count),
                MatMut::from_column_major_slice_mut(right, count, 1),
                Par::Seq,
                MemStack::new(memory),
            );
            for (multiplier, &k) in right.iter().zip(&*edges) {
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
