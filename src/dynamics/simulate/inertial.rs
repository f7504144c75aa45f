//! Readings of an inertial measurement unit that is fixed to a body, in axes that turn with the body.

use nalgebra::Vector3;

use super::gauge::{Gauge, part, turning};
use super::output::Value;
use super::reading::Reading;
use super::view::mean;
use crate::base::input::InputError;
use crate::base::vector::padded;
use crate::elements::mesh::Selection;
use crate::scene::timeline::Scene;

impl Reading {
    /// The function that reads R^T (a - g): a of the middle of `nodes`, or of the centre of mass of what else is read, with their rotation R.
    ///
    /// # Errors
    /// Nodes that do not exist, or that do not determine a rotation.
    pub(super) fn accelerometer_gauge(
        &self,
        scene: &Scene,
        nodes: Option<&Selection>,
    ) -> Result<Gauge, InputError> {
        let (fit, first_node) = (self.fit(scene, nodes)?, self.first_node(scene)?);
        let (mesh, d) = (scene.body().mesh(), scene.body().dimension());
        let nodes = nodes.map(|nodes| mesh.select(nodes)).transpose()?;
        // no command changes gravity
        let gravity: Vec<Vector3<f64>> = scene
            .phases()
            .iter()
            .map(|phase| scene.gravity_in(phase).map_or([0.0; 3], padded).into())
            .collect();
        Ok(Box::new(move |view, sample| {
            let acceleration = match (view.accelerations, &nodes) {
                ([], _) => [f64::NAN; 3],
                (all, Some(nodes)) => mean(nodes, all, d),
                (all, None) => {
                    let part = part(view.body(), first_node);
                    padded(&part.body.mean_velocity(&all[part.dofs()]))
                }
            };
            let gravity = gravity.get(sample.phase).copied().unwrap_or_default();
            let felt = Vector3::from(acceleration) - gravity;
            Value::Vector((fit.rotation(view).transpose() * felt).into())
        }))
    }

    /// The function that reads R^T omega.
    ///
    /// # Errors
    /// As [`accelerometer_gauge`](Self::accelerometer_gauge).
    pub(super) fn gyroscope_gauge(
        &self,
        scene: &Scene,
        nodes: Option<&Selection>,
    ) -> Result<Gauge, InputError> {
        let fit = self.fit(scene, nodes)?;
        Ok(turning(fit, scene.body().dimension(), |turning| {
            turning.rotation.transpose() * turning.velocity
        }))
    }
}
