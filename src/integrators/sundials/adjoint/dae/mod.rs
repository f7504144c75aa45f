//! Adjoint gradients of differential-algebraic equations, by IDAS.

mod end;
mod hessian;
mod problem;
mod setup;
mod system;

pub use setup::DaeAdjoint;
