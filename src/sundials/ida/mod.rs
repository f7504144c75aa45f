//! IDA: systems of differential-algebraic equations.

mod options;
mod setup;
mod start;

pub use options::IdaOptions;
pub(super) use setup::BACKWARD;
pub use setup::{Ida, IdaKind};
pub use start::InitialCondition;
