//! Two of the stiff problems of `pliant::samples`, written over a number type.

use pliant::automatic::{Number, RightHandSide};
use pliant::ode::Failure;

/// HIRES, as `pliant::samples::Hires` has it with a Jacobian by hand.
pub struct Plant;

impl RightHandSide for Plant {
    fn rhs<T: Number>(
        &mut self,
        _t: f64,
        y: &[T],
        _p: &[T],
        ydot: &mut [T],
    ) -> Result<(), Failure> {
        let exchange = y[5] * y[7] * 280.0;
        ydot[0] = y[0] * -1.71 + y[1] * 0.43 + y[2] * 8.32 + 0.0007;
        ydot[1] = y[0] * 1.71 - y[1] * 8.75;
        ydot[2] = y[2] * -10.03 + y[3] * 0.43 + y[4] * 0.035;
        ydot[3] = y[1] * 8.32 + y[2] * 1.71 - y[3] * 1.12;
        ydot[4] = y[4] * -1.745 + (y[5] + y[6]) * 0.43;
        ydot[5] = -exchange + y[3] * 0.69 + y[4] * 1.71 - y[5] * 0.43 + y[6] * 0.69;
        ydot[6] = exchange - y[6] * 1.81;
        ydot[7] = -ydot[6];
        Ok(())
    }
}

/// The Brusselator at so many points, as `pliant::samples::Brusselator` has it.
pub struct Line(pub usize);

impl RightHandSide for Line {
    fn rhs<T: Number>(
        &mut self,
        _t: f64,
        y: &[T],
        _p: &[T],
        ydot: &mut [T],
    ) -> Result<(), Failure> {
        let (n, end) = (self.0, (T::from(1.0), T::from(3.0)));
        let c = ((n + 1) * (n + 1)) as f64 / 50.0;
        for i in 0..n {
            let (u, v) = (y[2 * i], y[2 * i + 1]);
            let (left_u, left_v) = if i > 0 { (y[2 * i - 2], y[2 * i - 1]) } else { end };
            let (right_u, right_v) = if i + 1 < n { (y[2 * i + 2], y[2 * i + 3]) } else { end };
            let made = u * u * v;
            ydot[2 * i] = made - u * 4.0 + (left_u - u * 2.0 + right_u) * c + 1.0;
            ydot[2 * i + 1] = u * 3.0 - made + (left_v - v * 2.0 + right_v) * c;
        }
        Ok(())
    }
}
