//! A lightly damped oscillation, for which BDF of higher order is unstable.

use faer::MatMut;

use crate::integrators::ode::{Failure, Ode};

/// y'' + d y' + y = 0 for (y, y'), released at rest from y = 1.
#[derive(Clone, Copy, Debug)]
pub struct DampedOscillator {
    /// d, twice the damping ratio; below 2 it oscillates.
    pub damping: f64,
}

impl DampedOscillator {
    /// Initial state at t = 0.
    pub const Y0: [f64; 2] = [1.0, 0.0];

    /// The state at time `t`, by its closed form for a damping below 2.
    #[must_use]
    pub fn state(&self, t: f64) -> [f64; 2] {
        let rate = 0.5 * self.damping;
        let frequency = (1.0 - rate * rate).sqrt();
        let (sin, cos) = (frequency * t).sin_cos();
        let amplitude = (-rate * t).exp();
        [amplitude * (cos + rate / frequency * sin), -amplitude / frequency * sin]
    }
}

impl Ode for DampedOscillator {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = y[1];
        ydot[1] = -y[0] - self.damping * y[1];
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        jacobian[(0, 1)] = 1.0;
        jacobian[(1, 0)] = -1.0;
        jacobian[(1, 1)] = -self.damping;
        Ok(())
    }
}
