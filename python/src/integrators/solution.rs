//! Results of a run as arrays.

use faer::MatRef;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pliant::solve::{self, End};
use pyo3::prelude::*;

use super::run::{Met, met};
use crate::errors::raised;

/// Results of a run.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Solution {
    pub solution: solve::Solution,
    pub unknowns: usize,
    pub failure: Option<String>,
}

impl Solution {
    /// The matrices of all times: [time, column, row].
    fn stacked<'py, 's>(
        &'s self,
        py: Python<'py>,
        matrix: impl Fn(usize) -> MatRef<'s, f64>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let times = self.solution.t().len();
        let [rows, columns] = [matrix(0).nrows(), matrix(0).ncols()];
        let all = (0..times).flat_map(|k| matrix(k).col_iter().collect::<Vec<_>>());
        let numbers: Vec<f64> = all.flat_map(|column| column.iter().copied()).collect();
        PyArray1::from_vec(py, numbers).reshape([times, columns, rows])
    }
}

#[pymethods]
impl Solution {
    /// The times.
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.solution.t())
    }

    /// The states at the times: [time, unknown].
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let states = PyArray1::from_slice(py, self.solution.states());
        states.reshape([self.solution.t().len(), self.unknowns])
    }

    /// The time derivative of the last state of a DAE; empty otherwise.
    #[getter]
    fn last_yp<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.solution.last_yp())
    }

    /// The sensitivities at the times: [time, parameter, unknown].
    #[getter]
    fn sensitivities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, |k| self.solution.sensitivities(k))
    }

    /// How many integrals there are.
    #[getter]
    fn integral_count(&self) -> usize {
        self.solution.quadratures(0).len()
    }

    /// The integrals at the times: [time, integral].
    #[getter]
    fn integrals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let times = self.solution.t().len();
        let all = (0..times).flat_map(|k| self.solution.quadratures(k)).copied();
        PyArray1::from_vec(py, all.collect()).reshape([times, self.integral_count()])
    }

    /// Their sensitivities: [time, parameter, integral].
    #[getter]
    fn integral_sensitivities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.stacked(py, |k| self.solution.quadrature_sensitivities(k))
    }

    /// The methods: the time of the start of each, its name, and why it is used.
    #[getter]
    fn methods(&self) -> Vec<(f64, String, String)> {
        let uses = self.solution.methods().iter();
        uses.map(|used| (used.t, used.method.to_string(), used.reason.clone())).collect()
    }

    /// The parameters at the end.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.solution.parameters())
    }

    /// States at any times within the run: [time, unknown].
    fn at<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut states = vec![0.0; times.len() * self.unknowns];
        for (t, y) in times.iter().zip(states.chunks_exact_mut(self.unknowns)) {
            self.solution.at_into(*t, y).map_err(raised)?;
        }
        PyArray1::from_vec(py, states).reshape([times.len(), self.unknowns])
    }

    /// The events that were met: number, time, state.
    fn events<'py>(&self, py: Python<'py>) -> Vec<Met<'py>> {
        met(py, self.solution.events())
    }

    /// Whether an event has ended the run.
    #[getter]
    fn ended_by_event(&self) -> bool {
        matches!(self.solution.end(), End::Event(_))
    }

    /// Why the run ended early.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Evaluations of the right-hand side, with those for difference quotients.
    #[getter]
    fn evaluations(&self) -> u64 {
        let counts = self.solution.statistics();
        counts.evaluations + counts.difference_quotient_evaluations
    }

    /// Evaluations of the Jacobian.
    #[getter]
    fn jacobian_evaluations(&self) -> u64 {
        self.solution.statistics().jacobian_evaluations
    }

    /// Factorizations of the Newton matrix.
    #[getter]
    fn factorizations(&self) -> u64 {
        self.solution.statistics().linear_setups
    }

    /// Steps.
    #[getter]
    fn steps(&self) -> u64 {
        self.solution.statistics().steps
    }
}
