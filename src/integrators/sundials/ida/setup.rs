//! Building an IDA solver.

use super::options::IdaOptions;
use crate::integrators::{
    common::{Error, check_finite, check_length, check_start},
    ode::Dae,
    sundials::{
        dae_callbacks::{
            jacobian, jacobian_times, precondition_setup, precondition_solve, quadratures,
            residual, roots,
        },
        ffi,
        functions::{Functions, QuadratureSensitivityFunctions, named},
        index::index,
        linear_solver::LinearSolver,
        sensitivity::{Access, all_residuals, dae_integrands},
        session::{InitialState, Session},
        vector::Vector,
    },
};

/// Marks a [`Solver`](crate::integrators::sundials::Solver) as one of IDA.
#[derive(Debug)]
pub struct IdaKind {
    pub(super) knows_algebraic: bool,
}

impl<S: Dae> Session<IdaKind, S> {
    /// A session that starts as [`Ida::new`](super::Ida::new) says.
    pub(in crate::integrators::sundials) fn of_ida(
        system: S,
        t0: f64,
        (y0, yp0): (&[f64], &[f64]),
        options: &IdaOptions,
    ) -> Result<Self, Error> {
        check_start(t0, y0)?;
        check_length("length of yp0", yp0.len(), y0.len())?;
        check_finite("yp0", yp0)?;
        options.check(y0)?;

        let count = system.quadrature_count();
        let start = InitialState { t: t0, y: y0, yp: Some(yp0), root_count: system.root_count() };
        let solver = &options.linear_solver;
        let kind = IdaKind { knows_algebraic: options.own.differential.is_some() };
        // SAFETY: `create` gets a live context, and the table is that of IDA.
        let mut ida = unsafe {
            let create = ("IDACreate", |_, context| ffi::IDACreate(context));
            Self::create(Functions::IDA, create, kind, system, &start, Some(solver.clone()))?
        };
        let (memory, y, yp) = (ida.memory.raw, ida.y.raw(), ida.raw_yp());
        // SAFETY: the memory is alive, vectors have the right length, and the callbacks fit the host
        // that is registered as their data.
        unsafe {
            let elapsed = ida.elapsed;
            ida.host
                .call(named!(IDAInit), |init| init(memory, Some(residual::<S>), elapsed, y, yp))?;
            ida.configure(options)?;
            ida.set_root_functions(named!(IDARootInit), Some(roots::<S>))?;
            let integrands = Some(quadratures::<S> as _);
            ida.set_quadratures(count, named!(IDAQuadInit), integrands, options)?;
            ida.set_newton(options, |system, _, r| system.newton_solve(r))?;
            if let LinearSolver::Krylov(krylov) = solver {
                ida.set_krylov(
                    krylov,
                    (named!(IDASetJacTimes), Some(jacobian_times::<S>)),
                    (
                        named!(IDASetPreconditioner),
                        Some(precondition_setup::<S>),
                        Some(precondition_solve::<S>),
                    ),
                )?;
            } else if solver.has_jacobian_callback() {
                ida.set(named!(IDASetJacFn), Some(jacobian::<S> as _))?;
            }
        }
        if !options.own.suppress_algebraic {
            ida.host.get_mut().find_index = Some(index);
        }
        if let Some(differential) = &options.own.differential {
            let id: Vec<f64> = differential.iter().map(|&d| f64::from(u8::from(d))).collect();
            let id = Vector::from_slice(&id, &ida.context)?;
            // SAFETY: IDA keeps a copy of the vector, whose length was checked.
            unsafe {
                ida.set(named!(IDASetId), id.raw())?;
                ida.set(named!(IDASetSuppressAlg), i32::from(options.own.suppress_algebraic))?;
            }
        }
        if let Some(sensitivities) = &options.sensitivities {
            let access = Access { get: S::parameters, set: S::set_parameters };
            // SAFETY: the memory is alive, and the callback fits the host.
            unsafe {
                let init = ("IDASensInit", |count, method, s, sp| {
                    ffi::IDASensInit(memory, count, method, Some(all_residuals::<S>), s, sp)
                });
                ida.set_up_sensitivities(sensitivities, &options.tolerances, &access, init)?;
                ida.set_up_integral_sensitivities(
                    sensitivities,
                    options,
                    QuadratureSensitivityFunctions::IDA,
                    (named!(IDAQuadSensInit), Some(dae_integrands::<S> as _)),
                )?;
            }
        }
        Ok(ida)
    }
}
