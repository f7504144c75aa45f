//! The equations of the sensitivities, by the system or by differences.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::options::{Sensitivities, SensitivitySource};
use crate::base::input::InputError;
use crate::integrators::{common::Tolerances, ode::Failure};

/// Access to the parameters of an `Ode` or a `Dae`.
pub(in crate::integrators::sundials) struct Access<S> {
    pub(in crate::integrators::sundials) get: fn(&S) -> &[f64],
    pub(in crate::integrators::sundials) set: fn(&mut S, &[f64]),
}

impl<S> Access<S> {
    /// Calls `evaluate`, which may change the parameters, and sets them to `p` then, whatever happens.
    pub(in crate::integrators::sundials) fn restoring<T>(
        &self,
        system: &mut S,
        p: &[f64],
        evaluate: impl FnOnce(&mut S) -> T,
    ) -> T {
        let outcome = catch_unwind(AssertUnwindSafe(|| evaluate(system)));
        (self.set)(system, p);
        outcome.unwrap_or_else(|panic| resume_unwind(panic))
    }
}

/// Which parameters the sensitivities are to, and scratch space for differences.
pub(in crate::integrators::sundials) struct SensitivityRhs {
    parameters: Vec<usize>,
    /// Derivatives of the parameters of the system by each of these: one column after the other.
    directions: Vec<f64>,
    source: SensitivitySource,
    scales: Vec<f64>,
    tolerances: Tolerances,
    /// The present parameters, and shifted ones.
    p: Vec<f64>,
    trial: Vec<f64>,
    y: Vec<f64>,
    yp: Vec<f64>,
    behind: Vec<f64>,
}

/// A point and a direction: (y, s), and (y', s') of a DAE.
pub(super) struct Line<'a> {
    pub(super) y: (&'a [f64], &'a [f64]),
    pub(super) yp: (&'a [f64], &'a [f64]),
}

impl SensitivityRhs {
    /// Storage for sensitivities of `n` unknowns and so many `integrals`.
    pub(super) fn new<S>(
        options: &Sensitivities,
        tolerances: &Tolerances,
        [n, integrals]: [usize; 2],
        system: &mut S,
        access: &Access<S>,
    ) -> Result<Self, InputError> {
        let p = (access.get)(system).to_vec();
        let scales = options.check(&p)?;
        let mut rhs = Self {
            directions: options.directions(p.len()),
            parameters: options.parameters.clone(),
            source: options.source,
            scales,
            tolerances: tolerances.clone(),
            trial: p.clone(),
            p,
            y: vec![0.0; n],
            yp: vec![0.0; n],
            behind: vec![0.0; n.max(integrals)],
        };
        if rhs.source != SensitivitySource::Supplied || options.integrals {
            rhs.check_access(system, access)?;
        }
        Ok(rhs)
    }

    /// Checks that the parameters can be changed: differences see nothing of others.
    fn check_access<S>(&mut self, system: &mut S, access: &Access<S>) -> Result<(), InputError> {
        for (&place, scale) in self.parameters.iter().zip(&self.scales) {
            self.trial[place] = self.p[place] + scale;
        }
        (access.set)(system, &self.trial);
        let changed = (access.get)(system) == self.trial;
        (access.set)(system, &self.p);
        if changed && (access.get)(system) == self.p {
            return Ok(());
        }
        let help = "set_parameters has to change what parameters gives, or the equations of the \
                    sensitivities have to be supplied, and those of integrals can not be computed";
        Err(InputError::new("parameters of the system", format!("{:?}", self.p), help))
    }

    /// Sets how the parameters of the system change with those that the sensitivities are to, where a jump has
    /// set some of them.
    pub(super) fn set_directions(&mut self, directions: &[f64]) -> Result<(), InputError> {
        if self.is_supplied() && self.directions != directions {
            let help = "a jump has made parameters depend on others: take SensitivitySource::CentralDifferences";
            return Err(InputError::new("source of the sensitivities", "Supplied", help));
        }
        self.directions.copy_from_slice(directions);
        Ok(())
    }

    pub(super) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Index of a parameter among those of the system.
    pub(super) fn parameter(&self, index: usize) -> usize {
        self.parameters[index]
    }

    pub(super) fn is_supplied(&self) -> bool {
        self.source == SensitivitySource::Supplied
    }

    /// Writes the derivative of the equations `evaluate(system, y, y', out)` along `line`, and along the
    /// parameter `index`, into `out`; `value` is their value at the point itself. The parameters of the
    /// system are restored to the last bit, whatever happens.
    #[allow(clippy::too_many_arguments)] // a function, where, along what, and two results
    pub(super) fn differences<S>(
        &mut self,
        system: &mut S,
        access: &Access<S>,
        index: usize,
        line: &Line<'_>,
        value: &[f64],
        out: &mut [f64],
        evaluate: impl FnMut(&mut S, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.p.copy_from_slice((access.get)(system));
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            self.quotient(system, access, index, line, value, out, evaluate)
        }));
        (access.set)(system, &self.p);
        outcome.unwrap_or_else(|panic| resume_unwind(panic))
    }

    #[allow(clippy::too_many_arguments)] // those of `differences`
    fn quotient<S>(
        &mut self,
        system: &mut S,
        access: &Access<S>,
        index: usize,
        line: &Line<'_>,
        value: &[f64],
        out: &mut [f64],
        mut evaluate: impl FnMut(&mut S, &[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let central = self.source != SensitivitySource::ForwardDifferences;
        let increment = self.increment(index, central, line.y);
        let mut at = |rhs: &mut Self, step: f64, out: &mut [f64]| {
            let direction = &rhs.directions[index * rhs.p.len()..];
            move_along(&mut rhs.trial, (&rhs.p, direction), step);
            (access.set)(system, &rhs.trial);
            move_along(&mut rhs.y, line.y, step);
            move_along(&mut rhs.yp, line.yp, step);
            evaluate(system, &rhs.y, &rhs.yp, out)
        };
        at(self, increment, out)?;
        if central {
            let mut behind = std::mem::take(&mut self.behind);
            let outcome = at(self, -increment, &mut behind[..out.len()]);
            self.behind = behind;
            outcome?;
        } else {
            self.behind[..out.len()].copy_from_slice(value);
        }
        let width = if central { 2.0 * increment } else { increment };
        out.iter_mut().zip(&self.behind).for_each(|(out, behind)| *out = (*out - behind) / width);
        Ok(())
    }

    /// The step along (s, dp): small relative to the parameter and to the unknowns, to whose size atol/rtol
    /// is added, as for their errors. The error of central differences is the square of that relative step,
    /// so that sqrt(rtol) is small enough, and rounding errors are least (user guide of CVODES, "Forward
    /// sensitivity analysis"). The error of forward differences is the relative step itself.
    fn increment(&self, index: usize, central: bool, (y, s): (&[f64], &[f64])) -> f64 {
        let rtol = self.tolerances.rtol;
        let smallness = if central { rtol.max(f64::EPSILON).sqrt() } else { f64::EPSILON.sqrt() };
        let relative = |(i, (y, s)): (usize, (&f64, &f64))| match *s {
            0.0 => 0.0,
            s => s / (y.abs() + self.tolerances.noise_of(i)),
        };
        let squares: f64 = y.iter().zip(s).enumerate().map(relative).map(|part| part * part).sum();
        let norm = (squares / y.len() as f64).sqrt();
        let step = smallness / norm.max(1.0 / self.scales[index]);
        // exactly the change of the parameter
        let p = self.p[self.parameters[index]];
        (p + step) - p
    }
}

/// Writes `from` + `step` `direction`.
pub(in crate::integrators::sundials) fn move_along(
    to: &mut [f64],
    (from, direction): (&[f64], &[f64]),
    step: f64,
) {
    for ((to, from), direction) in to.iter_mut().zip(from).zip(direction) {
        *to = from + step * direction;
    }
}
