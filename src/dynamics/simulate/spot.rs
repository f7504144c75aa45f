//! Places whose motion is read.

use crate::elements::mesh::Selection;

/// A spot whose motion is read: the mean position of nodes, a point of a body, or a marker outside of it.
///
/// A selection of nodes converts to a spot.
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
/// assert!((lamp[0].hypot(lamp[1]) - 0.4).abs() < 1e-4);
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

/// The quantity that is read of its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Motion {
    Position,
    Displacement,
    Velocity,
    Acceleration,
}

impl Spot {
    /// The point of the body, within a cell or on its surface, whose undeformed position is `place` (m). It moves with the body by the shape functions of its
    /// cell, so that it is the same point on a finer mesh.
    pub fn inside(place: impl Into<Vec<f64>>) -> Self {
        Self(At::Inside(place.into()))
    }

    /// The point at `place` (m) in the undeformed shape that moves with `nodes` as if both were one rigid body: a marker on a post or a
    /// plate, which need not be meshed.
    ///
    /// The rigid motion is the best fit to that of the nodes, in the mean square with equal weights: their mean position, and
    /// the [rotation](super::Reading::rotation) about it.
    pub fn marker(nodes: impl Into<Selection>, place: impl Into<Vec<f64>>) -> Self {
        Self(At::Marker(nodes.into(), place.into()))
    }
}

impl<S: Into<Selection>> From<S> for Spot {
    fn from(nodes: S) -> Self {
        Self(At::Nodes(nodes.into()))
    }
}
