//! How places are read: by sums over nodes, and of markers by the rigid motion of theirs.

use nalgebra::Vector3;

use super::gauge::Gauge;
use super::output::Value;
use super::reading::Reading;
use super::rigid_fit::RigidFit;
use super::spot::{At, Motion, Spot};
use super::view::{View, mean};
use crate::base::input::{InputError, finite};
use crate::scene::timeline::Scene;

impl Motion {
    /// The reading of a place that moves by a sum over the values of nodes.
    fn of(self, view: &View, sum: impl Fn(&[f64]) -> [f64; 3]) -> [f64; 3] {
        match self {
            Self::Position => {
                let [natural, moved] =
                    [view.body().mesh().positions(), view.displacements()].map(sum);
                std::array::from_fn(|i| natural[i] + moved[i])
            }
            Self::Displacement => sum(view.displacements()),
            Self::Velocity => sum(view.velocities()),
            Self::Acceleration => match view.accelerations {
                [] => [f64::NAN; 3],
                accelerations => sum(accelerations),
            },
        }
    }
}

impl Reading {
    /// The function that reads the `motion` of a place.
    ///
    /// # Errors
    /// Nodes that do not exist; a point outside the body; a marker of nodes that do not determine its rotation.
    pub(super) fn of_spot(
        &self,
        scene: &Scene,
        spot: &Spot,
        motion: Motion,
    ) -> Result<Gauge, InputError> {
        let mesh = scene.body().mesh();
        let d = mesh.dimension();
        Ok(match &spot.0 {
            At::Nodes(nodes) => {
                let nodes = self.counted(mesh.select(nodes)?);
                Box::new(move |view, _| Value::Vector(motion.of(view, |x| mean(&nodes, x, d))))
            }
            At::Inside(place) => {
                let shares = scene.body().shares_at(place)?;
                Box::new(move |view, _| Value::Vector(motion.of(view, |x| shared(&shares, x, d))))
            }
            At::Marker(nodes, place) => {
                let nodes = mesh.select(nodes)?;
                finite("place of a marker", place)?;
                if place.len() != d {
                    let help = format!("it needs {d} component(s) (m)");
                    return Err(InputError::new("place of a marker", format!("{place:?}"), help));
                }
                let middle = mean(&nodes, mesh.positions(), d);
                let place: [f64; 3] = std::array::from_fn(|i| place.get(i).copied().unwrap_or(0.0));
                let marker = Marker {
                    fit: RigidFit::of_nodes(mesh, nodes.clone())?,
                    arm: Vector3::from(place) - Vector3::from(middle),
                    nodes,
                };
                Box::new(move |view, _| Value::Vector(marker.read(view, motion)))
            }
        })
    }
}

/// A point that moves with nodes as if both were one rigid body.
struct Marker {
    nodes: Vec<usize>,
    fit: RigidFit,
    /// From the middle of the nodes in the undeformed shape (m).
    arm: Vector3<f64>,
}

impl Marker {
    fn read(&self, view: &View, motion: Motion) -> [f64; 3] {
        let d = view.body().dimension();
        let middle = Vector3::from(motion.of(view, |x| mean(&self.nodes, x, d)));
        let about = match motion {
            Motion::Position => self.fit.rotation(view) * self.arm,
            Motion::Displacement => self.fit.rotation(view) * self.arm - self.arm,
            Motion::Velocity => {
                let turning = self.fit.turning(view);
                turning.velocity.cross(&(turning.rotation * self.arm))
            }
            Motion::Acceleration => {
                let turning = self.fit.turning(view);
                let arm = turning.rotation * self.arm;
                turning.acceleration.cross(&arm)
                    + turning.velocity.cross(&turning.velocity.cross(&arm))
            }
        };
        (middle + about).into()
    }
}

/// The sum of the values of nodes, each times its share.
fn shared(shares: &[(usize, f64)], x: &[f64], dimension: usize) -> [f64; 3] {
    std::array::from_fn(|i| match i < dimension {
        true => shares.iter().map(|(node, share)| share * x[node * dimension + i]).sum(),
        false => 0.0,
    })
}
