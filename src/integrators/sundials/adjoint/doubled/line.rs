//! Lines in states and parameters, and derivatives along them.

use crate::base::vector::size_or_one;
use crate::integrators::{
    common::{Error, Tolerances, check_finite},
    ode::Failure,
    sundials::sensitivity::{Access, move_along},
};

/// Relative step of differences of values that are exact to rounding: truncation, its fourth power, and rounding are alike.
pub(super) const STEP: f64 = 7e-4;
/// The same for first derivatives by differences, and for differences of them.
pub(super) const SECOND_STEP: f64 = 2.5e-3;
/// Weights and distances, in steps, of a central difference of fourth order.
pub(super) const STENCIL: [(f64, f64); 4] =
    [(8.0 / 12.0, 1.0), (-8.0 / 12.0, -1.0), (-1.0 / 12.0, 2.0), (1.0 / 12.0, -2.0)];

/// The line (y + e s, y' + e s', p + e v) of a direction v of the parameters.
#[derive(Clone)]
pub(in crate::integrators::sundials::adjoint) struct Line {
    pub(super) v: Vec<f64>,
    pub(super) tolerances: Tolerances,
    /// The largest part of a parameter by which v changes it.
    pub(super) scale: f64,
}

impl Line {
    /// For these parameters, and the tolerances of y.
    pub(in crate::integrators::sundials::adjoint) fn new(
        direction: &[f64],
        p: &[f64],
        tolerances: &Tolerances,
    ) -> Result<Self, Error> {
        if direction.len() != p.len() {
            let help = format!("there are {} parameters", p.len());
            return Err(Error::input("length of direction", direction.len(), help));
        }
        check_finite("direction", direction)?;
        let parts = direction.iter().zip(p).map(|(v, p)| v.abs() / size_or_one(*p));
        let scale = parts.fold(0.0, f64::max);
        if scale == 0.0 {
            return Err(Error::input("direction", "zero", "it has a length"));
        }
        Ok(Self { v: direction.to_vec(), tolerances: tolerances.clone(), scale })
    }

    /// The step of a difference, `relative` to the sizes of y and p.
    pub(super) fn reach(&self, relative: f64, y: &[f64], s: &[f64]) -> f64 {
        relative * self.tolerances.reach(y, s, 1.0 / self.scale)
    }
}

/// A point of the line, (y, y'), and its direction, (s, s'); those of an ODE have no y' and s'.
#[derive(Clone, Copy)]
pub(super) struct Point<'a> {
    pub(super) y: &'a [f64],
    pub(super) s: &'a [f64],
    pub(super) yp: &'a [f64],
    pub(super) sp: &'a [f64],
}

impl<'a> Point<'a> {
    /// From (y, s) and (y', s').
    pub(super) fn of(y: &'a [f64], yp: &'a [f64]) -> Self {
        let ((y, s), (yp, sp)) = (y.split_at(y.len() / 2), yp.split_at(yp.len() / 2));
        Self { y, s, yp, sp }
    }
}

/// Derivatives along a line.
pub(super) struct Derivative {
    line: Line,
    y: Vec<f64>,
    yp: Vec<f64>,
    /// Parameters on the line, and those of before.
    moved: Vec<f64>,
    p: Vec<f64>,
    value: Vec<f64>,
}

impl Derivative {
    /// For functions of up to `longest` numbers, of `n` unknowns and their `slopes`, of which there are `n` or none.
    pub(super) fn new(line: Line, [n, slopes, longest]: [usize; 3]) -> Self {
        let (zeros, count) = (|n: usize| vec![0.0; n], line.v.len());
        let (moved, p) = (zeros(count), zeros(count));
        Self { line, y: zeros(n), yp: zeros(slopes), moved, p, value: zeros(longest) }
    }

    /// Adds the derivative of `evaluate(system, y, y', out)` to `out`.
    pub(super) fn add<S>(
        &mut self,
        system: &mut S,
        access: &Access<S>,
        relative: f64,
        at: Point<'_>,
        out: &mut [f64],
        mut evaluate: impl FnMut(&mut S, [&[f64]; 2], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Self { line, y, yp, moved, p, value } = self;
        let (e, value) = (line.reach(relative, at.y, at.s), &mut value[..out.len()]);
        p.copy_from_slice((access.get)(system));
        for (weight, steps) in STENCIL {
            move_along(y, (at.y, at.s), steps * e);
            move_along(yp, (at.yp, at.sp), steps * e);
            move_along(moved, (p, &line.v), steps * e);
            (access.set)(system, moved);
            access.restoring(system, p, |system| evaluate(system, [y, yp], value))?;
            out.iter_mut().zip(value.iter()).for_each(|(out, value)| *out += weight / e * value);
        }
        Ok(())
    }
}
