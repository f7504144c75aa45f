//! `[[muscle]]`.

use super::cells::{BOX, CELLS, GROUP, cells};
use super::keys::{Key, TableKeys, ValueType};
use super::material::{ALONG, AXIS, CENTRE, PITCH, course};
use super::surroundings::actuator_name;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::material::Hill;
use crate::scene::forces::{Actuator, Muscle};
use crate::scene::timeline::Scene;

pub(super) const MUSCLE: TableKeys = TableKeys::new(
    "[[muscle]]",
    "Fibres in a body that pull by a stress of their own, which `actuate` in a phase gives: a force per section of the undeformed shape, however \
     long they are, in addition to the elasticity of the material. They lie along a vector, or around an axis, in all of the body or in \
     the cells of a `box`, a `group` or a list. For bodies with Green's strain.",
    &[
        Key::new("name", ValueType::Text, "the name of the muscle, which no spring has").default("muscle 1, muscle 2, ..."),
        ALONG,
        CENTRE,
        AXIS,
        PITCH,
        BOX,
        GROUP,
        CELLS,
        Key::new("hill", ValueType::Table(&HILL), "reduces its stress away from the optimal length and as it shortens").default("it pulls alike"),
    ],
    "[[muscle]]\nname = \"upper\"\nalong = [1.0, 0.0]\nbox = [[0.0, 0.01], [0.1, 0.02]] # cells whose centroid lies in it",
)
.one_of(&[&["along"], &["centre"]]);

const HILL: TableKeys = TableKeys::new(
    "hill",
    "Hill's law of a muscle: it pulls by `stress` f_l f_v, the `stress` of `actuate` being activation (0 to 1) times `largest`. With the length L of its fibres \
     in best lengths and its rate V by `rate`, f_l = exp(-(L - 1)^2 / `width`), and f_v = (1 + V) / (1 - V / `shape`) as they shorten (0 where that is faster than \
     `rate`); as they lengthen f_v grows, at first alike, to `eccentric`. The defaults are values of D. G. Thelen (2003) for young adults.",
    &[
        Key::number(
            "largest",
            "the stress of full activation at the best length, while that does not change",
            "Pa",
        )
        .required(),
        Key::number("optimal", "the best length, by that in the undeformed shape", "1")
            .default("1"),
        Key::number("width", "the square of the width of f_l", "1").default("0.45"),
        Key::number("rate", "the fastest shortening, in best lengths per second", "1/s")
            .default("10"),
        Key::number(
            "shape",
            "Hill's a by the force at rest: the smaller, the more f_v is bent",
            "1",
        )
        .default("0.25"),
        Key::number("eccentric", "the limit of f_v in fast lengthening", "1").default("1.4"),
    ],
    "[[muscle]]\nname = \"biceps\"\nalong = [1.0, 0.0]\nhill = { largest = 2e5, rate = 5.0 }",
);

/// Hill's law that `value` describes.
fn hill(value: &Value) -> Result<Hill, Error> {
    let table = value.table(&HILL)?;
    let number = |key, or: f64| Ok::<f64, Error>(table.optional(key, Value::number)?.unwrap_or(or));
    let usual = Hill::new(table.required("largest", Value::number)?);
    Ok(Hill {
        optimal: number("optimal", usual.optimal)?,
        width: number("width", usual.width)?,
        rate: number("rate", usual.rate)?,
        shape: number("shape", usual.shape)?,
        eccentric: number("eccentric", usual.eccentric)?,
        ..usual
    })
}

/// The scene with the muscle that `value` describes.
pub(super) fn add_muscle(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&MUSCLE)?;
    let name = actuator_name(table, &scene, "muscle")?;
    let mut muscle = Muscle::new(course(table)?).named(name);
    if let Some(cells) = cells(table, scene.body().mesh())? {
        muscle = muscle.within(cells);
    }
    if let Some(law) = table.optional("hill", hill)? {
        muscle = muscle.hill(law);
    }
    muscle.driven(scene.body(), Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.muscle(muscle))
}
