//! The forces that act in a phase.

use std::sync::Arc;

use super::phase::{Load as PhaseLoad, check_vector, find};
use super::{Phase, Scene};
use crate::error::{Error, finite};
use crate::force::{Chamber, Contact, Force, Gravity, Load, Signal, Spring, VaryingLoad};

/// The forces that act in one phase.
pub(crate) type Forces = Vec<Arc<dyn Force>>;

impl Scene {
    /// The forces in one phase, all but those of constant matrices.
    pub(super) fn forces_in(&self, phase: &Phase) -> Result<Forces, Error> {
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
        for obstacle in phase.contacts(&self.obstacles)? {
            forces.push(Arc::new(Contact::new(&self.body, obstacle)?));
        }
        Ok(forces)
    }

    fn add_loads(&self, phase: &Phase, forces: &mut Forces) -> Result<(), Error> {
        let dimension = self.body.dimension();
        let mut constant = Vec::new();
        for (selection, load) in &phase.loads {
            let nodes = self.body.mesh().select(selection)?;
            let (force, share) = match load {
                PhaseLoad::Each(force) => (force, 1.0),
                PhaseLoad::Total(force) => (force, 1.0 / nodes.len() as f64),
                PhaseLoad::Function(function) => {
                    if function.dimension != dimension {
                        let mend = format!("it must give {dimension} component(s) (N)");
                        let input = "number of components of a load";
                        return Err(Error::input(input, function.dimension, mend));
                    }
                    forces.push(Arc::new(VaryingLoad { nodes, force: function.clone() }));
                    continue;
                }
            };
            check_vector("load", force, dimension, "N")?;
            finite("load", force)?;
            for node in nodes {
                constant.extend((0..dimension).map(|i| (node * dimension + i, share * force[i])));
            }
        }
        if !constant.is_empty() {
            forces.push(Arc::new(Load { forces: constant }));
        }
        Ok(())
    }

    fn add_springs(&self, phase: &Phase, forces: &mut Forces) -> Result<(), Error> {
        let known: Vec<&str> = self.springs.iter().map(Spring::name).collect();
        let input = format!("actuation of phase \"{}\"", phase.name);
        let mut actuations: Vec<Vec<Signal>> = vec![Vec::new(); known.len()];
        for (names, force) in &phase.actuations {
            force.validate(&input)?;
            for name in names {
                actuations[find(name, &known, &input, "springs")?].push(force.clone());
            }
        }
        for (spring, actuation) in self.springs.iter().zip(actuations) {
            forces.push(Arc::new(spring.force(self.body.mesh(), actuation)?));
        }
        Ok(())
    }

    fn add_chambers(&self, phase: &Phase, forces: &mut Forces) -> Result<(), Error> {
        let known: Vec<&str> = self.chambers.iter().map(Chamber::name).collect();
        let input = format!("pressure of phase \"{}\"", phase.name);
        let mut pressures: Vec<Vec<Signal>> = vec![Vec::new(); known.len()];
        for (name, pressure) in &phase.pressures {
            pressure.validate(&input)?;
            pressures[find(name, &known, &input, "chambers")?].push(pressure.clone());
        }
        for (chamber, pressure) in self.chambers.iter().zip(pressures) {
            if !pressure.is_empty() {
                forces.push(Arc::new(chamber.force(&self.body, pressure)?));
            }
        }
        Ok(())
    }
}
