//! A reduced model held against a run with all unknowns.

use std::ops::ControlFlow;

use super::Tried;
use super::error::{distance, travel};
use super::runs::timed;
use crate::dynamics::error::Error;
use crate::scene::ReducedModel;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// Times at which the two motions are compared.
const SAMPLES: f64 = 100.0;

/// A run by a reduced model, beside that with all unknowns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verified {
    /// The run by the model.
    pub reduced: Tried,
    /// Time (s) that the run with all unknowns takes.
    pub full_seconds: f64,
}

/// Runs a scene with all its unknowns and by a reduced model, and compares both at a hundred times. The error is relative to the largest
/// displacement, in this run or in those that the model was checked with.
///
/// # Errors
/// A model of another scene; a run with all unknowns that fails. One by the model that fails has an infinite error.
pub fn verify(scene: &Scene, model: &ReducedModel, settings: &Settings) -> Result<Verified, Error> {
    let mut observer = || ControlFlow::Continue(());
    let short = scene.clone().reduced(model.clone())?;
    let whole = scene.clone().unreduced();
    let (full, full_seconds) = timed(&whole, settings, SAMPLES, &mut observer)?;
    let (error, told, seconds) = match timed(&short, settings, SAMPLES, &mut observer) {
        Ok((motion, seconds)) => {
            let told =
                motion.report().reduced.as_ref().map_or(0.0, |report| report.estimated_error);
            (distance(&full, &motion) / travel(&full).max(model.travel), told, seconds)
        }
        Err(Error::Integration(_)) => (f64::INFINITY, f64::INFINITY, f64::NAN),
        Err(error) => return Err(error),
    };
    let (unknowns, cells) = (model.unknowns(), model.cells());
    Ok(Verified { reduced: Tried { unknowns, cells, error, told, seconds }, full_seconds })
}
