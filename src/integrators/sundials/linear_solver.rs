//! Linear solvers of the Newton iteration.

use faer::MatMut;

use super::{jacobian::Jacobian, krylov::Krylov, pattern::Pattern};
use crate::base::input::InputError;
use crate::integrators::ode::{BandMut, Entries, Storage};

/// Linear solver of the Newton iteration.
///
/// User guide: chapter "Linear Algebraic Solvers", SUNLinearSolver.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LinearSolver {
    /// LU factorization of a dense matrix: n^2 numbers, n^3 work. For small systems.
    Dense(Jacobian),
    /// LU factorization of a band matrix; entry (i, j) may be nonzero where
    /// `j - upper <= i <= j + lower`.
    Band {
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
        /// Source of the entries.
        jacobian: Jacobian,
    },
    /// Sparse LU factorization by KLU.
    Klu {
        /// Pattern of the nonzeros. Difference quotients are wrong where the Jacobian has others, which is checked
        /// ([`CvodeOptions::check_jacobian`](super::CvodeOptions::check_jacobian)).
        pattern: Pattern,
        /// Source of the entries.
        jacobian: Jacobian,
    },
    /// A Krylov method: no matrix, but products with vectors.
    Krylov(Krylov),
    /// The system's own `newton_setup` and `newton_solve`: the way to exploit structure that
    /// a matrix of entries hides.
    Custom,
}

impl LinearSolver {
    /// Rejects options on which C would crash, and dense matrices that do not fit into the memory.
    pub(crate) fn check(&self, n: usize) -> Result<(), InputError> {
        self.check_sizes(n)?;
        // two matrices are stored: the Jacobian, and the factors of Newton's matrix
        let has_memory = |count: usize| Vec::<f64>::new().try_reserve_exact(count).is_ok();
        if matches!(self, Self::Dense(_)) && !has_memory(2 * n * n) {
            let help = format!(
                "two dense matrices of {:.1} GB each do not fit into the memory: give a band (LinearSolver::Band), a pattern \
                 (LinearSolver::Klu; Pattern::ode_by_sampling or ode_by_nan finds it), a Krylov method or a custom linear solver",
                8e-9 * (n * n) as f64
            );
            return Err(InputError::new("number of unknowns", n, help));
        }
        Ok(())
    }

    fn check_sizes(&self, n: usize) -> Result<(), InputError> {
        match self {
            Self::Dense(_) if !is_addressable(n, n) => Err(InputError::new(
                "number of unknowns",
                n,
                "a dense matrix of that size does not fit into any memory: choose a band, a sparse \
                 or a custom linear solver",
            )),
            Self::Band { lower, upper, .. } if *lower >= n || *upper >= n => Err(InputError::new(
                "bandwidths (lower, upper)",
                format!("({lower}, {upper})"),
                format!("both have to be smaller than the number of unknowns, {n}"),
            )),
            Self::Band { lower, upper, .. } if !is_addressable(n, band_rows(*lower, *upper)) => {
                Err(InputError::new(
                    "bandwidths (lower, upper)",
                    format!("({lower}, {upper})"),
                    format!("with {n} unknowns the band does not fit into any memory"),
                ))
            }
            Self::Klu { pattern, .. } => pattern.check(n),
            Self::Krylov(krylov) => krylov.check(n),
            _ => Ok(()),
        }
    }

    /// The entries of a matrix with `n` columns, or of that of a preconditioner, which are stored as `values`;
    /// none for a solver of the system's own.
    pub(super) fn entries<'a>(&self, n: usize, values: &'a mut [f64]) -> Entries<'a> {
        match *self {
            Self::Dense(_) => Entries::Dense(MatMut::from_column_major_slice_mut(values, n, n)),
            Self::Band { lower, upper, .. } => {
                // space for pivots may lie above the band
                let stride = values.len() / n;
                Entries::Band(BandMut::new(values, stride, stride - lower - 1, lower, upper))
            }
            Self::Klu { .. } | Self::Krylov(_) | Self::Custom => Entries::Sparse(values),
        }
    }

    /// Whether the matrix of a DAE is filled by a callback (and not by SUNDIALS' difference quotients).
    pub(super) fn has_jacobian_callback(&self) -> bool {
        match self {
            Self::Dense(jacobian) | Self::Band { jacobian, .. } => *jacobian == Jacobian::Supplied,
            Self::Klu { .. } | Self::Custom => true,
            Self::Krylov(_) => false,
        }
    }

    /// The linear solver for a Jacobian that the system supplies.
    pub(crate) fn of_supplied(storage: Storage<'_>) -> Result<Self, InputError> {
        let jacobian = Jacobian::Supplied;
        Ok(match storage {
            Storage::Dense => Self::Dense(jacobian),
            Storage::Band { lower, upper } => Self::Band { lower, upper, jacobian },
            Storage::Sparse { column_pointers, row_indices } => {
                let numbers = |all: &[i64]| all.iter().map(|&k| k as usize).collect::<Vec<_>>();
                let (columns, rows) = (numbers(column_pointers), numbers(row_indices));
                Self::Klu { pattern: Pattern::from_csc(&columns, &rows)?, jacobian }
            }
        })
    }

    /// The method by which the system supplies a Jacobian that the iteration relies on.
    pub(crate) fn supplied(&self) -> Option<&'static str> {
        match self {
            Self::Dense(Jacobian::Supplied) => Some("dense_jacobian"),
            Self::Band { jacobian: Jacobian::Supplied, .. } => Some("banded_jacobian"),
            Self::Klu { jacobian: Jacobian::Supplied, .. } => Some("sparse_jacobian"),
            Self::Krylov(krylov) if krylov.products == Jacobian::Supplied => Some("jacobian_times"),
            _ => None,
        }
    }

    /// Whether the Jacobian is checked against the equations: a supplied one, or difference quotients that may lack entries.
    pub(crate) fn is_checked(&self) -> bool {
        let quotients = Jacobian::DifferenceQuotients;
        self.supplied().is_some()
            || matches!(self, Self::Band { jacobian, .. } | Self::Klu { jacobian, .. } if *jacobian == quotients)
    }

    /// Source of the entries of the matrix or of its preconditioner.
    fn source_of_entries(&self) -> Option<Jacobian> {
        match self {
            Self::Dense(jacobian) | Self::Band { jacobian, .. } | Self::Klu { jacobian, .. } => {
                Some(*jacobian)
            }
            _ => self.ilu().map(|(_, jacobian)| jacobian),
        }
    }

    /// Whether these are difference quotients.
    pub(crate) fn takes_quotients(&self) -> bool {
        self.source_of_entries() == Some(Jacobian::DifferenceQuotients)
    }

    /// Whether the system supplies them.
    pub(super) fn supplies_entries(&self) -> bool {
        self.source_of_entries() == Some(Jacobian::Supplied)
    }

    /// The pattern on which the layer itself takes difference quotients.
    pub(super) fn pattern_of_differences(&self) -> Option<&Pattern> {
        match (self, self.ilu()) {
            (Self::Klu { pattern, jacobian: Jacobian::DifferenceQuotients }, _)
            | (_, Some((pattern, Jacobian::DifferenceQuotients))) => Some(pattern),
            _ => None,
        }
    }

    /// Pattern and entries of an incomplete factorization that preconditions.
    pub(super) fn ilu(&self) -> Option<(&Pattern, Jacobian)> {
        match self {
            Self::Krylov(krylov) => krylov.ilu(),
            _ => None,
        }
    }
}

/// Rows of the stored band: as many diagonals as LU factorization with pivoting needs.
fn band_rows(lower: usize, upper: usize) -> usize {
    lower.saturating_mul(2).saturating_add(upper).saturating_add(1)
}

/// Whether C can count the bytes of a matrix of `n` columns of `rows` numbers.
fn is_addressable(n: usize, rows: usize) -> bool {
    let bytes = n.checked_mul(rows).and_then(|count| count.checked_mul(size_of::<f64>()));
    bytes.is_some_and(|bytes| isize::try_from(bytes).is_ok())
}

#[cfg(test)]
mod tests {
    use super::{Jacobian, LinearSolver};

    /// n^2 numbers of 8 bytes are more than 2^63 from n = 2^30 on: C would not notice the overflow.
    #[test]
    fn matrices_whose_size_overflows_are_refused() {
        let dense = LinearSolver::Dense(Jacobian::Supplied);
        assert!(dense.check_sizes(1 << 29).is_ok());
        assert!(dense.check_sizes(1 << 30).is_err());
        let band =
            |half| LinearSolver::Band { lower: half, upper: half, jacobian: Jacobian::Supplied };
        assert!(band(1).check_sizes(1 << 40).is_ok());
        assert!(band((1 << 40) - 1).check_sizes(1 << 40).is_err());
        assert!(band(usize::MAX / 2).check_sizes(usize::MAX).is_err());
    }
}
