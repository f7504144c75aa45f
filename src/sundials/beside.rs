//! What CVODES and IDAS carry beside the state.

use super::vector::Vector;

/// Integrals at the present time.
pub(super) struct Quadratures {
    pub(super) values: Vector,
    /// As many numbers, for others than the present ones.
    pub(super) scratch: Vector,
}
