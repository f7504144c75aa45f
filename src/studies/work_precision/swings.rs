//! Frequency and damping of a free vibration.

use std::f64::consts::PI;

/// Frequency (Hz) and damping ratio of a free vibration, from its turning points: their distances are half
/// periods, and from one to the next the swing falls by exp(-pi zeta/sqrt(1 - zeta^2)). None with fewer than
/// three of them.
pub(super) fn swings(times: &[f64], values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let values: Vec<f64> = values.collect();
    let mut turns: Vec<[f64; 2]> = Vec::new();
    for (t, x) in times.windows(3).zip(values.windows(3)) {
        let (before, after) = (x[1] - x[0], x[2] - x[1]);
        if before * after < 0.0 || (after == 0.0 && before != 0.0) {
            // the turning point of the parabola through the three
            let [before, after] = [before / (t[1] - t[0]), after / (t[2] - t[1])];
            let curvature = (after - before) / (t[2] - t[0]);
            let slope = before + curvature * (t[1] - t[0]);
            let away = -0.5 * slope / curvature;
            turns.push([t[1] + away, x[1] + 0.5 * slope * away]);
        }
    }
    let (first, last) = (turns.first()?, turns.last()?);
    let halves = turns.len().checked_sub(1).filter(|halves| *halves >= 2)? as f64;
    let frequency = halves / (2.0 * (last[0] - first[0]));
    let swing = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]).abs();
    let (largest, least) = (swing(&turns[..2]), swing(&turns[turns.len() - 2..]));
    let decrement = (largest / least).ln() / (halves - 1.0);
    Some((frequency, decrement / PI.hypot(decrement)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = 2 + exp(-zeta w t) cos(w sqrt(1 - zeta^2) t), of 3 Hz.
    #[test]
    fn frequency_and_damping_are_those_of_the_swings() {
        for zeta in [0.0, 0.02, 0.2] {
            let omega = 2.0 * PI * 3.0 / (1.0_f64 - zeta * zeta).sqrt();
            let times: Vec<f64> = (0..=2000).map(|k| 1e-3 * f64::from(k)).collect();
            let decay = |t: &f64| 2.0 + (-zeta * omega * t).exp() * (6.0 * PI * t).cos();
            let (frequency, damping) = swings(&times, times.iter().map(decay)).unwrap();
            // parabolas through three of about 330 points in a period
            assert!((frequency / 3.0 - 1.0).abs() < 1e-6, "{frequency}");
            assert!((damping - zeta).abs() < 1e-5, "{damping} {zeta}");
        }
        assert!(swings(&[0.0, 1.0, 2.0], [0.0, 1.0, 0.0].into_iter()).is_none());
    }
}
