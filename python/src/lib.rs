//! The Python module of pliant.
//!
//! What a scene is and how it is written stands in the library: scenes come here as the text of scene files and values of
//! JSON, which its reader reads, and arrays leave as those of NumPy. `pliant/*.py` turns them into what a program of
//! Python expects.

mod arrays;
mod errors;
mod integrators;
mod motion;
mod reduced;
mod scene;
mod simulation;
mod sweep;
mod watch;
mod watched;

use pyo3::prelude::*;

/// What `pliant` is made of; programs import `pliant`.
#[pymodule]
mod _pliant {
    #[pymodule_export]
    use super::integrators::{Run, gradient, solve};
    #[pymodule_export]
    use super::motion::Motion;
    #[pymodule_export]
    use super::reduced::Reduced;
    #[pymodule_export]
    use super::scene::{Scene, read_gmsh, schema, toml_of};
    #[pymodule_export]
    use super::simulation::{Checkpoint, Simulation};
    #[pymodule_export]
    use super::sweep::Sweep;
}
