//! Dynamics of soft elastic bodies: finite elements in Rust, stiff integration by SUNDIALS.
//!
//! A [`Scene`] is a [`Body`] (a [`Mesh`] with a [`Material`]), its surroundings, and a timeline
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
//! The integrators can be used alone: [`solve`](mod@solve) integrates any ODE or DAE by one call, [`sundials`] is the safe layer over CVODE, IDA and ARKODE
//! below it, [`rk`] an explicit Runge-Kutta method, [`rosenbrock`] implicit ones without an iteration, [`central_difference`] one for systems of second order; all take the
//! systems of [`ode`]. Without the feature `bodies` the crate consists of the integrators only.
//!
//! Modules lie in layers, from the lowest to the highest: [`integrators`], [`elements`], [`scene`](mod@scene), [`dynamics`], [`io`], [`studies`]
//! and `apps`; each depends only on those before it. The most used items also have a short path at the root.
//!
//! SI units throughout. Formulas follow S. Hirai, *Computing Dynamic Deformation*; numbers in
//! brackets are its equations.

// docs.rs marks what needs a feature.
#![cfg_attr(docsrs, feature(doc_cfg))]
// Upper layers use more of the lower ones than these do by themselves.
#![cfg_attr(
    not(all(feature = "cli", feature = "play")),
    allow(dead_code, unused_imports, unused_macros)
)]

// the command uses the public API, as programs do
#[cfg(feature = "cli")]
extern crate self as pliant;

#[cfg(any(feature = "cli", feature = "play"))]
pub mod apps;
mod base;
#[cfg(feature = "bodies")]
pub mod dynamics;
#[cfg(feature = "bodies")]
pub mod elements;
pub mod integrators;
#[cfg(feature = "bodies")]
pub mod io;
#[cfg(feature = "bodies")]
pub mod scene;
pub mod studies;

/// The matrices of [`Ode::dense_jacobian`](ode::Ode::dense_jacobian) and of sensitivities are those of this crate.
pub use faer;
#[cfg(feature = "bodies")]
pub use num_dual;

// The items of a first program, at the root.
pub use base::input::{Fraction, InputError};
#[cfg(feature = "bodies")]
pub use dynamics::{
    equations::Equations,
    equilibrium::{Equilibrium, MeshEstimate, NoEquilibrium, Stability},
    error::{Error, Panicked},
    phase::PhaseSummary,
    report::{
        Achieved, Counts, Indicator, PhaseReport, ReducedReport, Report, SensorErrorEstimate,
        SlipEvent, Verdict,
    },
    simulate::{Checkpoint, Sampling, Simulation, View},
    statics::Statics,
    system::{Energy, Spectrum},
    trajectory::{IntegrationFailure, Interrupted, Sample, Trajectory},
};
#[cfg(feature = "bodies")]
pub use elements::{
    body::{
        Body, BranchCells, BranchState, CellField, CellSelection, Dilatation, Inertia, NodalField,
        Part, Strain, Viscosity,
    },
    material::{
        FibreDirection, Fibres, Hill, Lame, Law, LawConstant, LawInformation, Material,
        MaxwellBranch, Moments, OwnEnergy, Plane, RigidMass, StrainEnergy, Substance,
    },
    mesh::{Cells, Mesh, Selection, SolidCells},
    rod::{Rod, RodPath, RodSection, SectionNumbers},
};
pub use integrators::common::Integrator;
#[cfg(feature = "scene-file")]
pub use io::scene_file::{DeviceKey, DeviceTable, OutputRequest, SceneFile, SceneReader};
#[cfg(feature = "bodies")]
pub use scene::{
    BodyState, Device, DeviceGauge, DeviceInput, DeviceMultipliers, DeviceOutput, DeviceRow,
    DeviceSignals, DeviceSite, DeviceState, DeviceValue, InputLimit, Phase, ReducedModel, Scene,
    SceneState, Smaller, Term,
    constraint::{Axis, Prescribed},
    devices::*,
    forces::*,
    settings::{
        AbsoluteTolerances, ContactEvents, Method, MethodInformation, MotionForm, Settings,
        SettingsOption, SettingsValue,
    },
};

// Modules by the short paths that programs use.
#[cfg(feature = "cli")]
pub use apps::command;
#[cfg(feature = "play")]
pub use apps::play;
#[cfg(feature = "bodies")]
pub use base::sparse;
#[cfg(feature = "bodies")]
pub use dynamics::{equations, error, simulate, statics, trajectory};
#[cfg(feature = "bodies")]
pub use elements::{body, force, material, mesh};
pub use integrators::{
    automatic, central_difference, common as integrate, ode, rk, rosenbrock, solve, sundials,
};
#[cfg(feature = "output")]
pub use io::output;
#[cfg(feature = "scene-file")]
pub use io::scene_file;
#[cfg(feature = "bodies")]
pub use scene::constraint;
#[cfg(feature = "fit")]
pub use studies::fit;
#[cfg(feature = "gradient")]
pub use studies::gradient;
#[cfg(feature = "gradient")]
pub use studies::optimize;
#[cfg(feature = "bodies")]
pub use studies::reduce;
pub use studies::samples;
#[cfg(feature = "sweep")]
pub use studies::sweep;
/// Speed charted against accuracy, and the adviser.
#[cfg(feature = "study")]
pub mod study {
    pub use crate::studies::advise::*;
    pub use crate::studies::work_precision::*;
}

/// Compiles the code blocks of the README.
#[doc = include_str!("../README.md")]
#[cfg(all(doctest, feature = "checkpoint", feature = "output"))]
pub struct ReadmeDoctests;

/// Compiles and runs the code blocks of the chapter on embedding.
#[doc = include_str!("../docs/embedding.md")]
#[cfg(doctest)]
pub struct EmbeddingDoctests;

/// Compiles the code blocks of the page on reduced models.
#[doc = include_str!("../docs/reduced-models.md")]
#[cfg(all(doctest, feature = "sweep"))]
pub struct ReducedModelsDoctests;

/// Compiles and runs the code blocks of the page on rods.
#[doc = include_str!("../docs/scenes/rods.md")]
#[cfg(all(doctest, feature = "bodies"))]
pub struct RodsDoctests;

/// Compiles and runs the code blocks of the page on joints.
#[doc = include_str!("../docs/scenes/joints.md")]
#[cfg(all(doctest, feature = "bodies"))]
pub struct JointsDoctests;

/// Compiles and runs the code blocks of the page on sweeps.
#[doc = include_str!("../docs/sweeps.md")]
#[cfg(all(doctest, feature = "sweep"))]
pub struct SweepsDoctests;
