//! Building a CVODE solver.

use super::options::{CvodeOptions, Multistep};
use crate::integrators::{
    common::{Error, check_form, check_start},
    ode::{Borrowed, Ode},
    sundials::{
        ffi,
        functions::{Functions, OdeFunctions, QuadratureSensitivityFunctions, named},
        ode_callbacks::{project, quadratures, rhs, roots},
        ode_krylov::newton_setup,
        sensitivity::{Access, CarriesSensitivities, integrands, one_rhs},
        session::{InitialState, Session},
        solver::{Kind, Owner, Solver, WithSensitivities},
    },
};

/// Integrates y' = f(t, y) with variable step size and order.
///
/// Made by `Cvode::new`, used through the methods of [`Integrator`](crate::integrators::common::Integrator).
///
/// User guide: chapter "Using CVODE".
pub type Cvode<S> = Solver<CvodeKind, S>;

/// Marks a [`Solver`] as one of CVODE.
#[derive(Debug)]
pub struct CvodeKind;

impl Kind for CvodeKind {
    type System = dyn Ode;
    type Session = dyn CarriesSensitivities<System = Borrowed<'static, dyn Ode>>;

    const NAME: &'static str = "CVODE";
}

impl WithSensitivities for CvodeKind {}

impl<S: Ode> Cvode<S> {
    /// A solver for `system`, starting at time `t0` from `y0`.
    ///
    /// # Errors
    /// [`Error::Input`] for options or initial values that cannot be used.
    pub fn new(system: S, t0: f64, y0: &[f64], options: &CvodeOptions) -> Result<Self, Error> {
        let mut system = Owner::new(system);
        // SAFETY: the solver drops the session first, and accesses the system through it.
        unsafe {
            let session = start(system.lend_ode(), t0, y0, options)?;
            Ok(Self::new_within(session, system))
        }
    }
}

/// A session of [`Cvode`].
fn start(
    system: Borrowed<'static, dyn Ode>,
    t0: f64,
    y0: &[f64],
    options: &CvodeOptions,
) -> Result<Box<<CvodeKind as Kind>::Session>, Error> {
    Ok(Box::new(Session::of_cvode(system, t0, y0, options)?))
}

impl<S: Ode> Session<CvodeKind, S> {
    pub(in crate::integrators::sundials) fn of_cvode(
        system: S,
        t0: f64,
        y0: &[f64],
        options: &CvodeOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        options.check(y0)?;
        check_form(&system)?;

        let count = system.quadrature_count();
        let start = InitialState { t: t0, y: y0, yp: None, root_count: system.root_count() };
        let method = match options.own.method {
            Multistep::Bdf => ffi::CV_BDF,
            Multistep::Adams => ffi::CV_ADAMS,
        };
        // SAFETY: `create` gets a live context, and the table is that of CVODE.
        let mut cvode = unsafe {
            let create = ("CVodeCreate", |_, context| ffi::CVodeCreate(method, context));
            let solver = options.newton_solver().cloned();
            Self::create(Functions::CVODE, create, CvodeKind, system, &start, solver)?
        };
        // SAFETY: the memory is alive, the vector has the right length, and the callbacks fit the
        // host that is registered as their data.
        unsafe {
            let (memory, y) = (cvode.memory.raw, cvode.y.raw());
            let elapsed = cvode.elapsed;
            cvode.host.call(named!(CVodeInit), |init| init(memory, Some(rhs::<S>), elapsed, y))?;
            cvode.configure(options)?;
            cvode.set_root_functions(OdeFunctions::CVODE.set_roots, Some(roots::<S>))?;
            let integrands = Some(quadratures::<S> as _);
            cvode.set_quadratures(count, named!(CVodeQuadInit), integrands, options)?;
        }
        // SAFETY: the callback fits the registered host; the other values are plain numbers.
        unsafe {
            if options.own.project {
                cvode.set(named!(CVodeSetProjFn), Some(project::<S> as _))?;
            }
            if options.own.stability_limit_detection {
                cvode.set(named!(CVodeSetStabLimDet), 1)?;
            }
            if let Some(steps) = options.max_steps_between_setups {
                cvode.set(named!(CVodeSetLSetupFrequency as _), i64::from(steps))?;
            }
        }
        if let Some(sensitivities) = &options.sensitivities {
            let memory = cvode.memory.raw;
            let access = Access { get: S::parameters, set: S::set_parameters };
            // SAFETY: the memory is alive, and the callback fits the host.
            unsafe {
                let init = ("CVodeSensInit1", |count, method, s, _| {
                    ffi::CVodeSensInit1(memory, count, method, Some(one_rhs::<S>), s)
                });
                cvode.set_up_sensitivities(sensitivities, &options.tolerances, &access, init)?;
                cvode.set_up_integral_sensitivities(
                    sensitivities,
                    options,
                    QuadratureSensitivityFunctions::CVODE,
                    (named!(CVodeQuadSensInit), Some(integrands::<S> as _)),
                )?;
            }
        }
        // SAFETY: the functions are those of CVODE, and the callback fits the registered host.
        unsafe {
            cvode.set_nonlinear(OdeFunctions::CVODE, options, |cvode| {
                cvode.set(named!(CVodeSetLinSysFn), Some(newton_setup::<S> as _))
            })?;
        }
        Ok(cvode)
    }
}
