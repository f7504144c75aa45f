//! Angles that are continuous over whole turns.

/// The last angles that sensors read, in turns including whole ones, by the names of the sensors.
///
/// They are updated after each step of the integrator, so that they do not depend on when samples are taken;
/// changes by less than half a turn in a step are followed.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Angles(pub(crate) Vec<(String, f64)>);

impl Angles {
    /// Number of whole turns to be added to an angle of `turns`, known up to whole ones, to be nearest to
    /// the one that was noted. 0 if none was noted.
    pub(super) fn behind(&self, name: &str, turns: f64) -> f64 {
        self.0
            .iter()
            .find(|(known, _)| known == name)
            .map_or(0.0, |(_, last)| (last - turns).round())
    }

    /// Removes the angles of sensors that are not kept.
    pub(super) fn keep(&mut self, is_kept: impl Fn(&str) -> bool) {
        self.0.retain(|(name, _)| is_kept(name));
    }

    /// Notes that the sensor `name` reads this many `turns`; an angle that is not finite is not noted.
    pub(super) fn note(&mut self, name: &str, turns: f64) {
        if !turns.is_finite() {
            return;
        }
        match self.0.iter_mut().find(|(known, _)| known == name) {
            Some((_, last)) => *last = turns,
            None => self.0.push((name.to_owned(), turns)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Angles;

    /// Back and forth over the seam, with a gap in between.
    #[test]
    fn whole_turns_are_counted() {
        let mut angles = Angles::default();
        let read = [0.4, 0.45, -0.45, -0.1, f64::NAN, 0.3, -0.4, 0.4];
        let expected = [0.4, 0.45, 0.55, 0.9, f64::NAN, 1.3, 1.6, 1.4];
        for (turns, expected) in read.into_iter().zip(expected) {
            let now = turns + angles.behind("ring", turns);
            angles.note("ring", now);
            // sums of a few numbers of order 1
            assert!((now - expected).abs() < 1e-15 || expected.is_nan() && now.is_nan(), "{now}");
        }
        assert_eq!(angles.behind("another", -0.4), 0.0);
    }
}
