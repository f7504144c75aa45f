//! Products of Hessians with directions: the adjoint gradient of the derivative along a direction, which is computed with
//! the state ("forward over adjoint").
//!
//! D. B. Ozyurt and P. I. Barton, SIAM J. Sci. Comput. 26 (2005) 1725-1743.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::setup::Adjoint;
use crate::base::{input::InputError, vector::size_or_one};
use crate::integrators::{
    common::{AbsoluteTolerance, Error, Tolerances, check_finite},
    ode::{Borrowed, Entries, Failure, Functional, Ode, Slopes, call},
    sundials::{
        CvodeOptions, Jacobian, LinearSolver, Pattern, Sign,
        adjoint::gradient::Gradient,
        stored_matrix::{Quotients, StoredMatrix},
    },
};

/// Steps of differences of differences, relative to sizes: truncation and rounding are alike.
fn step() -> f64 {
    f64::EPSILON.sqrt().sqrt()
}

impl<S: Ode, F: Functional> Adjoint<S, F> {
    /// The product of the Hessian d2G/dp2 at the end time T = `t` with a `direction` v of the parameters.
    ///
    /// The result is the [`Gradient`] of the derivative of G along v: `value` is (dG/dp)^T v, `parameters` the product
    /// (d2G/dp2) v, and `initial_state` (d2G/dy0 dp) v; y0 does not depend on parameters. All unit vectors give the
    /// Hessian.
    ///
    /// It runs y and s = (dy/dp) v forward, and back with as many unknowns, for twice the unknowns of a gradient.
    /// Second derivatives are central differences of the first, which the system supplies by the options of this
    /// adjoint, or of the equations, with some eight digits: tolerances below 1e-8 are not met.
    ///
    /// # Errors
    /// As for [`gradient`](Self::gradient); [`Error::Input`] for a direction of another length, a Krylov method or error
    /// weights of one's own.
    ///
    /// # Panics
    /// A panic of the system or the functional passes through.
    pub fn hessian_times(&mut self, t: f64, direction: &[f64]) -> Result<Gradient, Error> {
        let (t0, y0, _) = &self.runs.start;
        let (t0, n) = (*t0, y0.len());
        let p = self.system.parameters().to_vec();
        if direction.len() != p.len() {
            let help = format!("there are {} parameters", p.len());
            return Err(Error::input("length of direction", direction.len(), help));
        }
        check_finite("direction", direction)?;
        let parts = direction.iter().zip(&p).map(|(v, p)| v.abs() / size_or_one(*p));
        let scale = parts.fold(0.0, f64::max);
        if scale == 0.0 {
            return Err(Error::input("direction", "zero", "it has a length"));
        }
        let (forward, tolerances) = (&self.runs.forward, self.runs.forward.tolerances.clone());
        let line = Line { v: direction.to_vec(), p, tolerances, scale };
        let matrix = StoredMatrix::new(&forward.linear_solver, n);
        let options = &self.runs.options;
        let doubled = doubled_options(forward, n, scale)?;
        let mut back = options.clone().supplied_rhs().supplied_parameters();
        back.tolerances = doubled_tolerances(&options.tolerances, n, scale);
        let Tolerances { rtol, atol } = options.tolerances_for(&line.p);
        back = back.gradient_tolerances(rtol, scaled(&atol, line.p.len(), scale));
        let start: Vec<f64> = y0.iter().copied().chain(vec![0.0; n]).collect();
        let system = Doubled {
            quotients: Quotients::new(&matrix),
            matrix,
            is_supplied: forward.linear_solver.supplies_entries(),
            supplies: [options.supplied_rhs, options.supplied_parameters],
            system: Borrowed(&mut self.system as &mut dyn Ode),
            line: line.clone(),
            slope: vec![0.0; n],
        };
        let functional =
            Along { functional: Borrowed(&mut self.functional as &mut dyn Functional), line };
        let mut adjoint = Adjoint::new(system, functional, t0, &start, &doubled, &back)?;
        let mut gradient = adjoint.gradient(t)?;
        gradient.initial_state.truncate(n);
        Ok(gradient)
    }
}

/// Tolerances of y and of s, whose sizes are those of y times `scale`.
fn doubled_tolerances(Tolerances { rtol, atol }: &Tolerances, n: usize, scale: f64) -> Tolerances {
    let mut all = scaled(atol, n, 1.0);
    all.extend(scaled(atol, n, scale));
    Tolerances::new(*rtol, all)
}

fn scaled(atol: &AbsoluteTolerance, n: usize, scale: f64) -> Vec<f64> {
    match atol {
        AbsoluteTolerance::Scalar(atol) => vec![atol * scale; n],
        AbsoluteTolerance::Vector(atol) => atol.iter().map(|atol| atol * scale).collect(),
    }
}

/// The options of the run forward for y and s.
fn doubled_options(
    forward: &CvodeOptions,
    n: usize,
    scale: f64,
) -> Result<CvodeOptions, InputError> {
    if forward.weights.is_some() {
        let help = "the product of a Hessian has other unknowns, too: leave them out";
        return Err(InputError::new("error_weights", "given", help));
    }
    let klu = |pattern: &Pattern| {
        let columns = (0..n).flat_map(|j| pattern.column(j).iter().map(move |&i| (i as usize, j)));
        let blocks = columns.flat_map(|(i, j)| [(i, j), (n + i, j), (n + i, n + j)]);
        let pattern = Pattern::from_entries(2 * n, blocks)?;
        Ok::<_, InputError>(LinearSolver::Klu { pattern, jacobian: Jacobian::DifferenceQuotients })
    };
    let mut doubled = forward.clone();
    doubled.linear_solver = match &forward.linear_solver {
        LinearSolver::Dense(_) => LinearSolver::Dense(Jacobian::DifferenceQuotients),
        LinearSolver::Band { lower, upper, .. } => klu(&Pattern::band(n, *lower, *upper)?)?,
        LinearSolver::Klu { pattern, .. } => klu(pattern)?,
        other => {
            let help = "the product of a Hessian needs entries of the Jacobian: choose a dense, a band or a sparse one";
            return Err(InputError::new("linear solver", format!("{other:?}"), help));
        }
    };
    doubled.tolerances = doubled_tolerances(&forward.tolerances, n, scale);
    if !doubled.signs.is_empty() {
        doubled.signs.resize(2 * n, Sign::Free);
    }
    Ok(doubled)
}

/// The line (y + e s, p + e v).
#[derive(Clone)]
struct Line {
    v: Vec<f64>,
    p: Vec<f64>,
    tolerances: Tolerances,
    /// The largest part of a parameter by which v changes it.
    scale: f64,
}

impl Line {
    /// Half the distance of the two points for a difference, `relative` to the sizes of y and p.
    fn reach(&self, relative: f64, y: &[f64], s: &[f64]) -> f64 {
        relative * self.tolerances.reach(y, s, 1.0 / self.scale)
    }

    /// Writes y + e s.
    fn move_state(e: f64, y: &[f64], s: &[f64], out: &mut [f64]) {
        out.iter_mut().zip(y.iter().zip(s)).for_each(|(out, (y, s))| *out = y + e * s);
    }

    /// p + e v
    fn parameters(&self, p: &[f64], e: f64) -> Vec<f64> {
        p.iter().zip(&self.v).map(|(p, v)| p + e * v).collect()
    }
}

/// y' = f(t, y, p) with s' = (df/dy) s + (df/dp) v in addition, and what the adjoint of both needs.
struct Doubled<'a> {
    system: Borrowed<'a, dyn Ode + 'a>,
    line: Line,
    matrix: StoredMatrix,
    quotients: Quotients,
    /// Whether the system supplies the entries of df/dy, and `adjoint_rhs` and `adjoint_parameters`.
    is_supplied: bool,
    supplies: [bool; 2],
    slope: Vec<f64>,
}

impl Doubled<'_> {
    /// Calls `evaluate` with these parameters; those of before are restored, whatever happens.
    fn with<T>(
        &mut self,
        p: &[f64],
        evaluate: impl FnOnce(&mut Self) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let before = self.system.parameters().to_vec();
        self.system.set_parameters(p);
        let outcome = catch_unwind(AssertUnwindSafe(|| evaluate(self)));
        self.system.set_parameters(&before);
        outcome.unwrap_or_else(|panic| resume_unwind(panic))
    }

    /// Adds the derivative of `evaluate(y, out)` along the line to `out`.
    fn add_derivative(
        &mut self,
        relative: f64,
        (y, s): (&[f64], &[f64]),
        out: &mut [f64],
        mut evaluate: impl FnMut(&mut Self, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let e = self.line.reach(relative, y, s);
        let (mut at, mut value) = (y.to_vec(), vec![0.0; out.len()]);
        for e in [e, -e] {
            Line::move_state(e, y, s, &mut at);
            let p = self.line.parameters(&self.line.p, e);
            self.with(&p, |doubled| evaluate(doubled, &at, &mut value))?;
            out.iter_mut().zip(&value).for_each(|(out, value)| *out += value / (2.0 * e));
        }
        Ok(())
    }

    /// Writes (df/dy)^T lambda.
    fn by_state(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplies[0] {
            return call::adjoint_rhs(&mut self.system, t, y, lambda, out);
        }
        let Self { system, matrix, quotients, is_supplied, slope, line, .. } = self;
        if *is_supplied {
            call::rhs(system, t, y, slope)?;
            let entries: Entries<'_> = matrix.entries();
            entries.jacobian(system, t, y, slope)?;
        } else {
            let size = |j: usize| step() * line.tolerances.size_of(j, y[j]);
            quotients.write(matrix, y, size, |y, f| call::rhs(system, t, y, f))?;
        }
        out.fill(0.0);
        matrix.add_transposed_times(1.0, lambda, out);
        Ok(())
    }

    /// Writes (df/dp)^T lambda.
    fn by_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.supplies[1] {
            return call::adjoint_parameters(&mut self.system, t, y, lambda, out);
        }
        let p = self.system.parameters().to_vec();
        for (j, out) in out.iter_mut().enumerate() {
            let mut products = [0.0; 2];
            let h = step() * size_or_one(p[j]);
            for (product, h) in products.iter_mut().zip([h, -h]) {
                let mut trial = p.clone();
                trial[j] += h;
                *product = self.with(&trial, |doubled| {
                    let Self { system, slope, .. } = doubled;
                    call::rhs(system, t, y, slope)?;
                    Ok(slope.iter().zip(lambda).map(|(f, lambda)| f * lambda).sum())
                })?;
            }
            *out = (products[0] - products[1]) / (2.0 * h);
        }
        Ok(())
    }
}

impl Ode for Doubled<'_> {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let (y, s) = y.split_at(y.len() / 2);
        let (f, along) = ydot.split_at_mut(y.len());
        call::rhs(&mut self.system, t, y, f)?;
        self.add_derivative(f64::EPSILON.cbrt(), (y, s), along, |doubled, y, out| {
            call::rhs(&mut doubled.system, t, y, out)
        })
    }

    fn adjoint_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let (y, s) = y.split_at(y.len() / 2);
        let (mu, lambda) = lambda.split_at(y.len());
        let (by_y, by_s) = out.split_at_mut(y.len());
        self.by_state(t, y, lambda, by_s)?;
        self.by_state(t, y, mu, by_y)?;
        self.add_derivative(step(), (y, s), by_y, |doubled, y, out| {
            doubled.by_state(t, y, lambda, out)
        })
    }

    fn adjoint_parameters(
        &mut self,
        t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let (y, s) = y.split_at(y.len() / 2);
        let (mu, lambda) = lambda.split_at(y.len());
        self.by_parameters(t, y, mu, out)?;
        self.add_derivative(step(), (y, s), out, |doubled, y, out| {
            doubled.by_parameters(t, y, lambda, out)
        })
    }

    fn parameters(&self) -> &[f64] {
        self.system.parameters()
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.system.set_parameters(values);
    }
}

/// The derivative of a functional along the line.
struct Along<'a> {
    functional: Borrowed<'a, dyn Functional + 'a>,
    line: Line,
}

impl Along<'_> {
    /// The derivative of `value`, and its slopes by y and s, and by p.
    fn part(
        &mut self,
        mut value: impl FnMut(&mut Self, &[f64], &[f64], Option<Slopes<'_>>) -> Result<f64, Failure>,
        (y, base): (&[f64], &[f64]),
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let (y, s) = y.split_at(y.len() / 2);
        let e = self.line.reach(f64::EPSILON.cbrt(), y, s);
        let mut at = y.to_vec();
        let (mut along, mut slopes) = (0.0, slopes);
        let count = self.line.p.len();
        for e in [e, -e] {
            Line::move_state(e, y, s, &mut at);
            let p = self.line.parameters(base, e);
            let (mut by_y, mut by_p) = (vec![0.0; y.len()], vec![0.0; count]);
            let part = Slopes { y: &mut by_y, p: &mut by_p };
            along += value(self, &at, &p, slopes.is_some().then_some(part))? / (2.0 * e);
            if let Some(slopes) = &mut slopes {
                slopes.y.iter_mut().zip(&by_y).for_each(|(out, slope)| *out += slope / (2.0 * e));
                slopes.p.iter_mut().zip(&by_p).for_each(|(out, slope)| *out += slope / (2.0 * e));
            }
        }
        if let Some(slopes) = &mut slopes {
            let mut by_p = vec![0.0; count];
            let part = Slopes { y: &mut slopes.y[y.len()..], p: &mut by_p };
            value(self, y, base, Some(part))?;
        }
        Ok(along)
    }
}

impl Functional for Along<'_> {
    fn running(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.part(|along, y, p, slopes| along.functional.running(t, y, p, slopes), (y, p), slopes)
    }

    fn terminal(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        self.part(|along, y, p, slopes| along.functional.terminal(t, y, p, slopes), (y, p), slopes)
    }
}
