//! Rods as bodies: their forces, their options, their nodes.

use std::ops::Range;
use std::sync::Arc;

use super::assembled::Body;
use super::recipe::Recipe;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Reservoir, Tangents};
use crate::elements::material::{MaxwellBranch, Strain, Viscosity};
use crate::elements::mesh::Selection;
use crate::elements::rod::{Bend, CrossSection, RodElements, RodPoint, Tube, TubePiece};
use crate::integrators::ode::Failure;

/// The elastic and viscous forces of all rods.
pub(crate) struct RodForces {
    rods: Vec<Arc<RodElements>>,
}

impl Force for RodForces {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let NodalForces { conservative, dissipative, .. } = forces;
        self.rods.iter().try_for_each(|rod| rod.add_forces(u, v, conservative, dissipative))
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        self.rods.iter().for_each(|rod| rod.add_tangents(u, v, stiffness, damping));
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        self.rods.iter().map(|rod| rod.energy(u)).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Strain
    }
}

impl Body {
    /// The forces of its rods, if it has any.
    pub(crate) fn rod_forces(&self) -> Option<RodForces> {
        let rods: Vec<_> = self.continua.iter().filter_map(|own| own.rod.clone()).collect();
        (!rods.is_empty()).then_some(RodForces { rods })
    }

    /// The cross sections of rods at nodes of their axes, if each of the `nodes` (from 0) is one.
    pub(crate) fn sections_at(&self, nodes: &[usize]) -> Option<Vec<CrossSection>> {
        let at = |node: &usize| {
            self.continua
                .iter()
                .filter_map(|own| own.rod.as_ref())
                .find_map(|rod| rod.section_at(*node))
        };
        nodes.iter().map(at).collect()
    }

    /// Nodes (from 0) with their shares in the point of a rod that is undeformed at `x` (m), if it is within one.
    pub(super) fn shares_in_rods(&self, x: &[f64]) -> Option<Vec<(usize, f64)>> {
        self.continua.iter().filter_map(|own| own.rod.as_ref()).find_map(|rod| rod.shares_at(x))
    }

    /// Whether a node is that of a rod's axis or of a director.
    pub(crate) fn is_of_rod(&self, node: usize) -> bool {
        self.continua.iter().any(|own| own.rod.is_some() && own.nodes.contains(&node))
    }

    /// Points around the cross sections of rods: nodes with their shares, and the area (m^2) for which each stands.
    pub(crate) fn around_rods(&self) -> impl Iterator<Item = (RodPoint, f64)> {
        self.continua.iter().filter_map(|own| own.rod.as_ref()).flat_map(|rod| rod.around())
    }

    /// The [pieces](RodElements::tube_pieces) of the rod with these nodes, if it is one.
    pub(crate) fn tube_pieces(&self, nodes: &Range<usize>) -> Option<Option<Vec<TubePiece>>> {
        let own = self.continua.iter().find(|own| own.nodes == *nodes)?;
        own.rod.as_ref().map(|rod| rod.tube_pieces())
    }

    /// The [sharpest bend](RodElements::sharpest_bend) of a single body that is a rod.
    pub(crate) fn sharpest_bend(&self) -> Option<Bend> {
        self.continua[0].rod.as_ref().and_then(|rod| rod.sharpest_bend())
    }

    /// The [length and width](RodElements::extent) of a single body that is a rod.
    pub(crate) fn rod_extent(&self) -> Option<[f64; 2]> {
        self.continua[0].rod.as_ref().map(|rod| rod.extent())
    }

    /// The surface of a single body that is a rod.
    #[cfg(feature = "output")]
    pub(crate) fn tube(&self) -> Option<Tube> {
        self.continua[0].rod.as_ref().map(|rod| rod.tube())
    }

    /// Nodes of the axes of rods together with those of the cross sections there, which turn as these do.
    ///
    /// # Errors
    /// Nodes that do not exist, or are on the axis of no rod.
    pub fn with_sections(&self, nodes: &Selection) -> Result<Selection, InputError> {
        let Some(sections) = self.sections_at(&self.mesh().select(nodes)?) else {
            let help =
                "only nodes on the axis of a rod, such as its start, have cross sections that turn";
            return Err(InputError::new("rotation", nodes, help));
        };
        let all = sections.iter().flat_map(|section| section.nodes()).map(|node| node + 1);
        Ok(Selection::Numbers(all.collect()))
    }
}

impl Recipe {
    /// The elements of a rod, if it is one.
    ///
    /// # Errors
    /// Options that a rod does not have.
    pub(super) fn rod_elements(&self) -> Result<Option<RodElements>, InputError> {
        let Some(rod) = &self.rod else { return Ok(None) };
        let substance = &self.material;
        let name =
            self.name.as_deref().map_or_else(|| "rod".into(), |name| format!("rod \"{name}\""));
        let given = [
            ("law", substance.law.is_some()),
            (
                "yield stress of a Maxwell branch",
                substance.branches.iter().any(|branch| branch.yield_stress > 0.0),
            ),
            ("fibres", !substance.fibres.is_empty()),
            ("rigid material", substance.is_rigid),
            ("regions", !self.regions.is_empty()),
            ("thickness", self.thickness.is_some()),
            ("area", self.area.is_some()),
            ("plane", self.plane.is_some()),
            ("Cauchy strain", self.strain == Strain::Cauchy),
            ("natural viscosity", self.viscosity == Some(Viscosity::Natural)),
        ];
        if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
            let help = "its law is linear in stretch, shear, bending and twist, which it has from the moduli, the section, the viscosity and Maxwell branches without a \
                        yield stress: leave it out";
            return Err(InputError::new(name, *option, help));
        }
        substance.material.validate()?;
        substance.branches.iter().try_for_each(MaxwellBranch::validate)?;
        rod.elements(&substance.material, &substance.branches).map(Some)
    }
}
