//! Forces and moments on the cross sections of rods.

use std::sync::Arc;

use super::signal::VectorSignal;
use super::wrench_kind::WrenchKind;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::rod::{CrossSection, SectionLoad};
use crate::integrators::ode::Failure;

/// A moment on the cross sections of rods, or a force or a moment that follows them; each has an equal share.
pub(super) struct SectionWrench {
    kind: WrenchKind,
    sections: Vec<CrossSection>,
    dimension: usize,
    value: VectorSignal,
}

impl SectionWrench {
    pub(super) fn build(
        kind: WrenchKind,
        sections: Vec<CrossSection>,
        dimension: usize,
        value: &VectorSignal,
    ) -> Arc<dyn Force> {
        Arc::new(Self { kind, sections, dimension, value: value.clone() })
    }

    /// The share of each section at time `t` (s).
    fn load(&self, t: f64) -> Result<SectionLoad, Failure> {
        let count = self.sections.len() as f64;
        let given = self.kind.at(&self.value, self.dimension, t)?;
        let [force, moment] = given.map(|vector| (vector / count).into());
        Ok(SectionLoad { force, moment, follows: self.kind.follows() })
    }
}

impl Force for SectionWrench {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let load = self.load(t)?;
        self.sections.iter().for_each(|section| section.add_forces(&load, u, &mut forces.applied));
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        // the forces refuse a value that is not finite
        if let Ok(load) = self.load(t) {
            self.sections.iter().for_each(|section| section.add_tangents(&load, u, stiffness));
        }
        Tangents::Added
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.sections.iter().flat_map(CrossSection::nodes).copied().collect())
    }
}
