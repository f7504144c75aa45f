//! Sampling times of a motion, and the quantities that are read at them.

use std::sync::Arc;

use super::reading::Reading;
use super::sensor::{Sensor, SensorKind, Sensors};
use super::view::View;
use crate::base::input::{InputError, check_memory, positive};
#[cfg(any(feature = "fit", feature = "study"))]
use crate::dynamics::trajectory::Quantity;
use crate::dynamics::trajectory::Sample;
use crate::scene::timeline::{Phase, Scene};

/// When the motion is sampled. The start and the end of each phase always are.
///
/// Samples come from the dense output of the integrator; they never shorten its steps.
#[derive(Debug, Clone, Default)]
pub struct Sampling {
    times: Times,
    /// More times (s), ascending.
    also: Vec<f64>,
    sensors: Vec<Sensor>,
    /// Whether sensors are also read within each step, to find their largest and least values.
    finds_peaks: bool,
    /// Whether the displacements that a reduced model lacks are kept.
    keeps_lacking: bool,
}

#[derive(Debug, Clone, PartialEq, Default)]
enum Times {
    #[default]
    PhaseEnds,
    Every(f64),
    At(Vec<f64>),
}

impl Times {
    /// Whether this time (s), within a phase, is one of them.
    fn have(&self, time: f64) -> bool {
        match self {
            Self::PhaseEnds => false,
            Self::Every(step) => (time / step).round() * step == time,
            Self::At(times) => times.contains(&time),
        }
    }
}

impl Sampling {
    /// At t = 0 and at the ends of the phases only.
    pub fn phase_ends() -> Self {
        Self::default()
    }

    /// At all multiples of `step` (s).
    pub fn every(step: f64) -> Self {
        Self { times: Times::Every(step), ..Self::default() }
    }

    /// At the given times (s), in any order.
    pub fn at(times: impl Into<Vec<f64>>) -> Self {
        Self { times: Times::At(times.into()), ..Self::default() }
    }

    /// Whether a run of `scene` has a sample at exactly this `time` (s).
    pub fn takes(&self, scene: &Scene, time: f64) -> bool {
        let ends = scene.phases().iter().map(Phase::end);
        time == 0.0 || ends.into_iter().any(|end| end == time) || self.times.have(time)
    }

    /// At these times (s, ascending, within the scene) as well.
    #[cfg(feature = "study")]
    pub(crate) fn also_at(mut self, times: Vec<f64>) -> Self {
        self.also = times;
        self
    }

    /// Finds the largest and the least values of the sensors, also between samples: [`Trajectory::peaks`].
    #[cfg(feature = "study")]
    pub(crate) fn finding_peaks(mut self) -> Self {
        self.finds_peaks = true;
        self
    }

    pub(super) fn finds_peaks(&self) -> bool {
        self.finds_peaks
    }

    /// Keeps the displacements that a reduced model lacks: [`Trajectory::lacking`](crate::Trajectory).
    pub(crate) fn keeping_lacking(mut self) -> Self {
        self.keeps_lacking = true;
        self
    }

    pub(super) fn keeps_lacking(&self) -> bool {
        self.keeps_lacking
    }

    /// Whether a sample within a phase is taken because of [`also_at`](Self::also_at) alone.
    #[cfg(feature = "study")]
    pub(crate) fn is_extra(&self, time: f64) -> bool {
        !self.times.have(time) && self.also.contains(&time)
    }

    /// Adds a sensor: a number that `reading` returns for each sample, in addition to the standard contents of
    /// samples ([`Sample::sensors`], [`Trajectory::sensors`](crate::Trajectory::sensors); a column of tables).
    ///
    /// ```
    /// use pliant::{Sampling, Settings, samples};
    ///
    /// let sampling = Sampling::every(0.1)
    ///     .sensor("width", "m", |view, _| {
    ///         let [left, right] = ["left", "right"].map(|side| view.position(side));
    ///         left.and_then(|left| Ok(right?[0] - left[0])).unwrap_or(f64::NAN)
    ///     })
    ///     .sensor("stored", "J", |_, sample| sample.energy.strain);
    /// let trajectory = samples::square_jump(4)?.simulate(&Settings::default(), &sampling)?;
    /// let widest = trajectory.samples().iter().map(|sample| sample.sensors[0]).fold(0.0, f64::max);
    /// assert!(widest > 0.34); // it bulges while it is pressed
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn sensor(
        mut self,
        name: impl Into<String>,
        unit: impl Into<String>,
        reading: impl Fn(&View, &Sample) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let source = SensorKind::Own(unit.into(), Arc::new(reading));
        self.sensors.push(Sensor { name: name.into(), source });
        self
    }

    /// Adds a sensor for a quantity that scenes have. One with several components gets a column for each: `tip.x`,
    /// `tip.y`, ...
    ///
    /// ```
    /// use pliant::simulate::{Component, Reading};
    /// use pliant::{Sampling, Settings, samples};
    ///
    /// let sampling = Sampling::every(0.1)
    ///     .read("top", Reading::position("top"))
    ///     .read("probe", Reading::constraint_force([14, 15]).component(Component::Y))
    ///     .read("corner stress", Reading::stress([1]).component(Component::VonMises));
    /// let trajectory = samples::square_jump(4)?.simulate(&Settings::default(), &sampling)?;
    /// let names: Vec<&str> = trajectory.sensors().iter().map(|sensor| &sensor.name[..]).collect();
    /// assert_eq!(names, ["top.x", "top.y", "probe", "corner stress"]);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn read(mut self, name: impl Into<String>, reading: Reading) -> Self {
        self.sensors.push(Sensor { name: name.into(), source: SensorKind::Named(reading) });
        self
    }

    /// The sensors.
    pub(super) fn asked(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The columns that the sensors have.
    ///
    /// # Errors
    /// A quantity that `scene` does not have; two columns with one name.
    #[cfg(any(feature = "fit", feature = "study"))]
    pub(crate) fn columns(&self, scene: &Scene) -> Result<Vec<Quantity>, InputError> {
        Sensors::new(&self.sensors, scene).map(|sensors| sensors.quantities)
    }

    /// Checks that phases of `scene` end as they say.
    ///
    /// # Errors
    /// Sensors that are not read, and ends that a scene cannot have.
    #[cfg(feature = "scene-file")]
    pub(crate) fn check_ends(&self, scene: &Scene) -> Result<(), InputError> {
        if scene.phases().iter().all(|phase| phase.ends.is_none()) {
            return Ok(());
        }
        scene.check_ends()?;
        let sensors = self.sensors(scene)?;
        scene.phases().iter().try_for_each(|phase| sensors.ending(phase).map(|_| ()))
    }

    /// Checks the times for `scene`, and that it has what the sensors read.
    ///
    /// # Errors
    /// Times outside the scene or too close; a quantity that it does not have; two columns with one name.
    #[cfg(feature = "scene-file")]
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), InputError> {
        self.sensors(scene).map(|_| ())
    }

    /// Checks the times for `scene`, and finds what its sensors read.
    ///
    /// # Errors
    /// Times outside the scene or too close; a quantity that the scene does not have; two columns with one name.
    pub(super) fn sensors(&self, scene: &Scene) -> Result<Sensors, InputError> {
        self.check_times(scene.end(), scene.body().dofs())?;
        Sensors::new(&self.sensors, scene)
    }

    /// Checks the times for a scene that ends at time `end` (s), with `dofs` displacement components.
    fn check_times(&self, end: f64, dofs: usize) -> Result<(), InputError> {
        match &self.times {
            Times::PhaseEnds => Ok(()),
            Times::Every(step) => {
                positive("sampling step", *step, "s")?;
                if *step < LEAST_STEP * end {
                    let help =
                        format!("double precision does not tell such times apart up to {end} s");
                    return Err(InputError::new("sampling step", step, help));
                }
                let bytes = (end / step) * (dofs as f64) * SAMPLE_BYTES;
                check_memory("sampling step", format!("{step:e} s"), bytes, "sample less often")
            }
            Times::At(times) => match times.iter().find(|t| !(0.0..=end).contains(*t)) {
                Some(t) => {
                    let help = format!("samples lie between 0 and the end of the scene, {end} s");
                    Err(InputError::new("sampling time", t, help))
                }
                None => Ok(()),
            },
        }
    }

    /// The sampling times after `start` up to `end`, ending with `end`.
    pub(super) fn within(&self, start: f64, end: f64) -> Schedule {
        // times that differ from the ends of the phase by round-off only count as those ends
        let apart = 1e-9 * (end - start);
        let (after, before) = (start + apart, end - apart);
        let (inner, count) = match &self.times {
            Times::PhaseEnds => (Inner::Listed(Vec::new()), 0),
            Times::Every(step) => {
                let first = (after / step).floor() + 1.0;
                let count = ((before / step).ceil() - first).max(0.0) as usize;
                (Inner::Multiples { step: *step, first }, count)
            }
            Times::At(times) => {
                let inside = times.iter().copied().filter(|&t| t > after && t < before);
                let mut times: Vec<f64> = inside.collect();
                times.sort_by(f64::total_cmp);
                times.dedup();
                let count = times.len();
                (Inner::Listed(times), count)
            }
        };
        let asked = Schedule { inner, count, end, cut: None };
        if self.also.is_empty() {
            return asked;
        }
        let mut times: Vec<f64> = (0..count).filter_map(|number| asked.get(number)).collect();
        let is_new = |t: &&f64| {
            let next = times.partition_point(|time| *time < **t - apart);
            times.get(next).is_none_or(|time| *time > **t + apart)
        };
        let inside = self.also.iter().filter(|t| **t > after && **t < before);
        let new: Vec<f64> = inside.filter(is_new).copied().collect();
        times.extend(new);
        times.sort_by(f64::total_cmp);
        let count = times.len();
        Schedule { inner: Inner::Listed(times), count, end, cut: None }
    }
}

/// Memory that a sample takes for each displacement component, with its velocity.
const SAMPLE_BYTES: f64 = 16.0;

/// Least time between samples, as a part of the whole time: a thousand units of round-off.
const LEAST_STEP: f64 = 2e-13;

/// The sampling times of a phase, of which there may be more than fit in memory.
pub(super) struct Schedule {
    /// Those before the end, and their number.
    inner: Inner,
    count: usize,
    end: f64,
    /// The number of those before an end that came sooner, and that end.
    cut: Option<(usize, f64)>,
}

enum Inner {
    /// Multiples of `step`, from `first * step` on.
    Multiples {
        step: f64,
        first: f64,
    },
    Listed(Vec<f64>),
}

impl Schedule {
    /// Ends it at a time (s) before the one that was planned, after `taken` of the times.
    pub(super) fn cut(&mut self, taken: usize, end: f64) {
        let is_before = |number: &usize| self.get(*number).is_some_and(|t| t < end);
        let count = (taken..self.count).take_while(is_before).count();
        self.cut = Some((taken + count, end));
    }

    /// Ends it as planned.
    pub(super) fn uncut(&mut self) {
        self.cut = None;
    }

    /// One of the times, counted from 0.
    pub(super) fn get(&self, number: usize) -> Option<f64> {
        let (count, end) = self.cut.unwrap_or((self.count, self.end));
        if number >= count {
            return (number == count).then_some(end);
        }
        match &self.inner {
            Inner::Multiples { step, first } => Some((first + number as f64) * step),
            Inner::Listed(times) => times.get(number).copied(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Sampling;

    #[test]
    fn samples_lie_within_the_phase_and_end_with_it() {
        let within = |sampling: Sampling, start, end| -> Vec<f64> {
            let schedule = sampling.within(start, end);
            (0..9).map_while(|number| schedule.get(number)).collect()
        };
        // 3 x 0.1 is a little more than 0.3
        assert_eq!(within(Sampling::every(0.1), 0.0, 0.3), [0.1, 0.2, 0.3]);
        assert_eq!(within(Sampling::every(0.1), 0.3, 0.45), [0.4, 0.45]);
        assert_eq!(within(Sampling::every(0.1), 0.31, 0.35), [0.35]);
        assert_eq!(within(Sampling::at([0.4, 0.1, 0.3, 0.1]), 0.0, 0.35), [0.1, 0.3, 0.35]);
        assert_eq!(within(Sampling::phase_ends(), 0.3, 0.45), [0.45]);
        let both = Sampling { also: vec![0.05, 0.1, 0.2, 0.28, 0.35], ..Sampling::every(0.1) };
        assert_eq!(within(both, 0.0, 0.35), [0.05, 0.1, 0.2, 0.28, 3.0 * 0.1, 0.35]);
        // more than fit in memory
        assert_eq!(within(Sampling::every(0.002), 0.0, 1e6)[..2], [0.002, 0.004]);
    }
}
