//! ARKODE: Runge-Kutta methods, implicit and explicit.

mod butcher_table;
mod controller;
mod mass;
mod options;
mod setup;
mod stages;
mod tableau;

pub use butcher_table::ButcherTable;
pub use controller::Controller;
pub use options::ArkodeOptions;
pub use setup::{Arkode, ArkodeKind};
pub use stages::Predictor;
pub(super) use stages::{OfStages, StageOptions};
pub use tableau::Tableau;
