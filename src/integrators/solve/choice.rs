//! Comparison of the methods of [`Method::Auto`](super::Method::Auto) by their advance per work.
//!
//! Work is counted, never measured: each step of a method has a cost in numbers of operations, a function of the number of unknowns and of
//! the stored entries of the Jacobian, which fits times of the standard problems (`docs/notes/automatic-choices.md`).

use crate::integrators::sundials::LinearSolver;

/// The methods that are chosen from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Candidate {
    Explicit,
    Rosenbrock,
    Bdf,
}

/// Costs of one step of each method, in some operations per nanosecond, and the implicit method that is tried where the explicit one
/// may be limited by stability.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs {
    explicit: f64,
    rosenbrock: f64,
    bdf: f64,
    pub(super) implicit: Candidate,
    /// Whether the Rosenbrock method has the linear solver.
    pub(super) has_rosenbrock: bool,
}

/// Steps after which a trial is judged, by the mean of the last ones. BDF starts with short steps of order 1.
const TRIAL: u64 = 10;
const TRIAL_OF_BDF: u64 = 50;
/// Steps that are left for a limited explicit method, in work of a trial, above which one is made.
const WORTH_TRIAL: f64 = 3.0;

impl Costs {
    /// Those of `n` unknowns, with a linear solver that is given or dense.
    pub(super) fn new(n: usize, solver: Option<&LinearSolver>, rtol: f64) -> Self {
        let n = n as f64;
        let entries = match solver {
            Some(LinearSolver::Band { lower, upper, .. }) => Some((2 * lower + upper + 1) as f64),
            Some(LinearSolver::Klu { pattern, .. }) => Some(pattern.entry_count() as f64 / n),
            // products with the Jacobian in place of entries, or who knows what
            Some(LinearSolver::Krylov(_) | LinearSolver::Custom) => Some(50.0),
            _ => None,
        };
        let (rosenbrock, bdf) = match entries {
            None => {
                let factors = n.powi(3);
                (n * (230.0 + 35.0 * n) + factors / 6.0, n * (120.0 + 4.0 * n) + factors / 20.0)
            }
            Some(entries) => (n * (250.0 + 70.0 * entries), n * (120.0 + 4.0 * entries)),
        };
        // an evaluation, of which nothing is known but its number of unknowns; an iteration of BDF takes one
        let evaluation = 300.0 + 20.0 * n;
        let explicit = 900.0 + 70.0 * n + 6.0 * evaluation;
        let rosenbrock = 2700.0 + rosenbrock + 7.0 * evaluation;
        let bdf = 3600.0 + bdf + 1.4 * evaluation;
        // it takes no Krylov method, and nobody knows what factors of one's own cost, which it makes in each step
        let has_rosenbrock =
            !matches!(solver, Some(LinearSolver::Krylov(_) | LinearSolver::Custom));
        let implicit = match has_rosenbrock && rosenbrock < steps_of_bdf(rtol) * bdf {
            true => Candidate::Rosenbrock,
            false => Candidate::Bdf,
        };
        Self { explicit, rosenbrock, bdf, implicit, has_rosenbrock }
    }

    /// The cost of a step.
    fn of(&self, candidate: Candidate) -> f64 {
        match candidate {
            Candidate::Explicit => self.explicit,
            Candidate::Rosenbrock => self.rosenbrock,
            Candidate::Bdf => self.bdf,
        }
    }

    /// Whether steps of the implicit method cost no more than explicit ones, so that a run may as well begin with it.
    pub(super) fn may_begin_implicit(&self) -> bool {
        self.of(self.implicit) <= self.explicit
    }

    /// The steps of a trial of this method.
    pub(super) fn trial(candidate: Candidate) -> u64 {
        if candidate == Candidate::Bdf { TRIAL_OF_BDF } else { TRIAL }
    }

    /// Whether a trial of the implicit method is worth its work, where stability may limit the explicit one: after so many `steps` since the
    /// last one, with `left` of them left, and so many trials that were `lost` before.
    pub(super) fn tries_implicit(&self, steps: f64, left: f64, lost: i32) -> bool {
        let trial = Self::trial(self.implicit) as f64 * self.of(self.implicit);
        let times = 2_f64.powi(lost);
        left * self.explicit > WORTH_TRIAL * times * trial
            && steps * self.explicit >= (times - 1.0) * trial
    }

    /// Whether steps of mean size `h` of one method lead farther for their work than those of another.
    pub(super) fn is_better(
        &self,
        (one, h): (Candidate, f64),
        (other, h_other): (Candidate, f64),
    ) -> bool {
        h * self.of(other) > h_other * self.of(one)
    }
}

/// How many steps BDF takes for one of the Rosenbrock method of order 4: on HIRES, Robertson's, van der Pol's and the pollution problem,
/// the Oregonator and the Brusselator 1.8 to 5.3 at 1e-3, 1.7 to 3.5 at 1e-5, 1.2 to 2.2 at 1e-7, 0.7 to 1.4 at 1e-9, at larger errors.
fn steps_of_bdf(rtol: f64) -> f64 {
    let decades = (-3.0 - rtol.log10()).max(0.0);
    let exponent =
        if decades < 2.0 { 0.58 - 0.045 * decades } else { 0.49 - 0.107 * (decades - 2.0) };
    10_f64.powf(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::sundials::{Jacobian, Pattern};

    fn implicit(n: usize, solver: Option<&LinearSolver>, rtol: f64) -> Candidate {
        Costs::new(n, solver, rtol).implicit
    }

    /// The faster of the two in processor time: HIRES (8 unknowns), pollution (20), the Brusselator (1000, sparse).
    #[test]
    fn the_implicit_method_is_that_of_measurements() {
        use Candidate::{Bdf, Rosenbrock};
        let jacobian = Jacobian::Supplied;
        for (rtol, expected) in [(1e-3, Rosenbrock), (1e-5, Rosenbrock), (1e-9, Bdf), (0.0, Bdf)] {
            assert_eq!(implicit(8, None, rtol), expected, "{rtol:e}");
        }
        for (rtol, expected) in [(1e-3, Rosenbrock), (1e-7, Bdf), (1e-9, Bdf)] {
            assert_eq!(implicit(20, None, rtol), expected, "{rtol:e}");
        }
        let band = Pattern::band(1000, 3, 3).unwrap();
        let klu = LinearSolver::Klu { pattern: band, jacobian };
        for rtol in [1e-3, 1e-5, 1e-7] {
            assert_eq!(implicit(1000, Some(&klu), rtol), Bdf, "{rtol:e}");
        }
        assert_eq!(implicit(2, Some(&LinearSolver::Custom), 1e-3), Bdf);
    }

    /// Those of many unknowns, few of which occur in each equation; not of few, nor where all depend on all.
    #[test]
    fn implicit_steps_that_cost_no_more_may_be_the_first() {
        let begins = |n: usize, solver: Option<&LinearSolver>| {
            Costs::new(n, solver, 1e-5).may_begin_implicit()
        };
        let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::Supplied };
        assert!([8, 40, 1000].iter().all(|&n| !begins(n, None)));
        assert!(begins(1000, Some(&band)) && !begins(20, Some(&band)));
    }

    /// Few limited steps that are left are made; more of them ask for a trial, and after a lost one for twice as many.
    #[test]
    fn trials_have_to_pay() {
        let costs = Costs::new(8, None, 1e-5);
        let trial = Costs::trial(costs.implicit);
        let least = WORTH_TRIAL * trial as f64 * costs.rosenbrock / costs.explicit;
        assert!(!costs.tries_implicit(20.0, 0.9 * least, 0));
        assert!(costs.tries_implicit(20.0, 1.1 * least, 0));
        assert!(!costs.tries_implicit(1e9, 1.1 * least, 1));
        assert!(costs.tries_implicit(1e9, 2.2 * least, 1));
        // nor are there more trials than steps in between
        assert!(!costs.tries_implicit(20.0, 1e9, 3));
    }
}
