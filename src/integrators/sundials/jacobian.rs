//! Sources of a Jacobian.

/// Source of the entries of a Jacobian, or of its products with vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Jacobian {
    /// Difference quotients of the right-hand side or residual: n extra evaluations for a dense
    /// matrix, `lower + upper + 1` for a band, and for a sparse matrix one for each colour of its columns:
    /// those that share no row have the same colour and are shifted at once. A product takes one.
    ///
    /// For a right-hand side, the shifts depend on the size of each unknown (its value, plus atol / rtol,
    /// below which it is noise) and on the effect of the last shift; if that was below round-off, one more
    /// evaluation with a larger shift is made.
    DifferenceQuotients,
    /// The system's own `dense_jacobian`, `banded_jacobian`, `sparse_jacobian` or `jacobian_times`.
    Supplied,
}
