//! A scene for many values of its keys: the values, the run of each, and the results.

mod condition;
mod factor;
mod outcome;
mod page;
mod plan;
mod plot;
mod points;
mod row;
mod run;
mod runner;
mod store;
mod table;

pub use condition::Condition;
pub use factor::MANY;
pub use outcome::Outcome;
pub use plan::{Plan, Point};
pub(crate) use points::{MOST_AXES, sobol};
pub use row::{Cost, Row, RowVerdict};
pub use run::{PointRun, Sweep};
pub use runner::{Runner, Watch};
pub use store::{Claim, Store};
pub use table::Results;
