//! The state of a scene, from which another scene can start.

use std::collections::BTreeMap;

use crate::base::input::{InputError, finite, positive};
use crate::elements::body::{Body, BranchState, Part};

/// The state of a scene at one time, by the names of its bodies and components:
/// [`Scene::starting_from`](crate::Scene::starting_from) starts another scene from it.
///
/// [`Trajectory::state`](crate::Trajectory::state) returns that of a motion or an equilibrium; files of earlier runs contain
/// it, too.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneState {
    /// Each body, in the order of the scene.
    pub bodies: Vec<BodyState>,
    /// Mass (kg, above 0) of the gas in a chamber, by the name of the chamber.
    pub gases: BTreeMap<String, f64>,
    /// Mass (kg, above 0) of the liquid in a chamber, by the name of the chamber.
    pub liquids: BTreeMap<String, f64>,
    /// State of a [lag](crate::Lag), by the name of the actuator, in the unit of its actuation.
    pub lags: BTreeMap<String, f64>,
    /// Flow rate (m^3/s) through a pipe from its first end to its second, by the name of the pipe.
    pub pipes: BTreeMap<String, f64>,
    /// Position (m) of an obstacle that had moved, by its name: the centre of a disc or cavity, the first corner of a
    /// box, the first end of a capsule, the point of a half-plane nearest to the origin; of a union that of its first
    /// part. It is compared with the position of the obstacle in the scene that starts, and does not move it.
    pub obstacles: BTreeMap<String, Vec<f64>>,
    /// Angle, in turns including whole ones, that a sensor of an angle reads, by the name of the sensor.
    pub angles: BTreeMap<String, f64>,
}

/// The state of one of the bodies of a scene.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub struct BodyState {
    /// Its name; empty for a single body, and for all bodies of a scene as one.
    pub name: String,
    /// Undeformed positions (m), dimension components per node: the mesh is identified by them.
    pub positions: Vec<f64>,
    /// Displacements (m), likewise.
    pub displacements: Vec<f64>,
    /// Velocities (m/s), likewise.
    pub velocities: Vec<f64>,
    /// Its Maxwell branches; none where it has none, or where they are not known.
    #[cfg_attr(feature = "checkpoint", serde(default, skip_serializing_if = "Option::is_none"))]
    pub branches: Option<BranchState>,
}

/// Name of the input in errors of a state.
pub(super) const INPUT: &str = "state at the start";

impl SceneState {
    /// The state of a body of a scene, by its name; where one of both has a single body, or the state is not by bodies,
    /// the name does not matter.
    pub(super) fn of(&self, part: &Part, is_single: bool) -> Option<&BodyState> {
        match &self.bodies[..] {
            [only] if is_single => Some(only),
            all => all.iter().find(|body| body.name == part.name),
        }
    }

    /// The state of all bodies as one, if it is not by bodies.
    pub(super) fn whole(&self) -> Option<&BodyState> {
        match &self.bodies[..] {
            [only] if only.name.is_empty() => Some(only),
            _ => None,
        }
    }

    /// # Errors
    /// Other meshes than those of `body`, numbers that cannot be.
    pub(super) fn check(&self, body: &Body) -> Result<(), InputError> {
        if let Some(whole) = self.whole() {
            return whole.check(body);
        }
        let is_single = body.is_single();
        let mut found = 0;
        for part in body.parts() {
            if let Some(state) = self.of(&part, is_single) {
                state.check(part.body).map_err(|error| match is_single {
                    true => error,
                    false => {
                        let input = format!("{} of body \"{}\"", error.input, part.name);
                        InputError::new(input, error.value, error.help)
                    }
                })?;
                found += 1;
            }
        }
        if found == 0 && !self.bodies.is_empty() {
            let listed = |names: Vec<&str>| format!("\"{}\"", names.join("\", \""));
            let [own, theirs] = [
                listed(body.parts().map(|part| part.name).collect()),
                listed(self.bodies.iter().map(|body| &*body.name).collect()),
            ];
            let help = format!("this scene has {own}: start from a state of a body with its name");
            return Err(InputError::new(INPUT, format!("bodies {theirs}"), help));
        }
        for (what, amounts) in [("gas", &self.gases), ("liquid", &self.liquids)] {
            for (chamber, &amount) in amounts {
                positive(&format!("{INPUT}: {what} in chamber \"{chamber}\""), amount, "kg")?;
            }
        }
        for (what, states) in [("lag of", &self.lags), ("flow rate of pipe", &self.pipes)] {
            for (name, state) in states {
                finite(&format!("{INPUT}: {what} \"{name}\""), &[*state])?;
            }
        }
        Ok(())
    }
}

/// Equal positions may differ by this fraction of the size of a body: round-off when a mesh is made.
const SAME: f64 = 1e-9;

impl BodyState {
    /// # Errors
    /// Undeformed positions other than those of `body`; other numbers of displacements and velocities.
    fn check(&self, body: &Body) -> Result<(), InputError> {
        let (mesh, dimension) = (body.mesh(), body.dimension());
        let help = "start from a state of a body with the same mesh";
        if self.positions.len() != mesh.positions().len() {
            let count = self.positions.len() / dimension;
            let help = format!("this body has {}: {help}", mesh.node_count());
            return Err(InputError::new(INPUT, format!("{count} nodes"), help));
        }
        let pairs = self.positions.chunks_exact(dimension);
        let pairs = pairs.zip(mesh.positions().chunks_exact(dimension));
        let far = |(_, (theirs, ours)): &(usize, (&[f64], &[f64]))| {
            // NaN counts as far
            !theirs.iter().zip(*ours).all(|(a, b)| (a - b).abs() <= SAME * mesh.size())
        };
        if let Some((node, (theirs, ours))) = (1..).zip(pairs).find(far) {
            return Err(InputError::new(
                INPUT,
                format!("node {node} at {theirs:?} undeformed"),
                format!("this body has it at {ours:?}: {help}"),
            ));
        }
        for (name, field) in
            [("initial displacement", &self.displacements), ("initial velocity", &self.velocities)]
        {
            if field.len() != body.dofs() {
                let help = format!("it needs {dimension} components at each node");
                return Err(InputError::new(name, format!("{} numbers in all", field.len()), help));
            }
        }
        if let Some(branches) = &self.branches {
            finite(&format!("{INPUT}: branches"), &branches.components)?;
        }
        Ok(())
    }
}
