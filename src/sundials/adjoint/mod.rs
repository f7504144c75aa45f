//! Gradients of a functional of the solution with respect to many parameters, by one run back in time.

mod callbacks;
mod jacobian;
mod options;
mod run;
mod setup;
mod system;

pub use options::AdjointOptions;
pub use run::Gradient;
pub use setup::Adjoint;
