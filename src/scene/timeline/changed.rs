//! Phases changed by commands and by the search for an equilibrium.

use std::sync::Arc;

use super::load::Load;
use super::phase::{ContactWith, Phase};
use crate::base::input::InputError;
use crate::elements::mesh::{Mesh, Selection};
use crate::scene::constraint::{Constrained, Constraint};
use crate::scene::forces::{
    Dipole, DipolePart, Live, MagneticField, Obstacle, Signal, VectorSignal,
};

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

    /// The pressure in a chamber, if that is one number that a command can set.
    pub(crate) fn live_pressure(&self, chamber: &str) -> Option<&Live> {
        let mut all = self.pressures.iter().filter(|(name, _)| name == chamber);
        all.next().filter(|_| all.next().is_none())?.1.live()
    }

    /// The actuation force in a spring, likewise.
    pub(crate) fn live_actuation(&self, spring: &str) -> Option<&Live> {
        let acts = |(names, _): &&(Vec<String>, Signal)| names.iter().any(|name| name == spring);
        let mut all = self.actuations.iter().filter(acts);
        let (names, force) = all.next().filter(|_| all.next().is_none())?;
        force.live().filter(|_| names.len() == 1)
    }

    /// The load on a selection, likewise.
    pub(crate) fn live_load(&self, nodes: &Selection) -> Option<&Live> {
        let mut all = self.loads.iter().filter(|(other, _)| other == nodes);
        all.next().filter(|_| all.next().is_none())?.1.value.live()
    }

    /// The uniform part of the magnetic field, likewise.
    pub(crate) fn live_field(&self) -> Option<&Live> {
        self.magnetic_field.as_ref()?.field.live()
    }

    /// The phase with constants in place of numbers that commands can set: later commands do not change it.
    pub(crate) fn frozen(self: &Arc<Self>) -> Arc<Self> {
        if !self.is_live() {
            return self.clone();
        }
        let mut frozen = Self::clone(self);
        for (_, load) in &mut frozen.loads {
            load.value = load.value.frozen();
        }
        if let Some(field) = &mut frozen.magnetic_field {
            field.field = field.field.frozen();
        }
        for (.., value) in &mut frozen.dipoles {
            *value = value.frozen();
        }
        let actuations = frozen.actuations.iter_mut().map(|(_, force)| force);
        let openings = frozen.openings.iter_mut().map(|(_, opening)| opening);
        let pressures = frozen.pressures.iter_mut().map(|(_, pressure)| pressure);
        let flows = frozen.flows.iter_mut().map(|(_, flow)| flow);
        for signal in actuations.chain(pressures).chain(openings).chain(flows) {
            *signal = signal.frozen();
        }
        Arc::new(frozen)
    }

    /// The phase at rest under a `fraction` of its load: loads, pressures and the forces of actuators are
    /// constant, this fraction of those at the end, as the magnetic field and the moments of `dipoles` are, and `obstacles` stand where they are at the fraction `path`
    /// of the end time.
    pub(crate) fn at_rest(
        &self,
        [fraction, path]: [f64; 2],
        (obstacles, dipoles): (&[Obstacle], &[Dipole]),
        dimension: usize,
    ) -> Self {
        let (mut rest, end) = (self.clone(), self.until);
        for (_, load) in &mut rest.loads {
            let force = load.value.components(end, dimension);
            let part = force.iter().map(|force| fraction * force).collect();
            load.value = VectorSignal::Constant(part);
        }
        let actuations = rest.actuations.iter_mut().map(|(_, force)| force);
        let pressures = rest.pressures.iter_mut().map(|(_, pressure)| pressure);
        let on_faces = rest.face_pressures.iter_mut().map(|(_, pressure)| pressure);
        for signal in actuations.chain(pressures).chain(on_faces) {
            *signal = Signal::constant(fraction * signal.at(end));
        }
        let field = self.magnetic_field.as_ref();
        rest.magnetic_field = field.map(|field| field.at_rest(fraction, end, dimension));
        for dipole in dipoles.iter().map(|dipole| self.with_dipole(dipole)) {
            for (part, factor) in [(DipolePart::Position, 1.0), (DipolePart::Moment, fraction)] {
                let vector = dipole.part(part).components(end, dimension);
                let vector = vector.iter().map(|x| factor * x).collect();
                rest.set_dipole(dipole.name(), part, VectorSignal::Constant(vector));
            }
        }
        let reached = path * end;
        for obstacle in obstacles {
            if self.moving(obstacle).velocity_at(reached) != [0.0; 3] {
                rest.redirect(obstacle, reached, vec![0.0; dimension]);
            }
        }
        rest
    }

    /// Whether there are numbers that commands can set.
    fn is_live(&self) -> bool {
        self.loads.iter().any(|(_, load)| load.value.live().is_some())
            || self.actuations.iter().any(|(_, force)| force.live().is_some())
            || self.pressures.iter().any(|(_, pressure)| pressure.live().is_some())
            || self.openings.iter().any(|(_, opening)| opening.live().is_some())
            || self.flows.iter().any(|(_, flow)| flow.live().is_some())
            || self.live_field().is_some()
            || self.dipoles.iter().any(|(.., value)| value.live().is_some())
    }

    /// Replaces the pressure in a chamber.
    pub(crate) fn set_pressure(&mut self, chamber: &str, pressure: Signal) {
        self.pressures.retain(|(name, _)| name != chamber);
        self.pressures.push((chamber.to_owned(), pressure));
    }

    /// Replaces the actuation force in a spring.
    pub(crate) fn set_actuation(&mut self, spring: &str, force: Signal) {
        for (names, _) in &mut self.actuations {
            names.retain(|name| name != spring);
        }
        self.actuations.retain(|(names, _)| !names.is_empty());
        self.actuations.push((vec![spring.to_owned()], force));
    }

    /// Replaces the uniform part of the magnetic field; its gradient stays.
    pub(crate) fn set_field(&mut self, field: VectorSignal) {
        match &mut self.magnetic_field {
            Some(own) => own.field = field,
            none => *none = Some(MagneticField::of(field)),
        }
    }

    /// Replaces the loads that were given for the same selection.
    pub(crate) fn set_load(&mut self, nodes: Selection, load: Load) {
        self.loads.retain(|(other, _)| *other != nodes);
        self.loads.push((nodes, load));
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
