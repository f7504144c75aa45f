//! Tables of devices: `[[wind]]`, `[[dipole]]` and `drive` in phases, and those of other crates.

use std::sync::Arc;

use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::course::{vectors, vectors_until};
use super::keys::{Key, PERIOD, TIMES, TableKeys, ValueType};
use super::selection::selection;
use super::source::SourceText;
use super::surroundings::unique;
use super::table::Table;
use super::value::{Value, named};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::devices::{Dipole, Wind};
use crate::scene::forces::Signals;
use crate::scene::timeline::{Device, DeviceInput, Input, Phase, Quantity, Scene, Target};

/// A table of scene files for devices of one kind, which another crate defines.
///
/// `serde` reads it: keys are the fields of the type, and its attributes say which are optional and refuse all others
/// (`#[serde(deny_unknown_fields)]`). A [`SceneReader`](crate::SceneReader) reads it, and the
/// [command](crate::command::main_with) of a program.
#[derive(Debug, Clone, Copy)]
pub struct DeviceTable {
    pub(super) word: &'static str,
    pub(super) about: &'static str,
    pub(super) keys: &'static [DeviceKey],
    read: fn(ValueDeserializer<'_>) -> Result<Arc<dyn Device>, toml::de::Error>,
}

impl DeviceTable {
    /// The table `[[word]]`, or tables, of devices of the type `T`.
    pub fn of<T: Device + DeserializeOwned + 'static>(word: &'static str) -> Self {
        let read = |table: ValueDeserializer<'_>| -> Result<Arc<dyn Device>, _> {
            Ok(Arc::new(T::deserialize(table)?))
        };
        Self { word, about: "A device of this program.", keys: &[], read }
    }

    /// With words for reference and schema: what it is, a sentence in Markdown, and its keys, all of them.
    #[must_use]
    pub fn described(self, about: &'static str, keys: &'static [DeviceKey]) -> Self {
        Self { about, keys, ..self }
    }
}

/// A key of a [`DeviceTable`], for reference and schema.
#[derive(Debug, Clone, Copy)]
pub struct DeviceKey {
    /// Its name.
    pub name: &'static str,
    /// Its unit; empty for words.
    pub unit: &'static str,
    /// Its meaning, in words.
    pub meaning: &'static str,
}

/// Devices of other crates in a file, which are taken out of its `entries`.
///
/// # Errors
/// Tables that `serde` does not read.
pub(super) fn take_devices(
    source: &SourceText,
    entries: &mut DeTable,
    tables: &[DeviceTable],
) -> Result<Vec<Arc<dyn Device>>, Error> {
    let mut devices = Vec::new();
    for DeviceTable { word, read, .. } in tables {
        let Some(value) = entries.remove(*word) else { continue };
        let all = match value.get_ref() {
            DeValue::Array(list) => list.iter().cloned().collect(),
            _ => vec![value],
        };
        for value in all {
            let at = value.span();
            let device = read(value.into()).map_err(|error| {
                source.error(&error.span().unwrap_or(at), word, error.message())
            })?;
            devices.push(device);
        }
    }
    Ok(devices)
}

pub(super) const WIND: TableKeys = TableKeys::new(
    "[[wind]]",
    "Air that drags faces along with its velocity relative to theirs, as a `[[fluid]]` does, and whose `velocity` phases `steer`: 0 where they do not.",
    &[
        Key::new("name", ValueType::Text, "the name of the wind").default("wind 1, wind 2, ..."),
        Key::number("drag", "the coefficient C_n of drag along the normal", "1")
            .note("Faces at the front and at the back both count: 0.6 to 1 for plates, 0.75 to 0.9 for cylinders across, 0.5 for spheres.")
            .required(),
        Key::number("skin_drag", "the coefficient C_t of drag along the face", "1").default("0"),
        Key::number("density", "the density of the air", "kg/m^3").default("1.2"),
        Key::new("nodes", ValueType::Nodes, "the nodes of the faces that it blows on")
            .note("Those inside of bodies do not matter.")
            .default("all"),
    ],
    "[[wind]]\nname = \"gust\"\ndrag = 0.7",
);

/// The scene with the wind that `value` describes.
pub(super) fn add_wind(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&WIND)?;
    let name = device_name(table, &scene, "device", "wind")?;
    let tangential = table.optional("skin_drag", Value::number)?.unwrap_or_default();
    let mut wind = Wind::new(name).drag(table.required("drag", Value::number)?, tangential);
    wind = table.added(wind, "density", Value::number, Wind::density)?;
    let nodes = |value: &Value| selection(value, scene.body().mesh());
    wind = table.added(wind, "nodes", nodes, Wind::on)?;
    Ok(scene.device(wind))
}

/// The name of a device that the table describes, which no other one has.
pub(super) fn device_name(
    table: &Table,
    scene: &Scene,
    kind: &str,
    word: &str,
) -> Result<String, Error> {
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| scene.next_device(kind, word), Into::into);
    unique(table, &name, scene.devices().iter().map(|device| device.name()))?;
    Ok(name)
}

pub(super) const DIPOLE: TableKeys = TableKeys::new(
    "[[dipole]]",
    "An external magnet with prescribed motion: a point dipole of the moment m at p, whose field mu_0/(4 pi) (3 (m . r) r/|r|^5 - m/|r|^3), r = x - p, acts on \
     each `[[magnet]]` at its deformed place. In the plane it is that of a dipole in space which lies in the plane of the body, as its moment does. It acts in all phases; \
     `drive` in a phase moves it and changes its moment.",
    &[
        Key::new("name", ValueType::Text, "the name of the dipole").default("dipole 1, dipole 2, ..."),
        Key::new("moment", ValueType::ChangingVector, "the moment m")
            .in_unit("A m^2")
            .note("Of a magnet of the remanence b and the volume V it is b V/mu_0: 1.03 for 1 cm^3 of neodymium of 1.3 T.")
            .required(),
        Key::new("position", ValueType::ChangingVector, "the position p").in_unit("m"),
        Key::new("times", ValueType::List(&ValueType::Number), "times in ascending order").in_unit("s"),
        Key::new("positions", ValueType::List(&ValueType::Vector), "the positions at these times").in_unit("m"),
    ],
    "[[dipole]]\nname = \"lead\"\nmoment = [0.0, 1.0]\nposition = [\"0.05 + 0.01*t\", 0.3]",
)
.one_of(&[&["position"], &["times", "positions"]]);

pub(super) const DRIVE: TableKeys = TableKeys::new(
    "drive",
    "Where a `[[dipole]]` is in this phase, or its moment, in place of what the scene says; a moment of 0 switches it off. Those of tables are interpolated linearly, \
     and constant before and after.",
    &[
        Key::new("dipole", ValueType::Text, "the name of the dipole").required(),
        Key::new("position", ValueType::ChangingVector, "its position").in_unit("m"),
        Key::new("moment", ValueType::ChangingVector, "its moment").in_unit("A m^2"),
        TIMES,
        PERIOD,
        Key::new("positions", ValueType::List(&ValueType::Vector), "its positions at these times").in_unit("m"),
        Key::new("moments", ValueType::List(&ValueType::Vector), "its moments at these times").in_unit("A m^2"),
    ],
    "drive = [{ dipole = \"lead\", times = [0.0, 0.1], positions = [[0.05, 0.3], [0.1, 0.3]] }]",
)
.one_of(&[&["position"], &["moment"], &["times", "positions"], &["times", "moments"]]);

/// The scene with the dipole that `value` describes.
pub(super) fn add_dipole(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&DIPOLE)?;
    let dimension = scene.body().dimension();
    let vector = |input: &DeviceInput| -> Result<Signals, Error> {
        let missing = || table.missing(input.word, "a dipole needs it");
        let vector = vectors(table, input.word, dimension)?.ok_or_else(missing)?;
        let checked = vector.validate(input.word, dimension, input.unit);
        checked.map_err(|error| table.blame(error))?;
        Ok(Signals(vector))
    };
    let dipole = Dipole::new(vector(&Dipole::MOMENT)?, vector(&Dipole::POSITION)?);
    let name = device_name(table, &scene, "dipole", "dipole")?;
    if scene.magnets().is_empty() {
        let help = "the scene has no magnet on which it acts: add a [[magnet]]";
        return Err(table.blame(InputError::new("dipole", format!("\"{name}\""), help)));
    }
    Ok(scene.dipole(dipole.named(name)))
}

/// The phase with a place or a moment of a dipole.
pub(super) fn drive(mut phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let dipoles = scene.devices().iter().filter(|device| device.kind() == "dipole");
    let known: Vec<&str> = dipoles.map(|device| device.name()).collect();
    let name = table.required("dipole", |value| named(value, &known))?;
    for input in [&Dipole::POSITION, &Dipole::MOMENT] {
        let value = vectors_until(table, phase.end(), input.word, scene.body().dimension())?;
        if let Some(value) = value {
            phase.set(Input::new(Quantity::Device(input), Target::one(&*name), value));
        }
    }
    Ok(phase)
}
