//! ARKODE: Runge-Kutta methods, implicit and explicit.

mod butcher_table;
mod controller;
mod mass;
mod options;
mod setup;
mod tableau;

pub use butcher_table::ButcherTable;
pub use controller::Controller;
pub use options::{ArkodeOptions, Predictor};
pub use setup::Arkode;
pub use tableau::Tableau;
