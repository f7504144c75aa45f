//! The integrator of a phase by a reduced model: it integrates the unknowns of the model and returns states of all nodes.

use super::integrators::{IntoStepper, counts, ode};
use super::{Failed, Integrable, Start, Stepper};
use crate::base::input::InputError;
use crate::dynamics::reduced::ReducedSystem;
use crate::dynamics::report::Counts;
use crate::dynamics::system::PhaseSystem;
use crate::integrators::common::Integrator;
use crate::scene::settings::{Method, MotionForm};

/// An integrator of a reduced model.
struct Lifted<I> {
    integrator: I,
    /// The state at the end of the last step.
    state: Vec<f64>,
    /// Room for the unknowns of the model.
    seen: Vec<f64>,
}

impl Integrable for ReducedSystem {
    fn start(mut self: Box<Self>, start: &Start) -> Result<Box<dyn Stepper>, Failed> {
        let method = start.settings.method;
        if method.information().form != MotionForm::Ode {
            let takes = Method::names(|row| row.form == MotionForm::Ode);
            let help =
                format!("a reduced model is an ODE, without constraints: take one of {takes}");
            return Err(InputError::new("method", method, help).into());
        }
        let y = self.begin(start.time, start.state);
        let tolerances = self.tolerances(start.atol);
        ode(*self, tolerances, start, &y)
    }
}

impl IntoStepper for ReducedSystem {
    fn into_stepper(
        integrator: impl Integrator<System = Self> + Send + 'static,
    ) -> Box<dyn Stepper> {
        let seen = integrator.y().to_vec();
        let state = vec![0.0; integrator.system().full().layout().unknowns()];
        let mut lifted = Lifted { integrator, state, seen };
        lifted.follow();
        Box::new(lifted)
    }
}

impl<I: Integrator<System = ReducedSystem>> Lifted<I> {
    /// Updates the state to the end of the last step.
    fn follow(&mut self) {
        let t = self.integrator.t();
        self.seen.copy_from_slice(self.integrator.y());
        self.integrator.system_mut().lift(t, &self.seen, &mut self.state);
    }

    /// Sees the unknowns of the model in `state` at time `t` (s); `false` if it has none there.
    fn see(&mut self, t: f64, state: &[f64]) -> bool {
        // mostly where the last step has led to
        if t == self.integrator.t() && state == self.state {
            self.seen.copy_from_slice(self.integrator.y());
            return true;
        }
        let unknowns = self.integrator.system_mut().unknowns_of(t, state);
        unknowns.inspect(|unknowns| self.seen.copy_from_slice(unknowns)).is_some()
    }
}

impl<I: Integrator<System = ReducedSystem> + Send> Stepper for Lifted<I> {
    fn step(&mut self, end: f64) -> Result<f64, Failed> {
        let _ = self.integrator.step(end)?;
        self.follow();
        Ok(self.integrator.t())
    }

    fn stop_at(&mut self, t: f64) -> Result<(), Failed> {
        Ok(self.integrator.set_stop_time(Some(t))?)
    }

    fn resume(&mut self, t: f64, state: &[f64]) -> Result<bool, Failed> {
        let goes_on = self.see(t, state) && self.integrator.resume(t, &self.seen)?;
        if goes_on {
            self.state.copy_from_slice(state);
        }
        Ok(goes_on)
    }

    fn restart(&mut self, t: f64, state: &[f64]) -> Result<Option<Counts>, Failed> {
        if !self.see(t, state) {
            return Ok(None);
        }
        let counts = self.counts();
        self.integrator.reinit(t, &self.seen)?;
        self.integrator.system_mut().forget_counts();
        self.state.copy_from_slice(state);
        Ok(Some(counts))
    }

    fn interpolate(&mut self, t: f64, state: &mut [f64]) -> Result<(), Failed> {
        self.integrator.interpolate(t, 0, &mut self.seen)?;
        self.integrator.system_mut().lift(t, &self.seen, state);
        Ok(())
    }

    fn last_order(&self) -> u32 {
        self.integrator.last_order()
    }

    fn next_step(&self) -> f64 {
        self.integrator.statistics().current_step
    }

    fn state(&self) -> &[f64] {
        &self.state
    }

    fn unknowns(&self) -> usize {
        self.integrator.y().len()
    }

    fn system(&self) -> &dyn PhaseSystem {
        self.integrator.system()
    }

    fn system_mut(&mut self) -> &mut dyn PhaseSystem {
        self.integrator.system_mut()
    }

    fn into_system(self: Box<Self>) -> Box<dyn Integrable> {
        Box::new(self.integrator.into_system())
    }

    fn counts(&self) -> Counts {
        counts(&self.integrator, self.integrator.system())
    }
}
