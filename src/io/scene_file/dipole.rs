//! `[[dipole]]`.

use super::course::vectors;
use super::keys::{Key, TableKeys, ValueType};
use super::surroundings::unique;
use super::table::Table;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::{Dipole, DipolePart, Signals, VectorSignal};
use crate::scene::timeline::Scene;

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

/// The scene with the dipole that `value` describes.
pub(super) fn add_dipole(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&DIPOLE)?;
    let dimension = scene.body().dimension();
    let part = |part: DipolePart| -> Result<Signals, Error> {
        let missing = || table.missing(part.word(), "a dipole needs it");
        let vector = vectors(table, part.word(), dimension)?.ok_or_else(missing)?;
        check(table, part, &vector, dimension)?;
        Ok(Signals(vector))
    };
    let dipole = Dipole::new(part(DipolePart::Moment)?, part(DipolePart::Position)?);
    let dipole = table.added(dipole, "name", Value::string, Dipole::named)?;
    let dipole = dipole.or_named(format!("dipole {}", scene.dipoles().len() + 1));
    unique(table, dipole.name(), scene.dipoles().iter().map(Dipole::name))?;
    if scene.magnets().is_empty() {
        let help = "the scene has no magnet that feels it: add a [[magnet]]";
        let name = format!("\"{}\"", dipole.name());
        return Err(table.blame(InputError::new("dipole", name, help)));
    }
    Ok(scene.dipole(dipole))
}

fn check(
    table: &Table,
    part: DipolePart,
    vector: &VectorSignal,
    dimension: usize,
) -> Result<(), Error> {
    let checked = vector.validate(part.word(), dimension, part.unit());
    checked.map_err(|error| table.blame(error))
}
