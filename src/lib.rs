//! Dynamics of soft elastic bodies: finite elements in Rust, stiff integration by SUNDIALS.
//!
//! A [`Scene`] is a [`Body`] (a [`Mesh`] made of a [`Material`]), what surrounds it, and a timeline
//! of [`Phase`]s. [`Scene::simulate`] integrates the equations of motion and returns a
//! [`Trajectory`], which [`output`] writes to tables, pictures and files for ParaView.
//!
//! ```
//! use pliant::{Body, Cells, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings};
//!
//! let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
//! let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
//! let press = Phase::until(0.5).hold("bottom").move_nodes([14, 15], [0.0, -0.16]);
//! let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
//!     .obstacle(Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(100.0))
//!     .phase(press.without_contact())
//!     .phase(Phase::until(0.7).named("free"));
//! let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
//! assert!(trajectory.mean_velocity(trajectory.last())[1] > 0.5); // it jumps
//! # Ok::<(), pliant::Error>(())
//! ```
//!
//! The integrators stand on their own: [`solve`](mod@solve) integrates any ODE or DAE by one call, [`sundials`] is the safe layer over CVODE, IDA and ARKODE
//! below it, [`rk`] an explicit Runge-Kutta method, [`rosenbrock`] implicit ones without an iteration, [`central_difference`] one for systems of second order; all take the
//! systems of [`ode`]. Without the feature `bodies` they are all there is.
//!
//! SI units throughout. Formulas follow S. Hirai, *Computing Dynamic Deformation*; numbers in
//! brackets are its equations.

// The rooms of bodies use more of the lowest rooms than the integrators do.
#![cfg_attr(not(feature = "bodies"), allow(dead_code, unused_imports, unused_macros))]

#[cfg(feature = "bodies")]
pub mod body;
pub mod central_difference;
#[cfg(feature = "checkpoint")]
mod checkpoint_file;
#[cfg(feature = "bodies")]
pub mod constraint;
#[cfg(feature = "bodies")]
mod element;
#[cfg(feature = "bodies")]
pub mod equations;
#[cfg(feature = "bodies")]
mod equilibrium;
#[cfg(feature = "bodies")]
pub mod error;
#[cfg(feature = "bodies")]
mod external;
#[cfg(any(feature = "checkpoint", feature = "output"))]
mod file;
#[cfg(feature = "fit")]
pub mod fit;
#[cfg(feature = "bodies")]
pub mod force;
#[cfg(feature = "bodies")]
mod formula;
#[cfg(feature = "bodies")]
mod indicator;
mod input;
pub mod integrate;
mod lane;
#[cfg(feature = "bodies")]
pub mod material;
#[cfg(feature = "bodies")]
pub mod mesh;
#[cfg(feature = "bodies")]
mod model;
pub mod ode;
#[cfg(feature = "output")]
pub mod output;
#[cfg(feature = "play")]
pub mod play;
#[cfg(feature = "bodies")]
mod report;
pub mod rk;
pub mod rosenbrock;
pub mod samples;
#[cfg(feature = "bodies")]
pub mod scene;
#[cfg(feature = "scene-file")]
pub mod scene_file;
#[cfg(feature = "bodies")]
mod settings;
#[cfg(feature = "bodies")]
pub mod simulate;
pub mod solve;
#[cfg(feature = "bodies")]
pub mod sparse;
#[cfg(feature = "bodies")]
mod state;
#[cfg(feature = "checkpoint")]
mod state_file;
#[cfg(feature = "bodies")]
pub mod statics;
#[cfg(feature = "study")]
pub mod study;
pub mod sundials;
#[cfg(feature = "bodies")]
mod system;
mod tensor;
#[cfg(feature = "bodies")]
pub mod trajectory;
mod vector;
mod wide;

#[cfg(feature = "bodies")]
pub use body::{
    Body, CellField, CellSelection, Dilatation, Inertia, NodalField, Strain, Viscosity,
};
#[cfg(feature = "bodies")]
pub use constraint::{Axis, Prescribed};
#[cfg(feature = "bodies")]
pub use equations::Equations;
#[cfg(feature = "bodies")]
pub use equilibrium::{Equilibrium, MeshEstimate, NoEquilibrium, Stability};
#[cfg(feature = "bodies")]
pub use error::{Error, Panicked};
#[cfg(feature = "bodies")]
pub use external::*;
pub use input::{Fraction, InputError};
pub use integrate::Integrator;
#[cfg(feature = "bodies")]
pub use material::{Course, Fibres, Lame, Law, Material, MaxwellBranch, Plane, Substance};
#[cfg(feature = "bodies")]
pub use mesh::{Cells, Mesh, Selection, SolidCells};
#[cfg(feature = "bodies")]
pub use report::{Achieved, Counts, Indicator, PhaseReport, Report, SlipEvent, Verdict};
#[cfg(feature = "bodies")]
pub use scene::{BodyState, Phase, Scene, Term};
#[cfg(feature = "scene-file")]
pub use scene_file::{OutputRequest, SceneFile};
#[cfg(feature = "bodies")]
pub use settings::{
    AbsoluteTolerances, ContactEvents, Method, Settings, SettingsOption, SettingsValue,
};
#[cfg(feature = "bodies")]
pub use simulate::{Checkpoint, Sampling, Simulation, View};
#[cfg(feature = "bodies")]
pub use statics::Statics;
#[cfg(feature = "bodies")]
pub use system::{Energy, PhaseSummary, Spectrum};
#[cfg(feature = "bodies")]
pub use trajectory::{IntegrationFailure, Interrupted, Sample, Trajectory};

/// Compiles the code blocks of the README.
#[doc = include_str!("../README.md")]
#[cfg(all(doctest, feature = "checkpoint", feature = "output"))]
pub struct ReadmeDoctests;

/// Compiles and runs the code blocks of the chapter on embedding.
#[doc = include_str!("../docs/embedding.md")]
#[cfg(doctest)]
pub struct EmbeddingDoctests;
