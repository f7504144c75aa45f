//! The integrator of a phase in all unknowns: created from the settings and used through one interface, in any form of the
//! equations.

use std::mem::take;

use super::{Failed, Integrable, Start, Stepper};
use crate::dynamics::report::Counts;
use crate::dynamics::system::{DaeForm, Form, Index, PhaseSystem, SecondOrderForm, System};
use crate::integrators::central_difference::CentralDifference;
use crate::integrators::common::Integrator;
use crate::integrators::ode::{Failure, Ode};
use crate::integrators::rk::{self, DormandPrince};
use crate::integrators::rosenbrock::{self, Rosenbrock};
use crate::integrators::sundials::{
    Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, LinearSolver,
    Multistep,
};
use crate::scene::settings::{Method, Settings};

/// An integrator of the equations of a phase in one of their forms.
struct Driven<I, B> {
    integrator: I,
    /// Starts the integrator again from a state at a time (s); `false` if that needs a new one.
    begin: B,
}

impl<I, B> Stepper for Driven<I, B>
where
    I: Integrator<System: Form> + Send,
    B: FnMut(&mut I, f64, &[f64]) -> Result<bool, Failed> + Send,
{
    fn step(&mut self, end: f64) -> Result<f64, Failed> {
        keep_end(&mut self.integrator);
        let _ = self.integrator.step(end)?;
        keep_end(&mut self.integrator);
        Ok(self.integrator.t())
    }

    fn stop_at(&mut self, t: f64) -> Result<(), Failed> {
        Ok(self.integrator.set_stop_time(Some(t))?)
    }

    fn resume(&mut self, t: f64, state: &[f64]) -> Result<bool, Failed> {
        Ok(state.len() == self.unknowns() && self.integrator.resume(t, state)?)
    }

    fn restart(&mut self, t: f64, state: &[f64]) -> Result<Option<Counts>, Failed> {
        let counts = self.counts();
        if !(self.begin)(&mut self.integrator, t, state)? {
            return Ok(None);
        }
        self.integrator.system_mut().forget_counts();
        Ok(Some(counts))
    }

    fn interpolate(&mut self, t: f64, state: &mut [f64]) -> Result<(), Failed> {
        self.integrator.interpolate(t, 0, state)?;
        self.integrator.system_mut().full_mut().settle(t, state);
        Ok(())
    }

    fn last_order(&self) -> u32 {
        self.integrator.last_order()
    }

    fn next_step(&self) -> f64 {
        self.integrator.statistics().current_step
    }

    fn state(&self) -> &[f64] {
        self.integrator.y()
    }

    fn system(&self) -> &dyn PhaseSystem {
        self.integrator.system()
    }

    fn system_mut(&mut self) -> &mut dyn PhaseSystem {
        self.integrator.system_mut()
    }

    fn into_system(self: Box<Self>) -> Box<dyn Integrable> {
        Box::new(self.integrator.into_system().into_system())
    }

    fn counts(&self) -> Counts {
        counts(&self.integrator, self.system())
    }
}

/// Lets the system store the reached state, for interpolation.
fn keep_end<I: Integrator<System: Form>>(integrator: &mut I) {
    let mut ends = take(Integrator::system_mut(integrator).full_mut().ends_mut());
    let system = Integrator::system(integrator).full();
    system.keep_end(&mut ends, integrator.t(), integrator.y());
    *Integrator::system_mut(integrator).full_mut().ends_mut() = ends;
}

/// Statistics of an integrator and its equations.
pub(super) fn counts<I: Integrator>(integrator: &I, equations: &dyn PhaseSystem) -> Counts {
    let (s, system) = (integrator.statistics(), equations.full());
    let [spared, linear_iterations, indefinite] = system.newton_counts();
    Counts {
        steps: s.steps as usize,
        evaluations: s.evaluations as usize,
        jacobian_evaluations: equations.tangent_evaluations(),
        difference_evaluations: equations.difference_evaluations(),
        factorizations: (s.linear_setups as usize).saturating_sub(spared),
        linear_iterations,
        error_test_failures: s.error_test_failures as usize,
        convergence_failures: (s.nonlinear_failures + s.refused_steps) as usize,
        pattern_changes: system.pattern_changes(),
        contact_events: 0,
        last_step: s.last_step,
        last_order: s.last_order,
        // where surfaces rotate about each other contact needs a few
        notice: stabilization(integrator, system).or_else(|| integrator.notice()).or_else(|| {
            let has_met = system.pattern_changes() > 0;
            let few = if has_met { 2 + s.linear_setups as usize / MANY } else { 0 };
            // where a rigid piece is compressed, the forces of its edges are not in M + gamma^2 Kt
            let told = if system.has_edges() { 0 } else { indefinite.saturating_sub(few) };
            compression(told)
        }),
    }
}

/// Largest observed rate of a double eigenvalue -alpha, over alpha.
const DOUBLE: f64 = 1.5;

/// A notice if the stabilization of constraints bounds the steps of an explicit method: no motion does.
fn stabilization<I: Integrator>(integrator: &I, system: &System) -> Option<String> {
    let (rate, alpha) = (integrator.bounding_rate()?, system.alpha());
    (system.is_constrained() && rate < DOUBLE * alpha).then(|| {
        format!(
            "alpha, by which constraints are stabilized, bounds the steps to 3.3/alpha = {:.2e} s, no motion of the body: lower alpha, or \
             use another method, which alpha costs nothing",
            3.3 / alpha
        )
    })
}

/// Factorizations for each one of a matrix that is not positive definite, where bodies have met.
const MANY: usize = 20;

/// A notice if Newton matrices were not positive definite.
fn compression(indefinite: usize) -> Option<String> {
    (indefinite > 0).then(|| {
        format!(
            "{indefinite} Newton matrices were not positive definite, which costs time: at states that were tried and given \
             up, or because friction falls with the speed, or because compression brings the body near buckling; check \
             whether that is physical"
        )
    })
}

impl Integrable for System {
    fn start(self: Box<Self>, start: &Start) -> Result<Box<dyn Stepper>, Failed> {
        let mut system = *self;
        let Start { settings, atol, state, time: t, first, .. } = *start;
        let layout = system.layout();
        let mut tolerances = vec![atol.position; layout.dofs];
        tolerances.resize(layout.motion().end, atol.velocity);
        tolerances.resize(tolerances.len() + layout.strains, atol.strain);
        let of_flow = system.flow_tolerances(atol.strain, atol.velocity);
        system.settle_between(&of_flow);
        tolerances.extend(of_flow);
        tolerances.resize(layout.unknowns(), atol.energy);
        system.expect_iteration(iterates(settings.method, &system));
        let longest = settings.max_step.unwrap_or(f64::INFINITY);
        match settings.method {
            method @ (Method::Ida | Method::IdaIndexTwo) => {
                let index = if method == Method::Ida { Index::One } else { Index::Two };
                let mut equations = DaeForm::new(system, index);
                tolerances.extend(equations.tolerances([atol.force, atol.momentum]));
                let [mut y, mut yp] = [(); 2].map(|()| vec![0.0; equations.size()]);
                equations.consistent(t, state, [&mut y, &mut yp]).map_err(Failure::into_error)?;
                let options = ida_options(settings, tolerances, &equations);
                let integrator = Ida::new(equations, t, &y, &yp, &options)?;
                let begin = move |integrator: &mut Ida<DaeForm>, t: f64, state: &[f64]| {
                    let equations = integrator.system_mut();
                    equations
                        .consistent(t, state, [&mut y, &mut yp])
                        .map_err(Failure::into_error)?;
                    integrator.reinit_with(t, &y, &yp)?;
                    Ok(true)
                };
                Ok(Box::new(Driven { integrator, begin }))
            }
            Method::CentralDifference => {
                let options = rk::Options::new(settings.rtol, tolerances).max_step(longest);
                let options = first.into_iter().fold(options, rk::Options::initial_step);
                let equations = SecondOrderForm::new(system);
                let integrator = CentralDifference::new(equations, t, state, &options)?;
                // its first step is that of the one before
                Ok(Box::new(Driven { integrator, begin: |_: &mut _, _: f64, _: &[f64]| Ok(false) }))
            }
            _ => ode(system, tolerances, start, state),
        }
    }
}

/// Starts an integrator of ordinary differential equations, with the unknowns `y`.
pub(super) fn ode<S: IntoStepper>(
    equations: S,
    tolerances: Vec<f64>,
    start: &Start,
    y: &[f64],
) -> Result<Box<dyn Stepper>, Failed> {
    let Start { settings, time: t, first, .. } = *start;
    let is_linear = equations.full().is_linear();
    let longest = settings.max_step.unwrap_or(f64::INFINITY);
    let holds_liquid = equations.full().holds_liquid();
    Ok(match settings.method {
        Method::Arkode => {
            let options =
                arkode_options(settings, tolerances, is_linear, holds_liquid)?.max_step(longest);
            let options = first.into_iter().fold(options, ArkodeOptions::initial_step);
            S::into_stepper(Arkode::new(equations, t, y, &options)?)
        }
        Method::Rosenbrock => {
            let options = rosenbrock_options(settings, tolerances, equations.full(), is_linear);
            let options = options.max_step(longest);
            let options = first.into_iter().fold(options, rosenbrock::Options::initial_step);
            let options = if start.prescribed { options.prescribed() } else { options };
            S::into_stepper(Rosenbrock::new(equations, t, y, &options)?)
        }
        Method::Rk => {
            let options = rk::Options::new(settings.rtol, tolerances).max_step(longest);
            let options = first.into_iter().fold(options, rk::Options::initial_step);
            let options = if start.prescribed { options.prescribed() } else { options };
            S::into_stepper(DormandPrince::new(equations, t, y, &options)?)
        }
        // a plan never has `Auto`, and other methods take other equations
        _ => {
            let options = cvode_options(settings, tolerances, holds_liquid).max_step(longest);
            S::into_stepper(Cvode::new(equations, t, y, &options)?)
        }
    })
}

/// The integrator that takes steps of a run by [`Method::Rosenbrock`] again, one by one.
#[cfg(feature = "gradient")]
pub(crate) fn repeating(
    mut equations: System,
    settings: &Settings,
    (t, y): (f64, &[f64]),
) -> Result<Rosenbrock<System>, Failed> {
    equations.expect_iteration(false);
    // errors of prescribed steps do not count
    let (tolerances, is_linear) = (vec![1.0; y.len()], equations.is_linear());
    let options = rosenbrock_options(settings, tolerances, &equations, is_linear);
    Ok(Rosenbrock::new(equations, t, y, &options.prescribed())?)
}

/// Equations that are an ODE, with the stepper of their integrators.
pub(super) trait IntoStepper: Integrable + Ode + Sized + 'static {
    fn into_stepper(
        integrator: impl Integrator<System = Self> + Send + 'static,
    ) -> Box<dyn Stepper>;
}

impl IntoStepper for System {
    fn into_stepper(
        integrator: impl Integrator<System = Self> + Send + 'static,
    ) -> Box<dyn Stepper> {
        let begin = |integrator: &mut _, t: f64, state: &[f64]| {
            Integrator::reinit(integrator, t, state)?;
            Ok(true)
        };
        Box::new(Driven { integrator, begin })
    }
}

/// Whether a method iterates with its Newton systems until residuals are small enough.
fn iterates(method: Method, system: &System) -> bool {
    match method {
        Method::Arkode => !system.is_linear(),
        Method::Rosenbrock => false,
        _ => method.information().is_implicit,
    }
}

/// The part of tolerances that errors of Newton's iteration may have (the default of `CVodeSetNonlinConvCoef` and
/// `ARKStepSetNonlinConvCoef`), and that where liquids fill their chambers: with 0.1 pressures of a rubber finger full of water, of
/// 0.9 kPa, were wrong by 3.3 kPa at rtol 1e-3 (ARKODE; BDF of order 2: 4.4 kPa), with 0.01 by 20 Pa (51 Pa), for a seventh (a
/// quarter) more evaluations.
const NEWTON: f64 = 0.1;
const NEWTON_WITH_LIQUIDS: f64 = 0.01;

fn newton(holds_liquid: bool) -> f64 {
    if holds_liquid { NEWTON_WITH_LIQUIDS } else { NEWTON }
}

/// Order of BDF where liquids fill their chambers, at relative tolerances above the second number: waves of their pressure are hardly
/// damped, and grow at higher orders where steps are longer than they are.
const ORDER_WITH_LIQUIDS: u32 = 2;
const ROUGH: f64 = 1e-6;

fn cvode_options(settings: &Settings, tolerances: Vec<f64>, holds_liquid: bool) -> CvodeOptions {
    let method = match settings.method {
        Method::CvodeAdams => Multistep::Adams,
        _ => Multistep::Bdf,
    };
    let options = CvodeOptions::new(settings.rtol, tolerances)
        .method(method)
        .newton(LinearSolver::Custom)
        .check_jacobian(false)
        .convergence_coefficient(newton(holds_liquid))
        .stability_limit_detection(settings.stability_limit_detection);
    let is_capped = holds_liquid && matches!(method, Multistep::Bdf) && settings.rtol > ROUGH;
    match settings.max_order {
        Some(order) => options.max_order(order),
        None if is_capped => options.max_order(ORDER_WITH_LIQUIDS),
        None => options,
    }
}

/// Steps after which ARKODE gets a new Newton matrix with new tangents in any case: few enough that Newton's
/// method converges in one or two iterations, which is fastest on all of Hirai's scenes.
const STEPS_BETWEEN_SETUPS: u32 = 2;

fn arkode_options(
    settings: &Settings,
    tolerances: Vec<f64>,
    is_linear: bool,
    holds_liquid: bool,
) -> Result<ArkodeOptions, Failed> {
    let table = settings.max_order.map_or(Ok(ButcherTable::default()), ButcherTable::implicit)?;
    let options = ArkodeOptions::new(settings.rtol, tolerances)
        .table(table)
        .newton(LinearSolver::Custom)
        .check_jacobian(false)
        .convergence_coefficient(newton(holds_liquid));
    Ok(match is_linear {
        true => options.linear(),
        false => options
            .max_steps_between_setups(STEPS_BETWEEN_SETUPS)
            .max_steps_between_jacobians(STEPS_BETWEEN_SETUPS),
    })
}

/// Steps, one after each command, that one factorization serves at most: where bodies change their shape it is the error that
/// asks for another.
const STEPS_UNDER_COMMANDS: u32 = 20;

fn rosenbrock_options(
    settings: &Settings,
    tolerances: Vec<f64>,
    system: &System,
    is_linear: bool,
) -> rosenbrock::Options {
    let options = rosenbrock::Options::new(settings.rtol, tolerances)
        .newton(LinearSolver::Custom)
        .check_jacobian(false);
    let options = settings.max_order.into_iter().fold(options, rosenbrock::Options::order);
    match settings.max_order {
        _ if is_linear => options.linear(),
        // edges turn with their pieces
        Some(3) if !system.has_edges() => options.max_steps_between_jacobians(STEPS_UNDER_COMMANDS),
        _ => options,
    }
}

fn ida_options(settings: &Settings, tolerances: Vec<f64>, equations: &DaeForm) -> IdaOptions {
    // unknowns that are not marked as differential are excluded from the error test: energies and multipliers
    let first_energy = equations.system.layout().energies().start;
    let differential: Vec<bool> = (0..equations.size()).map(|i| i < first_energy).collect();
    let options = IdaOptions::new(settings.rtol, tolerances)
        .newton(LinearSolver::Custom)
        .check_jacobian(false)
        .differential(differential)
        .suppress_algebraic(true)
        .max_step(settings.max_step.unwrap_or(f64::INFINITY));
    match settings.max_order {
        Some(order) => options.max_order(order),
        None => options,
    }
}
