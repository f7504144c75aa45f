//! `[[growth]]`.

use super::cells::{BOX, CELLS, GROUP, cells};
use super::keys::{Key, TableKeys, ValueType};
use super::material::{AXIS, course};
use super::surroundings::actuator_name;
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Actuator, Growth};
use crate::scene::timeline::Scene;

pub(super) const GROWTH: TableKeys = TableKeys::new(
    "[[growth]]",
    "Cells that swell, expand by heat or change their shape as active materials do, by the strain that `actuate` in a phase gives: what is free gets 1 + strain times as long, \
     without stress. Alike in all directions, or along a vector or around an axis, as fibres run; across that they keep their size, or change it by a share of the strain \
     or so that their volume stays. All of the body, or the cells of a `box`, a `group` or a list. For Green's strain with any law. Rods get longer, or `bend` and `twist`.",
    &[
        Key::new("name", ValueType::Text, "the name of the growth, which no spring and no muscle has")
            .default("growth 1, growth 2, ..."),
        Key::new("along", ValueType::Vector, "a vector along which they grow, of any length")
            .default("alike in all directions"),
        Key::new("centre", ValueType::Vector, "a point of the axis around which they grow").in_unit("m"),
        AXIS,
        Key::number("pitch", "angle by which the direction of growth climbs along the axis: 0 are rings, others helices", "rad").default("0"),
        Key::number("across", "growth across the direction, relative to that along it: 0 is none, 1 isotropic", "1").default("0"),
        Key::new("keeps_volume", ValueType::Flag, "whether they get thinner across the direction as they grow along it, and keep their volume")
            .default("false"),
        Key::new("bend", ValueType::Array(&ValueType::Number, 2), "of rods: changes of the stress-free curvatures about d_1 and d_2 per unit strain, in place of length")
            .in_unit("1/m")
            .note("In the plane the second one bends."),
        Key::number("twist", "of rods: change of the stress-free twist per unit strain, in place of length", "rad/m").default("0"),
        BOX,
        GROUP,
        CELLS,
    ],
    "[[growth]]\nname = \"hot layer\"\nbox = [[0.0, 0.01], [0.1, 0.02]] # cells whose centroid lies in it",
);

/// The scene with the growth that `value` describes.
pub(super) fn add_growth(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&GROWTH)?;
    let name = actuator_name(table, &scene, "growth")?;
    let growth = match cells(table, scene.body().mesh())? {
        Some(cells) => Growth::within(cells),
        None => Growth::everywhere(),
    };
    let growth = directed(growth.named(name), table)?;
    growth.driven(scene.body(), Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.growth(growth))
}

/// The growth with the direction that a table gives, if it gives one.
fn directed(mut growth: Growth, table: &Table<'_>) -> Result<Growth, Error> {
    let has = |key: &str| table.get(key).is_some();
    if has("along") && has("centre") {
        return Err(table.error("expected one alone of along and centre"));
    }
    if ["along", "centre", "axis", "pitch"].into_iter().any(has) {
        growth = growth.along_course(course(table)?);
    }
    growth = table.added(growth, "across", Value::number, Growth::across)?;
    if has("bend") || has("twist") {
        let bend = table.optional("bend", Value::array)?.unwrap_or_default();
        growth = growth.bending(bend, table.optional("twist", Value::number)?.unwrap_or_default());
    }
    match (table.flag("keeps_volume")?, has("across")) {
        (true, true) => Err(table.error("expected one alone of across and keeps_volume")),
        (true, false) => Ok(growth.keeping_volume()),
        (false, _) => Ok(growth),
    }
}
