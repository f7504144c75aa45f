//! One scene: the promised error and the true one.

use std::ops::ControlFlow;
use std::time::Instant;

use pliant::study::{Advice, Adviser, Candidate, Choice, time_text};
use pliant::{Error, Method, Sampling, Scene, Settings};

/// An advice and its reference.
pub struct Trial {
    pub name: String,
    pub advice: Advice,
    /// True relative errors of what is enough and of what was written, if both gave a motion again.
    pub enough: Option<f64>,
    pub written: Option<f64>,
    /// The run that they are compared with, and its time (s).
    pub converged: Option<(Choice, f64)>,
    /// Why there is none on a finer mesh.
    pub not_finer: Option<String>,
}

/// A run that advices are compared with: its choice, the end of its motion (s), and its motion.
pub struct Reference {
    choice: Choice,
    end: f64,
    motion: Motion,
}

impl Reference {
    /// Whether it is as fine as one by `choice` until `end` has to be.
    fn serves(&self, choice: &Choice, end: f64) -> bool {
        let own = &self.choice;
        self.end == end
            && own.richer == choice.richer
            && own.halved >= choice.halved
            && own.halved_in.len() >= choice.halved_in.len()
            && own.settings.rtol <= choice.settings.rtol
    }
}

/// Times at which motions are compared.
const TIMES: usize = 101;
/// Tolerance of the reference run over the adviser's tightest one.
const TIGHTER: f64 = 0.1;

impl Trial {
    /// Asks about the whole motion of `scene` to an accuracy, within a budget (s); no run that it is compared with may take longer
    /// than a limit (s). Those on finer meshes are kept in `references`, and taken from there.
    pub fn run(
        name: String,
        scene: &Scene,
        settings: &Settings,
        [accuracy, budget, limit]: [f64; 3],
        references: &mut Vec<Reference>,
    ) -> Result<Self, Error> {
        let adviser = Adviser::new(scene, accuracy).settings(settings.clone()).budget(budget);
        let advice = adviser.run(&mut |_| ControlFlow::Continue(()))?;
        let scene = scene.clone().ended_at(advice.end);
        let mut trial =
            Self { name, advice, enough: None, written: None, converged: None, not_finer: None };
        let Some(truth) = &trial.advice.truth else { return Ok(trial) };
        // another method, a tighter tolerance, a finer mesh
        let rtol = TIGHTER * truth.choice.settings.rtol;
        let own = &truth.choice.settings;
        let settings = Settings { method: Method::Arkode, rtol, ..own.clone() };
        let same = Choice { settings, ..truth.choice.clone() };
        let mut finer = same.clone();
        if same.halved_in.is_empty() {
            finer.halved += 1;
        } else {
            // numbers of cells are those of the mesh before
            let cells = same.scene(&scene)?.body().mesh().cell_count();
            finer.halved_in.push((0..cells).collect());
        }
        let end = scene.end();
        if !references.iter().any(|known| known.serves(&finer, end)) {
            // what is said of the mesh as it was written is true or not on that
            let found = match (trial.advice.mesh, trial.advice.resolution.is_nan()) {
                (None, false) => {
                    motion(&finer, &scene, limit).map(|motion| (finer.clone(), motion))
                }
                (None, true) => Err("no finer mesh gave a motion within the budget".into()),
                (Some(apart), _) => {
                    Err(format!("the mesh as written; a finer one is {:.0} % away", 100.0 * apart))
                }
            };
            let own = found.or_else(|reason| {
                trial.not_finer = Some(reason);
                motion(&same, &scene, limit).map(|motion| (same.clone(), motion))
            });
            let Ok((choice, motion)) = own else { return Ok(trial) };
            references.push(Reference { choice, end, motion });
        }
        let wanted = if trial.not_finer.is_some() { &same } else { &finer };
        let known = references.iter().rev().find(|known| known.serves(wanted, end));
        let Some(Reference { choice, motion: converged, .. }) = known else { return Ok(trial) };
        let error = |candidate: &Candidate| {
            let Motion { places, .. } = motion(&candidate.choice, &scene, limit).ok()?;
            Some(distance(&places, &converged.places) / size(&converged.places))
        };
        trial.enough = trial.advice.enough.as_ref().and_then(error);
        trial.written = error(&trial.advice.written);
        trial.converged = Some((choice.clone(), converged.seconds));
        Ok(trial)
    }

    /// Whether what was promised is true; none where nothing was promised, or nothing is known.
    pub fn is_right(&self) -> Option<bool> {
        self.enough.map(|error| error <= self.advice.accuracy)
    }

    /// The most that what is enough was promised to be off by, if that is known of the mesh, too.
    pub fn promised(&self) -> Option<f64> {
        let enough = self.advice.enough.as_ref()?;
        enough.parts.map(|parts| parts.sum()).filter(|_| !self.advice.resolution.is_nan())
    }

    /// Whether what is enough was compared with a run on a finer mesh than the adviser's own.
    pub fn is_against_finer(&self) -> bool {
        self.enough.is_some() && self.not_finer.is_none()
    }

    /// Time of the advice over that of the run that it is compared with.
    pub fn cost(&self) -> Option<f64> {
        Some(self.advice.seconds / self.converged.as_ref()?.1)
    }

    /// A row of the table.
    pub fn row(&self) -> String {
        let Self { name, advice, enough, written, .. } = self;
        let percent = |error: Option<f64>| match error {
            Some(error) => format!("{:.2} %", 100.0 * error),
            None => "–".into(),
        };
        let (needs, promised) = match &advice.enough {
            Some(enough) => {
                let known = !advice.resolution.is_nan();
                let sure = if known { "" } else { " on this mesh" };
                (enough.choice.to_string(), percent(enough.parts.map(|parts| parts.sum())) + sure)
            }
            None => ("nothing known".into(), "–".into()),
        };
        let known = match advice.known_until {
            Some(_) => format!(" until {:.2} s", advice.end),
            None => String::new(),
        };
        let ratio = |ratio: Option<f64>| match ratio {
            Some(ratio) => format!("{ratio:.2}"),
            None => "–".into(),
        };
        let enough_seconds = advice.enough.as_ref().map(|enough| enough.seconds);
        let faster = ratio(enough_seconds.map(|seconds| advice.written.seconds / seconds));
        let cost = ratio(self.cost());
        let time = time_text(advice.seconds);
        let told = advice.written.parts.map(|parts| parts.sum()).or(advice.written.error);
        let [told, wrote, true_] = [told, *written, *enough].map(percent);
        format!(
            "| {name}{known} | {needs} | {promised} | {true_} | {told} | {wrote} | {faster} | {time} | {cost} |"
        )
    }
}

/// Where the nodes of the mesh as it was written are, time by time.
struct Motion {
    places: Vec<Vec<f64>>,
    seconds: f64,
}

/// That of `scene` by a choice, or why there is none.
fn motion(choice: &Choice, scene: &Scene, limit: f64) -> Result<Motion, String> {
    let dofs = scene.body().mesh().node_count() * scene.body().dimension();
    let finer = choice.scene(scene).map_err(|error| error.to_string())?;
    let times: Vec<f64> = (1..=TIMES).map(|k| scene.end() * (k as f64 / TIMES as f64)).collect();
    let clock = Instant::now();
    let result = finer.simulate_with(&choice.settings, &Sampling::at(&*times), |_| {
        match clock.elapsed().as_secs_f64() > limit {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    let seconds = clock.elapsed().as_secs_f64();
    let trajectory = result.map_err(|error| match error {
        Error::Integration(failure) if failure.is_interruption() => {
            format!("not done in {limit} s")
        }
        error => error.to_string(),
    })?;
    // samples at ends of phases are more
    let is_asked = |time: f64| times.iter().any(|asked| (asked - time).abs() <= 1e-9 * scene.end());
    let mut samples: Vec<_> = trajectory.samples().iter().skip(1).collect();
    samples.retain(|sample| is_asked(sample.time));
    samples.dedup_by(|a, b| (a.time - b.time).abs() <= 1e-9 * scene.end());
    let places = samples.iter().map(|sample| sample.u[..dofs].to_vec()).collect();
    Ok(Motion { places, seconds })
}

/// Root mean square over all times and components.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
    f64::sqrt(sum / count)
}

fn distance(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    assert_eq!(one.len(), other.len(), "motions are seen at the same times");
    mean(one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| a - b))
}

fn size(one: &[Vec<f64>]) -> f64 {
    mean(one.iter().flatten().copied())
}
