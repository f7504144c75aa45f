//! Adjoint gradients of differential-algebraic equations, by IDAS.

mod end;
mod problem;
mod setup;
mod system;

pub use setup::DaeAdjoint;
