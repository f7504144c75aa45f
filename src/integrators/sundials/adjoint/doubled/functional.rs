//! Derivatives of functionals along a line.

use super::line::{Line, STENCIL, STEP};
use crate::integrators::{
    ode::{Borrowed, Failure, Functional, Slopes},
    sundials::sensitivity::move_along,
};

type Lent<'a> = Borrowed<'a, dyn Functional + 'a>;

/// The derivative of a functional along a line, as a functional of y and s.
pub(in crate::integrators::sundials::adjoint) struct Along<'a> {
    functional: Lent<'a>,
    line: Line,
    y: Vec<f64>,
    p: Vec<f64>,
    by_y: Vec<f64>,
    by_p: Vec<f64>,
}

impl<'a> Along<'a> {
    /// For `n` unknowns y.
    pub(in crate::integrators::sundials::adjoint) fn new(
        functional: &'a mut (dyn Functional + 'a),
        line: Line,
        n: usize,
    ) -> Self {
        let (zeros, count) = (|n: usize| vec![0.0; n], line.v.len());
        let (p, by_p) = (zeros(count), zeros(count));
        Self { functional: Borrowed(functional), line, y: zeros(n), p, by_y: zeros(n), by_p }
    }

    /// The derivative of `value`, and its slopes by y and s, and by p.
    fn derivative(
        &mut self,
        mut value: impl FnMut(&mut Lent<'_>, [&[f64]; 2], Option<Slopes<'_>>) -> Result<f64, Failure>,
        [y, p]: [&[f64]; 2],
        mut slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let Self { functional, line, y: moved, p: moved_p, by_y, by_p } = self;
        let (y, s) = y.split_at(y.len() / 2);
        let e = line.reach(STEP, y, s);
        let mut along = 0.0;
        for (weight, steps) in STENCIL {
            move_along(moved, (y, s), steps * e);
            move_along(moved_p, (p, &line.v), steps * e);
            by_y.fill(0.0);
            by_p.fill(0.0);
            let part = slopes.is_some().then_some(Slopes { y: by_y, p: by_p });
            along += weight / e * value(functional, [moved, moved_p], part)?;
            if let Some(slopes) = &mut slopes {
                let by_both = by_y.iter().chain(by_p.iter());
                let to = slopes.y[..y.len()].iter_mut().chain(slopes.p.iter_mut());
                to.zip(by_both).for_each(|(to, slope)| *to += weight / e * slope);
            }
        }
        if let Some(slopes) = slopes {
            by_p.fill(0.0);
            value(functional, [y, p], Some(Slopes { y: &mut slopes.y[y.len()..], p: by_p }))?;
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
        let value = |functional: &mut Lent<'_>, [y, p]: [&[f64]; 2], slopes: Option<Slopes<'_>>| {
            functional.running(t, y, p, slopes)
        };
        self.derivative(value, [y, p], slopes)
    }

    fn terminal(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let value = |functional: &mut Lent<'_>, [y, p]: [&[f64]; 2], slopes: Option<Slopes<'_>>| {
            functional.terminal(t, y, p, slopes)
        };
        self.derivative(value, [y, p], slopes)
    }
}
