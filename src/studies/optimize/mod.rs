//! Numbers of a scene, within ranges, that minimize or maximize a quantity of it, or reach a goal, found by gradients.
//!
//! A [`SceneOptimizer`] is of one quantity, or of several with goals, and any numbers of a scene file. Each evaluation is a
//! [`Gradient`](crate::gradient::Gradient), with its estimated errors; the search stops where these leave
//! nothing to gain. An optimum of squares against measurements is a [`SceneFit`](crate::fit::SceneFit).

mod answer;
mod evaluation;
mod model;
mod scene;
mod search;
mod table;

pub use answer::Optimum;
pub use evaluation::{Aim, Evaluation};
pub use scene::SceneOptimizer;
pub use search::Ending;
pub use table::EvaluationTable;
