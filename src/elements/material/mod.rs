//! Isotropic viscoelastic materials, substances of bodies, and stress laws.

mod branch;
mod cell_law;
mod deformation;
mod fibres;
mod flow;
mod grown;
mod hooke;
mod law;
mod laws;
mod response;
mod rigid_mass;
mod substance;

pub use branch::MaxwellBranch;
pub(crate) use branch::{Relaxing, Strained, Stretch};
pub(crate) use cell_law::CellLaw;
pub(crate) use deformation::Deformation;
pub use fibres::{FibreDirection, Fibres};
pub(crate) use flow::{Components, Step, components, trace};
pub(crate) use grown::{GrownLaw, Stretches, along_cell};
pub(crate) use hooke::Hooke;
pub use hooke::{Lame, Plane};
pub(crate) use law::{Block, Blocks, ElasticLaw};
pub(crate) use laws::LAWS;
pub(crate) use laws::{
    ByPoint, Elastic, Fibre, Hookean, Linear, Maxwell, ObjectiveViscosity, Sprung, ViscousLaw,
    with_law,
};
pub use laws::{
    Hill, Law, LawConstant, LawInformation, OwnEnergy, Strain, StrainEnergy, Viscosity,
};
pub(crate) use response::axes;
pub use rigid_mass::{Moments, RigidMass};
pub use substance::Substance;

use crate::base::input::{InputError, not_negative, positive};

/// Isotropic material with linear elasticity and linear viscosity.
///
/// ```
/// let rubber = pliant::Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// let elastic = rubber.elastic();
/// assert!((elastic.mu - 1e6 / 2.96).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Density rho (kg/m^3), above 0.
    pub density: f64,
    /// Young's modulus E (Pa), above 0.
    pub young: f64,
    /// Poisson's ratio nu, above -1 and below 0.5.
    pub poisson: f64,
    /// Viscous modulus c (Pa s), 0 or above: the counterpart of E in the viscous Lamé pair.
    pub viscosity: f64,
}

/// Poisson's ratio from which a material is nearly incompressible: cells lock noticeably.
pub(crate) const NEARLY_INCOMPRESSIBLE: f64 = 0.45;

impl Material {
    pub(crate) fn is_nearly_incompressible(&self) -> bool {
        self.poisson >= NEARLY_INCOMPRESSIBLE
    }

    /// The elastic pair: lambda = nu E / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)).
    pub fn elastic(&self) -> Lame {
        lame(self.young, self.poisson)
    }

    /// The viscous pair: the same formula with c for E.
    pub fn viscous(&self) -> Lame {
        lame(self.viscosity, self.poisson)
    }

    /// The pair of `modulus`, which is like Young's, with a bulk modulus that stays that of a Poisson's ratio of
    /// [`NEARLY_INCOMPRESSIBLE`] above it.
    pub(crate) fn bounded(&self, modulus: f64) -> Lame {
        let pair = lame(modulus, self.poisson);
        if self.poisson <= NEARLY_INCOMPRESSIBLE {
            return pair;
        }
        let bulk = modulus / (3.0 * (1.0 - 2.0 * NEARLY_INCOMPRESSIBLE));
        Lame { lambda: bulk - 2.0 / 3.0 * pair.mu, ..pair }
    }

    /// Speed sqrt(E/rho) of a wave along a slender bar (m/s).
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("material.density", self.density, "kg/m^3")?;
        positive("material.young", self.young, "Pa")?;
        not_negative("material.viscosity", self.viscosity, "Pa s")?;
        if !(self.poisson > -1.0 && self.poisson < 0.5) {
            return Err(InputError::new(
                "material.poisson",
                self.poisson,
                "Poisson's ratio must lie above -1 and below 0.5, where lambda is infinite (rubber: 0.48 to 0.499)",
            ));
        }
        Ok(())
    }
}

fn lame(modulus: f64, poisson: f64) -> Lame {
    Lame {
        lambda: poisson * modulus / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
        mu: modulus / (2.0 * (1.0 + poisson)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_stretches_with_youngs_modulus() {
        for poisson in [0.0, 0.3, 0.48, -0.5] {
            let Lame { lambda, mu } = Hooke::new(lame(5e4, poisson), 1, Plane::Strain).lame;
            assert!((lambda + 2.0 * mu - 5e4).abs() < 1e-9);
        }
    }

    #[test]
    fn nonsense_is_named() {
        let good = Material { density: 1e3, young: 1e6, poisson: 0.48, viscosity: 40.0 };
        assert!(good.validate().is_ok());
        for (bad, name) in [
            (Material { density: -1.0, ..good }, "material.density = -1"),
            (Material { young: 0.0, ..good }, "material.young = 0"),
            (Material { poisson: 0.5, ..good }, "material.poisson = 0.5"),
            (Material { poisson: f64::NAN, ..good }, "material.poisson = NaN"),
            (Material { viscosity: -2.0, ..good }, "material.viscosity = -2"),
        ] {
            let message = bad.validate().unwrap_err().to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }
}
