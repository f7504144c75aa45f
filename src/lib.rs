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
//! The integrators stand on their own: [`sundials`] is a safe layer over CVODE and IDA for any ODE
//! or DAE, [`rk`] an explicit Runge-Kutta method, [`central_difference`] one for systems of second order; all take the
//! systems of [`ode`].
//!
//! SI units throughout. Formulas follow S. Hirai, *Computing Dynamic Deformation*; numbers in
//! brackets are its equations.

pub mod body;
pub mod central_difference;
#[cfg(feature = "checkpoint")]
mod checkpoint_file;
pub mod constraint;
mod element;
pub mod equations;
mod equilibrium;
pub mod error;
mod external;
#[cfg(any(feature = "checkpoint", feature = "output"))]
mod file;
pub mod force;
mod formula;
mod indicator;
mod input;
pub mod integrate;
pub mod material;
pub mod mesh;
mod model;
pub mod ode;
#[cfg(feature = "output")]
pub mod output;
#[cfg(feature = "play")]
pub mod play;
mod report;
pub mod rk;
pub mod samples;
pub mod scene;
#[cfg(feature = "scene-file")]
pub mod scene_file;
mod settings;
pub mod simulate;
pub mod sparse;
mod state;
#[cfg(feature = "checkpoint")]
mod state_file;
pub mod statics;
#[cfg(feature = "study")]
pub mod study;
pub mod sundials;
mod system;
mod tensor;
pub mod trajectory;
mod vector;

pub use body::{Body, CellField, CellSelection, Inertia, NodalField, Strain, Viscosity};
pub use constraint::{Axis, Prescribed};
pub use equations::Equations;
pub use equilibrium::{Equilibrium, MeshEstimate, NoEquilibrium, Stability};
pub use error::{Error, Panicked};
pub use external::*;
pub use input::{Fraction, InputError};
pub use integrate::Integrator;
pub use material::{Lame, Material, Plane};
pub use mesh::{Cells, Mesh, Selection, SolidCells};
pub use report::{Achieved, Counts, Indicator, PhaseReport, Report, SlipEvent, Verdict};
pub use scene::{BodyState, Phase, Scene, Term};
#[cfg(feature = "scene-file")]
pub use scene_file::{OutputRequest, SceneFile};
pub use settings::{
    AbsoluteTolerances, ContactEvents, Method, Settings, SettingsOption, SettingsValue,
};
pub use simulate::{Checkpoint, Sampling, Simulation, View};
pub use statics::Statics;
pub use system::{Energy, PhaseSummary, Spectrum};
pub use trajectory::{IntegrationFailure, Interrupted, Sample, Trajectory};

/// Compiles the code blocks of the README.
#[doc = include_str!("../README.md")]
#[cfg(all(doctest, feature = "checkpoint", feature = "output"))]
pub struct ReadmeDoctests;
