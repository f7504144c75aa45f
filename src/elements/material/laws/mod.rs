//! The material laws: formulas one file each, their rows in `register.rs`, and here which formulas a law is evaluated by.

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
mod register;
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
pub(crate) use register::LAWS;
pub use register::{Law, LawConstant, LawInformation};
pub(crate) use rivlin::Rivlin;
pub(crate) use stretches::ByStretches;
use stretches::Kind;
pub(crate) use viscous::ViscousLaw;

use super::hooke::{Hooke, Lame, Plane};

/// Strain measure of a body, as a function of its displacements, and with it the elastic law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strain {
    /// Cauchy's small strain: force -K u, linear. Not invariant to rotation: a body that turns by
    /// theta swells as if strained by cos(theta) - 1.
    Cauchy,
    /// Green's strain E = (F^T F - I)/2, invariant to rotation: St. Venant-Kirchhoff material.
    #[default]
    Green,
}

/// Viscous force of a body as a function of its velocities.
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
    /// stress, with the rate of deformation d = sym(F' F^-1). A motion that keeps the volume is independent of lambda there, and a bar
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

/// Evaluates an expression with the law that an [`Elastic`] holds, compiled separately for each law.
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
