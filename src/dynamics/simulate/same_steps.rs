//! Runs that list their steps, and runs that take those of another one.

use super::run::Run;
use super::simulation::Simulation;
use super::step_list::{Prescribed, StepList};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;
use crate::scene::settings::Method;

impl Simulation {
    /// Runs the rest of the scene, as [`finish`](Self::finish), and lists the steps.
    ///
    /// ```
    /// use pliant::{Method, Settings, samples};
    ///
    /// let settings = Settings { method: Method::Rosenbrock, rtol: 1e-3, ..Settings::default() };
    /// let start = || samples::square_press(4)?.start(&settings);
    /// let (motion, steps) = start()?.finish_with_steps()?;
    /// let again = start()?.finish_by_steps(&steps)?.expect("they are enough");
    /// assert_eq!(again.report().steps(), steps.count());
    /// assert!((again.last().u[8] - motion.last().u[8]).abs() < 1e-12);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`finish`](Self::finish).
    pub fn finish_with_steps(self) -> Result<(Trajectory, StepList), Error> {
        self.finish_noting(&mut |_, _| {})
    }

    /// As [`finish_with_steps`](Self::finish_with_steps); `note` is given the run after each step, and where the step begins and ends, as
    /// fractions of its interval.
    pub(super) fn finish_noting(
        mut self,
        note: &mut dyn FnMut(&Run, [f64; 2]),
    ) -> Result<(Trajectory, StepList), Error> {
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
            let fraction = |time: f64| (time - span[0]) / (stop - span[0]);
            intervals.last_mut().into_iter().for_each(|ends| ends.push(fraction(time)));
            note(&self.run, [before, time].map(fraction));
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
        self.run.prescribed = Some(Prescribed::new(steps.clone()));
        while self.advance()? {}
        Ok((self.run.steps == steps.count()).then(|| self.into_trajectory()))
    }
}
