//! Arguments and values of equations, with their slopes.

use super::dual::Dual;
use crate::integrators::ode::Failure;

/// Directions along which one evaluation differentiates: with more, those that a Jacobian of few columns or colours does not need cost more
/// than an evaluation less saves.
pub(super) const LANES: usize = 4;

/// Unknowns, their derivatives, which an ODE does not have, parameters and the equations, with their slopes.
#[derive(Default)]
pub(super) struct Workspace<const N: usize> {
    pub(super) y: Vec<Dual<N>>,
    pub(super) yp: Vec<Dual<N>>,
    pub(super) p: Vec<Dual<N>>,
    pub(super) f: Vec<Dual<N>>,
}

/// Evaluates equations at the numbers of a workspace.
pub(super) type Evaluate<E, const N: usize> =
    fn(&mut E, f64, &mut Workspace<N>) -> Result<(), Failure>;

/// Point of differentiation: time, unknowns, and their derivatives, which are empty for an ODE.
pub(super) type Point<'a> = (f64, &'a [f64], &'a [f64]);

impl<const N: usize> Workspace<N> {
    /// Takes arguments without slopes.
    pub(super) fn start(&mut self, (_, y, yp): Point<'_>, p: &[f64]) {
        let numbers = |values: &[f64], out: &mut Vec<Dual<N>>| {
            out.clear();
            out.extend(values.iter().map(|&value| Dual::from(value)));
        };
        numbers(y, &mut self.y);
        numbers(yp, &mut self.yp);
        numbers(p, &mut self.p);
        self.f.resize(y.len(), Dual::from(0.0));
    }

    pub(super) fn evaluate<E>(
        &mut self,
        equations: &mut E,
        t: f64,
        evaluate: Evaluate<E, N>,
    ) -> Result<(), Failure> {
        self.f.fill(Dual::from(0.0));
        evaluate(equations, t, self)
    }

    /// Sets the slopes of unknown `j` and of its derivative along a direction.
    pub(super) fn seed(&mut self, j: usize, lane: usize, [by_y, by_yp]: [f64; 2]) {
        self.y[j].slopes[lane] = by_y;
        if let Some(yp) = self.yp.get_mut(j) {
            yp.slopes[lane] = by_yp;
        }
    }
}
