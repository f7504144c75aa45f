//! Sparse factorization of symmetric matrices.
//!
//! Matrices are indefinite under strong compression, with strain measures that soften; the report has the
//! number of factorizations by LU (`docs/decisions/0009-indefinite-systems.md`).

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::solvers::Solve;
use faer::perm::Perm;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

/// A symmetric matrix, given by its lower triangle, and its factor: Cholesky's where the matrix is
/// positive definite, an LU factor where it is not.
///
/// The fill-reducing order and the pattern of Cholesky's factor are found once, in [`Cholesky::new`], and
/// everything is allocated there. LU is the fallback for states that few motions pass through; its pattern is
/// found when it is first needed, and it allocates at each factorization.
pub(super) struct Cholesky {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    /// The factor; for a diagonal matrix its inverse.
    factor: Vec<f64>,
    is_diagonal: bool,
    memory: MemBuffer,
    /// Threads of the factorization.
    par: Par,
    /// Used if the last factorization was LU.
    lu: Option<Lu<usize, f64>>,
    full: Option<Full>,
    /// Factorizations by LU so far.
    pub(super) indefinite: usize,
}

/// The full matrix whose lower triangle is known.
struct Full {
    pattern: SymbolicSparseColMat<usize>,
    symbolic: SymbolicLu<usize>,
    /// For each entry, the one of the lower triangle that it equals.
    sources: Vec<usize>,
}

/// Mean length of the columns of a factor from which threads pay: that of solids of some 10,000 unknowns.
/// Plane bodies stay below it up to a million.
const WORTH_THREADS: usize = 400;

/// The matrix is not positive definite, or singular.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Indefinite;

impl Cholesky {
    /// Analyses the pattern of a lower triangle (columns sorted, full diagonal). Unknowns are
    /// eliminated by approximate minimum degree, or in the `order` given if that leaves less fill.
    ///
    /// # Panics
    /// When the factor does not fit into memory: as any allocation does.
    pub(super) fn new(pattern: SymbolicSparseColMat<usize>, order: Option<Vec<usize>>) -> Self {
        let mut symbolic = analyse(&pattern, SymmetricOrdering::Amd);
        if let Some(order) = order {
            let mut inverse = vec![0; order.len()];
            order.iter().enumerate().for_each(|(at, &unknown)| inverse[unknown] = at);
            let n = order.len();
            let order = Perm::new_checked(order.into(), inverse.into(), n);
            let other = analyse(&pattern, SymmetricOrdering::Custom(order.as_ref()));
            if other.len_val() < symbolic.len_val() {
                symbolic = other;
            }
        }
        let par = match symbolic.len_val() > WORTH_THREADS * pattern.nrows() {
            true => Par::rayon(0),
            false => Par::Seq,
        };
        let memory = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(par, Spec::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]));
        let factor = vec![0.0; symbolic.len_val()];
        let is_diagonal = pattern.compute_nnz() == pattern.nrows();
        Self {
            pattern,
            symbolic,
            factor,
            is_diagonal,
            memory,
            par,
            lu: None,
            full: None,
            indefinite: 0,
        }
    }

    /// Numbers in Cholesky's factor.
    pub(super) fn entries(&self) -> usize {
        self.factor.len()
    }

    /// Operations of a factorization: the sum of the squares of the lengths of the factor's columns.
    pub(super) fn work(&self) -> f64 {
        let square = |length: usize| (length as f64).powi(2);
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(factor) => {
                factor.col_ptr().windows(2).map(|ends| square(ends[1] - ends[0])).sum()
            }
            SymbolicCholeskyRaw::Supernodal(factor) => {
                let ends = factor.supernode_begin().iter().zip(factor.supernode_end());
                let blocks = ends.enumerate().map(|(at, (start, end))| {
                    let below = factor.supernode(at).pattern().len();
                    (1..=end - start).map(|column| square(below + column)).sum::<f64>()
                });
                blocks.sum()
            }
        }
    }

    /// Factorizes the positive definite matrix whose lower triangle has these values.
    pub(super) fn factorize(&mut self, values: &[f64]) -> Result<(), Indefinite> {
        self.lu = None;
        if self.is_diagonal && values.iter().all(|value| *value > 0.0) {
            self.factor.iter_mut().zip(values).for_each(|(inverse, value)| *inverse = 1.0 / value);
            return Ok(());
        }
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                self.par,
                MemStack::new(&mut self.memory),
                Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| Indefinite)
    }

    /// Factorizes a symmetric matrix that may be indefinite.
    pub(super) fn factorize_indefinite(&mut self, values: &[f64]) -> Result<(), Indefinite> {
        self.indefinite += 1;
        let full = match self.full.take() {
            Some(full) => full,
            None => Full::new(&self.pattern)?,
        };
        let values: Vec<f64> = full.sources.iter().map(|&entry| values[entry]).collect();
        let matrix = SparseColMatRef::new(full.pattern.as_ref(), &values);
        self.lu = Lu::try_new_with_symbolic(full.symbolic.clone(), matrix).ok();
        self.full = Some(full);
        // a pivot of 0 is not rejected, but gives values that are not finite
        let mut probe = vec![1.0; self.pattern.nrows()];
        self.solve(&mut probe);
        let is_regular = self.lu.is_some() && probe.iter().all(|x| x.is_finite());
        if is_regular { Ok(()) } else { Err(Indefinite) }
    }

    /// Replaces `x` by the solution of A x' = x.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        if self.is_diagonal && self.lu.is_none() {
            return x.iter_mut().zip(&self.factor).for_each(|(x, inverse)| *x *= inverse);
        }
        let rows = x.len();
        let x = MatMut::from_column_major_slice_mut(x, rows, 1);
        match &self.lu {
            None => LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
                Conj::No,
                x,
                Par::Seq,
                MemStack::new(&mut self.memory),
            ),
            Some(lu) => lu.solve_in_place(x),
        }
    }
}

fn analyse(
    pattern: &SymbolicSparseColMat<usize>,
    order: SymmetricOrdering<'_, usize>,
) -> SymbolicCholesky<usize> {
    let params = CholeskySymbolicParams::default();
    factorize_symbolic_cholesky(pattern.as_ref(), Side::Lower, order, params)
        .unwrap_or_else(|error| panic!("analysis of a sparse factorization: {error:?}"))
}

impl Full {
    fn new(lower: &SymbolicSparseColMat<usize>) -> Result<Self, Indefinite> {
        let n = lower.nrows();
        let mut columns: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
        let (offsets, rows) = (lower.col_ptr(), lower.row_idx());
        for column in 0..n {
            for entry in offsets[column]..offsets[column + 1] {
                columns[column].push((rows[entry], entry));
                if rows[entry] != column {
                    columns[rows[entry]].push((column, entry));
                }
            }
        }
        columns.iter_mut().for_each(|column| column.sort_unstable());
        let mut offsets = vec![0];
        offsets.extend(columns.iter().scan(0, |end, column| {
            *end += column.len();
            Some(*end)
        }));
        let (rows, sources) = columns.into_iter().flatten().unzip();
        let pattern = SymbolicSparseColMat::new_checked(n, n, offsets, None, rows);
        let symbolic = SymbolicLu::try_new(pattern.as_ref()).map_err(|_| Indefinite)?;
        Ok(Self { pattern, symbolic, sources })
    }
}

#[cfg(test)]
mod tests {
    use faer::Mat;

    use super::*;

    /// The matrix of a grid of `side` x `side` points, coupled along x and y, with a diagonal that
    /// `shift` makes definite or not.
    fn grid(side: usize, shift: f64) -> (SymbolicSparseColMat<usize>, Vec<f64>, Mat<f64>) {
        let n = side * side;
        let (mut offsets, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        let mut dense = Mat::zeros(n, n);
        for column in 0..n {
            let mut put = |row: usize, value: f64| {
                rows.push(row);
                values.push(value);
                (dense[(row, column)], dense[(column, row)]) = (value, value);
            };
            put(column, 4.0 + shift + 0.1 * (column % 5) as f64);
            if (column + 1) % side != 0 {
                put(column + 1, -1.0);
            }
            if column + side < n {
                put(column + side, -1.0);
            }
            offsets.push(rows.len());
        }
        let pattern = SymbolicSparseColMat::new_checked(n, n, offsets, None, rows);
        (pattern, values, dense)
    }

    /// Small grids are factorized column by column, large ones by supernodes.
    #[test]
    fn definite_or_not_the_solution_is_that_of_a_dense_lu() {
        for side in [4, 40] {
            for shift in [0.0, -3.0] {
                let (pattern, values, dense) = grid(side, shift);
                let mut factor = Cholesky::new(pattern, None);
                assert_eq!(factor.factorize(&values).is_ok(), shift == 0.0);
                let right: Vec<f64> = (0..side * side).map(|i| (i as f64).sin()).collect();
                let expected =
                    dense.partial_piv_lu().solve(&Mat::from_fn(right.len(), 1, |i, _| right[i]));
                factor.factorize_indefinite(&values).unwrap();
                let mut x = right.clone();
                factor.solve(&mut x);
                // a condition number of some thousands
                let apart = |x: &[f64]| {
                    let apart = x.iter().enumerate().map(|(i, x)| (x - expected[(i, 0)]).abs());
                    apart.fold(0.0, f64::max)
                };
                assert!(apart(&x) < 1e-10, "{side} {shift}: {:e}", apart(&x));
                // and back to a definite matrix
                let (_, values, dense) = grid(side, 1.0);
                factor.factorize(&values).unwrap();
                let mut x = right.clone();
                factor.solve(&mut x);
                let residual = (0..x.len())
                    .map(|i| (0..x.len()).map(|j| dense[(i, j)] * x[j]).sum::<f64>() - right[i]);
                assert!(residual.fold(0.0, |most: f64, r| most.max(r.abs())) < 1e-12);
            }
        }
    }

    #[test]
    fn diagonal_matrices_are_divided_by() {
        let pattern =
            || SymbolicSparseColMat::new_checked(3, 3, vec![0, 1, 2, 3], None, vec![0, 1, 2]);
        let mut factor = Cholesky::new(pattern(), None);
        let solved = |factor: &mut Cholesky| {
            let mut x = [1.0, 1.0, 1.0];
            factor.solve(&mut x);
            x
        };
        factor.factorize(&[2.0, 4.0, 0.5]).unwrap();
        assert_eq!(solved(&mut factor), [0.5, 0.25, 2.0]);
        assert_eq!(factor.factorize(&[2.0, -4.0, 0.5]), Err(Indefinite));
        factor.factorize_indefinite(&[2.0, -4.0, 0.5]).unwrap();
        assert_eq!(solved(&mut factor), [0.5, -0.25, 2.0]);
        factor.factorize(&[1.0, 1.0, 8.0]).unwrap();
        assert_eq!(solved(&mut factor), [1.0, 1.0, 0.125]);
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let pattern = SymbolicSparseColMat::new_checked(2, 2, vec![0, 2, 3], None, vec![0, 1, 1]);
        let mut factor = Cholesky::new(pattern, None);
        assert_eq!(factor.factorize_indefinite(&[1.0, 1.0, 1.0]), Err(Indefinite));
    }
}
