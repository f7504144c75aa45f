//! Report of a computed motion, phase by phase, with its cost.

mod indicator;
mod reduced;

use std::fmt;

pub(crate) use indicator::warnings;
pub use indicator::{Indicator, Verdict};
pub use reduced::{ReducedReport, SensorErrorEstimate};

use crate::base::input::four_digits;
use crate::scene::settings::Method;

/// Report of a computed trajectory.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// Title of the scene, if its file has one; empty otherwise.
    pub title: String,
    /// Integration method.
    pub method: Method,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance of displacements (m).
    pub atol_position: f64,
    /// Rate of the constraint stabilization (1/s).
    pub alpha: f64,
    /// Unknowns of the integrator, in the last phase.
    pub states: usize,
    /// Assumption across cells of two dimensions in words, such as `plane strain`, body by body where they differ; `None` without
    /// such cells.
    pub plane: Option<String>,
    /// Largest |A^T u - b| at the end of a step (m).
    pub constraint_drift: f64,
    /// Largest change of the energy balance (J): kinetic + potential + dissipated - supplied.
    pub energy_error: f64,
    /// Largest rise of the energy balance (J): energy that the integrator has created.
    pub energy_created: f64,
    /// Largest sum of the energies (J), as the scale of `energy_error`: no less than the work of the forces that hold a body
    /// along 1e-9 of its size, which is round-off.
    pub energy_scale: f64,
    /// Wall-clock time of the whole run (s).
    pub wall_seconds: f64,
    /// Indicators of the scene and of the motion, measured once the run had ended; those beyond their limits are among
    /// the [`warnings`](Self::warnings). [`Trajectory::indicators`](crate::Trajectory::indicators) measures more.
    pub indicators: Vec<Indicator>,
    /// Choices made where a scene file says `auto`, with the reasons.
    pub chosen: Vec<String>,
    /// Accuracy of the motion, if it was
    /// [verified](crate::studies::work_precision::Verification).
    pub achieved: Option<Achieved>,
    /// Error report of a run by a reduced model.
    pub reduced: Option<ReducedReport>,
    /// Phase by phase.
    pub phases: Vec<PhaseReport>,
}

/// Accuracy of a motion: the difference of two runs, the second with a tenth of the tolerance of
/// the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Achieved {
    /// Compared quantity.
    pub quantity: String,
    /// The largest relative difference that was requested.
    pub asked: f64,
    /// The relative difference that was found.
    pub difference: f64,
    /// Scale of `asked` and `difference`, in `unit`: the variation of the quantity.
    pub scale: f64,
    /// Unit of the quantity.
    pub unit: String,
    /// Time (s) until which the runs agree as requested; the end of the scene if they always do.
    pub known_until: f64,
    /// End of the scene (s).
    pub end: f64,
    /// Total number of runs.
    pub runs: usize,
    /// Relative tolerances of the two runs that were compared.
    pub rtol: [f64; 2],
}

impl Achieved {
    /// Whether the runs agree as requested.
    pub fn is_enough(&self) -> bool {
        self.difference <= self.asked
    }

    /// The warning that they do not.
    fn parted(&self) -> String {
        format!(
            "two runs with rtol {:.0e} and {:.0e} still differ by {} % in {} (asked: {} %), and are further apart than \
             that from t = {} s on: small errors grow there, as after impacts. Rely on the motion until then, and \
             later on energies and means alone",
            self.rtol[0],
            self.rtol[1],
            four_digits(100.0 * self.difference),
            self.quantity,
            four_digits(100.0 * self.asked),
            four_digits(self.known_until),
        )
    }
}

impl fmt::Display for Achieved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, asked, difference, scale, unit, runs, rtol, .. } = self;
        let [coarse, fine] = rtol;
        let (found, asked, scale) =
            (four_digits(100.0 * difference), four_digits(100.0 * asked), four_digits(*scale));
        write!(
            f,
            "{quantity} is known to {found} % of {scale} {unit} (asked: {asked} %): the difference of the last two of \
             {runs} runs, by rtol {coarse:.0e} and {fine:.0e}"
        )
    }
}

/// Report of one phase.
#[derive(Debug, Clone)]
pub struct PhaseReport {
    /// Name of the phase.
    pub name: String,
    /// Time reached (s).
    pub end: f64,
    /// The sensor that [ended](crate::Phase::ends_above) it before its time, if one did.
    pub ended_by: Option<String>,
    /// Unknowns of the integrator.
    pub states: usize,
    /// Wall-clock time (s).
    pub wall_seconds: f64,
    /// Method at the end of the phase: the requested one, or the choice of [`Method::Auto`].
    pub method: Method,
    /// Reason for the choice of that method, if it was chosen.
    pub reason: Option<String>,
    /// Steps, evaluations, factorizations.
    pub counts: Counts,
    /// When bodies began to slide, or to stick, under friction, if contact events are located.
    pub slips: Vec<SlipEvent>,
}

/// A body begins to slide on an obstacle, or to stick to it.
#[derive(Debug, Clone, PartialEq)]
pub struct SlipEvent {
    /// When (s).
    pub time: f64,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Whether all points in contact now exceed the [sticking speed](crate::Obstacle::sticking_speed), or are
    /// all slower.
    pub slides: bool,
}

impl Report {
    /// Total statistics of all phases. Size and order of the last step are those of the last phase; the notice is the
    /// first one.
    pub(crate) fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        self.phases.iter().for_each(|phase| counts.add(phase.counts.clone()));
        counts
    }

    /// Steps of all phases.
    pub fn steps(&self) -> usize {
        self.counts().steps
    }

    /// Evaluations of the right-hand side or residual in all phases.
    pub fn evaluations(&self) -> usize {
        self.counts().evaluations
    }

    /// Evaluations of the tangents of the forces in all phases.
    pub fn jacobian_evaluations(&self) -> usize {
        self.counts().jacobian_evaluations
    }

    /// Evaluations of forces for their tangents by finite differences in all phases.
    pub fn difference_evaluations(&self) -> usize {
        self.counts().difference_evaluations
    }

    /// Factorizations of the Newton matrix in all phases.
    pub fn factorizations(&self) -> usize {
        self.counts().factorizations
    }

    /// Iterations of conjugate gradients for Newton matrices in all phases.
    pub fn linear_iterations(&self) -> usize {
        self.counts().linear_iterations
    }

    /// Steps of all phases that were repeated because their error was too large.
    pub fn error_test_failures(&self) -> usize {
        self.counts().error_test_failures
    }

    /// Newton iterations of all phases that did not converge.
    pub fn convergence_failures(&self) -> usize {
        self.counts().convergence_failures
    }

    /// The warnings of the [`indicators`](Self::indicators), each with its remedy.
    pub fn doubts(&self) -> Vec<String> {
        warnings(&self.indicators)
    }

    /// Warnings: reasons to doubt the result, or a cause of a needlessly long run.
    ///
    /// They are the notices of the integrators, an energy balance that is off by more than a hundredth of the largest
    /// energy, a verified accuracy that is lower than requested and, once the run has ended, indicators beyond their
    /// limits: of the scene
    /// ([`Scene::warnings`](crate::Scene::warnings)), of the strain of its cells and of its contacts.
    pub fn warnings(&self) -> Vec<String> {
        self.named_warnings().into_iter().map(|(_, warning)| warning).collect()
    }

    /// The [warnings](Self::warnings), each with its name: that of its indicator, or `integrator`, `energy-balance`,
    /// `accuracy`.
    pub fn named_warnings(&self) -> Vec<(&'static str, String)> {
        let notice = |phase: &PhaseReport| {
            let notice = phase.counts.notice.as_ref()?;
            Some(("integrator", format!("phase \"{}\": {notice}", phase.name)))
        };
        let mut warnings: Vec<_> = self.phases.iter().filter_map(notice).collect();
        // the error of the balance is the larger of created and lost energy
        let doubt = match self.energy_error > self.energy_created {
            true => loss(self.energy_error, self.energy_scale),
            false => creation(self.energy_created, self.energy_scale),
        };
        warnings.extend(doubt.map(|doubt| {
            let help = "so the motion may be wrong: lower rtol, or choose another method";
            ("energy-balance", format!("{doubt}, {help}"))
        }));
        let achieved = self.achieved.as_ref().filter(|achieved| !achieved.is_enough());
        warnings.extend(achieved.map(|known| ("accuracy", known.parted())));
        let doubtful = self.indicators.iter().filter(|indicator| indicator.is_doubtful());
        warnings.extend(doubtful.map(|indicator| (indicator.name, indicator.text.clone())));
        warnings
    }
}

/// Error of the energy balance, as part of the largest energy, from which a result is doubtful.
const DOUBTFUL: f64 = 0.01;

/// The energy that the integrator has created, in words, if a rise of the energy balance by `created` (J) is
/// more than a hundredth of `scale`, the largest energy (J).
pub(crate) fn creation(created: f64, scale: f64) -> Option<String> {
    let part = created / scale;
    (part > DOUBTFUL).then(|| {
        format!(
            "the integrator created {created:.1e} J, {:.1} % of the largest energy",
            100.0 * part
        )
    })
}

/// The energy that the integrator has lost, in words, if a fall of the energy balance by `lost` (J) is more than a hundredth of
/// `scale`, the largest energy (J).
fn loss(lost: f64, scale: f64) -> Option<String> {
    let part = lost / scale;
    (part > DOUBTFUL).then(|| {
        format!("the integrator lost {lost:.1e} J, {:.1} % of the largest energy", 100.0 * part)
    })
}

impl fmt::Display for Report {
    /// A table of the phases and the sums over them, then errors of constraints and energy, remarks and
    /// warnings.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, rtol, alpha, states, .. } = self;
        write!(f, "{method}, rtol {rtol:.0e}, alpha {alpha:.0e} 1/s, {states} unknowns")?;
        self.plane.iter().try_for_each(|plane| write!(f, ", {plane}"))?;
        writeln!(f)?;
        writeln!(
            f,
            "{:12} {:>8} {:>8} {:>12} {:>15} {:>9} {:>9}",
            "phase", "end (s)", "steps", "evaluations", "factorizations", "rejected", "time (s)"
        )?;
        let rejected = |c: &Counts| c.error_test_failures + c.convergence_failures;
        for PhaseReport { name, end, wall_seconds, counts, .. } in &self.phases {
            let Counts { steps, evaluations, factorizations, .. } = counts;
            // the end of a run that stopped early may have all digits
            let mut end_text = end.to_string();
            if end_text.len() > 8 {
                end_text = format!("{end:.3e}");
            }
            let rejected = rejected(counts);
            writeln!(
                f,
                "{name:12} {end_text:>8} {steps:8} {evaluations:12} {factorizations:15} {rejected:9} \
                 {wall_seconds:9.4}"
            )?;
        }
        let (all, seconds) = (self.counts(), self.wall_seconds);
        let Counts { steps, evaluations, factorizations, .. } = all;
        let rejected = rejected(&all);
        writeln!(
            f,
            "{:12} {:8} {steps:8} {evaluations:12} {factorizations:15} {rejected:9} {seconds:9.4}",
            "all", ""
        )?;
        let Self { constraint_drift, energy_error, energy_scale, .. } = self;
        write!(
            f,
            "largest constraint drift {constraint_drift:.1e} m; energy balance off by at most \
             {energy_error:.1e} of {energy_scale:.1e} J"
        )?;
        let (differences, tangents) = (all.difference_evaluations, all.jacobian_evaluations);
        if differences > 0 {
            write!(
                f,
                "\ntangents of forces by finite differences: {differences} evaluations of these forces \
                 for {tangents} Newton matrices; `Force::add_tangents` saves them"
            )?;
        }
        for PhaseReport { name, reason, counts, slips, ended_by, end, .. } in &self.phases {
            let ended_by =
                ended_by.as_ref().map(|by| format!("ended by sensor \"{by}\" at t = {end} s"));
            let events = match counts.contact_events {
                0 => None,
                1 => Some("1 contact event located".to_owned()),
                count => Some(format!("{count} contact events located")),
            };
            let slips = slips_in_words(slips);
            let remarks = reason.as_deref().into_iter().chain(events.as_deref());
            let remarks = remarks.chain(slips.as_deref()).chain(ended_by.as_deref());
            let remarks: Vec<&str> = remarks.collect();
            if !remarks.is_empty() {
                write!(f, "\nphase \"{name}\": {}", remarks.join("; "))?;
            }
        }
        self.chosen.iter().try_for_each(|chosen| write!(f, "\nchosen: {chosen}"))?;
        if let Some(achieved) = &self.achieved {
            write!(f, "\n{achieved}")?;
        }
        self.reduced.iter().try_for_each(|reduced| write!(f, "\n{reduced}"))?;
        self.warnings().iter().try_for_each(|warning| write!(f, "\nWARNING: {warning}"))
    }
}

/// Number of transitions to sliding or sticking, and time of the first.
fn slips_in_words(slips: &[SlipEvent]) -> Option<String> {
    let of = |slides: bool| {
        let mut of_kind = slips.iter().filter(|slip| slip.slides == slides);
        let first = of_kind.next()?;
        let (count, what) = (1 + of_kind.count(), if slides { "slips" } else { "sticks" });
        let times = if count == 1 { "once" } else { &format!("{count} times") };
        Some(format!("{what} {times}, first at {:.4e} s", first.time))
    };
    let kinds: Vec<String> = [true, false].into_iter().filter_map(of).collect();
    (!kinds.is_empty()).then(|| kinds.join("; "))
}

/// Statistics of the integration of a phase.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Counts {
    /// Steps taken.
    pub steps: usize,
    /// Evaluations of the right-hand side or residual.
    pub evaluations: usize,
    /// Evaluations of the tangents of the forces, of which the Newton matrix is made; none where
    /// they are constant.
    pub jacobian_evaluations: usize,
    /// Evaluations of forces for tangents by finite differences, of forces without
    /// [`Force::add_tangents`](crate::elements::force::Force::add_tangents).
    pub difference_evaluations: usize,
    /// Factorizations of the Newton matrix.
    pub factorizations: usize,
    /// Iterations of conjugate gradients, by which systems with the Newton matrices of large solids are solved where that
    /// costs less than a factorization.
    pub linear_iterations: usize,
    /// Steps repeated because their error was too large.
    pub error_test_failures: usize,
    /// Newton iterations that did not converge (`rk`: steps refused by the right-hand side).
    pub convergence_failures: usize,
    /// Symbolic factorizations of the Newton matrix after the first, where bodies that touch couple other nodes.
    pub pattern_changes: usize,
    /// Contact events that were located.
    pub contact_events: usize,
    /// Size of the last step (s).
    pub last_step: f64,
    /// Order of the last step.
    pub last_order: u32,
    /// Notice of the integration, such as: stability, not accuracy, bounds the steps; Newton matrices were not positive
    /// definite.
    pub notice: Option<String>,
}

impl Counts {
    /// Adds the counts of a further part of the phase.
    pub(crate) fn add(&mut self, further: Counts) {
        self.steps += further.steps;
        self.evaluations += further.evaluations;
        self.jacobian_evaluations += further.jacobian_evaluations;
        self.difference_evaluations += further.difference_evaluations;
        self.factorizations += further.factorizations;
        self.linear_iterations += further.linear_iterations;
        self.error_test_failures += further.error_test_failures;
        self.convergence_failures += further.convergence_failures;
        self.pattern_changes += further.pattern_changes;
        self.contact_events += further.contact_events;
        (self.last_step, self.last_order) = (further.last_step, further.last_order);
        self.notice = self.notice.take().or(further.notice);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reported error of the balance is the larger of lost and created energy.
    #[test]
    fn energy_is_lost_or_created() {
        let told = |energy_error, energy_created| {
            let report =
                Report { energy_error, energy_created, energy_scale: 1.0, ..Report::default() };
            report.warnings()
        };
        assert!(told(0.009, 0.009).is_empty());
        let [lost] = &told(0.18, 0.016)[..] else { panic!() };
        assert!(lost.contains("lost 1.8e-1 J, 18.0 %") && !lost.contains("created"), "{lost}");
        let [created] = &told(0.18, 0.18)[..] else { panic!() };
        assert!(created.contains("created 1.8e-1 J, 18.0 %"), "{created}");
    }
}
