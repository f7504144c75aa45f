//! Jacobians by difference quotients: columns that share no row are shifted at once.
//!
//! Increments and signs are those of the dense difference quotients of SUNDIALS. A tridiagonal matrix takes
//! three evaluations, whatever its size.

use std::ffi::c_void;

use super::{
    colouring::Colouring, context::Context, functions::Functions, linear_solver::LinearSolver,
    pattern::Pattern, shape::Shape, signs::Sign, vector::Vector,
};
use crate::integrators::common::{Error, Tolerances};
use crate::integrators::ode::Failure;

/// Difference quotients for the matrix of a linear solver.
pub(crate) struct Differences {
    shape: Shape,
    colouring: Colouring,
    /// For an ODE; a DAE has the increments of IDA.
    increments: Option<Increments>,
    /// Which signs the unknowns keep, if any.
    signs: Vec<Sign>,
    /// The point that the function is evaluated at. An ODE has no `yp`.
    y: Vec<f64>,
    yp: Vec<f64>,
    /// The function there.
    value: Vec<f64>,
    /// Number of evaluations of the function.
    pub(crate) evaluations: u64,
}

/// Writes the function at a state. (`dyn`: callers are compiled once, not for each type of system.)
type Evaluate<'a, E> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), E> + 'a;

/// An error of a function, which may mean that it is not defined there.
pub(crate) trait Refused {
    fn is_recoverable(&self) -> bool;
}

impl Refused for Failure {
    fn is_recoverable(&self) -> bool {
        matches!(self, Self::Recoverable(_))
    }
}

/// Results of callbacks, as C takes them.
impl Refused for i32 {
    fn is_recoverable(&self) -> bool {
        *self > 0
    }
}

/// Whether a function has no value where it was evaluated.
fn is_undefined<E: Refused>(outcome: &Result<(), E>, value: &[f64]) -> bool {
    match outcome {
        Ok(()) => value.iter().any(|value| !value.is_finite()),
        Err(error) => error.is_recoverable(),
    }
}

/// Increments of the unknowns of an ODE for difference quotients.
struct Increments {
    tolerances: Tolerances,
    /// The increment of each unknown, as a fraction of its size.
    fractions: Vec<f64>,
    /// Change of the function by the last shift of each unknown.
    changes: Vec<Change>,
    /// Whether they depend on nothing but the point.
    are_repeatable: bool,
}

/// The largest change of the function along a column, and the size of the function there.
#[derive(Clone, Copy, Default)]
struct Change {
    largest: f64,
    size: f64,
}

/// Limits of the shift of an unknown, as a fraction of its size. Salane's fractions fall below the root of
/// the rounding error, 2^-26, where a shift changes much; but in stiff equations near equilibrium, whose
/// terms cancel, any shift does, and shorter ones give noise.
const LEAST_FRACTION: f64 = 1.490_116_119_384_765_6e-8;
const LARGEST_FRACTION: f64 = 0.1;
/// 2^-52 to the powers of 7/8, 3/4 and 1/4: limits of the change of the function, relative to its size. A
/// change below the first is rounding: such a column is shifted once more, ten times as far. Below the
/// second, its next shift is ten times as far; above the third, a tenth.
const ROUNDING: f64 = 2.01e-14;
const SMALL: f64 = 1.82e-12;
const LARGE: f64 = 1.22e-4;

impl Change {
    /// Whether it is lost in rounding.
    fn is_lost(self) -> bool {
        self.largest < ROUNDING * self.size
    }

    /// The fraction for the next shift, after one by `fraction`.
    fn next(self, fraction: f64) -> f64 {
        let factor = match self {
            Self { largest, size } if largest < SMALL * size => 10.0,
            Self { largest, size } if largest > LARGE * size => 0.1,
            _ => 1.0,
        };
        (factor * fraction).clamp(LEAST_FRACTION, LARGEST_FRACTION)
    }
}

impl Differences {
    /// df/dy of an ODE, whose unknowns keep these signs, if any; none if there is no matrix to write it into.
    pub(crate) fn of_ode(
        solver: &LinearSolver,
        n: usize,
        tolerances: &Tolerances,
        signs: &[Sign],
    ) -> Option<Self> {
        let increments = Increments {
            tolerances: tolerances.clone(),
            fractions: vec![LEAST_FRACTION; n],
            changes: vec![Change::default(); n],
            are_repeatable: false,
        };
        Some(Self::new(Shape::of(solver)?, n, Some(increments), signs))
    }

    /// dF/dy + cj dF/dy' of a DAE on a pattern.
    pub(super) fn of_dae(pattern: &Pattern, signs: &[Sign]) -> Self {
        let n = pattern.dimension();
        let differences = Self::new(Shape::Sparse(pattern.clone()), n, None, signs);
        Self { yp: vec![0.0; n], ..differences }
    }

    /// Resets the increments and the count, for a new start.
    pub(super) fn restart(&mut self) {
        self.evaluations = 0;
        if let Some(increments) = &mut self.increments {
            increments.fractions.fill(LEAST_FRACTION);
        }
    }

    /// Lets no increment depend on earlier points: the adjoint method repeats parts of a run from its checkpoints, and C, which has storage
    /// for as many steps as before, has to take the same ones.
    pub(super) fn make_repeatable(&mut self) {
        self.increments.iter_mut().for_each(|increments| increments.are_repeatable = true);
    }

    fn new(shape: Shape, n: usize, increments: Option<Increments>, signs: &[Sign]) -> Self {
        Self {
            colouring: shape.colouring(n),
            shape,
            increments,
            signs: signs.to_vec(),
            y: vec![0.0; n],
            yp: Vec::new(),
            value: vec![0.0; n],
            evaluations: 0,
        }
    }

    /// Writes df/dy into `values`, which has the layout of the linear solver's matrix; `ydot` is f(t, y), and
    /// `evaluate` writes it at another y.
    ///
    /// Increments are fractions of the size of each unknown, in the direction in which it moves. They adapt
    /// to the change of the function: so large that it is not lost in rounding, and no larger than needed
    /// (D. E. Salane, "Adaptive routines for forming Jacobians numerically", Sandia report SAND86-1319, 1986).
    /// A colour with a column whose change was lost takes a second evaluation; so does one whose shifts lead out of where the
    /// function is defined, in the other direction.
    pub(crate) fn of_rhs<E: Refused>(
        &mut self,
        y: &[f64],
        ydot: &[f64],
        values: &mut [f64],
        evaluate: &mut Evaluate<'_, E>,
    ) -> Result<(), E> {
        let Self { shape, colouring, signs, y: shifted, value, evaluations, .. } = self;
        let Some(Increments { tolerances, fractions, changes, are_repeatable }) =
            &mut self.increments
        else {
            return Ok(());
        };
        if *are_repeatable {
            fractions.fill(LEAST_FRACTION);
        }
        let (n, stored) = (y.len(), values.len());
        let shift = |j: usize, fraction: f64| {
            let forward = if ydot[j] < 0.0 { -1.0 } else { 1.0 };
            let step = forward * fraction * tolerances.size_of(j, y[j]);
            let is_allowed = signs.get(j).is_none_or(|sign| sign.allows(y[j] + step));
            y[j] + if is_allowed { step } else { -step }
        };
        shifted.copy_from_slice(y);
        for colour in 0..colouring.count() {
            let columns = colouring.columns(colour);
            columns.iter().for_each(|&j| shifted[j] = shift(j, fractions[j]));
            *evaluations += 1;
            let outcome = evaluate(shifted, value);
            if is_undefined(&outcome, value) {
                for &j in columns {
                    let back = 2.0 * y[j] - shifted[j];
                    if signs.get(j).is_none_or(|sign| sign.allows(back)) {
                        shifted[j] = back;
                    }
                }
                *evaluations += 1;
                evaluate(shifted, value)?;
            } else {
                outcome?;
            }
            let mut again = false;
            for &j in columns {
                let column = &mut values[shape.positions(j, n, stored)];
                let rows = |k: usize| shape.row(j, k);
                changes[j] = difference(column, rows, [value, ydot], shifted[j] - y[j]);
                let is_lost = changes[j].is_lost() && fractions[j] < LARGEST_FRACTION;
                again |= is_lost;
                shifted[j] = if is_lost { shift(j, 10.0 * fractions[j]) } else { y[j] };
            }
            if again {
                *evaluations += 1;
                evaluate(shifted, value)?;
            }
            for &j in columns {
                if shifted[j] != y[j] {
                    let rows = |k: usize| shape.row(j, k);
                    let positions = shape.positions(j, n, stored);
                    let farther = change(positions.len(), rows, [value, ydot]);
                    if changes[j].largest * farther.size < farther.largest * changes[j].size {
                        let column = &mut values[positions];
                        changes[j] = difference(column, rows, [value, ydot], shifted[j] - y[j]);
                        fractions[j] *= 10.0;
                    }
                    shifted[j] = y[j];
                }
                fractions[j] = changes[j].next(fractions[j]);
            }
        }
        Ok(())
    }

    /// Writes dF/dy + cj dF/dy' into `values`; `residual` is F(t, y, y'), and `evaluate` writes it at another
    /// y and y', and returns 0 or the code to return to C.
    ///
    /// The increments are those of IDA's dense quotients (`idaLsDenseDQJac`), by the step size and the error
    /// weights.
    pub(super) fn of_residual(
        &mut self,
        (cj, y, yp): (f64, &[f64], &[f64]),
        (h, weights): (f64, &[f64]),
        residual: &[f64],
        values: &mut [f64],
        mut evaluate: impl FnMut(&[f64], &[f64], &mut [f64]) -> i32,
    ) -> i32 {
        let root = f64::EPSILON.sqrt();
        let increment = |j: usize| {
            let change = h * yp[j];
            let size = (root * y[j].abs().max(change.abs())).max(1.0 / weights[j]);
            if change < 0.0 { -size } else { size }
        };
        self.y.copy_from_slice(y);
        self.yp.copy_from_slice(yp);
        let (n, stored) = (y.len(), values.len());
        for colour in 0..self.colouring.count() {
            let columns = self.colouring.columns(colour);
            for &j in columns {
                let step = increment(j);
                let is_allowed = self.signs.get(j).is_none_or(|sign| sign.allows(y[j] + step));
                self.y[j] += if is_allowed { step } else { -step };
                self.yp[j] += cj * (self.y[j] - y[j]);
            }
            self.evaluations += 1;
            let outcome = evaluate(&self.y, &self.yp, &mut self.value);
            if outcome != 0 {
                return outcome;
            }
            for &j in columns {
                let column = &mut values[self.shape.positions(j, n, stored)];
                let rows = |k: usize| self.shape.row(j, k);
                difference(column, rows, [&self.value, residual], self.y[j] - y[j]);
                (self.y[j], self.yp[j]) = (y[j], yp[j]);
            }
        }
        0
    }
}

/// Writes the difference quotients of a column, from the function at both ends of a shift.
fn difference(
    column: &mut [f64],
    rows: impl Fn(usize) -> usize,
    [ahead, base]: [&[f64]; 2],
    shift: f64,
) -> Change {
    for (k, entry) in column.iter_mut().enumerate() {
        let i = rows(k);
        *entry = (ahead[i] - base[i]) / shift;
    }
    change(column.len(), rows, [ahead, base])
}

/// The largest change in the rows of a column.
fn change(count: usize, rows: impl Fn(usize) -> usize, [ahead, base]: [&[f64]; 2]) -> Change {
    let mut most = Change::default();
    for i in (0..count).map(rows) {
        let largest = (ahead[i] - base[i]).abs();
        if largest > most.largest || most.size == 0.0 {
            most = Change { largest, size: ahead[i].abs().max(base[i].abs()) };
        }
    }
    most
}

/// The step size and the error weights of an integrator, which its callbacks read.
pub(super) struct Scales {
    memory: *mut c_void,
    functions: &'static Functions,
    weights: Vector,
}

impl Scales {
    /// # Safety
    /// `memory` belongs to the integrator of `functions`, of `n` equations, and is alive whenever it is read.
    pub(super) unsafe fn new(
        (memory, functions): (*mut c_void, &'static Functions),
        n: usize,
        context: &Context,
    ) -> Result<Self, Error> {
        Ok(Self { memory, functions, weights: Vector::from_slice(&vec![0.0; n], context)? })
    }

    pub(super) fn read(&mut self) -> (f64, &[f64]) {
        let (_, get_weights) = self.functions.get_error_weights;
        let mut h = f64::NAN;
        // SAFETY: the memory is that of the integrator that is calling; it fills a vector of its length, and
        // the result pointer is valid.
        unsafe {
            get_weights(self.memory, self.weights.raw());
            (self.functions.get_current_step.1)(self.memory, &raw mut h);
        }
        (h, self.weights.as_slice())
    }
}
