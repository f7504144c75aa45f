//! Smooth paths through points.

use super::Prescribed;
use crate::base::input::{InputError, finite};
use crate::base::vector::largest;

/// A displacement that runs smoothly through given points: a cubic spline. It starts and ends with
/// velocity 0, and rests before the first time and after the last. Between them b, b' and b'' are
/// continuous; b'' starts and ends with a jump.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(from = "Points"))]
pub(crate) struct Spline {
    /// Times (s), ascending.
    times: Vec<f64>,
    /// b at these times (m).
    displacements: Vec<f64>,
    /// b' there (m/s). Between two points the path is the cubic with these values and slopes at its ends.
    #[cfg_attr(feature = "checkpoint", serde(skip_serializing))]
    velocities: Vec<f64>,
}

/// Serialized form of a spline: named fields, or a sequence as [`as_pair`] writes it.
#[cfg(feature = "checkpoint")]
#[derive(serde::Deserialize)]
struct Points {
    times: Vec<f64>,
    displacements: Vec<f64>,
}

#[cfg(feature = "checkpoint")]
impl From<Points> for Spline {
    fn from(Points { times, displacements }: Points) -> Self {
        Self::new(times, displacements)
    }
}

/// Writes the times and displacements of a path without their names.
#[cfg(feature = "checkpoint")]
pub(super) fn as_pair<S: serde::Serializer>(
    path: &Option<Spline>,
    to: S,
) -> Result<S::Ok, S::Error> {
    let pair = path.as_ref().map(|path| [&path.times, &path.displacements]);
    serde::Serialize::serialize(&pair, to)
}

impl Spline {
    /// The path through these points, to be [validated](Self::validate) before it is used.
    pub(crate) fn new(times: Vec<f64>, displacements: Vec<f64>) -> Self {
        let velocities = velocities(&times, &displacements);
        Self { times, displacements, velocities }
    }

    /// Times (s) of the points.
    pub(crate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// A bound on the speed (m/s): between two points the velocity is a quadratic Bezier curve, no larger
    /// than the largest of its control points.
    pub(crate) fn fastest(&self) -> f64 {
        let piece = |k: usize| {
            let span = self.times[k + 1] - self.times[k];
            let mean = (self.displacements[k + 1] - self.displacements[k]) / span;
            let (from, to) = (self.velocities[k], self.velocities[k + 1]);
            largest(&[from, 3.0 * mean - from - to, to])
        };
        (1..self.times.len()).map(|next| piece(next - 1)).fold(0.0, f64::max)
    }

    /// `values` and `unit` name what the path gives, for messages.
    ///
    /// # Errors
    /// Fewer than 2 points, times that do not ascend, numbers that are not finite, numbers of times and
    /// displacements that differ.
    pub(crate) fn validate(&self, values: &str, unit: &str) -> Result<(), InputError> {
        let Self { times, displacements, .. } = self;
        finite("the times of a path", times)?;
        finite(&format!("the {values}"), displacements)?;
        if times.len() < 2 {
            let help = "a path needs two points at least (s)";
            return Err(InputError::new("times of a path", format!("{times:?}"), help));
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[0] >= pair[1]) {
            let help = format!("times must ascend: it must lie after {} s", pair[0]);
            return Err(InputError::new("times of a path", format!("{} s", pair[1]), help));
        }
        if displacements.len() != times.len() {
            let help = format!("one is needed for each of the {} times ({unit})", times.len());
            return Err(InputError::new(values, format!("{displacements:?}"), help));
        }
        Ok(())
    }

    pub(crate) fn at(&self, t: f64) -> Prescribed {
        let rest = |displacement| Prescribed { displacement, velocity: 0.0, acceleration: 0.0 };
        let last = self.times.len() - 1;
        if t < self.times[0] {
            return rest(self.displacements[0]);
        }
        if t > self.times[last] {
            return rest(self.displacements[last]);
        }
        let k = self.times[1..last].partition_point(|&time| time <= t);
        let (from, to) = (self.velocities[k], self.velocities[k + 1]);
        let span = self.times[k + 1] - self.times[k];
        let mean = (self.displacements[k + 1] - self.displacements[k]) / span;
        // b = b_k + s (from + s (bend + s twist))
        let bend = (3.0 * mean - 2.0 * from - to) / span;
        let twist = (from + to - 2.0 * mean) / (span * span);
        let s = t - self.times[k];
        Prescribed {
            displacement: self.displacements[k] + s * (from + s * (bend + s * twist)),
            velocity: from + s * (2.0 * bend + 3.0 * s * twist),
            acceleration: 2.0 * bend + 6.0 * s * twist,
        }
    }
}

/// The velocities that make b'' continuous: with the spans h_k and mean velocities d_k between the
/// points,
///
/// v_(k-1)/h_(k-1) + 2 (1/h_(k-1) + 1/h_k) v_k + v_(k+1)/h_k = 3 (d_(k-1)/h_(k-1) + d_k/h_k)
///
/// at all inner points, and v = 0 at both ends. The matrix is tridiagonal and diagonally dominant.
fn velocities(times: &[f64], displacements: &[f64]) -> Vec<f64> {
    let last = times.len().min(displacements.len()).saturating_sub(1);
    let inverse = |k: usize| (times[k + 1] - times[k]).recip();
    let pull = |k: usize| 3.0 * (displacements[k + 1] - displacements[k]) * inverse(k).powi(2);
    let (mut velocities, mut diagonal) = (vec![0.0; last + 1], vec![0.0; last + 1]);
    for k in 1..last {
        let (before, after) = (inverse(k - 1), inverse(k));
        let ratio = if k == 1 { 0.0 } else { before / diagonal[k - 1] };
        diagonal[k] = 2.0 * (before + after) - ratio * before;
        velocities[k] = pull(k - 1) + pull(k) - ratio * velocities[k - 1];
    }
    for k in (1..last).rev() {
        velocities[k] = (velocities[k] - inverse(k) * velocities[k + 1]) / diagonal[k];
    }
    velocities
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline(times: &[f64], displacements: &[f64]) -> Spline {
        let spline = Spline::new(times.into(), displacements.into());
        spline.validate("displacements of a path", "m").unwrap();
        spline
    }

    /// A cubic with b' = 0 at both ends is its own spline, whichever points on it are given. Errors are those
    /// of round-off, amplified by the division by squared spans.
    #[test]
    fn a_cubic_is_its_own_spline() {
        // b = 0.3 (3 s^2 - 2 s^3) with s = (t - 1)/4
        let cubic = |t: f64| {
            let s = (t - 1.0) / 4.0;
            Prescribed {
                displacement: 0.3 * s * s * (3.0 - 2.0 * s),
                velocity: 0.3 * 6.0 * s * (1.0 - s) / 4.0,
                acceleration: 0.3 * 6.0 * (1.0 - 2.0 * s) / 16.0,
            }
        };
        for times in [&[1.0, 5.0][..], &[1.0, 2.0, 5.0], &[1.0, 1.1, 2.5, 3.0, 4.7, 5.0]] {
            let b: Vec<f64> = times.iter().map(|&t| cubic(t).displacement).collect();
            let spline = spline(times, &b);
            for k in 0..=40 {
                let t = 1.0 + 0.1 * f64::from(k);
                let (found, expected) = (spline.at(t), cubic(t));
                assert!((found.displacement - expected.displacement).abs() < 1e-14, "{t}");
                assert!((found.velocity - expected.velocity).abs() < 1e-13, "{t}");
                assert!((found.acceleration - expected.acceleration).abs() < 1e-12, "{t}");
            }
        }
    }

    const TIMES: [f64; 5] = [0.5, 0.8, 1.0, 1.7, 2.0];
    const POINTS: [f64; 5] = [0.01, -0.02, 0.03, 0.0, 0.005];

    #[test]
    fn it_meets_its_points_and_rests_before_and_after() {
        let spline = spline(&TIMES, &POINTS);
        for (t, b) in TIMES.into_iter().zip(POINTS) {
            assert!((spline.at(t).displacement - b).abs() < 1e-16);
        }
        for (t, b) in [(0.0, 0.01), (0.4999, 0.01), (2.0001, 0.005), (9.0, 0.005)] {
            let rest = Prescribed { displacement: b, velocity: 0.0, acceleration: 0.0 };
            assert_eq!(spline.at(t), rest);
        }
        assert_eq!(spline.at(0.5).velocity, 0.0);
        assert!(spline.at(2.0).velocity.abs() < 1e-14);
    }

    /// b, b' and b'' do not jump at inner points: over 2 h they change by 2 h times their slopes, which
    /// are below 1, 10 and 100 here. And b', b'' are the slopes of b, b', by central
    /// differences, which are off by h^2/6 times the third derivative, and by round-off over h.
    #[test]
    fn it_is_twice_continuously_differentiable() {
        let (spline, h) = (spline(&TIMES, &POINTS), 1e-5);
        for t in &TIMES[1..4] {
            let (before, after) = (spline.at(t - h), spline.at(t + h));
            assert!((before.displacement - after.displacement).abs() < 2.0 * h);
            assert!((before.velocity - after.velocity).abs() < 20.0 * h);
            assert!((before.acceleration - after.acceleration).abs() < 200.0 * h);
        }
        for k in 0..149 {
            let t = 0.505 + 0.01 * f64::from(k);
            let (before, at, after) = (spline.at(t - h), spline.at(t), spline.at(t + h));
            let slope = (after.displacement - before.displacement) / (2.0 * h);
            assert!((slope - at.velocity).abs() < 1e-8, "{t}: {slope} {}", at.velocity);
            let slope = (after.velocity - before.velocity) / (2.0 * h);
            assert!((slope - at.acceleration).abs() < 1e-8, "{t}: {slope} {}", at.acceleration);
        }
    }
}
