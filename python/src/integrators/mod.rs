//! Initial value problems by `pliant::solve`, with functions of Python or of C.

mod equations;
mod run;

use numpy::PyArray1;
use pliant::solve::{
    Error, Event, Method, Options, Output, Problem, Reason, gradient as gradient_of,
    solve as solve_problem,
};
use pliant::sundials::{
    AdjointOptions, ButcherTable, Jacobian as Source, LinearSolver, Pattern, Sensitivities,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use self::equations::{Equations, Function, Jacobian, Mass, MassValues, Raised, Sought, arguments};
pub use self::run::Run;
use crate::errors::{made, raised};

/// Problem, method and options: the dict from `pliant/equations.py`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    /// A function of (t, y), or of (t, y, y') for a residual; or the address of a compiled one.
    fun: Py<PyAny>,
    is_compiled: bool,
    span: (f64, f64),
    y0: Vec<f64>,
    /// y' at the start, if `fun` is a residual.
    yp0: Option<Vec<f64>>,
    differential: Option<Vec<bool>>,
    parameters: Vec<f64>,
    method: String,
    rtol: f64,
    atol: Vec<f64>,
    jac: Option<Py<PyAny>>,
    /// The pattern of the Newton matrix by columns: pointers and rows.
    sparsity: Option<(Vec<usize>, Vec<usize>)>,
    band: Option<(usize, usize)>,
    /// Rows and columns of the entries of the mass matrix, and their values.
    mass: Option<(Vec<usize>, Vec<usize>, MassValues)>,
    /// A function of (t, y), a direction (-1, 0, 1), and the number of the event that ends the run (0: none does).
    events: Vec<(Py<PyAny>, i32, u32)>,
    times: Option<Vec<f64>>,
    first_step: Option<f64>,
    min_step: Option<f64>,
    max_step: Option<f64>,
    max_order: Option<u32>,
    max_steps: u64,
    /// Places of parameters.
    sensitivities: Option<Vec<usize>>,
    /// One column after the other.
    initial_sensitivities: Option<Vec<f64>>,
}

impl Asked {
    fn method(&self) -> PyResult<Method> {
        Ok(match self.method.as_str() {
            "bdf" => Method::Bdf,
            "adams" => Method::Adams,
            "ida" => Method::Ida,
            "dormand-prince" => Method::DormandPrince,
            "rosenbrock" => Method::Rosenbrock,
            table => Method::RungeKutta(table.parse::<ButcherTable>().map_err(raised)?),
        })
    }

    /// The equations, their events, and the options.
    fn problem<'a>(self, py: Python<'_>, error: &'a Raised) -> PyResult<(Problem<'a>, Options)> {
        let options = self.options()?;
        let function = match self.is_compiled {
            false => Function::Python(self.fun),
            true => Function::compiled(self.fun.extract(py)?)?,
        };
        let jacobian = match (self.jac, &self.sparsity) {
            (None, _) => Jacobian::None,
            (Some(jac), None) => Jacobian::Dense(jac),
            (Some(jac), Some(_)) => Jacobian::Sparse(jac),
        };
        let mass = match self.mass {
            Some((rows, columns, values)) => {
                let places = places(&rows, &columns, self.sparsity.as_ref())?;
                Some(Mass { rows, columns, places, values })
            }
            None => None,
        };
        let equations =
            Equations { function, jacobian, mass, parameters: self.parameters, raised: error };
        let mut problem = match self.yp0 {
            None => Problem::ode(equations, self.y0),
            Some(yp0) => Problem::dae(equations, self.y0, yp0),
        };
        problem = self.differential.into_iter().fold(problem, Problem::differential);
        let given = self.initial_sensitivities.into_iter();
        problem = given.fold(problem, Problem::initial_sensitivities);
        for (function, direction, last) in self.events {
            let mut event = Event::with_parameters(move |t, y, p| {
                let value = Python::attach(|py| {
                    let returned = function.bind(py).call1(arguments(py, t, &[y], None, p)?)?;
                    returned.call_method0("__float__")?.extract()
                });
                value.unwrap_or_else(|raised: PyErr| {
                    error.keep(raised);
                    f64::NAN
                })
            });
            event = match direction {
                1.. => event.rising(),
                0 => event,
                _ => event.falling(),
            };
            problem = problem.event(if last > 0 { event.terminal_after(last) } else { event });
        }
        Ok((problem, options))
    }

    fn options(&self) -> PyResult<Options> {
        let mut options = Options::new(self.rtol, self.atol.clone()).max_steps(self.max_steps);
        options = options.output(self.times.clone().map_or(Output::Steps, Output::Times));
        for (value, set) in [
            (self.first_step, Options::initial_step as fn(Options, f64) -> Options),
            (self.min_step, Options::min_step),
            (self.max_step, Options::max_step),
        ] {
            options = value.into_iter().fold(options, set);
        }
        options = self.max_order.into_iter().fold(options, Options::max_order);
        let jacobian =
            if self.jac.is_some() { Source::Supplied } else { Source::DifferenceQuotients };
        let solver = match (&self.sparsity, self.band) {
            (Some((columns, rows)), _) => {
                let pattern = Pattern::from_csc(columns, rows).map_err(raised)?;
                Some(LinearSolver::Klu { pattern, jacobian })
            }
            (None, Some((lower, upper))) => {
                let jacobian = Source::DifferenceQuotients;
                Some(LinearSolver::Band { lower, upper, jacobian })
            }
            (None, None) => self.jac.is_some().then_some(LinearSolver::Dense(jacobian)),
        };
        options = solver.into_iter().fold(options, Options::linear_solver);
        let sensitivities = self.sensitivities.clone().map(Sensitivities::of);
        Ok(sensitivities.into_iter().fold(options, Options::sensitivities))
    }
}

/// The places of entries in a sparse matrix; none without one.
fn places(
    rows: &[usize],
    columns: &[usize],
    sparsity: Option<&(Vec<usize>, Vec<usize>)>,
) -> PyResult<Vec<usize>> {
    let Some((pointers, stored)) = sparsity else { return Ok(Vec::new()) };
    let place = |(&row, &column): (&usize, &usize)| {
        let ends = pointers.get(column).zip(pointers.get(column + 1));
        let range = ends.and_then(|(&start, &end)| Some((start, stored.get(start..end)?)));
        range
            .and_then(|(start, rows)| Some(start + rows.iter().position(|r| *r == row)?))
            .ok_or_else(|| {
                PyValueError::new_err(format!(
                    "the pattern lacks the entry ({row}, {column}) of mass"
                ))
            })
    };
    rows.iter().zip(columns).map(place).collect()
}

/// Integrates equations.
#[pyfunction]
pub fn solve(py: Python<'_>, asked: Asked) -> PyResult<Run> {
    let (unknowns, method, span) = (asked.y0.len(), asked.method()?, asked.span);
    let error = Raised::default();
    let (problem, options) = asked.problem(py, &error)?;
    let result = solve_problem(problem, method, span, &options);
    if let Some(raised) = error.take() {
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

/// A number and its derivatives by parameters and by the initial state.
type Slopes<'py> = (f64, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// A functional of the solution of equations, and its gradient. `terminal` and `running` are functions of (t, y, p,
/// whether derivatives are wanted); `adjoint_atol` is the absolute tolerance of the backward run.
#[pyfunction]
pub fn gradient<'py>(
    py: Python<'py>,
    asked: Asked,
    terminal: Option<Py<PyAny>>,
    running: Option<Py<PyAny>>,
    adjoint_atol: f64,
) -> PyResult<Slopes<'py>> {
    let (method, span) = (asked.method()?, asked.span);
    let back = AdjointOptions::new(asked.rtol, adjoint_atol);
    let error = Raised::default();
    let (problem, options) = asked.problem(py, &error)?;
    let sought = Sought { terminal, running, raised: &error };
    let result = gradient_of(problem, sought, method, span, &options, &back);
    if let Some(raised) = error.take() {
        return Err(raised);
    }
    match result {
        Ok(found) => {
            let parameters = PyArray1::from_vec(py, found.parameters);
            Ok((found.value, parameters, PyArray1::from_vec(py, found.initial_state)))
        }
        Err(Reason::Input(error)) => Err(raised(error)),
        Err(reason) => Err(made(py, "Error", (reason.to_string(),))?),
    }
}
