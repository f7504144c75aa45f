//! Methods that take far more steps than expected: another one is tried in their place, and kept if it advances farther for
//! the same cost.
//!
//! The cause of the short steps does not matter. A known one of BDF are undamped vibrations: they
//! lie outside of the stability regions of its orders above 2 (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
//! II*, section V.2), which bounds its steps by the fastest of them, however small they are.
//!
//! Where bodies touch, what sticks, slides, rests or chatters bounds the steps of one method and not of another, and no spectrum
//! tells which. There others are tried as soon as many steps are still to come, in turn, and after one has failed.

use super::auto::{FINE, Plan, Probe, TRIAL};
use crate::dynamics::phase::Failed;
use crate::dynamics::report::Counts;
use crate::integrators::common::{self, Cause};
use crate::scene::settings::Method;

/// Cost of an evaluation with the solve of an implicit method, and of its tangents and their factorization, in evaluations alone.
const SOLVED: f64 = 1.5;
const FACTORIZED: f64 = 3.0;

/// Steps of BDF after which a trial of it is judged, in those of one-step methods: it begins with order 1.
const LATER: usize = 10;

/// Failures at one time, of one method after the other, that end a run.
const MOST_FAILURES: usize = 3;

/// The cost of a method, in evaluations.
pub(super) fn cost(method: Method, counts: &Counts) -> f64 {
    let each = if method.information().is_implicit { SOLVED } else { 1.0 };
    each * counts.evaluations as f64 + FACTORIZED * counts.factorizations as f64
}

impl Plan {
    /// The plan to try when the last `taken` steps with this one, of `step` (s) in the mean, are far more than expected and the
    /// phase lasts `left` (s) more; a second of the motion has a `cost`.
    pub(super) fn stalled(&self, step: f64, taken: usize, left: f64, cost: f64) -> Option<Self> {
        // the spectrum knows nothing of what sticks, slides and rests
        let is_suspect = self.touches && self.asked.rtol >= FINE;
        let is_short = is_suspect || step < self.expected_step;
        let is_short = is_short && left > self.patience_of_probes as f64 * step;
        if taken < self.patience_of_probes
            || !is_short
            || !self.is_on_trial()
            || self.probe.is_some()
        {
            return None;
        }
        let reason = match self.touches {
            true => {
                format!("bodies touch, and {taken} steps of {step:.1e} s in the mean lead not far")
            }
            false => format!("{taken} steps of {step:.1e} s in the mean lead nearly nowhere"),
        };
        let before = Box::new(self.less_impatient());
        let plan = before.followed_by(self.other()?, self.asked.max_order, &reason);
        Some(Self { probe: Some(Probe { before, cost }), ..plan })
    }

    /// The method to try next.
    fn other(&self) -> Option<Method> {
        let others = match (self.settings.method, self.touches) {
            (Method::CvodeBdf, false) => [Method::Arkode; 2],
            (Method::Arkode, false) => [Method::CvodeBdf; 2],
            (Method::CvodeBdf, true) => [Method::Rosenbrock, Method::Arkode],
            (Method::Arkode, true) => [Method::Rosenbrock, Method::CvodeBdf],
            (Method::Rosenbrock, true) => [Method::CvodeBdf, Method::Arkode],
            (Method::Rk | Method::CentralDifference, true) => [Method::Rosenbrock; 2],
            // explicit methods are reviewed by the steps of the implicit one before them
            _ => return None,
        };
        Some(others[self.trials % 2])
    }

    /// Whether a trial has taken enough steps to judge by.
    pub(super) fn is_judged(&self, taken: usize) -> bool {
        let enough = if self.settings.method == Method::CvodeBdf { LATER * TRIAL } else { TRIAL };
        self.probe.is_some() && taken >= enough
    }

    /// Ends a trial by what a second of the motion has `cost` in it; returns the plan before if that was better.
    pub(super) fn settle(&mut self, cost: f64) -> Option<Self> {
        let probe = self.probe.take()?;
        if cost < probe.cost {
            return None;
        }
        let (method, times) = (self.settings.method, cost / probe.cost);
        Some(probe.back(&format!("{method} was tried, which costs {times:.1} times as much")))
    }

    /// The plan to go on with at time `t` (s) if this one has failed by `source`: that before, if it is a trial; where bodies touch,
    /// another method.
    pub(super) fn after_failure(&mut self, source: &Failed, t: f64) -> Option<Self> {
        let common::Error::Integration(error) = source.downcast_ref()? else { return None };
        if matches!(error.cause, Cause::Fatal(_)) {
            return None;
        }
        let method = self.settings.method;
        if let Some(probe) = self.probe.take() {
            return Some(probe.back(&format!("{method} was tried, and did not get on")));
        }
        let times = if self.failed.0 == t { self.failed.1 + 1 } else { 1 };
        if !self.touches || self.reason.is_none() || times == MOST_FAILURES {
            return None;
        }
        let other = self.other()?;
        let reason = format!("bodies touch, and {method} did not get on");
        let plan = self.less_impatient().followed_by(other, self.asked.max_order, &reason);
        Some(Self { failed: (t, times), ..plan })
    }

    /// This plan, or if it is a trial the one before.
    pub(super) fn settled(&self) -> &Self {
        self.probe.as_ref().map_or(self, |probe| &probe.before)
    }

    fn less_impatient(&self) -> Self {
        let (patience_of_probes, trials) = (2 * self.patience_of_probes, self.trials + 1);
        Self { patience_of_probes, trials, ..self.clone() }
    }
}

impl Probe {
    fn back(&self, why: &str) -> Plan {
        let before = self.before.reason.as_deref().unwrap_or_default();
        Plan { reason: Some(format!("{before}; {why}")), ..(*self.before).clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::auto::PATIENCE;
    use super::*;
    use crate::scene::settings::Settings;

    /// A plan of BDF whose steps are expected to be longer than 1 s.
    fn bdf() -> Plan {
        let asked = Settings { method: Method::Auto, ..Settings::default() };
        Plan {
            settings: Settings { method: Method::CvodeBdf, ..asked.clone() },
            asked,
            part: 1.0,
            reason: Some("cvode-bdf".into()),
            explicit_step: 0.0,
            central_step: 0.0,
            patience: 0,
            implicit_step: 0.0,
            expected_step: 1.0,
            patience_of_probes: PATIENCE,
            trials: 0,
            probe: None,
            touches: false,
            failed: (f64::NAN, 0),
        }
    }

    /// Another method is tried after enough steps, all of them too short, if enough are still to come; not for what was
    /// requested.
    #[test]
    fn when_another_method_is_tried() {
        let plan = bdf();
        let tried = plan.stalled(0.1, 1024, 1e3, 1.0).unwrap();
        assert_eq!(tried.settings.method, Method::Arkode);
        assert!(plan.stalled(0.1, 1023, 1e3, 1.0).is_none());
        assert!(plan.stalled(0.1, 1024, 102.0, 1.0).is_none());
        assert!(plan.stalled(1.1, 1024, 1e9, 1.0).is_none());
        assert!(tried.stalled(0.1, 1024, 1e3, 1.0).is_none());
        assert!(Plan { reason: None, ..plan.clone() }.stalled(0.1, 1024, 1e3, 1.0).is_none());
        let arkode = Settings { method: Method::Arkode, ..plan.settings.clone() };
        let tried = Plan { settings: arkode, ..plan }.stalled(0.1, 1024, 1e3, 1.0).unwrap();
        assert_eq!(tried.settings.method, Method::CvodeBdf);
    }

    /// Where bodies touch, two others are tried in turn, and explicit methods are left, too.
    #[test]
    fn where_bodies_touch_methods_take_turns() {
        let plan = Plan { touches: true, expected_step: 0.0, ..bdf() };
        let mut tried = plan.stalled(9.0, 1024, 1e5, 1.0).unwrap();
        assert_eq!(tried.settings.method, Method::Rosenbrock);
        let back = tried.settle(1.1).unwrap();
        assert_eq!(back.settings.method, Method::CvodeBdf);
        assert!(back.stalled(9.0, 1024, 1e5, 1.0).is_none());
        let tried = back.stalled(9.0, 2048, 1e5, 1.0).unwrap();
        assert_eq!(tried.settings.method, Method::Arkode);
        let rk = Settings { method: Method::Rk, ..plan.settings.clone() };
        let tried = Plan { settings: rk, ..plan }.stalled(9.0, 1024, 1e5, 1.0).unwrap();
        assert_eq!(tried.settings.method, Method::Rosenbrock);
        assert!(tried.reason.unwrap().contains("bodies touch"));
    }

    /// A trial is judged by what it costs. The method before is the more patient for one that was lost.
    #[test]
    fn what_follows_a_trial() {
        let tried = bdf().stalled(0.1, 1024, 1e3, 1.0).unwrap();
        assert!(!tried.is_judged(31) && tried.is_judged(32) && !bdf().is_judged(5000));
        let mut kept = tried.clone();
        assert!(kept.settle(0.9).is_none() && kept.probe.is_none());
        assert!(kept.stalled(0.1, 2047, 1e3, 1.0).is_none());
        assert!(kept.stalled(0.1, 2048, 1e3, 1.0).is_some());
        let back = tried.clone().settle(1.1).unwrap();
        assert_eq!(back.settings.method, Method::CvodeBdf);
        let reason = back.reason.clone().unwrap();
        assert!(reason.contains("arkode was tried, which costs 1.1 times"), "{reason}");
        assert!(back.stalled(0.1, 2047, 1e3, 1.0).is_none());
        assert!(back.stalled(0.1, 2048, 1e3, 1.0).is_some());
        assert_eq!(tried.settled().settings.method, Method::CvodeBdf);
        // BDF begins with order 1
        let settings = Settings { method: Method::Arkode, ..bdf().settings };
        let tried = Plan { settings, ..bdf() }.stalled(0.1, 1024, 1e3, 1.0).unwrap();
        assert!(!tried.is_judged(319) && tried.is_judged(320));
    }

    /// A step of ARKODE, some 8 evaluations and half a factorization, costs 6 to 10 of BDF.
    #[test]
    fn work_is_counted() {
        let counts = |evaluations, factorizations| Counts {
            evaluations,
            factorizations,
            ..Counts::default()
        };
        let [bdf, arkode, rk] = [
            cost(Method::CvodeBdf, &counts(12, 1)),
            cost(Method::Arkode, &counts(80, 5)),
            cost(Method::Rk, &counts(60, 0)),
        ];
        assert_eq!([bdf, arkode, rk], [21.0, 135.0, 60.0]);
    }

    /// A trial that fails ends; other failures, and what a force of the scene reports, end the run. Where bodies touch, two others
    /// have their turn first.
    #[test]
    fn a_trial_that_fails_is_no_failure() {
        let failed = |cause| -> Failed {
            let error = common::IntegrationError {
                integrator: "ARKODE",
                t: 1.0,
                step: 1e-9,
                order: 4,
                cause,
                message: String::new(),
                source: None,
            };
            common::Error::Integration(Box::new(error)).into()
        };
        let mut tried = bdf().stalled(0.1, 1024, 1e3, 1.0).unwrap();
        assert!(tried.after_failure(&"interrupted".into(), 1.0).is_none());
        assert!(tried.after_failure(&failed(Cause::Fatal(common::Callback::Rhs)), 1.0).is_none());
        let back = tried.after_failure(&failed(Cause::Convergence), 1.0).unwrap();
        assert_eq!(back.settings.method, Method::CvodeBdf);
        assert!(back.reason.unwrap().contains("did not get on"));
        assert!(bdf().after_failure(&failed(Cause::Convergence), 1.0).is_none());
        let mut plan = Plan { touches: true, ..bdf() };
        for other in [Method::Rosenbrock, Method::Arkode] {
            plan = plan.after_failure(&failed(Cause::Convergence), 1.0).unwrap();
            assert_eq!(plan.settings.method, other);
        }
        assert!(plan.clone().after_failure(&failed(Cause::Convergence), 1.0).is_none());
        assert!(plan.after_failure(&failed(Cause::Convergence), 2.0).is_some());
    }
}
