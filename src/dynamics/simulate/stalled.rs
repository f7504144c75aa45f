//! Methods that take far more steps than expected: another one is tried in their place, and kept if it leads farther for
//! the same cost.
//!
//! The cause of the short steps does not matter. A known one of BDF are undamped vibrations: they
//! lie outside of the stability regions of its orders above 2 (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
//! II*, section V.2), which bounds its steps by the fastest of them, however small they are.

use super::auto::{Plan, Probe, TRIAL};
use crate::dynamics::phase::Failed;
use crate::integrators::common::{self, Cause};
use crate::scene::settings::Method;

/// Cost of a step of ARKODE in steps of BDF: 8 to 15 in the scenes whose runs were timed.
const WORTH_BDF: f64 = 10.0;

impl Plan {
    /// The plan to try when the last `taken` steps with this one, of `step` (s) in the mean, are far more than expected and the
    /// phase lasts `left` (s) more.
    pub(super) fn stalled(&self, step: f64, taken: usize, left: f64) -> Option<Self> {
        let is_short = step < self.expected_step && left > self.patience_of_probes as f64 * step;
        if taken < self.patience_of_probes
            || !is_short
            || !self.is_on_trial()
            || self.probe.is_some()
        {
            return None;
        }
        let other = match self.settings.method {
            Method::CvodeBdf => Method::Arkode,
            Method::Arkode => Method::CvodeBdf,
            // explicit methods are reviewed by the steps of the implicit one before them
            _ => return None,
        };
        let reason = format!("{taken} steps of {step:.1e} s in the mean lead nearly nowhere");
        let plan = self.followed_by(other, self.asked.max_order, &reason);
        Some(Self { probe: Some(Probe { before: Box::new(self.less_impatient()), step }), ..plan })
    }

    /// Ends a trial if `taken` steps of `step` (s) in the mean are enough to judge by; returns the plan before if that was better.
    pub(super) fn settle(&mut self, taken: usize, step: f64) -> Option<Self> {
        let (worth, enough) = match self.settings.method {
            Method::Arkode => (WORTH_BDF, TRIAL),
            _ => (1.0 / WORTH_BDF, WORTH_BDF as usize * TRIAL),
        };
        if taken < enough {
            return None;
        }
        let probe = self.probe.take()?;
        if step > worth * probe.step {
            self.patience_of_probes = probe.before.patience_of_probes;
            return None;
        }
        let method = self.settings.method;
        Some(probe.back(&format!(
            "{method} was tried, whose steps of {step:.1e} s lead less far for what they cost than {:.1e} s",
            probe.step
        )))
    }

    /// The plan before, if a trial has failed by `source`.
    pub(super) fn after_failure(&mut self, source: &Failed) -> Option<Self> {
        let common::Error::Integration(error) = source.downcast_ref()? else { return None };
        if matches!(error.cause, Cause::Fatal(_)) {
            return None;
        }
        let method = self.settings.method;
        Some(self.probe.take()?.back(&format!("{method} was tried, and did not get on")))
    }

    /// This plan, or if it is a trial the one before.
    pub(super) fn settled(&self) -> &Self {
        self.probe.as_ref().map_or(self, |probe| &probe.before)
    }

    fn less_impatient(&self) -> Self {
        Self { patience_of_probes: 2 * self.patience_of_probes, ..self.clone() }
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
            probe: None,
        }
    }

    /// Another method is tried after enough steps, all of them too short, if enough are still to come; not for what was
    /// requested.
    #[test]
    fn when_another_method_is_tried() {
        let plan = bdf();
        let tried = plan.stalled(0.1, 1024, 1e3).unwrap();
        assert_eq!(tried.settings.method, Method::Arkode);
        assert!(plan.stalled(0.1, 1023, 1e3).is_none());
        assert!(plan.stalled(0.1, 1024, 102.0).is_none());
        assert!(plan.stalled(1.1, 1024, 1e9).is_none());
        assert!(tried.stalled(0.1, 1024, 1e3).is_none());
        assert!(Plan { reason: None, ..plan.clone() }.stalled(0.1, 1024, 1e3).is_none());
        let arkode = Settings { method: Method::Arkode, ..plan.settings.clone() };
        let tried = Plan { settings: arkode, ..plan }.stalled(0.1, 1024, 1e3).unwrap();
        assert_eq!(tried.settings.method, Method::CvodeBdf);
    }

    /// A step of ARKODE has to be worth ten of BDF. The method before is the more patient for a trial that was lost.
    #[test]
    fn what_follows_a_trial() {
        let tried = bdf().stalled(0.1, 1024, 1e3).unwrap();
        let mut kept = tried.clone();
        assert!(kept.settle(31, 9.0).is_none() && kept.probe.is_some());
        assert!(kept.settle(32, 1.1).is_none() && kept.probe.is_none());
        assert!(kept.stalled(0.1, 2047, 1e3).is_none() && kept.stalled(0.1, 2048, 1e3).is_some());
        let back = tried.clone().settle(32, 0.9).unwrap();
        assert_eq!(back.settings.method, Method::CvodeBdf);
        let reason = back.reason.clone().unwrap();
        assert!(reason.contains("arkode was tried"), "{reason}");
        assert!(back.stalled(0.1, 2047, 1e3).is_none() && back.stalled(0.1, 2048, 1e3).is_some());
        assert_eq!(tried.settled().settings.method, Method::CvodeBdf);
        // the other way, where a step of BDF is a tenth
        let settings = Settings { method: Method::Arkode, ..bdf().settings };
        let tried = Plan { settings, ..bdf() }.stalled(0.1, 1024, 1e3).unwrap();
        assert!(tried.clone().settle(319, 1e-3).is_none());
        assert_eq!(tried.clone().settle(320, 0.009).unwrap().settings.method, Method::Arkode);
        let mut kept = tried;
        assert!(kept.settle(320, 0.011).is_none() && kept.probe.is_none());
    }

    /// A trial that fails ends; other failures, and what a force of the scene reports, end the run.
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
        let mut tried = bdf().stalled(0.1, 1024, 1e3).unwrap();
        assert!(tried.after_failure(&"interrupted".into()).is_none());
        assert!(tried.after_failure(&failed(Cause::Fatal(common::Callback::Rhs))).is_none());
        let back = tried.after_failure(&failed(Cause::Convergence)).unwrap();
        assert_eq!(back.settings.method, Method::CvodeBdf);
        assert!(back.reason.unwrap().contains("did not get on"));
        assert!(bdf().after_failure(&failed(Cause::Convergence)).is_none());
    }
}
