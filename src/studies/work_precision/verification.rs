//! A motion with its error: runs with successively tighter tolerances, until two agree.
//!
//! Tolerances fall by ten until two runs agree, contact events located. Where stability bounds the steps a
//! tighter tolerance changes nothing, and two runs would agree for that reason only: if a run took less than
//! 1.3 times the steps of the one before, steps of the next are bounded by half of their mean. True errors
//! beside the reported ones are in `docs/notes/studies.md`.

use std::ops::ControlFlow;

use super::quantity::{Quantity, Seen};
use super::tightening;
use crate::base::input::{Fraction, InputError};
use crate::dynamics::error::Error;
use crate::dynamics::report::Achieved;
use crate::dynamics::simulate::{Sampling, Simulation};
use crate::dynamics::trajectory::{Quantity as Column, Trajectory};
use crate::io::output::{DIFFERENCE, OF_SENSOR};
#[cfg(feature = "scene-file")]
use crate::io::scene_file::SceneFile;
use crate::scene::settings::{ContactEvents, Settings};
use crate::scene::timeline::{Phase, Scene};

/// Runs a scene with tighter and tighter tolerances, until two runs agree in a [`Quantity`] to an accuracy.
///
/// A tolerance bounds the error of each step alone, and small errors may grow from step to step.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use pliant::study::Verification;
/// use pliant::{Sampling, samples};
///
/// let scene = samples::square_jump(4)?;
/// let verification = Verification::new(&scene, 0.01).sampling(Sampling::every(0.01));
/// let motion = verification.finish(|_| ControlFlow::Continue(()))?;
/// let achieved = motion.report().achieved.as_ref().unwrap();
/// assert!(achieved.difference < 0.01 && achieved.known_until == scene.end());
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug)]
pub struct Verification<'a> {
    scene: &'a Scene,
    accuracy: f64,
    settings: Settings,
    sampling: Sampling,
    quantity: Quantity,
    runs: usize,
    /// The tightest run so far.
    last: Option<TightenedRun>,
}

/// A run, and its observed quantity.
#[derive(Debug)]
struct TightenedRun {
    settings: Settings,
    /// The samples that were requested.
    trajectory: Trajectory,
    /// The times (s) at which it is compared, and whether a sample was requested there.
    looks: Vec<(f64, bool)>,
    /// The quantity that counts, and the displacements of all nodes, at each of these times.
    asked: Seen,
    motion: Seen,
    /// Number of columns of the sensors that were requested.
    sensors: usize,
    /// Whether its steps hardly changed although its tolerance is tighter than the one before.
    is_bounded: bool,
}

/// If a tighter tolerance does not multiply the number of steps by this factor at least, stability bounds the
/// steps, not the tolerance. Then the step size itself is bounded, by half of the mean step.
const FINER: f64 = 1.3;
/// Runs are compared at this many times at least, evenly spread: at few, they may agree by chance.
const LOOKS: usize = 100;

impl<'a> Verification<'a> {
    /// A verification of the whole motion of `scene`, to a relative `accuracy` (0.01 is 1 %).
    pub fn new(scene: &'a Scene, accuracy: f64) -> Self {
        Self {
            scene,
            accuracy,
            settings: Settings::default(),
            sampling: Sampling::every(scene.end() / LOOKS as f64),
            quantity: Quantity::motion(),
            runs: 0,
            last: None,
        }
    }

    /// A verification `within` an accuracy of the contents of a scene file: its scene, settings, sampling (a hundred samples
    /// if it requests none) and the quantity that it names, by default the whole motion.
    ///
    /// # Errors
    /// A name of no quantity.
    #[cfg(feature = "scene-file")]
    pub fn of_file(file: &'a SceneFile, within: Fraction) -> Result<Self, Error> {
        let SceneFile { scene, settings, accuracy, output, .. } = file;
        let quantity = accuracy.quantity.as_deref().unwrap_or("motion");
        Ok(Self::new(scene, within.0)
            .settings(settings.clone())
            .sampling(output.verified_sampling(scene.end()))
            .quantity(Quantity::named(quantity, scene, &output.sensors)?))
    }

    /// Settings of the scene; `rtol` is ignored. Contact events are located, unless `settings` have
    /// them stepped over. Default: [`Settings::default`].
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// When the motion is sampled. Runs are compared there, and at a hundred times in any case. Default: at
    /// those.
    #[must_use]
    pub fn sampling(mut self, sampling: Sampling) -> Self {
        self.sampling = sampling;
        self
    }

    /// Quantity that has to be accurate. Default: the whole motion.
    #[must_use]
    pub fn quantity(mut self, quantity: Quantity) -> Self {
        self.quantity = quantity;
        self
    }

    /// Runs the scene once more, with a tenth of the last tolerance.
    ///
    /// Returns whether a further run may help: two did not agree yet, and the tolerance can be tighter.
    /// `observer` is called after each step, and stops the run by [`ControlFlow::Break`].
    ///
    /// # Errors
    /// Bad input; [`Error::Integration`] if the run ends early. Results of earlier runs are kept.
    pub fn refine(
        &mut self,
        observer: impl FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Result<bool, Error> {
        self.scene.refuse_ends("an accuracy")?;
        let settings = match &self.last {
            None => self.first()?,
            Some(last) => self.tighter(last),
        };
        let mut simulation = self.scene.start(&settings)?;
        // at other times than the run before: events between samples in both are the same in both
        if self.runs % 2 == 1 {
            simulation.look_more_often(2.0);
        }
        let sampling = self.quantity.read_by(self.sampling.clone()).also_at(self.looks());
        simulation.record(&sampling)?;
        let mut trajectory = simulation.finish(observer)?;
        self.runs += 1;
        let nodes: Vec<usize> = (0..self.scene.body().mesh().node_count()).collect();
        let seen =
            |quantity: &Quantity| quantity.seen(&trajectory, &nodes, trajectory.samples().iter());
        let (asked, motion) = (seen(&self.quantity), seen(&Quantity::motion()));
        trajectory.keep_sensors(trajectory.sensors().len() - self.quantity.columns(self.scene)?);
        let sensors = trajectory.sensors().len();
        let ends: Vec<f64> = self.scene.phases().iter().map(Phase::end).collect();
        let is_kept = |time: f64| !sampling.is_extra(time) || ends.contains(&time);
        let looks = trajectory.samples().iter().map(|sample| (sample.time, is_kept(sample.time)));
        let looks = looks.collect();
        trajectory.keep_samples(|sample| is_kept(sample.time));
        let mut run =
            TightenedRun { settings, trajectory, looks, asked, motion, sensors, is_bounded: false };
        let difference = self.last.as_ref().map(|before| self.compare(before, &mut run));
        let is_tightest = tightening::is_tightest(run.settings.rtol);
        self.last = Some(run);
        Ok(difference.is_none_or(|difference| difference > self.accuracy) && !is_tightest)
    }

    /// Refines until two runs agree, or the tolerance cannot be tighter. Returns the motion of the tightest run, as
    /// [`trajectory`](Self::trajectory).
    ///
    /// # Errors
    /// As [`refine`](Self::refine).
    pub fn finish(
        mut self,
        mut observer: impl FnMut(&Simulation) -> ControlFlow<()>,
    ) -> Result<Trajectory, Error> {
        loop {
            let goes_on = self.refine(&mut observer)?;
            if !goes_on && let Some(run) = self.last {
                return Ok(run.trajectory);
            }
        }
    }

    /// The motion of the tightest run so far, if there was one. After its sensors it has the column `difference`
    /// (m), the root mean square distance of its nodes from the run before at each sample, and for each
    /// sensor `<sensor>.difference`; its report says what was [achieved](crate::Report::achieved).
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.last.as_ref().map(|run| &run.trajectory)
    }

    /// Times (s) at which runs are compared in any case.
    fn looks(&self) -> Vec<f64> {
        let count = LOOKS.max(self.quantity.times());
        (1..count).map(|k| self.scene.end() * (k as f64 / count as f64)).collect()
    }

    /// The settings of the first run.
    fn first(&self) -> Result<Settings, Error> {
        Fraction::check("accuracy", self.accuracy)?;
        self.quantity.check(self.scene)?;
        let is_ours = |name: &str| name == DIFFERENCE || name.ends_with(OF_SENSOR);
        let sensors = self.sampling.columns(self.scene)?;
        if let Some(Column { name, .. }) = sensors.iter().find(|column| is_ours(&column.name)) {
            let help = "a column of differences has it: name the sensor otherwise";
            return Err(InputError::new("name of a sensor", format!("\"{name}\""), help).into());
        }
        let contact_events = match self.settings.contact_events {
            ContactEvents::Auto => ContactEvents::Locate,
            asked => asked,
        };
        let rtol = tightening::first(self.accuracy);
        Ok(Settings { rtol, contact_events, ..self.settings.clone() })
    }

    /// The settings of the run after `last`.
    fn tighter(&self, last: &TightenedRun) -> Settings {
        let mut settings = last.settings.clone();
        settings.rtol = tightening::tighter(settings.rtol);
        if last.is_bounded {
            let steps = last.trajectory.report().steps() as f64;
            let mean = self.scene.end() / steps;
            settings.max_step = Some(settings.max_step.unwrap_or(mean).min(mean) / 2.0);
        }
        settings
    }

    /// Adds the differences of a run from the one before to its trajectory. Returns the relative difference.
    fn compare(&self, before: &TightenedRun, run: &mut TightenedRun) -> f64 {
        let scale = run.asked.scale;
        let difference = run.asked.error(&before.asked).mean;
        let steps = [before, run].map(|run| run.trajectory.report().steps() as f64);
        run.is_bounded = steps[1] < FINER * steps[0];
        let apart = run.motion.distances(&before.motion);
        let series = match self.quantity.is_over_time() {
            true => (run.asked.distances(&before.asked), scale),
            false => (apart.clone(), run.motion.scale),
        };
        let end = self.scene.end();
        let is_apart = |(distance, _): &(&f64, _)| **distance > self.accuracy * series.1;
        let parted = series.0.iter().zip(&run.looks).find(is_apart).map(|(_, look)| look.0);
        let known_until = match difference <= self.accuracy {
            true => end,
            false => parted.unwrap_or(end),
        };
        let columns = (0..run.sensors).map(|k| {
            let pairs = run.trajectory.samples().iter().zip(before.trajectory.samples());
            pairs.map(|(a, b)| (a.sensors[k] - b.sensors[k]).abs()).collect::<Vec<f64>>()
        });
        let columns: Vec<Vec<f64>> = columns.collect();
        let metres = Column { name: DIFFERENCE.into(), unit: "m".into() };
        let named = |sensor: &Column| Column {
            name: format!("{}{OF_SENSOR}", sensor.name),
            ..sensor.clone()
        };
        let names: Vec<Column> = run.trajectory.sensors().iter().map(named).collect();
        let kept = apart.iter().zip(&run.looks).filter(|(_, look)| look.1);
        let kept: Vec<f64> = kept.map(|(distance, _)| *distance).collect();
        run.trajectory.add_column(metres, &kept);
        for (name, column) in names.into_iter().zip(&columns) {
            run.trajectory.add_column(name, column);
        }
        run.trajectory.report.achieved = Some(Achieved {
            quantity: self.quantity.to_string(),
            asked: self.accuracy,
            difference,
            scale,
            unit: self.quantity.unit().into(),
            known_until,
            end,
            runs: self.runs,
            rtol: [before, run].map(|run| run.settings.rtol),
        });
        difference
    }
}
