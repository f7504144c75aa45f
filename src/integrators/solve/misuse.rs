//! Code that does not compile, each example next to one that does: ownership and lifetimes.
//!
//! The two differ only by the mistake, because rustdoc compares the error codes only in nightly versions.
//!
//! A solver owns its system. After `into_system` the solver is gone:
//!
//! ```
//! use pliant::sundials::{Cvode, CvodeOptions, Integrator};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! println!("{}", solver.t());
//! let system = solver.into_system();
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//! ```compile_fail,E0382
//! use pliant::sundials::{Cvode, CvodeOptions, Integrator};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! let system = solver.into_system();
//! println!("{}", solver.t());
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//!
//! The state belongs to the solver, which cannot step while the state is borrowed:
//!
//! ```
//! use pliant::sundials::{Cvode, CvodeOptions, Integrator};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let mut solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! let y = solver.y().to_vec();
//! solver.solve_to(1.0)?;
//! println!("{y:?}");
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//! ```compile_fail,E0502
//! use pliant::sundials::{Cvode, CvodeOptions, Integrator};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let mut solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! let y = solver.y();
//! solver.solve_to(1.0)?;
//! println!("{y:?}");
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//!
//! Equations that borrow do not outlive what they borrow, whoever holds the solver:
//!
//! ```
//! use pliant::solve::Problem;
//! fn problem(rate: &f64) -> Problem<'_> {
//!     Problem::ode(move |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -rate * y[0]; Ok(()) }, [1.0])
//! }
//! let rate = 2.0;
//! problem(&rate);
//! ```
//! ```compile_fail,E0515
//! use pliant::solve::Problem;
//! fn problem() -> Problem<'static> {
//!     let rate = &2.0_f64.sqrt();
//!     Problem::ode(move |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -rate * y[0]; Ok(()) }, [1.0])
//! }
//! problem();
//! ```
//!
//! A solver can move to another thread if its system can, and not otherwise:
//!
//! ```
//! use pliant::sundials::{Cvode, CvodeOptions};
//! let rate = std::sync::Arc::new(2.0);
//! let decay = move |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -*rate * y[0]; Ok(()) };
//! let solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! std::thread::spawn(move || drop(solver)).join().unwrap();
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//! ```compile_fail,E0277
//! use pliant::sundials::{Cvode, CvodeOptions};
//! let rate = std::rc::Rc::new(2.0);
//! let decay = move |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -*rate * y[0]; Ok(()) };
//! let solver = Cvode::new(decay, 0.0, &[1.0], &CvodeOptions::new(1e-6, 1e-9))?;
//! std::thread::spawn(move || drop(solver)).join().unwrap();
//! # Ok::<(), pliant::sundials::Error>(())
//! ```
//!
//! A step of a run has to be used before the next one is made:
//!
//! ```
//! use pliant::solve::{Method, Options, Problem, Run};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let mut run = Run::new(Problem::ode(decay, [1.0]), Method::Bdf, (0.0, 1.0), &Options::new(1e-6, 1e-9))?;
//! let first = run.advance()?.map(|step| step.y.to_vec());
//! run.advance()?;
//! println!("{first:?}");
//! # Ok::<(), pliant::solve::Reason>(())
//! ```
//! ```compile_fail,E0499
//! use pliant::solve::{Method, Options, Problem, Run};
//! let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| { ydot[0] = -y[0]; Ok(()) };
//! let mut run = Run::new(Problem::ode(decay, [1.0]), Method::Bdf, (0.0, 1.0), &Options::new(1e-6, 1e-9))?;
//! let first = run.advance()?;
//! run.advance()?;
//! println!("{first:?}");
//! # Ok::<(), pliant::solve::Reason>(())
//! ```
