//! Tables of devices: `[[wind]]`, and those of other crates.

use std::sync::Arc;

use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::source::SourceText;
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::devices::Wind;
use crate::scene::timeline::{Device, Scene};

/// A table of scene files for devices of one kind, which another crate defines.
///
/// `serde` reads it: keys are the fields of the type, and its attributes say which are optional and refuse all others
/// (`#[serde(deny_unknown_fields)]`). Given to [`SceneFile::read_with_devices`](crate::SceneFile::read_with_devices).
#[derive(Debug, Clone, Copy)]
pub struct DeviceTable {
    word: &'static str,
    read: fn(ValueDeserializer<'_>) -> Result<Arc<dyn Device>, toml::de::Error>,
}

impl DeviceTable {
    /// The table `[[word]]`, or tables, of devices of the type `T`.
    pub fn of<T: Device + DeserializeOwned + 'static>(word: &'static str) -> Self {
        Self { word, read: |table| Ok(Arc::new(T::deserialize(table)?)) }
    }
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
    for DeviceTable { word, read } in tables {
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
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| scene.next_device("device", "wind"), Into::into);
    unique(table, &name, scene.devices().iter().map(|device| device.name()))?;
    let tangential = table.optional("skin_drag", Value::number)?.unwrap_or_default();
    let mut wind = Wind::new(name).drag(table.required("drag", Value::number)?, tangential);
    wind = table.added(wind, "density", Value::number, Wind::density)?;
    let nodes = |value: &Value| selection(value, scene.body().mesh());
    wind = table.added(wind, "nodes", nodes, Wind::on)?;
    Ok(scene.device(wind))
}
