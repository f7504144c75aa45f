//! Outputs of devices, which have their rows.

use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::scene::timeline::{DeviceMultipliers, DeviceOutput};

impl View<'_> {
    /// An output of a [device](crate::Device), by the name of the device and the word of the output.
    ///
    /// # Errors
    /// A name that no device has, a word that none of its outputs has.
    pub fn device(&self, device: &str, output: &str) -> Result<Vec<f64>, InputError> {
        let number = self.scene.device_number(device, "device")?;
        let own = self.scene.output_number(number, output)?;
        let output = &self.scene.devices()[number].outputs()[own];
        let rank = output.rank(self.body().dimension());
        Ok(self.device_value(number, own, None)[..rank].to_vec())
    }

    /// An output of a device, both by number, where its rows have these `multipliers`.
    pub(in crate::dynamics::simulate) fn device_value(
        &self,
        device: usize,
        output: usize,
        multipliers: Option<DeviceMultipliers<'_>>,
    ) -> [f64; 3] {
        let own = &*self.scene.devices()[device];
        let mut state = self.scene.device_state(own, self.phase, self.time, [self.u, self.v]);
        state.multipliers = multipliers;
        (self.gauges.devices[device][output])(&state)
    }
}

impl Reading {
    /// An `output` of the [device](crate::Device) with a name.
    pub fn device(device: impl Into<String>, output: &'static DeviceOutput) -> Self {
        ReadingKind::OfDevice(output, device.into()).into()
    }
}
