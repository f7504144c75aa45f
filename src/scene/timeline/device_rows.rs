//! Rows of the inputs and outputs of devices.

/// An input of a [`Device`](crate::Device), one row of its list.
#[derive(Debug, Clone, Copy)]
pub struct DeviceInput {
    /// The word by which phases and commands know it.
    pub word: &'static str,
    /// Unit of its values; "1" without one.
    pub unit: &'static str,
    /// Whether it has one component per dimension of the body.
    pub is_vector: bool,
    /// Each component where a phase does not set it.
    pub absent: f64,
    /// Whether statics brings it on by load steps, as a force; an angle or a place is what it is at once.
    pub is_scaled: bool,
}

/// An output of a [`Device`](crate::Device), one row of its list.
#[derive(Debug, Clone, Copy)]
pub struct DeviceOutput {
    /// The word by which sensors know it.
    pub word: &'static str,
    /// Unit of its values; "1" without one.
    pub unit: &'static str,
    /// Whether it has one component per dimension of the body.
    pub is_vector: bool,
}

impl DeviceInput {
    /// A number, 0 where a phase does not set it, that statics scales.
    pub const fn number(word: &'static str, unit: &'static str) -> Self {
        Self { word, unit, is_vector: false, absent: 0.0, is_scaled: true }
    }

    /// A vector, likewise.
    pub const fn vector(word: &'static str, unit: &'static str) -> Self {
        Self { is_vector: true, ..Self::number(word, unit) }
    }

    /// Number of components on a body of this `dimension`.
    pub(crate) const fn rank(&self, dimension: usize) -> usize {
        if self.is_vector { dimension } else { 1 }
    }
}

impl DeviceOutput {
    /// Number of components on a body of this `dimension`.
    pub(crate) const fn rank(&self, dimension: usize) -> usize {
        if self.is_vector { dimension } else { 1 }
    }
}

impl PartialEq for DeviceInput {
    fn eq(&self, other: &Self) -> bool {
        self.word == other.word
    }
}

impl Eq for DeviceInput {}

impl PartialEq for DeviceOutput {
    fn eq(&self, other: &Self) -> bool {
        self.word == other.word
    }
}
