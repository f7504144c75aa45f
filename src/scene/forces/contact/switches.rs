//! The switches of a contact: which points touch, which normal forces press, and what sticks.

use std::sync::atomic::{AtomicBool, Ordering};

/// Which points touch, and which of their normal forces press: by the numbers that decide on it, or as
/// held from one contact event to the next. Which of these stick, in the latter case only.
pub(super) struct Switches {
    are_held: AtomicBool,
    touch: Vec<AtomicBool>,
    /// None where nothing hangs on it: with adhesion, and without Coulomb's friction.
    press: Vec<AtomicBool>,
    /// None without friction. The force needs none of them, for its law is smooth where they change.
    stick: Vec<AtomicBool>,
}

impl Switches {
    pub(super) fn new(points: usize, pressing: bool, sticking: bool) -> Self {
        let off = |are_there| {
            let count = if are_there { points } else { 0 };
            (0..count).map(|_| AtomicBool::new(false)).collect()
        };
        Self {
            are_held: AtomicBool::new(false),
            touch: off(true),
            press: off(pressing),
            stick: off(sticking),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.touch.len() + self.press.len() + self.stick.len()
    }

    /// Parts the `values` of all switches: distances, pulls, and how much faster points slide than what sticks.
    pub(super) fn parts<'v>(&self, values: &'v mut [f64]) -> [&'v mut [f64]; 3] {
        let (distances, rest) = values.split_at_mut(self.touch.len());
        let (pulls, excesses) = rest.split_at_mut(self.press.len());
        [distances, pulls, excesses]
    }

    pub(super) fn hold(&self, on: Option<&[bool]>) {
        let Self { are_held, touch, press, stick } = self;
        let switches = touch.iter().chain(press).chain(stick);
        for (held, &on) in switches.zip(on.into_iter().flatten()) {
            held.store(on, Ordering::Relaxed);
        }
        are_held.store(on.is_some(), Ordering::Relaxed);
    }

    fn is_on(&self, held: &AtomicBool, value: f64) -> bool {
        match self.are_held.load(Ordering::Relaxed) {
            true => held.load(Ordering::Relaxed),
            // what is no number is taken along, to be found out
            false => value.is_nan() || value <= 0.0,
        }
    }

    /// Whether point number `k` touches, at this distance (m).
    pub(super) fn touches(&self, k: usize, distance: f64) -> bool {
        self.is_on(&self.touch[k], distance)
    }

    /// Whether the normal force of point number `k` presses, or may pull as well; the law has this
    /// `pull` (N).
    pub(super) fn presses(&self, k: usize, pull: f64) -> bool {
        self.press.get(k).is_none_or(|press| self.is_on(press, pull))
    }

    /// Whether all points that are held under friction slide or none does, if it is one of these; the outer
    /// `None` if there are no such points.
    pub(super) fn all_slide(&self) -> Option<Option<bool>> {
        let mut sticking = (0..self.stick.len()).filter_map(|k| self.gripping(k));
        let first = sticking.next()?;
        Some(sticking.all(|sticks| sticks == first).then_some(!first))
    }

    /// Whether point number `k`, if held under friction, sticks.
    fn gripping(&self, k: usize) -> Option<bool> {
        let is = |switch: &AtomicBool| switch.load(Ordering::Relaxed);
        let presses = is(&self.are_held) && is(&self.touch[k]) && is(self.press.get(k)?);
        self.stick.get(k).filter(|_| presses).map(is)
    }
}
