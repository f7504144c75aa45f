//! The adviser as it is asked.

use std::ops::ControlFlow;
use std::time::Instant;

use super::advice::{Advice, Candidate};
use super::ladder::Found;
use super::search::{Request, Search, Solved, Stop};
use crate::error::Error;
use crate::input::{Fraction, InputError, positive};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::study::quantity::Quantity;

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
    request: Request,
}

/// Of the time until which a motion is known, this part is advised for.
const KNOWN: f64 = 0.9;
/// Less of a scene is not worth advice.
const LEAST_KNOWN: f64 = 0.01;

impl<'a> Adviser<'a> {
    /// Of the whole motion of `scene`, to a relative `accuracy` (0.01 is 1 %).
    pub fn new(scene: &'a Scene, accuracy: f64) -> Self {
        let (settings, quantity) = (Settings::default(), Quantity::motion());
        Self { scene, request: Request { accuracy, settings, quantity, budget: 60.0 } }
    }

    /// How the scene is integrated as it was written; other candidates have its alpha. Default: [`Settings::default`].
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.request.settings = settings;
        self
    }

    /// What has to be right. Default: the whole motion.
    #[must_use]
    pub fn quantity(mut self, quantity: Quantity) -> Self {
        self.request.quantity = quantity;
        self
    }

    /// Time (s) that all runs may take together. Default: 60.
    #[must_use]
    pub fn budget(mut self, seconds: f64) -> Self {
        self.request.budget = seconds;
        self
    }

    /// Runs candidates until it is known what is enough, or the budget is spent. `observer` is told what is run, after
    /// each step, and ends the search by [`ControlFlow::Break`]; the advice is what is known by then.
    ///
    /// # Errors
    /// Bad input; a scene that gives no motion at all.
    pub fn run(&self, observer: &mut dyn FnMut(&str) -> ControlFlow<()>) -> Result<Advice, Error> {
        let Request { accuracy, settings, quantity, budget } = &self.request;
        Fraction::check("accuracy", *accuracy)?;
        positive("budget", *budget, "s")?;
        settings.validate()?;
        self.scene.validate()?;
        quantity.check(self.scene)?;
        let mut search = Search {
            request: &self.request,
            scene: self.scene.clone(),
            nodes: self.scene.body().to_builder().own_mesh().node_count(),
            observer,
            began: Instant::now(),
            failures: Vec::new(),
            runs: 0,
            is_interrupted: false,
        };
        let mut found = Found::default();
        let mut stop = search.climb(&mut found).err();
        let long_enough = |until: &f64| *until > LEAST_KNOWN * self.scene.end();
        if let (None, Some(until)) = (stop, found.known_until.filter(long_enough)) {
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
            return Err(
                InputError::new("budget", format!("{} s", self.request.budget), mend).into()
            );
        };
        let runs = found.written.iter().chain(&found.models);
        let all = runs.chain(found.meshes.iter().skip(1)).chain(&found.sweep).map(candidate);
        let mut candidates: Vec<Candidate> = all.collect();
        candidates.extend(search.failures.iter().cloned());
        let (resolution, allowed) = (search.resolution(&found), search.allowed(&found));
        let is_right =
            |candidate: &&Candidate| candidate.error.is_some_and(|error| error <= allowed);
        let right = candidates.iter().filter(is_right);
        let enough = right.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).cloned();
        Ok(Advice {
            quantity: self.request.quantity.to_string(),
            accuracy: self.request.accuracy,
            scale: truth.map_or(f64::NAN, |truth| truth.seen.scale),
            unit: self.request.quantity.unit().into(),
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
