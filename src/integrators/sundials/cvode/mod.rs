//! CVODE: stiff and non-stiff systems of ordinary differential equations.

mod options;
mod setup;

pub use options::{CvodeOptions, Multistep};
pub use setup::{Cvode, CvodeKind};
