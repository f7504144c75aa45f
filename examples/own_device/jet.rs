//! A jet that can be steered: a device that is not of the crate, in one file.

use std::sync::Arc;

use pliant::force::{Force, NodalForces, Tangents};
use pliant::ode::Failure;
use pliant::sparse::BlockMatrix;
use pliant::{
    Body, Device, DeviceGauge, DeviceInput, DeviceKey, DeviceOutput, DeviceSignals, DeviceSite,
    DeviceState, InputError, Selection,
};
use serde::Deserialize;

/// A jet in the plane that pushes a set of nodes, its nozzle. In a scene file it is `[[jet]]` with these fields as keys.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Jet {
    name: String,
    /// Name of a set of nodes.
    nozzle: String,
}

/// Numbers of the inputs, in the order of [`Jet::inputs`].
const THRUST: usize = 0;
const ANGLE: usize = 1;

impl Jet {
    /// For the reference page and the schema of a command that has it.
    #[allow(dead_code, reason = "the program that steers the jet has no command")]
    pub const ABOUT: &str = "A jet in the plane, which `steer` of phases fires and turns by `thrust` (N) and `angle` (rad).";
    #[allow(dead_code, reason = "the program that steers the jet has no command")]
    pub const KEYS: [DeviceKey; 2] = [
        DeviceKey { name: "name", unit: "", meaning: "the name of the jet" },
        DeviceKey {
            name: "nozzle",
            unit: "",
            meaning: "the name of the set of nodes that it pushes",
        },
    ];

    pub const THRUST: DeviceInput = DeviceInput::number("thrust", "N");
    /// Direction of the thrust from the x axis, counter-clockwise; statics does not bring it on by load steps.
    pub const ANGLE: DeviceInput =
        DeviceInput { is_scaled: false, ..DeviceInput::number("angle", "rad") };
    /// Power that the thrust gives to the body.
    pub const POWER: DeviceOutput = DeviceOutput { word: "power", unit: "W", is_vector: false };

    fn nodes(&self, body: &Body) -> Result<Vec<usize>, InputError> {
        body.mesh().select(&Selection::Set(self.nozzle.clone()))
    }
}

/// Thrust (N) by the values of the inputs.
fn thrust(size: f64, angle: f64) -> [f64; 2] {
    [size * angle.cos(), size * angle.sin()]
}

impl Device for Jet {
    fn name(&self) -> &str {
        &self.name
    }

    fn inputs(&self) -> &'static [DeviceInput] {
        &[Self::THRUST, Self::ANGLE]
    }

    fn outputs(&self) -> &'static [DeviceOutput] {
        &[Self::POWER]
    }

    fn force(
        &self,
        DeviceSite { body, .. }: &DeviceSite<'_>,
        inputs: DeviceSignals,
    ) -> Result<Arc<dyn Force>, InputError> {
        if body.dimension() != 2 {
            let help = "a jet steers in the plane: take a body in the plane";
            return Err(InputError::new("dimension of the body", body.dimension(), help));
        }
        Ok(Arc::new(Push { nodes: self.nodes(body)?, inputs }))
    }

    fn gauge(&self, _number: usize, site: &DeviceSite<'_>) -> Result<DeviceGauge, InputError> {
        let nodes = self.nodes(site.body)?;
        Ok(Box::new(move |now| {
            let thrust = thrust(now.input(THRUST)[0], now.input(ANGLE)[0]);
            let of_node = |n: &usize| (0..2).map(|i| thrust[i] * now.v[2 * n + i]).sum::<f64>();
            [nodes.iter().map(of_node).sum::<f64>() / nodes.len() as f64, 0.0, 0.0]
        }))
    }

    /// The same: a named set has the nodes of the finer mesh, too.
    fn on_finer_mesh(
        &self,
        _nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        Ok(Arc::new(self.clone()))
    }

    /// A flame against the thrust, 1 m for 1 N.
    fn lines(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        // the force has found the nodes before
        let nodes = self.nodes(now.body).unwrap_or_default();
        let thrust = thrust(now.input(THRUST)[0], now.input(ANGLE)[0]);
        let mut nozzle = [0.0; 3];
        for node in &nodes {
            let place = now.body.mesh().position(*node);
            (0..2).for_each(|i| nozzle[i] += (place[i] + now.u[2 * node + i]) / nodes.len() as f64);
        }
        vec![[nozzle, [nozzle[0] - thrust[0], nozzle[1] - thrust[1], 0.0]]]
    }
}

/// The force of a jet, shared by the nodes of its nozzle.
struct Push {
    nodes: Vec<usize>,
    inputs: DeviceSignals,
}

impl Force for Push {
    fn add_forces(
        &self,
        t: f64,
        _u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let thrust = thrust(self.inputs.at(THRUST, t)[0], self.inputs.at(ANGLE, t)[0]);
        for node in &self.nodes {
            (0..2).for_each(|i| {
                forces.applied[2 * node + i] += thrust[i] / self.nodes.len() as f64;
            });
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        _stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        Tangents::Added // it depends on neither u nor v
    }

    fn is_nonlinear(&self) -> bool {
        false
    }
}
