//! Devices in a scene: their inputs in phases, their forces, their outputs and lines.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::device::{
    Device, DeviceGauge, DeviceRow, DeviceSignals, DeviceSite, DeviceState, DeviceValue,
};
use super::device_rows::DeviceInput;
use super::input::{Input, InputSignal, Quantity, Target};
use super::{Phase, Scene, taken};
use crate::base::input::{InputError, find, find_in};
use crate::elements::force::Forces;
use crate::scene::constraint::{Constrained, Constraint, ConstraintRow, Motion, held_pieces};

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
        let input = format!("output of device \"{}\"", device.name());
        find_in(device.kind(), word, words, &input, "outputs")
    }

    /// The name of one more device of a kind, where it is given none.
    pub(crate) fn next_device(&self, kind: &str, word: &str) -> String {
        let own = self.devices.iter().filter(|device| device.kind() == kind);
        format!("{word} {}", own.count() + 1)
    }

    pub(super) fn device_site(&self) -> DeviceSite<'_> {
        DeviceSite::new(&self.body, &self.magnets)
    }

    /// The rows of a device, by its number (from 0).
    ///
    /// # Errors
    /// Nodes that do not exist, numbers out of range.
    pub(crate) fn rows_of_device(&self, number: usize) -> Result<Vec<DeviceRow>, InputError> {
        self.devices[number].rows(&self.device_site())
    }

    /// The same by degrees of freedom, ascending, as rows in force have them.
    pub(crate) fn terms_of_device(
        &self,
        number: usize,
    ) -> Result<Vec<Vec<(usize, f64)>>, InputError> {
        let d = self.body.dimension();
        let by_dofs = |row: DeviceRow| {
            let terms = row.into_iter().map(|(node, axis, c)| ((node - 1) * d + axis.index(), c));
            let mut terms: Vec<(usize, f64)> = terms.collect();
            terms.sort_unstable_by_key(|&(dof, _)| dof);
            terms
        };
        Ok(self.rows_of_device(number)?.into_iter().map(by_dofs).collect())
    }

    /// Whether the device with a name has rows.
    pub(crate) fn joins(&self, name: &str) -> bool {
        let number = self.devices.iter().position(|device| device.name() == name);
        number.is_some_and(|number| self.rows_of_device(number).is_ok_and(|own| !own.is_empty()))
    }

    /// Checks that what a phase drives can move under its `rows`, at the displacements `u` (m).
    ///
    /// # Errors
    /// A joint that is driven, of which each node is held, or belongs to a rigid piece that is.
    pub(super) fn check_driven(
        &self,
        phase: &Phase,
        rows: &[ConstraintRow],
        u: &[f64],
    ) -> Result<(), InputError> {
        let is_driven = |device: &dyn Device| {
            (0..device.inputs().len())
                .any(|number| phase.device_signals(device, number).next().is_some())
        };
        let driven: Vec<_> =
            self.devices.iter().enumerate().filter(|(_, own)| is_driven(&***own)).collect();
        if driven.is_empty() {
            return Ok(());
        }
        let (d, pieces) = (self.body.dimension(), self.body.rigid_pieces());
        let held_pieces = pieces.map(|pieces| held_pieces(rows, (&self.body, pieces), u));
        let is_in_held_piece = |node: usize| {
            let Some((pieces, held)) = pieces.zip(held_pieces.as_ref()) else { return false };
            let frames = || pieces.frames().iter().zip(held);
            let is_held = |node| frames().any(|(frame, held)| *held && frame.contains(&node));
            pieces.contains(node) && pieces.shares(node).all(|(node, _)| is_held(node))
        };
        let held = |dof: usize| {
            rows.iter().any(|row| matches!(row.terms[..], [(own, _)] if own == dof))
                || is_in_held_piece(dof / d)
        };
        for (number, device) in driven {
            let own = self.terms_of_device(number)?;
            let mut dofs = own.iter().flatten().map(|(dof, _)| *dof);
            if !own.is_empty() && dofs.all(held) {
                let input =
                    format!("{} \"{}\" in phase \"{}\"", device.kind(), device.name(), phase.name);
                let help = "both of its sides are held there, so that nothing moves: hold one of them, or leave the command out";
                return Err(InputError::new(input, "driven", help));
            }
        }
        Ok(())
    }

    /// The constraints of all devices.
    pub(super) fn device_constraints(&self) -> Result<Vec<Constraint>, InputError> {
        let mut all = Vec::new();
        for number in 0..self.devices.len() {
            let rows = self.rows_of_device(number)?.into_iter().map(Constrained::Row);
            all.extend(rows.map(|what| Constraint { what, how: Motion::Together }));
        }
        Ok(all)
    }

    /// Checks the devices at the start, under these displacements and velocities.
    pub(super) fn check_devices_at_start(
        &self,
        phase: &Phase,
        motion: [&[f64]; 2],
    ) -> Result<(), InputError> {
        let site = self.device_site();
        self.devices.iter().try_for_each(|device| {
            device.check_start(&site, &self.device_state(&**device, phase, 0.0, motion))
        })
    }

    /// The same of the last one alone, where no phase drives it.
    pub(crate) fn check_last_device_undriven(&self) -> Result<(), InputError> {
        let Some(device) = self.devices.last() else { return Ok(()) };
        let (u, v) = (self.initial_displacements(), self.initial_velocities()?);
        let phase = Phase::until(1.0);
        device.check_start(&self.device_site(), &self.device_state(&**device, &phase, 0.0, [u, &v]))
    }

    /// The functions that read the outputs of each device.
    pub(crate) fn device_gauges(&self) -> Result<Vec<Vec<DeviceGauge>>, InputError> {
        let site = self.device_site();
        let of_device = |device: &Arc<dyn Device>| {
            let outputs = 0..device.outputs().len();
            outputs.map(|number| device.gauge(number, &site)).collect()
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
        let owner = &self.devices[self.device_number(device, "input of device")?];
        let (kind, inputs) = (owner.kind(), owner.inputs());
        let words = inputs.iter().map(|input| input.word);
        let input = format!("input of device \"{device}\"");
        Ok(&inputs[find_in(kind, word, words, &input, "inputs")?])
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
        DeviceState { time, body: &self.body, u, v, multipliers: None, device, phase }
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

    /// The needles by which devices are drawn: their middles (m) and directions.
    #[cfg(feature = "output")]
    pub(crate) fn device_needles(
        &self,
        phase: &Phase,
        time: f64,
        [u, v]: [&[f64]; 2],
    ) -> Vec<[[f64; 3]; 2]> {
        let needles = |device: &Arc<dyn Device>| {
            device.needles(&self.device_state(&**device, phase, time, [u, v]))
        };
        self.devices.iter().flat_map(needles).collect()
    }

    /// The presets of devices that are in force in `phase`.
    pub(crate) fn presets_in(&self, phase: &Phase) -> Vec<Input> {
        let of_device = |device: &Arc<dyn Device>| {
            let own = device.inputs().iter().enumerate().filter_map(|(number, row)| {
                let (quantity, target) = (Quantity::Device(row), Target::one(device.name()));
                let is_set = phase.inputs_on(quantity, &target).next().is_some();
                let preset = device.preset(number).filter(|_| !is_set)?;
                Some(Input::new(quantity, target, preset.0.clone()))
            });
            own.collect::<Vec<_>>()
        };
        self.devices.iter().flat_map(of_device).collect()
    }

    /// The forces of all devices.
    ///
    /// # Errors
    /// Names that are taken; inputs that no device has, or that do not fit.
    pub(crate) fn device_forces(&self, phase: &Phase) -> Result<Forces, InputError> {
        let mut names = BTreeSet::new();
        if let Some(device) = self.devices.iter().find(|device| !names.insert(device.name())) {
            return Err(taken(device.kind(), device.name()));
        }
        for input in &phase.inputs {
            let Quantity::Device(own) = input.quantity else { continue };
            let names = || self.devices.iter().map(|device| device.name());
            for name in input.target.names() {
                let [_, of] = own.keys;
                find(name, names(), &format!("{of} of phase \"{}\"", phase.name), "devices")?;
                self.device_row(name, own.word)?;
            }
            self.check_device_input(input)?;
        }
        self.presets_in(phase).iter().try_for_each(|preset| self.check_device_input(preset))?;
        let (site, dimension) = (self.device_site(), self.body.dimension());
        let force = |device: &Arc<dyn Device>| {
            let inputs = device.inputs();
            let own = |number| phase.device_signals(&**device, number).cloned().collect();
            let signals = (0..inputs.len()).map(own);
            device.force(&site, DeviceSignals { inputs, dimension, signals: signals.collect() })
        };
        self.devices.iter().map(force).collect()
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

    /// The signals of the input of a number of a `device`, or else its preset.
    pub(super) fn device_signals<'a>(
        &'a self,
        device: &'a dyn Device,
        number: usize,
    ) -> impl Iterator<Item = &'a InputSignal> {
        let row = device.inputs().get(number);
        let own = self.inputs.iter().filter(move |input| {
            matches!(input.quantity, Quantity::Device(own) if row == Some(own))
                && input.target.names().iter().any(|name| name == device.name())
        });
        let preset = device.preset(number).filter(|_| own.clone().next().is_none());
        own.map(|input| &input.signal).chain(preset.map(|preset| &preset.0))
    }
}
