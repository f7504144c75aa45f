//! The adviser: its settings, and its search.

use std::ops::ControlFlow;
use std::path::PathBuf;

use super::advice::{Advice, Candidate};
use super::evidence::Evidence;
use super::runs::Runs;
use super::search::{Request, Search, Solved, Stop};
use crate::base::input::{Fraction, InputError, positive};
use crate::dynamics::error::Error;
use crate::scene::settings::Settings;
use crate::scene::timeline::Scene;
use crate::studies::work_precision::look::Look;
use crate::studies::work_precision::quantity::Quantity;

/// Search for the cheapest model of a scene with a given accuracy of a [`Quantity`].
///
/// It runs the scene with a richer model, on finer meshes, with tighter tolerances, and with things left out,
/// one at a time, and compares.
///
/// Errors are those that [`Quantity`] describes, against the richest model on the finest mesh that the budget
/// allows; how far that one can be trusted is estimated from the mesh before it.
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
    file: Option<PathBuf>,
}

/// The advice is for this part of the time until which a motion is known.
const KNOWN: f64 = 0.9;
/// The first look takes at most this many seconds, and this part of the budget.
const LOOK: f64 = Look::SECONDS;
const LOOK_SHARE: f64 = 0.05;
/// If a smaller part of a scene is known, no advice is given for it.
const LEAST_KNOWN: f64 = 0.01;

impl<'a> Adviser<'a> {
    /// An adviser for the whole motion of `scene`, to a relative `accuracy` (0.01 is 1 %).
    pub fn new(scene: &'a Scene, accuracy: f64) -> Self {
        let (settings, quantity) = (Settings::default(), Quantity::motion());
        Self { scene, request: Request { accuracy, settings, quantity, budget: 60.0 }, file: None }
    }

    /// Settings of the scene as it was written; other candidates have its alpha. Default:
    /// [`Settings::default`].
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.request.settings = settings;
        self
    }

    /// Quantity that has to be accurate. Default: the whole motion.
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

    /// A file that keeps all runs. Runs that it holds are not repeated, so that a search that was cut
    /// short can continue, within a new budget; runs of other scenes stay in it. Runs of other versions of
    /// this library are not used; after changes of the code within a version, or on another machine, begin a
    /// new file.
    #[must_use]
    pub fn keep(mut self, file: impl Into<PathBuf>) -> Self {
        self.file = Some(file.into());
        self
    }

    /// Runs candidates until a sufficient model is known, or the budget is spent. `observer` is called after
    /// each step with the name of the current run, and ends the search by [`ControlFlow::Break`]; the advice is then what is
    /// known by then.
    ///
    /// # Errors
    /// Bad input; a scene that gives no motion at all; [`Error::Output`] if the file of the runs cannot be
    /// read or written.
    pub fn run(&self, observer: &mut dyn FnMut(&str) -> ControlFlow<()>) -> Result<Advice, Error> {
        let Request { accuracy, settings, quantity, budget } = &self.request;
        Fraction::check("accuracy", *accuracy)?;
        positive("budget", *budget, "s")?;
        settings.validate()?;
        self.scene.validate()?;
        self.scene.refuse_ends("the adviser")?;
        quantity.check(self.scene)?;
        let runs = Runs::open(self.file.as_deref())?;
        let look = Look::of(self.scene, settings, LOOK.min(LOOK_SHARE * budget))?;
        let mut search = Search::new(&self.request, self.scene, runs, observer);
        let (mut found, mut is_cut_short) = (Evidence::default(), false);
        let mut climb = |search: &mut Search, found: &mut Evidence| match search.climb(found) {
            Ok(()) => Ok(()),
            Err(Stop::Trouble(error)) => Err(error),
            Err(Stop::Budget | Stop::Interrupted) => {
                is_cut_short = true;
                Ok(())
            }
        };
        climb(&mut search, &mut found)?;
        let long_enough = |until: &f64| *until > LEAST_KNOWN * self.scene.end();
        if let Some(until) = found.known_until.filter(long_enough) {
            // once more, for the part that can be known
            search.scene = self.scene.clone().ended_at(KNOWN * until);
            let known_until = found.known_until;
            found = Evidence::default();
            climb(&mut search, &mut found)?;
            found.known_until = known_until;
        }
        Ok(Advice { look: Some(look), ..self.advice(search, found, is_cut_short)? })
    }

    fn advice(&self, search: Search, found: Evidence, is_cut_short: bool) -> Result<Advice, Error> {
        let truth = found.truth();
        let named = |candidate: Candidate| {
            let set = candidate.choice.overrides(self.scene, &self.request.settings);
            Candidate { set, ..candidate }
        };
        let candidate = |solved: &Solved| {
            let Solved { choice, seconds, unknowns, warnings, .. } = solved.clone();
            named(Candidate {
                error: truth.map(|truth| solved.error(truth)),
                parts: found.parts(solved),
                seconds,
                unknowns,
                warnings,
                ..Candidate::new(choice)
            })
        };
        let written = found.written.as_ref().map(candidate);
        let Some(written) = written.or_else(|| search.failures.first().cloned().map(named)) else {
            let help = "not one run came to its end: allow more time";
            return Err(
                InputError::new("budget", format!("{} s", self.request.budget), help).into()
            );
        };
        let mut candidates: Vec<Candidate> = found.all().map(candidate).collect();
        candidates.extend(search.failures.iter().cloned().map(named));
        Ok(Advice {
            quantity: self.request.quantity.to_string(),
            accuracy: self.request.accuracy,
            scale: truth.map_or(f64::NAN, |truth| truth.seen.scale),
            unit: self.request.quantity.unit().into(),
            written,
            enough: found.best(self.request.accuracy).map(candidate),
            truth: truth.map(candidate),
            resolution: found.resolution(),
            has_rate: found.has_rate(),
            mesh: found.mesh(),
            candidates,
            runs: search.runs,
            known: search.known,
            seconds: search.began.elapsed().as_secs_f64(),
            alphas: found.alphas,
            law: found.law,
            inertia: found.inertia,
            terms: found.terms,
            together: found.together,
            mesh_estimate: found.mesh_estimate,
            smaller: found.smaller,
            reduced: found.reduced,
            look: None,
            known_until: found.known_until,
            end: search.scene.end(),
            not_tried: found.not_tried,
            is_cut_short,
        })
    }
}
