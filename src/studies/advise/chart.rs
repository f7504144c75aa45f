//! The chart of the advice: errors of all candidates over their times.

use svg::Document;
use svg::node::element::{Circle, Group, Path as Outline, Polyline, Title};

use super::advice::{Advice, Candidate};
use crate::base::input::percent;
use crate::io::output::{FONT, Point, rectangle, round, stroke, text};
use crate::studies::work_precision::fastest::time_text;
use crate::studies::work_precision::frame::Frame;

/// Left, top, right and bottom of the field in which points are drawn (px).
const FIELD: [f64; 4] = [74.0, 14.0, 586.0, 404.0];
/// Width and height of the chart (px), with room for what levels mean on its right.
const SIZE: [f64; 2] = [720.0, 456.0];
/// Errors below this part of the accuracy are drawn there: they are good enough for anything.
const LEAST: f64 = 1e-3;
/// Between the lines of two labels (px).
const APART: f64 = 17.0;

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
            (self.truth.as_ref(), "what all are compared with"),
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
        let known: Vec<(f64, &Candidate)> =
            self.candidates.iter().filter_map(|one| Some((one.measured()?, one))).collect();
        if known.is_empty() {
            return None;
        }
        let errors = known.iter().map(|(error, _)| self.shown(*error));
        let resolution = Some(self.resolution).filter(|error| *error > LEAST * self.accuracy);
        let errors = errors.chain(resolution).chain([self.accuracy]);
        let times = known.iter().map(|(_, candidate)| candidate.seconds);
        let colours = ["var(--muted)", "var(--line)", "var(--grid)"];
        let frame = Frame::new(FIELD, colours, times, errors);
        let [width, height] = SIZE;
        let document = Document::new()
            .set("viewBox", (0, 0, width, height))
            .set("font-family", FONT)
            .set("font-size", 13)
            .set("fill", "var(--ink)")
            .set("role", "img")
            .set("aria-label", "Relative error over time of all candidates")
            .add(self.hidden(&frame))
            .add(frame.axes("time of one run"))
            .add(self.levels(&frame));
        let front = self.front();
        let line = front.iter().map(|(error, one)| {
            let [x, y] = frame.place(self.shown(*error), one.seconds);
            format!("{x:.2},{y:.2}")
        });
        let line = Polyline::new()
            .set("points", line.collect::<Vec<_>>().join(" "))
            .set("fill", "none")
            .set("stroke", "var(--accent)")
            .set("stroke-width", 1.8)
            .set("stroke-linejoin", "round");
        let mut points = Group::new().set("class", "points");
        // what matters is drawn over the rest
        let mut known = known;
        known.sort_by_key(|(_, one)| (self.roles_of(one).len(), self.is_on_front(one)));
        for (error, candidate) in known {
            points = points
                .add(self.point(candidate, frame.place(self.shown(error), candidate.seconds)));
        }
        Some(document.add(line).add(points).add(self.labels(&frame)))
    }

    /// The error at which one is drawn: the least are alike, so that none is on the edge of the field.
    fn shown(&self, error: f64) -> f64 {
        error.max(LEAST * self.accuracy)
    }

    /// A band over the errors that the comparison may have itself.
    fn hidden(&self, frame: &Frame) -> Group {
        let [left, _, right, bottom] = FIELD;
        let Some(level) = self.hidden_below(frame) else { return Group::new() };
        let band = rectangle([left, level], [right, bottom]);
        let band = band.set("fill", "var(--solid)").set("opacity", 0.6);
        Group::new().add(band)
    }

    /// Where the band ends (px), if there is one.
    fn hidden_below(&self, frame: &Frame) -> Option<f64> {
        let [_, top, _, bottom] = FIELD;
        let [_, level] = frame.place(self.resolution, 1.0);
        (self.resolution > 0.0 && level < bottom - 1.0).then_some(level.max(top))
    }

    /// The accuracy that was asked for, and what both levels mean, beside the field.
    fn levels(&self, frame: &Frame) -> Group {
        let [left, _, right, _] = FIELD;
        let [_, asked] = frame.place(self.accuracy, 1.0);
        let line = stroke([left, asked], [right, asked], "var(--push)");
        let label = text(format!("asked: {}", percent(self.accuracy)), [right + 8.0, asked + 4.0]);
        let mut levels = Group::new()
            .add(line.set("class", "asked").set("stroke-width", 1.6).set("stroke-dasharray", "7 4"))
            .add(label);
        let least = LEAST * self.accuracy;
        if self.candidates.iter().filter_map(Candidate::measured).any(|error| error < least) {
            let [_, level] = frame.place(least, 1.0);
            let label = text(format!("{} or less", percent(least)), [right + 8.0, level + 4.0]);
            levels = levels.add(label.set("fill", "var(--muted)"));
        }
        let Some(hidden) = self.hidden_below(frame) else { return levels };
        let gap = hidden - asked;
        let hidden = asked + if gap.abs() < APART { APART.copysign(gap) } else { gap };
        let label = format!("known to {}", percent(self.resolution));
        levels.add(text(label, [right + 8.0, hidden + 4.0]).set("fill", "var(--muted)"))
    }

    fn point(&self, candidate: &Candidate, [x, y]: Point) -> Group {
        let parts = self.roles_of(candidate);
        let time = time_text(candidate.seconds);
        let off = candidate.measured().filter(|_| !self.is_truth(candidate)).map(percent);
        let off = off.map_or_else(String::new, |off| format!("{off} off in "));
        let name = parts.iter().map(|part| format!(" ({part})")).collect::<String>();
        let title = format!("{}{name}: {off}{time}", candidate.choice);
        let (colour, radius) = match &parts[..] {
            parts if parts.contains(&"enough") => ("var(--gravity)", 6.5),
            parts if parts.contains(&"as written") => ("var(--push)", 6.5),
            _ if self.is_on_front(candidate) => ("var(--accent)", 4.5),
            _ => ("var(--hatch)", 4.5),
        };
        let point = Group::new()
            .set("fill", colour)
            .set("stroke", "var(--card)")
            .set("stroke-width", 1.2)
            .add(Title::new(title));
        if self.is_truth(candidate) {
            let square = format!("M{x:.2} {y:.2} m0 -7 l7 7 l-7 7 l-7 -7 z");
            let square = Outline::new().set("d", square).set("stroke-width", 2);
            let [fill, line] = ["var(--card)", "var(--ink)"];
            return point.add(square.set("fill", fill).set("stroke", line));
        }
        point.add(Circle::new().set("cx", round(x)).set("cy", round(y)).set("r", radius))
    }

    /// The names of what was written and of what is enough, away from each other.
    fn labels(&self, frame: &Frame) -> Group {
        let place = |one: &Candidate| Some(frame.place(self.shown(one.measured()?), one.seconds));
        let written = place(&self.written);
        let enough = self.enough.as_ref().filter(|enough| !enough.is(&self.written));
        let enough = enough.and_then(place);
        let name = match &self.enough {
            Some(enough) if enough.is(&self.written) => "as written: enough",
            _ => "as written",
        };
        // the lower of two points has its name below it
        let is_below = matches!((written, enough), (Some(a), Some(b)) if a[1] > b[1]);
        [(written, name, is_below), (enough, "enough", !is_below)].into_iter().fold(
            Group::new(),
            |labels, (place, name, is_below)| match place {
                Some(place) => labels.add(label(name, place, is_below)),
                None => labels,
            },
        )
    }
}

/// A name above or below a point, within the field.
fn label(name: &str, [x, y]: Point, is_below: bool) -> svg::node::element::Text {
    let [left, top, right, bottom] = FIELD;
    let is_below = (is_below || y < top + 24.0) && y < bottom - 24.0;
    let anchor = match x {
        x if x > right - 60.0 => "end",
        x if x < left + 60.0 => "start",
        _ => "middle",
    };
    text(name, [x, y + if is_below { 22.0 } else { -12.0 }])
        .set("text-anchor", anchor)
        .set("font-weight", 600)
        .set("stroke", "var(--card)")
        .set("stroke-width", 4)
        .set("stroke-linejoin", "round")
        .set("paint-order", "stroke")
}
