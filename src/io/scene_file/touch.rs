//! `[[touch]]`.

use super::friction::{FRICTION_COEFFICIENT, coefficients};
use super::keys::{Key, TableKeys, ValueType};
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::Touch;
use crate::scene::timeline::Scene;

pub(super) const TOUCH: TableKeys = TableKeys::new(
    "[[touch]]",
    "Contact of bodies with each other and with themselves: surfaces nearer than `distance` D push each other apart, by the pressure \
     k (D - d)^2 (D + 2 d)/(3 d^2) of a barrier at the distance d, which nothing passes, or by k (D - d) of a spring.",
    &[
        Key::new("name", ValueType::Text, "the name of the contact, for sensors").default("touch"),
        Key::new(
            "bodies",
            ValueType::List(&ValueType::Text),
            "the bodies that touch each other; a single one touches itself",
        )
        .default("all, and each of them itself"),
        Key::new("law", ValueType::Word(|| vec!["barrier", "spring"]), "how the pressure grows")
            .default("barrier"),
        Key::number("stiffness_density", "the stiffness k per area", "N/m^3")
            .default("a tenth of the least Young's modulus over D, all of it for a spring; between rigid bodies less, by their weight and initial speeds"),
        Key::number("distance", "the distance D from which on nothing acts", "m")
            .default("a tenth of the mean edge of the surfaces and of the thickness 2 V/A of the thinnest body, and no more than the gap of undeformed bodies, down to a hundredth of that"),
        Key::number("damping_density", "the damping along the normal, per area", "N s/m^3")
            .default("0"),
        FRICTION_COEFFICIENT,
        Key::number("sticking_speed", "the speed below which friction sticks", "m/s")
            .default("a thousandth of the size of the bodies per second, or of the differences of their initial velocities"),
    ],
    "[[touch]]\ndistance = 5.0e-4\nfriction_coefficient = 0.6",
);

/// The scene with the contact that `value` describes.
pub(super) fn add_touch(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&TOUCH)?;
    let mut touch = match table.optional("bodies", |value| {
        value.list_of("names of bodies", |name| name.string().map(str::to_owned))
    })? {
        Some(bodies) => Touch::between(bodies),
        None => Touch::all(),
    };
    touch = table.added(touch, "name", Value::string, Touch::named)?;
    let law = |value: &Value| value.word(&[("barrier", false), ("spring", true)]);
    if table.optional("law", law)? == Some(true) {
        touch = touch.spring();
    }
    touch = table.added(touch, "stiffness_density", Value::number, Touch::stiffness_density)?;
    touch = table.added(touch, "distance", Value::number, Touch::distance)?;
    touch = table.added(touch, "damping_density", Value::number, Touch::damping_density)?;
    if let Some([at_rest, sliding]) = coefficients(table)? {
        touch = touch.friction_coefficients(at_rest, sliding);
    }
    touch = table.added(touch, "sticking_speed", Value::number, Touch::sticking_speed)?;
    unique(table, touch.name(), scene.touches().iter().map(Touch::name))?;
    scene.force_of(&touch).map_err(|error| table.blame(error))?;
    Ok(scene.touch(touch))
}
