//! Errors of the library as the exceptions of `pliant/errors.py`.

use pliant::{Error, InputError, IntegrationFailure, NoEquilibrium, Trajectory};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::motion::Motion;

/// The exception for `error`.
pub fn raised(error: impl Into<Error>) -> PyErr {
    Python::attach(|py| exception(py, error.into()).unwrap_or_else(|broken| broken))
}

fn exception(py: Python<'_>, error: Error) -> PyResult<PyErr> {
    let text = error.to_string();
    match error {
        Error::Input(InputError { input, value, help }) => {
            made(py, "InputError", (text, input, value, help))
        }
        Error::SceneFile { path, line, key, message } => {
            made(py, "SceneError", (text, key, message, path.display().to_string(), line))
        }
        Error::Integration(failure) => {
            let IntegrationFailure { phase, method, time, step, trajectory, .. } = *failure;
            let motion = so_far(py, trajectory, &text)?;
            made(py, "IntegrationError", (text, motion, phase, method.name(), time, step))
        }
        Error::Statics(failure) => {
            let NoEquilibrium { phase, fraction, trajectory, .. } = *failure;
            let motion = so_far(py, trajectory, &text)?;
            made(py, "NoEquilibrium", (text, motion, phase, fraction))
        }
        Error::Read { source, .. } | Error::Output { source, .. } => {
            made(py, "FileError", (text, source.raw_os_error()))
        }
        _ => made(py, "Error", (text,)),
    }
}

fn so_far(py: Python<'_>, trajectory: Trajectory, text: &str) -> PyResult<Py<PyAny>> {
    Ok(Py::new(py, Motion::new(trajectory, String::new(), Some(text.to_owned())))?.into_any())
}

/// The exception of this name in `pliant.errors`.
pub fn made<'py>(
    py: Python<'py>,
    name: &str,
    arguments: impl IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error = PyErr>,
) -> PyResult<PyErr> {
    let class = py.import("pliant.errors")?.getattr(name)?;
    let arguments = arguments.into_pyobject(py)?;
    Ok(PyErr::from_value(class.call1(arguments)?))
}
