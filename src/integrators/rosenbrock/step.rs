//! The inside of a step: matrix, stages, error, the new solution.
//!
//! The stages are solved for in the form without products with the Jacobian: `newton_rhs` and `newton_solve`
//! of a system serve as they do for ARKODE, and except for the first slope no stage solves a system with M.
//! df/dt is a difference quotient. The matrix is that of the system, a dense one, or a band or sparse one of
//! `integrators/sundials/factors.rs`.
//!
//! Unknowns that are integrals (`Ode::integrals`), such as the energies of bodies, are omitted from the error
//! test and follow by Simpson's rule from their rates at both ends and in the middle of the step. In the
//! Newton system their row is quadratic, which is right for an iteration and wrong for a single solve.

use super::matrix::Matrix;
use super::solver::{LinearlyImplicit, Service, interpolate};
use crate::integrators::common::{
    Callback, Cause, Error, March, Point, StepMethod, Wanted, not_finite,
};
use crate::integrators::ode::{Ode, call};

/// Relative difference of step sizes that one factorization may serve: that by which a step stretches to end at a time.
const SAME_SIZE: f64 = 0.01;

impl LinearlyImplicit {
    /// [`StepMethod::try_step`].
    pub(super) fn attempt<S: Ode>(
        &mut self,
        march: &mut March<S>,
        t_new: f64,
        h: f64,
    ) -> Result<Result<f64, Cause>, Error> {
        if let Some(cause) = self.set_up(march, h)? {
            return Ok(Err(cause));
        }
        if !self.known.time_slope
            && let Some(cause) = self.differentiate_by_time(march, h)?
        {
            return Ok(Err(cause));
        }
        for i in 0..self.tableau.alpha.len() {
            if let Some(cause) = self.solve_stage(march, i, h)? {
                return Ok(Err(cause));
            }
        }
        march.argument.fill(0.0);
        add(&mut march.argument, self.tableau.e, &self.stages);
        let error = self.norm(&march.argument, &march.weight);
        if !error.is_finite() {
            // Finite slopes whose solution overflows: the step is far too long.
            return Ok(Ok(f64::MAX));
        }
        if (error <= 1.0 || march.options.prescribed)
            && let Some(cause) = self.finish(march, t_new, h)?
        {
            return Ok(Err(cause));
        }
        Ok(Ok(error))
    }

    /// Factorizes I - gamma h J.
    fn set_up<S: Ode>(&mut self, march: &mut March<S>, h: f64) -> Result<Option<Cause>, Error> {
        let gamma = self.tableau.gamma * h;
        let is_kept = self.is_linear && self.factored.is_some();
        if self.factored == Some(gamma) && (is_kept || self.known.jacobian) {
            return Ok(None);
        }
        if self.still_serves(gamma) {
            return Ok(None);
        }
        let (t, reuse) = (march.clock.time(march.t), is_kept || self.known.jacobian);
        let March { system, y, slope, statistics, .. } = march;
        statistics.linear_setups += 1;
        self.factored = None;
        let outcome = match &mut self.matrix {
            None => system.newton_setup(t, y, slope, gamma, reuse).map(|_| true),
            Some(matrix) => {
                let evaluated = if reuse { Ok(0) } else { matrix.update(system, t, [y, slope]) };
                evaluated.map(|evaluations| {
                    statistics.difference_quotient_evaluations += evaluations;
                    matrix.not_finite().is_some() || matrix.factorize(gamma)
                })
            }
        };
        march.statistics.jacobian_evaluations += u64::from(!reuse);
        let callback =
            if self.matrix.is_some() { Callback::Jacobian } else { Callback::NewtonSetup };
        let is_regular = match outcome {
            Ok(is_regular) => is_regular,
            Err(failure) => return march.classify(Err(failure), callback, march.t, h),
        };
        if let Some((component, value)) = self.matrix.as_ref().and_then(Matrix::not_finite) {
            let cause = Cause::NotFinite { callback, t, component, value };
            return Err(march.stopped(cause, h).into());
        }
        if !reuse && let Some(cause) = self.wrong_jacobian(march) {
            return Err(march.stopped(cause, h).into());
        }
        self.known.jacobian = true;
        self.service.steps = 0;
        self.factored = is_regular.then_some(gamma);
        Ok((!is_regular).then_some(Cause::LinearSolver))
    }

    /// Whether the factors of another step are good enough for one of this `gamma`.
    fn still_serves(&mut self, gamma: f64) -> bool {
        let Service { most, steps, .. } = self.service;
        let is_same = |factored: f64| (factored - gamma).abs() <= SAME_SIZE * gamma;
        self.service.is_resumed &= self.factored.is_some_and(is_same);
        self.service.is_resumed && (1..most).contains(&steps)
    }

    /// The error in the Jacobian that was just evaluated, if its check is due.
    fn wrong_jacobian<S: Ode>(&mut self, march: &mut March<S>) -> Option<Cause> {
        let (matrix, (method, check)) = (self.matrix.as_ref()?, self.check.as_mut()?);
        if !check.is_due() {
            return None;
        }
        let t = march.clock.time(march.t);
        let March { system, y, .. } = march;
        check.find(*method, Point { y, yp: &[], cj: 0.0 }, &mut |wanted, out| match wanted {
            Wanted::Product(v) => {
                matrix.multiply(v, out);
                true
            }
            Wanted::Equations([y, _]) => call::rhs(system, t, y, out).is_ok(),
            Wanted::Entry(row, column) => matrix.stores(row, column),
        })
    }

    /// df/dt at (t, y), as a difference quotient within the step.
    fn differentiate_by_time<S: Ode>(
        &mut self,
        march: &mut March<S>,
        h: f64,
    ) -> Result<Option<Cause>, Error> {
        let t = march.clock.time(march.t);
        let ahead = t + (f64::EPSILON.sqrt() * (t.abs() + h)).min(h);
        if ahead == t {
            // no number in the step is a later time
            self.time_slope.fill(0.0);
            self.known.time_slope = true;
            return Ok(None);
        }
        march.statistics.difference_quotient_evaluations += 1;
        let outcome = call::rhs(&mut march.system, ahead, &march.y, &mut self.time_slope);
        let setback = march.classify(outcome, Callback::Rhs, march.clock.elapsed(ahead), h)?;
        if let Some(cause) = setback.or_else(|| not_finite(ahead, &self.time_slope)) {
            return Ok(Some(cause));
        }
        let rate = 1.0 / (ahead - t);
        for (ahead, slope) in self.time_slope.iter_mut().zip(&march.slope) {
            *ahead = rate * (*ahead - slope);
        }
        self.known.time_slope = true;
        Ok(None)
    }

    /// Solves for u_i.
    fn solve_stage<S: Ode>(
        &mut self,
        march: &mut March<S>,
        i: usize,
        h: f64,
    ) -> Result<Option<Cause>, Error> {
        let (tableau, gamma) = (self.tableau, self.tableau.gamma * h);
        let t = march.t + tableau.alpha[i] * h;
        let time = march.clock.time(t);
        let (before, rest) = self.stages.split_at_mut(i);
        let u = &mut rest[0];
        // terms of f that the system omits in `newton_rhs` are added in `newton_solve`
        let mut share = 0.0;
        if i == 0 {
            u.copy_from_slice(&march.slope);
        } else {
            march.argument.copy_from_slice(&march.y);
            add(&mut march.argument, tableau.a[i], before);
            march.statistics.evaluations += 1;
            let outcome = if self.matrix.is_some() {
                call::rhs(&mut march.system, time, &march.argument, u)
            } else {
                share = gamma;
                call::newton_rhs(&mut march.system, time, &march.argument, u)
            };
            if let Err(failure) = outcome {
                return march.classify(Err(failure), Callback::Rhs, t, h);
            }
            if let Some(cause) = not_finite(time, u) {
                return Ok(Some(cause));
            }
        }
        let of_time = gamma * h * tableau.gamma_sums[i];
        for (u, by_time) in u.iter_mut().zip(&self.time_slope) {
            *u = gamma * *u + of_time * by_time;
        }
        for (c, earlier) in tableau.c[i].iter().zip(&*before) {
            let c = tableau.gamma * c;
            u.iter_mut().zip(earlier).for_each(|(u, earlier)| *u += c * earlier);
        }
        let outcome = match &mut self.matrix {
            Some(matrix) => {
                if !matrix.solve(u) {
                    return Ok(Some(Cause::LinearSolver));
                }
                Ok(())
            }
            None => {
                let is_checked = self.checks_answers && u.iter().any(|u| *u != 0.0);
                let outcome = march.system.newton_solve(share, u);
                if outcome.is_ok() && is_checked && u.iter().all(|u| *u == 0.0) {
                    return Err(march.stopped(Cause::WrongSolver, h).into());
                }
                outcome
            }
        };
        u[self.coupled..].fill(0.0);
        march.classify(outcome, Callback::NewtonSolve, t, h)
    }

    /// Writes the new solution, its slope, the dense output and the integrals.
    fn finish<S: Ode>(
        &mut self,
        march: &mut March<S>,
        t_new: f64,
        h: f64,
    ) -> Result<Option<Cause>, Error> {
        let (tableau, coupled) = (self.tableau, self.coupled);
        march.y_old.copy_from_slice(&march.y);
        add(&mut march.y_old, tableau.m, &self.stages);
        for (bend, weights) in self.bends.iter_mut().zip([tableau.p, tableau.q]) {
            bend.fill(0.0);
            add(bend, weights, &self.stages);
        }
        march.statistics.evaluations += 1;
        let time = march.clock.time(t_new);
        let outcome = call::rhs(&mut march.system, time, &march.y_old, &mut march.slope_old);
        let setback = march.classify(outcome, Callback::Rhs, t_new, h)?;
        let setback = setback.or_else(|| not_finite(time, &march.slope_old));
        if setback.is_some() || coupled == march.y.len() {
            return Ok(setback);
        }
        // the integrals: Simpson's rule, and the cubic through the slopes at both ends
        let middle = march.t + 0.5 * h;
        interpolate([&march.y, &march.y_old], &self.bends, 0.5, &mut march.argument);
        march.statistics.evaluations += 1;
        let outcome = call::rhs(
            &mut march.system,
            march.clock.time(middle),
            &march.argument,
            &mut march.output,
        );
        for i in coupled..march.y.len() {
            let [first, last] = [h * march.slope[i], h * march.slope_old[i]];
            let change = (first + 4.0 * h * march.output[i] + last) / 6.0;
            march.y_old[i] = march.y[i] + change;
            self.bends[0][i] = first - change;
            self.bends[1][i] = 2.0 * change - first - last;
        }
        march.classify(outcome, Callback::Rhs, middle, h)
    }
}

/// Adds the weighted sum of the vectors.
fn add(out: &mut [f64], weights: &[f64], vectors: &[Vec<f64>]) {
    for (weight, vector) in weights.iter().zip(vectors).filter(|(weight, _)| **weight != 0.0) {
        out.iter_mut().zip(vector).for_each(|(out, x)| *out += weight * x);
    }
}
