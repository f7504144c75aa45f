//! Devices: components of a scene that are defined in one file, by this crate or by another one.
//!
//! A [`Device`] defines everything that the scene needs: its inputs, its outputs, its force, its image on a finer mesh and in a half, the lines
//! and needles by which it is drawn. Inputs are quantities as all others are (`input.rs`): phases and commands set them, tables and formulas of
//! time end steps at their breaks, statics scale them, checkpoints store them. Nothing else in the crate depends on a single device.

use std::any::Any;
use std::cell::OnceCell;
use std::fmt;
use std::sync::Arc;

use super::device_rows::{DeviceInput, DeviceOutput};
use super::input::InputSignal;
use super::phase::Phase;
use crate::base::input::InputError;
use crate::elements::body::{Body, MagnetizedPoints};
use crate::elements::force::Force;
use crate::elements::mesh::Selection;
use crate::scene::constraint::Axis;
use crate::scene::forces::{Magnet, Signal, Signals};

/// A component of a scene that exerts a force on its body, with inputs and outputs of its own: a jet, a fan, a gyroscope.
///
/// The trait is all that a program implements. [`Scene::device`](crate::Scene::device) adds the device to a scene; its
/// [inputs](DeviceInput) are then set by [`Phase::device_input`] and [`Simulation::device_input`](crate::Simulation::device_input), its
/// [outputs](DeviceOutput) are read by sensors ([`Reading::device`](crate::simulate::Reading::device)), and it is part of checkpoints, finer
/// meshes and pictures. A device that `serde` can read may have a table in scene files: see
/// [`DeviceTable`](crate::DeviceTable). The example `own_device` has all of it.
pub trait Device: Any + fmt::Debug + Send + Sync {
    /// The name by which phases, commands and sensors refer to it.
    fn name(&self) -> &str;

    /// Noun for devices of its kind in messages and lists. Default: "device".
    fn kind(&self) -> &'static str {
        "device"
    }

    /// The inputs that phases and commands set. Default: none.
    fn inputs(&self) -> &'static [DeviceInput] {
        &[]
    }

    /// Value of the input of a number (from 0) in phases that do not set it. Default: that of its [row](DeviceInput::absent).
    fn preset(&self, number: usize) -> Option<&DeviceValue> {
        let _ = number;
        None
    }

    /// The outputs that sensors read. Default: none.
    fn outputs(&self) -> &'static [DeviceOutput] {
        &[]
    }

    /// The force on the body at a `site`, driven by the values of the `inputs` in one phase.
    ///
    /// # Errors
    /// Nodes that do not exist, numbers out of range.
    fn force(
        &self,
        site: &DeviceSite<'_>,
        inputs: DeviceSignals,
    ) -> Result<Arc<dyn Force>, InputError>;

    /// The constraints that it puts on nodes of the body, row by row. Default: none.
    ///
    /// # Errors
    /// Nodes that do not exist, numbers out of range.
    fn rows(&self, site: &DeviceSite<'_>) -> Result<Vec<DeviceRow>, InputError> {
        let _ = site;
        Ok(Vec::new())
    }

    /// Checks the device at the start of a scene, `now`, before its force is evaluated. Default: nothing.
    ///
    /// # Errors
    /// Inputs by which the force has no meaning there.
    fn check_start(&self, site: &DeviceSite<'_>, now: &DeviceState<'_>) -> Result<(), InputError> {
        let _ = (site, now);
        Ok(())
    }

    /// The function that reads the output of a number (from 0), in the order of [`outputs`](Self::outputs), of the body in motion.
    /// Components beyond the dimension, or beyond the first one of a number, are not read. Default: 0.
    ///
    /// # Errors
    /// Nodes that do not exist.
    fn gauge(&self, number: usize, site: &DeviceSite<'_>) -> Result<DeviceGauge, InputError> {
        let _ = (number, site);
        Ok(Box::new(|_| [0.0; 3]))
    }

    /// The device on a finer mesh; `nodes` maps selections of nodes to that mesh.
    ///
    /// # Errors
    /// Default: finer meshes are not supported.
    fn on_finer_mesh(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        let _ = nodes;
        let help = "other meshes are not supported: implement Device::on_finer_mesh";
        Err(InputError::new("device", format!("\"{}\"", self.name()), help))
    }

    /// The device in the half of a scene to which it is symmetric ([`Scene::symmetric_half`](crate::Scene::symmetric_half)); `nodes` maps
    /// selections of nodes to the half, with an error for those that are not their own mirror images. Vector inputs have been checked to be parallel to the plane.
    ///
    /// # Errors
    /// Default: halves are not supported.
    fn in_half(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        let _ = nodes;
        let help = "it is not known to be its own mirror image, as of this crate wind is alone: leave the scene whole, or implement Device::in_half";
        Err(InputError::new(self.kind(), format!("\"{}\"", self.name()), help))
    }

    /// The lines by which pictures and animations show it: their two ends (m). Default: none.
    fn lines(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        let _ = now;
        Vec::new()
    }

    /// The needles by which they show it: bars of one size with two poles, by their middles (m) and directions; a dot without direction.
    /// As many at all times. Default: none.
    fn needles(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        let _ = now;
        Vec::new()
    }
}

/// The surroundings of a device in its scene.
pub struct DeviceSite<'a> {
    /// The body; all of them, joined into one, where there are several.
    pub body: &'a Body,
    magnets: &'a [Magnet],
    magnetized: OnceCell<Arc<[Box<dyn MagnetizedPoints>]>>,
}

impl<'a> DeviceSite<'a> {
    pub(super) fn new(body: &'a Body, magnets: &'a [Magnet]) -> Self {
        Self { body, magnets, magnetized: OnceCell::new() }
    }

    /// The magnetized points of the body; none without magnets.
    ///
    /// # Errors
    /// Cells that the body does not have.
    pub(crate) fn magnetized_points(&self) -> Result<Arc<[Box<dyn MagnetizedPoints>]>, InputError> {
        if let Some(known) = self.magnetized.get() {
            return Ok(known.clone());
        }
        let mut points = Vec::new();
        for (number, magnet) in (1..).zip(self.magnets) {
            magnet.add_points_to(self.body, number, &mut points)?;
        }
        Ok(self.magnetized.get_or_init(|| points.into()).clone())
    }
}

impl fmt::Debug for DeviceSite<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DeviceSite").field("body", &self.body).finish_non_exhaustive()
    }
}

/// A constraint sum c u = 0 on displacements: numbers of nodes (from 1), axes, and the coefficients c.
pub type DeviceRow = Vec<(usize, Axis, f64)>;

/// The function that reads an output of a device.
pub type DeviceGauge = Box<dyn Fn(&DeviceState<'_>) -> [f64; 3] + Send + Sync>;

/// The signals of the inputs of a device in one phase. Commands change their values.
#[derive(Debug, Clone)]
pub struct DeviceSignals {
    pub(super) inputs: &'static [DeviceInput],
    pub(super) dimension: usize,
    /// Of each input.
    pub(super) signals: Vec<Vec<InputSignal>>,
}

impl DeviceSignals {
    /// Whether the phase, or the device itself, has a value for one of the inputs.
    pub fn are_set(&self) -> bool {
        self.signals.iter().any(|own| !own.is_empty())
    }

    /// Whether there is a value for the input of a number (from 0).
    pub(crate) fn is_set(&self, number: usize) -> bool {
        self.signals.get(number).is_some_and(|own| !own.is_empty())
    }

    /// The value of the input of a number (from 0) at time `t` (s): the sum of the phase's signals for it. Components beyond its own
    /// are 0, and so is an input that the device does not have.
    pub fn at(&self, number: usize, t: f64) -> [f64; 3] {
        match (self.inputs.get(number), self.signals.get(number)) {
            (Some(input), Some(signals)) => sum(input, self.dimension, signals.iter(), t),
            _ => [0.0; 3],
        }
    }
}

/// A body in motion at one time, and the inputs of a device there.
#[derive(Debug, Clone, Copy)]
pub struct DeviceState<'a> {
    /// Time (s).
    pub time: f64,
    /// The body; all of them, joined into one, where there are several.
    pub body: &'a Body,
    /// Displacements (m), one component per dimension and node.
    pub u: &'a [f64],
    /// Velocities (m/s), likewise.
    pub v: &'a [f64],
    /// Multipliers of its [rows](Device::rows); not known without a sample.
    pub multipliers: Option<DeviceMultipliers<'a>>,
    pub(super) device: &'a dyn Device,
    pub(super) phase: &'a Phase,
}

/// Multipliers of the rows of a device.
#[derive(Debug, Clone, Copy)]
pub struct DeviceMultipliers<'a> {
    /// The number of each row among those in force; none of those that follow from others.
    pub(crate) rows: &'a [Option<usize>],
    pub(crate) all: &'a [f64],
}

impl<'a> DeviceMultipliers<'a> {
    /// The multipliers (N), row by row: 0 for redundant rows, NaN where they are not known, as at the start.
    pub fn iter(self) -> impl Iterator<Item = f64> + 'a {
        self.rows.iter().map(move |row| match row {
            None => 0.0,
            Some(row) => self.all.get(*row).copied().unwrap_or(f64::NAN),
        })
    }
}

impl DeviceState<'_> {
    /// The value of the input of a number (from 0), as of [`DeviceSignals::at`].
    pub fn input(&self, number: usize) -> [f64; 3] {
        let Some(input) = self.device.inputs().get(number) else { return [0.0; 3] };
        let signals = self.phase.device_signals(self.device, number);
        sum(input, self.body.dimension(), signals, self.time)
    }
}

/// The sum of the `signals` of an input at time `t` (s).
fn sum<'a>(
    input: &DeviceInput,
    dimension: usize,
    signals: impl Iterator<Item = &'a InputSignal>,
    t: f64,
) -> [f64; 3] {
    let rank = input.rank(dimension);
    let values = signals.map(|signal| {
        let mut own = [0.0; 3];
        match signal {
            InputSignal::Number(signal) => own[0] = signal.at(t),
            InputSignal::Vector(signal) => signal.at(t, &mut own[..rank]),
        }
        own
    });
    let sum = values.reduce(|a, b| std::array::from_fn(|i| a[i] + b[i]));
    sum.unwrap_or_else(|| std::array::from_fn(|i| if i < rank { input.absent } else { 0.0 }))
}

/// A value for an input of a device: a number or any other [`Signal`], or [`Signals`] for a vector.
#[derive(Clone)]
pub struct DeviceValue(pub(super) InputSignal);

impl fmt::Debug for DeviceValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl From<f64> for DeviceValue {
    fn from(value: f64) -> Self {
        Signal::from(value).into()
    }
}

impl From<Signal> for DeviceValue {
    fn from(signal: Signal) -> Self {
        Self(signal.into())
    }
}

impl From<Signals> for DeviceValue {
    fn from(signals: Signals) -> Self {
        Self(signals.0.into())
    }
}

impl<const D: usize> From<[f64; D]> for DeviceValue {
    fn from(vector: [f64; D]) -> Self {
        Signals::from(vector).into()
    }
}
