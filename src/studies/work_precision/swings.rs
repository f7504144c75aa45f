//! Frequency and damping of a free vibration.

use std::f64::consts::PI;

use crate::base::root::crosses;

/// Swings below this fraction of the largest one are ripples, or the remainder of a vibration.
const RIPPLE: f64 = 0.05;
/// Rounds in which a crossing is found on a parabola, each of which leaves a small fraction of the error.
const ROUNDS: usize = 4;

/// A turning point: the number of the sample nearest to it, and the value there.
#[derive(Clone, Copy)]
struct Turn {
    sample: usize,
    value: f64,
}

/// Frequency (Hz) and damping ratio of a free vibration; none with fewer than three turning points.
///
/// The frequency follows from the times at which the values cross the middles of the swings, between a turning point and the
/// next, which are half a period apart; they change continuously with the values, which turning points with ripples on them do
/// not. From one turning point to the next the swing falls by exp(-pi zeta/sqrt(1 - zeta^2)).
pub(super) fn swings(times: &[f64], values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let values: Vec<f64> = values.collect();
    // the first and the last sample, with the ripples on them, are no turning points, but ripples are told by them: one that
    // leaves through the start would else leave a lower one behind, and a jump
    let ended = without_ripples(turns(times, &values));
    let turns = ended.get(1..ended.len().checked_sub(1)?)?;
    let halves = turns.len().checked_sub(1).filter(|halves| *halves >= 2)?;
    let crossings = turns.windows(2).map(|pair| {
        let middle = 0.5 * (pair[0].value + pair[1].value);
        crossing(times, &values, [pair[0].sample, pair[1].sample], middle)
    });
    let crossings = crossings.collect::<Option<Vec<f64>>>()?;
    let frequency = (halves - 1) as f64 / (2.0 * (crossings[halves - 1] - crossings[0]));
    let swing = |pair: &[Turn]| (pair[1].value - pair[0].value).abs();
    let (largest, least) = (swing(&turns[..2]), swing(&turns[halves - 1..]));
    let decrement = (largest / least).ln() / (halves - 1) as f64;
    Some((frequency, decrement / PI.hypot(decrement)))
}

/// The turning points between the first and the last sample, and these two.
fn turns(times: &[f64], values: &[f64]) -> Vec<Turn> {
    let mut turns = Vec::new();
    turns.extend(values.first().map(|value| Turn { sample: 0, value: *value }));
    for (number, (t, x)) in (1..).zip(times.windows(3).zip(values.windows(3))) {
        let (before, after) = (x[1] - x[0], x[2] - x[1]);
        if before * after < 0.0 || (after == 0.0 && before != 0.0) {
            // the turning point of the parabola through the three
            let [before, after] = [before / (t[1] - t[0]), after / (t[2] - t[1])];
            let curvature = (after - before) / (t[2] - t[0]);
            let slope = before + curvature * (t[1] - t[0]);
            let value = x[1] - 0.25 * slope * slope / curvature;
            turns.push(Turn { sample: number, value });
        }
    }
    turns.extend(values.last().map(|value| Turn { sample: values.len() - 1, value: *value }));
    turns
}

/// The turning points without those of swings that are small beside the largest.
fn without_ripples(mut turns: Vec<Turn>) -> Vec<Turn> {
    let swing = |turns: &[Turn], k: usize| (turns[k + 1].value - turns[k].value).abs();
    while turns.len() > 1 {
        let count = turns.len() - 1;
        let largest = (0..count).map(|k| swing(&turns, k)).fold(0.0, f64::max);
        let smaller = |a: &usize, b: &usize| swing(&turns, *a).total_cmp(&swing(&turns, *b));
        let Some(least) = (0..count).min_by(smaller) else { break };
        if swing(&turns, least) >= RIPPLE * largest {
            break;
        }
        match least {
            0 => drop(turns.remove(0)),
            last if last + 1 == count => drop(turns.pop()),
            // both of its ends: what is left between their neighbours is one swing
            inner => drop(turns.drain(inner..inner + 2)),
        }
    }
    turns
}

/// The time at which the values cross a `level` between two samples; of several crossings the middle of the first and the
/// last.
fn crossing(times: &[f64], values: &[f64], [from, to]: [usize; 2], level: f64) -> Option<f64> {
    let is_crossed = |&k: &usize| {
        let [a, b] = [values[k] - level, values[k + 1] - level];
        crosses(a, b) || a == 0.0
    };
    let mut crossed = (from..to).filter(is_crossed);
    let first = crossed.next()?;
    let last = crossed.next_back().unwrap_or(first);
    let at = |k: usize| {
        let slope = |k: usize| (values[k + 1] - values[k]) / (times[k + 1] - times[k]);
        // the mean curvature of the parabolas through the two samples and the one before or after
        let curvature = |k: usize| (slope(k + 1) - slope(k)) / (times[k + 2] - times[k]);
        let before = k.checked_sub(1).map(curvature);
        let after = (k + 2 < times.len()).then(|| curvature(k));
        let bend = 0.5 * (before.or(after).unwrap_or(0.0) + after.or(before).unwrap_or(0.0));
        let (start, end, slope) = (times[k], times[k + 1], slope(k));
        if slope == 0.0 {
            return start;
        }
        let mut t = start;
        for _ in 0..ROUNDS {
            let bent = (t - start) * (t - end) * bend;
            t = (start + (level - values[k] - bent) / slope).clamp(start, end);
        }
        t
    };
    Some(0.5 * (at(first) + at(last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times() -> Vec<f64> {
        (0..=2000).map(|k| 1e-3 * f64::from(k)).collect()
    }

    /// x = 2 + exp(-zeta w t) cos(w sqrt(1 - zeta^2) t), of 3 Hz.
    #[test]
    fn frequency_and_damping_are_those_of_the_swings() {
        for zeta in [0.0, 0.02, 0.2] {
            let omega = 2.0 * PI * 3.0 / (1.0_f64 - zeta * zeta).sqrt();
            let times = times();
            let decay = |t: &f64| 2.0 + (-zeta * omega * t).exp() * (6.0 * PI * t).cos();
            let (frequency, damping) = swings(&times, times.iter().map(decay)).unwrap();
            // parabolas through three of about 330 points in a period
            assert!((frequency / 3.0 - 1.0).abs() < 1e-6, "{frequency}");
            assert!((damping - zeta).abs() < 1e-5, "{damping} {zeta}");
        }
        assert!(swings(&[0.0, 1.0, 2.0], [0.0, 1.0, 0.0].into_iter()).is_none());
    }

    /// Ripples of 1 % and 40 Hz on a vibration of 3 Hz, which adds turning points where it turns, and a change of 1e-6 in their
    /// phase, change the frequency by no more than they shift the crossings by.
    #[test]
    fn ripples_do_not_count() {
        let times = times();
        let found = |phase: f64| {
            let rippled = |t: &f64| (6.0 * PI * t).cos() + 0.01 * (80.0 * PI * t + phase).sin();
            swings(&times, times.iter().map(rippled)).unwrap().0
        };
        let mut before = found(0.0);
        for k in 1..=400 {
            let now = found(0.05 * f64::from(k));
            // 1 % at a slope of 6 pi shifts a crossing by 5.3e-4 s or less, and the middle of a swing as much: both twice in the 1.66 s
            // between the first and the last (measured: 9.0e-4)
            assert!((now / 3.0 - 1.0).abs() < 1.3e-3, "{now}");
            // and no jump: a step of 0.05 in the phase shifts the values and the middles of swings by 5e-4 each at most, which
            // is 2.7e-5 s each at both ends (measured: 5.7e-5)
            assert!((now / before - 1.0).abs() < 6.4e-5, "{now} {before}");
            before = now;
        }
    }
}
