//! Runs for a reduced model: with all unknowns, or by one that is tried.

use std::ops::ControlFlow;
use std::time::Instant;

use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::ReducedModel;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;

/// Samples of a run that is learned from or checked with.
pub(super) const SAMPLES: f64 = 200.0;

/// Summary of the runs of a reduced model.
pub(super) struct ByModel {
    /// The largest imbalance (m) and the largest displacement (m) that they tell.
    pub(super) lengths: [f64; 2],
    /// Time (s) of a run, the mean of those that came to their end.
    pub(super) seconds: f64,
    /// Reason of a failed run, if there was one.
    pub(super) problem: Option<Error>,
}

/// Runs scenes by a model, and passes each one to `see`, with its number and time (s), none where it failed, until `see` ends it.
///
/// # Errors
/// A model of another scene; runs that the observer has ended.
pub(super) fn run_by<'a>(
    model: &ReducedModel,
    scenes: impl Iterator<Item = &'a Scene>,
    settings: &Settings,
    observer: &mut dyn FnMut() -> ControlFlow<()>,
    mut see: impl FnMut(usize, Option<(Trajectory, f64)>) -> ControlFlow<()>,
) -> Result<ByModel, Error> {
    let mut lengths = [0.0_f64; 2];
    let (mut seconds, mut problem) = (Vec::new(), None);
    for (number, scene) in scenes.enumerate() {
        let scene = scene.clone().reduced(model.clone())?;
        let run = match timed(&scene, settings, SAMPLES, observer) {
            Ok((run, time)) => {
                if let Some(report) = &run.report().reduced {
                    lengths
                        .iter_mut()
                        .zip(report.lengths())
                        .for_each(|(most, x)| *most = most.max(x));
                }
                seconds.push(time);
                Some((run, time))
            }
            Err(Error::Integration(failed)) if failed.is_interruption() => {
                return Err(Error::Integration(failed));
            }
            Err(failed) => {
                problem = Some(failed);
                None
            }
        };
        if see(number, run).is_break() {
            break;
        }
    }
    Ok(ByModel { lengths, seconds: mean(seconds.into_iter()), problem })
}

/// A run with so many samples, and the time (s) that it takes.
pub(super) fn timed(
    scene: &Scene,
    settings: &Settings,
    samples: f64,
    observer: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<(Trajectory, f64), Error> {
    let clock = Instant::now();
    let sampling = Sampling::every(scene.end() / samples).keeping_lacking();
    let run = scene.simulate_with(settings, &sampling, |_| observer())?;
    Ok((run, clock.elapsed().as_secs_f64()))
}

pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}
