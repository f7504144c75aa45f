//! Which method integrates a phase, and why.
//!
//! The rules come from charts of speed against accuracy over Hirai's scenes: diagonally
//! implicit Runge-Kutta methods lead where vibrations are lightly damped, for they are L-stable and
//! may step over them; BDF leads where damping is strong, for a step costs it one stage; explicit
//! Runge-Kutta leads where accuracy asks for steps not much longer than those of its stability. With
//! lumped inertia a step of central differences costs so little that they lead well before that.

use crate::dynamics::system::{Spectrum, System};
use crate::integrators::central_difference;
use crate::integrators::ode::Rates;
use crate::scene::settings::{ContactEvents, Method, Settings};

/// How a phase is integrated from now on.
#[derive(Clone)]
pub(super) struct Plan {
    /// As asked for, with a method of its own in place of [`Method::Auto`].
    pub(super) settings: Settings,
    /// As asked for, with all tolerances.
    pub(super) asked: Settings,
    /// Part of these tolerances that the method is given.
    pub(super) part: f64,
    /// Why this method, and those before it in the phase, if they were chosen.
    pub(super) reason: Option<String>,
    /// Longest stable steps of explicit Runge-Kutta and, with lumped inertia, of central differences (s).
    pub(super) explicit_step: f64,
    pub(super) central_step: f64,
    /// Steps of explicit Runge-Kutta after which the implicit one is tried again.
    pub(super) patience: usize,
    /// Mean step (s) of the implicit method when an explicit one took over from it; 0 as long as none has.
    pub(super) implicit_step: f64,
}

/// Damping ratio of the lowest vibration from which BDF is chosen. Hirai's bodies lie well
/// to both sides: squares and bent beams below 0.004, membranes and rings above 0.01.
const STRONG_DAMPING: f64 = 0.006;

/// Relative tolerance above which the vibrations that are damped least bound the steps of BDF. The bent beam, whose slowest
/// motion is damped by 0.1 and the others by a hundredth of that, takes 0.8 of the time with ARKODE at 1e-3, 1.2 times
/// the time at 1e-6.
const ROUGH: f64 = 1e-6;

/// Relative tolerance from which on ARKODE follows a body that creeps on a floor by order 3, with all of the tolerances:
/// contacts that come and go leave little of order 4, and errors die out. On walking rings they are 0.3 to 0.9 times `rtol`
/// then (of order 4 up to 5 times), at 1e-5 they are 0.2 times and cost a quarter more than those of order 4.
const COARSE: f64 = 1e-4;

/// Steps of the implicit method, in longest stable ones of the explicit method, below which the
/// explicit one is faster: 7 stages with a solve each and a bit, against 6 without.
const WORTH_EXPLICIT: f64 = 2.2;

/// The same for central differences: what a step of the implicit method costs, in theirs. On the clamped beam with
/// lumped inertia that is 79 us beside 1.08 us at rtol 1e-5 and 79 beside 1.06 at 1e-7 (105 beside 1.10 at 1e-3, with
/// more iterations).
const WORTH_CENTRAL: f64 = 70.0;

/// Part of these limits below which half the trials tell enough.
const CLEARLY: f64 = 0.7;

/// Part of their longest stable step below which it is accuracy that bounds steps of central differences,
/// and a method of higher order is better.
const SHORT: f64 = 0.1;

/// Part of the way of the implicit method below which an explicit one, for the same cost, does not pay. (Where one pays it is
/// above 0.8; it may fall as the motion, and not what bounds the steps, becomes faster.)
const LOSING: f64 = 0.25;

/// Steps on the real axis and on the imaginary one that Dormand-Prince 5(4) takes, times the rate.
const EXPLICIT_REACH: f64 = 3.3;
const EXPLICIT_REACH_UNDAMPED: f64 = 1.0;

/// Relative tolerance below which implicit methods locate contact events: on Hirai's scenes that
/// takes a quarter less time there, and at 1e-5 a quarter more.
const FINE: f64 = 1e-6;

/// Part of the tolerances with which BDF goes on where it has created energy.
const FINER: f64 = 0.1;

/// Relative tolerance that methods are given at least, unless less was asked for: round-off rules below.
const TIGHTEST: f64 = 1e-13;

/// Steps after which a choice is looked at again, and how many of such trials are remembered.
pub(super) const TRIAL: usize = 32;
pub(super) const TRIALS: usize = 4;

/// Steps of a plan after which it is asked how far they have led, whatever intervals they lie in.
pub(super) const LONG: usize = TRIAL * TRIALS;

impl Plan {
    /// The plan for a phase whose equations are `system`, from time `t` and `state` = (u, v, ...).
    pub(super) fn new(asked: &Settings, system: &mut System, t: f64, state: &[f64]) -> Self {
        if asked.method != Method::Auto {
            return Self {
                settings: asked.clone(),
                asked: asked.clone(),
                part: 1.0,
                reason: None,
                explicit_step: 0.0,
                central_step: 0.0,
                patience: 0,
                implicit_step: 0.0,
            };
        }
        let n = system.dofs();
        let spectrum = system.spectrum(t, &state[..n], &state[n..2 * n]);
        let (method, creeps, reason) = choose(&spectrum, asked.rtol);
        let alpha = if system.rows().is_empty() { 0.0 } else { asked.alpha };
        let (part, max_order) = match asked.max_order {
            None if creeps && asked.rtol >= COARSE => (1.0, Some(3)),
            order => (part(method, asked.rtol), order),
        };
        let relaxation = system.relaxation_rate();
        let is_for_central = system.is_lumped() && relaxation == 0.0;
        Self {
            settings: given(asked, method, max_order, part),
            asked: asked.clone(),
            part,
            reason: Some(reason),
            explicit_step: explicit_step(&spectrum, alpha.max(relaxation)),
            central_step: if is_for_central { central_step(&spectrum) } else { 0.0 },
            patience: 8 * TRIAL,
            implicit_step: 0.0,
        }
    }

    /// Whether contact events are located.
    pub(super) fn locates(&self) -> bool {
        let pays = || match self.settings.method {
            // one step after another: a new start costs nothing, and errors become much smaller
            Method::Rk => true,
            Method::CentralDifference => false,
            _ => self.asked.rtol < FINE,
        };
        match self.settings.contact_events {
            ContactEvents::Auto => self.reason.is_some() && pays(),
            ContactEvents::StepOver => false,
            ContactEvents::Locate => true,
        }
    }

    /// Whether there is another method to go on with if this one creates energy.
    pub(super) fn is_on_trial(&self) -> bool {
        self.reason.is_some() && !self.is_last_resort()
    }

    /// What to go on with when this plan has gone wrong by `trouble`: nothing if the method was
    /// asked for, or is the last resort already.
    pub(super) fn instead(&self, trouble: &str) -> Option<Self> {
        if !self.is_on_trial() {
            return None;
        }
        let asked = self.asked.max_order;
        Some(match self.settings.method {
            Method::Arkode => self.followed_by(Method::CvodeBdf, Some(2), trouble),
            // its orders above 2 create energy where steps are long for what vibrates
            Method::CvodeBdf if self.part == part(Method::CvodeBdf, self.asked.rtol) => {
                let reason = format!("{trouble}: at a tenth of its tolerances");
                self.followed_by(Method::CvodeBdf, asked, &reason).with_part(FINER * self.part)
            }
            _ => self.followed_by(Method::Arkode, asked, trouble),
        })
    }

    /// What to go on with when the last times [`TRIAL`] of the `steps` taken with this plan have
    /// shown, by their mean sizes `means` (s), the last one first, what the motion asks for. (Two in a row at least, and
    /// four where it is not clear: motion begins with small steps.)
    pub(super) fn reconsidered(&self, means: [f64; TRIALS], steps: usize) -> Option<Self> {
        self.reason.as_ref()?;
        let (bound, central, [step, ..]) = (self.explicit_step, self.central_step, means);
        let lasts_below = |limit: f64| means.chunks(2).all(|two| 0.5 * (two[0] + two[1]) < limit);
        let below = |limit: f64| {
            lasts_below(limit) || means[..2].iter().all(|step| *step < CLEARLY * limit)
        };
        let explicit = |method| {
            let reason = format!("accuracy asks for steps of {step:.1e} s");
            Some(Self { implicit_step: step, ..self.followed_by(method, None, &reason) })
        };
        let implicit = |central_step| {
            let plan = self.followed_by(
                Method::Arkode,
                self.asked.max_order,
                &format!("stability may bound steps of {step:.1e} s"),
            );
            Some(Self { patience: 4 * self.patience, central_step, ..plan })
        };
        match self.settings.method {
            Method::Arkode if below(WORTH_EXPLICIT * bound) && below(central) => {
                explicit(Method::Rk)
            }
            Method::Arkode if below(WORTH_CENTRAL * central) => explicit(Method::CentralDifference),
            Method::Arkode if below(WORTH_EXPLICIT * bound) => explicit(Method::Rk),
            // does stability bound the steps, or accuracy? Only the implicit method can tell
            Method::Rk if steps >= self.patience && step > 0.3 * bound => implicit(central),
            Method::CentralDifference if lasts_below(SHORT * central) => implicit(step),
            Method::CentralDifference if steps >= WORTH_CENTRAL as usize * self.patience => {
                implicit(central)
            }
            _ => None,
        }
    }

    /// What to go on with when steps of an explicit method that took over turn out to lead but `step` (s) in the mean:
    /// the implicit one again, if that led farther for what its steps cost. (What bounds explicit steps may have come
    /// since: a body that sticks to a floor, or events one after the other.) From then on explicit steps count as that long.
    pub(super) fn turned_back(&self, step: f64) -> Option<Self> {
        let (worth, [explicit_step, central_step]) = match self.settings.method {
            Method::Rk => (WORTH_EXPLICIT, [step, self.central_step]),
            Method::CentralDifference => (WORTH_CENTRAL, [self.explicit_step, step]),
            _ => return None,
        };
        (worth * step < LOSING * self.implicit_step).then(|| {
            let reason = format!("steps of {step:.1e} s lead less far for what they cost");
            let plan = self.followed_by(Method::Arkode, self.asked.max_order, &reason);
            Self { explicit_step, central_step, ..plan }
        })
    }

    /// What to go on with where commands change the forces again and again, each of which would make BDF start anew.
    pub(super) fn under_commands(&self) -> Option<Self> {
        let starts_anew = self.is_on_trial() && self.settings.method == Method::CvodeBdf;
        starts_anew.then(|| {
            self.followed_by(Method::Arkode, self.asked.max_order, "commands change forces")
        })
    }

    fn followed_by(&self, method: Method, max_order: Option<u32>, reason: &str) -> Self {
        let part = part(method, self.asked.rtol);
        let before = self.reason.as_deref().unwrap_or_default();
        Self {
            settings: given(&self.asked, method, max_order, part),
            part,
            reason: Some(format!("{before}; then {method}, as {reason}")),
            ..self.clone()
        }
    }

    /// This plan with `part` of the tolerances that were asked for.
    fn with_part(self, part: f64) -> Self {
        let Settings { method, max_order, .. } = self.settings;
        Self { settings: given(&self.asked, method, max_order, part), part, ..self }
    }

    /// Whether this is what other plans end in: order 2 of BDF, which damps all vibrations.
    fn is_last_resort(&self) -> bool {
        self.settings.method == Method::CvodeBdf && self.settings.max_order == Some(2)
    }
}

/// The settings of a method, with its `part` of the tolerances asked for.
fn given(asked: &Settings, method: Method, max_order: Option<u32>, part: f64) -> Settings {
    Settings { method, max_order: cap(method, max_order), ..asked.tightened(part) }
}

/// Part of the tolerances asked for that a method is given, so that the error of the motion is about as large as `rtol`.
///
/// On Hirai's scenes and clamped beams errors were 1 to 9 times the tolerance of ARKODE, 4 to 20 times that of BDF
/// where accuracy bounds its steps. Methods that go on with the value whose error they estimate have one more order per
/// step than in all, so that errors shrink by rtol^(p/(p+1)) (E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary
/// Differential Equations I*, section II.4); the others go on with a better one.
fn part(method: Method, rtol: f64) -> f64 {
    let part = match method {
        Method::CvodeBdf => 0.1 * (rtol / 1e-3).powf(1.0 / 5.0).min(1.0),
        Method::CentralDifference => 0.2 * (rtol / 1e-5).sqrt().min(1.0),
        _ => 0.2,
    };
    part.max((TIGHTEST / rtol).min(1.0))
}

/// The highest order that was asked for, as far as the method has a choice of orders.
fn cap(method: Method, max_order: Option<u32>) -> Option<u32> {
    match method {
        Method::Arkode => max_order.map(|order| order.clamp(2, 5)),
        Method::CvodeBdf => max_order.map(|order| order.min(5)),
        _ => None,
    }
}

/// The method, whether it follows a body that creeps, and why it was chosen.
fn choose(spectrum: &Spectrum, rtol: f64) -> (Method, bool, String) {
    // fast vibrations, which BDF dislikes, have next to nothing of mass damping
    let (by_mass, besides) = match spectrum.mass_damping_ratio {
        0.0 => (0.0, ""),
        by_mass => (by_mass, " besides that of its mass"),
    };
    let ratio = (spectrum.lowest_damping_ratio - by_mass).max(0.0);
    // the ratio that the fastest motions would give it, were the damping that of the material
    let of_material = 0.5 * spectrum.damping_rate * spectrum.lowest_frequency.unwrap_or(0.0)
        / spectrum.highest_frequency.powi(2);
    // a body that creeps on a floor that damps tells nothing of what vibrates in it
    let creeps = ratio >= 1.0 && of_material < 1.0;
    let (method, limit) = match ratio {
        _ if creeps => (Method::Arkode, "overdamped from outside".into()),
        // nor does a bent one whose parts turn in its slowest motion, which natural viscosity brakes
        STRONG_DAMPING.. if of_material < STRONG_DAMPING && rtol > ROUGH => {
            (Method::Arkode, format!("by the fastest motions {of_material:.1e}"))
        }
        STRONG_DAMPING.. => (Method::CvodeBdf, format!("{STRONG_DAMPING} or more")),
        _ => (Method::Arkode, format!("below {STRONG_DAMPING}")),
    };
    let why = spectrum.slowest_period().map_or("nothing vibrates".into(), |period| {
        format!("the slowest vibration ({period:.1e} s) has the damping ratio {ratio:.1e}{besides}, {limit}")
    });
    (method, creeps, format!("{method}, as {why}"))
}

/// Longest step (s) with which central differences are stable.
fn central_step(spectrum: &Spectrum) -> f64 {
    let Spectrum { highest_frequency, damping_rate, .. } = *spectrum;
    central_difference::longest_step(&Rates { frequency: highest_frequency, decay: damping_rate })
}

/// Longest step (s) with which explicit Runge-Kutta is stable, `decay` (1/s) being the fastest besides those of the spectrum.
fn explicit_step(spectrum: &Spectrum, decay: f64) -> f64 {
    let Spectrum { highest_frequency, damping_rate, .. } = *spectrum;
    // an undamped vibration is on the edge of the region of stability, which leaves the axis at 1
    let reach = match damping_rate > 0.1 * highest_frequency {
        true => EXPLICIT_REACH,
        false => EXPLICIT_REACH_UNDAMPED,
    };
    (reach / spectrum.stiffest_rate()).min(EXPLICIT_REACH / decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Trials of `means` (s), the last one first, of ARKODE where stable steps are 1 s, or 0.1 s of central differences.
    fn goes_on_with(means: [f64; TRIALS], central_step: f64) -> Option<Method> {
        let asked = Settings { method: Method::Auto, ..Settings::default() };
        let plan = Plan {
            settings: given(&asked, Method::Arkode, None, 1.0),
            asked,
            part: 1.0,
            reason: Some(String::new()),
            explicit_step: 1.0,
            central_step,
            patience: 8 * TRIAL,
            implicit_step: 0.0,
        };
        plan.reconsidered(means, TRIAL).map(|plan| plan.settings.method)
    }

    /// Two trials with steps far below what an implicit method is worth, four with steps near to it; never by one.
    #[test]
    fn explicit_methods_take_over_the_sooner_the_clearer_it_is() {
        let never = f64::INFINITY;
        assert_eq!(goes_on_with([1.0, 1.0, never, never], 0.0), Some(Method::Rk));
        assert_eq!(goes_on_with([1.0, never, never, never], 0.0), None);
        assert_eq!(goes_on_with([2.0, 2.0, never, never], 0.0), None);
        assert_eq!(goes_on_with([2.0, 2.0, 2.0, never], 0.0), None);
        assert_eq!(goes_on_with([2.0; 4], 0.0), Some(Method::Rk));
        assert_eq!(goes_on_with([2.0, 2.0, 2.3, 2.3], 0.0), None);
        // a step of ARKODE costs 70 of central differences
        assert_eq!(goes_on_with([4.0, 4.0, never, never], 0.1), Some(Method::CentralDifference));
        assert_eq!(goes_on_with([6.0, 6.0, never, never], 0.1), None);
        assert_eq!(goes_on_with([6.0; 4], 0.1), Some(Method::CentralDifference));
        assert_eq!(goes_on_with([8.0; 4], 0.1), None);
    }

    /// What methods are given is less than what was asked for, the less the finer it is for methods whose errors shrink more
    /// slowly, and never beyond round-off.
    #[test]
    fn parts_of_tolerances() {
        assert_eq!(part(Method::Arkode, 1e-2), 0.2);
        assert_eq!([1e-2, 1e-3].map(|rtol| part(Method::CvodeBdf, rtol)), [0.1; 2]);
        assert!((part(Method::CvodeBdf, 1e-8) - 0.01).abs() < 1e-15);
        for method in [Method::Arkode, Method::CvodeBdf, Method::Rk, Method::CentralDifference] {
            for rtol in [1e-9, 1e-11, 1e-12] {
                assert!(part(method, rtol) * rtol >= 0.999 * TIGHTEST, "{method} {rtol}");
            }
            assert_eq!(part(method, 1e-14), 1.0);
        }
    }
}
