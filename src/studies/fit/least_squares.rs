//! Least squares within ranges: the Levenberg-Marquardt method, with difference quotients from runs on all
//! cores.
//!
//! The search is that of MINPACK with bounds, by `rmpfit`; the crate `levenberg-marquardt` has no bounds and
//! brings a nalgebra of its own. Unknowns are fractions of their ranges, logarithmic where ranges are
//! above 0. Differences are central, with a step of the square root of the tolerance of the runs: the noise of
//! results is then an error of that relative size in a derivative, and an unknown whose column of the
//! Jacobian is below that fraction of the largest one, or a combination whose singular value is, is not
//! fitted but named, before the search and after it. A run that fails is a bad step with large residuals; a
//! derivative then takes the other side.

use rayon::prelude::*;
use rmpfit::{MPConfig, MPError, MPFitter, MPPar, MPResult, MPSide, MPSuccess};

use super::confidence::{confidence, independent, norm};
use super::unknown::Unknown;
use crate::base::input::InputError;
use crate::dynamics::error::Error;

/// The residuals of a model against measurements, as a function of the unknowns.
///
/// There is a series for each quantity that was measured, in order of time; its length is the same at all
/// values.
pub type Residuals<'a> = dyn Fn(&[f64]) -> Result<Vec<Vec<f64>>, Error> + Sync + 'a;

/// Unknowns that were fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// The unknowns, each with its value and confidence interval.
    pub unknowns: Vec<Determined>,
    /// Root mean square of the residuals: in the middle of the ranges, and at the values that were found.
    pub rms: [f64; 2],
    /// How many residuals there are.
    pub residuals: usize,
    /// How many independent residuals they count as, at the values that were found: n / (1 + 2 sum |rho_k|)
    /// for a series of n, with its significant autocorrelations rho_k.
    pub independent: f64,
    /// How often the residuals were computed.
    pub runs: usize,
    /// How many of these runs failed: they counted as bad steps.
    pub failed: usize,
    /// Whether the search has converged: further runs would change next to nothing.
    pub is_converged: bool,
}

/// The value of an unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct Determined {
    /// The unknown.
    pub unknown: Unknown,
    /// The value with the least sum of squares.
    pub value: f64,
    /// Half width of its 95 % confidence interval, if the residuals are errors of one variance, and those of
    /// different series are independent. Within a series they need not be ([`Fitted::independent`]). Errors
    /// of the model that are correlated between series are not covered: then it is too small.
    pub confidence: f64,
}

impl Determined {
    /// Whether its value is at an end of its range.
    pub fn is_at_end(&self) -> bool {
        self.unknown.range.contains(&self.value)
    }
}

/// A relative change of the sum of squares, or of the unknowns, that is worth no further run.
const ENOUGH: f64 = 1e-4;
/// Most steps of the search.
const MOST_STEPS: usize = 50;
/// Value of the residuals of a run that failed, relative to the norm of those in the middle of the ranges.
const BAD: f64 = 1e3;

/// Finds the values of the `unknowns` within their ranges that minimize the sum of squares of the
/// `residuals`.
///
/// The search starts in the middle of the ranges.
///
/// `precision` is the accuracy of the residuals, relative to their own range: the tolerance of the runs
/// behind them. Derivatives are central differences with its square root as step, in parts of the range of
/// each unknown: the relative error of the derivatives that the tolerance causes has that size, too. `tell`
/// is called for each run of the search, with the number of runs so far and the root mean square of the
/// residuals.
///
/// Where residuals cannot be computed because a run fails, the step counts as a bad one, and the next is
/// shorter; a derivative takes the other side.
///
/// The method is that of MINPACK, as the crate `rmpfit` has it.
///
/// ```
/// use pliant::fit::{Unknown, least_squares};
///
/// let fall = |g: f64, t: f64| 0.5 * g * t * t;
/// let seen: Vec<(f64, f64)> = (1..20).map(|k| 0.05 * f64::from(k)).map(|t| (t, fall(9.8, t))).collect();
/// let residuals = |at: &[f64]| Ok(vec![seen.iter().map(|(t, x)| fall(at[0], *t) - x).collect()]);
/// let fitted = least_squares(&[Unknown::new("g", 1.0, 30.0)], 1e-12, &residuals, &mut |_, _| {})?;
/// assert!((fitted.unknowns[0].value - 9.8).abs() < 1e-4 && fitted.is_converged);
/// # Ok::<(), pliant::Error>(())
/// ```
///
/// # Errors
/// No unknown, or one without a range; no more residuals than unknowns; residuals that do not change with an
/// unknown, or change alike with several; errors of `residuals` in the middle of the ranges, or on both sides
/// of a point.
pub fn least_squares(
    unknowns: &[Unknown],
    precision: f64,
    residuals: &Residuals,
    tell: &mut dyn FnMut(usize, f64),
) -> Result<Fitted, Error> {
    if unknowns.is_empty() {
        let help = "name what is to be found, with its range";
        return Err(InputError::new("number of unknowns", 0, help).into());
    }
    unknowns.iter().try_for_each(Unknown::validate)?;
    let mut parts = vec![0.5; unknowns.len()];
    let step = precision.sqrt();
    let mut search = Search::new(unknowns, residuals, step, tell);
    let first = search.run(&parts)?;
    if first.len() <= unknowns.len() {
        let help = format!("it must be above the number of unknowns, {}", unknowns.len());
        return Err(InputError::new("number of measured values", first.len(), help).into());
    }
    search.bad = BAD * norm(&first);
    // unknowns that cannot be identified are reported before the search
    let slopes = search.slopes(&parts, &first)?;
    confidence(unknowns, &slopes, &first, first.len() as f64, step)?;
    search.known = Some((parts.clone(), slopes));
    let is_converged = match search.mpfit(&mut parts) {
        Ok(status) => status.success != MPSuccess::MaxIter,
        Err(error) => return Err(search.failure.take().unwrap_or_else(|| stuck(&error))),
    };
    let last = search.run(&parts)?;
    let slopes = search.slopes(&parts, &last)?;
    let independent = search.series(&last).map(independent).sum();
    let half_widths = confidence(unknowns, &slopes, &last, independent, step)?;
    let found = unknowns.iter().zip(&parts).zip(half_widths);
    let determined = |((unknown, &part), half): ((&Unknown, &f64), f64)| Determined {
        unknown: unknown.clone(),
        value: unknown.at(part),
        confidence: half * unknown.slope(part),
    };
    let (unknowns, rms) = (found.map(determined).collect(), [rms(&first), rms(&last)]);
    let Search { runs, failed, .. } = search;
    let residuals = last.len();
    Ok(Fitted { unknowns, rms, residuals, independent, runs, failed, is_converged })
}

/// A search that failed without an error of the residuals.
fn stuck(error: &MPError) -> Error {
    let help = "each residual must be a finite number everywhere in the ranges: narrow them";
    InputError::new("residuals", error, help).into()
}

pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// A search; points are given in parts of the ranges.
struct Search<'a> {
    unknowns: &'a [Unknown],
    residuals: &'a Residuals<'a>,
    /// Step of the difference quotients.
    step: f64,
    tell: &'a mut dyn FnMut(usize, f64),
    /// Number of residuals of each series.
    counts: Vec<usize>,
    runs: usize,
    failed: usize,
    /// Value of the residuals where a run fails.
    bad: f64,
    /// A point with known derivatives, and these.
    known: Option<(Vec<f64>, Vec<Vec<f64>>)>,
    /// Why a run failed.
    failure: Option<Error>,
    settings: MPConfig,
    limits: Vec<MPPar>,
}

impl<'a> Search<'a> {
    fn new(
        unknowns: &'a [Unknown],
        residuals: &'a Residuals<'a>,
        step: f64,
        tell: &'a mut dyn FnMut(usize, f64),
    ) -> Self {
        let limits = unknowns.iter().map(|_| MPPar {
            limited_low: true,
            limited_up: true,
            limit_up: 1.0,
            side: MPSide::User,
            ..MPPar::new()
        });
        let settings =
            MPConfig { ftol: ENOUGH, xtol: ENOUGH, max_iter: MOST_STEPS, ..MPConfig::new() };
        let limits = limits.collect();
        let (counts, runs, failed, bad) = (Vec::new(), 0, 0, f64::INFINITY);
        let (known, failure) = (None, None);
        Self {
            unknowns,
            residuals,
            step,
            tell,
            counts,
            runs,
            failed,
            bad,
            known,
            failure,
            settings,
            limits,
        }
    }

    fn values(&self, parts: &[f64]) -> Vec<f64> {
        self.unknowns.iter().zip(parts).map(|(unknown, part)| unknown.at(*part)).collect()
    }

    /// The residuals at a point.
    fn run(&mut self, parts: &[f64]) -> Result<Vec<f64>, Error> {
        let series = (self.residuals)(&self.values(parts))?;
        if self.counts.is_empty() {
            self.counts = series.iter().map(Vec::len).collect();
        }
        let residuals = self.checked(series)?;
        self.runs += 1;
        (self.tell)(self.runs, rms(&residuals));
        Ok(residuals)
    }

    /// Joins the series, one after the other.
    ///
    /// # Errors
    /// If there are not as many residuals as at first.
    fn checked(&self, series: Vec<Vec<f64>>) -> Result<Vec<f64>, Error> {
        if !series.iter().map(Vec::len).eq(self.counts.iter().copied()) {
            let found = series.iter().map(Vec::len).sum::<usize>();
            let count = self.number_of_points();
            let help =
                format!("there were {count} at other values of the unknowns: leave none out");
            return Err(InputError::new("number of residuals", found, help).into());
        }
        Ok(series.concat())
    }

    /// The series of which `residuals` are made.
    fn series<'r>(&self, mut residuals: &'r [f64]) -> impl Iterator<Item = &'r [f64]> {
        self.counts.iter().map(move |count| {
            let (series, others) = residuals.split_at(*count);
            residuals = others;
            series
        })
    }

    /// The derivatives of the residuals with respect to the parts, unknown by unknown, at a point with the
    /// residuals `here`: one-sided at the end of a range, or where a run fails.
    fn slopes(&mut self, parts: &[f64], here: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        let ends = |part: f64| [(part - self.step).max(0.0), (part + self.step).min(1.0)];
        let places: Vec<Vec<f64>> = (0..2 * parts.len())
            .map(|number| {
                let mut place = parts.to_vec();
                place[number / 2] = ends(parts[number / 2])[number % 2];
                self.values(&place)
            })
            .collect();
        let residuals = self.residuals;
        let runs: Vec<_> = places.par_iter().map(|values| residuals(values)).collect();
        let mut at = Vec::with_capacity(runs.len());
        self.runs += places.len();
        for run in runs {
            at.push(match run {
                Ok(series) => Ok(self.checked(series)?),
                Err(error) => {
                    self.failed += 1;
                    Err(error)
                }
            });
        }
        let mut slopes = Vec::with_capacity(parts.len());
        let mut at = at.into_iter();
        for &part in parts {
            let [low, high] = ends(part);
            let pair = match (at.next(), at.next()) {
                (Some(Err(_)), Some(Err(error))) => return Err(error),
                (Some(Ok(low_r)), Some(Ok(high_r))) => [(low, low_r), (high, high_r)],
                (Some(Ok(low_r)), _) => [(low, low_r), (part, here.to_vec())],
                (_, Some(Ok(high_r))) => [(part, here.to_vec()), (high, high_r)],
                _ => break,
            };
            let [(low, low_r), (high, high_r)] = pair;
            let slope = low_r.iter().zip(&high_r);
            slopes.push(slope.map(|(low_r, high_r)| (high_r - low_r) / (high - low)).collect());
        }
        Ok(slopes)
    }

    fn noted<T>(&mut self, result: Result<T, Error>) -> MPResult<T> {
        result.map_err(|error| {
            self.failure = Some(error);
            MPError::Eval
        })
    }
}

impl MPFitter for Search<'_> {
    fn eval(&mut self, parts: &[f64], residuals: &mut [f64]) -> MPResult<()> {
        let series = (self.residuals)(&self.values(parts));
        self.runs += 1;
        match series {
            Ok(series) => {
                let found = self.checked(series);
                residuals.copy_from_slice(&self.noted(found)?);
                (self.tell)(self.runs, rms(residuals));
            }
            Err(_) => {
                self.failed += 1;
                residuals.fill(self.bad);
            }
        }
        Ok(())
    }

    fn number_of_points(&self) -> usize {
        self.counts.iter().sum()
    }

    fn config(&self) -> &MPConfig {
        &self.settings
    }

    fn parameters(&self) -> &[MPPar] {
        &self.limits
    }

    fn jacobian(
        &mut self,
        parts: &[f64],
        residuals: &mut [f64],
        slopes: &mut [Option<Vec<f64>>],
    ) -> MPResult<()> {
        let found = match self.known.take() {
            Some((at, slopes)) if at == parts => Ok(slopes),
            _ => self.slopes(parts, residuals),
        };
        for (place, column) in slopes.iter_mut().zip(self.noted(found)?) {
            *place = Some(column);
        }
        Ok(())
    }
}
