//! Initial value problems by `pliant::solve`, with functions of Python or of C.

mod equations;
mod events;
mod krylov;
mod run;
mod solution;

use std::ops::ControlFlow;

use numpy::PyArray1;
use pliant::solve::{
    Error, MassMatrices, Method, Options, Output, Problem, Progress, gradient as gradient_of,
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
use self::krylov::AskedKrylov;
use self::run::completed;
pub use self::run::{Run, Saved};
pub use self::solution::Solution;
use crate::errors::raised;

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
    krylov: Option<AskedKrylov>,
    /// Rows and columns of the entries of the mass matrix, and their values.
    mass: Option<(Vec<usize>, Vec<usize>, MassValues)>,
    events: Vec<AskedEvent>,
    /// Times at which the equations jump.
    breaks: Vec<f64>,
    /// A function as `fun`, which returns the integrands, and their number.
    integrands: Option<Py<PyAny>>,
    integral_count: Option<usize>,
    /// A function of time, state, number of steps and part of the span; it returns whether the run ends.
    observer: Option<Py<PyAny>>,
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
    fn problem(self, py: Python<'_>, raised: &Raised) -> PyResult<(Problem<'static>, Options)> {
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
            iterative: self.krylov.map(AskedKrylov::functions).unwrap_or_default(),
            parameters: self.parameters,
            raised: raised.clone(),
        };
        let mut problem = match self.yp0 {
            None => Problem::ode(equations, self.y0),
            Some(yp0) => Problem::dae(equations, self.y0, yp0),
        };
        problem = self.differential.into_iter().fold(problem, Problem::differential);
        let given = self.initial_sensitivities.into_iter();
        problem = given.fold(problem, Problem::initial_sensitivities);
        for event in self.events {
            problem = problem.event(event.event(raised)?);
        }
        problem = problem.breaks(self.breaks);
        if self.is_compiled || self.observer.is_some() {
            let (observer, raised) = (self.observer, raised.clone());
            problem = problem.observed_by(move |progress| observe(&observer, progress, &raised));
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
        let pattern = self
            .sparsity
            .as_ref()
            .map(|(columns, rows)| Pattern::from_csc(columns, rows).map_err(raised));
        let solver = match (&self.krylov, pattern.transpose()?, self.band) {
            (Some(krylov), Some(pattern), _) => Some(krylov.solver(Some((pattern, jacobian)))?),
            (Some(krylov), None, band) => {
                let n = self.y0.len();
                let pattern = band.map(|(lower, upper)| Pattern::band(n, lower, upper));
                let pattern = pattern.transpose().map_err(raised)?;
                Some(krylov.solver(pattern.map(|pattern| (pattern, jacobian)))?)
            }
            (None, Some(pattern), _) => Some(LinearSolver::Klu { pattern, jacobian }),
            (None, None, Some((lower, upper))) => {
                Some(LinearSolver::Band { lower, upper, jacobian })
            }
            (None, None, None) => self.jac.is_some().then_some(LinearSolver::Dense(jacobian)),
        };
        options = solver.into_iter().fold(options, Options::linear_solver);
        let mut sensitivities = self.sensitivities.clone().map(Sensitivities::of);
        if self.integrands.is_some() {
            sensitivities = sensitivities.map(Sensitivities::integrals);
        }
        Ok(sensitivities.into_iter().fold(options, Options::sensitivities))
    }
}

/// Steps of compiled functions between two looks for signals: each may wait for another thread to let go of Python.
const STEPS_BETWEEN_SIGNALS: u64 = 64;

/// Shows a step to the observer, or looks for signals if there is none; both may end the run.
fn observe(
    observer: &Option<Py<PyAny>>,
    progress: Progress<'_>,
    raised: &Raised,
) -> ControlFlow<()> {
    let Progress { t, y, steps, part } = progress;
    if observer.is_none() && !steps.is_multiple_of(STEPS_BETWEEN_SIGNALS) {
        return ControlFlow::Continue(());
    }
    let ends = Python::attach(|py| {
        py.check_signals()?;
        let Some(observer) = observer else { return Ok(false) };
        observer.bind(py).call1((t, PyArray1::from_slice(py, y), steps, part))?.extract()
    });
    match ends {
        Ok(false) => ControlFlow::Continue(()),
        Ok(true) => ControlFlow::Break(()),
        Err(exception) => {
            raised.keep(exception);
            ControlFlow::Break(())
        }
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

/// Integrates equations; while compiled ones are, other threads have Python.
#[pyfunction]
pub fn solve(py: Python<'_>, asked: Asked) -> PyResult<Solution> {
    let (unknowns, method, span) = (asked.y0.len(), asked.method()?, asked.span);
    let (is_compiled, kept) = (asked.is_compiled, Raised::default());
    let (problem, options) = asked.problem(py, &kept)?;
    let solved = || solve_problem(problem, method, span, &options);
    let result = if is_compiled { py.detach(solved) } else { solved() };
    if let Some(exception) = kept.take() {
        return Err(exception);
    }
    match result {
        Ok(solution) => Ok(Solution { solution, unknowns, failure: None }),
        Err(Error::Stopped(stopped)) => {
            let failure = Some(stopped.to_string());
            Ok(Solution { solution: stopped.solution, unknowns, failure })
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
    let mut back = AdjointOptions::new(asked.rtol, adjoint_atol);
    if asked.krylov.is_some() {
        back = back.supplied_rhs();
    }
    let kept = Raised::default();
    let (problem, options) = asked.problem(py, &kept)?;
    let sought = Sought { terminal, running, raised: kept.clone() };
    let result = gradient_of(problem, sought, method, span, &options, &back);
    let found = completed(py, result, &kept)?;
    let parameters = PyArray1::from_vec(py, found.parameters);
    Ok((found.value, parameters, PyArray1::from_vec(py, found.initial_state)))
}
