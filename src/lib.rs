//! Dynamics of soft elastic bodies.

pub mod body;
pub mod constraint;
mod element;
pub mod error;
pub mod force;
pub mod material;
pub mod mesh;
pub mod ode;
pub mod output;
pub mod rk;
pub mod samples;
pub mod scene;
pub mod simulate;
pub mod sparse;
pub mod sundials;
mod system;
pub mod trajectory;

pub use body::{Body, Strain};
pub use constraint::{Axis, Prescribed};
pub use error::Error;
pub use force::Obstacle;
pub use material::{Lame, Material, Plane};
pub use mesh::{Cells, Mesh, Selection};
pub use scene::{Phase, Scene};
pub use simulate::{Method, Sampling, Solver};
pub use system::Energy;
pub use trajectory::{Sample, Trajectory};

/// Compiles the code blocks of the README.
#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct ReadmeDoctests;
