//! Derivatives of an objective of a scene by numbers of its file, each with its estimated error.
//!
//! A [`SceneGradient`] is of one [`Objective`] and any numbers of a scene file. Three methods:
//!
//! - [`Method::Adjoint`]: the discrete adjoint of the steps of a run by a Rosenbrock method (`dynamics/simulate/adjoint.rs`), which gives the
//!   derivative of the computed motion by any number of numbers. A number costs evaluations of forces in the states of the run. Of an
//!   equilibrium the dual of its equations is solved (`at_rest.rs`).
//! - [`Method::SameSteps`]: a run by an own one-step method lists its steps, and runs with another number take the same ones. Their result
//!   is a smooth function of the number, so that central differences of a thousandth, extrapolated, are the derivative of the
//!   computed motion to eight digits or more. The difference from the derivative of the motion itself is estimated by a second tolerance.
//! - [`Method::Differences`]: whole runs or equilibria at a tight tolerance with several steps, extrapolated by Ridders' tableau. For
//!   everything: squares over several equilibria, phases that sensors end, numbers on which the number of unknowns or of steps depends.
//!
//! A derivative is [doubtful](Derivative::doubt) where the two tolerances disagree about it: nearby motions diverge faster than
//! any derivative says, by bounces or chaos.

mod answer;
mod at_rest;
mod method;
mod number;
mod objective;
mod runs;
mod scene;
mod tableau;

pub use answer::{Check, Derivative, Doubt, Gradient};
pub use method::Method;
pub(crate) use number::set;
pub use objective::Objective;
pub(crate) use objective::quantity;
pub use scene::SceneGradient;
