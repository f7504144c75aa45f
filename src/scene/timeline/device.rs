//! Devices: parts of a scene that are defined in one place, by this crate or by another one.
//!
//! A [`Device`] says all that the scene has to know of it: its inputs, its outputs, its force, what it is on a finer mesh, the lines
//! by which it is drawn. Inputs are quantities as all others are (`input.rs`): phases and commands set them, tables and formulas of
//! time end steps at their breaks, statics scale them, checkpoints hold them. Nothing else in the crate knows of a single device.

use std::fmt;
use std::sync::Arc;

use super::input::{Input, InputSignal, Quantity, Target};
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::elements::body::Body;
use crate::elements::force::{Force, Forces};
use crate::elements::mesh::Selection;
use crate::scene::forces::{Signal, Signals};

/// A part of a scene that exerts a force on its body, with inputs and outputs of its own: a jet, a fan, a gyroscope.
///
/// The trait is all that a program implements. A scene that has the device by [`Scene::device`] then takes
/// [inputs](DeviceInput) by [`Phase::device_input`] and [`Simulation::device_input`](crate::Simulation::device_input), gives
/// [outputs](DeviceOutput) to sensors ([`Reading::device`](crate::Reading::device)), has it in checkpoints and on finer
/// meshes, and draws it in pictures. Scene files have a table for a device that `serde` can read: see
/// [`DeviceTable`](crate::DeviceTable). The example `own_device` has all of it.
pub trait Device: fmt::Debug + Send + Sync {
    /// The name by which phases, commands and sensors know it.
    fn name(&self) -> &str;

    /// The inputs that phases and commands set. Default: none.
    fn inputs(&self) -> &'static [DeviceInput] {
        &[]
    }

    /// The outputs that sensors read. Default: none.
    fn outputs(&self) -> &'static [DeviceOutput] {
        &[]
    }

    /// The force on `body`, driven by the values of the `inputs` in one phase.
    ///
    /// # Errors
    /// Nodes that do not exist, numbers out of range.
    fn force(&self, body: &Body, inputs: DeviceSignals) -> Result<Arc<dyn Force>, InputError>;

    /// The function that reads the output of a number (from 0), in the order of [`outputs`](Self::outputs), of `body` in motion.
    /// Components beyond the dimension, or beyond the first one of a number, are not read. Default: 0.
    ///
    /// # Errors
    /// Nodes that do not exist.
    fn gauge(&self, number: usize, body: &Body) -> Result<DeviceGauge, InputError> {
        let _ = (number, body);
        Ok(Box::new(|_| [0.0; 3]))
    }

    /// The device on a finer mesh, where `nodes` are what selections of nodes become.
    ///
    /// # Errors
    /// Default: the device does not know what it is there.
    fn on_finer_mesh(
        &self,
        nodes: &dyn Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Arc<dyn Device>, InputError> {
        let _ = nodes;
        let help = "it does not say what it is on another mesh: implement Device::on_finer_mesh";
        Err(InputError::new("device", format!("\"{}\"", self.name()), help))
    }

    /// The lines by which pictures and animations show it: their two ends (m). Default: none.
    fn lines(&self, now: &DeviceState<'_>) -> Vec<[[f64; 3]; 2]> {
        let _ = now;
        Vec::new()
    }
}

/// The function that reads an output of a device.
pub type DeviceGauge = Box<dyn Fn(&DeviceState<'_>) -> [f64; 3] + Send + Sync>;

/// An input of a [`Device`], one row of its list.
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

/// An output of a [`Device`], one row of its list.
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

/// The signals of the inputs of a device in one phase. Commands change their values.
#[derive(Debug, Clone)]
pub struct DeviceSignals {
    inputs: &'static [DeviceInput],
    dimension: usize,
    signals: Vec<Vec<InputSignal>>,
}

impl DeviceSignals {
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
    device: &'a dyn Device,
    phase: &'a Phase,
}

impl DeviceState<'_> {
    /// The value of the input of a number (from 0), as of [`DeviceSignals::at`].
    pub fn input(&self, number: usize) -> [f64; 3] {
        let Some(input) = self.device.inputs().get(number) else { return [0.0; 3] };
        let signals = self.phase.device_signals(self.device.name(), input);
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
    let rank = if input.is_vector { dimension } else { 1 };
    let (mut sum, mut is_set) = ([0.0; 3], false);
    for signal in signals {
        is_set = true;
        let mut own = [0.0; 3];
        match signal {
            InputSignal::Number(signal) => own[0] = signal.at(t),
            InputSignal::Vector(signal) => signal.at(t, &mut own[..rank]),
        }
        (0..rank).for_each(|i| sum[i] += own[i]);
    }
    if !is_set {
        sum[..rank].fill(input.absent);
    }
    sum
}

/// A value for an input of a device: a number or any other [`Signal`], or [`Signals`] for a vector.
#[derive(Debug, Clone)]
pub struct DeviceValue(InputSignal);

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

impl Scene {
    /// Adds a device, which acts in all phases.
    pub fn device(self, device: impl Device + 'static) -> Self {
        self.shared_device(Arc::new(device))
    }

    pub(crate) fn shared_device(mut self, device: Arc<dyn Device>) -> Self {
        self.devices.push(device);
        self
    }

    /// The devices.
    pub fn devices(&self) -> &[Arc<dyn Device>] {
        &self.devices
    }

    /// The number (from 0) of the device with a name; `input` is where that was given.
    pub(crate) fn device_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.devices.iter().map(|device| device.name()), input, "devices")
    }

    /// The number (from 0) of an output of a device, by the word of the one and the number of the other.
    pub(crate) fn output_number(&self, device: usize, word: &str) -> Result<usize, InputError> {
        let device = &self.devices[device];
        let words = device.outputs().iter().map(|output| output.word);
        find(word, words, &format!("output of device \"{}\"", device.name()), "outputs")
    }

    /// The functions that read the outputs of each device.
    pub(crate) fn device_gauges(&self) -> Result<Vec<Vec<DeviceGauge>>, InputError> {
        let of_device = |device: &Arc<dyn Device>| {
            let outputs = 0..device.outputs().len();
            outputs.map(|number| device.gauge(number, &self.body)).collect()
        };
        self.devices.iter().map(of_device).collect()
    }

    /// An input of a device, by the name of the one and the word of the other.
    ///
    /// # Errors
    /// A name that no device has, a word that none of its inputs has, a value of another rank, numbers that are not finite.
    pub(crate) fn device_input(
        &self,
        device: &str,
        word: &str,
        value: DeviceValue,
    ) -> Result<Input, InputError> {
        let quantity = Quantity::Device(self.device_row(device, word)?);
        let input = Input::new(quantity, Target::one(device), value.0);
        self.check_device_input(&input)?;
        Ok(input)
    }

    /// The row of an input of a device.
    ///
    /// # Errors
    /// A name that no device has, a word that none of its inputs has.
    pub(crate) fn device_row(
        &self,
        device: &str,
        word: &str,
    ) -> Result<&'static DeviceInput, InputError> {
        let inputs = self.devices[self.device_number(device, "input of device")?].inputs();
        let words = inputs.iter().map(|input| input.word);
        Ok(&inputs[find(word, words, &format!("input of device \"{device}\""), "inputs")?])
    }

    /// Whether the signal fits the input.
    fn check_device_input(&self, input: &Input) -> Result<(), InputError> {
        let Input { quantity, target, signal } = input;
        let (name, dimension, row) = (quantity.of(target), self.body.dimension(), quantity.row());
        match (signal, quantity) {
            (InputSignal::Vector(signal), Quantity::Device(own)) if own.is_vector => {
                signal.validate(&name, dimension, row.unit)
            }
            (InputSignal::Number(signal), Quantity::Device(own)) if !own.is_vector => {
                signal.validate(&name)
            }
            (_, Quantity::Device(own)) => {
                let needed = if own.is_vector { dimension } else { 1 };
                let help = format!("it needs {needed} component(s) ({})", row.unit);
                Err(InputError::new(name, "a value of another rank", help))
            }
            _ => Ok(()),
        }
    }

    /// A state of the body for the device, in `phase`.
    pub(crate) fn device_state<'a>(
        &'a self,
        device: &'a dyn Device,
        phase: &'a Phase,
        time: f64,
        [u, v]: [&'a [f64]; 2],
    ) -> DeviceState<'a> {
        DeviceState { time, body: &self.body, u, v, device, phase }
    }

    /// The lines by which devices are drawn (m).
    #[cfg(feature = "output")]
    pub(crate) fn device_lines(
        &self,
        phase: &Phase,
        time: f64,
        [u, v]: [&[f64]; 2],
    ) -> Vec<[[f64; 3]; 2]> {
        let lines = |device: &Arc<dyn Device>| {
            device.lines(&self.device_state(&**device, phase, time, [u, v]))
        };
        self.devices.iter().flat_map(lines).collect()
    }

    /// Adds the forces of all devices.
    ///
    /// # Errors
    /// Names that are taken; inputs that no device has, or that do not fit.
    pub(super) fn add_devices(&self, phase: &Phase, forces: &mut Forces) -> Result<(), InputError> {
        unique("device", self.devices.iter().map(|device| device.name()))?;
        for input in &phase.inputs {
            if let Quantity::Device(own) = input.quantity {
                for name in input.target.names() {
                    self.device_row(name, own.word)?;
                }
                self.check_device_input(input)?;
            }
        }
        for device in &self.devices {
            let inputs = device.inputs();
            let own = |input| phase.device_signals(device.name(), input).cloned().collect();
            let (signals, dimension) = (inputs.iter().map(own).collect(), self.body.dimension());
            let signals = DeviceSignals { inputs, dimension, signals };
            forces.push(device.force(&self.body, signals)?);
        }
        Ok(())
    }
}

impl Phase {
    /// A value for an `input` of the [device](Device) with a name. Several add up.
    pub fn device_input(
        self,
        device: impl Into<String>,
        input: &'static DeviceInput,
        value: impl Into<DeviceValue>,
    ) -> Self {
        self.with(Input::new(Quantity::Device(input), Target::one(device), value.into().0))
    }

    /// The signals of an input of the device with a `name`.
    fn device_signals<'a>(
        &'a self,
        name: &'a str,
        input: &'a DeviceInput,
    ) -> impl Iterator<Item = &'a InputSignal> {
        let own = self.inputs.iter().filter(move |other| {
            matches!(other.quantity, Quantity::Device(row) if row == input)
                && other.target.names().iter().any(|own| own == name)
        });
        own.map(|input| &input.signal)
    }
}
