//! Fibres with an active stress: muscles.

use super::assembled::Body;
use super::contraction::Contraction;
use super::fibres::Strings;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::material::{Fibre, FibreDirection, Strain};
use crate::integrators::ode::Failure;

/// Fibres through some cells of a body, which pull by a stress of their own.
pub(crate) struct Strands {
    parts: Vec<Box<dyn Strings>>,
    /// Natural volume of their cells (m^3).
    volume: f64,
}

impl Strands {
    /// Adds the nodal forces of a `stress` along them, a force per natural section (Pa).
    pub(crate) fn add_forces(
        &self,
        stress: f64,
        u: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Failure> {
        let law = Fibre::Active { stress };
        self.parts.iter().try_for_each(|part| part.add_forces(&law, u, forces))
    }

    /// Adds the tangents of a `stress` (Pa) to the stiffness; the damping does not change.
    pub(crate) fn add_tangents(
        &self,
        stress: f64,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let law = Fibre::Active { stress };
        self.parts.iter().for_each(|part| part.add_tangents(&law, u, stiffness, damping));
    }

    /// Adds the nodal forces of a contraction by Hill's law.
    pub(crate) fn contract(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Failure> {
        self.parts.iter().try_for_each(|part| part.contract(contraction, u, v, forces))
    }

    /// Adds its tangents to the stiffness and the damping.
    pub(crate) fn add_contraction_tangents(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let parts = self.parts.iter();
        parts.for_each(|part| {
            part.add_contraction_tangents(contraction, u, v, stiffness, damping);
        });
    }

    /// The mean over their volume of the stress (Pa) by which they pull in a contraction.
    pub(crate) fn mean_pull(&self, contraction: Contraction, u: &[f64], v: &[f64]) -> f64 {
        let total: f64 = self.parts.iter().map(|part| part.total_pull(contraction, u, v)).sum();
        total / self.volume
    }

    /// The mean over their volume of how much longer they are than in the undeformed shape, as a factor.
    pub(crate) fn mean_stretch(&self, u: &[f64]) -> f64 {
        let law = Fibre::Active { stress: 1.0 };
        1.0 + self.parts.iter().map(|part| part.energy(&law, u)).sum::<f64>() / self.volume
    }
}

impl Body {
    /// Fibres of a `course` through some `cells`, counted from 0.
    ///
    /// # Errors
    /// Vectors of another dimension; a point where they have no direction; cells that are rigid, or whose strain is
    /// Cauchy's.
    pub(crate) fn strands(
        &self,
        cells: &[usize],
        course: &FibreDirection,
    ) -> Result<Strands, InputError> {
        let mut parts = Vec::new();
        for own in &self.continua {
            let inside = cells.iter().filter(|cell| own.cells.contains(cell));
            let inside: Vec<usize> = inside.map(|cell| cell - own.cells.start).collect();
            if inside.is_empty() {
                continue;
            }
            if own.strain == Strain::Cauchy {
                let help =
                    "its fibres turn with the body, which is not linear: measure strain by Green's";
                return Err(InputError::new("strain", "Cauchy", help));
            }
            if let Some(cell) = inside.iter().find(|cell| own.regions.of(**cell).of_rigid.is_some())
            {
                let help = "it is rigid, so that nothing can contract it: name cells that are soft";
                return Err(InputError::new("cell", own.cells.start + cell + 1, help));
            }
            parts.push(own.elements.fibres(&self.mesh, &inside, course)?);
        }
        let volume = parts.iter().map(|part| part.volume()).sum();
        Ok(Strands { parts, volume })
    }
}
