//! Derivatives of equations of both kinds, along directions of their arguments.

use super::{
    dual::Dual,
    system::Automatic,
    workspace::{Evaluate, LANES, Point},
};
use crate::integrators::{
    ode::{Entries, Failure},
    sundials::Shape,
};

impl<E> Automatic<E> {
    /// Differentiates the equations by all unknowns times `seed[0]` and by their derivatives times `seed[1]`, and calls
    /// `put` with the shape, each column and its lane in the equations.
    fn each_column(
        &mut self,
        at: Point<'_>,
        seed: [f64; 2],
        evaluate: Evaluate<E, LANES>,
        mut put: impl FnMut(&Shape, usize, usize, &[Dual<LANES>]),
    ) -> Result<(), Failure> {
        let Self { equations, parameters, shape, colouring, many, .. } = self;
        let colouring = colouring.get_or_insert_with(|| shape.colouring(at.1.len()));
        many.start(at, parameters);
        for first in (0..colouring.count()).step_by(LANES) {
            let lanes = LANES.min(colouring.count() - first);
            let columns =
                |lane: usize| colouring.columns(first + lane).iter().map(move |&j| (j, lane));
            let directions = || (0..lanes).flat_map(columns);
            directions().for_each(|(j, lane)| many.seed(j, lane, seed));
            many.evaluate(equations, at.0, evaluate)?;
            directions().for_each(|(j, lane)| put(shape, j, lane, &many.f));
            directions().for_each(|(j, lane)| many.seed(j, lane, [0.0; 2]));
        }
        Ok(())
    }

    /// Writes the matrix of the equations by their unknowns and `cj` times that by their derivatives.
    pub(super) fn fill(
        &mut self,
        at: Point<'_>,
        cj: f64,
        evaluate: Evaluate<E, LANES>,
        mut entries: Entries<'_>,
    ) -> Result<(), Failure> {
        let n = at.1.len();
        self.each_column(at, [1.0, cj], evaluate, |shape, j, lane, f| match (&mut entries, shape) {
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

    /// Adds the product of `lambda` with the matrix by the unknowns times `seed[0]` and by their derivatives times `seed[1]`.
    pub(super) fn add_transposed(
        &mut self,
        at: Point<'_>,
        seed: [f64; 2],
        evaluate: Evaluate<E, LANES>,
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let n = at.1.len();
        self.each_column(at, seed, evaluate, |shape, j, lane, f| {
            let rows = (0..shape.positions(j, n, shape.stored(n)).len()).map(|k| shape.row(j, k));
            out[j] += rows.map(|i| lambda[i] * f[i].slopes[lane]).sum::<f64>();
        })
    }

    /// Writes the derivative along a direction of the unknowns, `factor` times one of their derivatives, and one parameter,
    /// if any.
    pub(super) fn along(
        &mut self,
        at: Point<'_>,
        (v, factor, vp): (&[f64], f64, &[f64]),
        parameter: Option<usize>,
        evaluate: Evaluate<E, 1>,
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, parameters, one, .. } = self;
        one.start(at, parameters);
        one.y.iter_mut().zip(v).for_each(|(y, v)| y.slopes = [*v]);
        one.yp.iter_mut().zip(vp).for_each(|(yp, vp)| yp.slopes = [factor * vp]);
        if let Some(parameter) = parameter {
            one.p[parameter].slopes = [1.0];
        }
        one.evaluate(equations, at.0, evaluate)?;
        out.iter_mut().zip(&one.f).for_each(|(out, f)| *out = f.slopes[0]);
        Ok(())
    }

    /// Writes the product of `lambda` with the derivatives by the parameters.
    pub(super) fn by_parameters(
        &mut self,
        at: Point<'_>,
        evaluate: Evaluate<E, LANES>,
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let Self { equations, parameters, many, .. } = self;
        for (chunk, out) in out.chunks_mut(LANES).enumerate() {
            many.start(at, parameters);
            for lane in 0..out.len() {
                many.p[chunk * LANES + lane].slopes[lane] = 1.0;
            }
            many.evaluate(equations, at.0, evaluate)?;
            for (lane, out) in out.iter_mut().enumerate() {
                *out = many.f.iter().zip(lambda).map(|(f, lambda)| f.slopes[lane] * lambda).sum();
            }
        }
        Ok(())
    }
}
