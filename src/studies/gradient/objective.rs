//! Quantities of which derivatives are taken.

use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::Sampling;
use crate::dynamics::trajectory::Trajectory;
use crate::io::scene_file::SceneFile;
use crate::studies::fit::{Measured, MeasuredAtRest};
use crate::studies::work_precision::{Part, Quantity};

/// A number that follows from a motion or from equilibria.
#[derive(Debug, Clone, PartialEq)]
pub enum Objective {
    /// The quantity of the motion that a text names, as [`Quantity::named`] takes it: `tip.y`, which is its value at the end,
    /// `com.y:max`, `tip.y:frequency`.
    Quantity(String),
    /// The same of the equilibrium, as `tip.y`.
    QuantityAtRest(String),
    /// The sum of the squares of sensor readings less measurements over time. With sensors of several units, residuals are
    /// divided as in a [`SceneFit`](crate::fit::SceneFit).
    LeastSquares(Measured),
    /// The same of equilibria.
    LeastSquaresAtRest(MeasuredAtRest),
}

/// A number of one run, its history, and its cost.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    /// The history of a reading, evenly from the start to the end, whose last value is the number; or the number alone.
    pub(super) values: Vec<f64>,
    /// The largest change of the reading, or the number itself.
    pub(super) scale: f64,
    /// Steps of the integrator, or Newton's iterations.
    pub(super) steps: usize,
}

impl Seen {
    /// The number.
    pub(super) fn value(&self) -> f64 {
        self.values.last().copied().unwrap_or(f64::NAN)
    }
}

/// Times from the start to the end at which a reading is followed; of swings and peaks more.
const LOOKS: usize = 100;
const MANY_LOOKS: usize = 2000;

/// The time of value `number` of a history, as a part of the whole.
pub(super) fn part_of_time(number: usize) -> f64 {
    (number + 1) as f64 / LOOKS as f64
}

/// The quantity that a `text` names, as a number: at the end if nothing else is said.
pub(crate) fn quantity(text: &str, file: &SceneFile, is_at_rest: bool) -> Result<Quantity, Error> {
    // an error about a component knows nothing of the text
    let named = |InputError { help, .. }| InputError::new("quantity", format!("\"{text}\""), help);
    let quantity = Quantity::named(text, &file.scene, &file.output.sensors).map_err(named)?;
    let quantity = match quantity.is_over_time() {
        true if !quantity.is_motion() => quantity.part(Part::End),
        true => {
            let help = "the whole motion is no single number: name a reading, as tip.y";
            return Err(InputError::new("quantity", format!("\"{text}\""), help).into());
        }
        false => quantity,
    };
    match is_at_rest {
        true => _ = quantity.at_rest(&file.scene)?,
        false => quantity.check(&file.scene)?,
    }
    Ok(quantity)
}

/// The sampling of a motion for a quantity, with the sensors of the file, by which phases may end.
pub(super) fn sampling(quantity: &Quantity, file: &SceneFile) -> Sampling {
    let end = file.scene.end();
    let looks = if quantity.is_at_end() { LOOKS } else { MANY_LOOKS };
    let times: Vec<f64> = (1..looks).map(|k| end * (k as f64 / looks as f64)).collect();
    let sensors = file.output.sensors.iter().cloned();
    quantity.read_by(sensors.fold(Sampling::at(times), |all, (name, own)| all.read(name, own)))
}

/// A quantity in a motion that was [sampled](sampling) for it, or in an equilibrium.
pub(super) fn seen(quantity: &Quantity, motion: &Trajectory) -> Result<Seen, Error> {
    let samples = motion.samples();
    let number = quantity.seen(motion, &[], samples.iter());
    let value = number.values.first().and_then(|values| values.first()).copied();
    let Some(value) = value.filter(|value| value.is_finite()) else {
        let help = "there is no such number, as of a motion that does not swing";
        return Err(InputError::new("quantity", format!("\"{quantity}\""), help).into());
    };
    let mut values = vec![value];
    if quantity.is_at_end() {
        // at the times of the sampling alone: phases end at others
        let end = motion.last().time;
        let history = quantity.clone().part(Part::OverTime).seen(motion, &[], samples.iter());
        let at = |k: usize| samples.partition_point(|sample| sample.time < end * part_of_time(k));
        let before = (0..LOOKS - 1).filter_map(|k| history.values.get(at(k))?.first().copied());
        values = before.chain([value]).collect();
    }
    Ok(Seen { values, scale: number.scale, steps: motion.report().steps() })
}
