//! The search for the best numbers of a scene file.

use std::path::{Path, PathBuf};

use nalgebra::DVector;

use super::answer::Optimum;
use super::evaluation::{Aim, Evaluation, overrides};
use super::model::Model;
use super::search::{self, Seen};
use crate::base::input::{InputError, finite, four_digits};
use crate::dynamics::error::Error;
use crate::io::file::write_file;
use crate::io::scene_file::{SceneFile, SceneReader, problem, text_of};
use crate::studies::fit::Unknown;
use crate::studies::gradient::{Derivative, Gradient, Objective, SceneGradient, quantity, set};

/// A scene file, quantities of it that are to be as good as numbers within their ranges allow, and these numbers.
///
/// ```
/// use pliant::fit::Unknown;
/// use pliant::gradient::Objective;
/// use pliant::optimize::{Aim, SceneOptimizer};
///
/// # let place = tempfile::tempdir().unwrap();
/// # let scene = place.path().join("bar.toml");
/// # std::fs::write(&scene, r#"
/// #     body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 0.0 } }
/// #     phase = { name = "pull", until = 1.0, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
/// #     sensor = { name = "tip", kind = "displacement", nodes = "right" }
/// # "#).unwrap();
/// // a bar, stretched by F L / (E A): which modulus lets its tip go 5 mm?
/// let stretch = Objective::QuantityAtRest("tip.x".into());
/// let young = Unknown::new("body.material.young", 1e3, 1e6);
/// let optimizer = SceneOptimizer::new(&scene, &[], vec![stretch], Aim::Goals(vec![5e-3]), &[young])?;
/// let optimum = optimizer.optimize(&mut |_| Ok(()))?;
/// assert!((optimum.best().values[0] / 2e4 - 1.0).abs() < 1e-4);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SceneOptimizer {
    reader: SceneReader,
    text: String,
    path: PathBuf,
    overrides: Vec<String>,
    objectives: Vec<Objective>,
    aim: Aim,
    numbers: Vec<Unknown>,
    /// The numbers of the file.
    start: Vec<f64>,
}

impl SceneOptimizer {
    /// A search in the scene file at `path`, with other values as [`SceneFile::read_with`] takes them. It begins with the numbers that the file
    /// states or `overrides` give, which lie within the ranges of `numbers`.
    ///
    /// # Errors
    /// As [`SceneGradient::new`]; no goal for a quantity or several quantities without goals; goals in several units; a range that is none, at
    /// whose ends the scene cannot be, or that the number of the file is not in.
    pub fn new(
        path: impl Into<PathBuf>,
        overrides: &[String],
        objectives: Vec<Objective>,
        aim: Aim,
        numbers: &[Unknown],
    ) -> Result<Self, Error> {
        let path = path.into();
        let text = text_of(&path)?;
        Self::of_text(&SceneReader::default(), text, path, overrides, objectives, aim, numbers)
    }

    /// As [`new`](Self::new), of the `text` of a file at `path`, which `reader` reads.
    ///
    /// # Errors
    /// As there.
    pub fn of_text(
        reader: &SceneReader,
        text: impl Into<String>,
        path: impl Into<PathBuf>,
        overrides: &[String],
        objectives: Vec<Objective>,
        aim: Aim,
        numbers: &[Unknown],
    ) -> Result<Self, Error> {
        let (reader, text, path) = (reader.clone(), text.into(), path.into());
        let (overrides, numbers, start) = (overrides.to_vec(), numbers.to_vec(), Vec::new());
        let mut optimizer = Self { reader, text, path, overrides, objectives, aim, numbers, start };
        optimizer.check_aim()?;
        optimizer.check_units()?;
        // all that may be wrong with keys and the scene
        optimizer.gradients(&[])?;
        let start = optimizer.numbers.iter().map(|number| optimizer.start_of(number));
        optimizer.start = start.collect::<Result<_, Error>>()?;
        Ok(optimizer)
    }

    /// # Errors
    /// Goals that are not as many as there are quantities; more than one of these, or squares of measurements, without them.
    fn check_aim(&self) -> Result<(), InputError> {
        let count = self.objectives.len();
        let of_data = |objective: &Objective| {
            matches!(objective, Objective::LeastSquares(_) | Objective::LeastSquaresAtRest(_))
        };
        if self.objectives.iter().any(of_data) {
            let help = "least squares against measurements are a fit: pliant fit, SceneFit";
            return Err(InputError::new("quantity", "squares of what is left over", help));
        }
        match &self.aim {
            Aim::Goals(goals) if goals.len() == count && count > 0 => finite("goals", goals),
            Aim::Goals(goals) => {
                let help = format!("there must be one for each quantity, {count}");
                Err(InputError::new("number of goals", goals.len(), help))
            }
            _ if count == 1 => Ok(()),
            _ => {
                let help = "name one, or give each of them a goal";
                Err(InputError::new("number of quantities", count, help))
            }
        }
    }

    /// # Errors
    /// Quantities that the scene does not have, or in several units.
    fn check_units(&self) -> Result<(), Error> {
        let file = self.reader.parse_with(&self.text, &self.path, &self.overrides)?;
        let mut units: Vec<&str> = Vec::new();
        for objective in &self.objectives {
            let unit = match objective {
                Objective::Quantity(text) => quantity(text, &file, false)?.unit(),
                Objective::QuantityAtRest(text) => quantity(text, &file, true)?.unit(),
                _ => continue,
            };
            if !units.contains(&unit) {
                units.push(unit);
            }
        }
        match units.len() {
            ..=1 => Ok(()),
            _ => {
                let help =
                    "the squares of their distances are added up, so that they must have one unit";
                let units = units.join(", ");
                Err(InputError::new("units of quantities with goals", units, help).into())
            }
        }
    }

    /// The number of the file.
    fn start_of(&self, number: &Unknown) -> Result<f64, Error> {
        let Unknown { name, range: range @ [least, most] } = number;
        number.validate()?;
        let (text, path) = (&self.text, &self.path);
        let stated = SceneFile::value_of(text, path, &self.overrides, name)?;
        let start = stated.and_then(|value| value.number()).unwrap_or(f64::NAN);
        if !(*least..=*most).contains(&start) {
            let help = format!(
                "the scene file says {}, from which the search would begin: widen the range, or give another value by --set {name}=VALUE",
                four_digits(start)
            );
            let told = format!("{least:?}..{most:?}");
            return Err(InputError::new(format!("range of {name}"), told, help).into());
        }
        for &end in range {
            let other = [&self.overrides[..], &[set(name, end)]].concat();
            self.reader.parse_with(text, path, &other).map_err(|error| {
                let help = format!("the scene does not take this end: {}", problem(error));
                InputError::new(format!("range of {name}"), format!("{end:?}"), help)
            })?;
        }
        Ok(start)
    }

    /// The objectives with other values for some keys.
    fn gradients(&self, others: &[String]) -> Result<Vec<SceneGradient>, Error> {
        let by: Vec<&str> = self.numbers.iter().map(|number| &number.name[..]).collect();
        let set = [&self.overrides[..], others].concat();
        let of = |objective: &Objective| {
            let (text, path) = (&self.text[..], &self.path);
            SceneGradient::of_text(&self.reader, text, path, &set, objective.clone(), &by)
        };
        self.objectives.iter().map(of).collect()
    }

    /// Writes the scene file with the values of an evaluation, and with whole paths of the files that it names, to a file.
    ///
    /// # Errors
    /// A value for which the text has no place; [`Error::Output`].
    pub fn write_scene(
        &self,
        evaluation: &Evaluation,
        path: impl AsRef<Path>,
    ) -> Result<(), Error> {
        let set = [&self.overrides[..], &overrides(&self.numbers, &evaluation.values)].concat();
        let text = SceneFile::moved_with(&self.text, &self.path, &set)?;
        write_file(path.as_ref(), |file| file.write_all(text.as_bytes()))
    }

    /// The numbers with which the quantity is best. `tell` is given each evaluation, and ends the search by an error.
    ///
    /// # Errors
    /// [`Error::Integration`] and [`Error::Statics`] where the first evaluation fails; a number that nothing depends on there; an error of `tell`.
    pub fn optimize(
        &self,
        tell: &mut dyn FnMut(&Evaluation) -> Result<(), Error>,
    ) -> Result<Optimum, Error> {
        let mut evaluations: Vec<Evaluation> = Vec::new();
        let mut least = f64::INFINITY;
        let mut evaluate = |parts: &[f64]| {
            let values: Vec<f64> = match evaluations.is_empty() {
                true => self.start.clone(),
                false => self.numbers.iter().zip(parts).map(|(number, x)| number.at(*x)).collect(),
            };
            let found = self.gradients(&overrides(&self.numbers, &values)).and_then(|gradients| {
                gradients.iter().map(|by| by.value_and_gradient(&mut |_| {})).collect()
            });
            let found: Result<Vec<Gradient>, Error> = found;
            let (gradients, seen) = match found {
                Ok(gradients) => {
                    if evaluations.is_empty() {
                        self.check_influence(&gradients)?;
                    }
                    let seen = self.seen(&gradients, parts);
                    (Ok(gradients), Some(seen))
                }
                Err(error) if evaluations.is_empty() => return Err(error),
                Err(error) => (Err(error.to_string()), None),
            };
            let is_best = seen.as_ref().is_some_and(|seen| seen.value < least);
            if let Some(seen) = &seen {
                least = least.min(seen.value);
            }
            let evaluation = Evaluation { values, gradients, is_best };
            tell(&evaluation)?;
            evaluations.push(evaluation);
            Ok(seen)
        };
        let start = self.numbers.iter().zip(&self.start).map(|(number, x)| number.part(*x));
        let (best, ending) = search::least(start.collect(), &mut evaluate)?;
        let (numbers, aim) = (self.numbers.clone(), self.aim.clone());
        Ok(Optimum { aim, numbers, evaluations, best, ending })
    }

    /// # Errors
    /// A number that no quantity depends on.
    fn check_influence(&self, gradients: &[Gradient]) -> Result<(), InputError> {
        for (at, number) in self.numbers.iter().enumerate() {
            if gradients.iter().all(|gradient| gradient.derivatives[at].is_constant) {
                let of: Vec<&str> = gradients.iter().map(|gradient| &gradient.of[..]).collect();
                let help = format!(
                    "{} does not depend on it where the search would begin: leave it out, or begin elsewhere by --set {}=VALUE",
                    of.join(", "),
                    number.name
                );
                return Err(InputError::new("number", &number.name, help));
            }
        }
        Ok(())
    }

    /// The function that is to be least.
    fn seen(&self, gradients: &[Gradient], parts: &[f64]) -> Seen {
        let by_part = |pick: fn(&Derivative) -> f64, gradient: &Gradient| {
            let derivatives = gradient.derivatives.iter().zip(self.numbers.iter().zip(parts));
            let parts = derivatives.map(|(by, (number, x))| pick(by) * number.slope(*x));
            DVector::from_iterator(self.numbers.len(), parts)
        };
        let [slope, error] = [|by: &Derivative| by.value, |by: &Derivative| by.error];
        // a value is about as accurate as its run
        let noise = |gradient: &Gradient| gradient.rtols[1] * gradient.value.abs();
        let goals = match &self.aim {
            Aim::Goals(goals) => goals,
            aim => {
                let sign = if *aim == Aim::Largest { -1.0 } else { 1.0 };
                let one = &gradients[0];
                return Seen {
                    value: sign * one.value,
                    noise: noise(one),
                    slopes: sign * by_part(slope, one),
                    errors: by_part(error, one),
                    model: None,
                };
            }
        };
        let count = self.numbers.len();
        let mut seen = Seen {
            value: 0.0,
            noise: 0.0,
            slopes: DVector::zeros(count),
            errors: DVector::zeros(count),
            model: None,
        };
        let mut rows = Vec::new();
        for (gradient, goal) in gradients.iter().zip(goals) {
            let (off, noise) = (gradient.value - goal, noise(gradient));
            let row = by_part(slope, gradient);
            seen.value += off * off;
            seen.noise += 2.0 * off.abs() * noise + noise * noise;
            seen.slopes += 2.0 * off * &row;
            seen.errors += 2.0 * (off.abs() * by_part(error, gradient) + noise * row.abs());
            rows.push(row);
        }
        seen.model = Some(Model::of_squares(&rows, count));
        seen
    }
}
