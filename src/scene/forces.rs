//! The forces that act in a phase.

use std::sync::Arc;

use super::phase::{Load as PhaseLoad, check_vector};
use super::{Phase, Scene};
use crate::external::{Contact, Gravity, Load, Signal, VaryingLoad, shares};
use crate::force::Forces;
use crate::input::{InputError, finite};
use crate::mesh::Selection;

impl Scene {
    /// The forces in one phase, all but those of constant matrices.
    pub(crate) fn forces_in(&self, phase: &Phase) -> Result<Forces, InputError> {
        let dimension = self.body.dimension();
        let mut forces = Forces::new();
        if let Some(elastic) = self.body.elastic() {
            forces.push(Arc::new(elastic));
        }
        if let Some(gravity) = &self.gravity {
            check_vector("gravity", gravity, dimension, "m/s^2")?;
            finite("gravity", gravity)?;
            forces.push(Arc::new(Gravity::new(&self.body, gravity)));
        }
        self.add_loads(phase, &mut forces)?;
        self.add_springs(phase, &mut forces)?;
        self.add_chambers(phase, &mut forces)?;
        for contact in self.contacts(phase)? {
            forces.push(Arc::new(contact));
        }
        forces.extend_from_slice(&self.forces);
        Ok(forces)
    }

    /// The contact forces among them.
    pub(crate) fn contacts(&self, phase: &Phase) -> Result<Vec<Contact>, InputError> {
        let obstacles = phase.contacts(&self.obstacles)?.into_iter();
        obstacles.map(|obstacle| Contact::new(&self.body, obstacle)).collect()
    }

    fn add_loads(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        let dimension = self.body.dimension();
        let mut constant = Vec::new();
        for (selection, load) in &phase.loads {
            let nodes = self.body.mesh().select(selection)?;
            let (force, shares) = match load {
                PhaseLoad::Each(force) => (force, vec![1.0; nodes.len()]),
                PhaseLoad::Total(force) => (force, shares(&self.body, &nodes)),
                PhaseLoad::Varying(force) => {
                    force.validate("a load", dimension)?;
                    let force = force.clone();
                    forces.push(Arc::new(VaryingLoad { nodes, force, dimension }));
                    continue;
                }
            };
            check_vector("load", force, dimension, "N")?;
            finite("load", force)?;
            for (node, share) in nodes.into_iter().zip(shares) {
                constant.extend((0..dimension).map(|i| (node * dimension + i, share * force[i])));
            }
        }
        if !constant.is_empty() {
            forces.push(Arc::new(Load { forces: constant }));
        }
        Ok(())
    }

    /// The force (N) on each of the nodes of `selection`, in the mean over them, at time `t` (s), by the loads that
    /// `phase` has for it.
    pub(crate) fn load_on(
        &self,
        phase: &Phase,
        selection: &Selection,
        t: f64,
    ) -> Result<Vec<f64>, InputError> {
        let count = self.body.mesh().select(selection)?.len();
        let mut sum = vec![0.0; self.body.dimension()];
        for (_, load) in phase.loads.iter().filter(|(other, _)| other == selection) {
            let force = match load {
                PhaseLoad::Each(force) => force.clone(),
                PhaseLoad::Total(force) => force.iter().map(|force| force / count as f64).collect(),
                PhaseLoad::Varying(force) => force.components(t, sum.len()),
            };
            sum.iter_mut().zip(force).for_each(|(sum, force)| *sum += force);
        }
        Ok(sum)
    }

    fn add_springs(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        for (spring, actuation) in self.springs.iter().zip(self.actuation_signals(phase)?) {
            forces.push(Arc::new(spring.force(self.body.mesh())?));
            if !actuation.is_empty() {
                forces.push(Arc::new(spring.actuator(self.body.mesh(), actuation)?));
            }
        }
        Ok(())
    }

    /// Forces (N) of the actuators of all springs at time `t` (s) in `phase`.
    pub(crate) fn actuations(&self, phase: &Phase, t: f64) -> Result<Vec<f64>, InputError> {
        let signals = self.actuation_signals(phase)?.into_iter();
        Ok(signals.map(|signals| signals.iter().map(|signal| signal.at(t)).sum()).collect())
    }

    /// What actuates each spring in `phase`.
    fn actuation_signals(&self, phase: &Phase) -> Result<Vec<Vec<Signal>>, InputError> {
        let input = format!("actuation of phase \"{}\"", phase.name);
        let mut actuations: Vec<Vec<Signal>> = vec![Vec::new(); self.springs.len()];
        for (names, force) in &phase.actuations {
            force.validate(&input)?;
            for name in names {
                actuations[self.spring_number(name, &input)?].push(force.clone());
            }
        }
        Ok(actuations)
    }

    fn add_chambers(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        let input = format!("pressure of phase \"{}\"", phase.name);
        let mut pressures: Vec<Vec<Signal>> = vec![Vec::new(); self.chambers.len()];
        for (name, pressure) in &phase.pressures {
            pressure.validate(&input)?;
            pressures[self.chamber_number(name, &input)?].push(pressure.clone());
        }
        for (chamber, pressure) in self.chambers.iter().zip(pressures) {
            if !pressure.is_empty() {
                forces.push(Arc::new(chamber.force(&self.body, pressure)?));
            }
        }
        Ok(())
    }
}
