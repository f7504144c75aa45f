//! Fluid action at a point of a face: the traction of drag, and the pressure by depth.

use crate::base::vector::{dot, norm};

/// A 3 x 3 matrix, row by row.
pub(super) type Matrix = [[f64; 3]; 3];

/// Drag by squares of velocities.
pub(crate) struct Drag {
    /// rho C_n/2 and rho C_t/2 (kg/m^3)
    factors: [f64; 2],
}

/// A velocity relative to a face with the normal n J of the area J per reference area.
struct Split {
    area: f64,
    normal: [f64; 3],
    /// The part along n, and the one along the face, with its length.
    across: f64,
    along: [f64; 3],
    speed: f64,
}

impl Split {
    /// `None` for a face without area.
    fn of(velocity: &[f64; 3], facing: &[f64; 3]) -> Option<Self> {
        let area = norm(facing);
        if area == 0.0 {
            return None;
        }
        let normal = facing.map(|n| n / area);
        let across = dot(velocity, &normal);
        let along = std::array::from_fn(|i| velocity[i] - across * normal[i]);
        Some(Self { area, normal, across, along, speed: norm(&along) })
    }
}

impl Drag {
    /// `None` without drag.
    pub(super) fn new(density: f64, coefficients: [f64; 2]) -> Option<Self> {
        let is_there = coefficients.iter().any(|coefficient| *coefficient > 0.0);
        is_there.then(|| Self { factors: coefficients.map(|c| 0.5 * density * c) })
    }

    /// The traction times the area, T = -a |w_n| w_n n J - b |w_t| w_t J, at the `velocity` w relative to the fluid (m/s), on a
    /// face with n J = `facing`.
    pub(super) fn traction(&self, velocity: &[f64; 3], facing: &[f64; 3]) -> [f64; 3] {
        let Some(Split { area, normal, across, along, speed }) = Split::of(velocity, facing) else {
            return [0.0; 3];
        };
        let [a, b] = self.factors;
        std::array::from_fn(|i| {
            -area * (a * across.abs() * across * normal[i] + b * speed * along[i])
        })
    }

    /// -dT/d(n J) and -dT/dw. With P = I - n n^T
    ///
    /// ```text
    /// -dT/d(n J) = a (2 |w_n| n w_t^T + |w_n| w_n I) + b (|w_t| (w_t n^T - n w_t^T) - w_n (|w_t| P + w_t w_t^T/|w_t|))
    /// -dT/dw     = J (2 a |w_n| n n^T + b (|w_t| P + w_t w_t^T/|w_t|))
    /// ```
    pub(super) fn derivatives(&self, velocity: &[f64; 3], facing: &[f64; 3]) -> [Matrix; 2] {
        let Some(Split { area, normal: n, across, along, speed }) = Split::of(velocity, facing)
        else {
            return [[[0.0; 3]; 3]; 2];
        };
        let [a, b] = self.factors;
        let unit = |i: usize, j: usize| f64::from(i == j);
        // |w_t| w_t has the slope 0 at w_t = 0
        let skin = |i: usize, j: usize| match speed == 0.0 {
            true => 0.0,
            false => speed * (unit(i, j) - n[i] * n[j]) + along[i] * along[j] / speed,
        };
        let matrix = |entry: &dyn Fn(usize, usize) -> f64| -> Matrix {
            std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
        };
        let by_facing = |i: usize, j: usize| {
            a * across.abs() * (2.0 * n[i] * along[j] + across * unit(i, j))
                + b * (speed * (along[i] * n[j] - n[i] * along[j]) - across * skin(i, j))
        };
        let by_velocity =
            |i: usize, j: usize| area * (2.0 * a * across.abs() * n[i] * n[j] + b * skin(i, j));
        [matrix(&by_facing), matrix(&by_velocity)]
    }
}

/// Pressure by depth.
pub(crate) struct Depth {
    /// rho g (N/m^3)
    pub(super) weight: f64,
    /// Height of the surface above the origin (m), against gravity.
    pub(super) level: f64,
    /// The direction of gravity.
    pub(super) down: [f64; 3],
}

impl Depth {
    /// The depth (m) of a point x (m); 0 above the surface.
    pub(super) fn at(&self, x: &[f64; 3]) -> f64 {
        (self.level + dot(&self.down, x)).max(0.0)
    }
}
