//! The material laws, one file each, and their register: a new law is a file, a variant of [`Elastic`]
//! that [`Strain`] chooses, and a line in `with_law`.

mod linear;
mod objective_viscosity;
mod st_venant_kirchhoff;
#[cfg(test)]
mod tests;

pub(crate) use linear::Linear;
pub(crate) use objective_viscosity::ObjectiveViscosity;
pub(crate) use st_venant_kirchhoff::StVenantKirchhoff;

use super::hooke::Hooke;

/// How the strain of a body follows from its displacements, and with it the elastic law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strain {
    /// Cauchy's small strain: force -K u, linear. Not invariant to rotation: a body that turns by
    /// theta swells as if strained by cos(theta) - 1.
    Cauchy,
    /// Green's strain E = (F^T F - I)/2, invariant to rotation: St. Venant-Kirchhoff material.
    #[default]
    Green,
}

/// How the viscous force of a body follows from its velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Viscosity {
    /// Force -B v with the constant B of the undeformed shape, as in Hirai. Not invariant to
    /// rotation: a body that spins as a whole is braked.
    Natural,
    /// Stress from the rate of Green's strain: a body that spins as a whole is not braked.
    Objective,
}

/// The elastic law of a cell, with its moduli.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Elastic {
    Linear(Linear),
    StVenantKirchhoff(StVenantKirchhoff),
}

impl Elastic {
    /// The law that `strain` stands for, with the moduli of `hooke` at small strains.
    pub(crate) fn new(strain: Strain, hooke: Hooke) -> Self {
        match strain {
            Strain::Cauchy => Self::Linear(Linear(hooke)),
            Strain::Green => Self::StVenantKirchhoff(StVenantKirchhoff(hooke)),
        }
    }
}

/// Evaluates an expression with the law that an [`Elastic`] holds, compiled for each law by itself.
macro_rules! with_law {
    ($elastic:expr, $law:ident => $expression:expr) => {
        match $elastic {
            $crate::material::Elastic::Linear($law) => $expression,
            $crate::material::Elastic::StVenantKirchhoff($law) => $expression,
        }
    };
}
pub(crate) use with_law;
