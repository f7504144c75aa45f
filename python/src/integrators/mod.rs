//! Initial value problems by `pliant::solve`, with functions of Python or of C.

mod equations;
mod events;
mod run;

use std::ops::ControlFlow;

use numpy::PyArray1;
use pliant::solve::{
    Error, MassMatrices, Method, Options, Output, Problem, Reason, gradient as gradient_of,
    solve as solve_problem,
};
use pliant::sundials::{
    AdjointOptions, Jacobian as Source, LinearSolver, Pattern, Sensitivities, Sign,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use self::equations::{
    Equations, Function, Integrands, Jacobian, Mass, MassValues, Raised, Sought,
};
use self::events::AskedEvent;
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
    events: Vec<AskedEvent>,
    /// Times at which the equations jump.
    breaks: Vec<f64>,
    /// A function as `fun`, which returns the integrands, and their number.
    integrands: Option<Py<PyAny>>,
    integral_count: Option<usize>,
    times: Option<Vec<f64>>,
    first_step: Option<f64>,
    min_step: Option<f64>,
    max_step: Option<f64>,
    max_order: Option<u32>,
    max_steps: u64,
    check_jacobian: bool,
    /// Places of unknowns that are not negative.
    nonnegative: Vec<usize>,
    /// Places of parameters.
    sensitivities: Option<Vec<usize>>,
    /// One column after the other.
    initial_sensitivities: Option<Vec<f64>>,
}

impl Asked {
    fn method(&self) -> PyResult<Method> {
        self.method.parse().map_err(raised)
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
        let integrands = self.integrands.zip(self.integral_count);
        let integrands = integrands.map(|(function, count)| Integrands { function, count });
        let equations = Equations {
            function,
            jacobian,
            mass,
            integrands,
            parameters: self.parameters,
            raised: error,
        };
        let mut problem = match self.yp0 {
            None => Problem::ode(equations, self.y0),
            Some(yp0) => Problem::dae(equations, self.y0, yp0),
        };
        problem = self.differential.into_iter().fold(problem, Problem::differential);
        let given = self.initial_sensitivities.into_iter();
        problem = given.fold(problem, Problem::initial_sensitivities);
        for event in self.events {
            problem = problem.event(event.event(error)?);
        }
        problem = problem.breaks(self.breaks);
        if self.is_compiled {
            // Python's own functions meet signals by themselves
            problem = problem.observed_by(move |_| match Python::attach(|py| py.check_signals()) {
                Ok(()) => ControlFlow::Continue(()),
                Err(signal) => {
                    error.keep(signal);
                    ControlFlow::Break(())
                }
            });
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
        options = options.check_jacobian(self.check_jacobian);
        if !self.nonnegative.is_empty() {
            let mut signs = vec![Sign::Free; self.y0.len()];
            for &place in &self.nonnegative {
                *signs.get_mut(place).ok_or_else(|| PyValueError::new_err("nonnegative"))? =
                    Sign::NonNegative;
            }
            options = options.sign_constraints(signs);
        }
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
        let mut sensitivities = self.sensitivities.clone().map(Sensitivities::of);
        if self.integrands.is_some() {
            sensitivities = sensitivities.map(Sensitivities::integrals);
        }
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

/// The facts of the method of this name: its name, whether it is implicit, goes backward in time, takes a mass matrix and a singular one, and
/// has sensitivities.
#[pyfunction]
pub fn method(name: &str) -> PyResult<(&'static str, bool, bool, bool, bool, bool)> {
    let facts = name.parse::<Method>().map_err(raised)?.information();
    let takes_mass = facts.mass != MassMatrices::None;
    let takes_singular_mass = facts.mass == MassMatrices::Singular;
    let (implicit, backward) = (facts.is_implicit, facts.goes_backward);
    Ok((facts.name, implicit, backward, takes_mass, takes_singular_mass, facts.has_sensitivities))
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
