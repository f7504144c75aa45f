//! Charts of speed against accuracy.
//!
//! A [`Study`] solves a [`Problem`] in several ways, its [`Line`]s, each at several [`Point`]s (tolerances,
//! or meshes), measures the time and the error of each, and gives [`Findings`]: a table of all runs, a
//! chart, and which line is the fastest for each accuracy.
//!
//! ```
//! use pliant::samples::beam_jump;
//! use pliant::study::{Scenes, Study};
//! use pliant::{Method, Settings};
//!
//! let mut scenes = Scenes::new("Jumping beam", beam_jump()?).tolerances([1e-3, 1e-5]);
//! for method in [Method::CvodeBdf, Method::Rk] {
//!     scenes = scenes.line(method.name(), Settings { method, ..Settings::default() });
//! }
//! let findings = Study::new(&mut scenes).run(&mut |stage| println!("{stage}"))?;
//! println!("{}", findings.fastest());
//! # assert_eq!(findings.lines().len(), 2);
//! # Ok::<(), pliant::Error>(())
//! ```
//!
//! **Error.** That of a scene is the distance of its nodes from their positions in the reference, root mean
//! square over nodes and over 101 times from start to end, relative to the motion: the root mean square
//! displacement of the same nodes at the same times in the reference. One number thus covers the whole motion
//! and not one instant, and means the same for large and small bodies. Motion below a millionth of the body's
//! size counts as that large. Where meshes differ, the nodes are those that all of them share. The error of a
//! general problem is relative, component by component, at its end. In addition to the mean, the table has
//! the largest value.
//!
//! **Reference.** It is computed by the two fastest of four methods (Adams, BDF, implicit and explicit
//! Runge-Kutta), at tolerances that are tightened until both agree to a thirtieth of the least error to be
//! measured, or agree no better. The distance between them is the *resolution* of the reference: errors below
//! ten times that are marked as not sure, and lines are not ranked at accuracies below it.
//!
//! **Time.** Wall-clock time of the whole solution, from the call to the end of the last phase, without
//! samples: the median of some repetitions (a run of more than half a second is run once). Runs never
//! overlap. Before and after each of them a fixed piece of arithmetic is timed, the yardstick: where it takes
//! longer than its least time, the machine was busy with other things, and the row has the ratio. Rows
//! have processor times, too, which are disturbed less.
//!
//! **Failures** are results. A run that fails, or that is abandoned because it takes more than twenty times
//! as long as the fastest at the same tolerance, is a row with its reason. Each row has the error of the
//! energy balance, which reveals most wrong answers that cause no failure.

mod chart;
pub(super) mod fastest;
mod findings;
pub(super) mod fingerprint;
pub(super) mod frame;
mod general;
pub(super) mod look;
mod mesh_estimate;
pub(super) mod quantity;
pub(super) mod rigid_motion;
mod row;
mod runner;
mod scenes;
mod standard;
mod swings;
pub(super) mod tightening;
pub(super) mod timing;
pub(super) mod truth;
mod verification;

pub use fastest::{Accuracy, Fastest, time_text};
pub use findings::{Findings, LineFindings};
pub use general::{EndState, General, Goal};
pub use look::Look;
pub use quantity::{Part, Quantity};
pub use row::Row;
pub use runner::{Stage, Study};
pub use scenes::{Scenes, all_methods};
pub use verification::Verification;

use std::time::Duration;

use crate::dynamics::error::Error;

/// Reason for a missing result of a run.
pub type Failed = Box<dyn std::error::Error + Send + Sync>;

/// Problem that is solved in several ways.
pub trait Problem {
    /// Name, for titles and tables.
    fn title(&self) -> &str;

    /// The ways to solve it.
    fn lines(&self) -> &[Line];

    /// Identifies this run of this problem: a result that was kept under the same
    /// fingerprint is not computed again.
    fn fingerprint(&self, line: usize, point: usize) -> u64;

    /// Gets the reference ready and returns its resolution, a relative error. Called once, before
    /// anything is measured; no single run may take more processor time than `limit`.
    ///
    /// # Errors
    /// Bad input; [`Error::Reference`].
    fn prepare(&mut self, limit: Duration, tell: &mut dyn FnMut(&str)) -> Result<f64, Error>;

    /// Solves the problem and compares with the reference.
    ///
    /// # Errors
    /// Reason for a missing solution, such as more processor time than `limit`.
    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed>;

    /// Solves the problem again and returns the time (s) that it took.
    ///
    /// # Errors
    /// Reason for a missing solution.
    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed>;
}

/// One way to solve a problem: a line of the chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Name, unique within the problem.
    pub name: String,
    /// Lines of one family share a colour.
    pub family: String,
    /// Its points, from rough to fine.
    pub points: Vec<Point>,
}

/// Fineness of a run: a point on a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Name, unique within the line: the tolerance or the mesh.
    pub name: String,
    /// Relative tolerance.
    pub rtol: f64,
}

/// Errors and costs of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Measured {
    /// Relative error, root mean square.
    pub error: f64,
    /// Relative error, largest.
    pub largest_error: f64,
    /// Time of this run (s), which may include more than [`Problem::time`].
    pub seconds: f64,
    /// Unknowns.
    pub states: usize,
    /// Steps.
    pub steps: usize,
    /// Evaluations of the right-hand side or residual.
    pub evaluations: usize,
    /// Factorizations of the Newton matrix.
    pub factorizations: usize,
    /// Largest change of the energy balance, relative to the largest sum of the energies.
    pub energy_error: Option<f64>,
}
