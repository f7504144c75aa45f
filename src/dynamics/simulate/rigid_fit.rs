//! The rigid motion that is nearest to that of some nodes.
//!
//! With weights w, undeformed positions X and present ones y = X + u of the nodes, both relative to their means, the
//! rotation R is that of the polar decomposition of sum w y X^T, and S = sum w y (R X)^T is symmetric. The rates of both
//! sides of that, with the angular velocity omega and its rate alpha:
//!
//! ```text
//! (tr(S) 1 - S) omega = b,             b = sum w R X x v
//! (tr(S) 1 - S) alpha = b' - (tr(S') 1 - S') omega
//! ```
//!
//! Of nodes that move as a rigid body, y = R X, these are inertia, angular momentum and its rate.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::view::View;
use crate::base::input::InputError;
use crate::base::rotation::{nearest_rotation, plane_rotation};
use crate::elements::body::Part;
use crate::elements::mesh::Mesh;

/// The least inertia about any axis, as a part of that about all, of nodes that determine a rotation.
const SLENDER: f64 = 1e-12;

/// Nodes with weights, by which a rotation is found.
pub(super) struct RigidFit {
    /// The nodes, counted from 0.
    nodes: Vec<usize>,
    /// Their undeformed positions relative to the mean, times their weights; they add up to 0.
    arms: Vec<[f64; 3]>,
    dimension: usize,
}

/// How nodes turn.
pub(super) struct Turning {
    pub(super) rotation: Matrix3<f64>,
    /// rad/s
    pub(super) velocity: Vector3<f64>,
    /// rad/s^2
    pub(super) acceleration: Vector3<f64>,
}

impl RigidFit {
    /// That of `nodes` (counted from 0), which count alike.
    ///
    /// # Errors
    /// Nodes that do not determine a rotation.
    pub(super) fn of_nodes(mesh: &Mesh, nodes: Vec<usize>) -> Result<Self, InputError> {
        let d = mesh.dimension();
        let middle = super::view::mean(&nodes, mesh.positions(), d);
        let arm = |node: &usize| {
            let x = at(mesh.positions(), *node, d);
            std::array::from_fn(|i| (x[i] - middle[i]) / nodes.len() as f64)
        };
        let arms = nodes.iter().map(arm).collect();
        Self { arms, nodes, dimension: d }.checked(mesh)
    }

    /// That of a body of `mesh`, all of whose mass counts alike.
    ///
    /// # Errors
    /// As [`of_nodes`](Self::of_nodes).
    pub(super) fn of_part(mesh: &Mesh, part: &Part) -> Result<Self, InputError> {
        let (nodes, arms) = (part.nodes.clone().collect(), part.body.arms());
        Self { nodes, arms, dimension: mesh.dimension() }.checked(mesh)
    }

    fn checked(self, mesh: &Mesh) -> Result<Self, InputError> {
        let help = match self.dimension {
            1 => "nothing turns on a line",
            2 => {
                "they are in one position, which does not determine a rotation: name nodes around it"
            }
            _ => {
                "they are on a line, which does not determine the rotation about it: name nodes off the line"
            }
        };
        let inertia = inertia(self.correlation(mesh.positions()), self.dimension);
        let is_slender = inertia.symmetric_eigenvalues().min() <= SLENDER * inertia.trace()
            || self.dimension == 1;
        match is_slender || inertia.trace() <= 0.0 {
            true => Err(InputError::new(
                "nodes of a rotation",
                format!("{} of them", self.nodes.len()),
                help,
            )),
            false => Ok(self),
        }
    }

    /// sum w y X^T, with y as `positions` says.
    fn correlation(&self, positions: &[f64]) -> Matrix3<f64> {
        let each = self.nodes.iter().zip(&self.arms);
        each.map(|(&node, arm)| {
            at(positions, node, self.dimension) * Vector3::from(*arm).transpose()
        })
        .sum()
    }

    fn positions(&self, view: &View) -> Vec<f64> {
        let natural = view.body().mesh().positions();
        natural.iter().zip(view.displacements()).map(|(x, u)| x + u).collect()
    }

    /// The angle (rad) by which nodes in the plane have turned, between -pi and pi.
    pub(super) fn angle(&self, view: &View) -> f64 {
        let (x, u) = (view.body().mesh().positions(), view.displacements());
        plane_rotation(self.nodes.iter().zip(&self.arms).map(|(node, &[a, b, _])| {
            ([a, b], [x[2 * node] + u[2 * node], x[2 * node + 1] + u[2 * node + 1]])
        }))
    }

    pub(super) fn rotation(&self, view: &View) -> Matrix3<f64> {
        match self.dimension {
            2 => *Rotation3::from_axis_angle(&Vector3::z_axis(), self.angle(view)).matrix(),
            _ => nearest_rotation(self.correlation(&self.positions(view))),
        }
    }

    /// The rotation as a vector along its axis (rad), of a length of at most pi.
    pub(super) fn rotation_vector(&self, view: &View) -> [f64; 3] {
        let rotation = Rotation3::from_matrix_unchecked(self.rotation(view));
        UnitQuaternion::from_rotation_matrix(&rotation).scaled_axis().into()
    }

    /// How the nodes turn; without accelerations in the `view` the angular one is NaN.
    pub(super) fn turning(&self, view: &View) -> Turning {
        let (d, rotation) = (self.dimension, self.rotation(view));
        let positions = self.positions(view);
        let carried: Vec<_> = self.arms.iter().map(|arm| rotation * Vector3::from(*arm)).collect();
        let each = || self.nodes.iter().zip(&carried);
        let moment = |x: &[f64]| -> Vector3<f64> {
            each().map(|(&node, arm)| arm.cross(&at(x, node, d))).sum()
        };
        let spread: Matrix3<f64> =
            each().map(|(&node, arm)| at(&positions, node, d) * arm.transpose()).sum();
        let lacking = Matrix3::repeat(f64::NAN);
        let inverse = inertia(spread, d).try_inverse().unwrap_or(lacking);
        let velocity = inverse * moment(view.velocities());
        let change = |(&node, arm): (&usize, &Vector3<f64>)| {
            let (y, v) = (at(&positions, node, d), at(view.velocities(), node, d));
            let turned = velocity.cross(arm);
            (v * arm.transpose() + y * turned.transpose(), turned.cross(&v))
        };
        let (spread, turned) = each()
            .map(change)
            .fold((Matrix3::zeros(), Vector3::zeros()), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        let gyration = (Matrix3::identity() * spread.trace() - spread) * velocity;
        let acceleration = match view.accelerations {
            [] => Vector3::repeat(f64::NAN),
            accelerations => inverse * (moment(accelerations) + turned - gyration),
        };
        Turning { rotation, velocity, acceleration }
    }
}

/// tr(S) 1 - S; in the plane only the axis across counts.
fn inertia(spread: Matrix3<f64>, dimension: usize) -> Matrix3<f64> {
    let inertia = Matrix3::identity() * spread.trace() - spread;
    match dimension {
        3 => inertia,
        _ => Matrix3::identity() * inertia.m33,
    }
}

/// The entries of a node, 0 beyond the dimension.
fn at(x: &[f64], node: usize, dimension: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i < dimension { x[node * dimension + i] } else { 0.0 })
}
