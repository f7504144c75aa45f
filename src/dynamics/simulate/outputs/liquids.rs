//! Outputs of liquids in chambers, and of pipes.

use super::super::output::{Kind, Output, Read};
use super::super::reading::{Reading, ReadingKind};
use super::super::view::View;
use crate::base::input::InputError;
use crate::scene::timeline::Quantity;

const FILLED: Kind = Kind {
    key: "chamber",
    about: "the name of the chamber",
    find: |scene, name, input| scene.liquid_number(name, input),
};

/// Chambers with a liquid that has a surface.
const WITH_SURFACE: Kind =
    Kind { find: |scene, name, input| scene.surface_number(name, input), ..FILLED };

const PIPE: Kind = Kind {
    key: "pipe",
    about: "the name of the pipe",
    find: |scene, name, input| scene.pipe_number(name, input),
};

pub(super) static VOLUME: Output = Output {
    word: "liquid-volume",
    about: "the volume of the liquid in a chamber, as it is without pressure (m^3)",
    unit: "m^3",
    of: FILLED,
    read: Read::Number(|view, number| {
        Ok(view.gauges.liquids[number].natural(view.liquid_mass(number)))
    }),
};

pub(super) static FLOW: Output = Output {
    word: "liquid-flow",
    about: "the flow of liquid into a chamber (m^3/s)",
    unit: "m^3/s",
    of: FILLED,
    read: Read::Number(|view, number| {
        Ok(view.input(Quantity::Flow, view.scene.liquids()[number].chamber()))
    }),
};

pub(super) static LEVEL: Output = Output {
    word: "liquid-level",
    about: "the height of the surface of the liquid in a chamber above the origin, against gravity (m)",
    unit: "m",
    of: WITH_SURFACE,
    read: Read::Number(|view, number| {
        Ok(view.with_surface(number)?.level(view.u, view.liquid_mass(number)))
    }),
};

pub(super) static PIPE_FLOW: Output = Output {
    word: "pipe-flow",
    about: "the flow of liquid through a pipe, from its first end to its second (m^3/s)",
    unit: "m^3/s",
    of: PIPE,
    read: Read::Number(|view, number| {
        Ok(view.scene.flowing(view.amounts).map_or(0.0, |all| all.pipes[number]))
    }),
};

impl View<'_> {
    /// Natural volume (m^3) of the liquid in a chamber.
    ///
    /// # Errors
    /// A name that no chamber has, or one without liquid.
    pub fn liquid_volume(&self, chamber: &str) -> Result<f64, InputError> {
        VOLUME.number(self, chamber)
    }

    /// Flow (m^3/s, of natural volume) of liquid into a chamber.
    ///
    /// # Errors
    /// As [`liquid_volume`](Self::liquid_volume).
    pub fn liquid_flow(&self, chamber: &str) -> Result<f64, InputError> {
        FLOW.number(self, chamber)
    }

    /// Height (m) above the origin, against gravity, of the surface of the liquid in a chamber; NaN where the chamber is too small for the liquid.
    ///
    /// # Errors
    /// A name that no chamber has, one without liquid, a liquid without a [surface](crate::Liquid::surface).
    pub fn liquid_level(&self, chamber: &str) -> Result<f64, InputError> {
        LEVEL.number(self, chamber)
    }

    /// Flow (m^3/s) through a pipe, from its first end to its second.
    ///
    /// # Errors
    /// A name that no pipe has.
    pub fn pipe_flow(&self, pipe: &str) -> Result<f64, InputError> {
        PIPE_FLOW.number(self, pipe)
    }
}

impl Reading {
    /// Natural volume of the liquid in a chamber (m^3).
    pub fn liquid_volume(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&VOLUME, chamber.into()).into()
    }

    /// Flow of liquid into a chamber (m^3/s).
    pub fn liquid_flow(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&FLOW, chamber.into()).into()
    }

    /// Height (m) of the surface of the liquid in a chamber above the origin, against gravity: see [`Liquid::surface`](crate::Liquid::surface).
    pub fn liquid_level(chamber: impl Into<String>) -> Self {
        ReadingKind::Of(&LEVEL, chamber.into()).into()
    }

    /// Flow of liquid (m^3/s) through a [pipe](crate::Pipe), from its first end to its second.
    pub fn pipe_flow(pipe: impl Into<String>) -> Self {
        ReadingKind::Of(&PIPE_FLOW, pipe.into()).into()
    }
}
