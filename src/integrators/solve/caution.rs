//! Steps that are examined more closely.

/// Steps that may have passed a switch.
#[derive(Debug, Default)]
pub(super) struct Caution {
    pub(super) failures: u64,
    /// Size of the last step, and that to which steps have to grow again after a failure.
    pub(super) last: f64,
    pub(super) until: f64,
    /// Whether they have not yet.
    pub(super) is_on: bool,
}

impl Caution {
    /// Whether the last step is so short that its polynomial has no accurate derivatives.
    pub(super) fn is_short(&self) -> bool {
        self.is_on && self.last < 0.01 * self.until
    }
}
