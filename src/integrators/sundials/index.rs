//! The index of a DAE: a check that its equations determine all unknowns without differentiation.

use crate::integrators::ode::{Dae, Failure, call};

/// Differentiation index from the derivatives E = dF/dy' and A = dF/dy at one point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Index {
    /// An ODE, or a DAE of index 1.
    AtMostOne,
    /// Higher: the equations without derivatives do not determine this unknown.
    Higher(usize),
    /// None: A + c E is singular for all c, so the equations determine nothing.
    Singular,
}

/// Rows of [E A], to be eliminated; the columns of both are swapped together.
struct Pencil {
    rows: Vec<Vec<f64>>,
    /// Which unknown each column belongs to.
    unknowns: Vec<usize>,
}

/// Finds the index at (t, y, y') by difference quotients, with four evaluations of the residual for each
/// unknown, and elimination: E becomes [I R; 0 0] and A, by the same operations on rows, [A11 A12; A21 A22].
/// The index is at most 1 if A22 - A21 R is regular: A in the equations without derivatives, on the null
/// space of E.
pub(super) fn index<S: Dae>(
    system: &mut S,
    t: f64,
    y: &[f64],
    yp: &[f64],
) -> Result<Index, Failure> {
    let n = y.len();
    let mut pencil = Pencil::new(system, t, y, yp)?;
    if pencil.is_singular() {
        return Ok(Index::Singular);
    }
    // difference quotients are accurate to 1e-8 or so
    let rank = pencil.eliminate(n, 1e-6);
    let (upper, lower) = pencil.rows.split_at_mut(rank);
    let left: Vec<Vec<f64>> = lower
        .iter()
        .map(|row| {
            let scale = largest(&row[n..]).max(f64::MIN_POSITIVE);
            let entry = |k: usize| {
                let coupled = (0..rank).map(|j| row[n + j] * upper[j][k]);
                (row[n + k] - coupled.sum::<f64>()) / scale
            };
            (rank..n).map(entry).collect()
        })
        .collect();
    let mut left = Pencil { rows: left, unknowns: pencil.unknowns[rank..].to_vec() };
    let determined = left.eliminate(n - rank, 1e-6);
    Ok(left.unknowns.get(determined).map_or(Index::AtMostOne, |unknown| Index::Higher(*unknown)))
}

impl Pencil {
    fn new<S: Dae>(system: &mut S, t: f64, y: &[f64], yp: &[f64]) -> Result<Self, Failure> {
        let n = y.len();
        // the size that is assumed for an unknown that is zero
        let usual = match largest(y) {
            0.0 => 1.0,
            most => most.min(1.0),
        };
        let sizes: Vec<f64> =
            y.iter().map(|y| if y.abs() > 1e-6 * usual { y.abs() } else { usual }).collect();
        let rate = largest(yp);
        let mut rows = vec![vec![0.0; 2 * n]; n];
        let (mut y, mut yp) = (y.to_vec(), yp.to_vec());
        let [mut before, mut after] = [vec![0.0; n], vec![0.0; n]];
        for j in 0..n {
            for (half, step) in [(0, 1e-3 * rate.max(sizes[j])), (n, 1e-5 * sizes[j])] {
                for (sign, residual) in [(-1.0, &mut before), (1.0, &mut after)] {
                    let moved = if half == 0 { &mut yp[j] } else { &mut y[j] };
                    let value = *moved;
                    *moved += sign * step;
                    let outcome = call::residual(system, t, &y, &yp, residual);
                    *(if half == 0 { &mut yp[j] } else { &mut y[j] }) = value;
                    outcome?;
                }
                for (row, (before, after)) in rows.iter_mut().zip(before.iter().zip(&after)) {
                    row[half + j] = (after - before) / (2.0 * step) * sizes[j];
                }
            }
        }
        if rows.iter().flatten().any(|entry| !entry.is_finite()) {
            return Err(Failure::Recoverable("the residual is not finite near the start".into()));
        }
        // scales each equation: by its entries of E if it has any, else by those of A
        for row in &mut rows {
            let (e, a) = (largest(&row[..n]), largest(&row[n..]));
            let scale = if e > 0.0 { e } else { a };
            if scale > 0.0 {
                row.iter_mut().for_each(|entry| *entry /= scale);
            }
        }
        Ok(Self { rows, unknowns: (0..n).collect() })
    }

    /// Whether A + c E is singular for a c that gives both weight.
    fn is_singular(&self) -> bool {
        let n = self.rows.len();
        let ratios = self.rows.iter().map(|row| (largest(&row[n..]), largest(&row[..n])));
        let ratios: Vec<f64> =
            ratios.filter(|(a, e)| *a > 0.0 && *e > 0.0).map(|(a, e)| (a / e).ln()).collect();
        let mean = ratios.iter().sum::<f64>() / ratios.len().max(1) as f64;
        // an odd factor: c is unlikely to be an eigenvalue
        let c = 1.234_567 * mean.exp();
        let sum = |row: &Vec<f64>| {
            let sum: Vec<f64> = (0..n).map(|j| row[n + j] + c * row[j]).collect();
            let scale = largest(&sum);
            if scale > 0.0 { sum.iter().map(|entry| entry / scale).collect() } else { sum }
        };
        let rows = self.rows.iter().map(sum).collect();
        let mut matrix = Self { rows, unknowns: self.unknowns.clone() };
        matrix.eliminate(n, 1e-10) < n
    }

    /// Turns the first of the `width` columns into those of the identity, with the largest remaining entry as
    /// pivot, until that is below `tolerance`. Returns their number. Columns `width` apart are swapped
    /// together.
    fn eliminate(&mut self, width: usize, tolerance: f64) -> usize {
        let Self { rows, unknowns } = self;
        for rank in 0..rows.len() {
            let mut pivot = (0.0, rank, rank);
            for (i, row) in rows.iter().enumerate().skip(rank) {
                for (j, entry) in row[..width].iter().enumerate().skip(rank) {
                    if entry.abs() > pivot.0 {
                        pivot = (entry.abs(), i, j);
                    }
                }
            }
            let (size, i, j) = pivot;
            if size <= tolerance {
                return rank;
            }
            rows.swap(rank, i);
            unknowns.swap(rank, j);
            for row in rows.iter_mut() {
                row.chunks_exact_mut(width).for_each(|half| half.swap(rank, j));
            }
            let mut row = std::mem::take(&mut rows[rank]);
            let factor = row[rank];
            row.iter_mut().for_each(|entry| *entry /= factor);
            for other in rows.iter_mut().filter(|other| !other.is_empty()) {
                let factor = other[rank];
                if factor != 0.0 {
                    other.iter_mut().zip(&row).for_each(|(entry, own)| *entry -= factor * own);
                }
            }
            rows[rank] = row;
        }
        rows.len()
    }
}

/// The largest absolute value.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, number| most.max(number.abs()))
}
