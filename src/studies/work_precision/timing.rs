//! Times, with a warning if they cannot be trusted.

use std::hint::black_box;
use std::iter;
use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};

use super::Failed;

/// A run that takes longer than this (s) is not repeated.
const LONG: f64 = 0.5;

/// A fixed piece of arithmetic, timed again and again to see how fast the machine is.
#[derive(Debug)]
pub(crate) struct Yardstick {
    least: f64,
}

impl Yardstick {
    pub(crate) fn new() -> Self {
        Self { least: (0..5).map(|_| arithmetic()).fold(f64::INFINITY, f64::min) }
    }

    /// Present slow-down of the machine, relative to its best.
    pub(crate) fn slowdown(&mut self) -> f64 {
        let seconds = arithmetic();
        self.least = self.least.min(seconds);
        seconds / self.least
    }
}

/// Time (s) of a million multiplications that depend on each other, some milliseconds.
fn arithmetic() -> f64 {
    let clock = Instant::now();
    let mut x = 0.3;
    for _ in 0..1_000_000 {
        x *= 3.9 * (1.0 - x);
    }
    black_box(x);
    clock.elapsed().as_secs_f64()
}

/// Duration of a run (s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Time {
    /// Wall-clock time.
    pub(crate) wall: f64,
    /// Processor time, in which other programs do not count.
    pub(crate) processor: f64,
}

impl Time {
    /// Result of `run`, and its times; `wall` takes the wall-clock time from that.
    pub(crate) fn of<T>(
        run: impl FnOnce() -> Result<T, Failed>,
        wall: impl FnOnce(&T) -> f64,
    ) -> Result<(T, Self), Failed> {
        let start = processor_time();
        let result = run()?;
        let time = Self { wall: wall(&result), processor: processor_time() - start };
        Ok((result, time))
    }
}

/// Processor time (s) that this thread has used.
fn processor_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The processor time that a run may take: other programs on the machine do not use it up.
#[derive(Debug)]
pub(crate) struct Budget {
    start: f64,
    limit: f64,
    asked: u64,
}

impl Budget {
    pub(crate) fn new(limit: Duration) -> Self {
        Self { start: processor_time(), limit: limit.as_secs_f64(), asked: 0 }
    }

    /// Processor time (s) so far.
    pub(crate) fn spent(&self) -> f64 {
        processor_time() - self.start
    }

    /// Whether the budget is spent. To be called after each step; reads the clock only now and then, as steps
    /// may be shorter than a reading.
    pub(crate) fn is_spent(&mut self) -> bool {
        self.asked += 1;
        self.asked.is_multiple_of(16) && self.spent() > self.limit
    }
}

/// Repetitions of one run.
#[derive(Debug)]
pub(crate) struct Repetitions {
    /// Wall-clock times (s), ascending.
    wall: Vec<f64>,
    /// Processor times (s), ascending.
    processor: Vec<f64>,
}

impl Repetitions {
    /// `count` times of a run, by `time`; of a run whose first time was long, that one alone.
    pub(crate) fn of(
        first: Time,
        count: usize,
        time: impl FnMut() -> Result<Time, Failed>,
    ) -> Result<Self, Failed> {
        let times = match first.wall > LONG {
            true => vec![first],
            false => iter::repeat_with(time).take(count).collect::<Result<_, _>>()?,
        };
        let sorted = |of: fn(&Time) -> f64| {
            let mut times: Vec<f64> = times.iter().map(of).collect();
            times.sort_by(f64::total_cmp);
            times
        };
        Ok(Self { wall: sorted(|time| time.wall), processor: sorted(|time| time.processor) })
    }

    pub(crate) fn count(&self) -> usize {
        self.wall.len()
    }

    /// Medians.
    pub(crate) fn median(&self) -> Time {
        Time { wall: median(&self.wall), processor: median(&self.processor) }
    }

    /// Slowest less fastest wall-clock time, relative to the median.
    pub(crate) fn spread(&self) -> f64 {
        (self.wall[self.wall.len() - 1] - self.wall[0]) / median(&self.wall)
    }
}

fn median(sorted: &[f64]) -> f64 {
    let n = sorted.len();
    0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
}

#[cfg(test)]
mod tests {
    use super::{Repetitions, Time};

    fn repetitions(first: f64, times: &[f64]) -> Repetitions {
        let time = |wall: f64| Time { wall, processor: 0.5 * wall };
        let mut times = times.iter();
        let count = times.len();
        Repetitions::of(time(first), count, || Ok(time(*times.next().unwrap()))).unwrap()
    }

    #[test]
    fn the_median_stands_for_all_and_the_spread_is_relative_to_it() {
        let three = repetitions(0.1, &[5.0, 1.0, 2.0]);
        assert_eq!((three.count(), three.spread()), (3, 2.0));
        assert_eq!(three.median(), Time { wall: 2.0, processor: 1.0 });
        let four = repetitions(0.1, &[4.0, 1.0, 2.0, 3.0]);
        assert_eq!((four.median().wall, four.spread()), (2.5, 1.2));
    }

    #[test]
    fn a_long_run_is_not_repeated() {
        let long = repetitions(9.0, &[1.0, 1.0]);
        assert_eq!((long.count(), long.median().wall, long.spread()), (1, 9.0, 0.0));
    }
}
