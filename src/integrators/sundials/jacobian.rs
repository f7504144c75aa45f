//! Where a Jacobian comes from.

/// Where the entries of a Jacobian, or its products with vectors, come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Jacobian {
    /// Difference quotients of the right-hand side or residual: n extra evaluations for a dense
    /// matrix, `lower + upper + 1` for a band, and for a sparse matrix one for each colour of its columns:
    /// those that share no row have the same colour and are shifted at once. A product takes one.
    ///
    /// Those of a right-hand side follow the size of each unknown, its own or that below which it is noise, atol / rtol, and what the last shift has
    /// changed; where that was lost in rounding, one more evaluation shifts farther.
    DifferenceQuotients,
    /// The system's own `dense_jacobian`, `banded_jacobian`, `sparse_jacobian` or `jacobian_times`.
    Supplied,
}
