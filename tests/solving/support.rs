//! Problems with closed forms, and all methods.

use pliant::{
    ode::{Failure, Ode, with_parameters},
    solve::{Method, Options, Problem},
    sundials::ButcherTable,
};

/// All methods for ODEs. Miri, which knows no C, has that of Rust.
pub fn methods() -> Vec<Method> {
    if cfg!(miri) {
        return vec![Method::DormandPrince];
    }
    vec![
        Method::Bdf,
        Method::Adams,
        Method::RungeKutta(ButcherTable::implicit(5).unwrap()),
        Method::RungeKutta(ButcherTable::explicit(5).unwrap()),
        Method::DormandPrince,
    ]
}

/// Tolerances of which little is left in the comparisons.
pub fn tight() -> Options {
    Options::new(1e-10, 1e-12)
}

pub const G: f64 = 9.81;

/// Free fall: y = (height, velocity).
pub fn fall(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = y[1];
    ydot[1] = -G;
    Ok(())
}

/// The same under the gravity p0; what p1 is, events know.
pub fn fall_under<'a>(p: [f64; 2]) -> impl Ode + 'a {
    with_parameters(
        |_t, y, p, ydot| {
            ydot[0] = y[1];
            ydot[1] = -p[0];
            Ok(())
        },
        p,
    )
}

/// y'' = -y: y = (sin t, cos t) from (0, 1).
pub fn oscillator(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = y[1];
    ydot[1] = -y[0];
    Ok(())
}

/// The oscillator from (sin t, cos t) at t = 0.
pub fn sine<'a>() -> Problem<'a> {
    Problem::ode(oscillator, [0.0, 1.0])
}
