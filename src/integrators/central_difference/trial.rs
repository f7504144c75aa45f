//! The inside of a step: the scheme and its local error.
//!
//! Apart from the forces and the product with M^-1, a step is two passes over the vectors, each a formula of
//! `base/simd`: from the state to where forces are evaluated, and from accelerations to the new velocities
//! and the sums of the error norm.

use super::CentralDifference;
use crate::base::simd::{Formula, each};
use crate::base::tensor::Real;
use crate::integrators::ode::{Failure, Kick, SecondOrder, call};

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
        let departure = if self.is_curved { &mut self.departure } else { &mut self.first };
        // otherwise `first` holds those at the end of the step before
        if self.step_before.is_none() || is_coupled || self.is_curved {
            if self.is_curved {
                system.depart(h, u);
            }
            call::accelerations(system, &kick, departure);
        }
        each(Drift { h }, [u, v, departure], [middle, u_next, extrapolated]);
        system.lead(&kick, middle, work);

        system.prescribe(next, u_next, extrapolated)?;
        self.statistics.evaluations += 1;
        call::forces(system, next, u_next, extrapolated, &mut self.trial_force)?;
        let kick = Kick { duration: half, force: &self.trial_force, before: middle };
        call::accelerations(system, &kick, &mut self.second);
        // differences over steps of different size; without a step before, the first difference is used
        let (ratio, scale) = match self.step_before {
            Some(before) => (h / before, 2.0 * h / (before + h)),
            None => (0.0, 1.0),
        };
        let (position_weights, velocity_weights) = self.weights.split_at(self.n);
        let [earlier, first] = match self.is_curved {
            false => [&self.earlier, &self.first],
            // each step by its own two kicks: multipliers are those of times within it
            true => {
                let last = self.first.iter().zip(&self.earlier);
                let all = extrapolated.iter_mut().zip(&self.departure).zip(last);
                all.for_each(|((out, a), (end, begin))| *out = a - (end - begin));
                [&*extrapolated, &self.departure]
            }
        };
        let [position, velocity] = each(
            Arrive { half, ratio },
            [middle, earlier, first, &self.second, position_weights, velocity_weights],
            [v_next],
        );
        system.lead(&kick, v_next, work);

        call::powers(system, v_next, trial_powers);
        for (k, integral) in integrals_next.iter_mut().enumerate() {
            *integral = integrals[k] + 0.5 * h * (self.powers[k] + trial_powers[k]) + work[k];
        }
        let (position, velocity) =
            (h * h / 6.0 * position.sqrt(), scale * h / 12.0 * velocity.sqrt());
        Ok(position.hypot(velocity) / (self.weights.len() as f64).sqrt())
    }
}

/// From u, v and a at the beginning of a step to velocities w in its middle, u at its end, and velocities
/// extrapolated to there.
struct Drift {
    h: f64,
}

impl Formula<3, 3, 0> for Drift {
    #[inline(always)]
    fn at<T: Real>(&self, [u, v, a]: [T; 3], _: [T; 3]) -> ([T; 3], [T; 0]) {
        let w = v + a * (0.5 * self.h);
        ([w, u + w * self.h, w * 2.0 - v], [])
    }
}

/// From velocities w in the middle of a step to those at its end, and the sums of the squares of the local
/// errors
///
/// ```text
/// h^3 u'''/6 = h^2 (a_(n+1) - a_n)/6,    h^3 v'''/12 = h (a_(n+1) - 2 a_n + a_(n-1))/12
/// ```
///
/// without the factors of h, weighted by the tolerances.
struct Arrive {
    half: f64,
    /// Ratio of the size of the step to that of the one before.
    ratio: f64,
}

impl Formula<6, 1, 2> for Arrive {
    #[inline(always)]
    fn at<T: Real>(
        &self,
        [w, earlier, first, second, position_weight, velocity_weight]: [T; 6],
        _: [T; 1],
    ) -> ([T; 1], [T; 2]) {
        let ahead = second - first;
        let bend = ahead - (first - earlier) * self.ratio;
        let (position, velocity) = (ahead * position_weight, bend * velocity_weight);
        ([w + second * self.half], [position * position, velocity * velocity])
    }
}
