//! Outputs of gas in chambers, and of orifices.

use super::super::output::{Kind, Output, Read};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;

const FILLED: Kind = Kind {
    key: "chamber",
    about: "the name of the chamber",
    find: |scene, name, input| scene.gas_number(name, input),
};

const ORIFICE: Kind = Kind {
    key: "orifice",
    about: "the name of the orifice",
    find: |scene, name, input| scene.orifice_number(name, input),
};

pub(super) static ABSOLUTE_PRESSURE: Output = Output {
    word: "absolute-pressure",
    about: "the absolute pressure of the gas in a chamber (Pa)",
    unit: "Pa",
    of: FILLED,
    read: Read::Number(|view, number| Ok(view.gas_pressure(number))),
};

pub(super) static AMOUNT: Output = Output {
    word: "gas-amount",
    about: "the amount of gas in a chamber (kg)",
    unit: "kg",
    of: FILLED,
    read: Read::Number(|view, number| Ok(view.gas_mass(number))),
};

pub(super) static FLOW: Output = Output {
    word: "gas-flow",
    about: "the flow of gas through an orifice, from its first end to its second (kg/s)",
    unit: "kg/s",
    of: ORIFICE,
    read: Read::Number(|view, number| {
        let flow = view.scene.orifice_flow(number, view.phase)?;
        let gases = &view.gauges.gases;
        let pressures: Vec<f64> = (0..gases.len()).map(|gas| view.gas_pressure(gas)).collect();
        let rate = flow.rate(view.time, gases, &pressures);
        let [rate, ..] = rate.map_err(|failure| {
            let name = format!("\"{}\"", view.scene.orifices()[number].name());
            InputError::new("orifice", name, failure.into_error().to_string())
        })?;
        Ok(rate)
    }),
};

impl View<'_> {
    /// Absolute pressure (Pa) of the gas in a chamber.
    ///
    /// # Errors
    /// A name that no chamber has, or one without gas.
    pub fn absolute_pressure(&self, chamber: &str) -> Result<f64, InputError> {
        ABSOLUTE_PRESSURE.number(self, chamber)
    }

    /// Amount of gas (kg) in a chamber.
    ///
    /// # Errors
    /// As [`absolute_pressure`](Self::absolute_pressure).
    pub fn gas_amount(&self, chamber: &str) -> Result<f64, InputError> {
        AMOUNT.number(self, chamber)
    }

    /// Flow (kg/s) through an orifice, from its first end to its second.
    ///
    /// # Errors
    /// A name that no orifice has; a supply or an opening out of range.
    pub fn gas_flow(&self, orifice: &str) -> Result<f64, InputError> {
        FLOW.number(self, orifice)
    }

    fn gas_pressure(&self, number: usize) -> f64 {
        let pressure = self.gauges.gases[number].pressure(self.u, self.gas_mass(number));
        pressure.map_or(f64::NAN, |[pressure, _]| pressure)
    }
}

impl Reading {
    /// Absolute pressure (Pa) of the gas in a chamber.
    pub fn absolute_pressure(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&ABSOLUTE_PRESSURE, chamber.into()).into()
    }

    /// Amount of gas (kg) in a chamber.
    pub fn gas_amount(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&AMOUNT, chamber.into()).into()
    }

    /// Flow of gas (kg/s) through an orifice, from its first end to its second.
    pub fn gas_flow(orifice: impl Into<String>) -> Self {
        ReadingKind::Of(&FLOW, orifice.into()).into()
    }
}
