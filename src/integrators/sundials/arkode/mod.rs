//! ARKODE: Runge-Kutta methods, implicit and explicit.

mod butcher_table;
mod mass;
mod options;
mod setup;

pub use butcher_table::ButcherTable;
pub use options::{ArkodeOptions, Predictor};
pub use setup::Arkode;
