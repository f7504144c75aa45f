//! `[[muscle]]`.

use super::cells::{BOX, CELLS, GROUP, cells};
use super::keys::{Holds, Key, TableKeys};
use super::material::{ALONG, AXIS, CENTRE, PITCH, course};
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Muscle, Spring};
use crate::scene::timeline::Scene;

pub(super) const MUSCLE: TableKeys = TableKeys::new(
    "[[muscle]]",
    "Fibres in a body that pull by a stress of their own, which `actuate` in a phase gives: a force per section of the undeformed shape, however \
     long they are, in addition to the elasticity of the material. They lie along a vector, or around an axis, in all of the body or in \
     the cells of a `box`, a `group` or a list. For bodies with Green's strain.",
    &[
        Key::new("name", Holds::Text, "the name of the muscle, which no spring has").default("muscle 1, muscle 2, ..."),
        ALONG,
        CENTRE,
        AXIS,
        PITCH,
        BOX,
        GROUP,
        CELLS,
    ],
    "[[muscle]]\nname = \"upper\"\nalong = [1.0, 0.0]\nbox = [[0.0, 0.01], [0.1, 0.02]] # cells whose centroid lies in it",
)
.one_of(&[&["along"], &["centre"]]);

/// The scene with the muscle that `value` describes.
pub(super) fn add_muscle(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&MUSCLE)?;
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| format!("muscle {}", scene.muscles().len() + 1), Into::into);
    let others = scene.springs().iter().map(Spring::name);
    unique(table, &name, others.chain(scene.muscles().iter().map(Muscle::name)))?;
    let mut muscle = Muscle::new(course(table)?).named(name);
    if let Some(cells) = cells(table, scene.body().mesh())? {
        muscle = muscle.within(cells);
    }
    muscle.strands(scene.body()).map_err(|error| table.blame(error))?;
    Ok(scene.muscle(muscle))
}
