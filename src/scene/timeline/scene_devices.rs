//! Devices in a scene: their inputs in phases, their forces, their outputs and lines.

use std::sync::Arc;

use super::device::{Device, DeviceGauge, DeviceSignals, DeviceState, DeviceValue};
use super::device_rows::DeviceInput;
use super::input::{Input, InputSignal, Quantity, Target};
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::elements::force::Forces;

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
                let needed = own.rank(dimension);
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
    pub(super) fn device_signals<'a>(
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
