//! Progress display and Ctrl-C during a run that is detached from Python.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Time between two checks.
const PERIOD: Duration = Duration::from_millis(100);

/// Periodic check of a run for progress and signals.
pub struct Watch {
    last: Instant,
    /// Called with the time reached (s).
    progress: Option<Py<PyAny>>,
    raised: Option<PyErr>,
}

impl Watch {
    pub fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { last: Instant::now(), progress, raised: None }
    }

    /// Called after each step, at `time`; breaks if Python has raised something.
    pub fn see(&mut self, time: f64) -> ControlFlow<()> {
        if self.last.elapsed() < PERIOD {
            return ControlFlow::Continue(());
        }
        self.last = Instant::now();
        let seen = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (time,)).map(|_| ()),
                None => Ok(()),
            }
        });
        match seen {
            Ok(()) => ControlFlow::Continue(()),
            Err(raised) => {
                self.raised = Some(raised);
                ControlFlow::Break(())
            }
        }
    }

    /// Raises the stored exception, except for Ctrl-C, after which the results so far are kept.
    pub fn check(self, py: Python<'_>) -> PyResult<()> {
        match self.raised {
            Some(raised) if !raised.is_instance_of::<PyKeyboardInterrupt>(py) => Err(raised),
            _ => Ok(()),
        }
    }
}
