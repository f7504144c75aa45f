//! IDA: systems of differential-algebraic equations.

mod options;
mod setup;
mod solver;
mod start;

pub use options::IdaOptions;
pub use setup::IdaKind;
pub use solver::Ida;
pub use start::{InitialCondition, StartsDae};
