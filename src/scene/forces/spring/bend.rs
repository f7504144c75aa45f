//! Angle of the path of a cable at a point, on which its friction there depends.

use crate::base::vector::{dot, norm};

/// Below this angle (rad) a bend is smoothed: its angle would have a kink where the cable is straight.
const STRAIGHT: f64 = 1e-3;

/// Angle of the path from one line to the next.
pub(super) struct Bend {
    /// theta^2/(theta^2 + s^2)^(1/2), with the angle theta and the angle s of what counts as straight.
    pub(super) angle: f64,
    /// Its derivatives by the vectors along the two lines.
    by_lines: [[f64; 3]; 2],
}

impl Bend {
    /// Between two lines with these unit vectors `a` and `b` along them, and these `lengths` (m).
    pub(super) fn new([a, b]: [&[f64; 3]; 2], lengths: [f64; 2]) -> Self {
        let [sum, difference] =
            [1.0, -1.0].map(|sign| norm(&std::array::from_fn::<f64, 3, _>(|i| a[i] + sign * b[i])));
        let theta = 2.0 * difference.atan2(sum);
        let smooth = theta.hypot(STRAIGHT);
        // d theta = -d(a.b)/sin(theta)
        let ratio = if theta < 1e-6 { 1.0 } else { theta / theta.sin() };
        let slope = -ratio * (theta * theta + 2.0 * STRAIGHT * STRAIGHT) / smooth.powi(3);
        let cosine = dot(a, b);
        let by_lines = [
            std::array::from_fn(|i| slope * (b[i] - cosine * a[i]) / lengths[0]),
            std::array::from_fn(|i| slope * (a[i] - cosine * b[i]) / lengths[1]),
        ];
        Self { angle: theta * theta / smooth, by_lines }
    }

    /// Its derivative by the place `q`, where it is at the place `k` between the lines.
    pub(super) fn by_place(&self, k: usize, q: usize) -> [f64; 3] {
        let [a, b] = &self.by_lines;
        match q {
            _ if q + 1 == k => a.map(|x| -x),
            _ if q == k => std::array::from_fn(|i| a[i] - b[i]),
            _ if q == k + 1 => *b,
            _ => [0.0; 3],
        }
    }
}
