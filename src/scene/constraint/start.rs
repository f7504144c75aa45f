//! Where the constraints of a phase start.

/// Where the rows of a phase start from.
pub(crate) struct PhaseStart<'a> {
    /// Time (s).
    pub(crate) time: f64,
    /// Displacements (m), with what the phase before prescribed put [where it should be](super::prescribe).
    pub(crate) u: &'a [f64],
}
