//! SUNDIALS
mod context;
mod cvode;
mod error;
mod ffi;
mod host;
mod ida;
mod linear;
mod matrix;
mod options;
mod pattern;
mod statistics;
mod vector;

pub use cvode::{Cvode, CvodeOptions, Multistep};
pub use error::{Callback, Cause, Error, IntegrationError};
pub use ida::{Ida, IdaOptions, InitialCondition};
pub use linear::{Jacobian, LinearSolver};
pub use options::{AbsoluteTolerance, Reached};
pub use pattern::Pattern;
pub use statistics::Statistics;
