//! Incomplete LU factorization without fill, as a preconditioner.
//!
//! It uses the pattern and values of the sparse Jacobian. On a full band it is the LU factorization without
//! pivoting.

use super::pattern::Pattern;

/// ILU(0) of a Newton matrix: factors L and U with entries only where the matrix has entries, and a product
/// that equals it there.
///
/// Y. Saad, Iterative Methods for Sparse Linear Systems, section 10.3, column by column.
pub(super) struct IncompleteLu {
    pattern: Pattern,
    /// Position of each diagonal entry among the values.
    diagonal: Vec<usize>,
    jacobian: Vec<f64>,
    /// Whether all of `jacobian` was evaluated.
    has_jacobian: bool,
    /// L below the diagonal (its own diagonal is 1), and U.
    factors: Vec<f64>,
    /// Position of the entry of each row in the column that is being eliminated, if it has one.
    positions: Vec<Option<usize>>,
}

/// The reason to request a smaller step where there is no pivot in this row.
pub(super) fn no_pivot(row: usize) -> String {
    format!(
        "the incomplete LU factorization, which takes each unknown from the equation of its own row, has no pivot \
         in row {row}"
    )
}

impl IncompleteLu {
    pub(super) fn new(pattern: &Pattern) -> Self {
        let n = pattern.dimension();
        let above = |j: usize| pattern.column(j).partition_point(|&i| (i as usize) < j);
        let zeros = vec![0.0; pattern.entry_count()];
        Self {
            diagonal: (0..n).map(|j| pattern.positions(j).start + above(j)).collect(),
            pattern: pattern.clone(),
            jacobian: zeros.clone(),
            has_jacobian: false,
            factors: zeros,
            positions: vec![None; n],
        }
    }

    pub(super) fn has_jacobian(&self) -> bool {
        self.has_jacobian
    }

    /// Lets `evaluate` fill the values of the Jacobian, which are zero before, and returns its code: 0 for
    /// success.
    pub(super) fn update_jacobian(&mut self, evaluate: impl FnOnce(&mut [f64]) -> i32) -> i32 {
        self.jacobian.fill(0.0);
        let outcome = evaluate(&mut self.jacobian);
        self.has_jacobian = outcome == 0;
        outcome
    }

    /// Factorizes I - gamma J.
    ///
    /// # Errors
    /// The row without a pivot.
    pub(super) fn factorize_shifted(&mut self, gamma: f64) -> Result<(), usize> {
        for (factor, entry) in self.factors.iter_mut().zip(&self.jacobian) {
            *factor = -gamma * entry;
        }
        self.diagonal.iter().for_each(|&place| self.factors[place] += 1.0);
        self.eliminate()
    }

    /// Factorizes J itself, the whole matrix of a DAE.
    ///
    /// # Errors
    /// The row without a pivot.
    pub(super) fn factorize(&mut self) -> Result<(), usize> {
        self.factors.copy_from_slice(&self.jacobian);
        self.eliminate()
    }

    fn eliminate(&mut self) -> Result<(), usize> {
        let Self { pattern, diagonal, factors, positions, .. } = self;
        for (j, &pivot) in diagonal.iter().enumerate() {
            let column = pattern.positions(j);
            let rows = pattern.column(j);
            rows.iter().zip(column.clone()).for_each(|(&i, at)| positions[i as usize] = Some(at));
            for (&k, at) in rows.iter().zip(column.start..pivot) {
                let k = k as usize;
                let upper = factors[at];
                let below = diagonal[k] + 1..pattern.positions(k).end;
                for (&i, from) in pattern.rows(below.clone()).iter().zip(below) {
                    if let Some(to) = positions[i as usize] {
                        factors[to] -= factors[from] * upper;
                    }
                }
            }
            rows.iter().for_each(|&i| positions[i as usize] = None);
            let value = factors[pivot];
            if value == 0.0 || !value.is_finite() {
                return Err(j);
            }
            factors[pivot + 1..column.end].iter_mut().for_each(|factor| *factor /= value);
        }
        Ok(())
    }

    /// Replaces `x` by U^-1 L^-1 x.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let subtract = |x: &mut [f64], positions: std::ops::Range<usize>, solved: f64| {
            for (&i, factor) in
                self.pattern.rows(positions.clone()).iter().zip(&self.factors[positions])
            {
                x[i as usize] -= factor * solved;
            }
        };
        for (j, &pivot) in self.diagonal.iter().enumerate() {
            subtract(x, pivot + 1..self.pattern.positions(j).end, x[j]);
        }
        for (j, &pivot) in self.diagonal.iter().enumerate().rev() {
            x[j] /= self.factors[pivot];
            subtract(x, self.pattern.positions(j).start..pivot, x[j]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{IncompleteLu, Pattern};

    /// A matrix on a pattern, diagonally dominant, with irregular entries.
    fn entry(i: usize, j: usize) -> f64 {
        if i == j { 9.0 + i as f64 } else { ((3 * i + 7 * j) as f64).sin() }
    }

    /// The factorization of the matrix with these entries, or of I - gamma J that equals it.
    fn factorized(pattern: &Pattern, gamma: Option<f64>) -> IncompleteLu {
        let mut ilu = IncompleteLu::new(pattern);
        ilu.update_jacobian(|values| {
            for j in 0..pattern.dimension() {
                for (&i, at) in pattern.column(j).iter().zip(pattern.positions(j)) {
                    let a = entry(i as usize, j);
                    let identity = if i as usize == j { 1.0 } else { 0.0 };
                    values[at] = gamma.map_or(a, |gamma| (identity - a) / gamma);
                }
            }
            0
        });
        match gamma {
            Some(gamma) => ilu.factorize_shifted(gamma).unwrap(),
            None => ilu.factorize().unwrap(),
        }
        ilu
    }

    /// The product of the matrix with (1, -2, 3, ...), and that vector.
    fn product(pattern: &Pattern) -> (Vec<f64>, Vec<f64>) {
        let n = pattern.dimension();
        let x: Vec<f64> =
            (0..n).map(|i| (i + 1) as f64 * if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let mut b = vec![0.0; n];
        for (j, x) in x.iter().enumerate() {
            pattern.column(j).iter().for_each(|&i| b[i as usize] += entry(i as usize, j) * x);
        }
        (b, x)
    }

    #[test]
    fn a_full_band_and_a_tree_are_solved_exactly() {
        let arrow = (0..19).flat_map(|i| [(i, 19), (19, i)]);
        let arrow = Pattern::from_entries(20, arrow).unwrap();
        for pattern in [
            Pattern::band(20, 1, 1).unwrap(),
            Pattern::band(20, 3, 2).unwrap(),
            Pattern::band(20, 19, 19).unwrap(),
            arrow,
        ] {
            for gamma in [None, Some(1e-3)] {
                let (mut b, x) = product(&pattern);
                factorized(&pattern, gamma).solve(&mut b);
                let error = b.iter().zip(&x).map(|(b, x)| (b - x).abs()).fold(0.0, f64::max);
                assert!(error < 1e-12, "{error}");
            }
        }
    }

    /// Without fill, L U still equals the matrix wherever that has entries.
    #[test]
    fn the_factors_reproduce_the_entries() {
        let n = 25;
        let neighbours = |k: usize| [1, 5].into_iter().flat_map(move |d| [(k, k + d), (k + d, k)]);
        let entries = (0..n).flat_map(neighbours).filter(|&(i, j)| i < n && j < n);
        let pattern = Pattern::from_entries(n, entries).unwrap();
        let ilu = factorized(&pattern, None);
        let at = |i: usize, j: usize| pattern.position(i, j).map_or(0.0, |at| ilu.factors[at]);
        let mut fill: f64 = 0.0;
        for i in 0..n {
            for j in 0..n {
                let lower = |k: usize| if k == i { 1.0 } else { at(i, k) };
                let product: f64 = (0..=i.min(j)).map(|k| lower(k) * at(k, j)).sum();
                match pattern.position(i, j) {
                    Some(_) => assert!((product - entry(i, j)).abs() < 1e-14, "({i}, {j})"),
                    None => fill = fill.max(product.abs()),
                }
            }
        }
        assert!(fill > 1e-3, "this pattern has no fill");
    }

    #[test]
    fn a_missing_pivot_is_named() {
        let pattern = Pattern::band(3, 1, 1).unwrap();
        let mut ilu = IncompleteLu::new(&pattern);
        let tridiagonal = |middle: f64| [1.0, 2.0, 2.0, middle, 0.0, 0.0, 1.0];
        let mut factorize = |middle: f64| {
            ilu.update_jacobian(|values| {
                values.copy_from_slice(&tridiagonal(middle));
                0
            });
            ilu.factorize()
        };
        assert_eq!(factorize(4.0), Err(1));
        assert_eq!(factorize(f64::NAN), Err(1));
        assert_eq!(factorize(5.0), Ok(()));
    }
}
