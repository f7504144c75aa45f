//! Automatic choice of the method that integrates a phase.
//!
//! The rules come from charts of speed against accuracy over Hirai's scenes: diagonally implicit Runge-Kutta
//! methods lead where vibrations are lightly damped, as they are L-stable and may step over them; BDF leads
//! where damping is strong, as its steps cost one stage; explicit Runge-Kutta leads where accuracy requires
//! steps not much longer than its stability limit. With lumped inertia a step of central differences costs so
//! little that they lead even with steps well above theirs.
//!
//! One factorization under commands serves while a step keeps its size to 1 % and until the error passes a
//! fifth of the tolerance. Without commands, where steps change their size, that gains nothing. Measurements
//! of the choices are in `docs/notes/automatic-choices.md` and `docs/notes/commands.md`.

use crate::dynamics::system::{PhaseSystem, Spectrum};
use crate::integrators::central_difference;
use crate::integrators::ode::Rates;
use crate::integrators::rk::{REACH, REACH_UNDAMPED};
use crate::scene::settings::{ContactEvents, Method, Settings};

/// How a phase is integrated from now on.
#[derive(Clone)]
pub(super) struct Plan {
    /// As requested, with the chosen method in place of [`Method::Auto`].
    pub(super) settings: Settings,
    /// As requested, with the full tolerances.
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
    /// Steps (s) below which, after so many of them, another method is tried; 0 where none is.
    pub(super) expected_step: f64,
    pub(super) patience_of_probes: usize,
    /// Trials so far.
    pub(super) trials: usize,
    /// The plan that this one is tried in place of.
    pub(super) probe: Option<Probe>,
    /// Whether bodies may touch obstacles or each other.
    pub(super) touches: bool,
    /// Time (s) at which the last method has failed, and how many have failed there one after the other.
    pub(super) failed: (f64, usize),
}

/// A trial of another method.
#[derive(Clone)]
pub(super) struct Probe {
    /// The plan to return to, and what a second of the motion has cost with it.
    pub(super) before: Box<Plan>,
    pub(super) cost: f64,
}

/// Damping ratio of the lowest vibration from which BDF is chosen. Hirai's bodies lie well on both sides:
/// squares and bent beams below 0.004, membranes and rings above 0.01.
const STRONG_DAMPING: f64 = 0.006;

/// Relative tolerance above which the vibrations that are damped least bound the steps of BDF. The bent beam,
/// whose slowest motion is damped by 0.1 and the others by a hundredth of that, takes with ARKODE 0.8 times
/// the time of BDF at 1e-3, and 1.2 times at 1e-6.
const ROUGH: f64 = 1e-6;

/// Relative tolerance from which on ARKODE integrates a body that creeps on a floor with order 3 and the full
/// tolerances: contacts that come and go take away most of the gain of order 4, and errors die out. On
/// walking rings errors are then 0.3 to 0.9 times `rtol` (with order 4 up to 5 times); at 1e-5 they are 0.2
/// times `rtol`, at a quarter more cost than with order 4.
const COARSE: f64 = 1e-4;

/// Step of the implicit method, in multiples of the longest stable one of the explicit method, below which
/// the explicit one is faster: 7 stages with a little more than one solve each, against 6 without.
const WORTH_EXPLICIT: f64 = 2.2;

/// The same for central differences: the cost of a step of the implicit method in steps of theirs. On the
/// clamped beam with lumped inertia these cost 79 us and 1.08 us at rtol 1e-5, 79 and 1.06 at 1e-7 (105 and
/// 1.10 at 1e-3, with more iterations).
const WORTH_CENTRAL: f64 = 70.0;

/// Part of these limits below which half of the trials are enough.
const CLEARLY: f64 = 0.7;

/// Part of their longest stable step below which it is accuracy that bounds steps of central differences,
/// and a method of higher order is better.
const SHORT: f64 = 0.1;

/// An explicit method does not pay if, for the same cost, it advances by less than this part of what the
/// implicit one does. (Where one pays the part is above 0.8; it may fall because the motion becomes faster,
/// while what bounds the steps stays the same.)
const LOSING: f64 = 0.25;

/// Part of the steps of an explicit method that lost so clearly as which they count from then on: it leaves fast vibrations
/// behind, which the implicit method then has to follow, and for a part of twice at most that is no bargain. Two syringes of
/// water and a pipe took 82,207 steps at 1e-6 where explicit steps counted as long as they were, and take 1042.
const ONCE_LOST: f64 = 0.5;

/// Relative tolerance below which implicit methods locate contact events: on Hirai's scenes that
/// takes a quarter less time there, and at 1e-5 a quarter more. Short steps between bodies that touch are then those that accuracy asks for.
pub(super) const FINE: f64 = 1e-6;

/// Part of the tolerances with which BDF continues where it has created energy.
const FINER: f64 = 0.1;

/// Unknown displacements of a body in space from which on one factorization serves many commands. A finger of 6,048 takes 10
/// ms for a tick of 1 ms so, 31 with one in each, and 33 with ARKODE, all within 5e-5; a plane body of fewer gains less than
/// its errors grow.
const LARGE: usize = 3000;

/// Part of the tolerances where one matrix serves many steps.
const OLD_MATRIX: f64 = 0.2;

/// Smallest relative tolerance that methods are given, unless a smaller one was requested: below it round-off
/// dominates.
const TIGHTEST: f64 = 1e-13;

/// Steps after which a choice is reviewed, and how many such trials are remembered.
pub(super) const TRIAL: usize = 32;
pub(super) const TRIALS: usize = 4;

/// Steps of a plan after which their mean size is checked, whatever intervals they lie in.
pub(super) const LONG: usize = TRIAL * TRIALS;

/// Steps of a plan after which another method is tried, if as many or more are still to come; twice as many before each
/// further trial. The first trial of ARKODE costs as much as a third of them.
pub(super) const PATIENCE: usize = 1024;
pub(super) const PATIENCE_OF_TOUCHES: usize = 256;

/// Part of the period of the slowest vibration below which steps are far too short for the motion to be the reason. BDF takes
/// some 100 steps for a period where accuracy bounds them, up to 5000 where nodes come to a floor and leave it, and above 10,000
/// where undamped vibrations do.
const FAR_TOO_SHORT: f64 = 1.0 / 8000.0;

impl Plan {
    /// The plan for a phase with these `equations`, from time `t` and `state`.
    pub(super) fn new(
        asked: &Settings,
        equations: &mut dyn PhaseSystem,
        t: f64,
        state: &[f64],
    ) -> Self {
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
                expected_step: 0.0,
                patience_of_probes: 0,
                trials: 0,
                probe: None,
                touches: false,
                failed: (f64::NAN, 0),
            };
        }
        let n = equations.full().dofs();
        let spectrum = equations.spectrum(t, &state[..n], &state[n..2 * n]);
        let system = equations.full();
        let (method, creeps, reason) =
            choose(&spectrum, system.matrices().retardation_time, asked.rtol);
        let is_damped = spectrum.lowest_damping_ratio >= STRONG_DAMPING;
        let period = spectrum.slowest_period().filter(|_| is_damped);
        let alpha = if system.is_constrained() { asked.alpha } else { 0.0 };
        let (part, max_order) = match asked.max_order {
            None if creeps && asked.rtol >= COARSE => (1.0, Some(3)),
            order => (part(method, asked.rtol), order),
        };
        let relaxation = system.relaxation_rate();
        let touches = system.touches();
        let is_for_central = system.is_lumped() && system.layout().internal().is_empty();
        Self {
            settings: given(asked, method, max_order, part),
            asked: asked.clone(),
            part,
            reason: Some(reason),
            explicit_step: explicit_step(&spectrum, alpha.max(relaxation)),
            central_step: if is_for_central { central_step(&spectrum) } else { 0.0 },
            patience: 8 * TRIAL,
            implicit_step: 0.0,
            // steps over light vibrations are long, or as short as accuracy asks for
            expected_step: FAR_TOO_SHORT * period.unwrap_or(0.0),
            patience_of_probes: if touches { PATIENCE_OF_TOUCHES } else { PATIENCE },
            trials: 0,
            probe: None,
            touches,
            failed: (f64::NAN, 0),
        }
    }

    /// Whether contact events are located.
    pub(super) fn locates(&self) -> bool {
        let pays = || match self.settings.method {
            // a one-step method: a new start costs nothing, and errors become much smaller
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

    /// Whether there is another method to continue with if this one creates energy.
    pub(super) fn is_on_trial(&self) -> bool {
        self.reason.is_some() && !self.is_last_resort()
    }

    /// The plan to continue with when this one has failed by `trouble`: none if the method was requested, or
    /// is already the last resort.
    pub(super) fn instead(&self, trouble: &str) -> Option<Self> {
        if !self.is_on_trial() {
            return None;
        }
        let asked = self.asked.max_order;
        Some(match self.settings.method {
            Method::Arkode => self.followed_by(Method::CvodeBdf, Some(2), trouble),
            // its orders above 2 create energy where steps are long compared with the periods of vibrations
            Method::CvodeBdf if self.part == part(Method::CvodeBdf, self.asked.rtol) => {
                let reason = format!("{trouble}: at a tenth of its tolerances");
                self.followed_by(Method::CvodeBdf, asked, &reason).with_part(FINER * self.part)
            }
            _ => self.followed_by(Method::Arkode, asked, trouble),
        })
    }

    /// The plan to continue with, if the mean step sizes `means` (s) of the last trials of [`TRIAL`] steps
    /// each, the last one first, show that another method is better; `steps` were taken with this plan in
    /// all. (At least two trials in a row must show it, and four where it is not clear: motion begins with
    /// small steps.)
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
            // does stability bound the steps, or accuracy? Only the implicit method can show it
            Method::Rk if steps >= self.patience && step > 0.3 * bound => implicit(central),
            Method::CentralDifference if lasts_below(SHORT * central) => implicit(step),
            Method::CentralDifference if steps >= WORTH_CENTRAL as usize * self.patience => {
                implicit(central)
            }
            _ => None,
        }
    }

    /// The plan to continue with when the steps of an explicit method that took over turn out to be only
    /// `step` (s) in the mean: the implicit method again, if it advanced farther for the same cost. (What
    /// bounds explicit steps may have begun since: a body that sticks to a floor, or events one after the
    /// other.) From then on explicit steps count as half as long.
    pub(super) fn turned_back(&self, step: f64) -> Option<Self> {
        let lost = ONCE_LOST * step;
        let (worth, [explicit_step, central_step]) = match self.settings.method {
            Method::Rk => (WORTH_EXPLICIT, [lost, self.central_step]),
            Method::CentralDifference => (WORTH_CENTRAL, [self.explicit_step, lost]),
            _ => return None,
        };
        (worth * step < LOSING * self.implicit_step).then(|| {
            let reason = format!("steps of {step:.1e} s advance less per cost");
            let plan = self.followed_by(Method::Arkode, self.asked.max_order, &reason);
            Self { explicit_step, central_step, ..plan }
        })
    }

    /// The plan to continue with where commands change the forces of the `equations` again and again, as each change would restart
    /// BDF; the step that is planned is this `part` of the time between two commands.
    ///
    /// A Rosenbrock method of order 4, which has no iteration to begin anew; of order 3 for large bodies in space, where one
    /// factorization serves many commands, as long as a step lasts from one to the next.
    pub(super) fn under_commands(&self, equations: &dyn PhaseSystem, part: f64) -> Option<Self> {
        let method = self.settings.method;
        if !self.is_on_trial() {
            return None;
        }
        if self.asked.max_order.is_some() || self.asked.rtol < COARSE {
            let reason = "commands change forces";
            let starts_anew = method == Method::CvodeBdf;
            return starts_anew
                .then(|| self.followed_by(Method::Arkode, self.asked.max_order, reason));
        }
        let system = equations.full();
        let is_solid = system.matrices().dimension == 3 && !system.has_edges();
        let is_large = is_solid && equations.freedoms() >= LARGE;
        let (order, reason) = match (method, self.settings.max_order) {
            (Method::CvodeBdf | Method::Arkode, _) if is_large => {
                (3, "commands change forces, and factorizations are most of the work")
            }
            (Method::CvodeBdf | Method::Arkode, _) => (4, "commands change forces"),
            (Method::Rosenbrock, Some(3)) if part < 0.5 => {
                (4, "steps are shorter than the time between commands")
            }
            _ => return None,
        };
        let plan = self.followed_by(Method::Rosenbrock, Some(order), reason);
        Some(if order == 3 { plan.with_part(OLD_MATRIX) } else { plan })
    }

    pub(super) fn followed_by(&self, method: Method, max_order: Option<u32>, reason: &str) -> Self {
        let part = part(method, self.asked.rtol);
        let before = self.reason.as_deref().unwrap_or_default();
        Self {
            settings: given(&self.asked, method, max_order, part),
            part,
            reason: Some(format!("{before}; then {method}, as {reason}")),
            probe: None,
            ..self.clone()
        }
    }

    /// This plan with `part` of the requested tolerances.
    fn with_part(self, part: f64) -> Self {
        let Settings { method, max_order, .. } = self.settings;
        Self { settings: given(&self.asked, method, max_order, part), part, ..self }
    }

    /// Whether this is the plan that all others end in: order 2 of BDF, which damps all vibrations.
    fn is_last_resort(&self) -> bool {
        self.settings.method == Method::CvodeBdf && self.settings.max_order == Some(2)
    }
}

/// The settings of a method, with its `part` of the requested tolerances.
fn given(asked: &Settings, method: Method, max_order: Option<u32>, part: f64) -> Settings {
    Settings { method, max_order: cap(method, max_order), ..asked.tightened(part) }
}

/// Part of the requested tolerances that a method is given, so that the error of the motion is about as large
/// as `rtol`.
///
/// On Hirai's scenes and clamped beams errors were 1 to 9 times the tolerance of ARKODE, 4 to 20 times that
/// of BDF where accuracy bounds its steps. Methods that continue with the value whose error they estimate
/// have a local error of one order more than the global one, so that errors shrink as rtol^(p/(p+1)) (E.
/// Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, section II.4); the others
/// continue with a more accurate value.
fn part(method: Method, rtol: f64) -> f64 {
    let part = match method {
        Method::CvodeBdf => 0.1 * (rtol / 1e-3).powf(1.0 / 5.0).min(1.0),
        Method::CentralDifference => 0.2 * (rtol / 1e-5).sqrt().min(1.0),
        // under commands: 0.02 to 0.9 times the tolerance on four driven bodies, at 1e-3 and 1e-4
        Method::Rosenbrock => 1.0,
        _ => 0.2,
    };
    part.max((TIGHTEST / rtol).min(1.0))
}

/// The order of a method that is nearest to that requested, if it has a choice of orders.
fn cap(method: Method, max_order: Option<u32>) -> Option<u32> {
    let [lowest, highest] = method.information().orders;
    max_order.filter(|_| method.has_orders()).map(|order| order.clamp(lowest, highest))
}

/// The method, whether it follows a body that creeps, and why it was chosen, for a body whose materials have a viscosity of
/// `retardation_time` (s) times their stiffness at most.
fn choose(spectrum: &Spectrum, retardation_time: f64, rtol: f64) -> (Method, bool, String) {
    // mass damping hardly affects fast vibrations, which are difficult for BDF
    let (by_mass, besides) = match spectrum.mass_damping_ratio {
        0.0 => (0.0, ""),
        by_mass => (by_mass, " besides that of its mass"),
    };
    let ratio = (spectrum.lowest_damping_ratio - by_mass).max(0.0);
    // the damping ratio that follows from the fastest motions if all damping is that of the material
    let of_material = 0.5 * spectrum.damping_rate * spectrum.lowest_frequency.unwrap_or(0.0)
        / spectrum.highest_frequency.powi(2);
    // the creeping of a body on a floor that damps says nothing about the vibrations within the body
    let creeps = ratio >= 1.0 && of_material < 1.0;
    // nor does what a muscle or a damper brakes: it leaves motions across it to the material
    let by_viscosity = 0.5 * retardation_time * spectrum.lowest_frequency.unwrap_or(0.0);
    let (method, limit) = match ratio {
        _ if creeps => (Method::Arkode, "overdamped from outside".into()),
        // nor does the slowest motion of a bent body if parts of it turn, which natural viscosity damps
        STRONG_DAMPING.. if of_material < STRONG_DAMPING && rtol > ROUGH => {
            (Method::Arkode, format!("by the fastest motions {of_material:.1e}"))
        }
        STRONG_DAMPING.. if by_viscosity < STRONG_DAMPING && rtol > ROUGH => {
            (Method::Arkode, format!("by the viscosity of its material {by_viscosity:.1e}"))
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

/// Longest step (s) with which explicit Runge-Kutta is stable, where `decay` (1/s) is the fastest rate
/// outside the spectrum.
fn explicit_step(spectrum: &Spectrum, decay: f64) -> f64 {
    let Spectrum { highest_frequency, damping_rate, .. } = *spectrum;
    // undamped vibrations lie on the imaginary axis, at the edge of the stability region, which leaves it at
    // 1
    let reach = match damping_rate > 0.1 * highest_frequency {
        true => REACH,
        false => REACH_UNDAMPED,
    };
    (reach / spectrum.stiffest_rate()).min(REACH / decay)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Method that replaces ARKODE after trials with mean steps `means` (s), the last one first, where explicit steps
    /// are stable up to 1 s, or up to `central_step` (s) for central differences; `None` if ARKODE continues.
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
            expected_step: 0.0,
            patience_of_probes: PATIENCE,
            trials: 0,
            probe: None,
            touches: false,
            failed: (f64::NAN, 0),
        };
        plan.reconsidered(means, TRIAL).map(|plan| plan.settings.method)
    }

    /// Two trials are needed if steps are far below the limit, four if they are near to it; one is never
    /// enough.
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

    /// Methods are given smaller tolerances than requested, a part that decreases with the tolerance for
    /// methods whose errors shrink more slowly, but never below round-off.
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
