//! The integrators by themselves: trusted numbers, control, failures.

mod support;

mod adjoint;
mod after_failures;
mod arkode;
mod central_difference;
mod checks;
mod control;
mod cvode;
mod dae_adjoint;
mod failures;
mod golden_counts;
mod ida;
mod imex;
mod index;
mod jacobians;
mod krylov;
mod krylov_failures;
mod lifecycle;
mod long_spans;
mod mass;
mod mass_matrix;
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
mod threads;
