//! `[[liquid]]` and `[[pipe]]`.

use super::keys::{Key, TableKeys, ValueType};
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Liquid, Pipe};
use crate::scene::timeline::Scene;

pub(super) const LIQUID: TableKeys = TableKeys::new(
    "[[liquid]]",
    "A liquid that fills a chamber, or stands in it with a `surface`, in place of a `pressure` of phases. Above that outside it has the pressure p = K (V_m - V)/V_m, with the volume V of the \
     chamber and the volume V_m that it would have without pressure, which a `flow` in phases changes. Where there is gravity it has weight: p is the mean, and the \
     pressure on the walls grows with depth. Its own motion, its inertia, is left out.",
    &[
        Key::new("chamber", ValueType::Text, "the name of the chamber").required(),
        Key::number("bulk_modulus", "the bulk modulus K", "Pa").default("2.2e9, water"),
        Key::number("density", "the density without pressure", "kg/m^3").default("1000"),
        Key::number(
            "fill",
            "V_m at the start, as a part of the volume of the undeformed chamber",
            "1",
        )
        .note("With 1 the initial pressure is 0; with a `surface` it has to be below 1.")
        .default("1"),
        Key::new(
            "surface",
            ValueType::Flag,
            "whether it has a level surface under air of the pressure outside, in a chamber that is open or vented and not full",
        )
        .note("It is not compressed: the pressure on the walls is rho g (h - z) below the level h, which follows from the volume, and 0 above it. Requires gravity.")
        .default("false"),
    ],
    "[[liquid]]\nchamber = \"inside\"\nbulk_modulus = 2.2e9\ndensity = 1000.0",
);

pub(super) const PIPE: TableKeys = TableKeys::new(
    "[[pipe]]",
    "A pipe or a tube between two chambers with liquids of the same density, or between one and a `[[supply]]` or the atmosphere. Its flow q, from the first end to the second, follows \
     (rho l/A) dq/dt = p_1 - p_2 + rho g (z_1 - z_2) - R q - zeta rho q |q|/(2 A^2), R = 8 pi mu l/A^2. Of a chamber that is full p is the mean pressure and z the height of its middle, of one with a \
     `surface` p is 0 and z the level; a supply and the atmosphere are at the height that the chamber at the other end has in the undeformed shape.",
    &[
        Key::new("name", ValueType::Text, "the name of the pipe").required(),
        Key::new(
            "from",
            ValueType::Text,
            "one end: a chamber with a liquid, a supply, or `atmosphere`",
        )
        .required(),
        Key::new("to", ValueType::Text, "the other end, likewise").required(),
        Key::number("length", "the length l", "m").required(),
        Key::number("area", "the area A of its section", "m^2")
            .note("A tube 4 mm wide has 1.26e-5.")
            .required(),
        Key::number("viscosity", "the viscosity mu of the liquid", "Pa s").default("1e-3, water"),
        Key::number("loss", "the coefficient zeta of losses at ends, bends and valves", "1")
            .note("Some 0.5 where it begins with sharp edges, 1 where it ends in a chamber.")
            .default("0"),
    ],
    "[[pipe]]\nname = \"tube\"\nfrom = \"atmosphere\"\nto = \"inside\"\nlength = 0.5\narea = 1.26e-5",
);

/// The scene with the liquid that `value` describes.
pub(super) fn add_liquid(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&LIQUID)?;
    let mut liquid = Liquid::in_chamber(table.required("chamber", Value::string)?);
    liquid = table.added(liquid, "bulk_modulus", Value::number, Liquid::bulk_modulus)?;
    liquid = table.added(liquid, "density", Value::number, Liquid::density)?;
    liquid = table.added(liquid, "fill", Value::number, Liquid::fill)?;
    if table.optional("surface", Value::flag)?.unwrap_or(false) {
        if let Some(value) = table.get("bulk_modulus") {
            return Err(value.error("a liquid with a surface is not compressed: leave it out"));
        }
        liquid = liquid.surface();
    }
    let scene = scene.liquid(liquid);
    scene.poured(None).map_err(|error| table.blame(error))?;
    Ok(scene)
}

/// The scene with the pipe that `value` describes.
pub(super) fn add_pipe(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&PIPE)?;
    let text = |key: &str| table.required(key, Value::string);
    let number = |key: &str| table.required(key, Value::number);
    let (name, from, to) = (text("name")?, text("from")?, text("to")?);
    let mut pipe = Pipe::new(name, from, to, number("length")?, number("area")?);
    pipe = table.added(pipe, "viscosity", Value::number, Pipe::viscosity)?;
    pipe = table.added(pipe, "loss", Value::number, Pipe::loss)?;
    unique(table, name, scene.pipes().iter().map(Pipe::name))?;
    let scene = scene.pipe(pipe);
    scene.pipe_flow(scene.pipes().len() - 1).map_err(|error| table.blame(error))?;
    Ok(scene)
}
