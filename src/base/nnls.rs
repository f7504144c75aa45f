//! Least squares with unknowns that are not negative, by active sets.
//!
//! Unknowns are freed one by one, that with the steepest descent first, and bound to 0 again where the least squares of
//! the free ones make them negative (NNLS of C. L. Lawson, R. J. Hanson, *Solving Least Squares Problems*, 1974, chapter 23).
//! So a search that ends early, at a residual that is small enough, leaves most unknowns 0.

use faer::Mat;
use rayon::prelude::*;

use crate::base::vector::{dot, norm};

/// A gradient relative to |g| |b| that is round-off.
const FLAT: f64 = 1e-12;

/// Square of the sine of the angle between a column and the span of others, below which it is one of them.
const DEPENDENT: f64 = 1e-12;

/// Unknowns w >= 0 with |G w - b| <= `tolerance` |b|, few of which are not 0; or those with the least residual, where that
/// is larger.
pub(crate) fn nonnegative(g: &Mat<f64>, b: &[f64], tolerance: f64) -> Vec<f64> {
    let (mut free, goal) = (Free::new(g, b), tolerance * norm(b));
    let mut weights = vec![0.0; g.ncols()];
    let mut residual = b.to_vec();
    // sets of free unknowns never come back but for round-off
    for _ in 0..3 * g.ncols() {
        if norm(&residual) <= goal || !free.descend(&mut weights, &residual) {
            break;
        }
        free.leave(&weights, &mut residual);
    }
    weights
}

/// The unknowns that are free, with the Cholesky factor of their normal equations. Columns are scaled to length 1 in these.
struct Free<'a> {
    g: &'a Mat<f64>,
    b: &'a [f64],
    /// Lengths of all columns.
    lengths: Vec<f64>,
    numbers: Vec<usize>,
    /// Rows up to the diagonal of the matrix, and of its factor.
    gram: Vec<Vec<f64>>,
    factor: Vec<Vec<f64>>,
}

impl<'a> Free<'a> {
    fn new(g: &'a Mat<f64>, b: &'a [f64]) -> Self {
        let lengths = (0..g.ncols()).map(|j| norm(g.col_as_slice(j))).collect();
        Self { g, b, lengths, numbers: Vec::new(), gram: Vec::new(), factor: Vec::new() }
    }

    /// Frees one unknown, and binds those that get negative; whether there was one along which the residual falls.
    fn descend(&mut self, weights: &mut [f64], residual: &[f64]) -> bool {
        let size = norm(self.b);
        let slope = |j: usize| dot(self.g.col_as_slice(j), residual);
        let mut slopes: Vec<f64> = (0..weights.len()).into_par_iter().map(slope).collect();
        self.numbers.iter().for_each(|&number| slopes[number] = 0.0);
        let mut best = loop {
            let steep = |j: &usize| slopes[*j] > FLAT * self.lengths[*j] * size;
            let steepest =
                (0..slopes.len()).filter(steep).max_by(|i, j| slopes[*i].total_cmp(&slopes[*j]));
            let Some(steepest) = steepest else { return false };
            slopes[steepest] = 0.0;
            if !self.push(steepest) {
                continue;
            }
            let best = self.least();
            if best.last().is_some_and(|last| *last > 0.0) {
                break best;
            }
            self.remove(self.numbers.len() - 1);
        };
        loop {
            // as far towards it as none gets negative
            let part = |k: usize| {
                let weight = weights[self.numbers[k]];
                if weight > 0.0 { weight / (weight - best[k]) } else { 0.0 }
            };
            let negative = (0..best.len()).filter(|k| best[*k] <= 0.0).map(|k| (k, part(k)));
            let first = negative.min_by(|(_, a), (_, b)| a.total_cmp(b));
            let Some((first, part)) = first else { break };
            for (&number, best) in self.numbers.iter().zip(&best) {
                weights[number] += part * (best - weights[number]);
            }
            weights[self.numbers[first]] = 0.0;
            for k in (0..best.len()).rev().filter(|k| best[*k] <= 0.0) {
                if weights[self.numbers[k]] <= 0.0 {
                    weights[self.numbers[k]] = 0.0;
                    self.remove(k);
                }
            }
            best = self.least();
        }
        self.numbers.iter().zip(&best).for_each(|(&number, best)| weights[number] = *best);
        true
    }

    /// Frees an unknown, unless its column depends on those of the free ones.
    fn push(&mut self, number: usize) -> bool {
        let column = self.g.col_as_slice(number);
        let of = |other: &usize| {
            dot(self.g.col_as_slice(*other), column) / (self.lengths[*other] * self.lengths[number])
        };
        let mut row: Vec<f64> = self.numbers.par_iter().map(of).collect();
        row.push(1.0);
        let pivot = self.factorize(&row);
        if pivot <= DEPENDENT {
            self.factor.pop();
            return false;
        }
        self.gram.push(row);
        self.numbers.push(number);
        true
    }

    /// Adds a row to the factor; returns the square of its pivot.
    fn factorize(&mut self, row: &[f64]) -> f64 {
        let (mut of_row, diagonal) = (row.to_vec(), row.len() - 1);
        for k in 0..diagonal {
            let (before, at) = of_row.split_at_mut(k);
            at[0] = (at[0] - dot(before, &self.factor[k][..k])) / self.factor[k][k];
        }
        let pivot = of_row[diagonal] - dot(&of_row[..diagonal], &of_row[..diagonal]);
        of_row[diagonal] = pivot.max(DEPENDENT).sqrt();
        self.factor.push(of_row);
        pivot
    }

    /// Binds the free unknown in place `k`.
    fn remove(&mut self, k: usize) {
        self.numbers.remove(k);
        self.gram.remove(k);
        self.gram[k..].iter_mut().for_each(|row| _ = row.remove(k));
        self.factor.truncate(k);
        for row in k..self.gram.len() {
            let of_row = std::mem::take(&mut self.gram[row]);
            self.factorize(&of_row);
            self.gram[row] = of_row;
        }
    }

    /// The free unknowns with the least residual, whatever their signs; with one step of iterative refinement by the
    /// gradient.
    fn least(&self) -> Vec<f64> {
        let mut best = self.solve(self.b);
        let mut residual = self.b.to_vec();
        self.subtract(&best, &mut residual);
        best.iter_mut().zip(self.solve(&residual)).for_each(|(best, change)| *best += change);
        best
    }

    /// (G^T G)^-1 G^T x
    fn solve(&self, x: &[f64]) -> Vec<f64> {
        let on = |number: &usize| dot(self.g.col_as_slice(*number), x) / self.lengths[*number];
        let mut y: Vec<f64> = self.numbers.par_iter().map(on).collect();
        for k in 0..y.len() {
            y[k] = (y[k] - dot(&y[..k], &self.factor[k][..k])) / self.factor[k][k];
        }
        for k in (0..y.len()).rev() {
            y[k] /= self.factor[k][k];
            let (before, at) = y.split_at_mut(k);
            before.iter_mut().zip(&self.factor[k]).for_each(|(y, l)| *y -= l * at[0]);
        }
        y.iter_mut().zip(&self.numbers).for_each(|(y, number)| *y /= self.lengths[*number]);
        y
    }

    /// Subtracts G w from `x`.
    fn subtract(&self, w: &[f64], x: &mut [f64]) {
        for (number, w) in self.numbers.iter().zip(w) {
            x.iter_mut().zip(self.g.col_as_slice(*number)).for_each(|(x, g)| *x -= w * g);
        }
    }

    /// Writes the residual b - G w.
    fn leave(&self, weights: &[f64], residual: &mut [f64]) {
        residual.copy_from_slice(self.b);
        let own: Vec<f64> = self.numbers.iter().map(|&number| weights[number]).collect();
        self.subtract(&own, residual);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::vector::{largest, noise};

    const ROWS: usize = 40;

    fn matrix(columns: usize) -> Mat<f64> {
        let numbers = noise(ROWS * columns, 3);
        Mat::from_fn(ROWS, columns, |i, j| numbers[ROWS * j + i])
    }

    fn residual(g: &Mat<f64>, w: &[f64], b: &[f64]) -> Vec<f64> {
        (0..b.len()).map(|i| b[i] - (0..w.len()).map(|j| g[(i, j)] * w[j]).sum::<f64>()).collect()
    }

    /// KKT conditions, which hold at the minimum alone: zero gradient for free variables, non-negative gradient for bound
    /// ones. The right-hand side is not in the cone of the columns.
    #[test]
    fn no_way_leads_downhill_at_the_minimum() {
        for columns in [1, 10, 60] {
            let g = matrix(columns);
            let b = noise(ROWS, 11);
            let w = nonnegative(&g, &b, 0.0);
            let left = residual(&g, &w, &b);
            let mut bound = 0;
            for (j, &weight) in w.iter().enumerate() {
                let slope = dot(g.col_as_slice(j), &left);
                bound += usize::from(weight == 0.0);
                assert!(weight >= 0.0);
                // round-off of sums of 40 numbers
                let most = if weight > 0.0 { slope.abs() } else { slope };
                assert!(most < 1e-14, "{columns} columns, {j}: {slope:e} at {weight}");
            }
            assert!(columns == 1 || 0 < bound && bound < columns, "{bound} of {columns} are 0");
        }
    }

    /// Against the weights that a right-hand side was made with: there is one such solution.
    #[test]
    fn weights_are_found_again() {
        let g = matrix(30);
        let expected: Vec<f64> =
            (0..30).map(|j| if j % 4 == 0 { 1.0 + j as f64 } else { 0.0 }).collect();
        let b: Vec<f64> = residual(&g, &expected, &[0.0; ROWS]).iter().map(|x| -x).collect();
        let w = nonnegative(&g, &b, 0.0);
        let off: Vec<f64> = w.iter().zip(&expected).map(|(w, expected)| w - expected).collect();
        assert!(largest(&off) < 3e-14, "{:e}", largest(&off));
    }

    /// A search that ends early frees fewer variables, and its residual is within the requested tolerance.
    #[test]
    fn it_ends_where_the_residual_is_small_enough() {
        let numbers = matrix(400);
        let g = Mat::from_fn(ROWS, 400, |i, j| 1.0 + numbers[(i, j)]);
        let b: Vec<f64> = (0..ROWS).map(|i| (0..400).map(|j| g[(i, j)]).sum()).collect();
        let counts = [1e-1, 1e-2, 1e-3].map(|tolerance| {
            let w = nonnegative(&g, &b, tolerance);
            let off = norm(&residual(&g, &w, &b)) / norm(&b);
            assert!(off <= tolerance * (1.0 + 1e-9), "{off} for {tolerance}");
            w.iter().filter(|w| **w > 0.0).count()
        });
        assert!(0 < counts[0] && counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
        assert!(counts[2] <= ROWS, "{counts:?}");
    }

    /// Columns that are multiples of one, or 0: one of them is enough, and what they lack is left.
    #[test]
    fn columns_that_depend_on_others() {
        let [own, other] = [noise(ROWS, 5), noise(ROWS, 6)];
        let times = |j: usize| if j == 5 { 0.0 } else { 1.0 + 0.3 * j as f64 };
        let g = Mat::from_fn(ROWS, 60, |i, j| own[i] * times(j));
        let b: Vec<f64> = own.iter().zip(&other).map(|(own, other)| own + other).collect();
        let w = nonnegative(&g, &b, 0.0);
        let along = dot(&own, &residual(&g, &w, &b)) / dot(&own, &own);
        assert!(along.abs() < 1e-15, "{along:e}");
        assert_eq!(w.iter().filter(|w| **w > 0.0).count(), 1, "{w:?}");
    }
}
