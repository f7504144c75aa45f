//! Sparsity patterns that are found by evaluating the equations.
//!
//! A pattern is given, or found on request by propagating NaN or by sampling; it is never guessed silently.

use super::{groups::columns_by_groups, pattern::Pattern};
use crate::base::input::InputError;
use crate::integrators::{
    common::{check_count, check_finite, check_length},
    ode::{Dae, Failure, Ode, call},
};

/// Search for the nonzeros of a Jacobian by evaluation of the equations. Both methods detect only the
/// branches that are active in these evaluations: where the equations switch, give points on both sides, or
/// write the pattern down.
impl Pattern {
    /// The pattern of df/dy: component i of f depends on y_j if it becomes NaN when y_j is NaN.
    ///
    /// It takes n + 17 evaluations at most, some hundred where most unknowns with neighbouring numbers share few equations (a grid row by
    /// row, say), at any y where f has values: terms that are zero there count, too.
    /// Operations that do not propagate NaN hide their dependencies, and these entries are missing:
    /// `f64::max`, `f64::min`, `clamp` on the bounds, comparisons (`if y[0] > 1.0`), conversions to integers.
    /// [`ode_by_sampling`](Self::ode_by_sampling) is not affected by them.
    ///
    /// # Errors
    /// If f fails, at `y` or with a NaN, or has a component that is not finite at `y`, which is named.
    pub fn ode_by_nan<S>(system: &mut S, t: f64, y: &[f64]) -> Result<Self, InputError>
    where
        S: Ode + ?Sized,
    {
        Search::new(y, &[], |y, _, f| call::rhs(system, t, y, f))?.by_nan()
    }

    /// As [`ode_by_nan`](Self::ode_by_nan), the pattern of dF/dy + cj dF/dy': y_j and y'_j are NaN together.
    ///
    /// # Errors
    /// As `ode_by_nan`.
    pub fn dae_by_nan<S>(system: &mut S, t: f64, y: &[f64], yp: &[f64]) -> Result<Self, InputError>
    where
        S: Dae + ?Sized,
    {
        check_length("length of yp", yp.len(), y.len())?;
        Search::new(y, yp, |y, yp, f| call::residual(system, t, y, yp, f))?.by_nan()
    }

    /// The pattern of df/dy: component i of f depends on y_j if it changes with y_j alone, at one of `points`
    /// random points, the same ones in each run.
    ///
    /// It takes as many evaluations as [`ode_by_nan`](Self::ode_by_nan) for each point. Component k of the points and of the changed values lies
    /// within `spread[k]` of y_k. Entries are missing if they change f by less than its rounding, or only in
    /// branches that no point reaches.
    ///
    /// # Errors
    /// If f fails at a point or has a component there that is not finite, which is named; if `spread`
    /// has not n positive numbers; if `points` is 0.
    pub fn ode_by_sampling<S>(
        system: &mut S,
        t: f64,
        y: &[f64],
        spread: &[f64],
        points: u32,
    ) -> Result<Self, InputError>
    where
        S: Ode + ?Sized,
    {
        Search::new(y, &[], |y, _, f| call::rhs(system, t, y, f))?.by_sampling(spread, &[], points)
    }

    /// As [`ode_by_sampling`](Self::ode_by_sampling), the pattern of dF/dy + cj dF/dy': y_j and y'_j change
    /// together, y'_j within `yp_spread[j]`.
    ///
    /// # Errors
    /// As `ode_by_sampling`.
    pub fn dae_by_sampling<S>(
        system: &mut S,
        t: f64,
        (y, yp): (&[f64], &[f64]),
        (spread, yp_spread): (&[f64], &[f64]),
        points: u32,
    ) -> Result<Self, InputError>
    where
        S: Dae + ?Sized,
    {
        check_length("length of yp", yp.len(), y.len())?;
        Search::new(y, yp, |y, yp, f| call::residual(system, t, y, yp, f))?
            .by_sampling(spread, yp_spread, points)
    }
}

/// A function of y and y' (empty for an ODE) around a point.
struct Search<'a, F> {
    y: &'a [f64],
    yp: &'a [f64],
    evaluate: F,
}

impl<'a, F> Search<'a, F>
where
    F: FnMut(&[f64], &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn new(y: &'a [f64], yp: &'a [f64], evaluate: F) -> Result<Self, InputError> {
        check_finite("y", y)?;
        check_finite("yp", yp)?;
        Ok(Self { y, yp, evaluate })
    }

    fn by_nan(mut self) -> Result<Pattern, InputError> {
        let n = self.y.len();
        let (mut y, mut yp) = (self.y.to_vec(), self.yp.to_vec());
        let mut f = vec![0.0; n];
        self.finite_value(&y, &yp, &mut f, "choose a point where the equations have values")?;
        let entries = columns_by_groups(n, |columns| {
            copy(columns, &vec![f64::NAN; n], &mut y);
            copy(columns, &vec![f64::NAN; self.yp.len()], &mut yp);
            (self.evaluate)(&y, &yp, &mut f).map_err(|failure| {
                let help = "use sampling for equations that refuse NaN";
                let others = if columns.len() > 1 { " and others" } else { "" };
                let input = format!("equations with NaN for unknown {}{others}", columns[0]);
                InputError::new(input, failure.into_error(), help)
            })?;
            copy(columns, self.y, &mut y);
            copy(columns, self.yp, &mut yp);
            Ok((0..n).filter(|&i| f[i].is_nan()).collect())
        })?;
        Pattern::from_entries(n, entries)
    }

    fn by_sampling(
        mut self,
        spread: &[f64],
        yp_spread: &[f64],
        points: u32,
    ) -> Result<Pattern, InputError> {
        let n = self.y.len();
        check_spread("spread", spread, n)?;
        check_spread("yp_spread", yp_spread, self.yp.len())?;
        check_count("points", points)?;
        let mut random = Random(0);
        let mut near = |centre: &[f64], spread: &[f64]| -> Vec<f64> {
            centre.iter().zip(spread).map(|(y, spread)| y + spread * random.next()).collect()
        };
        let mut entries = Vec::new();
        for _ in 0..points {
            let from = [near(self.y, spread), near(self.yp, yp_spread)];
            let to = [near(self.y, spread), near(self.yp, yp_spread)];
            entries.extend(self.changes(
                &from,
                &to,
                "choose a smaller spread, or another point",
            )?);
        }
        Pattern::from_entries(n, entries)
    }

    /// The entries of the equations that change where unknowns go from one point to another one.
    fn changes(
        &mut self,
        from: &[Vec<f64>; 2],
        to: &[Vec<f64>; 2],
        help: &str,
    ) -> Result<Vec<(usize, usize)>, InputError> {
        let n = self.y.len();
        let [mut before, mut after] = [vec![0.0; n], vec![0.0; n]];
        let [mut y, mut yp] = from.clone();
        self.finite_value(&y, &yp, &mut before, help)?;
        columns_by_groups(n, |columns| {
            copy(columns, &to[0], &mut y);
            copy(columns, &to[1], &mut yp);
            self.finite_value(&y, &yp, &mut after, help)?;
            copy(columns, &from[0], &mut y);
            copy(columns, &from[1], &mut yp);
            Ok((0..n).filter(|&i| before[i] != after[i]).collect())
        })
    }

    /// Evaluates the equations, each component of which has to be finite.
    fn finite_value(
        &mut self,
        y: &[f64],
        yp: &[f64],
        f: &mut [f64],
        help: &str,
    ) -> Result<(), InputError> {
        (self.evaluate)(y, yp, f).map_err(|failure| {
            InputError::new("equations at the point", failure.into_error(), help)
        })?;
        match f.iter().position(|f| !f.is_finite()) {
            Some(i) => {
                let input = format!("component {i} of the equations at the point");
                Err(InputError::new(input, f[i], help))
            }
            None => Ok(()),
        }
    }
}

/// Copies the unknowns of these columns; of an ODE there are no slopes.
fn copy(columns: &[usize], from: &[f64], to: &mut [f64]) {
    if !to.is_empty() {
        columns.iter().for_each(|&j| to[j] = from[j]);
    }
}

fn check_spread(input: &str, spread: &[f64], n: usize) -> Result<(), InputError> {
    check_length(&format!("length of {input}"), spread.len(), n)?;
    match spread.iter().find(|s| !(**s > 0.0 && s.is_finite())) {
        Some(s) => Err(InputError::new(input, s, "each is positive and finite")),
        None => Ok(()),
    }
}

/// Random numbers, the same ones in each run (SplitMix64: Steele, Lea and Flood, OOPSLA 2014).
struct Random(u64);

impl Random {
    /// A number between -1 and 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
