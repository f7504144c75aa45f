//! The equations as a system for integrators.

use std::fmt;

use faer::MatMut;

use super::{dual::Dual, number::Number};
use crate::integrators::{
    ode::{BandMut, Entries, Failure, Ode, Storage},
    sundials::{Colouring, Jacobian, LinearSolver, Pattern, Shape},
};

/// y' = f(t, y, p), written over a number type.
pub trait RightHandSide {
    /// Writes f(t, y, p) into `ydot` (same length as `y`, zero on entry).
    ///
    /// # Errors
    /// As [`Ode::rhs`].
    fn rhs<T: Number>(&mut self, t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure>;
}

/// Directions along which one evaluation differentiates: with more, those that a Jacobian of few columns or colours does not need cost more
/// than an evaluation less saves.
const LANES: usize = 4;

/// An ODE with exact derivatives, made by [`automatic`].
pub struct Automatic<E> {
    equations: E,
    parameters: Vec<f64>,
    solver: LinearSolver,
    shape: Shape,
    /// Columns that are differentiated at once; none before the first Jacobian.
    colouring: Option<Colouring>,
    many: Workspace<LANES>,
    one: Workspace<1>,
}

impl<E> fmt::Debug for Automatic<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Automatic")
            .field("parameters", &self.parameters)
            .field("solver", &self.solver)
            .finish_non_exhaustive()
    }
}

/// The ODE y' = f(t, y, p) with the parameters `p` (none: `[]`) and a dense Jacobian: [`banded`](Automatic::banded) and
/// [`sparse`](Automatic::sparse) give it another form.
///
/// [`solve`](fn@crate::integrators::solve::solve) uses the Jacobian where no linear solver is given; the integrators below it take
/// [`linear_solver`](Automatic::linear_solver).
pub fn automatic<E: RightHandSide>(equations: E, p: impl Into<Vec<f64>>) -> Automatic<E> {
    let solver = LinearSolver::Dense(Jacobian::Supplied);
    let (colouring, many, one) = (None, Workspace::default(), Workspace::default());
    Automatic { equations, parameters: p.into(), solver, shape: Shape::Dense, colouring, many, one }
}

impl<E> Automatic<E> {
    /// With a Jacobian of band form: entry (i, j) may be nonzero where `j - upper <= i <= j + lower`. It takes an evaluation for each
    /// four of its diagonals.
    #[must_use]
    pub fn banded(self, lower: usize, upper: usize) -> Self {
        self.of(LinearSolver::Band { lower, upper, jacobian: Jacobian::Supplied })
    }

    /// With a sparse Jacobian. It takes an evaluation for each four colours of its columns, of which those that share no row have the same.
    ///
    /// [`Pattern::ode_by_sampling`] and [`Pattern::ode_by_nan`] find the pattern, of these equations, too.
    #[must_use]
    pub fn sparse(self, pattern: Pattern) -> Self {
        self.of(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied })
    }

    fn of(self, solver: LinearSolver) -> Self {
        let shape = Shape::of(&solver).unwrap_or(Shape::Dense);
        Self { solver, shape, colouring: None, ..self }
    }

    /// The linear solver that takes the Jacobian as it is.
    #[must_use]
    pub fn linear_solver(&self) -> LinearSolver {
        self.solver.clone()
    }

    /// Refuses a matrix of another form than that of the Jacobian.
    fn check(fits: bool) -> Result<(), Failure> {
        if fits {
            return Ok(());
        }
        let text = "the band or pattern of the linear solver is not that of the equations: Automatic::linear_solver gives the right one";
        Err(Failure::Fatal(text.into()))
    }
}

impl<E: RightHandSide> Automatic<E> {
    /// Differentiates f by all unknowns, and calls `put` with the shape, each column and its lane in f.
    fn each_column(
        &mut self,
        t: f64,
        y: &[f64],
        mut put: impl FnMut(&Shape, usize, usize, &[Dual<LANES>]),
    ) -> Result<(), Failure> {
        let Self { equations, parameters, shape, colouring, many, .. } = self;
        let colouring = colouring.get_or_insert_with(|| shape.colouring(y.len()));
        many.start(y, parameters);
        for first in (0..colouring.count()).step_by(LANES) {
            let lanes = LANES.min(colouring.count() - first);
            let columns =
                |lane: usize| colouring.columns(first + lane).iter().map(move |&j| (j, lane));
            let directions = || (0..lanes).flat_map(columns);
            directions().for_each(|(j, lane)| many.y[j].slopes[lane] = 1.0);
            many.evaluate(equations, t)?;
            directions().for_each(|(j, lane)| put(shape, j, lane, &many.f));
            directions().for_each(|(j, lane)| many.y[j].slopes[lane] = 0.0);
        }
        Ok(())
    }

    fn fill(&mut self, t: f64, y: &[f64], mut entries: Entries<'_>) -> Result<(), Failure> {
        let n = y.len();
        self.each_column(t, y, |shape, j, lane, f| match (&mut entries, shape) {
            (Entries::Dense(matrix), Shape::Dense) => {
                let column = matrix.as_mut().col_mut(j);
                column.iter_mut().zip(f).for_each(|(entry, f)| *entry = f.slopes[lane]);
            }
            (entries, shape) => {
                for (k, position) in shape.positions(j, n, shape.stored(n)).enumerate() {
                    let i = shape.row(j, k);
                    entries.set((i, j), position, f[i].slopes[lane]);
                }
            }
        })
    }

    /// Writes the derivative of f along a direction of the unknowns and of one parameter, if any, into `out`.
    fn along(
        &mut self,
        (t, y): (f64, &[f64]),
        v: &[f64],
        parameter: Option<usize>,
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, parameters, one, .. } = self;
        one.start(y, parameters);
        one.y.iter_mut().zip(v).for_each(|(y, v)| y.slopes = [*v]);
        if let Some(parameter) = parameter {
            one.p[parameter].slopes = [1.0];
        }
        one.evaluate(equations, t)?;
        out.iter_mut().zip(&one.f).for_each(|(out, f)| *out = f.slopes[0]);
        Ok(())
    }
}

impl<E: RightHandSide> Ode for Automatic<E> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.equations.rhs(t, y, &self.parameters, ydot)
    }

    fn supplied_jacobian(&self) -> Option<Storage<'_>> {
        Some(match &self.solver {
            &LinearSolver::Band { lower, upper, .. } => Storage::Band { lower, upper },
            LinearSolver::Klu { pattern, .. } => Storage::Sparse {
                column_pointers: pattern.column_pointers(),
                row_indices: pattern.row_indices(),
            },
            _ => Storage::Dense,
        })
    }

    fn dense_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.fill(t, y, Entries::Dense(jacobian))
    }

    fn banded_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        let (lower, upper) = (jacobian.lower(), jacobian.upper());
        Self::check(
            matches!(self.shape, Shape::Band { lower: l, upper: u } if (l, u) == (lower, upper)),
        )?;
        self.fill(t, y, Entries::Band(jacobian))
    }

    fn sparse_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        Self::check(
            matches!(&self.shape, Shape::Sparse(pattern) if pattern.entry_count() == values.len()),
        )?;
        self.fill(t, y, Entries::Sparse(values))
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.along((t, y), v, None, jv)
    }

    fn sensitivity_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        self.along((t, y), s, Some(parameter), sdot)
    }

    fn adjoint_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let n = y.len();
        self.each_column(t, y, |shape, j, lane, f| {
            let rows = (0..shape.positions(j, n, shape.stored(n)).len()).map(|k| shape.row(j, k));
            out[j] = rows.map(|i| lambda[i] * f[i].slopes[lane]).sum();
        })
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, parameters, many, .. } = self;
        for (chunk, out) in out.chunks_mut(LANES).enumerate() {
            many.start(y, parameters);
            for lane in 0..out.len() {
                many.p[chunk * LANES + lane].slopes[lane] = 1.0;
            }
            many.evaluate(equations, t)?;
            for (lane, out) in out.iter_mut().enumerate() {
                *out = many.f.iter().zip(lambda).map(|(f, lambda)| f.slopes[lane] * lambda).sum();
            }
        }
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.parameters.copy_from_slice(values);
    }
}

/// Unknowns, parameters and the right-hand side, with their slopes.
#[derive(Default)]
struct Workspace<const N: usize> {
    y: Vec<Dual<N>>,
    p: Vec<Dual<N>>,
    f: Vec<Dual<N>>,
}

impl<const N: usize> Workspace<N> {
    /// Takes unknowns and parameters without slopes.
    fn start(&mut self, y: &[f64], p: &[f64]) {
        let numbers = |values: &[f64], out: &mut Vec<Dual<N>>| {
            out.clear();
            out.extend(values.iter().map(|&value| Dual::from(value)));
        };
        numbers(y, &mut self.y);
        numbers(p, &mut self.p);
        self.f.resize(y.len(), Dual::from(0.0));
    }

    fn evaluate<E: RightHandSide>(&mut self, equations: &mut E, t: f64) -> Result<(), Failure> {
        self.f.fill(Dual::from(0.0));
        equations.rhs(t, &self.y, &self.p, &mut self.f)
    }
}
