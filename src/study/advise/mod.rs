//! What model is enough for a scene: the adviser.

mod answer;
mod choice;
mod ladder;
mod search;

use std::ops::ControlFlow;
use std::time::Instant;

pub use choice::Choice;
use ladder::Found;
use search::{Search, Solved, Stop};

use super::quantity::Quantity;
use crate::error::Error;
use crate::input::{Fraction, InputError, positive};
use crate::scene::{Scene, Term};
use crate::settings::Settings;

/// Finds out what of a scene has to be modelled for a [`Quantity`] to be right to an accuracy: it runs the scene by a
/// richer model, on finer meshes, by tighter tolerances, and with things left out, one at a time, and compares.
///
/// Errors are those that [`Quantity`] describes, against the richest model on the finest mesh that the budget allows; how
/// far that one can be trusted is told by the mesh before it.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use pliant::samples;
/// use pliant::study::Adviser;
///
/// let scene = samples::clamped_beam([11, 3], 100.0)?.ended_at(0.5);
/// let advice = Adviser::new(&scene, 0.05).budget(20.0).run(&mut |_| ControlFlow::Continue(()))?;
/// println!("{advice}");
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug)]
pub struct Adviser<'a> {
    scene: &'a Scene,
    accuracy: f64,
    settings: Settings,
    quantity: Quantity,
    budget: f64,
}

/// What is enough for a scene, and what that was found from.
#[derive(Debug, Clone)]
pub struct Advice {
    /// What has to be right.
    pub quantity: String,
    /// The relative accuracy that was asked for, and what it is relative to: how much the quantity changes, in `unit`.
    pub accuracy: f64,
    /// See `accuracy`.
    pub scale: f64,
    /// Unit of the scale.
    pub unit: String,
    /// The scene as it was written.
    pub written: Candidate,
    /// The cheapest that is right, if there is one: its error and the [`resolution`](Self::resolution) are below the accuracy
    /// together.
    pub enough: Option<Candidate>,
    /// What all were compared with, and the relative error that it may have itself (NaN: not known).
    pub truth: Option<Candidate>,
    /// See `truth`.
    pub resolution: f64,
    /// What the other measure of strain changes (relative).
    pub law: Option<f64>,
    /// What the other inertia changes.
    pub inertia: Option<f64>,
    /// What is changed by leaving something out.
    pub terms: Vec<(Term, f64)>,
    /// All that were run, in their order.
    pub candidates: Vec<Candidate>,
    /// Time (s) until which the motion can be known, if small errors grow too large before its end: then all else is
    /// about the motion until some time before that.
    pub known_until: Option<f64>,
    /// What was not tried, and why.
    pub not_tried: Vec<String>,
    /// Whether the budget was spent, or the observer has ended the search, before all was tried.
    pub is_cut_short: bool,
    /// Runs, and the time (s) that they took in all.
    pub runs: usize,
    /// See `runs`.
    pub seconds: f64,
}

/// A choice, and how good it is.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The choice.
    pub choice: Choice,
    /// Its relative error; none without a motion, or without anything to compare with.
    pub error: Option<f64>,
    /// Wall-clock time (s) of one run.
    pub seconds: f64,
    /// Unknowns of the integrator.
    pub unknowns: usize,
    /// Why there is no motion.
    pub failure: Option<String>,
}

impl Candidate {
    fn new(choice: Choice) -> Self {
        Self { choice, error: None, seconds: 0.0, unknowns: 0, failure: None }
    }
}

/// Of the time until which a motion is known, this part is advised for.
const KNOWN: f64 = 0.9;

impl<'a> Adviser<'a> {
    /// Of the whole motion of `scene`, to a relative `accuracy` (0.01 is 1 %).
    pub fn new(scene: &'a Scene, accuracy: f64) -> Self {
        let (settings, quantity) = (Settings::default(), Quantity::motion());
        Self { scene, accuracy, settings, quantity, budget: 60.0 }
    }

    /// How the scene is integrated as it was written; other candidates have its alpha. Default: [`Settings::default`].
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// What has to be right. Default: the whole motion.
    #[must_use]
    pub fn quantity(mut self, quantity: Quantity) -> Self {
        self.quantity = quantity;
        self
    }

    /// Time (s) that all runs may take together. Default: 60.
    #[must_use]
    pub fn budget(mut self, seconds: f64) -> Self {
        self.budget = seconds;
        self
    }

    /// Runs candidates until it is known what is enough, or the budget is spent. `observer` is told what is run, after
    /// each step, and ends the search by [`ControlFlow::Break`]; the advice is what is known by then.
    ///
    /// # Errors
    /// Bad input; a scene that gives no motion at all.
    pub fn run(&self, observer: &mut dyn FnMut(&str) -> ControlFlow<()>) -> Result<Advice, Error> {
        Fraction::check("accuracy", self.accuracy)?;
        positive("budget", self.budget, "s")?;
        self.settings.validate()?;
        self.scene.validate()?;
        self.quantity.check(self.scene)?;
        let mut search = Search {
            adviser: self,
            scene: self.scene.clone(),
            nodes: self.scene.body().to_builder().own_mesh().node_count(),
            observer,
            began: Instant::now(),
            failures: Vec::new(),
            runs: 0,
        };
        let mut found = Found::default();
        let mut stop = search.climb(&mut found).err();
        if let (None, Some(until)) = (stop, found.known_until) {
            // what can be known, once more
            search.scene = self.scene.clone().ended_at(KNOWN * until);
            let known_until = found.known_until;
            found = Found { known_until, ..Found::default() };
            stop = search.climb(&mut found).err();
            found.known_until = known_until;
        }
        self.advice(search, found, stop)
    }

    fn advice(&self, search: Search, found: Found, stop: Option<Stop>) -> Result<Advice, Error> {
        let truth = found.meshes.last();
        let candidate = |solved: &Solved| {
            let error =
                truth.map(|truth| truth.seen.distance(&solved.seen).mean / truth.seen.scale);
            let Solved { choice, seconds, unknowns, .. } = solved.clone();
            Candidate { error, seconds, unknowns, ..Candidate::new(choice) }
        };
        let written = found.written.as_ref().map(candidate);
        let written = written.or_else(|| search.failures.first().cloned());
        let Some(written) = written else {
            let mend = "not one run came to its end: allow more time";
            return Err(InputError::new("budget", format!("{} s", self.budget), mend).into());
        };
        let runs = found.written.iter().chain(&found.models);
        let all = runs.chain(found.meshes.iter().skip(1)).chain(&found.sweep).map(candidate);
        let mut candidates: Vec<Candidate> = all.collect();
        candidates.extend(search.failures.iter().cloned());
        // where the mesh was not compared with a finer one, it is taken as it is
        let resolution = search.resolution(&found);
        let allowed = self.accuracy - if resolution.is_nan() { 0.0 } else { resolution };
        let is_right =
            |candidate: &&Candidate| candidate.error.is_some_and(|error| error <= allowed);
        let right = candidates.iter().filter(is_right);
        let enough = right.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).cloned();
        Ok(Advice {
            quantity: self.quantity.to_string(),
            accuracy: self.accuracy,
            scale: truth.map_or(f64::NAN, |truth| truth.seen.scale),
            unit: self.quantity.unit().into(),
            written,
            enough: enough.filter(|_| truth.is_some()),
            truth: truth.map(candidate),
            resolution,
            law: found.law,
            inertia: found.inertia,
            terms: found.terms,
            candidates,
            known_until: found.known_until,
            not_tried: found.not_tried,
            is_cut_short: stop.is_some(),
            runs: search.runs,
            seconds: search.began.elapsed().as_secs_f64(),
        })
    }
}
