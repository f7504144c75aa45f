//! A run that a program leads step by step.

use std::sync::{Mutex, MutexGuard, TryLockError};

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pliant::solve::{self, End, Occurrence, Reason};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use super::Asked;
use super::equations::Raised;
use super::events::act;
use crate::errors::{made, raised};

/// Where a run stands. It is pickled as JSON, whose names later versions may add to.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Saved(solve::Saved);

#[pymethods]
impl Saved {
    #[new]
    fn new(json: &str) -> PyResult<Self> {
        let unusable = |error| PyValueError::new_err(format!("this is no saved run: {error}"));
        serde_json::from_str(json).map(Self).map_err(unusable)
    }

    fn __getnewargs__(&self) -> PyResult<(String,)> {
        let failed = |error: serde_json::Error| PyValueError::new_err(error.to_string());
        Ok((serde_json::to_string(&self.0).map_err(failed)?,))
    }
}

/// A run that a program leads step by step.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Run {
    run: Mutex<solve::Run<'static>>,
    raised: Raised,
}

/// An event that was met: its number, its time and the state before its action.
pub type Met<'py> = (usize, f64, Bound<'py, PyArray1<f64>>);

/// A step: times of its start and end, the state there, that before a jump, and its events.
type Step<'py> =
    (f64, f64, Bound<'py, PyArray1<f64>>, Option<Bound<'py, PyArray1<f64>>>, Vec<Met<'py>>);

/// The value of `outcome`, or the exception of a function that was called, or that for the reason.
pub fn completed<T>(py: Python<'_>, outcome: Result<T, Reason>, kept: &Raised) -> PyResult<T> {
    if let Some(exception) = kept.take() {
        return Err(exception);
    }
    match outcome {
        Ok(value) => Ok(value),
        Err(Reason::Input(error)) => Err(raised(error)),
        Err(reason) => Err(made(py, "Error", (reason.to_string(),))?),
    }
}

/// Events that were met.
pub fn met<'py>(py: Python<'py>, events: &[Occurrence]) -> Vec<Met<'py>> {
    events.iter().map(|met| (met.event, met.t, PyArray1::from_slice(py, &met.y))).collect()
}

impl Run {
    fn lock(&self) -> PyResult<MutexGuard<'_, solve::Run<'static>>> {
        match self.run.try_lock() {
            Ok(run) => Ok(run),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "the run is at work, in another thread or in a function that it calls: make one for each thread",
            )),
        }
    }
}

#[pymethods]
impl Run {
    #[new]
    fn new(py: Python<'_>, asked: Asked) -> PyResult<Self> {
        let (method, span, raised) = (asked.method()?, asked.span, Raised::default());
        let (problem, options) = asked.problem(py, &raised)?;
        let run = completed(py, solve::Run::new(problem, method, span, &options), &raised)?;
        Ok(Self { run: Mutex::new(run), raised })
    }

    /// Takes one step; nothing once the run has ended.
    fn advance<'py>(&self, py: Python<'py>) -> PyResult<Option<Step<'py>>> {
        let mut run = self.lock()?;
        let step = completed(py, run.advance(), &self.raised)?;
        Ok(step.map(|step| {
            let before = step.before.map(|before| PyArray1::from_slice(py, before));
            (step.t_old, step.t, PyArray1::from_slice(py, step.y), before, met(py, step.events))
        }))
    }

    /// Goes to a time, and returns the events on the way.
    fn advance_to<'py>(&self, py: Python<'py>, t: f64) -> PyResult<Vec<Met<'py>>> {
        let events = completed(py, self.lock()?.advance_to(t), &self.raised)?;
        Ok(met(py, &events))
    }

    /// Changes state and parameters by an action, as that of an event.
    fn jump(&self, py: Python<'_>, action: Py<PyAny>) -> PyResult<()> {
        let outcome = self.lock()?.jump(|jump| act(&action, jump, &self.raised));
        completed(py, outcome, &self.raised)
    }

    fn save(&self) -> PyResult<Saved> {
        Ok(Saved(self.lock()?.save()))
    }

    fn restore(&self, py: Python<'_>, saved: &Saved) -> PyResult<()> {
        completed(py, self.lock()?.restore(&saved.0), &self.raised)
    }

    /// The state at a time within the last step.
    fn interpolate<'py>(&self, py: Python<'py>, t: f64) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut run = self.lock()?;
        let mut state = vec![0.0; run.y().len()];
        completed(py, run.interpolate(t, &mut state).map_err(Reason::from), &self.raised)?;
        Ok(PyArray1::from_vec(py, state))
    }

    #[getter]
    fn t(&self) -> PyResult<f64> {
        Ok(self.lock()?.t())
    }

    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.y()))
    }

    /// The time derivative of the state of a residual; empty otherwise.
    #[getter]
    fn yp<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.yp()))
    }

    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.parameters()))
    }

    /// The sensitivities: [parameter, unknown].
    #[getter]
    fn sensitivities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let run = self.lock()?;
        let s = run.sensitivities();
        let numbers: Vec<f64> = s.col_iter().flat_map(|column| column.iter().copied()).collect();
        PyArray1::from_vec(py, numbers).reshape([s.ncols(), s.nrows()])
    }

    #[getter]
    fn integrals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.quadratures()))
    }

    /// How the run has ended; nothing before.
    #[getter]
    fn end(&self) -> PyResult<Option<&'static str>> {
        Ok(self.lock()?.end().map(|end| match end {
            End::Span => "span",
            End::Event(_) => "event",
            End::Break => "break",
            _ => "early",
        }))
    }

    #[getter]
    fn steps(&self) -> PyResult<u64> {
        Ok(self.lock()?.statistics().steps)
    }

    /// Evaluations of the right-hand side, with those for difference quotients.
    #[getter]
    fn evaluations(&self) -> PyResult<u64> {
        let counts = self.lock()?.statistics();
        Ok(counts.evaluations + counts.difference_quotient_evaluations)
    }
}
