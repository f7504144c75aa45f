//! Sources of the entries of the matrices of a phase.

/// Which entry of the matrices of the body an entry of X comes from. There is one for each entry of X, so it
/// is kept small.
#[derive(Clone, Copy)]
pub(crate) struct EntrySource {
    entry: u32,
    transposed: u32,
    axes: [u8; 2],
}

impl EntrySource {
    /// The entry at two axes, of the row and of the column, in the block `entry` of the [`NodePattern`].
    pub(crate) fn new(entry: usize, transposed: usize, axes: [usize; 2]) -> Self {
        let [entry, transposed] = [entry, transposed].map(|entry| entry as u32);
        Self { entry, transposed, axes: axes.map(|axis| axis as u8) }
    }

    /// Index of the pair of nodes in the [`NodePattern`].
    pub(crate) fn entry(self) -> usize {
        self.entry as usize
    }

    /// Index of the transposed pair.
    pub(crate) fn transposed(self) -> usize {
        self.transposed as usize
    }

    /// Axis of the row and of the column, in the block of `entry`.
    pub(crate) fn axes(self) -> [usize; 2] {
        self.axes.map(usize::from)
    }
}

/// Which entries X has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Coupling {
    /// The diagonal only, as for lumped inertia.
    Diagonal,
    /// Equal axes only, as for the inertia matrix.
    SameAxis,
    /// All axes of coupled nodes.
    AllAxes,
}
