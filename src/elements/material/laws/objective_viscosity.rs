//! Which law of objective viscosity a cell has.
//!
//! The bulk viscosity of the fluid is bounded by that of a Poisson's ratio of 0.45: changes of volume that
//! are not elastic, and laws that keep the volume to first order only (corotated), would depend on it. That takes
//! 0.84 % at most from the viscosity of a bar at small strains, nothing up to nu = 0.45. Cells that are free
//! to change their thickness keep lambda, reduced as in elasticity, which bounds it by 2 mu. The derivative
//! of objective viscosity by u is not symmetric: tangents are exact, and the Newton matrix has their
//! symmetric part. `docs/decisions/0006-isochoric-viscosity.md` has the reasons.

use super::hookean_viscosity::HookeanViscosity;
use super::newtonian::NewtonianViscosity;
use super::viscous::ViscousLaw;
use super::{Elastic, Hooke, Lame, Plane};
use crate::elements::material::Material;

/// Objective viscosity of a cell, by its elastic law.
///
/// Hooke's law for Green's strain resists a change of tr E, and motions of nearly incompressible material keep that: the
/// viscous stress is that law's for the rate of Green's strain. Under all other laws motions keep the volume, or nearly, while
/// tr E' grows with the stretch: there the stress is that of a Newtonian fluid.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ObjectiveViscosity {
    Hookean(HookeanViscosity),
    Newtonian(NewtonianViscosity),
}

impl ObjectiveViscosity {
    /// Beside the law `elastic` of cells of `dimension`.
    pub(crate) fn new(
        elastic: &Elastic,
        material: &Material,
        dimension: usize,
        plane: Plane,
    ) -> Self {
        let hooke = Hooke::new(material.viscous(), dimension, plane);
        match elastic {
            Elastic::StVenantKirchhoff(_) => Self::Hookean(HookeanViscosity(hooke)),
            // a free thickness follows the motion with any bulk viscosity
            _ if hooke.is_free_across(dimension) => Self::Newtonian(NewtonianViscosity(hooke)),
            _ => {
                let lame = material.bounded(material.viscosity);
                Self::Newtonian(NewtonianViscosity(Hooke::new(lame, dimension, plane)))
            }
        }
    }

    /// The same of cells of `dimension` that grow: a Newtonian fluid without bulk viscosity, in which isotropic
    /// growth causes no stress.
    pub(crate) fn of_growing(&self, dimension: usize) -> Self {
        let hooke = self.hooke();
        let lame = match hooke.is_free_across(dimension) {
            true => hooke.lame,
            false => Lame { lambda: -2.0 / 3.0 * hooke.lame.mu, ..hooke.lame },
        };
        Self::Newtonian(NewtonianViscosity(Hooke { lame, ..*hooke }))
    }

    /// None.
    pub(crate) fn zero(dimension: usize, plane: Plane) -> Self {
        let lame = Lame { lambda: 0.0, mu: 0.0 };
        Self::Hookean(HookeanViscosity(Hooke::new(lame, dimension, plane)))
    }

    fn hooke(&self) -> &Hooke {
        match self {
            Self::Hookean(law) => law.hooke(),
            Self::Newtonian(law) => law.hooke(),
        }
    }
}
