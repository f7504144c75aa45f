//! The forces that act in a phase.

use std::sync::Arc;

use super::input::Quantity;
use super::phase::check_vector;
use super::{LoadKind, Phase, Scene};
use crate::base::input::{InputError, finite};
use crate::elements::force::Forces;
use crate::elements::mesh::Selection;
use crate::scene::forces::{
    Contact, FacePressure, Gravity, Load, Signal, VaryingLoad, VectorSignal, areas, shares,
};

impl Scene {
    /// The forces in one phase, except those of constant matrices.
    pub(crate) fn forces_in(&self, phase: &Phase) -> Result<Forces, InputError> {
        self.check_around(phase)?;
        let dimension = self.body.dimension();
        let mut forces = Forces::new();
        if let Some(elastic) = self.body.elastic_outside(&self.growing_cells(phase)?) {
            forces.push(Arc::new(elastic));
        }
        if let Some(elastic) = self.body.elastic_of_rigid() {
            forces.push(Arc::new(elastic));
        }
        if let Some(rods) = self.body.rod_forces() {
            forces.push(Arc::new(rods));
        }
        if let Some(reinforcement) = self.body.reinforcement() {
            forces.push(Arc::new(reinforcement));
        }
        if let Some(gravity) = self.gravity_in(phase) {
            check_vector("gravity", gravity, dimension, "m/s^2")?;
            finite("gravity", gravity)?;
            forces.push(Arc::new(Gravity::new(&self.body, gravity)));
        }
        self.add_loads(phase, &mut forces)?;
        let lagging = self.add_actuators(phase, &mut forces)?;
        if let Some(field) = phase.field() {
            let input = format!("magnetic field of phase \"{}\"", phase.name);
            let Some(magnets) = self.magnetization()? else {
                let help = "the scene has no magnet on which it acts: add one";
                return Err(InputError::new(input, format!("{:?}", field.field), help));
            };
            forces.push(Arc::new(field.force(&self.body, magnets, input)?));
        }
        forces.extend(self.device_forces(phase)?);
        self.add_chambers(phase, &mut forces)?;
        self.add_amounts(phase, lagging, &mut forces)?;
        for (nodes, pressure) in phase.face_pressures() {
            forces.push(Arc::new(FacePressure::new(&self.body, nodes, pressure.clone())?));
        }
        for (quantity, nodes, value) in phase.vectors_on_nodes() {
            if let Some(build) = quantity.row().on_nodes {
                forces.push(build(&self.body, nodes, value)?);
            }
        }
        self.add_fluids(phase, &mut forces)?;
        for contact in self.contacts(phase)? {
            forces.push(Arc::new(contact));
        }
        for touch in self.touches_in(phase)? {
            forces.push(Arc::new(touch));
        }
        forces.extend_from_slice(&self.forces);
        Ok(forces)
    }

    /// Acceleration of gravity (m/s^2) in one phase, if there is any.
    pub(crate) fn gravity_in<'a>(&'a self, phase: &'a Phase) -> Option<&'a [f64]> {
        phase.gravity.as_deref().or(self.acceleration())
    }

    /// The contact forces among them.
    pub(crate) fn contacts(&self, phase: &Phase) -> Result<Vec<Contact>, InputError> {
        let obstacles = phase.contacts(&self.obstacles)?.into_iter();
        obstacles.map(|obstacle| Contact::new(&self.body, obstacle)).collect()
    }

    fn add_loads(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        let dimension = self.body.dimension();
        let mut constant = Vec::new();
        for (selection, kind, value) in phase.loads() {
            let nodes = self.body.mesh().select(selection)?;
            check_load(kind, value, dimension)?;
            let parts = self.parts(kind, selection, &nodes)?;
            let nodes = nodes.into_iter().zip(parts);
            match value {
                VectorSignal::Constant(force) => {
                    for (node, part) in nodes {
                        let along = |i| (node * dimension + i, part * force[i]);
                        constant.extend((0..dimension).map(along));
                    }
                }
                varying => {
                    let (nodes, force) = (nodes.collect(), varying.clone());
                    forces.push(Arc::new(VaryingLoad { nodes, force, dimension }));
                }
            }
        }
        if !constant.is_empty() {
            forces.push(Arc::new(Load { forces: constant, dimension }));
        }
        Ok(())
    }

    /// Forces (N) of the loads of `phase` at time `t` (s), node by node as they are named.
    pub(crate) fn loads_at(
        &self,
        phase: &Phase,
        t: f64,
    ) -> Result<Vec<(usize, Vec<f64>)>, InputError> {
        let mut forces = Vec::new();
        for (selection, kind, value) in phase.loads() {
            let nodes = self.body.mesh().select(selection)?;
            let parts = self.parts(kind, selection, &nodes)?;
            let value = value.components(t, self.body.dimension());
            let on = |part: f64| value.iter().map(|value| part * value).collect();
            forces.extend(nodes.into_iter().zip(parts.into_iter().map(on)));
        }
        Ok(forces)
    }

    /// The factor of the value of a load of this `kind` at each of the `nodes`, which `selection` has named.
    pub(super) fn parts(
        &self,
        kind: LoadKind,
        selection: &Selection,
        nodes: &[usize],
    ) -> Result<Vec<f64>, InputError> {
        match kind {
            LoadKind::Each => Ok(vec![1.0; nodes.len()]),
            LoadKind::Total => Ok(shares(&self.body, nodes)),
            LoadKind::Traction => areas(&self.body, nodes)
                .map_err(|problem| InputError::new("traction nodes", selection, problem)),
        }
    }

    /// The loads that `phase` has for `selection` at time `t` (s), added up as one of this `kind`. Those of
    /// other kinds are converted by the mean of their forces on the nodes.
    pub(crate) fn load_on(
        &self,
        phase: &Phase,
        selection: &Selection,
        kind: LoadKind,
        t: f64,
    ) -> Result<Vec<f64>, InputError> {
        let nodes = self.body.mesh().select(selection)?;
        let count = nodes.len() as f64;
        // value of a load of a kind for a mean force of 1 on the nodes
        let times = |kind: LoadKind| match kind {
            LoadKind::Each => Ok(1.0),
            LoadKind::Total => Ok(count),
            LoadKind::Traction => {
                let parts = self.parts(kind, selection, &nodes)?;
                Ok::<f64, InputError>(count / parts.iter().sum::<f64>())
            }
        };
        let mut sum = vec![0.0; self.body.dimension()];
        for (_, own, value) in phase.loads().filter(|(other, ..)| *other == selection) {
            let value = value.components(t, sum.len());
            let [own, wanted] = match own == kind {
                true => [1.0; 2],
                false => [times(own)?, times(kind)?],
            };
            sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += value / own * wanted);
        }
        Ok(sum)
    }

    fn add_chambers(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        let input = format!("pressure of phase \"{}\"", phase.name);
        let mut pressures: Vec<Vec<Signal>> = vec![Vec::new(); self.chambers.len()];
        for (name, pressure) in phase.signals(Quantity::Pressure) {
            pressure.validate(&input)?;
            let number = self.chamber_number(name, &input)?;
            let gas = "the gas in it has a pressure of its own: feed it by an orifice, or leave the gas out";
            let liquid = "the liquid in it has a pressure of its own: let it flow in and out, or leave the liquid out";
            let gas = self.gas_in(name).map(|_| gas);
            if let Some(help) = gas.or(self.liquid_in(name).map(|_| liquid)) {
                return Err(InputError::new(input, format!("in chamber \"{name}\""), help));
            }
            pressures[number].push(pressure.clone());
        }
        for (chamber, pressure) in self.chambers.iter().zip(pressures) {
            if !pressure.is_empty() {
                forces.push(Arc::new(chamber.force(&self.body, pressure)?));
            }
        }
        Ok(())
    }
}

/// Checks what can be known of a load beforehand.
fn check_load(kind: LoadKind, value: &VectorSignal, dimension: usize) -> Result<(), InputError> {
    let (one, varying, unit) = match kind {
        LoadKind::Each | LoadKind::Total => ("load", "a load", "N"),
        LoadKind::Traction => ("traction", "a traction", "N/m^2"),
    };
    let is_constant = matches!(value, VectorSignal::Constant(_));
    value.validate(if is_constant { one } else { varying }, dimension, unit)
}
