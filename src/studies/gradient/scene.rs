//! The gradient of an objective of a scene file: its runs, and the derivatives from them.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::answer::{Check, Derivative, Doubt, Gradient};
use super::method::Method;
use super::number::{Number, numbers};
use super::objective::{self, Objective, Seen, part_of_time};
use super::runs::{AT_THE_END, Base, Costs, Runs, Stop, Target};
use super::tableau::{Extrapolated, extrapolated};
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::io::scene_file::{SceneReader, text_of};
use crate::studies::fit::SceneFit;

/// The derivatives of an objective by numbers of a scene file.
///
/// ```
/// use pliant::gradient::{Objective, SceneGradient};
///
/// # let place = tempfile::tempdir().unwrap();
/// # let scene = place.path().join("bar.toml");
/// # std::fs::write(&scene, r#"
/// #     body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 0.0 } }
/// #     phase = { name = "pull", until = 1.0, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
/// #     sensor = { name = "tip", kind = "displacement", nodes = "right" }
/// # "#).unwrap();
/// // a bar, stretched by F L / (E A)
/// let stretch = Objective::QuantityAtRest("tip.x".into());
/// let gradient = SceneGradient::new(&scene, &[], stretch, &["body.material.young"])?.value_and_gradient(&mut |_| {})?;
/// let by_young = &gradient.derivatives[0];
/// assert!((by_young.value + gradient.value / 1e5).abs() < by_young.error + 1e-15);
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SceneGradient {
    runs: Runs,
    of: String,
    unit: String,
    numbers: Vec<Number>,
    method: Option<Method>,
    is_checked: bool,
    /// The relative tolerance of the file, of motions or of equilibria.
    rtol: f64,
    /// Reason for which runs cannot take the steps of another one.
    refused: Option<String>,
    /// Whether the objective is a reading at the end of a motion, or of an equilibrium.
    is_at_end: bool,
}

/// Settings of the runs, and steps of differences.
struct Scheme {
    method: Method,
    /// Relative tolerances: that of the derivative, and the larger one that it is compared with.
    rtols: [f64; 2],
    /// The first step of differences, as a part of a number, and how many there are, each half as long as the one before.
    first: f64,
    rows: usize,
}

/// The derivative by one number, from differences.
struct DifferenceQuotients {
    slope: Extrapolated,
    /// The quotients of the second step at both tolerances.
    quotients: [Vec<f64>; 2],
    /// Whether all runs saw the same value.
    is_constant: bool,
}

/// Relative error of the differences from which on other steps are tried, and the factors of these.
const ROUGH: f64 = 1e-5;
const FACTORS: [f64; 2] = [16.0, 1.0 / 16.0];

/// Relative tolerances of equilibria.
const AT_REST: [f64; 2] = [1e-13, 1e-12];

/// Reason for which equilibria are not found by the steps of others.
const NO_STEPS: &str = "equilibria have no steps";

/// Count of numbers from which on the adjoint is the default.
const MANY: usize = 2;

/// Part of a derivative by which results of both tolerances may differ.
const MEANINGFUL: f64 = 0.1;
/// Changes of the objective below this part of it, for a change of a number by itself, count as none.
const NOTHING: f64 = 1e-6;
/// Relative differences of results that are the same.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;

impl SceneGradient {
    /// The gradient of an objective of the scene file at `path` by the numbers of the keys `by`, with other values as
    /// [`SceneFile::read_with`](crate::SceneFile::read_with) takes them.
    ///
    /// # Errors
    /// As [`SceneFile::read_with`](crate::SceneFile::read_with) and, for measurements, as [`SceneFit::new`]; an objective that the scene does not have or that is
    /// no single number; no key, a key that stands twice, or that is not a number which may change.
    pub fn new(
        path: impl Into<PathBuf>,
        overrides: &[String],
        objective: Objective,
        by: &[impl AsRef<str>],
    ) -> Result<Self, Error> {
        let path = path.into();
        Self::of_text(&SceneReader::default(), text_of(&path)?, path, overrides, objective, by)
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
        objective: Objective,
        by: &[impl AsRef<str>],
    ) -> Result<Self, Error> {
        let (text, path) = (text.into(), path.into());
        let file = reader.parse_with(&text, &path, overrides)?;
        let squares = |fit: SceneFit| {
            let unit = fit.unit().map_or_else(|| "1".into(), |unit| format!("{unit}^2"));
            ("squares of what is left over".to_owned(), Target::LeastSquares(Box::new(fit)), unit)
        };
        let mut is_at_end = false;
        let (of, target, unit) = match objective {
            Objective::Quantity(text) => {
                let quantity = objective::quantity(&text, &file, false)?;
                is_at_end = quantity.is_at_end();
                (quantity.to_string(), Target::Quantity(text), quantity.unit().into())
            }
            Objective::QuantityAtRest(text) => {
                is_at_end = true;
                let unit = objective::quantity(&text, &file, true)?.unit().into();
                (text.clone(), Target::QuantityAtRest(text), unit)
            }
            Objective::LeastSquares(measured) => {
                squares(SceneFit::of_text(reader, &*text, &*path, overrides, &measured)?)
            }
            Objective::LeastSquaresAtRest(measured) => {
                squares(SceneFit::at_rest_of_text(reader, &*text, &*path, overrides, &measured)?)
            }
        };
        let numbers = numbers(by, reader, (&text, &path), overrides)?;
        let is_at_rest = match &target {
            Target::Quantity(_) => false,
            Target::QuantityAtRest(_) => true,
            Target::LeastSquares(fit) => fit.is_at_rest(),
        };
        let ends = || file.scene.phases().iter().find(|phase| phase.ends.is_some());
        let refused = match is_at_rest {
            true => {
                file.check_equilibrium()?;
                let why = match &target {
                    Target::LeastSquares(_) => Some(NO_STEPS),
                    _ => (file.statics.options.arc_steps > 0)
                        .then_some("equilibria by arc length have loads of their own"),
                };
                why.map(str::to_owned)
            }
            false => {
                // all that is wrong with the scene
                _ = file.scene.start(&file.settings)?;
                ends().map(|phase| format!("phase \"{}\" ends by a sensor", phase.name()))
            }
        };
        let rtol = if is_at_rest { file.statics.options.rtol } else { file.settings.rtol };
        let (reader, overrides) = (reader.clone(), overrides.into());
        let (method, is_checked) = (None, false);
        Ok(Self {
            runs: Runs { reader, text, path, overrides, target },
            of,
            unit,
            numbers,
            method,
            is_checked,
            rtol,
            refused,
            is_at_end,
        })
    }

    /// By this method. Default: [`Method::Adjoint`] of an equilibrium, and by several numbers of a reading at the end; else, and where steps
    /// have no adjoint, [`Method::SameSteps`]; [`Method::Differences`] where runs cannot take the same steps and equilibria cannot be
    /// linearized.
    ///
    /// # Errors
    /// A method that the scene or the objective does not allow.
    pub fn by_method(mut self, method: Method) -> Result<Self, InputError> {
        let refused = match (method, &self.refused) {
            (Method::SameSteps | Method::Adjoint, Some(why)) => Some((&**why, Method::Differences)),
            (Method::SameSteps, None) if self.runs.target.is_at_rest() => {
                Some((NO_STEPS, Method::Adjoint))
            }
            (Method::Adjoint, None) if !self.is_at_end => Some((AT_THE_END, Method::SameSteps)),
            _ => None,
        };
        if let Some((why, other)) = refused {
            let help = format!("{why}: take {other}");
            return Err(InputError::new("method of the gradient", method, help));
        }
        self.method = Some(method);
        Ok(self)
    }

    /// With a [`Check`] of each derivative: differences of whole runs, by steps of their own.
    #[must_use]
    pub fn checked(mut self) -> Self {
        self.is_checked = true;
        self
    }

    /// The value and the derivatives. `tell` is given the number of runs, now and then.
    ///
    /// # Errors
    /// [`Error::Integration`] and [`Error::Statics`] of a run that fails; with a [method](Self::by_method), a run that needs other steps.
    pub fn value_and_gradient(&self, tell: &mut dyn FnMut(usize)) -> Result<Gradient, Error> {
        let differences = |first| Scheme {
            method: Method::Differences,
            rtols: match self.runs.target.is_at_rest() {
                true => AT_REST,
                false => {
                    let fine = (1e-5 * self.rtol).max(1e-10).min(0.1 * self.rtol);
                    [fine, 10.0 * fine]
                }
            },
            first,
            rows: 4,
        };
        let fine = (0.01 * self.rtol).max(1e-10).min(0.1 * self.rtol);
        let is_at_rest = self.runs.target.is_at_rest();
        let method = match self.method {
            Some(Method::Adjoint) => Method::Adjoint,
            None if is_at_rest || self.is_at_end && self.numbers.len() >= MANY => Method::Adjoint,
            _ => Method::SameSteps,
        };
        let by_equations = match is_at_rest {
            true => Scheme { method, rtols: AT_REST, first: 1e-2, rows: 4 },
            false => Scheme { method, rtols: [fine, 10.0 * fine], first: 5e-5, rows: 2 },
        };
        let why = match (self.method, &self.refused) {
            (Some(Method::Differences), _) => None,
            (_, Some(refused)) => Some(refused.clone()),
            (method, None) => match (self.find_by(&by_equations, tell), method) {
                (Ok(mut gradient), method) => {
                    let is_refused =
                        method.is_none() && !self.is_at_end && self.numbers.len() >= MANY;
                    gradient.reason = gradient.reason.or(is_refused.then(|| AT_THE_END.to_owned()));
                    return self.with_check(gradient, &differences(0.007), tell);
                }
                (Err(Stop::Failed(error)), Some(_)) => return Err(error),
                (Err(Stop::Unsuited(why)), Some(method)) => {
                    let help = format!("{why}: take {}", Method::Differences);
                    return Err(InputError::new("method of the gradient", method, help).into());
                }
                (Err(Stop::Unsuited(why)), None) => Some(why),
                (Err(Stop::Failed(error)), None) => Some(error.to_string()),
            },
        };
        match self.find_by(&differences(0.02), tell) {
            Ok(gradient) => {
                self.with_check(Gradient { reason: why, ..gradient }, &differences(0.007), tell)
            }
            Err(Stop::Failed(error)) => Err(error),
            Err(Stop::Unsuited(why)) => Err(InputError::new("steps", "others", why).into()),
        }
    }

    /// Adds checks, if requested.
    fn with_check(
        &self,
        mut gradient: Gradient,
        scheme: &Scheme,
        tell: &mut dyn FnMut(usize),
    ) -> Result<Gradient, Error> {
        if !self.is_checked {
            return Ok(gradient);
        }
        let before = gradient.runs;
        match self.find_by(scheme, &mut |runs| tell(before + runs)) {
            Ok(by_differences) => {
                let pairs = gradient.derivatives.iter_mut().zip(&by_differences.derivatives);
                for (derivative, by_differences) in pairs {
                    let Derivative { value, error, .. } = *by_differences;
                    derivative.check = Some(Check { value, error });
                }
                Ok(gradient)
            }
            Err(Stop::Failed(error)) => Err(error),
            Err(Stop::Unsuited(_)) => Ok(gradient),
        }
    }

    fn find_by(&self, scheme: &Scheme, tell: &mut dyn FnMut(usize)) -> Result<Gradient, Stop> {
        let costs = Costs::default();
        let base = |rtol: f64| -> Result<Base, Stop> {
            let (seen, record) = self.runs.observe(None, rtol, scheme.method, None, &costs)?;
            Ok(Base { rtol, seen, record })
        };
        let [fine, coarse] = scheme.rtols;
        let bases = [base(fine)?, base(coarse)?];
        let all: Vec<usize> = (0..self.numbers.len()).collect();
        let differences = || self.differences(scheme, &bases, &all, 1.0, &costs);
        let (mut found, method, reason) = match scheme.method {
            Method::Adjoint => match self.taken_back(scheme, &bases, &costs) {
                Ok(found) => (found, Method::Adjoint, None),
                Err(why) if self.runs.target.is_at_rest() => return Err(Stop::Unsuited(why)),
                Err(why) if self.method == Some(Method::Adjoint) => {
                    let help = format!("{why}: take {}", Method::SameSteps);
                    let error = InputError::new("method of the gradient", Method::Adjoint, help);
                    return Err(Stop::Failed(error.into()));
                }
                Err(why) => (differences()?, Method::SameSteps, Some(why)),
            },
            method => (differences()?, method, None),
        };
        tell(costs.runs());
        for factor in FACTORS.into_iter().filter(|_| method != Method::Adjoint) {
            let is_rough =
                |found: &DifferenceQuotients| found.slope.error > ROUGH * found.slope.slope().abs();
            let rough: Vec<usize> =
                all.iter().copied().filter(|&at| is_rough(&found[at])).collect();
            // a scene may not take numbers so far away
            let others = self.differences(scheme, &bases, &rough, factor, &costs);
            for (at, other) in rough.into_iter().zip(others.into_iter().flatten()) {
                if other.slope.error < found[at].slope.error || found[at].is_constant {
                    found[at] = other;
                }
            }
            tell(costs.runs());
        }
        let seen = &bases[0].seen;
        let derivatives = self.numbers.iter().zip(found);
        let derivatives =
            derivatives.map(|(number, found)| self.derivative(number, found, seen, scheme));
        let steps = seen.steps.max(1);
        Ok(Gradient {
            of: self.of.clone(),
            value: seen.value(),
            unit: self.unit.clone(),
            is_at_rest: self.runs.target.is_at_rest(),
            method,
            reason,
            rtols: scheme.rtols.map(rounded),
            derivatives: derivatives.collect(),
            runs: costs.runs(),
            cost: costs.steps.load(Ordering::Relaxed) as f64 / steps as f64,
        })
    }

    /// The derivatives by all numbers, by the adjoint of the steps of runs; or the reason for its failure.
    ///
    /// At the smaller tolerance with the first step of the differences alone, which has the least round-off: what longer steps are off by is
    /// that at the larger one.
    fn taken_back(
        &self,
        scheme: &Scheme,
        bases: &[Base; 2],
        costs: &Costs,
    ) -> Result<Vec<DifferenceQuotients>, String> {
        let step = |number: &Number, row: usize| {
            number.first_step(scheme.first) * 0.5_f64.powi(row as i32)
        };
        let quotients = |base: &Base, rows: Range<usize>| {
            let ends: Vec<(&Number, [f64; 2])> = self
                .numbers
                .iter()
                .flat_map(|number| {
                    rows.clone().map(move |row| (number, number.ends(step(number, row))))
                })
                .collect();
            let others: Vec<(&Number, f64)> =
                ends.iter().flat_map(|(number, ends)| ends.map(|at| (*number, at))).collect();
            let sums = self.runs.lagrangians(base, &others, costs)?;
            let quotient = |(sums, (_, ends)): (&[f64], &(&Number, [f64; 2]))| {
                let (change, width) = (sums[0] - sums[1], ends[0] - ends[1]);
                let round_off = ROUND_OFF * sums[0].abs();
                (change / width, round_off / width, change.abs() <= round_off)
            };
            Ok::<Vec<(f64, f64, bool)>, String>(sums.chunks(2).zip(&ends).map(quotient).collect())
        };
        let fine = quotients(&bases[0], 0..1)?;
        let coarse = quotients(&bases[1], 0..scheme.rows)?;
        let each = self.numbers.iter().zip(fine.iter().zip(coarse.chunks(scheme.rows)));
        let found = each.filter_map(|(number, (&(of_fine, round_off, is_same), coarse))| {
            let of_coarse: Vec<Vec<f64>> = coarse.iter().map(|of| vec![of.0]).collect();
            let Extrapolated { slopes, error } = extrapolated(&of_coarse, number.order())?;
            let (limit, of_coarse) = (*slopes.last()?, coarse.first()?.0);
            let slope = of_fine + limit - of_coarse;
            let error = error.max(round_off) + bases[0].error() * slope.abs();
            Some(DifferenceQuotients {
                slope: Extrapolated { slopes: vec![slope], error },
                quotients: [of_fine, of_coarse].map(|of| vec![of]),
                is_constant: is_same && coarse.iter().all(|of| of.2),
            })
        });
        Ok(found.collect())
    }

    /// Differences by some of the numbers, with steps of so many times the usual ones.
    fn differences(
        &self,
        scheme: &Scheme,
        bases: &[Base; 2],
        numbers: &[usize],
        factor: f64,
        costs: &Costs,
    ) -> Result<Vec<DifferenceQuotients>, Stop> {
        // the second step at both tolerances, the others at the first
        let rows = (0..scheme.rows).map(|row| (row, &bases[0])).chain([(1, &bases[1])]);
        let jobs: Vec<(&Number, f64, &Base)> = numbers
            .iter()
            .flat_map(|&at| {
                let number = &self.numbers[at];
                let first = factor * number.first_step(scheme.first);
                rows.clone()
                    .map(move |(row, base)| (number, first * 0.5_f64.powi(row as i32), base))
            })
            .collect();
        let quotient = |(number, step, base): (&Number, f64, &Base)| {
            let at = |value: f64| match value == number.value {
                true => Ok(base.seen.values.clone()),
                false => {
                    let (method, by) = (scheme.method, base.record.as_ref());
                    let seen =
                        self.runs.observe(Some((number, value)), base.rtol, method, by, costs);
                    seen.map(|(seen, _)| seen.values)
                }
            };
            let ends = number.ends(step);
            let [high, low] = [at(ends[0])?, at(ends[1])?];
            let width = ends[0] - ends[1];
            let own = base.seen.value();
            let is_constant = [&high, &low].iter().all(|values| {
                values.last().is_some_and(|value| (value - own).abs() <= ROUND_OFF * own.abs())
            });
            let quotient = high.iter().zip(&low).map(|(high, low)| (high - low) / width);
            Ok((quotient.collect::<Vec<f64>>(), is_constant))
        };
        // of several errors the first one, whichever was found first
        let quotients: Vec<Result<_, Stop>> = jobs.into_par_iter().map(quotient).collect();
        let quotients = quotients.into_iter().collect::<Result<Vec<_>, Stop>>()?;
        let of_number = |(at, quotients): (&usize, &[(Vec<f64>, bool)])| {
            let is_constant = quotients.iter().all(|(_, is_constant)| *is_constant);
            let mut quotients: Vec<Vec<f64>> =
                quotients.iter().map(|(quotient, _)| quotient.clone()).collect();
            let coarse = quotients.pop()?;
            let slope = extrapolated(&quotients, self.numbers[*at].order())?;
            Some(DifferenceQuotients {
                slope,
                quotients: [quotients.swap_remove(1), coarse],
                is_constant,
            })
        };
        Ok(numbers.iter().zip(quotients.chunks(scheme.rows + 1)).filter_map(of_number).collect())
    }

    fn derivative(
        &self,
        number: &Number,
        found: DifferenceQuotients,
        seen: &Seen,
        scheme: &Scheme,
    ) -> Derivative {
        let DifferenceQuotients { slope, quotients: [fine, coarse], is_constant } = found;
        if is_constant {
            // differences are round-off
            return Derivative::constant(number.key.clone(), (number.value, number.unit));
        }
        let value = slope.slope();
        let apart = |k: usize| (fine[k] - coarse[k]).abs();
        let last = fine.len().min(coarse.len()).saturating_sub(1);
        let by_tolerance = apart(last);
        let error = slope.error + by_tolerance;
        let size = seen.values.iter().fold(seen.scale, |size, value| size.max(value.abs()));
        let nothing = NOTHING * size / number.scale();
        let mut doubt = None;
        if error > (MEANINGFUL * value.abs()).max(nothing) || !value.is_finite() {
            let mut largest = nothing;
            let parted = (0..last).find(|&k| {
                largest = largest.max(MEANINGFUL * fine[k].abs());
                apart(k) > largest
            });
            doubt = Some(Doubt {
                by_tolerance: by_tolerance >= slope.error,
                since: parted.map(part_of_time).map(|part| part * self.runs.end()),
                rtols: scheme.rtols.map(rounded),
            });
        }
        Derivative {
            key: number.key.clone(),
            at: number.value,
            at_unit: number.unit,
            value,
            error,
            by_steps: slope.error,
            by_tolerance,
            is_constant: false,
            doubt,
            check: None,
        }
    }
}

/// A tolerance without the digits of its product.
fn rounded(rtol: f64) -> f64 {
    format!("{rtol:.2e}").parse().unwrap_or(rtol)
}
