//! Isotropic viscoelastic material: what a body is made of.

use crate::input::{InputError, not_negative, positive};

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

/// Lamé's constants (Pa; Pa s for the viscous pair).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lame {
    /// First constant, lambda.
    pub lambda: f64,
    /// Second constant, mu (the shear modulus).
    pub mu: f64,
}

/// What a two-dimensional body assumes about the third dimension.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Plane {
    /// No strain across the plane (Hirai's choice): lambda as it is.
    #[default]
    Strain,
    /// No stress across the plane: lambda becomes 2 lambda mu / (lambda + 2 mu).
    Stress,
}

impl Material {
    /// The elastic pair: lambda = nu E / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)).
    pub fn elastic(&self) -> Lame {
        lame(self.young, self.poisson)
    }

    /// The viscous pair: the same formula with c for E.
    pub fn viscous(&self) -> Lame {
        lame(self.viscosity, self.poisson)
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

impl Lame {
    /// The pair for a cell of `cell_dimension`: cells of lower dimension than space have no stress
    /// across them, so that a segment stretches with E = lambda + 2 mu exactly.
    pub(crate) fn reduced(self, cell_dimension: usize, plane: Plane) -> Lame {
        let Lame { lambda, mu } = self;
        let lambda = match (cell_dimension, plane) {
            // E - 2 mu, with E = mu (3 lambda + 2 mu) / (lambda + mu)
            (1, _) if mu == 0.0 => 0.0,
            (1, _) => lambda * mu / (lambda + mu),
            (2, Plane::Stress) if mu == 0.0 => 0.0,
            (2, Plane::Stress) => 2.0 * lambda * mu / (lambda + 2.0 * mu),
            _ => lambda,
        };
        Lame { lambda, mu }
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
            let lame = lame(5e4, poisson).reduced(1, Plane::Strain);
            assert!((lame.lambda + 2.0 * lame.mu - 5e4).abs() < 1e-9);
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
