//! Rigid pieces: nodes that follow those of a frame.
//!
//! The displacements of the nodes of a rigid piece are affine functions of their undeformed positions x, and so
//! weighted means of those of d + 1 nodes of it, its frame:
//!
//! ```text
//! u_i = sum_a w_ia u_a,   sum_a w_ia = 1,   sum_a w_ia x_a = x_i
//! ```
//!
//! M is constant with them (natural coordinates). The only motion besides the rigid one is a uniform
//! strain. The edges of the frame keep it at 0, as constraints of the motion
//! (`dynamics/linear/edges.rs`), and in equilibria the elasticity of the piece keeps it small.
//!
//! The frame spans a large simplex, each node the farthest from the span of those before it, so that no weight
//! is large. Dependent nodes remain in the state with their own u and v: forces, contact, sensors, samples and
//! checkpoints treat them as any node. Only the linear algebra has pieces: `shares` are
//! the weights, `carry` moves dependent nodes with their frames, `gather` moves nodal forces to the frames, where they do
//! the same work. The elasticity of a piece in equilibria is a force that motions omit
//! (`Capabilities::keeps_rigid`). `docs/decisions/0012-rigid-pieces.md` has the alternatives.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};

use crate::base::input::InputError;
use crate::base::sparse::NodePattern;
use crate::base::vector::{dot, largest, norm};
use crate::elements::mesh::Mesh;

/// Shares below this are round-off.
const NO_SHARE: f64 = 1e-13;

/// Largest distortion of rigid pieces that counts as round-off, relative to a typical size of the displacements or velocities.
const MOST_DISTORTED: f64 = 1e-9;

/// The nodes of all rigid pieces.
#[derive(Debug)]
pub(crate) struct RigidPieces {
    dimension: usize,
    /// Whether a node belongs to a piece, and the number of it among the dependent ones.
    kinds: Vec<Kind>,
    dependent: Vec<Dependent>,
    /// The nodes of each frame.
    frames: Vec<Vec<usize>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Free,
    Frame,
    Dependent(usize),
}

/// A node that moves with those of a frame.
#[derive(Debug)]
struct Dependent {
    node: usize,
    /// Nodes of the frame with their shares.
    shares: Vec<(usize, f64)>,
}

/// The nodes of each connected piece of some cells.
fn connected(mesh: &Mesh, cells: &[usize]) -> Vec<Vec<usize>> {
    let mut is_rigid = vec![false; mesh.cell_count()];
    cells.iter().for_each(|&cell| is_rigid[cell] = true);
    let rigid = mesh.cells().zip(is_rigid).filter(|(_, is_rigid)| *is_rigid);
    let cells: Vec<&[usize]> = rigid.map(|(nodes, _)| nodes).collect();
    let pieces = NodePattern::new(mesh.node_count(), cells.iter().copied()).pieces();
    let mut nodes = vec![BTreeSet::new(); pieces.iter().max().map_or(0, |last| last + 1)];
    for &node in cells.into_iter().flatten() {
        nodes[pieces[node]].insert(node);
    }
    nodes.into_iter().filter(|nodes| !nodes.is_empty()).map(Vec::from_iter).collect()
}

impl RigidPieces {
    /// Those that the rigid `cells` (numbers from 0) of a mesh make, if there are any.
    pub(super) fn of(mesh: &Mesh, cells: &[usize]) -> Option<Self> {
        if cells.is_empty() {
            return None;
        }
        let kinds = vec![Kind::Free; mesh.node_count()];
        let dimension = mesh.dimension();
        let mut pieces = Self { dimension, kinds, dependent: Vec::new(), frames: Vec::new() };
        connected(mesh, cells).iter().for_each(|nodes| pieces.add(mesh, nodes));
        Some(pieces)
    }

    fn add(&mut self, mesh: &Mesh, nodes: &[usize]) {
        let frame = frame(mesh, nodes);
        let d = self.dimension;
        let origin = mesh.position(frame[0]);
        let arm = |node: usize, i: usize| mesh.position(node)[i] - origin[i];
        let edges = DMatrix::from_fn(d, d, |i, a| arm(frame[a + 1], i)).lu();
        frame.iter().for_each(|&node| self.kinds[node] = Kind::Frame);
        for &node in nodes.iter().filter(|node| !frame.contains(node)) {
            // cells have a volume, so that the edges are no multiples of each other
            let place = edges.solve(&DVector::from_fn(d, |i, _| arm(node, i)));
            let place = place.unwrap_or_else(|| DVector::zeros(d));
            let shares = std::iter::once(1.0 - place.sum()).chain(place.iter().copied());
            let shares = frame.iter().copied().zip(shares).filter(|(_, w)| w.abs() > NO_SHARE);
            self.kinds[node] = Kind::Dependent(self.dependent.len());
            self.dependent.push(Dependent { node, shares: shares.collect() });
        }
        self.frames.push(frame);
    }

    /// The nodes of each frame, which move by themselves.
    pub(crate) fn frames(&self) -> &[Vec<usize>] {
        &self.frames
    }

    /// Number of nodes that move with others.
    pub(crate) fn dependent_nodes(&self) -> usize {
        self.dependent.len()
    }

    /// Whether a node belongs to a rigid piece.
    pub(crate) fn contains(&self, node: usize) -> bool {
        self.kinds[node] != Kind::Free
    }

    /// Whether a node moves with those of a frame.
    pub(crate) fn is_dependent(&self, node: usize) -> bool {
        matches!(self.kinds[node], Kind::Dependent(_))
    }

    /// The nodes by which a node moves, with their shares: itself if it is independent.
    pub(crate) fn shares(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        let (own, others) = match self.kinds[node] {
            Kind::Dependent(number) => (None, &self.dependent[number].shares[..]),
            _ => (Some((node, 1.0)), &[][..]),
        };
        own.into_iter().chain(others.iter().copied())
    }

    /// Moves dependent nodes as their frames move in `x`, of displacements or velocities.
    pub(crate) fn carry(&self, x: &mut [f64]) {
        let d = self.dimension;
        for Dependent { node, shares } in &self.dependent {
            for axis in 0..d {
                x[node * d + axis] = shares.iter().map(|(a, w)| w * x[a * d + axis]).sum();
            }
        }
    }

    /// Writes by how much `x`, displacements or velocities, differ from those of rigid pieces that move as their frames
    /// do.
    pub(crate) fn stray(&self, x: &[f64], stray: &mut [f64]) {
        stray.fill(0.0);
        self.replace_by_strays(x, stray);
    }

    /// Writes by how much the dependent nodes differ in `x`, as [`stray`](Self::stray), and leaves `values` of others as
    /// they are.
    pub(crate) fn replace_by_strays(&self, x: &[f64], values: &mut [f64]) {
        let d = self.dimension;
        for (node, shares) in self.dependents() {
            for axis in 0..d {
                let carried: f64 = shares.iter().map(|(a, w)| w * x[a * d + axis]).sum();
                values[node * d + axis] = x[node * d + axis] - carried;
            }
        }
    }

    /// The nodes that move with others: each with those of its frame and their shares.
    pub(crate) fn dependents(&self) -> impl Iterator<Item = (usize, &[(usize, f64)])> {
        self.dependent.iter().map(|Dependent { node, shares }| (*node, &shares[..]))
    }

    /// Deviation of `x`, displacements or velocities, from those of rigid pieces that move as their frames do: the
    /// largest component.
    pub(crate) fn distortion(&self, x: &[f64]) -> f64 {
        let mut stray = vec![0.0; x.len()];
        self.stray(x, &mut stray);
        largest(&stray)
    }

    /// Refuses displacements (m) or velocities (m/s) that are not of this kind; `scale` is a typical size of them.
    pub(crate) fn check(
        &self,
        input: &str,
        x: &[f64],
        unit: &str,
        scale: f64,
    ) -> Result<(), InputError> {
        let off = self.distortion(x);
        if off <= MOST_DISTORTED * scale {
            return Ok(());
        }
        let help = "rigid pieces keep their shape: move each as a whole";
        Err(InputError::new(input, format!("{off:.3e} {unit} off in a rigid piece"), help))
    }

    /// Moves nodal forces `f` from dependent nodes to their frames, where they do the same work.
    pub(crate) fn gather(&self, f: &mut [f64]) {
        let d = self.dimension;
        for Dependent { node, shares } in &self.dependent {
            for axis in 0..d {
                let force = std::mem::take(&mut f[node * d + axis]);
                shares.iter().for_each(|(a, w)| f[a * d + axis] += w * force);
            }
        }
    }

    /// The pairs of nodes that are coupled where dependent nodes are coupled by `pattern`, as far as it lacks
    /// them.
    pub(crate) fn couplings(&self, pattern: &NodePattern) -> Vec<[usize; 2]> {
        let mut pairs = BTreeSet::new();
        for Dependent { node, .. } in &self.dependent {
            for (_, other) in pattern.row(*node) {
                for (a, _) in self.shares(*node) {
                    for (b, _) in self.shares(other).filter(|(b, _)| pattern.find(a, *b).is_none())
                    {
                        pairs.insert([a.min(b), a.max(b)]);
                    }
                }
            }
        }
        pairs.into_iter().collect()
    }
}

/// d + 1 of the nodes that span a large simplex, so that no node has large shares: each is the farthest from the span of those
/// before it.
fn frame(mesh: &Mesh, nodes: &[usize]) -> Vec<usize> {
    let d = mesh.dimension();
    let mut centre = vec![0.0; d];
    for &node in nodes {
        let x = mesh.position(node);
        centre.iter_mut().zip(x).for_each(|(sum, x)| *sum += x / nodes.len() as f64);
    }
    let from = |node: usize, origin: &[f64]| -> Vec<f64> {
        mesh.position(node).iter().zip(origin).map(|(x, o)| x - o).collect()
    };
    let mut frame: Vec<usize> = Vec::with_capacity(d + 1);
    let mut directions: Vec<Vec<f64>> = Vec::new();
    while frame.len() <= d {
        let origin = frame.first().map_or(&centre[..], |&first| mesh.position(first));
        let beside = |node: usize| {
            let mut arm = from(node, origin);
            for direction in &directions {
                let part = dot(direction, &arm);
                arm.iter_mut().zip(direction).for_each(|(x, e)| *x -= part * e);
            }
            arm
        };
        let far = |&&a: &&usize, &&b: &&usize| norm(&beside(a)).total_cmp(&norm(&beside(b)));
        let Some(&next) = nodes.iter().max_by(far) else { break };
        if !frame.is_empty() {
            let arm = beside(next);
            let length = norm(&arm);
            directions.push(arm.into_iter().map(|x| x / length).collect());
        }
        frame.push(next);
    }
    frame
}
