//! `[[growth]]`.

use super::cells::{BOX, CELLS, GROUP, cells};
use super::keys::{Holds, Key, TableKeys};
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Growth, Muscle, Spring};
use crate::scene::timeline::Scene;

pub(super) const GROWTH: TableKeys = TableKeys::new(
    "[[growth]]",
    "Cells that swell, or expand by heat, alike in all directions, by the strain that `actuate` in a phase gives: what is free gets 1 + strain times as long, \
     without stress. All of the body, or the cells of a `box`, a `group` or a list. For Green's strain with any law, in solids, plane stress, membranes and strings.",
    &[
        Key::new("name", Holds::Text, "the name of the growth, which no spring and no muscle has")
            .default("growth 1, growth 2, ..."),
        BOX,
        GROUP,
        CELLS,
    ],
    "[[growth]]\nname = \"hot layer\"\nbox = [[0.0, 0.01], [0.1, 0.02]] # cells whose centroid lies in it",
);

/// The scene with the growth that `value` describes.
pub(super) fn add_growth(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&GROWTH)?;
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| format!("growth {}", scene.growths().len() + 1), Into::into);
    let others = scene.springs().iter().map(Spring::name);
    let others = others.chain(scene.muscles().iter().map(Muscle::name));
    unique(table, &name, others.chain(scene.growths().iter().map(Growth::name)))?;
    let growth = match cells(table, scene.body().mesh())? {
        Some(cells) => Growth::within(cells),
        None => Growth::everywhere(),
    };
    let growth = growth.named(name);
    growth.growing(scene.body()).map_err(|error| table.blame(error))?;
    Ok(scene.growth(growth))
}
