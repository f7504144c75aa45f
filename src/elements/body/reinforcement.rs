//! The fibres of a body with any elements.

use std::sync::Arc;

use super::assembly::Elements;
use super::fibres::Strings;
use super::offset::Offset;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::elements::material::{Fibre, Fibres};
use crate::elements::mesh::Mesh;
use crate::integrators::ode::Failure;

/// The families of fibres of a body, each with its law.
pub(super) type Families = Vec<(Box<dyn Strings>, Fibre)>;

/// The families of `substances`, each in the cells of its substance.
pub(super) fn families<'a>(
    mesh: &Mesh,
    elements: &dyn Elements,
    substances: impl Iterator<Item = (&'a [Fibres], Vec<usize>)>,
) -> Result<Families, InputError> {
    let mut families = Families::new();
    for (fibres, cells) in substances {
        if cells.is_empty() {
            continue;
        }
        for Fibres { course, young, stiffening } in fibres {
            let law = Fibre::Passive { young: *young, stiffening: *stiffening };
            families.push((elements.fibres(mesh, &cells, course)?, law));
        }
    }
    Ok(families)
}

/// The same families on the nodes of several bodies.
pub(super) fn among_others(families: &Families, offset: Offset) -> Families {
    families.iter().map(|(strings, law)| (strings.among_others(offset), *law)).collect()
}

/// Adds the tangents of families of fibres in the undeformed shape.
pub(super) fn add_at_rest(
    families: &Families,
    dofs: usize,
    stiffness: &mut BlockMatrix,
    damping: &mut BlockMatrix,
) {
    let rest = vec![0.0; dofs];
    families.iter().for_each(|(strings, law)| strings.add_tangents(law, &rest, stiffness, damping));
}

/// The forces of fibres.
pub(crate) struct Reinforcement(pub(super) Vec<Arc<Families>>);

impl Reinforcement {
    fn families(&self) -> impl Iterator<Item = &(Box<dyn Strings>, Fibre)> {
        self.0.iter().flat_map(|of_body| of_body.iter())
    }
}

impl Force for Reinforcement {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let conservative = &mut forces.conservative;
        self.families().try_for_each(|(strings, law)| strings.add_forces(law, u, conservative))
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        self.families().for_each(|(strings, law)| strings.add_tangents(law, u, stiffness, damping));
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        self.families().map(|(strings, law)| strings.energy(law, u)).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}
