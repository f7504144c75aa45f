//! Places whose motion is read.

use nalgebra::Vector3;

use super::gauge::{Gauge, Value};
use super::reading::Reading;
use super::rigid_fit::RigidFit;
use super::view::{View, mean};
use crate::base::input::{InputError, finite};
use crate::elements::mesh::Selection;
use crate::scene::timeline::Scene;

/// A place whose motion is read: the middle of nodes, a point of a body, or a marker beside it.
///
/// Selections of nodes are places by themselves.
///
/// ```
/// use pliant::simulate::{Reading, Spot};
/// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
///
/// let mesh = Mesh::rectangle([0.1, 0.02], [6, 3], Cells::Rectangles)?;
/// let body = Body::new(mesh, Material::rigid(1000.0)).thickness(0.01).build()?;
/// let scene = Scene::new(body).spin([2.0]).phase(Phase::until(0.5));
/// let sampling = Sampling::every(0.1)
///     .read("grain", Reading::velocity(Spot::inside([0.03, 0.015])))
///     .read("lamp", Reading::acceleration(Spot::marker("right", [0.15, 0.01])));
/// let motion = scene.simulate(&Settings { rtol: 1e-8, ..Settings::default() }, &sampling)?;
/// // 10 cm from the centre of mass, at 2 rad/s
/// let lamp = &motion.last().sensors[2..];
/// assert!((lamp[0].hypot(lamp[1]) - 0.4).abs() < 1e-5);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Spot(pub(super) At);

/// Where it is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum At {
    Nodes(Selection),
    Inside(Vec<f64>),
    Marker(Selection, Vec<f64>),
}

/// What is read of its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Motion {
    Position,
    Displacement,
    Velocity,
    Acceleration,
}

impl Spot {
    /// The point of the body, within a cell or on its surface, whose undeformed position is `place` (m). It moves with the body, whatever
    /// nodes are near, so that a finer mesh has the same place: by the shape functions of its cell.
    pub fn inside(place: impl Into<Vec<f64>>) -> Self {
        Self(At::Inside(place.into()))
    }

    /// The point at `place` (m) in the undeformed shape that moves with `nodes` as if both were one rigid body: a marker on a post or a
    /// plate, which need not be meshed.
    ///
    /// The rigid motion is the one nearest to that of the nodes, in the mean square, all of which count alike: their middle, and
    /// the [rotation](Reading::rotation) about it.
    pub fn marker(nodes: impl Into<Selection>, place: impl Into<Vec<f64>>) -> Self {
        Self(At::Marker(nodes.into(), place.into()))
    }
}

impl<S: Into<Selection>> From<S> for Spot {
    fn from(nodes: S) -> Self {
        Self(At::Nodes(nodes.into()))
    }
}

impl Motion {
    /// What is read of a place that moves by a sum over the values of nodes.
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
    /// Nodes that do not exist; a point outside the body; a marker of nodes that do not tell how it turns.
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
