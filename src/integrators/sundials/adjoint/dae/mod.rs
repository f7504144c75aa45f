//! Adjoint gradients of differential-algebraic equations, by IDAS.

mod end;
mod gmres;
mod hessian;
mod matrix_free;
mod problem;
mod products;
mod setup;
mod system;

pub use setup::DaeAdjoint;
