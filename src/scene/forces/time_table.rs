//! Tables of vectors over time.

use crate::base::input::{InputError, finite, positive};

/// Largest number of repetitions of a table: all of them are stored.
const MOST_REPEATED: f64 = 1e6;

/// Vectors at given times (s). In between they are interpolated linearly; before the first time
/// and after the last they are constant.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct TimeTable {
    pub(crate) times: Vec<f64>,
    /// The components at each time.
    pub(crate) values: Vec<Vec<f64>>,
}

impl TimeTable {
    pub(crate) fn new(times: Vec<f64>, values: Vec<Vec<f64>>) -> Self {
        Self { times, values }
    }

    /// The same table, times a `factor`.
    pub(super) fn times(&self, factor: f64) -> Self {
        let scaled = |values: &Vec<f64>| values.iter().map(|x| factor * x).collect();
        Self::new(self.times.clone(), self.values.iter().map(scaled).collect())
    }

    /// One component at time `t`.
    pub(crate) fn at(&self, t: f64, component: usize) -> f64 {
        let value = |k: usize| self.values[k][component];
        match self.times.partition_point(|&time| time <= t) {
            0 => value(0),
            next if next == self.times.len() => value(next - 1),
            next => {
                let (from, to) = (self.times[next - 1], self.times[next]);
                let share = (t - from) / (to - from);
                value(next - 1) + share * (value(next) - value(next - 1))
            }
        }
    }

    /// The rate of one component at time `t`; at a kink that of the line behind it.
    pub(super) fn rate(&self, t: f64, component: usize) -> f64 {
        self.rate_of(self.times.partition_point(|&time| time <= t), component)
    }

    /// The rate of one component before time `t` (s); at a kink that of the line which ends there.
    pub(super) fn rate_before(&self, t: f64, component: usize) -> f64 {
        self.rate_of(self.times.partition_point(|&time| time < t), component)
    }

    /// The rate of one component on the line to the time with number `next`, from 0.
    fn rate_of(&self, next: usize, component: usize) -> f64 {
        match next {
            0 => 0.0,
            next if next == self.times.len() => 0.0,
            next => {
                let change = self.values[next][component] - self.values[next - 1][component];
                change / (self.times[next] - self.times[next - 1])
            }
        }
    }

    /// Checks that there are vectors of `dimension` at ascending times.
    pub(super) fn validate(&self, input: &str, dimension: usize) -> Result<(), InputError> {
        let Self { times, values } = self;
        let input_times = format!("times of {input}");
        finite(&input_times, times)?;
        if times.is_empty() || values.len() != times.len() {
            let help = format!("one value is needed for each time, there are {}", values.len());
            return Err(InputError::new(input_times, format!("{times:?}"), help));
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            let help = format!(
                "times must ascend: it must lie after {} s (for a jump, begin another phase)",
                pair[0]
            );
            return Err(InputError::new(input_times, format!("{} s", pair[1]), help));
        }
        for value in values {
            if value.len() != dimension {
                let help = format!("it needs {dimension} component(s)");
                return Err(InputError::new(input, format!("{value:?}"), help));
            }
            finite(input, value)?;
        }
        Ok(())
    }

    /// Appends the table over and over, each time `period` (s) later, up to the time `until` (s).
    pub(crate) fn repeat(&mut self, period: f64, until: f64) -> Result<(), InputError> {
        self.validate("the table that is repeated", self.values.first().map_or(0, Vec::len))?;
        let refused = |help: String| InputError::new("period", format!("{period} s"), help);
        positive("period", period, "s")?;
        finite("end of what is repeated", &[until])?;
        let (first, last) = (self.times[0], self.times[self.times.len() - 1]);
        let length = last - first;
        let closes = (length - period).abs() <= 1e-9 * period;
        if length > period && !closes {
            return Err(refused(format!(
                "the table is {length} s long: its period is that at least"
            )));
        }
        if closes && self.values.first() != self.values.last() {
            let help = "the table is as long as it, and ends with other values than it begins with: end it before, so that there is a line back";
            return Err(refused(help.into()));
        }
        let count = self.times.len() - usize::from(closes);
        self.times.truncate(count);
        self.values.truncate(count);
        let times = ((until - first) / period).floor();
        if times > MOST_REPEATED {
            let help = format!(
                "until {until} s it is repeated {times} times: {MOST_REPEATED} are allowed"
            );
            return Err(refused(help));
        }
        // one more, for the line that leads to it
        for round in 1..=(times.max(0.0) as usize + 1) {
            for k in 0..count {
                self.times.push(self.times[k] + round as f64 * period);
                self.values.push(self.values[k].clone());
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Repetition is exact to round-off, also if the table is shorter than its period.
    #[test]
    fn tables_repeat() {
        let once = TimeTable::new(vec![0.1, 0.2, 0.35], vec![vec![0.0], vec![2.0], vec![1.0]]);
        let mut open = once.clone();
        open.repeat(0.5, 3.0).unwrap();
        let mut closed = once;
        closed.times.push(0.6);
        closed.values.push(vec![0.0]);
        let line = closed.clone();
        closed.repeat(0.5, 3.0).unwrap();
        for k in 0..=290 {
            let t = 0.1 + 0.01 * f64::from(k);
            let expected = line.at(0.1 + (t - 0.1 + 1e-12).rem_euclid(0.5), 0);
            for table in [&open, &closed] {
                assert!((table.at(t, 0) - expected).abs() < 1e-9, "{t}");
            }
        }
        assert!(open.times.is_sorted_by(|a, b| a < b), "{:?}", open.times);
    }

    #[test]
    fn tables_that_cannot_repeat_are_refused() {
        let table = || TimeTable::new(vec![0.0, 0.5], vec![vec![0.0], vec![1.0]]);
        for (period, until) in [(0.4, 1.0), (0.5, 1.0), (0.0, 1.0), (f64::NAN, 1.0), (0.6, 1e9)] {
            let error = table().repeat(period, until).unwrap_err();
            assert_eq!(error.input, "period", "{error}");
        }
        let mut empty = TimeTable::new(vec![], vec![]);
        assert!(empty.repeat(1.0, 1.0).is_err());
    }
}
