//! The material laws, one file each, and their register: a new law is a file, a variant of [`Elastic`]
//! that [`Strain`] chooses, and a line in `with_law`.

mod linear;
mod objective_viscosity;
mod rivlin;
mod st_venant_kirchhoff;
#[cfg(test)]
mod tests;

pub(crate) use linear::Linear;
pub(crate) use objective_viscosity::ObjectiveViscosity;
pub(crate) use rivlin::Rivlin;
pub(crate) use st_venant_kirchhoff::StVenantKirchhoff;

use super::hooke::{Hooke, Lame, Plane};
use crate::input::{InputError, finite};

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

/// What becomes of the moduli of a [`Material`](crate::Material) at large strains. Each law has the material's Young's
/// modulus and Poisson's ratio at small strains; what else it has are ratios, without unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Hooke's law for Green's strain. It softens under compression, until a bar collapses that is pressed to 58 % of its length (1/sqrt 3).
    StVenantKirchhoff,
    /// W = c1 (I1 - 3) + U, with I1 of J^(-2/3) C and U = (kappa/4) (J^2 - 1 - 2 ln J); c1 = mu/2. Rubber at
    /// strains up to a half.
    NeoHookean,
    /// W = c1 (I1 - 3) + c2 (I2 - 3) + U, with 2 (c1 + c2) = mu.
    MooneyRivlin {
        /// c2 / (c1 + c2), 0 to 1.
        second: f64,
    },
    /// W = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3 + U, with 2 c1 = mu: rubber that stiffens.
    Yeoh {
        /// c2 / c1
        second: f64,
        /// c3 / c1
        third: f64,
    },
}

impl Law {
    pub(crate) fn validate(self) -> Result<(), InputError> {
        match self {
            Self::StVenantKirchhoff | Self::NeoHookean => Ok(()),
            Self::MooneyRivlin { second } => match (0.0..=1.0).contains(&second) {
                true => Ok(()),
                false => {
                    let mend = "c2 / (c1 + c2) lies between 0 and 1: neither c1 nor c2 is below 0, and their sum is above";
                    Err(InputError::new("law.second", second, mend))
                }
            },
            Self::Yeoh { second, third } => {
                finite("law.second", &[second])?;
                // dW/dI1 = c1 (1 + 2 second x + 3 third x^2), above 0 for all x = I1 - 3 >= 0
                let grows = third >= 0.0 && (second >= 0.0 || second * second < 3.0 * third);
                match grows {
                    true => finite("law.third", &[third]),
                    false => {
                        let mend = format!(
                            "with c2 / c1 = {second} stress falls with strain somewhere: c3 / c1 has to be 0 or above, and above (c2 / c1)^2 / 3 if c2 is below 0"
                        );
                        Err(InputError::new("law.third", third, mend))
                    }
                }
            }
        }
    }
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
    Rivlin(Rivlin),
}

impl Elastic {
    /// The law of cells of `cell_dimension`, `law` or else the one that `strain` stands for, with the moduli of `lame`.
    pub(crate) fn new(
        strain: Strain,
        law: Option<Law>,
        lame: Lame,
        cell_dimension: usize,
        plane: Plane,
    ) -> Self {
        let hooke = Hooke::new(lame, cell_dimension, plane);
        let c1 = lame.mu / 2.0;
        let rivlin = |first: [f64; 3], second: f64| {
            let bulk = lame.lambda + lame.mu * 2.0 / 3.0;
            Self::Rivlin(Rivlin { first, second, bulk, across: hooke.across })
        };
        match (law, strain) {
            (None, Strain::Cauchy) => Self::Linear(Linear(hooke)),
            (None | Some(Law::StVenantKirchhoff), _) => {
                Self::StVenantKirchhoff(StVenantKirchhoff(hooke))
            }
            (Some(Law::NeoHookean), _) => rivlin([c1, 0.0, 0.0], 0.0),
            (Some(Law::MooneyRivlin { second }), _) => {
                rivlin([c1 * (1.0 - second), 0.0, 0.0], c1 * second)
            }
            (Some(Law::Yeoh { second, third }), _) => rivlin([c1, c1 * second, c1 * third], 0.0),
        }
    }
}

/// Evaluates an expression with the law that an [`Elastic`] holds, compiled for each law by itself.
macro_rules! with_law {
    ($elastic:expr, $law:ident => $expression:expr) => {
        match $elastic {
            $crate::material::Elastic::Linear($law) => $expression,
            $crate::material::Elastic::StVenantKirchhoff($law) => $expression,
            $crate::material::Elastic::Rivlin($law) => $expression,
        }
    };
}
pub(crate) use with_law;

/// The same for tangents: those of linear elasticity are constant, and nothing needs to be compiled for them.
macro_rules! with_curved_law {
    ($elastic:expr, $law:ident => $expression:expr) => {
        match $elastic {
            $crate::material::Elastic::Linear(_) => {}
            $crate::material::Elastic::StVenantKirchhoff($law) => $expression,
            $crate::material::Elastic::Rivlin($law) => $expression,
        }
    };
}
pub(crate) use with_curved_law;
