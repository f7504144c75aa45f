//! A safe, general layer over SUNDIALS, for any system of ordinary differential equations (CVODE) or
//! differential-algebraic equations (IDA). It is independent of bodies.
//!
//! The system is a closure or a struct, see [`crate::integrators::ode`]; the solver owns it, chooses its
//! steps by the tolerances, and reports failures by a typed [`Error`] that names time, step size, order,
//! cause and remedy. Panics of the system pass through C safely.
//!
//! ```
//! use pliant::sundials::{Cvode, CvodeOptions, Integrator};
//!
//! // y' = -1000 (y - cos t): the solution is pulled to cos t within milliseconds.
//! let system = |t: f64, y: &[f64], ydot: &mut [f64]| {
//!     ydot[0] = -1000.0 * (y[0] - t.cos());
//!     Ok(())
//! };
//! let mut solver = Cvode::new(system, 0.0, &[0.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! for t in [0.5, 1.0, 1.5] {
//!     solver.solve_to(t)?;
//!     assert!((solver.y()[0] - t.cos()).abs() < 2e-3);
//! }
//! println!("{} steps", solver.statistics().steps);
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//!
//! [`Cvode`], [`Arkode`] and [`Ida`] are used through the methods of [`Integrator`]:
//! [`solve_to`](Integrator::solve_to) a time or a single [`step`](Integrator::step), output between the steps
//! by [`interpolate`](Integrator::interpolate), stop times, root functions, new starts and [`Statistics`].
//! [`LinearSolver`] selects the solver of Newton's linear systems: dense, band, sparse (KLU), without a
//! matrix ([`Krylov`]) or by the system itself. The SUNDIALS user guide describes the C functions behind the
//! methods.
//!
//! | equations | integrators |
//! | --- | --- |
//! | y' = f(t, y) | [`Cvode`], [`Arkode`] |
//! | M y' = f(t, y) with a [mass matrix](crate::integrators::ode::Ode::mass_kind) | [`Arkode`]; [`Ida`] by [`MassForm`], where M may be singular |
//! | y' = f(t, y) + g(t, y), f alone [stiff](crate::integrators::ode::Ode::is_split) | [`Arkode`] by [`ButcherTable::imex`] |
//! | y' = f(t, y) + g(t, y), g faster than f and cheap | [`Multirate`] |
//! | y' = f(t, y) with invariants | [`Cvode`] by [`CvodeOptions::project`] |
//! | F(t, y, y') = 0 of index 1 | [`Ida`], see [`Ida::check_index`] |
//!
//! In all of them, unknowns can be required to keep their [`Sign`].
//!
//! In addition to the state, [`Cvode`] and [`Ida`] compute integrals and [`Sensitivities`]; [`Adjoint`] and
//! [`DaeAdjoint`] compute gradients with respect to many parameters.

mod adjoint;
mod arkode;
mod arkode_ffi;
mod auxiliary;
mod callbacks;
mod colouring;
mod context;
mod cvode;
mod dae_callbacks;
mod dense;
mod differences;
mod factored;
mod factors;
mod ffi;
mod functions;
mod groups;
mod host;
mod ida;
mod ilu;
mod index;
mod integrator_stats;
mod jacobian;
mod kernels;
#[cfg(feature = "vendored")]
mod klu;
mod krylov;
mod linear;
mod linear_solver;
mod mass_form;
mod matrix;
mod messages;
mod multirate;
mod nonlinear;
mod ode_callbacks;
mod ode_krylov;
mod options;
mod pattern;
mod pattern_search;
mod progress;
mod quadratures;
mod report;
mod restarts;
mod sensitivity;
mod serial;
mod session;
mod shape;
mod signs;
mod solver;
mod step_control;
mod stepping;
mod stop_time;
mod stored_matrix;
mod vector;
mod version;
mod weights;

pub use adjoint::{Adjoint, AdjointOf, AdjointOptions, DaeAdjoint, Gradient};
pub use arkode::{Arkode, ArkodeOptions, ButcherTable, Controller, Predictor, Tableau};
pub(crate) use colouring::Colouring;
pub use cvode::{Cvode, CvodeOptions, Multistep};
pub(crate) use differences::Differences;
pub(crate) use factors::Factors;
pub use ida::{Ida, IdaOptions, InitialCondition};
pub use jacobian::Jacobian;
pub use krylov::{Krylov, KrylovMethod, Preconditioner, Side};
pub use linear_solver::LinearSolver;
pub use mass_form::MassForm;
pub use multirate::{Coupling, Multirate, MultirateOptions};
pub(crate) use options::OfMultistep;
pub use options::SolverOptions;
pub use pattern::Pattern;
pub use sensitivity::{Sensitivities, SensitivityMethod, SensitivitySource};
pub(crate) use shape::Shape;
pub use signs::Sign;
pub use solver::{Kind, Solver, WithSensitivities};
pub use step_control::StepControl;
pub(crate) use stored_matrix::StoredMatrix;
pub use version::{description, suitesparse_version, version};

pub use crate::integrators::common::{
    AbsoluteTolerance, Callback, Cause, Error, IntegrationError, Integrator, Reached, Statistics,
};
