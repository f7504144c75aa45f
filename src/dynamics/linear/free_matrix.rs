//! The entries of a symmetric matrix at the free degrees of freedom.

use super::entry_source::EntrySource;

/// The lower triangle of the free part of X, column by column.
pub(super) struct FreeMatrix {
    /// Free degrees of freedom, ascending.
    pub(super) free: Vec<usize>,
    /// Sources of the entries.
    sources: Vec<EntrySource>,
    /// Contributions of nodes that move with others: entry, source and weight.
    carried: Vec<(usize, EntrySource, f64)>,
    pub(super) values: Vec<f64>,
}

impl FreeMatrix {
    pub(super) fn new(
        free: Vec<usize>,
        sources: Vec<EntrySource>,
        carried: Vec<(usize, EntrySource, f64)>,
    ) -> Self {
        let values = vec![0.0; sources.len()];
        Self { free, sources, carried, values }
    }

    /// Sets the entries that `value` returns.
    pub(super) fn assemble(&mut self, value: impl Fn(EntrySource) -> f64) {
        self.values.iter_mut().zip(&self.sources).for_each(|(x, &source)| *x = value(source));
        for &(at, source, share) in &self.carried {
            self.values[at] += share * value(source);
        }
    }
}
