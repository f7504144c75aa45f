//! Scenes of bodies of revolution: constraints on the axis, and unsupported features.

use super::{Phase, Scene};
use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axes, Axis, Constrained, Constraint, Motion};
use crate::scene::forces::{Fluid, Touch};

impl Scene {
    /// The nodes on the axis of a body of revolution, held there.
    pub(super) fn held_on_axis(&self) -> Option<Constraint> {
        let nodes = self.body.nodes_on_axis();
        (!nodes.is_empty()).then(|| Constraint {
            what: Constrained::Nodes(
                Selection::Numbers(nodes.iter().map(|node| node + 1).collect()),
                Axes::These(vec![Axis::X]),
            ),
            how: Motion::Hold,
        })
    }

    /// Refuses what a body of revolution does not have, in the scene and in `phase`.
    ///
    /// # Errors
    /// Anything that is not the same all around the axis, or whose forces are not known there.
    pub(super) fn check_around(&self, phase: &Phase) -> Result<(), InputError> {
        if !self.body.is_axisymmetric() {
            return Ok(());
        }
        let refuse = |what: &str, name: &str| {
            let help =
                "an axisymmetric body does not have it: leave it out, or mesh the body in space";
            Err(InputError::new(what, format!("\"{name}\""), help))
        };
        let actuator = self.actuators.iter().find(|own| !own.kind().is_axisymmetric);
        let magnet = self.magnets.first().map(|_| "magnet 1");
        let fluid = self.fluids.first().map(Fluid::name);
        let touch = self.touches.first().map(Touch::name);
        let device = self.devices.first();
        let kind = device.map_or("device", |device| device.kind());
        for (what, name) in [
            (actuator.map_or("actuator", |own| own.kind().name), actuator.map(|own| own.name())),
            ("magnet", magnet),
            ("fluid", fluid),
            ("touch", touch),
            (kind, device.map(|device| device.name())),
        ] {
            name.map_or(Ok(()), |name| refuse(what, name))?;
        }
        if self.reduced.is_some() {
            self.body.refuse_around("reduced model", "given")?;
        }
        if let Some(gravity) = self.gravity_in(phase)
            && gravity.first().is_some_and(|along_r| *along_r != 0.0)
        {
            let help = "gravity acts along the axis of an axisymmetric body, which is y: its first component is 0";
            return Err(InputError::new("gravity", format!("{gravity:?}"), help));
        }
        if phase.constraints.iter().any(|own| matches!(own.how, Motion::Turn(_))) {
            let input = format!("rotation in phase \"{}\"", phase.name);
            self.body.refuse_around(&input, "in the plane")?;
        }
        if self.start.spin.is_some() || !self.start.of_bodies.is_empty() {
            self.body.refuse_around("spin", "in the plane")?;
        }
        let (u, v) = (self.initial_displacements(), self.initial_velocities()?);
        for (what, unit, field) in
            [("initial displacement", "m", u), ("initial velocity", "m/s", &v[..])]
        {
            for node in self.body.nodes_on_axis() {
                if field[2 * node] != 0.0 {
                    let input = format!("{what} along r of node {}", node + 1);
                    let help = "the node is on the axis of the body, and stays there: give 0";
                    return Err(InputError::new(
                        input,
                        format!("{} {unit}", field[2 * node]),
                        help,
                    ));
                }
            }
        }
        Ok(())
    }
}
