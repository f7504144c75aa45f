//! Quantities of interest of a motion, and the scales of their errors.
//!
//! A quantity is the whole motion, or a reading of a sensor over time, or a number that follows from it.
//! Charts, verified runs and the adviser measure by the same definitions.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::swings::swings;
use crate::base::input::{InputError, unknown_among};
use crate::dynamics::equilibrium::Equilibrium;
use crate::dynamics::simulate::{Component, Reading, Sampling};
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::mesh::NodeMap;
use crate::elements::rod::SolidAxis;
use crate::scene::timeline::Scene;

/// A quantity of interest: the whole motion, or a number that follows from it.
///
/// | quantity | an error of 1 % is |
/// | --- | --- |
/// | the [whole motion](Self::motion) | a root mean square distance of the nodes, over all of them and all times, of a hundredth of their root mean square displacement |
/// | a [reading](Self::reading) over time | a root mean square error over all times of a hundredth of the reading's root mean square change since the start |
/// | its value at the end, its largest, least or mean | a hundredth of its largest change since the start |
/// | its frequency or damping ratio | a hundredth of itself |
///
/// Errors of a reading with several components (a position) are lengths of vectors.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Quantity {
    reading: Option<Reading>,
    /// Its name, as given.
    name: String,
    part: Part,
}

/// Which part of a reading over time counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Part {
    /// All of it.
    #[default]
    OverTime,
    /// Its value at the end.
    End,
    /// Its largest value.
    Largest,
    /// Its least value.
    Least,
    /// Its mean over time.
    Mean,
    /// The frequency (Hz) at which it swings: that of its turning points.
    Frequency,
    /// Its damping ratio: the mean logarithmic decrement of its swings.
    Damping,
}

impl Part {
    /// All but the first, with the words after a colon that name them.
    const WORDS: [(&'static str, Self); 6] = [
        ("end", Self::End),
        ("max", Self::Largest),
        ("min", Self::Least),
        ("mean", Self::Mean),
        ("frequency", Self::Frequency),
        ("damping", Self::Damping),
    ];
}

/// Motion below this fraction of the body's size counts as that large.
const LEAST_MOTION: f64 = 1e-6;
/// Changes below this part of the largest value are round-off.
const LEAST_CHANGE: f64 = 1e-9;

impl Quantity {
    /// The whole motion: where all nodes are at all times.
    pub fn motion() -> Self {
        Self::default()
    }

    /// Time history of `reading`, with a name for messages.
    pub fn reading(name: impl Into<String>, reading: Reading) -> Self {
        Self { name: name.into(), reading: Some(reading), part: Part::OverTime }
    }

    /// Only this part of it.
    #[must_use]
    pub fn part(mut self, part: Part) -> Self {
        self.part = part;
        self
    }

    /// The quantity that a text names: `motion`; the name of one of the `sensors`, or of one of its
    /// components (`tip.y`); a set of nodes and an axis, `tip.y`, which is their position; `com` or `com.y`,
    /// the centre of mass; `rotation`, the angle by which a body in the plane has turned. After a colon the
    /// part that counts: `tip.y:end`, `max`, `min`, `mean`, `frequency`, `damping`; without, all times count.
    ///
    /// # Errors
    /// A text that names nothing in `scene`.
    pub fn named(
        text: &str,
        scene: &Scene,
        sensors: &[(String, Reading)],
    ) -> Result<Self, InputError> {
        let bad = |help: String| InputError::new("quantity", format!("\"{text}\""), help);
        let (name, part) = match text.rsplit_once(':') {
            None => (text, Part::OverTime),
            Some((name, word)) => {
                let known = Part::WORDS.map(|(word, _)| word);
                let part = Part::WORDS.iter().find(|(known, _)| *known == word);
                let help = || bad(unknown_among(word, &known, "quantity", "parts"));
                (name, part.ok_or_else(help)?.1)
            }
        };
        let quantity = Self { name: name.into(), part, reading: None };
        if name == "motion" {
            return match part {
                Part::OverTime => Ok(Self::motion()),
                _ => Err(bad("the whole motion is no single number: name a reading".into())),
            };
        }
        let reading = reading(name, scene, sensors).ok_or_else(|| bad(help(scene, sensors)))?;
        let quantity = Self { reading: Some(reading), ..quantity };
        quantity.check(scene)?;
        Ok(quantity)
    }

    /// # Errors
    /// A reading that `scene` does not have, or a part of one that has several components.
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), InputError> {
        if self.columns(scene)? > 1 && !self.is_over_time() {
            let help = "it has several components: choose one, as in tip.y:end";
            return Err(InputError::new("quantity", format!("\"{self}\""), help));
        }
        Ok(())
    }

    /// The reading of an equilibrium.
    ///
    /// # Errors
    /// A motion, a part that equilibria do not have, several components.
    pub(crate) fn at_rest(&self, scene: &Scene) -> Result<&Reading, InputError> {
        let refused = |help: &str| Err(self.refused(help));
        let Some(reading) = &self.reading else {
            return refused("the whole motion is no single number: name a reading, as tip.y");
        };
        if ![Part::OverTime, Part::End].contains(&self.part) {
            return refused("an equilibrium does not move: leave out what stands after the colon");
        }
        if self.columns(scene)? > 1 {
            return refused("it has several components: choose one, as in tip.y");
        }
        Ok(reading)
    }

    /// As [`at_rest`](Self::at_rest), if the error of the mesh can be estimated for it.
    ///
    /// # Errors
    /// As there; a reading without a known derivative.
    pub(crate) fn of_equilibrium(&self, scene: &Scene) -> Result<&Reading, InputError> {
        let reading = self.at_rest(scene)?;
        if !reading.has_derivative() {
            let help = "the error of the mesh is estimated of positions, displacements, distances, angles between lines, \
                        centres of mass, volumes of chambers and constraint forces";
            return Err(self.refused(help));
        }
        Ok(reading)
    }

    fn refused(&self, help: &str) -> InputError {
        InputError::new("quantity of an equilibrium", format!("\"{self}\""), help)
    }

    /// Its value in an equilibrium, to be compared with that [seen](Self::seen) at the end of a motion.
    ///
    /// # Errors
    /// As [`of_equilibrium`](Self::of_equilibrium).
    pub(crate) fn seen_at_rest(&self, found: &Equilibrium) -> Result<Seen, InputError> {
        let scene = found.trajectory().scene();
        let reading = self.of_equilibrium(scene)?;
        let value = reading.at(scene, found.sample())?;
        let change = value - reading.at(scene, &found.trajectory().samples()[0])?;
        Ok(Seen { dimension: 1, values: vec![vec![value]], scale: change.abs() })
    }

    /// Whether an equilibrium may give it: whether it is a number at the end.
    pub(crate) fn is_at_end(&self) -> bool {
        self.part == Part::End
    }

    /// Reads it in addition to the readings of `sampling`.
    pub(crate) fn read_by(&self, sampling: Sampling) -> Sampling {
        match &self.reading {
            Some(reading) if self.is_peak() => {
                sampling.read(SENSOR, reading.clone()).finding_peaks()
            }
            Some(reading) => sampling.read(SENSOR, reading.clone()),
            None => sampling,
        }
    }

    /// Count of its numbers in a sample, after those of other sensors; 0 for the whole motion.
    pub(crate) fn columns(&self, scene: &Scene) -> Result<usize, InputError> {
        match &self.reading {
            Some(_) => self.read_by(Sampling::phase_ends()).columns(scene).map(|own| own.len()),
            None => Ok(0),
        }
    }

    /// Its values in a trajectory that was sampled [for it](Self::read_by), at the `samples`. For the whole
    /// motion the `nodes` (from 0) count.
    pub(crate) fn seen<'a>(
        &self,
        trajectory: &'a Trajectory,
        nodes: &[usize],
        samples: impl Iterator<Item = &'a Sample>,
    ) -> Seen {
        let body = trajectory.body();
        let d = body.dimension();
        let Some(_) = &self.reading else {
            let displacement = |sample: &'a Sample| {
                nodes.iter().flat_map(|node| &sample.u[node * d..][..d]).copied().collect()
            };
            let values: Vec<Vec<f64>> = samples.map(displacement).collect();
            let mut seen = Seen { dimension: d, values, scale: 0.0 };
            seen.scale = seen.size(|_, _, x| x).mean.max(LEAST_MOTION * body.size());
            return seen;
        };
        let count = trajectory.sensors().iter().filter(|column| is_own(&column.name)).count();
        let own = |sample: &Sample| sample.sensors[sample.sensors.len() - count..].to_vec();
        let start = own(&trajectory.samples()[0]);
        let mut times = Vec::new();
        let values: Vec<Vec<f64>> = samples
            .map(|sample| {
                times.push(sample.time);
                own(sample)
            })
            .collect();
        let mut seen = Seen { dimension: count, values, scale: 0.0 };
        let largest = seen.size(|_, _, x| x).largest;
        let mut change = seen.size(|_, k, x| x - start[k]);
        // what was read between samples
        let between = trajectory.peaks.last().copied().filter(|_| self.is_peak());
        let [least_read, largest_read] = between.unwrap_or([start[0]; 2]);
        for read in [least_read, largest_read] {
            change.largest = change.largest.max((read - start[0]).abs());
        }
        let least = (LEAST_CHANGE * largest).max(f64::MIN_POSITIVE);
        if self.is_over_time() {
            seen.scale = change.mean.max(least);
            return seen;
        }
        let series: Vec<f64> = seen.values.iter().map(|value| value[0]).collect();
        let read = [least_read.min(start[0]), largest_read.max(start[0])];
        let value = self.number(&times, &series, read).unwrap_or(f64::NAN);
        let scale = match self.part {
            Part::Frequency | Part::Damping => value,
            _ => change.largest,
        };
        Seen { dimension: 1, values: vec![vec![value]], scale: scale.max(least) }
    }

    /// The number that counts, of a reading that was `series` at some `times` (s), and had the least and the largest
    /// value `read` besides. None over all times, and where there is no such number: of a motion without swings.
    pub(crate) fn number(&self, times: &[f64], series: &[f64], read: [f64; 2]) -> Option<f64> {
        let [least, largest] = read;
        let values = || series.iter().copied();
        match self.part {
            Part::OverTime => None,
            Part::End => values().next_back(),
            Part::Largest => Some(values().fold(largest, f64::max)),
            Part::Least => Some(values().fold(least, f64::min)),
            Part::Mean => mean(times, series),
            Part::Frequency => swings(times, values()).map(|(frequency, _)| frequency),
            Part::Damping => swings(times, values()).map(|(_, damping)| damping),
        }
    }

    /// Reading of the quantity; `None` for the whole motion.
    #[cfg(feature = "sweep")]
    pub(crate) fn read_for_it(&self) -> Option<&Reading> {
        self.reading.as_ref()
    }

    /// Whether its swings or its mean count, which few samples do not show.
    #[cfg(feature = "sweep")]
    pub(crate) fn is_of_history(&self) -> bool {
        matches!(self.part, Part::Mean | Part::Frequency | Part::Damping)
    }

    /// Whether its largest or least value counts, which may lie between samples.
    pub(crate) fn is_peak(&self) -> bool {
        matches!(self.part, Part::Largest | Part::Least)
    }

    /// Equivalent quantity in the smaller scene by a `map` of the `whole`; for the whole motion, that of its nodes.
    ///
    /// # Errors
    /// A reading that the smaller scene does not have.
    pub(crate) fn by_map(&self, whole: &Scene, map: &NodeMap) -> Result<Self, InputError> {
        let reading = self.reading.as_ref().map(|reading| reading.by_map(whole, map));
        Ok(Self { reading: reading.transpose()?, ..self.clone() })
    }

    /// Equivalent quantity of the rod that stands for a `solid` along its `axis`; for the whole motion, that of its nodes.
    ///
    /// # Errors
    /// A reading that the rod does not have.
    pub(crate) fn of_rod(&self, solid: &Scene, axis: &SolidAxis) -> Result<Self, InputError> {
        let reading = self.reading.as_ref().map(|reading| reading.of_rod(solid, axis));
        Ok(Self { reading: reading.transpose()?, ..self.clone() })
    }

    /// Whether it is the whole motion.
    pub(crate) fn is_motion(&self) -> bool {
        self.reading.is_none()
    }

    /// Whether all times count, and not one number.
    pub(crate) fn is_over_time(&self) -> bool {
        self.part == Part::OverTime
    }

    /// Its unit.
    pub(crate) fn unit(&self) -> &'static str {
        match (&self.reading, self.part) {
            (_, Part::Frequency) => "Hz",
            (_, Part::Damping) => "1",
            (Some(reading), _) => reading.unit(),
            (None, _) => "m",
        }
    }

    /// Number of times at which a motion has to be seen.
    pub(crate) fn times(&self) -> usize {
        if self.is_over_time() { FEW_TIMES } else { MANY_TIMES }
    }
}

/// The mean over time of values at `times` (s), by the trapezoidal rule.
fn mean(times: &[f64], values: &[f64]) -> Option<f64> {
    let (first, last) = (times.first()?, times.last()?);
    if first == last {
        return values.last().copied();
    }
    let pieces = times.windows(2).zip(values.windows(2));
    let sum: f64 = pieces.map(|(t, x)| 0.5 * (x[0] + x[1]) * (t[1] - t[0])).sum();
    Some(sum / (last - first))
}

/// Times at which motions are compared: this many, evenly from the start (without it) to the end, ...
const FEW_TIMES: usize = 101;
/// ... and this many to see the largest value or a frequency.
const MANY_TIMES: usize = 2001;

/// Name of the sensor that reads the quantity.
const SENSOR: &str = "\u{1}quantity";

/// Whether this is a column of that sensor.
fn is_own(column: &str) -> bool {
    column.starts_with(SENSOR)
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.reading.is_none() {
            return f.write_str("motion");
        }
        f.write_str(&self.name)?;
        match Part::WORDS.iter().find(|(_, part)| *part == self.part) {
            Some((word, _)) => write!(f, ":{word}"),
            None => Ok(()),
        }
    }
}

/// The reading that a name without a part stands for.
fn reading(name: &str, scene: &Scene, sensors: &[(String, Reading)]) -> Option<Reading> {
    let sensor = |name: &str| sensors.iter().find(|(known, _)| known == name);
    if let Some((_, reading)) = sensor(name) {
        return Some(reading.clone());
    }
    let of = |stem: &str| match stem {
        _ if sensor(stem).is_some() => sensor(stem).map(|(_, reading)| reading.clone()),
        "com" => Some(Reading::centre_of_mass()),
        "rotation" => Some(Reading::rotation()),
        set => scene.body().mesh().select(&set.into()).ok().map(|_| Reading::position(set)),
    };
    if let Some(reading) = of(name) {
        return Some(reading);
    }
    let (stem, word) = name.rsplit_once('.')?;
    let component = Component::WORDS.iter().find(|(known, _)| *known == word)?.1;
    Some(of(stem)?.component(component))
}

/// The names that are known, for messages.
fn help(scene: &Scene, sensors: &[(String, Reading)]) -> String {
    let mut known: Vec<&str> = sensors.iter().map(|(name, _)| &name[..]).collect();
    known.extend(scene.body().mesh().sets().keys().map(String::as_str));
    format!(
        "it is motion, com, rotation, a sensor or a set of nodes ({}), where need be with a component as in tip.y, and \
         with :end, :max, :min, :mean, :frequency or :damping where one number counts",
        known.join(", ")
    )
}

/// A quantity as it was in a motion.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Seen {
    /// Components of a point.
    pub(super) dimension: usize,
    /// Time by time; point by point.
    pub(crate) values: Vec<Vec<f64>>,
    /// Scale of relative errors.
    pub(crate) scale: f64,
}

/// Distances between two motions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Distance {
    /// Root mean square over points and times.
    pub(crate) mean: f64,
    /// Largest.
    pub(crate) largest: f64,
}

impl Seen {
    /// Observation of some of its points (from 0) along some axes, with the same scale.
    pub(crate) fn chosen(&self, points: &[usize], axes: &[usize]) -> Self {
        let of_point = |x: &[f64], point: usize| {
            axes.iter().map(|i| x[point * self.dimension + i]).collect::<Vec<f64>>()
        };
        let of_time = |x: &Vec<f64>| points.iter().flat_map(|&point| of_point(x, point)).collect();
        let values = self.values.iter().map(of_time).collect();
        Self { dimension: axes.len(), values, scale: self.scale }
    }

    /// Observation of points whose motion is made of that of its own, each with its share.
    pub(crate) fn combined(&self, shares: &[Vec<(usize, f64)>]) -> Self {
        let d = self.dimension;
        let of_time = |x: &Vec<f64>| {
            let component = |own: &[(usize, f64)], i| -> f64 {
                own.iter().map(|(point, share)| share * x[point * d + i]).sum()
            };
            shares.iter().flat_map(|own| (0..d).map(move |i| component(own, i))).collect()
        };
        Self { values: self.values.iter().map(of_time).collect(), ..self.clone() }
    }

    pub(crate) fn distance(&self, other: &Self) -> Distance {
        self.size(|time, k, x| x - other.values[time][k])
    }

    /// Distances of another motion from this one, relative to its scale.
    pub(crate) fn error(&self, of: &Self) -> Distance {
        let Distance { mean, largest } = self.distance(of);
        Distance { mean: mean / self.scale, largest: largest / self.scale }
    }

    /// Root mean square distance at each time.
    pub(crate) fn distances(&self, other: &Self) -> Vec<f64> {
        let at = |(one, other): (&Vec<f64>, &Vec<f64>)| {
            let squares: f64 = one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum();
            (squares / (one.len() / self.dimension) as f64).sqrt()
        };
        self.values.iter().zip(&other.values).map(at).collect()
    }

    fn size(&self, component: impl Fn(usize, usize, f64) -> f64) -> Distance {
        let (mut sum, mut largest, mut count) = (0.0, 0.0_f64, 0);
        for (time, values) in self.values.iter().enumerate() {
            for (point, x) in values.chunks_exact(self.dimension).enumerate() {
                let first = point * self.dimension;
                let parts = x.iter().enumerate();
                let square: f64 = parts.map(|(i, x)| component(time, first + i, *x).powi(2)).sum();
                sum += square;
                // NaN is kept: `max` would drop it
                largest = if square.is_nan() { square } else { largest.max(square) };
                count += 1;
            }
        }
        Distance { mean: (sum / f64::from(count.max(1))).sqrt(), largest: largest.sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_nodes() {
        // two nodes at two times, in two dimensions
        let seen = |values: [[f64; 4]; 2]| Seen {
            dimension: 2,
            values: values.map(Vec::from).into(),
            scale: 1.0,
        };
        let one = seen([[1.0, 1.0, 2.0, 2.0], [1.0, 1.0, 0.0, 0.0]]);
        let other = seen([[4.0, 5.0, 2.0, 2.0], [1.0, 1.0, 6.0, -8.0]]);
        let Distance { mean, largest } = one.distance(&other);
        assert_eq!((mean, largest), ((125.0_f64 / 4.0).sqrt(), 10.0));
        assert_eq!(one.size(|_, _, x| x).mean, (12.0_f64 / 4.0).sqrt());
        assert_eq!(one.distances(&other), [12.5_f64.sqrt(), 50.0_f64.sqrt()]);
    }
}
