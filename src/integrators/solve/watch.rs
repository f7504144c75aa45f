//! An event function followed along the steps.
//!
//! Events are not the root functions of SUNDIALS, which are looked for at the ends of steps only, stop every
//! call, and are particular to each integrator. An event function is evaluated on the interpolant of the
//! step, which all integrators have: at samples, at minima of |g| between them, then between two points.
//! Events that are only recorded do not change the steps.

use super::{event::Event, minimum::minimum};
use crate::base::root::{Direction, Point, bracket, crosses};

/// A root of an event function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    pub(super) t: f64,
    /// +1 where the function rises, -1 where it falls, 0 where it touches.
    pub(super) sign: i32,
    /// Values of the function up to which its sign at the root is noise.
    pub(super) noise: f64,
    /// Whether it is of the direction that counts as an event.
    pub(super) counts: bool,
    /// Start of the further search, and the value there.
    behind: Point,
}

/// The search for roots of one event in a step.
#[derive(Clone, Copy, Default)]
pub(super) struct Seen {
    /// The next one.
    pub(super) root: Option<Root>,
    /// First point at which the function was undefined.
    pub(super) undefined: Option<f64>,
}

/// An event function, and how far it was followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct EventTracker {
    direction: Direction,
    samples: u32,
    touching: Option<f64>,
    /// Whether roots that do not count are found, too.
    finds_all: bool,
    /// The sign that the function should have next, where an action has turned the solution back from zero,
    /// or brought it to rest there.
    turn: Option<Turn>,
    /// Point at which an action has let the solution rest at zero, or pass.
    held: Option<Held>,
    /// When an action was called last, and the longest time between two calls.
    acted: Option<f64>,
    longest: f64,
    t: f64,
    /// The function at `t`; 0 also if it is so near that its sign is noise: then the next sign counts.
    g: f64,
}

/// Expected sign of an event function after an action at its root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// The sign of the function before the root.
    near: f64,
    /// Values up to which its sign is noise.
    noise: f64,
    /// Whether the solution is at rest there.
    pub(super) at_rest: bool,
}

/// A function that is still within the tolerances of zero after an action.
#[derive(Clone, Copy, Debug)]
struct Held {
    /// Values up to which it has not left zero.
    band: f64,
    /// The sign on the side that it came to; 0 if that is not known.
    side: f64,
}

/// Result of an event tracker.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sight {
    Nothing,
    Root(Root),
    /// After an action the function has left zero on the other side, without having the sign of the side that
    /// it came from.
    Passage(Turn),
}

impl Sight {
    pub(super) fn root(self) -> Option<Root> {
        match self {
            Self::Root(root) => Some(root),
            Self::Nothing | Self::Passage(_) => None,
        }
    }
}

impl EventTracker {
    /// Follows `event` from time `t`, where its function is `g`; `finds_all` roots, or those that count.
    pub(super) fn new(event: &Event<'_>, (t, g): (f64, f64), finds_all: bool) -> Self {
        let Event { direction, samples, touching, .. } = *event;
        let (turn, held, acted, longest) = (None, None, None, 0.0);
        Self { direction, samples, touching, finds_all, turn, held, acted, longest, t, g }
    }

    /// Waits until the function leaves zero by more than `band`, from where it is now within that. `side` is the sign
    /// on the side that it came to.
    pub(super) fn hold(&mut self, band: f64, side: f64) {
        if self.g.abs() <= band && self.turn.is_none() && band > 0.0 {
            self.held = Some(Held { band, side });
        }
    }

    /// The function where it was last looked at; 0 where it has not left zero, and the largest number where it is infinite, which JSON cannot hold.
    pub(super) fn value(&self) -> f64 {
        if self.held.is_some() { 0.0 } else { self.g.clamp(-f64::MAX, f64::MAX) }
    }

    /// Continues at time `t`, where the function now is `g` and values up to `noise` count as 0.
    pub(super) fn restart(&mut self, t: f64, g: f64, noise: f64) {
        (self.t, self.g) = (t, if g.abs() <= noise { 0.0 } else { g });
        self.turn = None;
        self.held = self.held.filter(|held| g.abs() <= held.band);
    }

    /// After a new start: an action was called here, at time `t`, and should have turned the solution back as
    /// `turn` says, or let it pass if that is `None`.
    pub(super) fn acted(&mut self, t: f64, turn: Option<Turn>) {
        self.turn = turn.filter(|_| self.g == 0.0);
        let interval = self.acted.map_or(0.0, |last| (t - last).abs());
        (self.acted, self.longest) = (Some(t), self.longest.max(interval));
    }

    /// After a new start: the solution was brought to rest here, where it should have turned.
    pub(super) fn expect_rest(&mut self, turn: Turn) {
        if self.g.abs() <= turn.noise {
            self.g = 0.0;
            self.turn = Some(Turn { at_rest: true, ..turn });
        }
    }

    /// Whether an action at time `t` would follow the last one after less than half the longest interval so
    /// far.
    pub(super) fn hurries(&self, t: f64) -> bool {
        self.acted.is_some_and(|last| (t - last).abs() < 0.5 * self.longest)
    }

    /// Goes on from the start of a step at time `t`, along `sign` t, if a root just before it is where it was followed to.
    pub(super) fn begin_step(&mut self, t: f64, sign: f64) {
        if (t - self.t) * sign > 0.0 {
            self.t = t;
        }
    }

    /// The root in a step up to time `to` that is too short to be searched, placed there.
    pub(super) fn leap<E>(
        &mut self,
        (to, is_last): (f64, bool),
        g: &mut impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Sight, E> {
        if self.g == 0.0 || self.t == to || self.held.is_some() {
            return Ok(Sight::Nothing);
        }
        let before = self.g;
        (self.t, self.g) = (to, g(to)?);
        if self.g == 0.0 && !is_last {
            self.g = f64::MIN_POSITIVE.copysign(before);
        }
        let sign = if before < 0.0 { 1 } else { -1 };
        let counts = self.direction.counts(sign.into());
        let is_met = crosses(before, self.g) && (counts || self.finds_all) && !self.g.is_nan();
        let root = Root { counts, ..Root::at(to, self.g, sign) };
        Ok(if is_met { Sight::Root(root) } else { Sight::Nothing })
    }

    /// The next root up to time `to`, to within `tolerance`. The tracker moves there, or to `to`.
    ///
    /// Whether a 0 at `to` is a root is decided in the next step, unless this one `is_last`.
    pub(super) fn next_root<E>(
        &mut self,
        (to, is_last): (f64, bool),
        tolerance: f64,
        g: &mut impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Sight, E> {
        while (to - self.t).abs() > tolerance {
            let mut root = match self.any_root((to, is_last), tolerance, g)? {
                Sight::Root(root) => root,
                other => return Ok(other),
            };
            (self.t, self.g) = (root.behind.t, root.behind.g);
            root.counts = self.direction.counts(root.sign.into());
            if root.counts || self.finds_all {
                return Ok(Sight::Root(root));
            }
        }
        Ok(Sight::Nothing)
    }

    /// The next root of either direction; without one the tracker moves to `to`.
    fn any_root<E>(
        &mut self,
        (to, is_last): (f64, bool),
        tolerance: f64,
        g: &mut impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Sight, E> {
        if let Some(held) = self.held {
            match self.leave(held, to, tolerance, g)? {
                Some(root) => return Ok(Sight::Root(root)),
                None if self.held.is_some() => return Ok(Sight::Nothing),
                None => {}
            }
        }
        let (from, slice) = (self.t, (to - self.t) / f64::from(self.samples));
        let mut at = |t: f64| g(t).map(|g| Point { t, g });
        let mut last = Point { t: from, g: self.g };
        if last.g == 0.0 {
            last = at(from + 1e-3 * slice)?;
            if let Some(turn) = self.turn
                && last.g * turn.near <= turn.noise
            {
                match turn.leaves_zero(from, to, tolerance, &mut at)? {
                    Some(point) if point.g * turn.near > 0.0 => last = point,
                    Some(_) => return Ok(Sight::Passage(turn)),
                    None => {
                        self.t = to;
                        return Ok(Sight::Nothing);
                    }
                }
            }
            self.turn = None;
            if last.g.is_nan() {
                return Ok(Sight::Nothing);
            }
        }
        let mut before: Option<Point> = None;
        for k in 1..=self.samples {
            let t = if k == self.samples { to } else { from + slice * f64::from(k) };
            let mut next = at(t)?;
            if next.g.is_nan() {
                let root = Root::up_to_edge(last, t, tolerance, &mut at)?;
                return Ok(root.map_or(Sight::Nothing, Sight::Root));
            }
            if last.g == 0.0 {
                last = next;
                continue;
            }
            let knows_behind = k < self.samples || !(is_last || self.touching.is_some());
            if next.g == 0.0 && knows_behind {
                // the sign after it decides whether it crosses; after the end of the step, that is left to
                // the next step
                let still = f64::MIN_POSITIVE.copysign(last.g);
                let behind = if k == self.samples { still } else { at(t + 1e-3 * slice)?.g };
                if behind != 0.0 && !crosses(last.g, behind) {
                    next.g = still;
                }
            }
            // where |g| has a minimum: around the last sample, or near an end, by the slope there
            let dip = match before {
                Some(first) if is_lower(last, first) && !is_lower(next, last) => Some(first),
                None if is_lower(last, next) && falls_from(last, next, &mut at)? => Some(last),
                _ if k < self.samples => None,
                _ => (is_lower(next, last) && falls_from(next, last, &mut at)?).then_some(last),
            };
            if let Some(first) = dip.filter(|_| !crosses(last.g, next.g)) {
                let lowest =
                    minimum(first, next, self.touching.is_some(), &mut |t| at(t).map(|p| p.g))?;
                if crosses(first.g, lowest.g) {
                    return Root::between(first, lowest, tolerance, &mut at).map(Sight::Root);
                }
                if self.touching.is_some_and(|most| lowest.g.abs() <= most) {
                    let (t, sign, noise, counts) = (lowest.t, 0, 0.0, true);
                    return Ok(Sight::Root(Root { t, sign, noise, counts, behind: next }));
                }
            }
            if crosses(last.g, next.g) {
                return Root::between(last, next, tolerance, &mut at).map(Sight::Root);
            }
            (before, last) = (Some(last), next);
        }
        (self.t, self.g) = (last.t, last.g);
        Ok(Sight::Nothing)
    }
}

impl EventTracker {
    /// Goes to the first sample up to time `to` where the function has left zero, or to the end. It has crossed zero
    /// only if it leaves to the side that it came from.
    fn leave<E>(
        &mut self,
        held: Held,
        to: f64,
        tolerance: f64,
        g: &mut impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Option<Root>, E> {
        let (from, slice) = (self.t, (to - self.t) / f64::from(self.samples));
        let mut at = |t: f64| g(t).map(|g| Point { t, g });
        for k in 0..=self.samples {
            let t = match k {
                0 => from + 1e-3 * slice,
                k if k == self.samples => to,
                k => from + slice * f64::from(k),
            };
            let point = at(t)?;
            if point.g.abs() > held.band {
                self.held = None;
                let near = Point { t: self.t, g: held.side * f64::MIN_POSITIVE };
                if crosses(near.g, point.g) {
                    return Root::between(near, point, tolerance, &mut at).map(Some);
                }
                (self.t, self.g) = (point.t, point.g);
                return Ok(None);
            }
            self.t = t;
        }
        Ok(None)
    }
}

impl Turn {
    pub(super) fn at(root: &Root) -> Self {
        Self { near: -f64::from(root.sign), noise: root.noise, at_rest: false }
    }

    /// The first point from the time `from` to `to` where the function is more than noise.
    ///
    /// It is evaluated at distances that grow fourfold, so that an arc above zero that begins at `from` is
    /// not missed.
    fn leaves_zero<E>(
        &self,
        from: f64,
        to: f64,
        tolerance: f64,
        at: &mut impl FnMut(f64) -> Result<Point, E>,
    ) -> Result<Option<Point>, E> {
        let mut distance = 2.0 * tolerance;
        loop {
            let is_last = distance >= (to - from).abs();
            let point = at(if is_last { to } else { from + distance.copysign(to - from) })?;
            if point.g.abs() > self.noise {
                return Ok(Some(point));
            }
            if is_last {
                return Ok(None);
            }
            distance *= 4.0;
        }
    }

    /// Whether a change of the function by `change` leads back to the side that it came from; `None` if it is
    /// noise.
    pub(super) fn leads_back(&self, change: f64) -> Option<bool> {
        (change.abs() > self.noise).then_some(change * self.near > 0.0)
    }
}

/// Whether |g| is smaller at `a` than at `b`.
fn is_lower(a: Point, b: Point) -> bool {
    a.g.abs() < b.g.abs()
}

/// Whether |g| falls, or crosses zero, on the way from `a` towards `b`.
fn falls_from<E>(
    a: Point,
    b: Point,
    at: &mut impl FnMut(f64) -> Result<Point, E>,
) -> Result<bool, E> {
    let near = at(a.t + 1e-3 * (b.t - a.t))?;
    Ok(is_lower(near, a) || crosses(a.g, near.g))
}

/// Part of the last value of a function that it has to fall below on its way to the edge of its domain, for that to be a root;
/// less where it was followed to a smaller part of the distance, of which a square root falls to the root.
const ZERO_AT_EDGE: f64 = 1e-3;

impl Root {
    /// A root at time `t`, where the function is `g`, of which no more is known.
    pub(super) fn at(t: f64, g: f64, sign: i32) -> Self {
        Self { t, sign, noise: 10.0 * g.abs(), counts: true, behind: Point { t, g } }
    }

    /// The root between `near` and the edge of the domain of the function, before the time `beyond` where it is undefined.
    fn up_to_edge<E>(
        mut near: Point,
        mut beyond: f64,
        tolerance: f64,
        at: &mut impl FnMut(f64) -> Result<Point, E>,
    ) -> Result<Option<Self>, E> {
        let first = near;
        if first.g == 0.0 {
            return Ok(None);
        }
        while (beyond - near.t).abs() > tolerance.max(2.0 * f64::EPSILON * beyond.abs()) {
            let middle = at(0.5 * (near.t + beyond))?;
            if middle.g.is_nan() {
                beyond = middle.t;
            } else if crosses(near.g, middle.g) {
                return Self::between(near, middle, tolerance, at).map(Some);
            } else {
                near = middle;
            }
        }
        let sign = if first.g < 0.0 { 1 } else { -1 };
        let part = ((beyond - near.t) / (beyond - first.t)).cbrt().min(ZERO_AT_EDGE);
        let falls = near.g.abs() < part * first.g.abs();
        Ok(falls.then(|| Self::at(near.t, near.g, sign)))
    }

    fn between<E>(
        near: Point,
        far: Point,
        tolerance: f64,
        at: &mut impl FnMut(f64) -> Result<Point, E>,
    ) -> Result<Self, E> {
        let (near, far) = bracket(near, far, tolerance, &mut |t| at(t).map(|p| p.g))?;
        let sign = if near.g < 0.0 { 1 } else { -1 };
        let noise = 10.0 * (near.g.abs() + far.g.abs());
        Ok(Self { t: far.t, sign, noise, counts: true, behind: far })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows g over steps of one unit; the roots with their signs.
    fn roots(event: Event<'_>, g: impl Fn(f64) -> f64, steps: u32) -> Vec<(f64, i32)> {
        let mut watch = EventTracker::new(&event, (0.0, g(0.0)), false);
        let mut found = Vec::new();
        for step in 1..=steps {
            while let Sight::Root(root) = watch
                .next_root((f64::from(step), step == steps), 1e-13, &mut |t| Ok::<_, ()>(g(t)))
                .unwrap()
            {
                found.push((root.t, root.sign));
            }
        }
        found
    }

    fn event() -> Event<'static> {
        Event::new(|_, _| 0.0)
    }

    #[test]
    fn two_roots_within_a_slice_are_found_wherever_they_are() {
        for middle in [0.01, 0.1, 0.25, 0.4, 0.5, 0.77, 0.9, 0.99] {
            let found = roots(event(), |t| (t - middle) * (t - middle) - 1e-6, 1);
            let expected = [(middle - 1e-3, -1), (middle + 1e-3, 1)];
            assert_eq!(found.len(), 2, "{middle}: {found:?}");
            for ((t, sign), (t_expected, sign_expected)) in found.iter().zip(expected) {
                assert!((t - t_expected).abs() < 1e-12 && *sign == sign_expected, "{found:?}");
            }
        }
    }

    #[test]
    fn one_direction_may_count_alone() {
        let g = |t: f64| (t * 3.0).sin();
        let root = |k: f64| k * std::f64::consts::PI / 3.0;
        let close = |found: Vec<(f64, i32)>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|((t, _), e)| (t - e).abs() < 1e-12));
        };
        // it starts at zero, which is no event
        close(roots(event(), g, 4), &[root(1.0), root(2.0), root(3.0)]);
        close(roots(event().rising(), g, 4), &[root(2.0)]);
        close(roots(event().falling(), g, 4), &[root(1.0), root(3.0)]);
    }

    #[test]
    fn touching_is_an_event_if_asked_for() {
        for touch in [0.013, 0.3, 0.5, 0.98] {
            let g = |t: f64| (t - touch) * (t - touch);
            assert_eq!(roots(event(), g, 1), []);
            let found = roots(event().touching(1e-12), g, 1);
            assert_eq!(found.len(), 1, "{touch}: {found:?}");
            assert!((found[0].0 - touch).abs() < 1e-6 && found[0].1 == 0, "{found:?}");
        }
    }

    #[test]
    fn what_arrives_at_zero_and_stays_is_one_event() {
        let found = roots(event(), |t| (0.6 - t).max(0.0), 3);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].0 - 0.6).abs() < 1e-12 && found[0].1 == -1);
        // also where it arrives at the end of a step, or of the run; and leaving zero is no event
        for steps in [1, 3] {
            let found = roots(event(), |t| (1.0 - t).max(0.0), steps);
            assert_eq!(found.len(), 1, "{steps}: {found:?}");
            assert!((found[0].0 - 1.0).abs() < 1e-12 && found[0].1 == -1, "{found:?}");
        }
        assert_eq!(roots(event(), |t| (t - 0.6).max(0.0), 3), []);
    }
}
