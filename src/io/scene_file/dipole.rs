//! `[[dipole]]`, and `drive` in phases.

use super::course::{vectors, vectors_until};
use super::keys::{Key, PERIOD, TIMES, TableKeys, ValueType};
use super::surroundings::unique;
use super::table::Table;
use super::value::{Value, named};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::devices::Dipole;
use crate::scene::forces::Signals;
use crate::scene::timeline::{DeviceInput, Input, Phase, Quantity, Scene, Target};

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
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| scene.next_device("dipole", "dipole"), Into::into);
    unique(table, &name, scene.devices().iter().map(|device| device.name()))?;
    if scene.magnets().is_empty() {
        let help = "the scene has no magnet that feels it: add a [[magnet]]";
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
