//! The switches of a contact: which points touch, which normal forces press, and what sticks.

use std::sync::atomic::{AtomicBool, Ordering};

/// Which points touch, and which of their normal forces press: by the sign of the present values, or as held
/// from one contact event to the next. In the latter case also which of these stick.
pub(super) struct SwitchStates {
    are_held: AtomicBool,
    touch: Vec<AtomicBool>,
    /// Empty where nothing depends on it: with adhesion and without Coulomb's friction.
    press: Vec<AtomicBool>,
    /// Empty without friction. The force does not use them, as its law is smooth where they change.
    stick: Vec<AtomicBool>,
}

impl SwitchStates {
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

    /// Splits the `values` of all switches: distances, pulls, and how much faster than v0 points slide.
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
            // NaN counts as on, so that it gets into the force and is noticed
            false => value.is_nan() || value <= 0.0,
        }
    }

    /// Whether point number `k` touches, at this distance (m).
    pub(super) fn touches(&self, k: usize, distance: f64) -> bool {
        self.is_on(&self.touch[k], distance)
    }

    /// Whether the normal force of point number `k` presses, or is allowed to pull; by the law it has this
    /// `pull` (N).
    pub(super) fn presses(&self, k: usize, pull: f64) -> bool {
        self.press.get(k).is_none_or(|press| self.is_on(press, pull))
    }

    /// Whether the points that are held under friction all slide (true) or all stick (false), the inner
    /// `None` if some do either; the outer `None` if there are no such points.
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
