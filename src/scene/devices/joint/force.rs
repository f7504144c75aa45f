//! The force of what acts along the coordinate of a joint.

use super::coordinate::{At, Coordinate};
use super::coupling::Coupling;
use super::law::{JointLaw, Part};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::finite_at;
use crate::scene::timeline::DeviceSignals;

/// Spring, stops, damping, friction and motor of a joint, and the couplings by which it holds.
pub(super) struct JointForce {
    name: String,
    /// The coordinate, if anything acts along it.
    coordinate: Option<Coordinate>,
    couplings: Vec<Coupling>,
    law: JointLaw,
    inputs: DeviceSignals,
}

impl JointForce {
    pub(super) fn new(
        name: &str,
        (coordinate, couplings): (Option<Coordinate>, Vec<Coupling>),
        law: JointLaw,
        inputs: DeviceSignals,
    ) -> Self {
        let acts = law.is_of_state() || inputs.are_set();
        let coordinate = coordinate.filter(|_| acts);
        Self { name: name.into(), coordinate, couplings, law, inputs }
    }

    fn all_nodes(&self) -> Vec<usize> {
        let own = self.coordinate.iter().flat_map(Coordinate::nodes);
        let mut nodes: Vec<usize> =
            own.chain(self.couplings.iter().flat_map(Coupling::nodes)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The forces by their effect on the energy: elastic, resisting, of the motor.
    fn parts(&self, coordinate: &Coordinate, at: &At, t: f64) -> [Part; 3] {
        let wrapped = |difference| coordinate.wrapped(difference);
        let inputs = [0, 1, 2].map(|number| self.inputs.at(number, t)[0]);
        [
            self.law.elastic(at.value, wrapped),
            self.law.resistance(at.rate),
            self.law.motor(inputs, [at.value, at.rate], wrapped),
        ]
    }
}

impl Force for JointForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.couplings.iter().for_each(|coupling| coupling.add_forces(u, v, forces));
        let Some(coordinate) = &self.coordinate else { return Ok(()) };
        let at = coordinate.at(u, v, false);
        let [elastic, resisting, motor] = self.parts(coordinate, &at, t);
        finite_at(t, format_args!("the motor of joint \"{}\"", self.name), motor.force)?;
        coordinate.add_forces(&at, elastic.force, &mut forces.conservative);
        coordinate.add_forces(&at, resisting.force, &mut forces.dissipative);
        coordinate.add_forces(&at, motor.force, &mut forces.applied);
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        for coupling in &self.couplings {
            coupling.add_tangents(u, v, stiffness, damping);
        }
        let Some(coordinate) = &self.coordinate else { return Tangents::Added };
        let at = coordinate.at(u, v, true);
        let parts = self.parts(coordinate, &at, t);
        let force = parts.iter().map(|part| part.force).sum();
        let slopes = [0, 1].map(|way| parts.iter().map(|part| part.slopes[way]).sum());
        coordinate.add_tangents(&at, (force, slopes), stiffness, damping);
        Tangents::Added
    }

    fn is_nonlinear(&self) -> bool {
        self.coordinate.is_some() || !self.couplings.is_empty()
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let held: f64 = self.couplings.iter().map(|coupling| coupling.potential(u)).sum();
        let Some(coordinate) = &self.coordinate else { return held };
        // the value needs no velocities: those of the displacements do as well as any
        let value = coordinate.at(u, u, false).value;
        held + self.law.potential(value, |difference| coordinate.wrapped(difference))
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.all_nodes())
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        let nodes = self.all_nodes();
        let pairs = |k: usize| nodes[..k].iter().map(move |&other| (other, k));
        let pairs = (0..nodes.len()).flat_map(pairs);
        pairs.map(|(other, k)| [other, nodes[k]]).collect()
    }
}
