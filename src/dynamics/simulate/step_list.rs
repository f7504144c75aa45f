//! Runs by the steps of another run, for differences that are derivatives of the computed motion.
//!
//! The steps that error control chooses depend on every number of a scene, with jumps, so that differences of two runs have
//! errors of the tolerance divided by the difference. With the same steps the state at the end is a smooth function of the
//! numbers of the scene, and differences of a ten-thousandth are exact to nine digits ("internal numerical differentiation": H. G.
//! Bock, "Numerical treatment of inverse problems in chemical reaction kinetics", in: Modelling of Chemical Reaction
//! Systems, Springer, 1981). Steps are kept in parts of their interval, so that times of phases and of breaks may change, too.

use std::sync::Arc;

use super::simulation::Simulation;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::settings::Method;

/// Steps of a run, for other runs that take the same ones: for each interval the ends of its steps, as fractions of its length.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepList {
    intervals: Arc<[Vec<f64>]>,
}

impl StepList {
    /// Number of steps.
    pub fn count(&self) -> usize {
        self.intervals.iter().map(Vec::len).sum()
    }
}

/// A list of steps that a run follows, and its position there.
#[derive(Debug)]
pub(super) struct Prescribed {
    list: StepList,
    /// Intervals begun so far, and the start and the end of the present one (s).
    begun: usize,
    span: [f64; 2],
    /// The next step in that interval.
    next: usize,
}

impl Prescribed {
    /// Where the step from `time` ends (s), in an interval up to `stop` whose last step ends at `last` (s).
    pub(super) fn end(&mut self, time: f64, stop: f64, last: f64) -> f64 {
        if self.begun == 0 || self.span[1] != stop {
            (self.begun, self.span, self.next) = (self.begun + 1, [time, stop], 0);
        }
        let Some(fractions) = self.list.intervals.get(self.begun - 1) else { return last };
        let [start, stop] = self.span;
        while let Some(&fraction) = fractions.get(self.next).filter(|fraction| **fraction < 1.0) {
            let end = start + fraction * (stop - start);
            if end > time {
                return end;
            }
            self.next += 1;
        }
        last
    }
}

impl Simulation {
    /// Runs the rest of the scene, as [`finish`](Self::finish), and lists the steps.
    ///
    /// ```
    /// use pliant::{Method, Settings, samples};
    ///
    /// let settings = Settings { method: Method::Rosenbrock, rtol: 1e-3, ..Settings::default() };
    /// let start = || samples::square_press(3)?.start(&settings);
    /// let (motion, steps) = start()?.finish_with_steps()?;
    /// let again = start()?.finish_by_steps(&steps)?.expect("they are enough");
    /// assert_eq!(again.report().steps(), steps.count());
    /// assert!((again.last().u[8] - motion.last().u[8]).abs() < 1e-12);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub fn finish_with_steps(mut self) -> Result<(Trajectory, StepList), Error> {
        let mut intervals: Vec<Vec<f64>> = Vec::new();
        let (mut before, mut span) = (self.run.time, [f64::NAN; 2]);
        while self.advance()? {
            let (time, stop) = (self.run.time, self.run.phase_run.interval.stop);
            // a step that led through an obstacle was refused
            if time == before {
                continue;
            }
            if span[1] != stop {
                span = [before, stop];
                intervals.push(Vec::new());
            }
            let fraction = (time - span[0]) / (stop - span[0]);
            intervals.last_mut().into_iter().for_each(|ends| ends.push(fraction));
            before = time;
        }
        Ok((self.into_trajectory(), StepList { intervals: intervals.into() }))
    }

    /// Runs the scene from its start by the `steps` of another run, whatever their errors are: with a scene that differs in a number
    /// alone, the motion is a smooth function of that number. None if these steps were too few or too many.
    ///
    /// # Errors
    /// As [`finish`](Self::finish); a method other than [`Method::Rosenbrock`] and [`Method::Rk`].
    pub fn finish_by_steps(mut self, steps: &StepList) -> Result<Option<Trajectory>, Error> {
        let method = self.run.settings.method;
        if ![Method::Rosenbrock, Method::Rk].contains(&method) {
            let help = "the steps of another run are for rosenbrock and rk";
            return Err(InputError::new("method", method, help).into());
        }
        let list = steps.clone();
        self.run.prescribed = Some(Prescribed { list, begun: 0, span: [0.0; 2], next: 0 });
        while self.advance()? {}
        Ok((self.run.steps == steps.count()).then(|| self.into_trajectory()))
    }
}
