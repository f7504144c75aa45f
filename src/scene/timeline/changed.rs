//! Phases changed by commands and by the search for an equilibrium.

use std::sync::Arc;

use super::input::Input;
use super::phase::{ContactWith, Phase};
use crate::base::input::InputError;
use crate::elements::mesh::{Mesh, Selection};
use crate::scene::constraint::{Constrained, Constraint};
use crate::scene::forces::Obstacle;

impl Phase {
    /// Lets an obstacle of the scene move on with `velocity` (m/s) from where it is at time `t` (s).
    pub(crate) fn redirect(&mut self, obstacle: &Obstacle, t: f64, velocity: Vec<f64>) {
        let here = self.moving(obstacle).displacement(t);
        let redirected = obstacle.clone().velocity(velocity).placed(t, here);
        self.redirected.retain(|other| other.name() != redirected.name());
        self.redirected.push(redirected);
    }

    /// The phase as it follows `before` at time `t` (s): `obstacles` that were redirected go on from where
    /// they are.
    pub(crate) fn after(mut self, before: &Self, obstacles: &[Obstacle], t: f64) -> Self {
        let is_redirected = |obstacle: &&Obstacle| {
            before.redirected.iter().any(|redirected| redirected.name() == obstacle.name())
        };
        for obstacle in obstacles.iter().filter(is_redirected) {
            let here = before.moving(obstacle).displacement(t);
            self.redirected.push(obstacle.clone().placed(t, here));
        }
        self
    }

    /// The phase with constants in place of numbers that commands can set: later commands do not change it.
    pub(crate) fn snapshot(self: &Arc<Self>) -> Arc<Self> {
        if !self.is_live() {
            return self.clone();
        }
        let mut frozen = Self::clone(self);
        frozen.freeze();
        Arc::new(frozen)
    }

    /// The phase at rest under a `fraction` of its load: loads, pressures and the forces of actuators are
    /// constant, this fraction of those at the end, as the magnetic field and the `presets` of devices are that statics scale, and `obstacles` stand where they are at the fraction `path`
    /// of the end time.
    pub(crate) fn at_rest(
        &self,
        [fraction, path]: [f64; 2],
        (obstacles, presets): (&[Obstacle], Vec<Input>),
        dimension: usize,
    ) -> Self {
        let (mut rest, end) = (self.clone(), self.until);
        rest.inputs.extend(presets);
        rest.scale_inputs(fraction, dimension);
        rest.gradient = self.gradient.as_ref().map(|gradient| gradient.times(fraction));
        let reached = path * end;
        for obstacle in obstacles {
            if self.moving(obstacle).velocity_at(reached) != [0.0; 3] {
                rest.redirect(obstacle, reached, vec![0.0; dimension]);
            }
        }
        rest
    }

    /// Frees the `nodes` (counted from 0) that are held or moved one by one. Returns whether there were any.
    pub(crate) fn release(&mut self, mesh: &Mesh, nodes: &[usize]) -> Result<bool, InputError> {
        let mut kept = Vec::with_capacity(self.constraints.len());
        let mut is_changed = false;
        for Constraint { what, how } in self.constraints.drain(..) {
            let selection = match &what {
                Constrained::Nodes(selection, _) | Constrained::Along(selection, _) => selection,
                Constrained::Row(_) => {
                    kept.push(Constraint { what, how });
                    continue;
                }
            };
            let held = mesh.select(selection)?;
            let rest: Vec<usize> = held.iter().filter(|n| !nodes.contains(n)).copied().collect();
            is_changed |= rest.len() < held.len();
            let rest = match rest.len() {
                0 => continue,
                count if count == held.len() => selection.clone(),
                _ => Selection::of_nodes(rest),
            };
            let what = match what {
                Constrained::Along(_, normal) => Constrained::Along(rest, normal),
                Constrained::Nodes(_, axes) => Constrained::Nodes(rest, axes),
                row @ Constrained::Row(_) => row,
            };
            kept.push(Constraint { what, how });
        }
        self.constraints = kept;
        Ok(is_changed)
    }

    /// Lets an obstacle act or not; `all` are those of the scene.
    pub(crate) fn set_contact(&mut self, obstacle: &str, acts: bool, all: &[Obstacle]) {
        let acting = match &mut self.contact {
            ContactWith::These(names) => names,
            contact => {
                let all = all.iter().map(|obstacle| obstacle.name().to_owned());
                *contact = ContactWith::These(all.collect());
                let ContactWith::These(names) = contact else { return };
                names
            }
        };
        acting.retain(|name| name != obstacle);
        if acts {
            acting.push(obstacle.to_owned());
        }
    }
}
