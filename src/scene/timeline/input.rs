//! Inputs: the quantities of components that phases prescribe, and that commands and sliders set.
//!
//! All inputs of a phase stand in one list, and each quantity is one row of [`Quantity::row`]: its keys in scene files, its unit, its
//! change with the load factor. Times at which signals change their laws, commands, checkpoints, saved scenes and sliders go by that
//! list. A force reads the signals of its quantity; a new quantity is a variant with its row.

use std::fmt;
use std::sync::Arc;

use super::device_rows::DeviceInput;
use crate::base::input::InputError;
use crate::elements::body::Body;
use crate::elements::force::Force;
use crate::elements::mesh::Selection;
use crate::scene::forces::{
    SharedValue, Signal, SignalKind, VectorSignal, WrenchForce, WrenchKind,
};

/// A quantity that phases prescribe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum Quantity {
    /// The force of a spring, tension of a cable, length of a winch, stress of a muscle, strain of a growth, or heating power.
    Actuation,
    /// Of a chamber.
    Pressure,
    /// Of an orifice.
    Opening,
    /// Of liquid into a chamber.
    Flow,
    /// On the faces between nodes.
    FacePressure,
    /// On nodes.
    Load(LoadKind),
    /// On nodes together.
    Wrench(WrenchKind),
    /// The uniform part of the magnetic field.
    Field,
    /// Of a device, which has the row.
    #[cfg_attr(feature = "checkpoint", serde(skip))]
    Device(&'static DeviceInput),
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

impl LoadKind {
    #[cfg(feature = "play")]
    pub(crate) const ALL: [Self; 3] = [Self::Each, Self::Total, Self::Traction];
}

/// Facts about a quantity.
pub(crate) struct Row {
    /// Noun phrase that stands before its target.
    pub(crate) name: &'static str,
    /// Key of its list in a phase of a scene file, and of the target in it.
    pub(crate) keys: [&'static str; 2],
    /// Key of its value; with an "s" that of values at times.
    pub(crate) word: &'static str,
    pub(crate) unit: &'static str,
    /// Value where a phase has none.
    pub(crate) absent: f64,
    /// Whether statics scale it by the load factor; otherwise the signal stays as it is.
    pub(super) scales: bool,
    /// The force of a vector on nodes that needs no more than these; others are built with their like.
    pub(super) on_nodes: Option<BuildOnNodes>,
}

type BuildOnNodes = fn(&Body, &Selection, &VectorSignal) -> Result<Arc<dyn Force>, InputError>;

impl Quantity {
    /// Vectors on nodes, in the order in which a scene file reads them.
    #[cfg(feature = "scene-file")]
    pub(crate) const ON_NODES: [Self; 6] = [
        Self::Load(LoadKind::Each),
        Self::Load(LoadKind::Total),
        Self::Load(LoadKind::Traction),
        Self::Wrench(WrenchKind::Moment),
        Self::Wrench(WrenchKind::FollowerForce),
        Self::Wrench(WrenchKind::FollowerMoment),
    ];

    pub(crate) const fn row(self) -> Row {
        const fn row(
            name: &'static str,
            keys: [&'static str; 2],
            word: &'static str,
            unit: &'static str,
        ) -> Row {
            Row { name, keys, word, unit, absent: 0.0, scales: true, on_nodes: None }
        }
        match self {
            Self::Actuation => row("actuation of", ["actuate", "springs"], "force", "N"),
            Self::Pressure => row("pressure of chamber", ["pressure", "chamber"], "value", "Pa"),
            Self::Opening => Row {
                absent: 1.0,
                scales: false,
                ..row("opening of orifice", ["open", "orifice"], "opening", "")
            },
            Self::Flow => Row {
                scales: false,
                ..row("flow into chamber", ["flow", "chamber"], "rate", "m^3/s")
            },
            Self::FacePressure => row("pressure on", ["pressure_on", "nodes"], "value", "Pa"),
            Self::Load(kind) => {
                let (word, unit) = match kind {
                    LoadKind::Each => ("force", "N"),
                    LoadKind::Total => ("total", "N"),
                    LoadKind::Traction => ("traction", "Pa"),
                };
                row("load on", ["load", "nodes"], word, unit)
            }
            Self::Wrench(WrenchKind::Moment) => Row {
                on_nodes: Some(|body, nodes, value| {
                    WrenchForce::build(body, WrenchKind::Moment, nodes, value)
                }),
                ..row("moment on", ["moment", "nodes"], "moment", "N m")
            },
            Self::Wrench(WrenchKind::FollowerForce) => Row {
                on_nodes: Some(|body, nodes, value| {
                    WrenchForce::build(body, WrenchKind::FollowerForce, nodes, value)
                }),
                ..row("follower force on", ["follower", "nodes"], "force", "N")
            },
            Self::Wrench(WrenchKind::FollowerMoment) => Row {
                on_nodes: Some(|body, nodes, value| {
                    WrenchForce::build(body, WrenchKind::FollowerMoment, nodes, value)
                }),
                ..row("follower moment on", ["follower", "nodes"], "moment", "N m")
            },
            Self::Field => row("magnetic field", ["magnetic_field", ""], "field", "T"),
            Self::Device(&DeviceInput { word, unit, absent, is_scaled, keys, .. }) => {
                Row { absent, scales: is_scaled, ..row(word, keys, word, unit) }
            }
        }
    }

    /// The quantity and a target in words.
    pub(crate) fn of(self, target: &Target) -> String {
        let name = self.row().name;
        match target {
            Target::Named(names) => {
                let names = names.join("\", \"");
                match self {
                    Self::Device(input) => format!("{name} of {} \"{names}\"", input.keys[1]),
                    _ => format!("{name} \"{names}\""),
                }
            }
            Target::Nodes(nodes) => format!("{name} {nodes}"),
            Target::Everything => name.into(),
        }
    }

    /// Number of components of its value in space of a `dimension`.
    pub(crate) fn rank(self, dimension: usize) -> usize {
        match self {
            Self::Load(_) | Self::Field => dimension,
            Self::Wrench(kind) => kind.rank(dimension),
            Self::Device(input) => input.rank(dimension),
            Self::Actuation | Self::Pressure | Self::Opening | Self::Flow => 1,
            Self::FacePressure => 1,
        }
    }

    /// Whether it is the force of a vector on nodes together.
    #[cfg(feature = "play")]
    pub(crate) fn is_force_on_nodes(self) -> bool {
        self.row().on_nodes.is_some()
    }

    /// Whether halves and sections have it by what their nodes and components are of those of the whole.
    pub(super) fn is_known_of_parts(self) -> bool {
        matches!(
            self,
            Self::FacePressure
                | Self::Load(_)
                | Self::Actuation
                | Self::Pressure
                | Self::Opening
                | Self::Flow
        )
    }

    /// Whether a command for it replaces `other` on the same target: a load replaces loads of all kinds.
    pub(super) fn replaces(self, other: Self) -> bool {
        self == other || matches!((self, other), (Self::Load(_), Self::Load(_)))
    }
}

/// The target of an input.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub(crate) enum Target {
    /// Components, by their names; each has the whole value.
    Named(Vec<String>),
    Nodes(Selection),
    Everything,
}

impl Target {
    /// The component with a name.
    pub(crate) fn one(name: impl Into<String>) -> Self {
        Self::Named(vec![name.into()])
    }

    /// Its components, each by itself.
    pub(super) fn each(&self) -> Vec<Self> {
        match self {
            Self::Named(names) => names.iter().map(Self::one).collect(),
            Self::Nodes(_) | Self::Everything => vec![self.clone()],
        }
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Named(own), Self::Named(other)) => own.iter().any(|name| other.contains(name)),
            _ => self == other,
        }
    }

    pub(crate) fn names(&self) -> &[String] {
        match self {
            Self::Named(names) => names,
            Self::Nodes(_) | Self::Everything => &[],
        }
    }

    pub(super) fn nodes(&self) -> Option<&Selection> {
        match self {
            Self::Nodes(nodes) => Some(nodes),
            Self::Named(_) | Self::Everything => None,
        }
    }
}

/// The signal of an input, of one component or of one per dimension.
#[derive(Clone)]
pub(crate) enum InputSignal {
    Number(Signal),
    Vector(VectorSignal),
}

impl InputSignal {
    /// Times (s) at which it changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        match self {
            Self::Number(signal) => signal.breaks(),
            Self::Vector(signal) => signal.breaks(),
        }
    }

    /// Its components at time `t` (s), as many as the `rank` of its quantity.
    pub(crate) fn components(&self, t: f64, rank: usize) -> Vec<f64> {
        match self {
            Self::Number(signal) => vec![signal.at(t)],
            Self::Vector(signal) => signal.components(t, rank),
        }
    }

    /// The values of a constant.
    pub(crate) fn constant(&self) -> Option<&[f64]> {
        match self {
            Self::Number(Signal(SignalKind::Constant(value))) => Some(std::slice::from_ref(value)),
            Self::Vector(VectorSignal::Constant(values)) => Some(values),
            Self::Number(_) | Self::Vector(_) => None,
        }
    }

    pub(super) fn live(&self) -> Option<&SharedValue> {
        match self {
            Self::Number(signal) => signal.live(),
            Self::Vector(signal) => signal.live(),
        }
    }

    /// The same signal; a constant becomes numbers that a command can set.
    pub(crate) fn settable(self) -> Self {
        match self {
            Self::Number(signal) => Self::Number(signal.settable()),
            Self::Vector(signal) => Self::Vector(signal.settable()),
        }
    }

    pub(super) fn snapshot(&self) -> Self {
        match self {
            Self::Number(signal) => Self::Number(signal.snapshot()),
            Self::Vector(signal) => Self::Vector(signal.snapshot()),
        }
    }

    /// A constant: a `fraction` of its value at time `t` (s).
    pub(super) fn at_rest(&self, fraction: f64, t: f64, rank: usize) -> Self {
        match self {
            Self::Number(signal) => Self::Number(Signal::constant(fraction * signal.at(t))),
            Self::Vector(signal) => {
                let value = signal.components(t, rank);
                let part = value.iter().map(|x| fraction * x).collect();
                Self::Vector(VectorSignal::Constant(part))
            }
        }
    }
}

impl fmt::Debug for InputSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(signal) => signal.fmt(f),
            Self::Vector(signal) => signal.fmt(f),
        }
    }
}

impl From<Signal> for InputSignal {
    fn from(signal: Signal) -> Self {
        Self::Number(signal)
    }
}

impl From<VectorSignal> for InputSignal {
    fn from(signal: VectorSignal) -> Self {
        Self::Vector(signal)
    }
}

/// A quantity that a phase prescribes, with its target. Signals on the same target add up.
#[derive(Debug, Clone)]
pub(crate) struct Input {
    pub(crate) quantity: Quantity,
    pub(crate) target: Target,
    pub(crate) signal: InputSignal,
}

impl Input {
    pub(crate) fn new(quantity: Quantity, target: Target, signal: impl Into<InputSignal>) -> Self {
        Self { quantity, target, signal: signal.into() }
    }

    /// A load on nodes.
    pub(crate) fn load(nodes: Selection, kind: LoadKind, value: VectorSignal) -> Self {
        Self::new(Quantity::Load(kind), Target::Nodes(nodes), value)
    }
}
