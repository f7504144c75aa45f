//! Checks whether a linear solver or a preconditioner of a system's own solves its Newton systems, while an integrator uses it.
//!
//! A solver that answers zero ends each Newton iteration at once, as if the prediction were the solution.

use super::{error::Cause, jacobian_check::Point, tolerances::Tolerances};
use crate::integrators::ode::Failure;

/// Checks what a system answers to the product of its Newton matrix with a direction, which should be that direction.
///
/// It checks the first set-up, the second, the fourth, the eighth and so on, by two evaluations of the equations and two solutions.
#[derive(Debug)]
pub(crate) struct SolverCheck {
    tolerances: Tolerances,
    is_preconditioner: bool,
    seen: u64,
    next: u64,
    direction: Vec<f64>,
    moved: [Vec<f64>; 2],
    base: Vec<f64>,
    answer: Vec<f64>,
    /// The answer to zero: terms that `newton_solve` adds by itself.
    offset: Vec<f64>,
}

/// What a check asks a system for.
pub(crate) enum Asked<'a> {
    /// The equations at a state and time derivative.
    Equations([&'a [f64]; 2]),
    /// The solution for the numbers that are there.
    Solution,
}

/// Shift along the direction, relative to the sizes of the unknowns.
const SHIFT: f64 = 1e-5;
/// What differences leave of a product, and solutions of a system.
const TOLERANCE: f64 = 0.01;
/// Part of an error that an iteration has to remove for Newton's method to converge at all.
const LEAST_GAIN: f64 = 0.1;
/// An answer of less than this is zero.
const NOTHING: f64 = 1e-30;

impl SolverCheck {
    /// For the integration of `n` equations within these tolerances.
    pub(crate) fn new(n: usize, tolerances: &Tolerances, is_preconditioner: bool) -> Self {
        let zeros = || vec![0.0; n];
        Self {
            tolerances: tolerances.clone(),
            is_preconditioner,
            seen: 0,
            next: 1,
            direction: zeros(),
            moved: [zeros(), Vec::new()],
            base: zeros(),
            answer: zeros(),
            offset: zeros(),
        }
    }

    /// The error in the answers of a system that was just set up at `point`: for I - gamma df/dy of an ODE, or, without a gamma, for
    /// dF/dy + cj dF/dy' of a DAE.
    ///
    /// The result is `None` where the answer is not a multiple of the direction: approximate solvers have other answers, with which Newton's
    /// method converges or shows that it does not. A preconditioner may answer anything but zero.
    pub(crate) fn find(
        &mut self,
        gamma: Option<f64>,
        point: Point<'_>,
        ask: &mut dyn FnMut(Asked<'_>, &mut [f64]) -> Result<(), Failure>,
    ) -> Result<Option<Cause>, Failure> {
        self.seen += 1;
        if self.seen < self.next {
            return Ok(None);
        }
        self.next *= 2;
        let Point { y, yp, cj } = point;
        let Self {
            tolerances, direction, moved: [moved, moved_slope], base, answer, offset, ..
        } = self;
        moved_slope.clear();
        for (j, (v, y)) in direction.iter_mut().zip(y).enumerate() {
            // between 1 and 2, without a pattern
            let uneven = 1.0 + (j as f64 * 0.618_033_988_749_894_9).fract();
            *v = uneven * tolerances.size_of(j, *y);
            moved[j] = y + SHIFT * *v;
            moved_slope.extend(yp.get(j).map(|yp| yp + cj * SHIFT * *v));
        }
        ask(Asked::Equations([y, yp]), base)?;
        if ask(Asked::Equations([moved, moved_slope]), answer).is_err() {
            return Ok(None);
        }
        for ((answer, base), v) in answer.iter_mut().zip(&*base).zip(&*direction) {
            let quotient = (*answer - base) / SHIFT;
            *answer = gamma.map_or(quotient, |gamma| v - gamma * quotient);
        }
        if answer.iter().any(|x| !x.is_finite()) || answer.iter().all(|x| *x == 0.0) {
            return Ok(None);
        }
        offset.fill(0.0);
        ask(Asked::Solution, answer)?;
        ask(Asked::Solution, offset)?;
        // relative to the direction: 1 for each unknown of a solver that is right
        let parts = answer.iter_mut().zip(&*offset).zip(&*direction);
        parts.for_each(|((answer, offset), v)| *answer = (*answer - offset) / v);
        let factor = answer.iter().sum::<f64>() / answer.len() as f64;
        let spread = answer.iter().fold(0.0, |most: f64, x| most.max((x - factor).abs()));
        let is_zero = answer.iter().all(|x| x.abs() < NOTHING);
        let is_multiple = spread <= TOLERANCE * factor.abs();
        let is_wrong =
            !self.is_preconditioner && is_multiple && (1.0 - factor).abs() > 1.0 - LEAST_GAIN;
        Ok((is_zero || is_wrong).then(|| {
            // whoever continues nevertheless gets this error again
            self.next = self.seen + 1;
            Cause::WrongSolver { factor: if is_zero { 0.0 } else { factor } }
        }))
    }
}
