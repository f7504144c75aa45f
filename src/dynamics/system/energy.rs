//! Energies of a state.

use super::{System, flow_of};
use crate::dynamics::matrices::Matrices;
use crate::elements::force::{Forces, Reservoir};

/// Energies of a state (J).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energy {
    /// (1/2) v.M v, and that of liquids in pipes.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Potential of gravity, 0 at height 0.
    pub gravity: f64,
    /// Stored in the penalty springs of contacts.
    pub contact: f64,
    /// Stored in springs between nodes, and in gas in chambers and the air around them; of liquids that of their compression and
    /// their weight.
    pub springs: f64,
    /// Turned into heat since t = 0 by viscosity, damping and friction of contacts and pipes.
    pub dissipated: f64,
    /// Supplied since t = 0 by loads and constraints, and with gas and liquids that flow in.
    pub supplied: f64,
}

impl Energy {
    /// Kinetic + potential + dissipated - supplied: constant along an exact motion.
    pub fn balance(&self) -> f64 {
        let stored = self.strain + self.gravity + self.contact + self.springs;
        self.kinetic + stored + self.dissipated - self.supplied
    }

    /// Sum of all but gravity, whose zero is arbitrary, as the scale of the balance; potentials may be below 0.
    pub(crate) fn size(&self) -> f64 {
        let stored = self.strain.abs() + self.contact.abs() + self.springs.abs();
        self.kinetic + stored + self.dissipated.abs() + self.supplied.abs()
    }
}

impl System {
    /// (1/2) v.M v (J).
    pub(crate) fn kinetic_energy(&self, v: &[f64]) -> f64 {
        0.5 * self.matrices.square(v)
    }

    /// Kinetic and potential energies of a state; dissipated and supplied are left at 0. Without `internal` unknowns
    /// Maxwell branches have relaxed, and there is no gas that flows.
    pub(crate) fn energy(&self, t: f64, u: &[f64], v: &[f64], internal: &[f64]) -> Energy {
        self.energy_under(&self.forces, t, [u, v, internal])
    }

    /// The same under these `forces` and those of matrices, branches and flows.
    pub(crate) fn energy_under(
        &self,
        forces: &Forces,
        t: f64,
        [u, v, internal]: [&[f64]; 3],
    ) -> Energy {
        let Matrices { stiffness, linear_by_cells, branches, .. } = &*self.matrices;
        let mut energy = Energy {
            kinetic: self.kinetic_energy(v),
            strain: match linear_by_cells {
                Some(cells) => cells.energy(u),
                None => stiffness.as_ref().map_or(0.0, |k| 0.5 * k.quadratic_form(u)),
            },
            ..Energy::default()
        };
        let (strains, amounts) = self.layout.split(internal);
        self.set_lagging(t, internal);
        if let (Some(branches), [_, ..]) = (branches, strains) {
            energy.strain += branches.energy(u, strains);
        }
        if let (Some(flow), [_, ..]) = (flow_of(&self.flow), amounts) {
            energy.springs += flow.potential_of(u, amounts);
            energy.kinetic += flow.kinetic_of(amounts);
        }
        for force in forces {
            let potential = force.potential(t, u);
            match force.reservoir() {
                Reservoir::Strain => energy.strain += potential,
                Reservoir::Gravity => energy.gravity += potential,
                Reservoir::Contact => energy.contact += potential,
                Reservoir::Springs => energy.springs += potential,
                Reservoir::None => {}
            }
        }
        energy
    }
}
