//! Sparse Jacobians by difference quotients: columns of one colour are shifted at once.

use std::ffi::c_void;

use super::{
    colouring::Colouring,
    context::Context,
    functions::{Functions, Get},
    pattern::Pattern,
    signs::Sign,
    vector::Vector,
};
use crate::integrate::Error;

/// Difference quotients on a sparsity pattern.
pub(super) struct Differences {
    pattern: Pattern,
    colouring: Colouring,
    /// The integrator that is asked for error weights and step sizes.
    memory: *mut c_void,
    functions: &'static Functions,
    weights: Vector,
    /// Which signs the unknowns keep, if any.
    signs: Vec<Sign>,
    /// The point that the function is evaluated at. An ODE has no `yp`.
    y: Vec<f64>,
    yp: Vec<f64>,
    /// The function there.
    value: Vec<f64>,
    /// How often the function was evaluated.
    pub(super) evaluations: u64,
}

impl Differences {
    /// # Safety
    /// `memory` belongs to the integrator of `functions`, and is alive whenever quotients are asked for.
    pub(super) unsafe fn new(
        pattern: &Pattern,
        (memory, functions): (*mut c_void, &'static Functions),
        is_dae: bool,
        signs: &[Sign],
        context: &Context,
    ) -> Result<Self, Error> {
        let n = pattern.dimension();
        let zeros = vec![0.0; n];
        Ok(Self {
            pattern: pattern.clone(),
            colouring: Colouring::new(pattern),
            memory,
            functions,
            weights: Vector::from_slice(&zeros, context)?,
            signs: signs.to_vec(),
            y: zeros.clone(),
            yp: if is_dae { zeros.clone() } else { Vec::new() },
            value: zeros,
            evaluations: 0,
        })
    }

    /// Writes df/dy into `values`; `ydot` is f(t, y), and `evaluate` writes it at another y or gives the code
    /// with which to return to C.
    ///
    /// The increments are those of the dense quotients (`cvLsDenseDQJac`), with the step parameter gamma for the
    /// step size, which CVODE does not tell in the first step.
    pub(super) fn of_rhs(
        &mut self,
        y: &[f64],
        ydot: &[f64],
        values: &mut [f64],
        mut evaluate: impl FnMut(&[f64], &mut [f64]) -> i32,
    ) -> i32 {
        self.update_weights();
        let gamma = self.ask(self.functions.get_step_parameter);
        let n = y.len() as f64;
        let weighted = ydot.iter().zip(self.weights.as_slice()).map(|(f, w)| (f * w) * (f * w));
        let norm = (weighted.sum::<f64>() / n).sqrt();
        let least = match norm {
            0.0 => 1.0,
            norm => 1000.0 * gamma.abs() * f64::EPSILON * n * norm,
        };
        let root = f64::EPSILON.sqrt();
        let increment = |j: usize, weight: f64| (root * y[j].abs()).max(least / weight);
        self.quotients((0.0, y, &[]), ydot, values, increment, |y, _, f| evaluate(y, f))
    }

    /// Writes dF/dy + cj dF/dy' into `values`; `residual` is F(t, y, y'), and `evaluate` writes it at another y and
    /// y' or gives the code with which to return to C.
    ///
    /// The increments are those of the dense quotients (`idaLsDenseDQJac`).
    pub(super) fn of_residual(
        &mut self,
        (cj, y, yp): (f64, &[f64], &[f64]),
        residual: &[f64],
        values: &mut [f64],
        evaluate: impl FnMut(&[f64], &[f64], &mut [f64]) -> i32,
    ) -> i32 {
        self.update_weights();
        let h = self.ask(self.functions.get_current_step);
        let root = f64::EPSILON.sqrt();
        let increment = |j: usize, weight: f64| {
            let change = h * yp[j];
            let size = (root * y[j].abs().max(change.abs())).max(1.0 / weight);
            if change < 0.0 { -size } else { size }
        };
        self.quotients((cj, y, yp), residual, values, increment, evaluate)
    }

    /// Shifts the columns of each colour by their increments.
    fn quotients(
        &mut self,
        (cj, y, yp): (f64, &[f64], &[f64]),
        base: &[f64],
        values: &mut [f64],
        increment: impl Fn(usize, f64) -> f64,
        mut evaluate: impl FnMut(&[f64], &[f64], &mut [f64]) -> i32,
    ) -> i32 {
        let weights = self.weights.as_slice();
        self.y.copy_from_slice(y);
        self.yp.copy_from_slice(yp);
        for colour in 0..self.colouring.count() {
            let columns = self.colouring.columns(colour);
            for &j in columns {
                let step = increment(j, weights[j]);
                let is_allowed = self.signs.get(j).is_none_or(|sign| sign.allows(y[j] + step));
                self.y[j] += if is_allowed { step } else { -step };
                if let Some(yp) = self.yp.get_mut(j) {
                    *yp += cj * (self.y[j] - y[j]);
                }
            }
            self.evaluations += 1;
            let outcome = evaluate(&self.y, &self.yp, &mut self.value);
            if outcome != 0 {
                return outcome;
            }
            for &j in columns {
                let inverse = 1.0 / (self.y[j] - y[j]);
                let places = self.pattern.places(j);
                for (value, &i) in values[places.clone()].iter_mut().zip(self.pattern.column(j)) {
                    *value = (self.value[i as usize] - base[i as usize]) * inverse;
                }
                self.y[j] = y[j];
                if let Some(slope) = self.yp.get_mut(j) {
                    *slope = yp[j];
                }
            }
        }
        0
    }

    fn update_weights(&mut self) {
        let (_, get) = self.functions.get_error_weights;
        // SAFETY: the memory is that of the integrator that is calling; it fills a vector of its length.
        unsafe { get(self.memory, self.weights.raw()) };
    }

    fn ask(&self, get: Get<f64>) -> f64 {
        let mut value = f64::NAN;
        // SAFETY: as above; the result has a place.
        unsafe { get(self.memory, &raw mut value) };
        value
    }
}
