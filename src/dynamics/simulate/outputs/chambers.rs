//! Outputs of chambers.

use super::super::output::{Kind, Output, Read};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::scene::forces::ChamberFluid;
use crate::scene::timeline::Quantity;

const CHAMBER: Kind = Kind {
    key: "chamber",
    about: "the name of the chamber",
    find: |scene, name, input| scene.chamber_number(name, input),
};

pub(super) static PRESSURE: Output = Output {
    word: "pressure",
    about: "the gauge pressure in a chamber; of a liquid with weight the mean, of one with a surface that at the lowest point of the walls (Pa)",
    unit: "Pa",
    of: CHAMBER,
    read: Read::Number(|view, number| {
        let (scene, u) = (view.scene, view.u);
        let chamber = scene.chambers()[number].name();
        let pressure = if let Some(number) = scene.gas_in(chamber) {
            view.gauges.gases[number].gauge(u, view.gas_mass(number))
        } else if let Some(number) = scene.liquid_in(chamber) {
            let amount = view.liquid_mass(number);
            match scene.liquids()[number].has_surface() {
                true => view.with_surface(number)?.gauge(u, amount),
                false => view.gauges.liquids[number].gauge(u, amount),
            }
        } else {
            Ok(view.input(Quantity::Pressure, chamber))
        };
        Ok(pressure.unwrap_or(f64::NAN))
    }),
};

pub(in crate::dynamics::simulate) static VOLUME: Output = Output {
    word: "volume",
    about: "the volume that the walls of a chamber enclose (m^3)",
    unit: "m^3",
    of: CHAMBER,
    read: Read::OfPositions(|view, number| Ok(view.gauges.chambers[number].volume(view.u))),
};

impl View<'_> {
    /// Volume that the walls of a chamber enclose (m^3).
    ///
    /// # Errors
    /// A name that no chamber has.
    pub fn chamber_volume(&self, chamber: &str) -> Result<f64, InputError> {
        VOLUME.number(self, chamber)
    }

    /// Pressure in a chamber (Pa): for gas and liquids the gauge pressure, NaN where it is undefined; for a liquid with weight the mean,
    /// for one with a surface the pressure at the lowest point of the walls.
    ///
    /// # Errors
    /// A name that no chamber has.
    pub fn pressure(&self, chamber: &str) -> Result<f64, InputError> {
        PRESSURE.number(self, chamber)
    }
}

impl Reading {
    /// Gauge pressure in a chamber (Pa); of a liquid with weight the mean, of one with a surface the value at the
    /// lowest wall point.
    pub fn pressure(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&PRESSURE, chamber.into()).into()
    }

    /// Volume that the walls of a chamber enclose (m^3).
    pub fn chamber_volume(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&VOLUME, chamber.into()).into()
    }
}
