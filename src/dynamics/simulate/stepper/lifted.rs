//! The integrator of a phase that is run by a reduced model: it takes the unknowns of that, and shows all others.

use super::{Failed, IntoStepper, Stepper, ode};
use crate::base::input::InputError;
use crate::dynamics::report::Counts;
use crate::dynamics::system::{Form, ReducedForm, System};
use crate::integrators::common::Integrator;
use crate::scene::settings::{AbsoluteTolerances, Method, Settings};

/// An integrator of a reduced model.
struct Lifted<I> {
    integrator: I,
    /// The state at the end of the last step.
    state: Vec<f64>,
    /// Room for the unknowns of the model.
    seen: Vec<f64>,
}

/// Starts the integrator that the settings name, as [`super::start`].
pub(super) fn start(
    system: System,
    settings: &Settings,
    atol: &AbsoluteTolerances,
    [t, end]: [f64; 2],
    first: Option<f64>,
    state: &[f64],
) -> Result<Box<dyn Stepper>, Failed> {
    let method = settings.method;
    if let Method::Ida | Method::IdaKlu | Method::IdaIndexTwo | Method::CentralDifference = method {
        let help = "a reduced model is an ODE, without constraints: take cvode-bdf, arkode, rosenbrock or rk";
        return Err(InputError::new("method", method, help).into());
    }
    let (is_linear, mass) = (system.is_linear(), system.mass());
    let of_amounts = system.flow_tolerances(atol.strain, atol.velocity);
    let Ok((equations, y)) = ReducedForm::new(system, t, state) else {
        return Err("the equations have no reduced model".into());
    };
    // shapes are orthonormal in M: a displacement of all nodes counts times the root of the mass
    let free = equations.free();
    let mut tolerances = vec![atol.position * mass.sqrt(); free];
    tolerances.resize(2 * free, atol.velocity * mass.sqrt());
    tolerances.extend(equations.branch_tolerances(atol.strain));
    tolerances.extend(of_amounts);
    tolerances.resize(y.len(), atol.energy);
    ode(equations, is_linear, settings, tolerances, [t, end], first, &y)
}

impl IntoStepper for ReducedForm {
    fn into_stepper<I>(end: f64, mut integrator: I) -> Result<Box<dyn Stepper>, Failed>
    where
        I: Integrator<System = Self> + Send + 'static,
    {
        integrator.set_stop_time(Some(end))?;
        let seen = integrator.y().to_vec();
        let state = vec![0.0; integrator.system().system().unknowns()];
        let mut lifted = Lifted { integrator, state, seen };
        lifted.follow();
        Ok(Box::new(lifted))
    }
}

impl<I: Integrator<System = ReducedForm>> Lifted<I> {
    /// Updates the state to the end of the last step.
    fn follow(&mut self) {
        let t = self.integrator.t();
        self.seen.copy_from_slice(self.integrator.y());
        self.integrator.system_mut().lift(t, &self.seen, &mut self.state);
    }
}

impl<I: Integrator<System = ReducedForm> + Send> Stepper for Lifted<I> {
    fn step(&mut self, end: f64) -> Result<f64, Failed> {
        let _ = self.integrator.step(end)?;
        self.follow();
        Ok(self.integrator.t())
    }

    fn stop_at(&mut self, t: f64) -> Result<(), Failed> {
        Ok(self.integrator.set_stop_time(Some(t))?)
    }

    fn resume(&mut self, t: f64, state: &[f64]) -> Result<bool, Failed> {
        // mostly where the last step has led to
        let y = match t == self.integrator.t() && state == self.state {
            true => Some(self.integrator.y().to_vec()),
            false => self.integrator.system_mut().unknowns_of(t, state),
        };
        let Some(y) = y else { return Ok(false) };
        let goes_on = self.integrator.resume(t, &y)?;
        if goes_on {
            self.state.copy_from_slice(state);
        }
        Ok(goes_on)
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

    fn system(&self) -> &System {
        self.integrator.system().system()
    }

    fn system_mut(&mut self) -> &mut System {
        self.integrator.system_mut().system_mut()
    }

    fn into_system(self: Box<Self>) -> System {
        self.integrator.into_system().into_system()
    }

    fn counts(&self) -> Counts {
        super::counts(&self.integrator)
    }
}
