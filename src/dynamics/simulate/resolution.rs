//! Bounds of steps where loads, pressures, actuation or prescribed motion change with time.
//!
//! The error estimate of an integrator knows what acts at the few times at which a step evaluates forces; a pulse between
//! them does not exist for it. The time up to the next break is therefore halved into cells until in each of
//! them every number that changes with time is a polynomial of degree 4, to a tolerance. A step is no longer than the narrowest
//! cell that it enters, so that it cannot pass over more than its ends show. Cells are found ahead of each step,
//! only as far as it may go; steps that accuracy has made shorter are left as they are.
//!
//! Numbers that change are those of `scene/timeline/varying.rs`, to ten times `rtol` of their range. Bounds
//! of formulas by interval arithmetic (`base/formula/enclosure.rs`), term by term of a sum, show that nothing
//! is hidden between the values of a cell; kinks and jumps (`base/formula/kinks.rs`) are breaks. Functions of
//! programs are evaluated at some 1e5 times between two breaks: shorter pulses need breaks. The integrator
//! gets a stop time only where the bound is nearer than twice its next step.

use std::sync::Arc;

use crate::scene::timeline::{Phase, Scene, Varying};

/// Deviation from a polynomial, in parts of the range of a number that changes with time, for each part of the relative tolerance of a run;
/// and its limits.
const DEVIATION: f64 = 10.0;
const DEVIATIONS: [f64; 2] = [1e-9, 1e-2];

/// Part of that range by which the bounds of a formula may exceed the polynomial where they are not made narrower.
const EXCESS: f64 = 0.01;

/// Parts of a cell for which bounds are found at most, at one time.
const MOST_BOUNDS: usize = 1 << 14;

/// Parts of the time between two breaks whose bounds give the range of a formula.
const PARTS: usize = 256;

/// Times between two breaks at which functions of programs are looked at, at a deviation of 1e-3.
const LOOKS: f64 = 1e5;

/// Narrowest cells, in parts of the time between two breaks: of formulas and of functions.
const NARROWEST: [f64; 2] = [1e-9, 2e-6];

/// Intervals between the values of a cell.
const INTERVALS: usize = 8;

/// Round-off of values, in parts of the largest.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// The bounds of the steps up to a time at which they end.
#[derive(Default)]
pub(super) struct Resolution {
    /// The phase that it is of.
    phase: Option<Arc<Phase>>,
    /// Start and end (s).
    span: [f64; 2],
    /// End of the steps (s): just before a jump at the end.
    end: f64,
    courses: Vec<Course>,
}

impl Resolution {
    /// Whether it bounds steps of `phase` from time `t` to `stop` (s).
    pub(super) fn is_of(&self, phase: &Arc<Phase>, t: f64, stop: f64) -> bool {
        let is_same = self.phase.as_ref().is_some_and(|own| Arc::ptr_eq(own, phase));
        is_same && self.span[0] <= t && self.span[1] == stop
    }

    /// That of a `phase` for the tolerance `rtol`, in a `span` (s). Functions of programs are looked at so many `times` as often as that takes.
    pub(super) fn new(
        scene: &Scene,
        phase: &Arc<Phase>,
        span: [f64; 2],
        [rtol, times]: [f64; 2],
    ) -> Self {
        let all = scene.varying_in(phase);
        let before = span[1] - 32.0 * f64::EPSILON * span[1].abs();
        let jumps = |varying: &Varying| {
            let [from, to] = [before, span[1]].map(|t| varying.at(t));
            (to - from).abs() > 1e-6 * from.abs().max(to.abs())
        };
        let end = if before > span[0] && all.iter().any(jumps) { before } else { span[1] };
        let [least, most] = DEVIATIONS;
        let deviation = (DEVIATION * rtol).clamp(least, most);
        let looks = times * LOOKS * (1e-3 / deviation).powf(0.2);
        let course = |one| Course::new(one, [span[0], end], [deviation, looks]);
        let courses = all.into_iter().filter_map(course);
        Self { courses: courses.collect(), phase: Some(phase.clone()), span, end }
    }

    /// End of the last step before the end of the span (s).
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// The time (s) up to which a step from time `t` may go, if that is before `until` (s).
    pub(super) fn bound(&mut self, t: f64, until: f64) -> Option<f64> {
        let bounds = self.courses.iter_mut().map(|course| course.bound(t, until));
        bounds.reduce(f64::min).filter(|bound| *bound < until)
    }
}

/// A number that changes with time, and the cells found so far.
struct Course {
    varying: Varying,
    span: [f64; 2],
    /// Least and largest value: bounds of a formula, values that were seen of a function.
    range: [f64; 2],
    deviation: f64,
    /// Time between two looks at a function (s).
    spacing: f64,
    narrowest: f64,
    cells: Vec<Cell>,
}

#[derive(Clone, Copy)]
struct Cell {
    span: [f64; 2],
    /// Values at equal distances.
    values: [f64; INTERVALS + 1],
    /// Up to where (s) it is known that nothing is hidden between them.
    seen: f64,
}

impl Course {
    /// None if the number does not change.
    fn new(varying: Varying, span: [f64; 2], [deviation, looks]: [f64; 2]) -> Option<Self> {
        let length = span[1] - span[0];
        let time = |k: usize, n: usize| span[0] + k as f64 / n as f64 * length;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut include = |[low, high]: [f64; 2]| {
            if low.is_finite() && high.is_finite() {
                range = [range[0].min(low), range[1].max(high)];
            }
        };
        for k in 0..PARTS {
            let part = [time(k, PARTS), time(k + 1, PARTS)];
            match varying.bounds(part) {
                Some(bounds) => include(bounds),
                None if k.is_multiple_of(PARTS / INTERVALS) => include([varying.at(part[0]); 2]),
                None => {}
            }
        }
        let is_formula = varying.bounds(span).is_some();
        if is_formula && range[0] >= range[1] {
            return None;
        }
        let narrowest = NARROWEST[usize::from(!is_formula)] * length;
        // integrators take times that are nearer for the same
        let narrowest = narrowest.max(1e-10 * span[0].abs().max(span[1].abs()));
        let (spacing, cells) = (length / looks, Vec::new());
        Some(Self { varying, span, range, deviation, spacing, narrowest, cells })
    }

    /// The time (s) up to which a step from time `t` may go, as far as `until` (s).
    fn bound(&mut self, t: f64, until: f64) -> f64 {
        let until = until.min(self.span[1]);
        let own = self.cell(t, until);
        let (mut longest, mut bound) = (own.span[1] - own.span[0], own.span[1]);
        while bound < until {
            let [start, end] = self.cell(bound, until).span;
            longest = longest.min(end - start);
            if t + longest <= bound {
                break;
            }
            bound = end.min(t + longest);
            if bound < end {
                break;
            }
        }
        // at the end of the span another bound holds
        if bound >= self.span[1] { f64::INFINITY } else { bound }
    }

    /// The cell that time `t` (s) lies in, in which nothing is hidden up to the time `until` (s).
    fn cell(&mut self, t: f64, until: f64) -> Cell {
        // a time just before the end of a cell is in the next one
        let place = (t + 1e-3 * self.narrowest).min(self.span[1].next_down());
        let is_in = |[start, end]: [f64; 2]| start <= place && place < end;
        if let Some(k) = self.cells.iter().position(|cell| is_in(cell.span)) {
            let mut cell = self.cells[k];
            if self.shows_all(&mut cell, until) {
                self.cells[k] = cell;
                return cell;
            }
            self.cells.remove(k);
        }
        self.cells.retain(|cell| cell.span[1] > t);
        let mut span = self.span;
        loop {
            let [start, end] = span;
            let time = |k: usize| start + k as f64 / INTERVALS as f64 * (end - start);
            let values = std::array::from_fn(|k| self.value(time(k)));
            let mut cell = Cell { span, values, seen: t.max(start) };
            let is_narrow = end - start <= self.narrowest;
            if is_narrow || self.is_smooth(&cell) && self.shows_all(&mut cell, until) {
                self.cells.push(cell);
                return cell;
            }
            let middle = 0.5 * (start + end);
            span = if place < middle { [start, middle] } else { [middle, end] };
        }
    }

    /// Its value at time `t` (s), before a jump at the end.
    fn value(&mut self, t: f64) -> f64 {
        let value = self.varying.at(t.min(self.span[1]));
        if value.is_finite() {
            self.range = [self.range[0].min(value), self.range[1].max(value)];
        }
        value
    }

    /// The largest deviation that counts as none.
    fn tolerance(&self) -> f64 {
        let [low, high] = self.range;
        self.deviation * (high - low) + ROUND_OFF * low.abs().max(high.abs())
    }

    /// Whether the values in between are those of the polynomial through every other one.
    fn is_smooth(&self, cell: &Cell) -> bool {
        let tolerance = self.tolerance();
        let mut odd = (1..INTERVALS).step_by(2);
        odd.all(|k| (cell.polynomial(k as f64) - cell.values[k]).abs() <= tolerance)
    }

    /// Whether nothing is hidden between the values of a cell up to the time `until` (s).
    fn shows_all(&mut self, cell: &mut Cell, until: f64) -> bool {
        let [start, end] = cell.span;
        let part = [cell.seen, until.min(end)];
        if part[0] >= part[1] {
            return true;
        }
        let scale = INTERVALS as f64 / (end - start);
        let shows = match self.varying.bounds(part) {
            Some(_) => self.is_within(cell, part, scale),
            None => {
                let looks = part.map(|t| (t - self.span[0]) / self.spacing);
                (looks[0].ceil() as u64..looks[1].ceil() as u64).all(|k| {
                    let t = self.span[0] + k as f64 * self.spacing;
                    let off = self.value(t) - cell.polynomial((t - start) * scale);
                    off.abs() <= self.tolerance()
                })
            }
        };
        if shows {
            cell.seen = part[1];
        }
        shows
    }

    /// Whether bounds on a formula are those of the values of a cell, in the parts of it that are as short as this takes.
    fn is_within(&self, cell: &Cell, part: [f64; 2], scale: f64) -> bool {
        let slack = EXCESS * (self.range[1] - self.range[0]) + self.tolerance();
        let [low, high] = cell
            .values
            .into_iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |r, x| [r[0].min(x), r[1].max(x)]);
        let mut left = vec![part];
        for _ in 0..MOST_BOUNDS {
            let Some([start, end]) = left.pop() else { return true };
            let Some(bounds) = self.varying.bounds([start, end]) else { return true };
            if bounds[0] >= low - slack && bounds[1] <= high + slack {
                continue;
            }
            let middle = 0.5 * (start + end);
            let off = self.varying.at(middle) - cell.polynomial((middle - cell.span[0]) * scale);
            if off.is_nan() || off.abs() > self.tolerance() {
                return false;
            }
            if end - start > 1e-3 * self.narrowest {
                left.extend([[middle, end], [start, middle]]);
            }
        }
        true
    }
}

impl Cell {
    /// The polynomial through every other value, `place` intervals after the start.
    fn polynomial(&self, place: f64) -> f64 {
        let x = 0.5 * place;
        let weight = |k: usize| {
            let others = (0..=4).filter(|j| *j != k);
            others.map(|j| (x - j as f64) / (k as f64 - j as f64)).product::<f64>()
        };
        (0..=4).map(|k| weight(k) * self.values[2 * k]).sum()
    }
}
