//! The material laws, one file each, and their register: a new law is a file and a variant of [`ByPoint`].

mod by_point;
mod fibre;
mod hill;
mod hookean;
mod hookean_viscosity;
mod invariants;
mod maxwell;
mod newtonian;
mod objective_viscosity;
mod own;
mod principal;
mod rivlin;
mod stretches;
#[cfg(test)]
mod tests;
mod viscous;
mod volume;

pub(crate) use by_point::ByPoint;
pub(crate) use fibre::Fibre;
pub use hill::Hill;
pub(crate) use hookean::{Hookean, Linear, StVenantKirchhoff};
pub(crate) use maxwell::{Maxwell, Sprung};
pub(crate) use objective_viscosity::ObjectiveViscosity;
pub use own::{OwnEnergy, StrainEnergy};
pub(crate) use rivlin::Rivlin;
pub(crate) use stretches::ByStretches;
use stretches::Kind;
pub(crate) use viscous::ViscousLaw;

use super::hooke::{Hooke, Lame, Plane};
use crate::base::input::{InputError, finite};

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

/// The elastic law of a [`Material`](crate::Material) at large strains.
///
/// Each law has the material's Young's modulus and Poisson's ratio at small strains; its other parameters are
/// ratios, without unit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Law {
    /// Hooke's law for Green's strain. It softens under compression: a bar pressed to 58 % of its length
    /// (1/sqrt 3) collapses.
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
    /// W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) over three terms, + U, with the
    /// principal stretches l without the change of volume, J^(-1/3) times those of F: rubber over its whole
    /// range. The sum of mu_p alpha_p is 2 mu.
    Ogden {
        /// alpha_p (1), not 0
        exponents: [f64; 3],
        /// mu_p alpha_p / (2 mu) (1): none is below 0, and they add up to 1. A share of 0 leaves a term out.
        shares: [f64; 3],
    },
    /// W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with the stretch U of each point, U^2 = F^T F: Hooke's law
    /// in a frame that rotates with the point, for large rotations and small strains. Unlike St.
    /// Venant-Kirchhoff material it stays stiff under compression.
    Corotated,
    /// W = an energy that the program [defines](StrainEnergy), of the stretches without the change of volume, + U: see [`Law::own`].
    Own(OwnEnergy),
}

impl Law {
    /// The law of an energy of one's own: of a `static`, or a value that `Box::leak` keeps, as laws are copied to all places that need them.
    pub const fn own(energy: &'static impl StrainEnergy) -> Self {
        Self::Own(OwnEnergy::new(energy))
    }

    /// Its name, as in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::StVenantKirchhoff => "st-venant-kirchhoff",
            Self::NeoHookean => "neo-hookean",
            Self::MooneyRivlin { .. } => "mooney-rivlin",
            Self::Yeoh { .. } => "yeoh",
            Self::Ogden { .. } => "ogden",
            Self::Corotated => "corotated",
            Self::Own(_) => "own",
        }
    }

    pub(crate) fn validate(self) -> Result<(), InputError> {
        match self {
            Self::StVenantKirchhoff | Self::NeoHookean | Self::Corotated | Self::Own(_) => Ok(()),
            Self::MooneyRivlin { second } => match (0.0..=1.0).contains(&second) {
                true => Ok(()),
                false => {
                    let help = "c2 / (c1 + c2) lies between 0 and 1: neither c1 nor c2 is below 0, and their sum is above";
                    Err(InputError::new("law.second", second, help))
                }
            },
            Self::Ogden { exponents, shares } => {
                finite("law.exponents", &exponents)?;
                if let Some(share) = shares.iter().find(|share| !(0.0..=1.0).contains(*share)) {
                    let help = "a share mu_p alpha_p / (2 mu) lies between 0 and 1: below 0 its term would pull back where rubber is stretched";
                    return Err(InputError::new("law.shares", share, help));
                }
                let sum: f64 = shares.iter().sum();
                if (sum - 1.0).abs() > 1e-9 {
                    let help = format!(
                        "the shares mu_p alpha_p / (2 mu) of all terms add up to 1, and these to {sum}"
                    );
                    return Err(InputError::new("law.shares", format!("{shares:?}"), help));
                }
                let is_flat = |(exponent, share): (&f64, &f64)| *exponent == 0.0 && *share > 0.0;
                match exponents.iter().zip(&shares).any(is_flat) {
                    true => {
                        let help =
                            "an exponent of 0 has no energy: leave the term out by a share of 0";
                        Err(InputError::new("law.exponents", format!("{exponents:?}"), help))
                    }
                    false => Ok(()),
                }
            }
            Self::Yeoh { second, third } => {
                finite("law.second", &[second])?;
                // dW/dI1 = c1 (1 + 2 second x + 3 third x^2), above 0 for all x = I1 - 3 >= 0
                let grows = third >= 0.0 && (second >= 0.0 || second * second < 3.0 * third);
                match grows {
                    true => finite("law.third", &[third]),
                    false => {
                        let help = format!(
                            "with c2 / c1 = {second} stress falls with strain somewhere: c3 / c1 has to be 0 or above, and above (c2 / c1)^2 / 3 if c2 is below 0"
                        );
                        Err(InputError::new("law.third", third, help))
                    }
                }
            }
        }
    }
}

/// How the viscous force of a body follows from its velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Viscosity {
    /// Force -B v with the constant B of the undeformed shape, as in Hirai. Not invariant to
    /// rotation: a body that spins as a whole is braked.
    Natural,
    /// Stress from the rate of deformation of the present shape: a body that spins as a whole is not braked.
    ///
    /// Beside Hooke's law for Green's strain it is that law, with viscous moduli, for the rate of Green's strain: S = lambda tr(E')
    /// I + 2 mu E' is second Piola stress. Beside all other laws it is a Newtonian fluid: lambda tr(d) I + 2 mu d is Kirchhoff
    /// stress, with the rate of deformation d = sym(F' F^-1). A motion that keeps the volume does not feel lambda there, and a bar
    /// of rubber at the stretch l resists with 3 mu l'/l. From a Poisson's ratio of 0.45 on the bulk viscosity lambda + 2 mu / 3 of
    /// solids and of plane strain is that of 0.45, and in cells that grow it is 0.
    Objective,
}

/// The elastic law of a cell, with its moduli.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Elastic {
    Linear(Linear),
    StVenantKirchhoff(StVenantKirchhoff),
    ByPoint(ByPoint),
}

impl Elastic {
    /// The law of cells of `cell_dimension`: `law`, or else the one of `strain`, with the moduli of `lame`.
    pub(crate) fn new(
        strain: Strain,
        law: Option<Law>,
        lame: Lame,
        cell_dimension: usize,
        plane: Plane,
    ) -> Self {
        let hooke = Hooke::new(lame, cell_dimension, plane);
        let (c1, bulk) = (lame.mu / 2.0, lame.lambda + lame.mu * 2.0 / 3.0);
        let by_stretches =
            |kind| Self::ByPoint(ByPoint::Stretches(ByStretches { kind, across: hooke.across }));
        let rivlin = |first: [f64; 3], second: f64| {
            let across = hooke.across;
            Self::ByPoint(ByPoint::Rivlin(Rivlin { first, second, bulk, across }))
        };
        match (law, strain) {
            (None, Strain::Cauchy) => Self::Linear(Hookean(hooke)),
            (None | Some(Law::StVenantKirchhoff), _) => Self::StVenantKirchhoff(Hookean(hooke)),
            (Some(Law::NeoHookean), _) => rivlin([c1, 0.0, 0.0], 0.0),
            (Some(Law::MooneyRivlin { second }), _) => {
                rivlin([c1 * (1.0 - second), 0.0, 0.0], c1 * second)
            }
            (Some(Law::Ogden { exponents, shares }), _) => {
                let term = |p: usize| match shares[p] {
                    0.0 => [0.0, 1.0],
                    share => [2.0 * lame.mu * share / exponents[p], exponents[p]],
                };
                by_stretches(Kind::Ogden { terms: [term(0), term(1), term(2)], bulk })
            }
            (Some(Law::Own(energy)), _) => by_stretches(Kind::Own { energy, bulk }),
            (Some(Law::Corotated), _) => by_stretches(Kind::Corotated(lame)),
            (Some(Law::Yeoh { second, third }), _) => rivlin([c1, c1 * second, c1 * third], 0.0),
        }
    }

    /// The same as a function that loops call; none of small strain.
    pub(crate) fn called(&self) -> Option<ByPoint> {
        match self {
            Self::Linear(_) => None,
            Self::StVenantKirchhoff(law) => Some(ByPoint::Hooke(*law)),
            Self::ByPoint(law) => Some(*law),
        }
    }
}

/// Evaluates an expression with the law that an [`Elastic`] holds, compiled for each law by itself.
macro_rules! with_law {
    ($elastic:expr, $law:ident => $expression:expr) => {
        match $elastic {
            $crate::elements::material::Elastic::Linear($law) => $expression,
            $crate::elements::material::Elastic::StVenantKirchhoff($law) => $expression,
            $crate::elements::material::Elastic::ByPoint(
                $crate::elements::material::ByPoint::Hooke($law),
            ) => $expression,
            $crate::elements::material::Elastic::ByPoint(
                $crate::elements::material::ByPoint::Rivlin($law),
            ) => $expression,
            $crate::elements::material::Elastic::ByPoint(
                $crate::elements::material::ByPoint::Stretches($law),
            ) => $expression,
        }
    };
}
pub(crate) use with_law;
