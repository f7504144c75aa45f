//! Loads: forces on nodes, or tractions on the faces between them.

use crate::base::input::InputError;
use crate::scene::forces::VectorSignal;

/// A load on some nodes.
#[derive(Debug, Clone)]
pub(crate) struct Load {
    pub(crate) kind: LoadKind,
    pub(crate) value: VectorSignal,
}

/// Reference of the value of a load: each node, all nodes together, or undeformed area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum LoadKind {
    /// A force (N) on each node.
    #[cfg_attr(feature = "checkpoint", serde(rename = "force"))]
    Each,
    /// A force (N) on all nodes together.
    Total,
    /// A force per undeformed area (N/m^2) of the faces between the nodes.
    Traction,
}

#[cfg(feature = "scene-file")]
impl LoadKind {
    pub(crate) const ALL: [Self; 3] = [Self::Each, Self::Total, Self::Traction];

    /// Its word in files.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Each => "force",
            Self::Total => "total",
            Self::Traction => "traction",
        }
    }
}

impl Load {
    /// The same force (N) on each node.
    pub(crate) fn each(value: VectorSignal) -> Self {
        Self { kind: LoadKind::Each, value }
    }

    /// Checks what can be known beforehand.
    pub(super) fn validate(&self, dimension: usize) -> Result<(), InputError> {
        let (one, varying, unit) = match self.kind {
            LoadKind::Each | LoadKind::Total => ("load", "a load", "N"),
            LoadKind::Traction => ("traction", "a traction", "N/m^2"),
        };
        let is_constant = matches!(self.value, VectorSignal::Constant(_));
        self.value.validate(if is_constant { one } else { varying }, dimension, unit)
    }
}
