//! Unknowns of a model, fitted to measurements: [`least_squares`] of any residuals, and [`SceneFit`] of
//! a scene file, in motion or in equilibria.

mod at_rest;
mod confidence;
mod least_squares;
mod measured;
mod rows;
mod scene;
mod unknown;

pub use least_squares::{Determined, Fitted, Residuals, least_squares};
pub use measured::{Measured, MeasuredAtRest};
pub use scene::{FittedColumn, SceneFit, SceneFitted};
pub use unknown::Unknown;
