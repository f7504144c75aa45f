//! Rows of the inputs and outputs of devices.

use std::fmt;

/// An input of a [`Device`](crate::Device), one row of its list.
#[derive(Clone, Copy)]
pub struct DeviceInput {
    /// The word by which phases and commands refer to it.
    pub word: &'static str,
    /// Unit of its values; "1" without one.
    pub unit: &'static str,
    /// Whether it has one component per dimension of the body.
    pub is_vector: bool,
    /// Each component where neither a phase nor the [device](crate::Device::preset) has a value.
    pub absent: f64,
    /// Whether statics scales it by the load factor, as a force; an angle or a position applies in full at once.
    pub is_scaled: bool,
    /// Limit beyond which the units of a value are warned of, if any.
    pub limit: Option<InputLimit>,
    /// Keys of its list in a phase of a scene file, and of the device in it.
    #[doc(hidden)]
    pub keys: [&'static str; 2],
}

/// The largest usual size of an input: a larger one is an [indicator](crate::Scene::indicators) that warns.
#[derive(Debug, Clone, Copy)]
pub struct InputLimit {
    /// Name of the indicator.
    pub name: &'static str,
    /// The input as a noun phrase.
    pub about: &'static str,
    /// The limit, in the unit of the input.
    pub most: f64,
    /// Question that helps to find the mistake.
    pub help: &'static str,
}

/// Keys of inputs without keys of their own: such an input stands by its word.
pub(crate) const STEER: [&str; 2] = ["steer", "device"];

/// An output of a [`Device`](crate::Device), one row of its list.
#[derive(Debug, Clone, Copy)]
pub struct DeviceOutput {
    /// The word by which sensors refer to it.
    pub word: &'static str,
    /// Unit of its values; "1" without one.
    pub unit: &'static str,
    /// Whether it has one component per dimension of the body.
    pub is_vector: bool,
}

impl DeviceInput {
    /// A number, 0 where a phase does not set it, that statics scales.
    pub const fn number(word: &'static str, unit: &'static str) -> Self {
        let (limit, keys) = (None, STEER);
        Self { word, unit, is_vector: false, absent: 0.0, is_scaled: true, limit, keys }
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
    /// Whether it is an angle, which sensors follow over whole turns.
    pub(crate) fn is_angle(&self) -> bool {
        self.unit == "rad" && !self.is_vector
    }

    /// Number of components on a body of this `dimension`.
    pub(crate) const fn rank(&self, dimension: usize) -> usize {
        if self.is_vector { dimension } else { 1 }
    }
}

/// The word alone, which identifies it in files of checkpoints.
impl fmt::Debug for DeviceInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word)
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
