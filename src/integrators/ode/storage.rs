//! The form of a Jacobian that a system supplies.

/// Which Jacobian a system supplies. There is nothing outside a band or pattern.
#[derive(Clone, Copy, Debug)]
pub enum Storage<'a> {
    /// `dense_jacobian`
    Dense,
    /// `banded_jacobian`
    Band {
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
    },
    /// `sparse_jacobian`, by columns as [`Pattern`](crate::integrators::sundials::Pattern) has them.
    Sparse {
        /// Start of each column, and the number of entries.
        column_pointers: &'a [i64],
        /// Row of each entry.
        row_indices: &'a [i64],
    },
}
