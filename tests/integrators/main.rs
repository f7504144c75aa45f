//! The integrators by themselves: trusted numbers, control, failures.

mod support;

mod adjoint;
mod after_failures;
mod arkode;
mod automatic;
mod automatic_dae;
mod central_difference;
mod checks;
mod control;
mod cvode;
mod dae_adjoint;
mod failures;
mod golden_counts;
#[cfg(not(feature = "vendored"))]
mod headers;
mod ida;
mod imex;
mod index;
mod integral_sensitivities;
mod jacobians;
mod krylov;
mod krylov_failures;
mod lifecycle;
mod long_spans;
mod mass;
mod mass_matrix;
mod multirate;
mod outputs;
mod patterns;
mod projection;
mod quadratures;
mod random_problems;
mod rk;
mod roots;
mod rosenbrock;
mod sensitivities;
mod signs;
mod sparse;
mod stability_limit;
mod standard_problems;
mod step_control;
mod tableaux;
mod threads;
