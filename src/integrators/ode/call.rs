//! Calls of a system by integrators: its outputs are zero on entry.
//!
//! Outputs are memory of C, or hold results of the last call. All calls of equations go through these
//! functions, so that a system may add to its output (`tests/house.rs` looks for calls that bypass them).

use super::dae::Dae;
use super::failure::Failure;
use super::first_order::Ode;
use super::second_order::{Kick, SecondOrder};

/// Functions that clear the output `out`, the last argument of a method, and call it.
macro_rules! clearing {
    ($($name:ident: $system:ident::$method:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {
        $(
            #[allow(clippy::too_many_arguments)] // those of the method
            pub(crate) fn $name<S: $system + ?Sized>(
                system: &mut S,
                $($argument: $type,)*
                out: &mut [f64],
            ) -> $result {
                out.fill(0.0);
                system.$method($($argument,)* out)
            }
        )*
    };
}

type Outcome = Result<(), Failure>;

clearing! {
    rhs: Ode::rhs(t: f64, y: &[f64]) -> Outcome;
    explicit_rhs: Ode::explicit_rhs(t: f64, y: &[f64]) -> Outcome;
    newton_rhs: Ode::newton_rhs(t: f64, y: &[f64]) -> Outcome;
    jacobian_times: Ode::jacobian_times(t: f64, y: &[f64], ydot: &[f64], v: &[f64]) -> Outcome;
    roots: Ode::roots(t: f64, y: &[f64]) -> Outcome;
    quadratures: Ode::quadratures(t: f64, y: &[f64]) -> Outcome;
    sensitivity_rhs: Ode::sensitivity_rhs(
        t: f64, y: &[f64], ydot: &[f64], parameter: usize, s: &[f64]
    ) -> Outcome;
    adjoint_rhs: Ode::adjoint_rhs(t: f64, y: &[f64], lambda: &[f64]) -> Outcome;
    adjoint_parameters: Ode::adjoint_parameters(t: f64, y: &[f64], lambda: &[f64]) -> Outcome;

    residual: Dae::residual(t: f64, y: &[f64], yp: &[f64]) -> Outcome;
    dae_jacobian_times: Dae::jacobian_times(
        t: f64, cj: f64, y: &[f64], yp: &[f64], v: &[f64]
    ) -> Outcome;
    dae_roots: Dae::roots(t: f64, y: &[f64], yp: &[f64]) -> Outcome;
    dae_quadratures: Dae::quadratures(t: f64, y: &[f64], yp: &[f64]) -> Outcome;
    sensitivity_residual: Dae::sensitivity_residual(
        t: f64, y: &[f64], yp: &[f64], parameter: usize, s: &[f64], sp: &[f64]
    ) -> Outcome;
    adjoint_residual: Dae::adjoint_residual(
        t: f64, y: &[f64], yp: &[f64], lambda: &[f64], mu: &[f64]
    ) -> Outcome;
    dae_adjoint_parameters: Dae::adjoint_parameters(
        t: f64, y: &[f64], yp: &[f64], lambda: &[f64]
    ) -> Outcome;

    forces: SecondOrder::forces(t: f64, u: &[f64], v: &[f64]) -> Outcome;
    accelerations: SecondOrder::accelerations(kick: &Kick<'_>) -> ();
    powers: SecondOrder::powers(v: &[f64]) -> ();
}
