//! Adjoint gradients of ordinary differential equations, by CVODES.

mod hessian;
mod problem;
mod setup;
mod system;

pub use setup::Adjoint;
