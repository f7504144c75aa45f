//! `[[magnet]]`, and the magnetic field of a phase.

use super::cells::{BOX, CELLS, GROUP, cells};
use super::course::vectors_until;
use super::keys::{Key, TableKeys, ValueType};
use super::phase_keys::MAGNETIC_FIELD;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Magnet, MagneticField};
use crate::scene::timeline::Scene;

pub(super) const MAGNET: TableKeys = TableKeys::new(
    "[[magnet]]",
    "A part of the body that is a hard magnet, on which the `magnetic_field` of a phase acts: its remanence moves along with the material. All of the body, or \
     the cells of a `box`, a `group` or a list.",
    &[
        Key::new("remanence", ValueType::Vector, "the remanence in the undeformed shape")
            .in_unit("T")
            .note("Of elastomers filled with powder some 0.1 T, of magnets of neodymium 1.3 T.")
            .required(),
        BOX,
        GROUP,
        CELLS,
    ],
    "[[magnet]]\nremanence = [0.1, 0.0]\nbox = [[0.0, 0.0], [0.05, 0.02]] # cells whose centroid lies in it",
);

/// The scene with the magnet that `value` describes.
pub(super) fn add_magnet(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&MAGNET)?;
    let body = scene.body();
    let remanence = |value: &Value| value.vector(body.dimension());
    let mut magnet = Magnet::new(table.required("remanence", remanence)?);
    if let Some(cells) = cells(table, body.mesh())? {
        magnet = magnet.within(cells);
    }
    let mut alone = body.without_magnets();
    let number = scene.magnets().len() + 1;
    magnet.add_to(body, number, &mut alone).map_err(|error| table.blame(error))?;
    Ok(scene.magnet(magnet))
}

/// The magnetic field that `value` describes, of a phase that ends at the time `until` (s).
pub(super) fn magnetic_field(
    value: &Value,
    until: f64,
    scene: &Scene,
) -> Result<MagneticField, Error> {
    let (table, dimension) = (&value.table(&MAGNETIC_FIELD)?, scene.body().dimension());
    let vector = |value: &Value| value.vector(dimension);
    let field = vectors_until(table, until, "field", dimension)?;
    let field = field.ok_or_else(|| table.missing("field", "a magnetic field needs it"))?;
    let field = MagneticField::of(field);
    let rows = table.optional("gradient", |value| value.list_of("rows", vector))?;
    let centre = table.optional("centre", vector)?;
    match (rows, centre) {
        (Some(rows), centre) => Ok(field.gradient(rows, centre.unwrap_or(vec![0.0; dimension]))),
        (None, None) => Ok(field),
        (None, Some(_)) => {
            Err(table.error("a centre is that of a gradient: give one, or leave it out"))
        }
    }
}
