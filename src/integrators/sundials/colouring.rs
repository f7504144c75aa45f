//! Columns of a sparse matrix whose difference quotients can share one evaluation of the function.
//!
//! The colouring is greedy, columns with most neighbours first.

use super::pattern::Pattern;

/// The columns of a matrix in groups, the colours: no row has entries in two columns of one colour, so that a
/// single evaluation with all of them shifted gives the entries of each (Curtis, Powell and Reid).
pub(crate) struct Colouring {
    /// Columns, colour after colour.
    columns: Vec<usize>,
    /// End of each colour in `columns`.
    ends: Vec<usize>,
}

impl Colouring {
    /// Gives each column the first colour that none of its neighbours has, those with most neighbours first.
    /// Neighbours are columns that share a row.
    pub(super) fn new(pattern: &Pattern) -> Self {
        let n = pattern.dimension();
        let mut rows = vec![Vec::new(); n];
        for j in 0..n {
            pattern.column(j).iter().for_each(|&i| rows[i as usize].push(j));
        }
        let neighbours = |j: usize| pattern.column(j).iter().flat_map(|&i| &rows[i as usize]);

        let mut seen = vec![usize::MAX; n];
        let mut degree = |j: usize| {
            let mut first_visit = |k: usize| std::mem::replace(&mut seen[k], j) != j;
            neighbours(j).filter(|&&k| first_visit(k)).count()
        };
        let degrees: Vec<usize> = (0..n).map(&mut degree).collect();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&j| std::cmp::Reverse(degrees[j]));

        let none = usize::MAX;
        let mut colour = vec![none; n];
        // for each colour, the last column that could not have it
        let mut taken_at: Vec<usize> = Vec::new();
        for &j in &order {
            for &k in neighbours(j) {
                if colour[k] != none {
                    taken_at[colour[k]] = j;
                }
            }
            let free = taken_at.iter().position(|&at| at != j);
            colour[j] = free.unwrap_or(taken_at.len());
            if free.is_none() {
                taken_at.push(none);
            }
        }
        let mut columns: Vec<usize> = (0..n).collect();
        columns.sort_by_key(|&j| colour[j]);
        let ends =
            (0..taken_at.len()).map(|c| columns.partition_point(|&j| colour[j] <= c)).collect();
        Self { columns, ends }
    }

    /// Gives every `count`-th of `n` columns the same colour.
    pub(super) fn every(n: usize, count: usize) -> Self {
        let colours = count.min(n);
        let columns = (0..colours).flat_map(|colour| (colour..n).step_by(count)).collect();
        let mut ends = vec![0; colours];
        let mut end = 0;
        for (colour, place) in ends.iter_mut().enumerate() {
            end += (n - colour).div_ceil(count);
            *place = end;
        }
        Self { columns, ends }
    }

    /// Number of colours.
    pub(crate) fn count(&self) -> usize {
        self.ends.len()
    }

    /// The columns of a colour.
    pub(crate) fn columns(&self, colour: usize) -> &[usize] {
        let start = if colour == 0 { 0 } else { self.ends[colour - 1] };
        &self.columns[start..self.ends[colour]]
    }
}

#[cfg(test)]
mod tests {
    use super::{Colouring, Pattern};

    /// The number of colours, after a check that every column has one and that no row has two entries of one.
    fn colours(pattern: &Pattern) -> usize {
        let n = pattern.dimension();
        let colouring = Colouring::new(pattern);
        let mut all: Vec<usize> = Vec::new();
        for colour in 0..colouring.count() {
            let mut rows = vec![false; n];
            for &j in colouring.columns(colour) {
                all.push(j);
                for &i in pattern.column(j) {
                    assert!(!std::mem::replace(&mut rows[i as usize], true), "row {i}");
                }
            }
        }
        all.sort_unstable();
        assert_eq!(all, (0..n).collect::<Vec<_>>());
        colouring.count()
    }

    #[test]
    fn bands_have_as_many_colours_as_diagonals() {
        for (lower, upper) in [(0, 0), (1, 1), (0, 2), (3, 1)] {
            let band = Pattern::band(40, lower, upper).unwrap();
            assert_eq!(colours(&band), lower + upper + 1);
        }
    }

    #[test]
    fn even_colours_are_those_of_bands() {
        for (n, lower, upper) in [(40, 1, 1), (7, 3, 2), (5, 4, 4), (1, 0, 0)] {
            let (band, count) = (Pattern::band(n, lower, upper).unwrap(), lower + upper + 1);
            let even = Colouring::every(n, count);
            assert_eq!(even.count(), count.min(n));
            let mut all: Vec<usize> = Vec::new();
            for colour in 0..even.count() {
                let mut rows = vec![false; n];
                for &j in even.columns(colour) {
                    all.push(j);
                    for &i in band.column(j) {
                        assert!(!std::mem::replace(&mut rows[i as usize], true), "row {i}");
                    }
                }
            }
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }

    #[test]
    fn arrows_and_scattered_entries_are_told_apart() {
        // a full row needs a colour for each column, a full column only one for itself
        let row = Pattern::from_entries(9, (0..9).map(|j| (0, j))).unwrap();
        assert_eq!(colours(&row), 9);
        let column = Pattern::from_entries(9, (0..9).map(|i| (i, 0))).unwrap();
        assert_eq!(colours(&column), 2);
        let scattered = (0..60).map(|k| (k * 7 % 20, k * k % 20));
        assert!(colours(&Pattern::from_entries(20, scattered).unwrap()) <= 20);
    }
}
