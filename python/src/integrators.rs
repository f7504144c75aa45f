//! Initial value problems by `pliant::solve`, with functions of Python or of C.

use std::cell::RefCell;

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pliant::ode::{Failure, Ode};
use pliant::solve::{
    End, Error, Event, Method, Options, Output, Problem, Solution, solve as solve_problem,
};
use pliant::sundials::{ButcherTable, Jacobian, LinearSolver, Pattern};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::raised;

/// What a run has computed.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Run {
    solution: Solution,
    unknowns: usize,
    failure: Option<String>,
}

#[pymethods]
impl Run {
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

    /// States at any times within the run: [time, unknown].
    fn at<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut states = vec![0.0; times.len() * self.unknowns];
        for (t, y) in times.iter().zip(states.chunks_exact_mut(self.unknowns)) {
            self.solution.at_into(*t, y).map_err(raised)?;
        }
        PyArray1::from_vec(py, states).reshape([times.len(), self.unknowns])
    }

    /// The events that were met: number, time, state.
    fn events<'py>(&self, py: Python<'py>) -> Vec<(usize, f64, Bound<'py, PyArray1<f64>>)> {
        let events = self.solution.events().iter();
        events.map(|met| (met.event, met.t, PyArray1::from_slice(py, &met.y))).collect()
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

/// A right-hand side in C: t, y, where y' is written, and the pointer that `data` was given.
type Compiled = unsafe extern "C" fn(f64, *const f64, *mut f64, *const f64);

/// The right-hand side.
enum Function {
    Python(Py<PyAny>),
    C { function: Compiled, data: Vec<f64> },
}

/// The Jacobian.
enum Slopes {
    /// By difference quotients.
    None,
    /// A function of (t, y) that returns a matrix.
    Dense(Py<PyAny>),
    /// A function of (t, y) that returns the values of a sparse matrix, column by column.
    Sparse(Py<PyAny>),
}

/// Equations in Python.
struct Equations<'a> {
    function: Function,
    slopes: Slopes,
    /// The first exception.
    raised: &'a RefCell<Option<PyErr>>,
}

impl Equations<'_> {
    /// What `call` writes; an exception ends the run.
    fn guarded(&self, call: impl FnOnce(Python<'_>) -> PyResult<()>) -> Result<(), Failure> {
        Python::attach(call).map_err(|error| self.keep(error))
    }

    fn keep(&self, error: PyErr) -> Failure {
        let told = Failure::Fatal(error.to_string().into());
        self.raised.borrow_mut().get_or_insert(error);
        told
    }
}

/// Writes what a function of (t, y) returns into `out`.
fn call(
    py: Python<'_>,
    function: &Py<PyAny>,
    t: f64,
    y: &[f64],
    out: &mut [f64],
    what: &str,
) -> PyResult<()> {
    let returned = function.bind(py).call1((t, PyArray1::from_slice(py, y)))?;
    if let Ok(array) = returned.extract::<PyReadonlyArray1<'_, f64>>() {
        return copy(array.as_array().iter().copied(), out, what);
    }
    let numbers: Vec<f64> = py
        .import("numpy")?
        .call_method1("ravel", (returned,))?
        .call_method1("astype", ("float64",))?
        .call_method0("tolist")?
        .extract()?;
    copy(numbers.into_iter(), out, what)
}

fn copy(numbers: impl ExactSizeIterator<Item = f64>, out: &mut [f64], what: &str) -> PyResult<()> {
    if numbers.len() != out.len() {
        let message =
            format!("{what} returns {} numbers where {} are needed", numbers.len(), out.len());
        return Err(PyValueError::new_err(message));
    }
    out.iter_mut().zip(numbers).for_each(|(out, number)| *out = number);
    Ok(())
}

impl Ode for Equations<'_> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        match &self.function {
            Function::Python(function) => self.guarded(|py| call(py, function, t, y, ydot, "fun")),
            Function::C { function, data } => {
                // SAFETY: `solve` was told that this is the address of a function of this type, which reads as many
                // numbers as there are unknowns, writes as many, and reads no more of `data` than was given.
                unsafe { function(t, y.as_ptr(), ydot.as_mut_ptr(), data.as_ptr()) };
                Ok(())
            }
        }
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: faer::MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let Slopes::Dense(slopes) = &self.slopes else { return Err(no_jacobian()) };
        self.guarded(|py| {
            let returned = slopes.bind(py).call1((t, PyArray1::from_slice(py, y)))?;
            let matrix: PyReadonlyArray2<'_, f64> = returned.extract()?;
            let matrix = matrix.as_array();
            let n = y.len();
            if matrix.dim() != (n, n) {
                let (rows, columns) = matrix.dim();
                let message =
                    format!("jac returns {rows} x {columns} numbers where {n} x {n} are needed");
                return Err(PyValueError::new_err(message));
            }
            for ((row, column), entry) in matrix.indexed_iter() {
                jacobian[(row, column)] = *entry;
            }
            Ok(())
        })
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let Slopes::Sparse(slopes) = &self.slopes else { return Err(no_jacobian()) };
        self.guarded(|py| call(py, slopes, t, y, values, "jac"))
    }
}

fn no_jacobian() -> Failure {
    Failure::Fatal("there is no jac".into())
}

/// The method of this name.
fn method(name: &str) -> PyResult<Method> {
    Ok(match name {
        "bdf" => Method::Bdf,
        "adams" => Method::Adams,
        "dormand-prince" => Method::DormandPrince,
        "rosenbrock" => Method::Rosenbrock,
        table => Method::RungeKutta(table.parse::<ButcherTable>().map_err(raised)?),
    })
}

/// Integrates y' = f(t, y). `fun` is a function of (t, y), or the address of a compiled one. An event is a function of
/// (t, y), a direction (-1, 0, 1), and the number of the event that ends the run (0: none does). `sparsity` is the pattern
/// of the Jacobian by columns: pointers and rows.
#[pyfunction]
#[pyo3(signature = (fun, data, span, y0, method_name, rtol, atol, *, jac = None, sparsity = None, band = None, events = vec![],
    times = None, first_step = None, min_step = None, max_step = None, max_order = None, max_steps = 1_000_000))]
#[allow(clippy::too_many_arguments)]
pub fn solve(
    py: Python<'_>,
    fun: Py<PyAny>,
    data: Option<Vec<f64>>,
    span: (f64, f64),
    y0: Vec<f64>,
    method_name: &str,
    rtol: f64,
    atol: Vec<f64>,
    jac: Option<Py<PyAny>>,
    sparsity: Option<(Vec<usize>, Vec<usize>)>,
    band: Option<(usize, usize)>,
    events: Vec<(Py<PyAny>, i32, u32)>,
    times: Option<Vec<f64>>,
    first_step: Option<f64>,
    min_step: Option<f64>,
    max_step: Option<f64>,
    max_order: Option<u32>,
    max_steps: u64,
) -> PyResult<Run> {
    let unknowns = y0.len();
    let function = match data {
        None => Function::Python(fun),
        Some(data) => {
            let address: usize = fun.extract(py)?;
            if address == 0 {
                return Err(PyValueError::new_err("fun is the address 0, where no function is"));
            }
            // SAFETY: the caller, `pliant/ivp.py`, has checked that this is the address of a compiled function of this type.
            let function = unsafe { std::mem::transmute::<usize, Compiled>(address) };
            Function::C { function, data }
        }
    };
    let supplied = if jac.is_some() { Jacobian::Supplied } else { Jacobian::DifferenceQuotients };
    let (linear_solver, slopes) = match (sparsity, band, jac) {
        (Some((columns, rows)), _, jac) => {
            let pattern = Pattern::from_csc(&columns, &rows).map_err(raised)?;
            let slopes = jac.map_or(Slopes::None, Slopes::Sparse);
            (Some(LinearSolver::Klu { pattern, jacobian: supplied }), slopes)
        }
        (None, Some((lower, upper)), _) => {
            let jacobian = Jacobian::DifferenceQuotients;
            (Some(LinearSolver::Band { lower, upper, jacobian }), Slopes::None)
        }
        (None, None, Some(jac)) => {
            (Some(LinearSolver::Dense(Jacobian::Supplied)), Slopes::Dense(jac))
        }
        (None, None, None) => (None, Slopes::None),
    };
    let error = RefCell::new(None);
    let equations = Equations { function, slopes, raised: &error };
    let mut problem = Problem::ode(equations, y0);
    for (function, direction, last) in &events {
        let mut event = Event::new(|t, y| {
            let value = Python::attach(|py| {
                function
                    .bind(py)
                    .call1((t, PyArray1::from_slice(py, y)))?
                    .call_method0("__float__")?
                    .extract()
            });
            value.unwrap_or_else(|raised: PyErr| {
                error.borrow_mut().get_or_insert(raised);
                f64::NAN
            })
        });
        event = match direction {
            1.. => event.rising(),
            0 => event,
            _ => event.falling(),
        };
        problem = problem.event(if *last > 0 { event.terminal_after(*last) } else { event });
    }
    let mut options = Options::new(rtol, atol).max_steps(max_steps);
    options = options.output(times.map_or(Output::Steps, Output::Times));
    for (value, set) in [
        (first_step, Options::initial_step as fn(Options, f64) -> Options),
        (min_step, Options::min_step),
        (max_step, Options::max_step),
    ] {
        options = value.into_iter().fold(options, set);
    }
    options = max_order.into_iter().fold(options, Options::max_order);
    options = linear_solver.into_iter().fold(options, Options::linear_solver);
    let result = solve_problem(problem, method(method_name)?, span, &options);
    if let Some(raised) = error.into_inner() {
        return Err(raised);
    }
    match result {
        Ok(solution) => Ok(Run { solution, unknowns, failure: None }),
        Err(Error::Stopped(stopped)) => {
            let failure = Some(stopped.to_string());
            Ok(Run { solution: stopped.solution, unknowns, failure })
        }
        Err(Error::Input(error)) => Err(raised(error)),
        Err(other) => Err(PyValueError::new_err(other.to_string())),
    }
}
