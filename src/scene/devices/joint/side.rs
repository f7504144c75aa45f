//! Sides of a joint: points and directions that move with some nodes, or with the world.
//!
//! Points and vectors of a side are linear combinations of its nodes (natural coordinates),
//!
//! ```text
//! x(u) = X + sum c_i u_i,   sum c_i = 1 of a point, 0 of a vector,   sum c_i X_i = X,
//! ```
//!
//! with the coefficients of the least norm. They are exact on rigid bodies, whose frames have them all. A cross section of a rod has vectors in its
//! plane, a face of a solid those along the face, with its mean stretch.

use nalgebra::{Matrix3, Vector3};

use crate::base::input::InputError;
use crate::base::vector::padded;
use crate::elements::body::Body;
use crate::elements::mesh::Selection;

/// Name of the side that is fixed in space.
const WORLD: &str = "world";

/// Whether a side is fixed in space.
pub(super) fn is_world(selection: &Selection) -> bool {
    matches!(selection, Selection::Set(name) if name == WORLD)
}

/// Squares of extents below this, relative to the largest, are round-off: nodes lie in a plane or on a line.
const FLAT: f64 = 1e-9;

/// Distance, relative to the size of a side, from which on a point or a vector is none of the side.
const BESIDE: f64 = 1e-6;

/// A point, or a vector, that moves with nodes.
#[derive(Debug, Clone)]
pub(super) struct NodalVector {
    /// Itself in the undeformed shape (m).
    pub(super) natural: Vector3<f64>,
    /// Nodes (from 0) with their coefficients.
    pub(super) terms: Vec<(usize, f64)>,
}

impl NodalVector {
    /// A vector that does not move.
    pub(super) fn constant(natural: Vector3<f64>) -> Self {
        Self { natural, terms: Vec::new() }
    }

    /// Its change with nodal vectors `x`, displacements or velocities, `dimension` components each.
    pub(super) fn change(&self, x: &[f64], dimension: usize) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        for &(node, c) in &self.terms {
            let own = &x[node * dimension..][..dimension];
            own.iter().enumerate().for_each(|(i, x)| sum[i] += c * x);
        }
        sum
    }

    /// Itself under the displacements `u` (m).
    pub(super) fn at(&self, u: &[f64], dimension: usize) -> Vector3<f64> {
        self.natural + self.change(u, dimension)
    }
}

/// One side of a joint.
pub(super) struct Side {
    /// The nodes (from 0) whose combinations are points of it; none of the world.
    nodes: Vec<usize>,
    /// Their undeformed positions from their mean (m).
    arms: Vec<Vector3<f64>>,
    mean: Vector3<f64>,
    /// Orthonormal directions of the vectors that it has.
    pub(super) span: Vec<Vector3<f64>>,
    /// Pseudo-inverse of sum r r^T over the arms (m^-2).
    inverse: Matrix3<f64>,
    /// Root of the largest mean square extent (m); infinite of the world.
    pub(super) size: f64,
    label: String,
}

impl Side {
    /// The side of the nodes that `selection` names; `input` is where that was given.
    ///
    /// # Errors
    /// Nodes that do not exist, or that belong to several rigid pieces.
    pub(super) fn new(body: &Body, selection: &Selection, input: &str) -> Result<Self, InputError> {
        let dimension = body.dimension();
        let label = selection.to_string();
        if is_world(selection) {
            let span = (0..dimension).map(|i| Vector3::ith(i, 1.0)).collect();
            return Ok(Self {
                nodes: Vec::new(),
                arms: Vec::new(),
                mean: Vector3::zeros(),
                span,
                inverse: Matrix3::zeros(),
                size: f64::INFINITY,
                label,
            });
        }
        let nodes = match selection {
            // the name of a single body is no set of its mesh
            Selection::Set(name) if body.name() == Some(name) => {
                (0..body.mesh().node_count()).collect()
            }
            _ => body.mesh().select(selection)?,
        };
        let nodes = match (rigid_frame(body, &nodes, input, &label)?, body.sections_at(&nodes)) {
            (Some(frame), _) => frame,
            (None, Some(sections)) => {
                sections.iter().flat_map(|section| section.nodes()).copied().collect()
            }
            (None, None) => nodes,
        };
        let positions: Vec<Vector3<f64>> =
            nodes.iter().map(|&node| padded(body.mesh().position(node)).into()).collect();
        let mean = positions.iter().sum::<Vector3<f64>>() / nodes.len() as f64;
        let arms: Vec<Vector3<f64>> = positions.iter().map(|x| x - mean).collect();
        let spread: Matrix3<f64> = arms.iter().map(|r| r * r.transpose()).sum();
        let eigen = spread.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let (mut span, mut inverse) = (Vec::new(), Matrix3::zeros());
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > FLAT * largest {
                span.push(direction.into_owned());
                inverse += direction * direction.transpose() / *value;
            }
        }
        let size = (largest / nodes.len() as f64).sqrt();
        Ok(Self { nodes, arms, mean, span, inverse, size, label })
    }

    /// Whether it is fixed in space.
    pub(super) fn is_world(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Whether it shares a node with the other one.
    pub(super) fn meets(&self, other: &Self) -> bool {
        self.nodes.iter().any(|node| other.nodes.contains(node))
    }

    /// The point of it whose undeformed position is `at` (m).
    ///
    /// # Errors
    /// A point that is no combination of its nodes.
    pub(super) fn point(&self, at: Vector3<f64>, input: &str) -> Result<NodalVector, InputError> {
        if self.is_world() {
            return Ok(NodalVector::constant(at));
        }
        let share = (self.nodes.len() as f64).recip();
        let (gradient, off) = self.gradient(at - self.mean);
        if off > BESIDE * (self.size + at.norm()) {
            let help = format!(
                "it is {off:.3e} m beside the plane, the line or the point of the nodes of {}: a place on them is needed",
                self.label
            );
            let value = format!("{:?} m", [at.x, at.y, at.z]);
            return Err(InputError::new(input, value, help));
        }
        let terms = self.nodes.iter().zip(&self.arms);
        let terms = terms.map(|(&node, arm)| (node, share + gradient.dot(arm)));
        Ok(NodalVector { natural: at, terms: without_round_off(terms) })
    }

    /// The vector of it that is `vector` in the undeformed shape, if it has that.
    pub(super) fn vector(&self, vector: Vector3<f64>) -> Option<NodalVector> {
        if self.is_world() {
            return Some(NodalVector::constant(vector));
        }
        let (gradient, off) = self.gradient(vector);
        let terms = self.nodes.iter().zip(&self.arms);
        let terms = terms.map(|(&node, arm)| (node, gradient.dot(arm)));
        (off <= BESIDE * vector.norm())
            .then(|| NodalVector { natural: vector, terms: without_round_off(terms) })
    }

    /// A unit vector of it across the `axis`, if it has one.
    pub(super) fn across(&self, axis: Vector3<f64>) -> Option<NodalVector> {
        let along: Vec<f64> = self.span.iter().map(|direction| direction.dot(&axis)).collect();
        let squares: f64 = along.iter().map(|x| x * x).sum();
        // of the directions of the span, the one that is least along the axis, without what is left of it
        let least = (0..along.len()).min_by(|&a, &b| along[a].abs().total_cmp(&along[b].abs()))?;
        let mut across = self.span[least];
        if squares > BESIDE {
            for (direction, part) in self.span.iter().zip(&along) {
                across -= direction * (along[least] * part / squares);
            }
        }
        self.vector(across.try_normalize(BESIDE)?)
    }

    /// The g of the coefficients g . r that combine the arms r to a vector, and how far they miss it (m).
    fn gradient(&self, vector: Vector3<f64>) -> (Vector3<f64>, f64) {
        let gradient = self.inverse * vector;
        let reached: Vector3<f64> = self.arms.iter().map(|arm| arm * arm.dot(&gradient)).sum();
        (gradient, (reached - vector).norm())
    }
}

/// The coefficients that are not 0.
fn without_round_off(terms: impl Iterator<Item = (usize, f64)> + Clone) -> Vec<(usize, f64)> {
    let largest = terms.clone().fold(0.0_f64, |most, (_, c)| most.max(c.abs()));
    terms.filter(|(_, c)| c.abs() > 1e-12 * largest).collect()
}

/// The nodes of the frame of a rigid piece, if all `nodes` belong to it.
///
/// # Errors
/// Nodes of several pieces.
fn rigid_frame(
    body: &Body,
    nodes: &[usize],
    input: &str,
    label: &str,
) -> Result<Option<Vec<usize>>, InputError> {
    let Some(rigid) = body.rigid_pieces() else { return Ok(None) };
    if !nodes.iter().all(|&node| rigid.contains(node)) {
        return Ok(None);
    }
    let frame_of = |&node: &usize| {
        let (first, _) = rigid.shares(node).next()?;
        rigid.frames().iter().find(|frame| frame.contains(&first))
    };
    let frame = nodes.first().and_then(frame_of);
    if nodes.iter().any(|node| frame_of(node) != frame) {
        let help = "its nodes belong to several rigid pieces: name those of one";
        return Err(InputError::new(input, label, help));
    }
    Ok(frame.cloned())
}
