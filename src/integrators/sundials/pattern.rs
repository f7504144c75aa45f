//! Pattern of the nonzeros of a sparse Jacobian.

use std::ops::Range;

use crate::base::input::InputError;

/// The sparsity pattern of a square matrix in compressed sparse columns (CSC).
///
/// Rows are sorted within each column, no entry occurs twice, and every diagonal entry is stored, zero or
/// not: SUNDIALS adds the identity in place and writes out of bounds where the diagonal has no space
/// (`SUNMatScaleAddI_Sparse`, SUNDIALS 6.4.1). A `Pattern` cannot be made without these properties.
///
/// The values of a Jacobian come in the order of [`row_indices`](Self::row_indices);
/// [`position`](Self::position) finds the position of one entry.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Unchecked"))]
pub struct Pattern {
    column_pointers: Vec<i64>,
    row_indices: Vec<i64>,
}

/// The arrays of a pattern that comes from elsewhere.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Unchecked {
    column_pointers: Vec<usize>,
    row_indices: Vec<usize>,
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for Pattern {
    type Error = InputError;

    fn try_from(arrays: Unchecked) -> Result<Self, InputError> {
        Self::from_csc(&arrays.column_pointers, &arrays.row_indices)
    }
}

impl Pattern {
    /// The pattern of an `n` x `n` matrix with the given (row, column) entries, in any order and
    /// with repetitions; missing diagonal entries are added.
    ///
    /// # Errors
    /// If `n` is 0 or an entry lies outside the matrix.
    pub fn from_entries(
        n: usize,
        entries: impl IntoIterator<Item = (usize, usize)>,
    ) -> Result<Self, InputError> {
        if n == 0 {
            let help = "a matrix has at least one row and column";
            return Err(InputError::new("number of unknowns", n, help));
        }
        let mut columns: Vec<Vec<usize>> = (0..n).map(|j| vec![j]).collect();
        for (row, column) in entries {
            if row >= n || column >= n {
                return Err(InputError::new(
                    "pattern entry",
                    format!("({row}, {column})"),
                    format!("rows and columns of this matrix run from 0 to {}", n - 1),
                ));
            }
            columns[column].push(row);
        }
        let mut column_pointers = vec![0];
        let mut row_indices = Vec::new();
        for mut rows in columns {
            rows.sort_unstable();
            rows.dedup();
            row_indices.append(&mut rows);
            column_pointers.push(row_indices.len());
        }
        Self::from_csc(&column_pointers, &row_indices)
    }

    /// The pattern of an `n` x `n` band matrix: entry (i, j) is stored where `j - upper <= i <= j + lower`.
    ///
    /// # Errors
    /// If `n` is 0 or a bandwidth is not smaller than `n`.
    pub fn band(n: usize, lower: usize, upper: usize) -> Result<Self, InputError> {
        if n > 0 && (lower >= n || upper >= n) {
            return Err(InputError::new(
                "bandwidths (lower, upper)",
                format!("({lower}, {upper})"),
                format!("both have to be smaller than the number of unknowns, {n}"),
            ));
        }
        let column =
            |j: usize| (j.saturating_sub(upper)..(j + lower + 1).min(n)).map(move |i| (i, j));
        Self::from_entries(n, (0..n).flat_map(column))
    }

    /// The pattern of a matrix in CSC form: the rows of column j are
    /// `row_indices[column_pointers[j]..column_pointers[j + 1]]`.
    ///
    /// Nothing is rearranged, so values that belong to these arrays keep their positions.
    ///
    /// # Errors
    /// If the arrays do not fit together, a row is out of range, the rows of a
    /// column are not strictly increasing, or a diagonal entry is missing
    /// ([`from_entries`](Self::from_entries) sorts and completes).
    pub fn from_csc(column_pointers: &[usize], row_indices: &[usize]) -> Result<Self, InputError> {
        let total = row_indices.len();
        if column_pointers.len() < 2
            || column_pointers[0] != 0
            || column_pointers.last() != Some(&total)
            || column_pointers.windows(2).any(|pair| pair[1] < pair[0])
        {
            return Err(InputError::new(
                "column_pointers",
                format!("an array of {} with {total} rows", column_pointers.len()),
                "it starts with 0, does not decrease, and ends with the number of entries; a \
                 matrix has at least one column",
            ));
        }
        let n = column_pointers.len() - 1;
        for (j, ends) in column_pointers.windows(2).enumerate() {
            let rows = &row_indices[ends[0]..ends[1]];
            if rows.iter().any(|&row| row >= n)
                || rows.windows(2).any(|pair| pair[0] >= pair[1])
                || rows.binary_search(&j).is_err()
            {
                return Err(InputError::new(
                    "row_indices",
                    format!("{rows:?} in column {j}"),
                    format!(
                        "rows are smaller than {n}, strictly increasing, and contain the \
                         diagonal; Pattern::from_entries sorts and completes"
                    ),
                ));
            }
        }
        // None exceeds the length of a slice, so all fit.
        let signed = |indices: &[usize]| indices.iter().map(|&i| i as i64).collect();
        Ok(Self { column_pointers: signed(column_pointers), row_indices: signed(row_indices) })
    }

    /// Number of rows, which is the number of columns.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.column_pointers.len() - 1
    }

    /// Number of stored entries: the length of the `values` that a sparse Jacobian fills.
    #[must_use]
    pub fn entry_count(&self) -> usize {
        self.row_indices.len()
    }

    /// Start of each column in [`row_indices`](Self::row_indices), and its length at the end.
    #[must_use]
    pub fn column_pointers(&self) -> &[i64] {
        &self.column_pointers
    }

    /// Row of each entry, column after column.
    #[must_use]
    pub fn row_indices(&self) -> &[i64] {
        &self.row_indices
    }

    /// Index of the entry (row, column) among the values, if it is stored.
    #[must_use]
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        if column >= self.dimension() {
            return None;
        }
        let within = self.column(column).binary_search(&(row as i64)).ok()?;
        Some(self.column_pointers[column] as usize + within)
    }

    /// The values of a matrix with these (row, column, value) entries, in the order of this pattern; values
    /// at the same position add up.
    ///
    /// # Errors
    /// If an entry is not stored.
    pub fn values(
        &self,
        entries: impl IntoIterator<Item = (usize, usize, f64)>,
    ) -> Result<Vec<f64>, InputError> {
        let mut values = vec![0.0; self.entry_count()];
        for (row, column, value) in entries {
            let position = self.position(row, column).ok_or_else(|| {
                let help = "the sparsity pattern has to have it, with those of all matrices";
                InputError::new("entry", format!("({row}, {column})"), help)
            })?;
            values[position] += value;
        }
        Ok(values)
    }

    /// The pattern of the transposed matrix.
    pub(super) fn transposed(&self) -> Self {
        let mut columns = vec![Vec::new(); self.dimension()];
        for j in 0..columns.len() {
            self.column(j).iter().for_each(|&i| columns[i as usize].push(j as i64));
        }
        let mut column_pointers = vec![0];
        for rows in &columns {
            column_pointers.push(column_pointers[column_pointers.len() - 1] + rows.len() as i64);
        }
        Self { column_pointers, row_indices: columns.concat() }
    }

    /// Checks that the matrix has as many columns as there are unknowns.
    pub(super) fn check(&self, n: usize) -> Result<(), InputError> {
        if self.dimension() == n {
            return Ok(());
        }
        Err(InputError::new(
            "dimension of the sparsity pattern",
            self.dimension(),
            format!("it has to be the number of unknowns, {n}"),
        ))
    }

    /// Rows of the entries of column `j`.
    pub(super) fn column(&self, j: usize) -> &[i64] {
        self.rows(self.positions(j))
    }

    /// Rows of the entries at these positions.
    pub(super) fn rows(&self, positions: Range<usize>) -> &[i64] {
        &self.row_indices[positions]
    }

    /// Positions of the entries of column `j` among the values.
    pub(super) fn positions(&self, j: usize) -> Range<usize> {
        self.column_pointers[j] as usize..self.column_pointers[j + 1] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::Pattern;

    #[test]
    fn entries_are_sorted_and_completed_with_the_diagonal() {
        let pattern = Pattern::from_entries(3, [(2, 0), (1, 0), (2, 0), (0, 2)]).unwrap();
        assert_eq!(pattern.column_pointers(), [0, 3, 4, 6]);
        assert_eq!(pattern.row_indices(), [0, 1, 2, 1, 0, 2]);
        assert_eq!(pattern.position(0, 2), Some(4));
        assert_eq!(pattern.position(0, 1), None);
        assert_eq!(pattern.position(0, 3), None);
    }

    #[test]
    fn bands_store_their_diagonals() {
        let band = Pattern::band(3, 1, 0).unwrap();
        assert_eq!(band, Pattern::from_entries(3, [(1, 0), (2, 1)]).unwrap());
        assert_eq!(Pattern::band(5, 4, 4).unwrap().entry_count(), 25);
        assert!(Pattern::band(0, 0, 0).is_err() && Pattern::band(3, 3, 0).is_err());
    }

    #[test]
    fn unusable_patterns_are_refused() {
        assert!(Pattern::from_entries(0, []).is_err());
        assert!(Pattern::from_entries(2, [(2, 0)]).is_err());
        assert!(Pattern::from_csc(&[0, 2, 3], &[0, 1, 1]).is_ok());
        for (pointers, rows, why) in [
            (&[0, 2, 3][..], &[1, 0, 1][..], "unsorted"),
            (&[0, 1, 2], &[0, 0], "no diagonal in column 1"),
            (&[0, 1, 2], &[0, 2], "row out of range"),
            (&[0, 1, 3], &[0, 1], "pointers beyond the rows"),
            (&[0], &[], "no columns"),
            (&[0, 2, 1, 3], &[0, 1, 2], "decreasing pointers"),
            (&[0, 2, 3], &[usize::MAX, 0, 1], "a row that is -1 as an index of C"),
            (&[0, 2, 3], &[1 << 63, 0, 1], "the most negative index of C"),
            (&[0, usize::MAX, 2], &[0, 1], "a pointer that is -1 as an index of C"),
        ] {
            let refused = Pattern::from_csc(pointers, rows);
            assert!(refused.is_err(), "{why}: {refused:?}");
        }
    }
}
