//! The car axis: a multibody system of index 3, with its index reduced.

use super::{QUADRUPLE, Reference};
use crate::integrators::ode::{Dae, Failure};

/// A car axis (CARAXIS) on a bumpy road: two points with mass, (xl, yl) and (xr, yr), on stiff springs from
/// the wheels; they keep their distance, and the left one keeps at right angles to the road. The unknowns are
/// the four coordinates, their velocities and the two multipliers.
///
/// The constraints g(t, p) = 0 make it a DAE of index 3; here of index 1, by g'' + 2 alpha g' + alpha^2 g
/// = 0. The exact solution is the same for each alpha. Without it (0) the errors of g grow.
///
/// S. Schneider, "Intégration de systèmes d'équations différentielles raides et différentielles-algébriques
/// par des méthodes de collocations et méthodes générales linéaires", thesis, Geneva (1994); in the test set
/// of Bari for IVP solvers.
#[derive(Clone, Copy, Debug, Default)]
pub struct CarAxis {
    /// Rate at which errors of the constraints decay.
    pub alpha: f64,
}

/// Length of the axis, and that of the springs.
const LENGTH: f64 = 1.0;
const SPRING_LENGTH: f64 = 0.5;
/// M eps^2 / 2 with M = 10 and eps = 0.01, which multiplies the accelerations.
const MASS: f64 = 5e-4;
const GRAVITY: f64 = 1.0;
/// Height of the bumps, and the angular frequency at which they are met.
const BUMP: f64 = 0.1;
const OMEGA: f64 = 10.0;

/// The right wheel; the left one is at the origin.
struct Wheel {
    place: [f64; 2],
    velocity: [f64; 2],
    acceleration: [f64; 2],
}

impl Wheel {
    /// It goes up and down by a sine, at a constant distance from the left one.
    fn at(t: f64) -> Self {
        let (sin, cos) = (OMEGA * t).sin_cos();
        let (y, vy, ay) = (BUMP * sin, BUMP * OMEGA * cos, -BUMP * OMEGA * OMEGA * sin);
        let x = (LENGTH * LENGTH - y * y).sqrt();
        let vx = -y * vy / x;
        let ax = -(vx * vx + vy * vy + y * ay) / x;
        Self { place: [x, y], velocity: [vx, vy], acceleration: [ax, ay] }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Force of a spring on one of its ends, which is `away` from the other.
fn pull(away: [f64; 2]) -> [f64; 2] {
    let length = away[0].hypot(away[1]);
    away.map(|a| (SPRING_LENGTH - length) * a / length)
}

impl CarAxis {
    /// Initial state at t = 0.
    pub const Y0: [f64; 10] = [0.0, 0.5, 1.0, 0.5, -0.5, 0.0, -0.5, 0.0, 0.0, 0.0];

    /// Its time derivative.
    pub const YP0: [f64; 10] = [-0.5, 0.0, -0.5, 0.0, 0.0, -1.0, 0.0, -1.0, 0.0515, 0.012_875];

    /// Which unknowns are differential.
    pub const DIFFERENTIAL: [bool; 10] =
        [true, true, true, true, true, true, true, true, false, false];

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 3.0,
        y: &[
            4.934_557_842_752_409e-2,
            4.969_894_602_300_081e-1,
            1.041_742_524_885_426,
            3.739_110_272_653_658e-1,
            -7.705_836_840_359_208e-2,
            7.446_866_592_068_416e-3,
            1.755_681_575_354_173_7e-2,
            7.703_410_437_796_011e-1,
            -4.736_886_590_853_327e-3,
            -1.104_680_331_259_266e-3,
        ],
        digits: 15,
        source: QUADRUPLE,
    };

    /// The errors g(t, p) of the constraints at time t.
    #[must_use]
    pub fn constraints(t: f64, y: &[f64]) -> [f64; 2] {
        let (left, axis) = ([y[0], y[1]], [y[0] - y[2], y[1] - y[3]]);
        [dot(Wheel::at(t).place, left), dot(axis, axis) - LENGTH * LENGTH]
    }
}

impl Dae for CarAxis {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        let &[xl, yl, xr, yr, vxl, vyl, vxr, vyr, square, rigid] = y else {
            unreachable!("ten unknowns")
        };
        let wheel = Wheel::at(t);
        let (left, left_velocity) = ([xl, yl], [vxl, vyl]);
        let (axis, axis_velocity) = ([xl - xr, yl - yr], [vxl - vxr, vyl - vyr]);

        let pulls = [pull(left), pull(difference([xr, yr], wheel.place))];
        let mut accelerations = [[0.0, -GRAVITY]; 2];
        for i in 0..2 {
            let along = 2.0 * rigid * axis[i];
            accelerations[0][i] += (pulls[0][i] + square * wheel.place[i] + along) / MASS;
            accelerations[1][i] += (pulls[1][i] - along) / MASS;
        }
        for i in 0..4 {
            residual[i] = yp[i] - y[4 + i];
            residual[4 + i] = yp[4 + i] - accelerations[i / 2][i % 2];
        }

        let g = Self::constraints(t, y);
        let g_rate = [
            dot(wheel.velocity, left) + dot(wheel.place, left_velocity),
            2.0 * dot(axis, axis_velocity),
        ];
        let g_acceleration = [
            dot(wheel.acceleration, left)
                + 2.0 * dot(wheel.velocity, left_velocity)
                + dot(wheel.place, accelerations[0]),
            2.0 * (dot(axis_velocity, axis_velocity)
                + dot(axis, difference(accelerations[0], accelerations[1]))),
        ];
        for i in 0..2 {
            residual[8 + i] =
                g_acceleration[i] + 2.0 * self.alpha * g_rate[i] + self.alpha * self.alpha * g[i];
        }
        Ok(())
    }
}
