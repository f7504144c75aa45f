//! Gradients of a functional of the solution with respect to many parameters, by one run back in time.

mod dae;
mod equations;
mod gradient;
mod ode;
mod options;
mod way_back;

pub use dae::DaeAdjoint;
pub use gradient::Gradient;
pub use ode::Adjoint;
pub use options::AdjointOptions;
