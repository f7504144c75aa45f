//! Multirate methods of ARKODE: fast parts of the equations by steps of their own.

mod coupling;
mod options;
mod setup;
mod solver;

pub use coupling::Coupling;
pub use options::MultirateOptions;
pub use solver::Multirate;
