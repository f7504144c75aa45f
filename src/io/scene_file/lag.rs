//! `[[lag]]`.

use super::keys::{Key, TableKeys, ValueType};
use super::phase::names;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::Lag;
use crate::scene::timeline::Scene;

pub(super) const LAG: TableKeys = TableKeys::new(
    "[[lag]]",
    "Actuators that follow their commands with a delay: a' = (s - a)/T, with the command s of `actuate` and the state a, 0 at first, which drives the actuator. T is a \
     `time`, or one for rising and one for falling. With `activation`, the muscle's a by its largest stress, T is `rise` (0.5 + 1.5 a) and `fall`/(0.5 + 1.5 a) \
     (D. G. Thelen (2003)). What is heated is commanded by a power: `capacity` theta' = power - `loss` theta, and `per_kelvin` theta drives it.",
    &[
        Key::new("actuators", ValueType::OneOrMore(&ValueType::Text), "names of springs, cables, muscles and growths, each with a state of its own").required(),
        Key::number("time", "the time after which 1/e of a step is left", "s"),
        Key::number("rise", "that for commands above the state", "s"),
        Key::number("fall", "that for commands below the state", "s"),
        Key::new("activation", ValueType::Flag, "whether it is the activation of muscles by Hill's law").default("false"),
        Key::number("capacity", "the heat of a kelvin", "J/K"),
        Key::number("loss", "the heat loss per kelvin of temperature rise", "W/K"),
        Key::number("per_kelvin", "the actuation per kelvin of temperature rise: a force, a tension, a length of a winch, a stress or a strain", "N, m, Pa or 1 by K")
            .note("For a spring negative if it contracts as it gets warm."),
    ],
    "[[muscle]]\nname = \"biceps\"\nalong = [1.0, 0.0]\nhill = { largest = 2e5 }\n\n[[lag]]\nactuators = \"biceps\"\nrise = 0.015\nfall = 0.05\nactivation = true",
)
.one_of(&[&["time"], &["rise", "fall"], &["capacity", "loss", "per_kelvin"]]);

/// The scene with the lags that `value` describes.
pub(super) fn add_lag(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&LAG)?;
    let known: Vec<&str> = scene.actuator_names().map(|(_, name)| name).collect();
    let actuators = table.required("actuators", |value| names(value, &known))?;
    let number = |key: &str| table.optional(key, Value::number);
    let is_activation = table.optional("activation", Value::flag)?.unwrap_or(false);
    let lag = match (number("time")?, number("capacity")?) {
        (Some(time), _) => Lag::first_order(time),
        (None, Some(capacity)) => Lag::heated(
            capacity,
            table.required("loss", Value::number)?,
            table.required("per_kelvin", Value::number)?,
        ),
        (None, None) => {
            let rise = table.required("rise", Value::number)?;
            let fall = table.required("fall", Value::number)?;
            if is_activation { Lag::activation(rise, fall) } else { Lag::rise_and_fall(rise, fall) }
        }
    };
    if is_activation && !lag.is_activation() {
        let help =
            "a muscle's activation has a rise and a fall (s): give these, or leave activation out";
        return Err(table.blame(InputError::new("lag activation", true, help)));
    }
    let scene = scene.lag(lag, actuators);
    scene.check_lags().map_err(|error| table.blame(error))?;
    Ok(scene)
}
