//! Building an ARKODE solver.
//!
//! After a failure ARKODE returns the time of a stage with the state at the start of the step. The time that
//! belongs to that state is therefore recorded by the function of `ARKStepSetStabilityFn`, which is called
//! once a step. A function after each step (`ARKStepSetPostprocessStepFn`) would report it, too, but makes
//! ARKODE evaluate the right-hand side at the ends of steps, which costs accuracy in stiff systems; it serves
//! fixed steps alone.

use std::ptr;

use super::{
    controller::{Filter, filtered_step},
    mass,
    options::ArkodeOptions,
};
use crate::integrators::{
    common::{Clock, Error, Integrator, check_start, check_whole},
    ode::{Borrowed, MassKind, Ode},
    sundials::{
        ffi,
        functions::{Functions, OdeFunctions, StageFunctions, Stages, named},
        ode_callbacks::{explicit_rhs, note_step_end, note_time, rhs, roots},
        session::{InitialState, Session},
        solver::{Kind, Owner, Solver},
    },
};

/// Integrates y' = f(t, y), or M y' = f(t, y) with a regular [mass matrix](Ode::mass_kind), by a Runge-Kutta
/// method with variable step size.
///
/// Diagonally implicit methods are for stiff systems, among them lightly damped oscillations, which multistep
/// methods of high order cannot follow; explicit ones for systems that are not stiff. (`ARKStep`)
///
/// [`ButcherTable::imex`](super::ButcherTable::imex) makes it a pair of both, for a right-hand side that is
/// [split](Ode::is_split).
///
/// After a recoverable failure of the right-hand side it retries with a smaller step; with a fixed step, explicit methods and explicit
/// parts stop.
///
/// Interpolation between the steps is by Hermite polynomials, of a degree one less than the order of the
/// method, at most 3 for implicit and 5 for explicit methods. Degrees 4 and 5 evaluate the right-hand side.
///
/// Made by `Arkode::new`, used through the methods of [`Integrator`](crate::integrators::common::Integrator).
///
/// User guide: chapter "Using ARKODE", ARKStep.
pub type Arkode<S> = Solver<ArkodeKind, S>;

/// Marks a [`Solver`] as one of ARKODE.
#[derive(Debug)]
pub struct ArkodeKind {
    /// Freed after the memory, which refers to it.
    filter: Option<Box<Filter>>,
}

impl Kind for ArkodeKind {
    type System = dyn Ode;
    type Session = dyn Integrator<System = Borrowed<'static, dyn Ode>>;

    const NAME: &'static str = "ARKODE";
}

impl<S: Ode> Arkode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &ArkodeOptions) -> Result<Self, Error> {
        let mut system = Owner::new(system);
        // SAFETY: the solver drops the session first, and accesses the system through it.
        unsafe {
            let session = start(system.lend_ode(), t0, y0, options)?;
            Ok(Self::new_within(session, system))
        }
    }
}

/// A session of [`Arkode`].
fn start(
    system: Borrowed<'static, dyn Ode>,
    t0: f64,
    y0: &[f64],
    options: &ArkodeOptions,
) -> Result<Box<<ArkodeKind as Kind>::Session>, Error> {
    Ok(Box::new(Session::of_arkode(system, t0, y0, options)?))
}

impl<S: Ode> Session<ArkodeKind, S> {
    pub(in crate::integrators::sundials) fn of_arkode(
        system: S,
        t0: f64,
        y0: &[f64],
        options: &ArkodeOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        options.check(y0)?;
        let scheme = &options.own.scheme;
        if !scheme.is_imex() {
            check_whole(&system)?;
        } else if !system.is_split() {
            let help = "a pair of tables is for a right-hand side of two parts: see `is_split` and `split`";
            return Err(Error::input("table", scheme, help));
        }

        let start = InitialState { t: t0, y: y0, yp: None, root_count: system.root_count() };
        let (is_implicit, is_imex) = (scheme.is_implicit(), scheme.is_imex());
        let stages: Stages = match (is_imex, is_implicit) {
            (true, _) => [Some(explicit_rhs::<S>), Some(rhs::<S>)],
            (false, true) => [None, Some(rhs::<S>)],
            (false, false) => [Some(rhs::<S>), None],
        };
        let mass_kind = system.mass_kind();
        let solver = match mass_kind {
            MassKind::Identity => options.newton_solver().filter(|_| is_implicit).cloned(),
            _ => Some(mass::check(options.newton_solver())?),
        };
        let mass_form = solver.clone().filter(|_| mass_kind != MassKind::Identity);
        // SAFETY: `create` gets a live context and a vector of its own, the table is that of
        // ARKODE, and the callbacks fit the host that is registered as their data.
        let begin = Clock::starting_at(start.t).start();
        let mut arkode = unsafe {
            let create = |y, context| ffi::ARKStepCreate(stages[0], stages[1], begin, y, context);
            let create = ("ARKStepCreate", create);
            Self::create(
                Functions::ARKODE,
                create,
                ArkodeKind { filter: None },
                system,
                &start,
                solver,
            )?
        };
        arkode.stages = stages;
        arkode.host.get_mut().step_end = Some(arkode.elapsed);
        arkode.configure(options)?;
        let degree = options.interpolant_degree();
        arkode.interpolant_degree = Some(degree);
        // SAFETY: the callback fits the host; the memory is alive; the other values are plain numbers.
        unsafe {
            arkode.set_root_functions(OdeFunctions::ARKODE.set_roots, Some(roots::<S>))?;
            let (memory, data) = (arkode.memory.raw, arkode.host.as_ptr());
            scheme.set(memory, |name, code| arkode.host.accept(name, code))?;
            if is_imex && !cfg!(sundials_major = "6") {
                // SUNDIALS 7 re-evaluates the slopes of Hermite polynomials, with the errors of stiff components in them
                arkode.set(named!(ARKStepSetInterpolantType), ffi::ARK_INTERP_LAGRANGE)?;
            }
            arkode.set(named!(ARKStepSetInterpolantDegree as _), degree as i32)?;
            // Post-processing of steps makes ARKODE evaluate the right-hand side at their ends; it is used
            // for fixed steps only.
            if let Some(h) = options.own.fixed_step {
                arkode.has_fixed_step = true;
                arkode.set(named!(ARKStepSetFixedStep), h)?;
                arkode
                    .set(named!(ARKStepSetPostprocessStepFn as _), Some(note_step_end::<S> as _))?;
            } else {
                let (set, note) = (named!(ARKStepSetStabilityFn), Some(note_time::<S> as _));
                arkode.host.call(set, |set| set(memory, note, data))?;
                control_steps(&mut arkode, options)?;
            }
        }
        if is_implicit {
            options.own.stages.set(&mut arkode, StageFunctions::ARKODE, options)?;
        }
        if let Some(form) = mass_form {
            mass::attach(&mut arkode, &form, mass_kind)?;
        }
        Ok(arkode)
    }
}

/// Sets how step sizes follow from errors.
fn control_steps<S: Ode>(
    arkode: &mut Session<ArkodeKind, S>,
    options: &ArkodeOptions,
) -> Result<(), Error> {
    let memory = arkode.memory.raw;
    // SAFETY: the memory is alive and dropped before the filter; the other values are plain numbers.
    unsafe {
        match options.own.controller.method() {
            Ok(number) => arkode.host.call(named!(ARKStepSetAdaptivityMethod), |set| {
                set(memory, number, 1, 0, ptr::null_mut())
            })?,
            Err(mut filter) => {
                // from SUNDIALS 7 on the bias is that of its own controllers alone
                if !cfg!(sundials_major = "6") {
                    filter.bias = options.own.error_bias.unwrap_or(1.5);
                }
                let data = ptr::from_mut(arkode.kind.filter.insert(Box::new(filter)).as_mut());
                arkode.host.call(named!(ARKStepSetAdaptivityFn), |set| {
                    set(memory, Some(filtered_step), data.cast())
                })?;
            }
        }
        for (function, value) in [
            (named!(ARKStepSetSafetyFactor as _), options.own.safety_factor),
            (named!(ARKStepSetErrorBias as _), options.own.error_bias),
        ] {
            if let Some(value) = value {
                arkode.set(function, value)?;
            }
        }
    }
    Ok(())
}
