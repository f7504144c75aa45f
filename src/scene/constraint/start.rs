//! Start of the constraints of a phase.

/// Origins of the rows of a phase.
pub(crate) struct PhaseStart<'a> {
    /// Time (s).
    pub(crate) time: f64,
    /// Displacements (m), in which nodes that the previous phase prescribed are
    /// [where they should be](super::prescribe).
    pub(crate) u: &'a [f64],
}
