//! The inside of a step: the scheme and its local error.

use super::CentralDifference;
use crate::ode::{Failure, Kick, SecondOrder};

impl<S: SecondOrder> CentralDifference<S> {
    /// Computes the state at `next`, `h` later, into `y_before`, and returns the norm of its local error.
    pub(super) fn try_step(&mut self, next: f64, h: f64) -> Result<f64, Failure> {
        let Self { system, middle, extrapolated, work, trial_powers, .. } = self;
        let (u, rest) = self.y.split_at(self.n);
        let (v, integrals) = rest.split_at(self.n);
        let (u_next, rest) = self.y_before.split_at_mut(self.n);
        let (v_next, integrals_next) = rest.split_at_mut(self.n);
        work.fill(0.0);

        let half = 0.5 * h;
        let is_coupled = system.aim_at_mean_rates(self.t, h)?;
        let kick = Kick { duration: half, force: &self.force, before: v };
        // else those at the end of the step before
        if self.step_before.is_none() || is_coupled {
            system.accelerations(&kick, &mut self.first);
        }
        let outputs = u_next.iter_mut().zip(&mut *middle).zip(&mut *extrapolated);
        for (((u_next, w), extrapolated), ((u, v), a)) in
            outputs.zip(u.iter().zip(v).zip(&self.first))
        {
            *w = v + half * a;
            *u_next = u + h * *w;
            *extrapolated = 2.0 * *w - v;
        }
        system.lead(&kick, middle, work);

        system.prescribe(next, u_next, extrapolated)?;
        self.statistics.evaluations += 1;
        system.forces(next, u_next, extrapolated, &mut self.trial_force)?;
        let kick = Kick { duration: half, force: &self.trial_force, before: middle };
        system.accelerations(&kick, &mut self.second);
        let velocities = middle.iter().zip(&self.second);
        v_next.iter_mut().zip(velocities).for_each(|(v_next, (w, a))| *v_next = w + half * a);
        system.lead(&kick, v_next, work);

        system.powers(v_next, trial_powers);
        for (k, integral) in integrals_next.iter_mut().enumerate() {
            *integral = integrals[k] + 0.5 * h * (self.powers[k] + trial_powers[k]) + work[k];
        }
        Ok(self.error_norm(h))
    }

    /// Root mean square, weighted by the tolerances, of the local errors
    ///
    /// ```text
    /// h^3 u'''/6 = h^2 (a_(n+1) - a_n)/6,    h^3 v'''/12 = h (a_(n+1) - 2 a_n + a_(n-1))/12
    /// ```
    fn error_norm(&self, h: f64) -> f64 {
        // differences of steps of different size; without a step before the first one will do
        let (ratio, scale) = match self.step_before {
            Some(before) => (h / before, 2.0 * h / (before + h)),
            None => (0.0, 1.0),
        };
        let [position, velocity] = self.squares(ratio);
        let (position, velocity) =
            (h * h / 6.0 * position.sqrt(), scale * h / 12.0 * velocity.sqrt());
        position.hypot(velocity) / (self.weights.len() as f64).sqrt()
    }

    /// Sums of the squares of the weighted differences in [`error_norm`](Self::error_norm).
    fn squares(&self, ratio: f64) -> [f64; 2] {
        let (position_weights, velocity_weights) = self.weights.split_at(self.first.len());
        let part = |first: f64, second: f64, earlier: f64, weights: [f64; 2]| {
            let ahead = second - first;
            let bend = ahead - ratio * (first - earlier);
            [(ahead * weights[0]).powi(2), (bend * weights[1]).powi(2)]
        };
        // in interleaved sums, for speed
        let (first, first_rest) = self.first.as_chunks::<4>();
        let (second, second_rest) = self.second.as_chunks::<4>();
        let (earlier, earlier_rest) = self.earlier.as_chunks::<4>();
        let (position, position_rest) = position_weights.as_chunks::<4>();
        let (velocity, velocity_rest) = velocity_weights.as_chunks::<4>();
        let mut sums = [[0.0; 4]; 2];
        for ((((f, s), e), p), v) in
            first.iter().zip(second).zip(earlier).zip(position).zip(velocity)
        {
            for k in 0..4 {
                let [position, velocity] = part(f[k], s[k], e[k], [p[k], v[k]]);
                sums[0][k] += position;
                sums[1][k] += velocity;
            }
        }
        let mut squares = sums.map(|sum| sum.iter().sum());
        let rest = first_rest.iter().zip(second_rest).zip(earlier_rest);
        for (((f, s), e), (p, v)) in rest.zip(position_rest.iter().zip(velocity_rest)) {
            let [position, velocity] = part(*f, *s, *e, [*p, *v]);
            squares[0] += position;
            squares[1] += velocity;
        }
        squares
    }
}
