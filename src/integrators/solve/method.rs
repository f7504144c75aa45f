//! The methods, each with its facts in one row.

use std::{fmt, str::FromStr};

use crate::base::input::InputError;
use crate::integrators::sundials::ButcherTable;

/// A method at work, from a time on.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct MethodUse {
    /// Time of its start.
    pub t: f64,
    /// The method.
    pub method: Method,
    /// Why it is used.
    pub reason: String,
}

/// An integration method: [`information`](Self::information) has the facts of each, and a method is read from its word there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Method {
    /// The method that advances farthest per work, which is counted, never measured; it changes with the solution: that of Dormand and Prince;
    /// where stability limits its steps a Rosenbrock method or BDF, by tolerance and number of unknowns; and back. (Where stability limits them by
    /// fast vibrations that are not damped, it stays with explicit steps, which excite these up to the tolerances: name an implicit method
    /// if they are not to be followed.)
    /// [`Solution::methods`](super::Solution::methods) lists the methods in use, with time and reason.
    ///
    /// Where only one method supports the problem and options, it is that one: IDA for DAEs and mass matrices; BDF for sensitivities, integrals,
    /// gradients, projection, signs of unknowns, bounds of steps or orders, and backward in time.
    Auto,
    /// CVODE, backward differentiation formulas of order 1 to 5: for stiff ODEs.
    Bdf,
    /// CVODE, Adams-Moulton formulas of order 1 to 12, with a Newton iteration: for smooth ODEs whose
    /// right-hand side is costly.
    Adams,
    /// ARKODE, the Runge-Kutta method of this table: diagonally implicit for stiff ODEs, above all those that
    /// vibrate; or explicit.
    RungeKutta(ButcherTable),
    /// The internal explicit method of Dormand and Prince, order 5(4): for ODEs that are not stiff. Forward
    /// in time.
    DormandPrince,
    /// The internal Rosenbrock methods of order 4 and, by `max_order`, 3: for stiff ODEs at moderate
    /// tolerances, without an iteration that could fail. Forward in time.
    Rosenbrock,
    /// IDA, backward differentiation formulas of order 1 to 5: for DAEs, and for ODEs whose mass matrix may
    /// be singular.
    Ida,
}

/// Facts of a [`Method`]: words, refusals and messages follow from them, here and in the Python module.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MethodInformation {
    /// The word for it, from which it is read, and by which [`Display`](fmt::Display) writes it; for a Runge-Kutta method the name of its table.
    pub name: &'static str,
    /// Its name in error messages.
    pub long_name: &'static str,
    /// Whether it solves linear systems; else stability bounds its steps.
    pub is_implicit: bool,
    /// Whether it integrates backward in time, too.
    pub goes_backward: bool,
    /// The supported mass matrices M in M y' = f(t, y).
    pub mass: MassMatrices,
    /// Whether it is a multistep method of SUNDIALS, and so computes integrals, sensitivities and gradients.
    pub has_sensitivities: bool,
    /// Whether it has a choice of orders: [`Options::max_order`](super::Options::max_order).
    pub has_orders: bool,
    /// Whether it has a lower bound of steps and keeps signs of unknowns.
    pub(super) has_bounds: bool,
    /// The limit of its steps for ODEs without a mass matrix.
    pub(super) limit: Limit,
}

/// Mass matrices that a method supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MassMatrices {
    /// None but the identity.
    None,
    /// Regular ones.
    Regular,
    /// Singular ones, too.
    Singular,
}

/// The limit of the steps of a method, besides accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Limit {
    /// Nothing, or it is unknown.
    None,
    /// Any fast mode.
    FastModes,
    /// The same, and the integrator itself watches for them.
    Watched,
    /// Fast oscillations, at orders from 3 on.
    Oscillations,
}

impl Method {
    /// The methods that are no tables of ARKODE.
    const NAMED: [Self; 6] =
        [Self::Auto, Self::Bdf, Self::Adams, Self::DormandPrince, Self::Rosenbrock, Self::Ida];

    /// The facts of the method, its row.
    #[must_use]
    pub fn information(self) -> MethodInformation {
        // what most have
        let multistep = MethodInformation {
            name: "bdf",
            long_name: "CVODE's BDF",
            is_implicit: true,
            goes_backward: true,
            mass: MassMatrices::None,
            has_sensitivities: true,
            has_orders: true,
            has_bounds: true,
            limit: Limit::Oscillations,
        };
        let internal = MethodInformation {
            goes_backward: false,
            has_sensitivities: false,
            has_bounds: false,
            ..multistep
        };
        match self {
            Self::Auto => MethodInformation {
                name: "auto",
                long_name: "the automatic choice",
                mass: MassMatrices::Singular,
                limit: Limit::None,
                ..multistep
            },
            Self::Bdf => multistep,
            Self::Adams => MethodInformation {
                name: "adams",
                long_name: "CVODE's Adams methods",
                limit: Limit::FastModes,
                ..multistep
            },
            Self::RungeKutta(table) => MethodInformation {
                name: table.name(),
                long_name: table.name(),
                is_implicit: table.is_implicit(),
                mass: MassMatrices::Regular,
                has_sensitivities: false,
                has_orders: false,
                limit: if table.is_implicit() { Limit::None } else { Limit::FastModes },
                ..multistep
            },
            Self::DormandPrince => MethodInformation {
                name: "dormand-prince",
                long_name: "Dormand-Prince",
                is_implicit: false,
                has_orders: false,
                limit: Limit::Watched,
                ..internal
            },
            Self::Rosenbrock => MethodInformation {
                name: "rosenbrock",
                long_name: "the Rosenbrock method",
                limit: Limit::None,
                ..internal
            },
            Self::Ida => MethodInformation {
                name: "ida",
                long_name: "IDA",
                mass: MassMatrices::Singular,
                limit: Limit::None,
                ..multistep
            },
        }
    }

    /// Its name in error messages.
    #[must_use]
    pub fn name(self) -> String {
        let name = self.information().long_name;
        if matches!(self, Self::RungeKutta(_)) { format!("ARKODE's {name}") } else { name.into() }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.information().name)
    }
}

impl FromStr for Method {
    type Err = InputError;

    /// Reads the [name](MethodInformation::name) of a method, or of a table of ARKODE.
    fn from_str(name: &str) -> Result<Self, InputError> {
        if let Some(method) = Self::NAMED.into_iter().find(|m| m.information().name == name) {
            return Ok(method);
        }
        name.parse().map(Self::RungeKutta).map_err(|_| {
            let names = Self::NAMED.map(|method| method.information().name).join(", ");
            let help = format!(
                "it is one of {names}, or a table of ARKODE, such as {}",
                ButcherTable::default()
            );
            InputError::new("method", format!("\"{name}\""), help)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_they_are_written() {
        let tables = ButcherTable::ALL.into_iter().chain(ButcherTable::IMEX);
        let all = Method::NAMED.into_iter().chain(tables.map(Method::RungeKutta));
        for method in all {
            assert_eq!(method.to_string().parse::<Method>(), Ok(method));
        }
        let error = "RK5".parse::<Method>().unwrap_err().to_string();
        assert!(error.contains("RK5") && error.contains("rosenbrock") && error.contains("ARKODE"));
    }
}
