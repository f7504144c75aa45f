//! The Python module of pliant.
//!
//! Scenes are defined and parsed by the library: they arrive here as text of scene files and values of JSON, and arrays leave as
//! those of NumPy. `pliant/*.py` wraps both for Python programs.

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

/// Native part of `pliant`; programs import `pliant`.
#[pymodule]
mod _pliant {
    #[pymodule_export]
    use super::integrators::{Run, Saved, Solution, gradient, method, solve};
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
