//! Band matrices, to be filled by a Jacobian.

use std::ops::{Index, IndexMut};

/// A band matrix to be filled: entry (i, j) exists where `j - upper <= i <= j + lower`.
///
/// Indexed like a full matrix, `band[(i, j)] = value`; panics outside the band.
#[derive(Debug)]
pub struct BandMut<'a> {
    data: &'a mut [f64],
    stride: usize,
    diagonal: usize,
    lower: usize,
    upper: usize,
}

impl<'a> BandMut<'a> {
    /// A view of `data`: columns of `stride` numbers each, the diagonal entry at index `diagonal`
    /// of its column.
    ///
    /// # Panics
    /// If a column is too short for the band.
    #[must_use]
    pub fn new(
        data: &'a mut [f64],
        stride: usize,
        diagonal: usize,
        lower: usize,
        upper: usize,
    ) -> Self {
        assert!(
            upper <= diagonal && diagonal + lower < stride && data.len().is_multiple_of(stride)
        );
        Self { data, stride, diagonal, lower, upper }
    }

    /// The same matrix, lent for a shorter time.
    #[must_use]
    pub fn reborrow(&mut self) -> BandMut<'_> {
        BandMut { data: self.data, ..*self }
    }

    /// Number of rows, and of columns.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.data.len() / self.stride
    }

    /// Diagonals below the main one.
    #[must_use]
    pub fn lower(&self) -> usize {
        self.lower
    }

    /// Diagonals above the main one.
    #[must_use]
    pub fn upper(&self) -> usize {
        self.upper
    }

    fn place(&self, (i, j): (usize, usize)) -> usize {
        assert!(
            i <= j + self.lower && j <= i + self.upper && i < self.dimension(),
            "entry ({i}, {j}) lies outside the band of {} lower and {} upper diagonals",
            self.lower,
            self.upper
        );
        j * self.stride + self.diagonal + i - j
    }
}

impl Index<(usize, usize)> for BandMut<'_> {
    type Output = f64;

    fn index(&self, entry: (usize, usize)) -> &f64 {
        &self.data[self.place(entry)]
    }
}

impl IndexMut<(usize, usize)> for BandMut<'_> {
    fn index_mut(&mut self, entry: (usize, usize)) -> &mut f64 {
        let place = self.place(entry);
        &mut self.data[place]
    }
}

#[cfg(test)]
mod tests {
    use super::BandMut;

    #[test]
    fn a_band_stores_its_columns_one_after_another() {
        // Two lower diagonals, one upper, and one more row above them, as LU needs it.
        let mut data = [0.0; 5 * 4];
        let mut band = BandMut::new(&mut data, 5, 2, 2, 1);
        for (i, j) in [(0, 0), (2, 0), (0, 1), (3, 1), (2, 3)] {
            band[(i, j)] = (10 * i + j) as f64 + 0.5;
        }
        assert_eq!(band[(3, 1)], 31.5);
        let expected = [
            [0.0, 0.0, 0.5, 0.0, 20.5],
            [0.0, 1.5, 0.0, 0.0, 31.5],
            [0.0; 5],
            [0.0, 23.5, 0.0, 0.0, 0.0],
        ];
        assert_eq!(data, *expected.as_flattened());
    }

    #[test]
    #[should_panic(expected = "entry (0, 2) lies outside the band")]
    fn outside_the_band_there_is_nothing() {
        let mut data = [0.0; 20];
        BandMut::new(&mut data, 5, 2, 2, 1)[(0, 2)] = 1.0;
    }
}
