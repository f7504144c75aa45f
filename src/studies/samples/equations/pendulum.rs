//! A pendulum in closed form.

use crate::integrators::ode::{Dae, Failure, Ode};

/// A pendulum of unit length in Cartesian coordinates, released from the horizontal, with gravity
/// such that its period is exactly 2: at t = 2, 4, 6, ... it is back at the start.
///
/// As an ODE for (x, y, vx, vy), with the string tension solved for; as a DAE of index 1 with the
/// tension as fifth unknown. Neither enforces the length, so its drift shows the error.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pendulum;

impl Pendulum {
    /// Initial state at t = 0 of the ODE. The DAE starts with [`Self::DAE_Y0`].
    pub const Y0: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

    /// Initial state of the DAE.
    pub const DAE_Y0: [f64; 5] = [1.0, 0.0, 0.0, 0.0, 0.0];

    /// Its time derivative. (The tension grows by 3 g |vy|, from rest.)
    pub const DAE_YP0: [f64; 5] = [0.0, 0.0, 0.0, -Self::GRAVITY, 0.0];

    /// Which unknowns of the DAE are differential.
    pub const DIFFERENTIAL: [bool; 5] = [true, true, true, true, false];

    /// The period, exactly.
    pub const PERIOD: f64 = 2.0;

    /// Gravity: 4 K(1/sqrt 2)^2 with the complete elliptic integral K, which is
    /// Gamma(1/4)^4 / (4 pi).
    pub const GRAVITY: f64 = 13.750_371_636_040_746;
}

impl Ode for Pendulum {
    fn rhs(&mut self, _t: f64, s: &[f64], sdot: &mut [f64]) -> Result<(), Failure> {
        let &[x, y, vx, vy] = s else { unreachable!("four unknowns") };
        let tension = (vx * vx + vy * vy - Self::GRAVITY * y) / (x * x + y * y);
        sdot.copy_from_slice(&[vx, vy, -tension * x, -tension * y - Self::GRAVITY]);
        Ok(())
    }

    /// Projects onto the circle, with a velocity along it.
    fn project(
        &mut self,
        _t: f64,
        s: &[f64],
        correction: &mut [f64],
        error: &mut [f64],
    ) -> Result<(), Failure> {
        let &[x, y, vx, vy] = s else { unreachable!("four unknowns") };
        let length = x.hypot(y);
        let (nx, ny) = (x / length, y / length);
        let away = vx * nx + vy * ny;
        correction.copy_from_slice(&[nx - x, ny - y, -away * nx, -away * ny]);
        for error in error.chunks_exact_mut(2) {
            let away = error[0] * nx + error[1] * ny;
            (error[0], error[1]) = (error[0] - away * nx, error[1] - away * ny);
        }
        Ok(())
    }
}

impl Dae for Pendulum {
    fn residual(
        &mut self,
        _t: f64,
        s: &[f64],
        sp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        let &[x, y, vx, vy, tension] = s else { unreachable!("five unknowns") };
        residual[0] = sp[0] - vx;
        residual[1] = sp[1] - vy;
        residual[2] = sp[2] + tension * x;
        residual[3] = sp[3] + tension * y + Self::GRAVITY;
        residual[4] = vx * vx + vy * vy - Self::GRAVITY * y - tension * (x * x + y * y);
        Ok(())
    }
}
