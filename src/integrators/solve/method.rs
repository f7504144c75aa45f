//! The methods.

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

/// An integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Method {
    /// The method that leads farthest for its work, which is counted, never measured, and changes with the solution: that of Dormand and Prince;
    /// where stability limits its steps a Rosenbrock method or BDF, by tolerance and number of unknowns; and back.
    /// [`Solution::methods`](super::Solution::methods) tells which, when and why.
    ///
    /// Where only one method can do what is asked for, it is that one: IDA for DAEs and mass matrices; BDF for sensitivities, integrals,
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
    /// The limit of its steps for ODEs without a mass matrix.
    pub(super) fn limit(self) -> Limit {
        match self {
            Self::Bdf => Limit::Oscillations,
            Self::Adams => Limit::FastModes,
            Self::DormandPrince => Limit::Watched,
            method if method.is_explicit() => Limit::FastModes,
            _ => Limit::None,
        }
    }

    /// Its name in error messages.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Auto => "the automatic choice".into(),
            Self::Bdf => "CVODE's BDF".into(),
            Self::Adams => "CVODE's Adams methods".into(),
            Self::RungeKutta(table) => format!("ARKODE's {}", table.name()),
            Self::DormandPrince => "Dormand-Prince".into(),
            Self::Rosenbrock => "the Rosenbrock method".into(),
            Self::Ida => "IDA".into(),
        }
    }

    /// Whether it solves no linear systems.
    pub(super) fn is_explicit(self) -> bool {
        match self {
            Self::RungeKutta(table) => !table.is_implicit(),
            method => method == Self::DormandPrince,
        }
    }
}
