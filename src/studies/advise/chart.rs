//! The chart of the advice: errors of all candidates over their times.

use svg::Document;

use super::advice::{Advice, Candidate};
use crate::base::input::percent;
use crate::io::output::{Figure, Mark, Note, Panel, Series, Theme};
use crate::studies::work_precision::fastest::time_text;
use crate::studies::work_precision::frame::{WORST, axes, below};

/// Width of the chart, and height of its field (px).
const SIZE: [f64; 2] = [600.0, 340.0];
/// Errors below this part of the accuracy are drawn there: they are good enough for anything.
const LEAST: f64 = 1e-3;
const THEME: Theme = Theme {
    paper: "var(--card)",
    ink: "var(--ink)",
    muted: "var(--muted)",
    grid: ["var(--line)", "var(--grid)"],
};
const TRUTH: Mark = Mark { shape: "m0 -7 l7 7 l-7 7 l-7 -7 z", is_hollow: true, ..Mark::DOT };

impl Candidate {
    /// Its relative error, if it is a number.
    fn measured(&self) -> Option<f64> {
        self.error.filter(|error| error.is_finite() && self.failure.is_none())
    }

    /// Whether it is the same run.
    fn is(&self, other: &Candidate) -> bool {
        self.seconds == other.seconds && self.choice == other.choice
    }
}

impl Advice {
    /// The special roles of a candidate, if it has any.
    pub(super) fn roles_of(&self, candidate: &Candidate) -> Vec<&'static str> {
        let parts = [
            (Some(&self.written), "as written"),
            (self.enough.as_ref(), "enough"),
            (self.truth.as_ref(), "the reference"),
        ];
        let own = parts.iter().filter(|(one, _)| one.is_some_and(|one| one.is(candidate)));
        own.map(|(_, name)| *name).collect()
    }

    pub(super) fn is_truth(&self, candidate: &Candidate) -> bool {
        self.truth.as_ref().is_some_and(|truth| truth.is(candidate))
    }

    /// The Pareto front: candidates with their errors, from fast to slow, that are better than all faster
    /// ones. The run that all are compared with has no error of its own, and is left out.
    pub(super) fn front(&self) -> Vec<(f64, &Candidate)> {
        let known = self.candidates.iter().filter(|candidate| !self.is_truth(candidate));
        let mut known: Vec<_> = known.filter_map(|one| Some((one.measured()?, one))).collect();
        known.sort_by(|(_, a), (_, b)| a.seconds.total_cmp(&b.seconds));
        let mut least = f64::INFINITY;
        known.retain(|(error, _)| {
            let is_better = *error < least;
            least = least.min(*error);
            is_better
        });
        known
    }

    /// Whether a candidate is on the [`front`](Self::front).
    pub(super) fn is_on_front(&self, candidate: &Candidate) -> bool {
        self.front().iter().any(|(_, one)| one.is(candidate))
    }

    /// Draws error over time, both logarithmic: a point for each candidate with its name, those on the front
    /// joined by a line, the accuracy, and the errors that the comparison itself may have. `None` without
    /// errors.
    pub(super) fn chart(&self) -> Option<Document> {
        let mut known: Vec<(f64, &Candidate)> =
            self.candidates.iter().filter_map(|one| Some((one.measured()?, one))).collect();
        if known.is_empty() {
            return None;
        }
        let errors = known.iter().map(|(error, _)| self.shown(*error));
        let resolution = Some(self.resolution).filter(|error| *error > LEAST * self.accuracy);
        let errors = errors.chain(resolution).chain([self.accuracy]);
        let axes = axes(known.iter().map(|(_, candidate)| candidate.seconds), errors);

        let named = |name: &str, series: Series| Series { name: name.into(), ..series };
        let dot = |radius| Mark { radius, ..Mark::DOT };
        let front = self.front();
        let front = Series::line("var(--accent)", front.iter().map(|(_, one)| self.point(one)));
        let asked = axes[0].ends().map(|time| (time, self.accuracy.min(WORST)));
        let asked = Series { dashes: "7 4", ..Series::line("var(--push)", asked) };
        let mut series = vec![
            named(&format!("asked: {}", percent(self.accuracy)), asked),
            named("the front: nothing faster is as good", Series { mark: Some(dot(4.5)), ..front }),
            named("another; names when pointed at", Series::marks("var(--hatch)", dot(4.5), [])),
        ];
        if self.resolution > 0.0 {
            let hidden = Series::area("var(--solid)", 0.6, below(self.resolution, &axes));
            series.insert(0, named(&format!("known to {}", percent(self.resolution)), hidden));
        }
        // important series are drawn over the rest
        known.sort_by_key(|(_, one)| (self.roles_of(one).len(), self.is_on_front(one)));
        for (_, candidate) in known {
            let parts = self.roles_of(candidate);
            let (colour, mark) = match &parts[..] {
                _ if self.is_truth(candidate) => ("var(--ink)", TRUTH),
                parts if parts.contains(&"enough") => ("var(--gravity)", dot(6.5)),
                parts if parts.contains(&"as written") => ("var(--push)", dot(6.5)),
                _ if self.is_on_front(candidate) => ("var(--accent)", dot(4.5)),
                _ => ("var(--hatch)", dot(4.5)),
            };
            let tip = Some(self.tip(candidate));
            let one = Series::marks(colour, mark, [self.point(candidate)]);
            series.push(Series { tip, ..named(&parts.join(", "), one) });
        }
        let mut notes = Vec::new();
        let least = LEAST * self.accuracy;
        if self.candidates.iter().filter_map(Candidate::measured).any(|error| error < least) {
            let (text, at) = (format!("{} or less", percent(least)), (axes[0].ends()[0], least));
            notes.push(Note { text, at, shift: [8.0, 4.0], anchor: "start" });
        }
        let names = ["time of one run", "relative error"].map(String::from);
        let panel = Panel { axes, names, series, notes, ..Panel::default() };
        let figure = Figure { theme: THEME, ..Figure::new("", vec![panel], SIZE) };
        let label = "Relative error over time of all candidates";
        Some(figure.draw().set("role", "img").set("aria-label", label))
    }

    /// The error at which one is drawn: the least are alike, so that none is on the edge of the field.
    fn shown(&self, error: f64) -> f64 {
        error.max(LEAST * self.accuracy).min(WORST)
    }

    /// Time and error of a candidate as they are drawn.
    fn point(&self, candidate: &Candidate) -> (f64, f64) {
        (candidate.seconds, candidate.measured().map_or(f64::NAN, |error| self.shown(error)))
    }

    /// Name, error and time of a candidate, as a browser shows them when the pointer is on it.
    fn tip(&self, candidate: &Candidate) -> String {
        let time = time_text(candidate.seconds);
        let off = candidate.measured().filter(|_| !self.is_truth(candidate)).map(percent);
        let off = off.map_or_else(String::new, |off| format!("{off} off in "));
        let name = self.roles_of(candidate).into_iter().map(|part| format!(" ({part})"));
        format!("{}{}: {off}{time}", candidate.choice, name.collect::<String>())
    }
}
