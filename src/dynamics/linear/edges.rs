//! Edges of rigid pieces: constant distances between the nodes of their frames.
//!
//! The frame of a piece (`elements/body/rigid.rs`) is a simplex, whose 3 edges in the plane, 6 in space, are the lengths that rigid
//! motion leaves unchanged (natural coordinates: J. García de Jalón, E. Bayo, "Kinematic and Dynamic Simulation
//! of Multibody Systems", Springer 1994). An edge x from one node to another, of the length L, is a constraint
//! that is stabilized like all others,
//!
//! ```text
//! g = (x.x - L^2)/2 = 0,   x.x'' = -x'.x' - 2 alpha x.x' - alpha^2 g
//! ```
//!
//! with a multiplier whose force acts along x at both nodes. `edge_solver.rs` finds the multipliers.
//!
//! Constraints on nodes of rigid pieces are general rows, written for the independent displacements, even
//! where they hold one component; those that follow from others because nodes move together are omitted
//! (`scene/constraint/resolve.rs`), and nodes that would have to leave each other are an error. Edges that
//! follow from held nodes and from other edges have no pivot at the start of a phase, and are omitted; if
//! nodes can then be moved apart, the phase is refused (`tears_apart`).

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, norm};
use crate::elements::body::RigidPieces;

/// An edge of a frame between two nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Edge {
    pub(crate) nodes: [usize; 2],
    /// Itself in the undeformed body (m).
    natural: [f64; 3],
}

impl Edge {
    /// Itself under the displacements `u` (m).
    fn at(&self, u: &[f64], dimension: usize) -> [f64; 3] {
        let apart = difference_at(self.nodes, dimension, u);
        std::array::from_fn(|i| self.natural[i] + apart[i])
    }

    /// The difference of a vector, `dimension` components per node, at its nodes.
    pub(crate) fn apart(&self, values: &[f64], dimension: usize) -> [f64; 3] {
        difference_at(self.nodes, dimension, values)
    }

    /// L^2/2 (m^2).
    pub(crate) fn half_square(&self) -> f64 {
        0.5 * dot(&self.natural, &self.natural)
    }
}

/// The difference of a vector, `dimension` components per node, at two nodes.
fn difference_at([a, b]: [usize; 2], dimension: usize, values: &[f64]) -> [f64; 3] {
    let apart = |axis: usize| values[a * dimension + axis] - values[b * dimension + axis];
    std::array::from_fn(|axis| if axis < dimension { apart(axis) } else { 0.0 })
}

/// The factors of x, x' and x'' in R, in a step of the parameter `gamma` (s) with the stabilization rate `alpha` (1/s).
pub(crate) fn stabilized(gamma: f64, alpha: f64) -> [f64; 3] {
    let decay = 1.0 + alpha * gamma;
    [decay * decay, 2.0 * gamma * decay, gamma * gamma]
}

/// All edges in a state, with the requirements of the stabilization.
#[derive(Debug, Clone, Default)]
pub(crate) struct Edges {
    pub(crate) list: Vec<Edge>,
    /// Those that follow from constraints and the others, and are no constraints themselves.
    implied: Vec<Edge>,
    dimension: usize,
    /// x, x', x'' of each, then of those that are implied.
    pub(crate) arms: Vec<[f64; 3]>,
    rates: Vec<[f64; 3]>,
    accelerations: Vec<[f64; 3]>,
    /// x.x'' of each.
    pub(crate) demands: Vec<f64>,
    /// Force over length of each (N/m), above 0 where it presses.
    pub(crate) multipliers: Vec<f64>,
}

impl Edges {
    pub(crate) fn new(rigid: Option<&RigidPieces>, positions: &[f64], dimension: usize) -> Self {
        let Some(rigid) = rigid else { return Self::default() };
        let mut list = Vec::new();
        for frame in rigid.frames() {
            for (k, &a) in frame.iter().enumerate() {
                list.extend(frame[..k].iter().map(|&b| Edge {
                    nodes: [a, b],
                    natural: difference_at([a, b], dimension, positions),
                }));
            }
        }
        Self::of([list, Vec::new()], dimension)
    }

    fn of([list, implied]: [Vec<Edge>; 2], dimension: usize) -> Self {
        let none = vec![[0.0; 3]; list.len() + implied.len()];
        Self {
            dimension,
            arms: list.iter().chain(&implied).map(|edge| edge.natural).collect(),
            rates: none.clone(),
            accelerations: none,
            demands: vec![0.0; list.len()],
            multipliers: vec![0.0; list.len()],
            list,
            implied,
        }
    }

    /// The edges of which `is_kept` is true as constraints, the others as implied ones.
    pub(crate) fn retained(&self, is_kept: &[bool]) -> Self {
        let (kept, implied): (Vec<_>, Vec<_>) =
            self.list.iter().zip(is_kept).partition(|(_, is_kept)| **is_kept);
        let edges = [kept, implied].map(|part| part.into_iter().map(|(edge, _)| *edge).collect());
        Self::of(edges, self.dimension)
    }

    /// All edges, those that are implied last, as in [`arms`](Self::arms).
    pub(crate) fn all(&self) -> impl Iterator<Item = &Edge> {
        self.list.iter().chain(&self.implied)
    }

    /// Becomes the same as the `other` ones of the same list.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.arms.copy_from_slice(&other.arms);
        self.rates.copy_from_slice(&other.rates);
        self.accelerations.copy_from_slice(&other.accelerations);
        self.multipliers.copy_from_slice(&other.multipliers);
    }

    /// Moves on to displacements `u` (m) and velocities `v` (m/s), with the stabilization rate `alpha` (1/s).
    pub(crate) fn move_to(&mut self, alpha: f64, u: &[f64], v: &[f64]) {
        for (k, edge) in self.list.iter().chain(&self.implied).enumerate() {
            let (x, rate) =
                (edge.at(u, self.dimension), difference_at(edge.nodes, self.dimension, v));
            let off = 0.5 * (dot(&x, &x) - dot(&edge.natural, &edge.natural));
            if let Some(demand) = self.demands.get_mut(k) {
                *demand = -dot(&rate, &rate) - 2.0 * alpha * dot(&x, &rate) - alpha * alpha * off;
            }
            (self.arms[k], self.rates[k]) = (x, rate);
        }
    }

    /// Moves the edges on to displacements `u` (m), without their rates.
    pub(crate) fn place(&mut self, u: &[f64]) {
        for (arm, edge) in self.arms.iter_mut().zip(self.list.iter().chain(&self.implied)) {
            *arm = edge.at(u, self.dimension);
        }
    }

    /// g and its rate at the displacements `u` (m) and velocities `v` (m/s), edge by edge.
    pub(crate) fn remainders(&self, u: &[f64], v: &[f64]) -> impl Iterator<Item = [f64; 2]> {
        self.list.iter().map(move |edge| {
            let x = edge.at(u, self.dimension);
            let off = 0.5 * dot(&x, &x) - edge.half_square();
            [off, dot(&x, &edge.apart(v, self.dimension))]
        })
    }

    /// Whether one of them changes its length faster than by `least` (m/s).
    pub(crate) fn stretches(&self, least: f64) -> bool {
        let along = |(x, rate): (&[f64; 3], &[f64; 3])| dot(x, rate).abs() > least * norm(x);
        self.arms.iter().zip(&self.rates).any(along)
    }

    /// Takes the accelerations `a` (m/s^2).
    pub(crate) fn accelerate(&mut self, a: &[f64]) {
        for (k, Edge { nodes, .. }) in self.list.iter().chain(&self.implied).enumerate() {
            self.accelerations[k] = difference_at(*nodes, self.dimension, a);
        }
    }

    /// The rows R of a step, with the `factors` of x, x' and x''.
    pub(crate) fn rows(&self, factors: [f64; 3], rows: &mut Vec<[f64; 3]>) {
        rows.clear();
        let all = self.arms.iter().zip(&self.rates).zip(&self.accelerations);
        rows.extend(all.map(|((x, rate), acceleration)| {
            std::array::from_fn(|i| {
                factors[0] * x[i] + factors[1] * rate[i] + factors[2] * acceleration[i]
            })
        }));
    }

    /// Right-hand side of R xv in a Newton step, given the residuals `ru`, `rv` and that of the demands: G rv - gamma
    /// (x'' + 2 alpha x' + alpha^2 x) ru + `share` demands.
    pub(crate) fn newton_demands(
        &self,
        [gamma, alpha, share]: [f64; 3],
        [ru, rv]: [&[f64]; 2],
        demands: &mut [f64],
    ) {
        for (k, Edge { nodes, .. }) in self.list.iter().enumerate() {
            let [su, sv] = [ru, rv].map(|r| difference_at(*nodes, self.dimension, r));
            let lag = self.lag(k, alpha, &su);
            demands[k] = dot(&self.arms[k], &sv) + share * self.demands[k] - gamma * lag;
        }
    }

    /// (x'' + 2 alpha x' + alpha^2 x).s of the edge `k`.
    fn lag(&self, k: usize, alpha: f64, s: &[f64; 3]) -> f64 {
        let (x, rate, acceleration) = (&self.arms[k], &self.rates[k], &self.accelerations[k]);
        dot(acceleration, s) + 2.0 * alpha * dot(rate, s) + alpha * alpha * dot(x, s)
    }

    /// Right-hand side of R xv in a Newton step of the DAE form of index 1, given `ru`, the residuals of displacements
    /// times gamma, and the residuals of the edges.
    pub(crate) fn index_one_demands(
        &self,
        [gamma, alpha]: [f64; 2],
        ru: &[f64],
        residuals: &[f64],
        demands: &mut [f64],
    ) {
        for (k, edge) in self.list.iter().enumerate() {
            let lag = self.lag(k, alpha, &edge.apart(ru, self.dimension));
            demands[k] = gamma * (residuals[k] - lag);
        }
    }

    /// x'.s of each edge.
    pub(crate) fn turned(&self, s: &[f64]) -> impl Iterator<Item = f64> {
        let all = self.list.iter().zip(&self.rates);
        all.map(move |(edge, rate)| dot(rate, &edge.apart(s, self.dimension)))
    }

    /// x.x'' less its value required by the stabilization, edge by edge (m^2/s^2).
    pub(crate) fn imbalances(&self) -> impl Iterator<Item = f64> {
        let all = self.arms.iter().zip(&self.accelerations).zip(&self.demands);
        all.map(|((x, acceleration), demand)| dot(x, acceleration) - demand)
    }

    /// Subtracts G^T `multipliers` from nodal `forces`.
    pub(crate) fn subtract_pull(&self, multipliers: &[f64], forces: &mut [f64]) {
        let d = self.dimension;
        for ((Edge { nodes: [a, b], .. }, x), multiplier) in
            self.list.iter().zip(&self.arms).zip(multipliers)
        {
            for (axis, x) in x.iter().enumerate().take(d) {
                forces[a * d + axis] -= multiplier * x;
                forces[b * d + axis] += multiplier * x;
            }
        }
    }

    /// The derivatives of what [`imbalances`](Self::imbalances) has of the edge `k` by the displacements, and by the
    /// velocities in a step in which x'' changes by `cj` times as much as x'.
    #[cfg(test)]
    pub(crate) fn slopes(&self, k: usize, alpha: f64, cj: f64) -> [[f64; 3]; 2] {
        let (x, rate, acceleration) = (&self.arms[k], &self.rates[k], &self.accelerations[k]);
        [
            std::array::from_fn(|i| acceleration[i] + 2.0 * alpha * rate[i] + alpha * alpha * x[i]),
            std::array::from_fn(|i| (cj + 2.0 * alpha) * x[i] + 2.0 * rate[i]),
        ]
    }

    /// Adds -df/du of the forces of the multipliers to `stiffness`.
    pub(crate) fn add_tangents(&self, stiffness: &mut BlockMatrix) {
        let d = self.dimension;
        for (Edge { nodes: [a, b], .. }, multiplier) in self.list.iter().zip(&self.multipliers) {
            for (row, column, sign) in [(a, a, -1.0), (b, b, -1.0), (a, b, 1.0), (b, a, 1.0)] {
                let Some(block) = stiffness.block_mut(*row, *column) else { continue };
                (0..d).for_each(|axis| block[axis * d + axis] += sign * multiplier);
            }
        }
    }

    /// Largest change of the length of an edge (m).
    pub(crate) fn drift(&self, u: &[f64]) -> f64 {
        let drift = |edge: &Edge| (norm(&edge.at(u, self.dimension)) - norm(&edge.natural)).abs();
        self.list.iter().map(drift).fold(0.0, f64::max)
    }
}
