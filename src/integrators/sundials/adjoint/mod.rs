//! Gradients of a functional of the solution with respect to many parameters, by one run back in time.

mod backward;
mod dae;
mod doubled;
mod equations;
mod gradient;
mod ode;
mod options;
mod parameters;
mod setup;
mod slopes;

pub use dae::DaeAdjoint;
pub use gradient::Gradient;
pub use ode::Adjoint;
pub use options::AdjointOptions;
pub use setup::AdjointOf;
