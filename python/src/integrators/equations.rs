//! Equations and functionals whose functions are those of Python or of C.

use std::sync::{Arc, Mutex, PoisonError};

use faer::MatMut;
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pliant::ode::{BandMut, Dae, Failure, Functional, MassKind, Ode, Slopes};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};

/// A right-hand side in C: t, y, where y' is written, and the parameters.
type Compiled = unsafe extern "C" fn(f64, *const f64, *mut f64, *const f64);

/// The right-hand side or residual.
pub enum Function {
    Python(Py<PyAny>),
    C(Compiled),
}

impl Function {
    /// The compiled function at `address`.
    pub fn compiled(address: usize) -> PyResult<Self> {
        if address == 0 {
            return Err(PyValueError::new_err("fun is the address 0, where no function is"));
        }
        // SAFETY: the caller, `pliant/ivp.py`, has checked that this is the address of a compiled function of this type.
        Ok(Self::C(unsafe { std::mem::transmute::<usize, Compiled>(address) }))
    }
}

/// The Jacobian: a function of (t, y) that returns df/dy, or one of (t, y, y', cj) that returns dF/dy + cj dF/dy'.
pub enum Jacobian {
    /// By difference quotients.
    None,
    /// As a matrix.
    Dense(Py<PyAny>),
    /// As the values of a sparse matrix, column by column.
    Sparse(Py<PyAny>),
}

/// The mass matrix: where its entries lie, and their values.
pub struct Mass {
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
    /// Their places among the values of a sparse Newton matrix.
    pub places: Vec<usize>,
    pub values: MassValues,
}

/// Values of the entries of a mass matrix.
#[derive(FromPyObject)]
pub enum MassValues {
    Constant(Vec<f64>),
    /// A function of t that returns them.
    Function(Py<PyAny>),
}

/// The integrands of integrals along the solution.
pub struct Integrands {
    /// A function of the arguments of the equations.
    pub function: Py<PyAny>,
    pub count: usize,
}

/// Storage for the first exception of a Python function, shared by all functions of a run.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Keeps the first one.
    pub fn keep(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// y' = f(t, y) or M y' = f(t, y), or F(t, y, y') = 0. Functions of Python take the parameters as their last argument if
/// there are any.
pub struct Equations {
    pub function: Function,
    pub jacobian: Jacobian,
    pub iterative: Iterative,
    pub mass: Option<Mass>,
    pub integrands: Option<Integrands>,
    pub parameters: Vec<f64>,
    pub raised: Raised,
}

/// Functions for a Krylov method.
#[derive(Default)]
pub struct Iterative {
    /// A function of the arguments of the equations, a vector and, for a residual, cj, that returns the product of the
    /// Jacobian with the vector.
    pub products: Option<Py<PyAny>>,
    /// A function of the arguments of the equations and gamma or cj that returns another one, which solves the Newton
    /// system there approximately.
    pub preconditioner: Option<Py<PyAny>>,
    /// Its last return value.
    pub prepared: Option<Py<PyAny>>,
    /// A function of the arguments of the equations and a vector, or two for a residual, that returns the product of the
    /// transposed Jacobian, or the sum of those by y and by y'.
    pub transposed: Option<Py<PyAny>>,
}

/// Result of `call`; an exception is kept, and ends the run.
pub fn guarded<T>(
    raised: &Raised,
    call: impl FnOnce(Python<'_>) -> PyResult<T>,
) -> Result<T, Failure> {
    Python::attach(call).map_err(|error| {
        let told = Failure::Fatal(error.to_string().into());
        raised.keep(error);
        told
    })
}

/// The arguments of a function: t, arrays, the factor cj of a Jacobian, and the parameters if there are any.
pub fn arguments<'py>(
    py: Python<'py>,
    t: f64,
    arrays: &[&[f64]],
    factor: Option<f64>,
    parameters: &[f64],
) -> PyResult<Bound<'py, PyTuple>> {
    let mut all = vec![PyFloat::new(py, t).into_any()];
    all.extend(arrays.iter().map(|array| PyArray1::from_slice(py, array).into_any()));
    all.extend(factor.map(|factor| PyFloat::new(py, factor).into_any()));
    if !parameters.is_empty() {
        all.push(PyArray1::from_slice(py, parameters).into_any());
    }
    PyTuple::new(py, all)
}

/// Writes the value `returned` by a function into `out`.
fn write(returned: &Bound<'_, PyAny>, out: &mut [f64], what: &str) -> PyResult<()> {
    if let Ok(array) = returned.extract::<PyReadonlyArray1<'_, f64>>() {
        return copy(array.as_array().iter().copied(), out, what);
    }
    let numbers: Vec<f64> = returned
        .py()
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

impl Equations {
    /// Writes the value of a function of `t`, `arrays` and a factor into `out`.
    fn call(
        &self,
        function: &Py<PyAny>,
        (t, arrays, factor): (f64, &[&[f64]], Option<f64>),
        out: &mut [f64],
        what: &str,
    ) -> Result<(), Failure> {
        guarded(&self.raised, |py| {
            let given = arguments(py, t, arrays, factor, &self.parameters)?;
            write(&function.bind(py).call1(given)?, out, what)
        })
    }

    fn dense(
        &self,
        (t, arrays, factor): (f64, &[&[f64]], Option<f64>),
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let Jacobian::Dense(function) = &self.jacobian else { return Err(no_jacobian()) };
        guarded(&self.raised, |py| {
            let given = arguments(py, t, arrays, factor, &self.parameters)?;
            let returned = function.bind(py).call1(given)?;
            let matrix: PyReadonlyArray2<'_, f64> = returned.extract()?;
            let matrix = matrix.as_array();
            let n = jacobian.nrows();
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

    fn sparse(&self, at: (f64, &[&[f64]], Option<f64>), values: &mut [f64]) -> Result<(), Failure> {
        let Jacobian::Sparse(function) = &self.jacobian else { return Err(no_jacobian()) };
        self.call(function, at, values, "jac")
    }

    fn product(
        &self,
        at: (f64, &[&[f64]], Option<f64>),
        product: &mut [f64],
    ) -> Result<(), Failure> {
        let Some(function) = &self.iterative.products else {
            return Err(fatal("there are no products".into()));
        };
        self.call(function, at, product, "products")
    }

    fn transposed_product(
        &self,
        t: f64,
        arrays: &[&[f64]],
        product: &mut [f64],
    ) -> Result<(), Failure> {
        let Some(function) = &self.iterative.transposed else {
            return Err(fatal("there are no transposed products".into()));
        };
        self.call(function, (t, arrays, None), product, "transposed")
    }

    /// Prepares the preconditioner at these arguments.
    fn prepare(&mut self, t: f64, arrays: &[&[f64]], factor: f64) -> Result<(), Failure> {
        let Iterative { preconditioner, prepared, .. } = &mut self.iterative;
        let Some(function) = preconditioner else { return Err(no_preconditioner()) };
        *prepared = Some(guarded(&self.raised, |py| {
            let given = arguments(py, t, arrays, Some(factor), &self.parameters)?;
            Ok(function.bind(py).call1(given)?.unbind())
        })?);
        Ok(())
    }

    fn precondition(&self, r: &mut [f64]) -> Result<(), Failure> {
        let Some(function) = &self.iterative.prepared else { return Err(no_preconditioner()) };
        guarded(&self.raised, |py| {
            let solved = function.bind(py).call1((PyArray1::from_slice(py, r),))?;
            write(&solved, r, "the function that the preconditioner returns")
        })
    }

    fn integral_count(&self) -> usize {
        self.integrands.as_ref().map_or(0, |integrands| integrands.count)
    }

    fn write_integrands(&self, t: f64, arrays: &[&[f64]], out: &mut [f64]) -> Result<(), Failure> {
        let Some(Integrands { function, .. }) = &self.integrands else {
            return Err(fatal("there are no integrands".into()));
        };
        self.call(function, (t, arrays, None), out, "integrands")
    }

    /// Calls `write` with the number, row, column and value of each entry of the mass matrix.
    fn write_mass(
        &self,
        t: f64,
        mut write: impl FnMut(usize, (usize, usize), f64),
    ) -> Result<(), Failure> {
        let Some(mass) = &self.mass else { return Err(fatal("there is no mass".into())) };
        let called;
        let values = match &mass.values {
            MassValues::Constant(values) => values,
            MassValues::Function(function) => {
                let mut values = vec![0.0; mass.rows.len()];
                self.call(function, (t, &[], None), &mut values, "mass")?;
                called = values;
                &called
            }
        };
        let places = mass.rows.iter().copied().zip(mass.columns.iter().copied());
        places.zip(values).enumerate().for_each(|(i, (place, value))| write(i, place, *value));
        Ok(())
    }
}

fn fatal(message: String) -> Failure {
    Failure::Fatal(message.into())
}

fn no_jacobian() -> Failure {
    fatal("there is no jac".into())
}

fn no_preconditioner() -> Failure {
    fatal("there is no preconditioner".into())
}

impl Ode for Equations {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        match &self.function {
            Function::Python(function) => self.call(function, (t, &[y], None), ydot, "fun"),
            Function::C(function) => {
                // SAFETY: `solve` was told that this is the address of a function of this type, which reads as many
                // numbers as there are unknowns, writes as many, and reads no more parameters than there are.
                unsafe { function(t, y.as_ptr(), ydot.as_mut_ptr(), self.parameters.as_ptr()) };
                Ok(())
            }
        }
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.dense((t, &[y], None), jacobian)
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.sparse((t, &[y], None), values)
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.product((t, &[y, v], None), jv)
    }

    fn newton_setup(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.prepare(t, &[y], gamma).map(|()| true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        self.precondition(r)
    }

    fn adjoint_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.transposed_product(t, &[y, lambda], out)
    }

    fn mass_kind(&self) -> MassKind {
        match &self.mass {
            None => MassKind::Identity,
            Some(Mass { values: MassValues::Constant(_), .. }) => MassKind::Constant,
            Some(Mass { values: MassValues::Function(_), .. }) => MassKind::TimeDependent,
        }
    }

    fn dense_mass(&mut self, t: f64, mut mass: MatMut<'_, f64>) -> Result<(), Failure> {
        self.write_mass(t, |_, place, value| mass[place] += value)
    }

    fn banded_mass(&mut self, t: f64, mut mass: BandMut<'_>) -> Result<(), Failure> {
        self.write_mass(t, |_, place, value| mass[place] += value)
    }

    fn sparse_mass(&mut self, t: f64, values: &mut [f64]) -> Result<(), Failure> {
        let places = self.mass.as_ref().map_or(&[][..], |mass| &mass.places);
        self.write_mass(t, |i, _, value| values[places[i]] += value)
    }

    fn quadrature_count(&self) -> usize {
        self.integral_count()
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        self.write_integrands(t, &[y], qdot)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.copy_from_slice(values);
    }
}

impl Dae for Equations {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        match &self.function {
            Function::Python(function) => self.call(function, (t, &[y, yp], None), residual, "fun"),
            Function::C(_) => Err(fatal("residuals are functions of Python".into())),
        }
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.dense((t, &[y, yp], Some(cj)), jacobian)
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.sparse((t, &[y, yp], Some(cj)), values)
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.product((t, &[y, yp, v], Some(cj)), jv)
    }

    fn newton_setup(&mut self, t: f64, cj: f64, y: &[f64], yp: &[f64]) -> Result<(), Failure> {
        self.prepare(t, &[y, yp], cj)
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        self.precondition(r)
    }

    fn adjoint_residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.transposed_product(t, &[y, yp, lambda, mu], out)
    }

    fn quadrature_count(&self) -> usize {
        self.integral_count()
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        self.write_integrands(t, &[y, yp], qdot)
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.copy_from_slice(values);
    }
}

/// A functional whose parts are functions of (t, y, p, whether its derivatives are wanted): they return a number, or one
/// and its derivatives by y and by p.
pub struct Sought {
    pub terminal: Option<Py<PyAny>>,
    pub running: Option<Py<PyAny>>,
    pub raised: Raised,
}

impl Sought {
    fn value(
        &self,
        (function, what): (&Option<Py<PyAny>>, &str),
        (t, y, p): (f64, &[f64], &[f64]),
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let Some(function) = function else { return Ok(0.0) };
        guarded(&self.raised, |py| {
            let (y, p) = (PyArray1::from_slice(py, y), PyArray1::from_slice(py, p));
            let returned = function.bind(py).call1((t, y, p, slopes.is_some()))?;
            let Some(slopes) = slopes else { return returned.extract() };
            let (value, by_y, by_p): (f64, Bound<'_, PyAny>, Bound<'_, PyAny>) =
                returned.extract()?;
            write(&by_y, slopes.y, &format!("the derivative of {what} by y"))?;
            write(&by_p, slopes.p, &format!("the derivative of {what} by p"))?;
            Ok(value)
        })
    }
}

impl Functional for Sought {
    fn running(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.value((&self.running, "running"), (t, y, p), slopes)
    }

    fn terminal(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.value((&self.terminal, "terminal"), (t, y, p), slopes)
    }
}
