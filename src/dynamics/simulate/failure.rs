//! Error messages of runs that do not reach their end.

use crate::base::input::four_digits;
use crate::dynamics::phase::Failed;
use crate::dynamics::report::Counts;
use crate::dynamics::trajectory::Interrupted;
use crate::integrators::common::{self, Cause};
use crate::scene::settings::Method;

/// Number of steps in a row that may be too small to advance time in double precision.
pub(super) const STANDING: usize = 100;

/// Mean step, in units of round-off of the time, below which a run makes no progress.
const CRAWLING: f64 = 16.0;

pub(super) fn standing_still(refusal: &str) -> Failed {
    let reason = cause_of_stall(refusal);
    format!("no progress: {STANDING} steps in a row too small to advance time: {reason}").into()
}

/// The error of `count` steps up to `time` (s) whose mean size is `step` (s), if that is too small for any
/// progress.
pub(super) fn crawling(count: usize, step: f64, time: f64, refusal: &str) -> Option<Failed> {
    let reason = cause_of_stall(refusal);
    (step < CRAWLING * f64::EPSILON * time.abs()).then(|| {
        format!(
            "no progress: {count} steps of {step:.1e} s in the mean, close to round-off: {reason}"
        )
        .into()
    })
}

fn cause_of_stall(refusal: &str) -> &str {
    match refusal {
        "" => {
            "the motion becomes singular: a part of the body has collapsed or is driven without limit, or a force is undefined \
             there (walls that have passed through each other, a contact, spring or load that is far too stiff or large); look at \
             the last samples, and at the forces near this time"
        }
        reason => reason,
    }
}

pub(super) fn too_many_steps(steps: usize, counts: &Counts) -> Failed {
    let reason = counts.notice.as_deref().unwrap_or("loosen rtol, or choose another method");
    format!("{steps} steps taken, as many as max_steps allows: {reason}").into()
}

pub(super) fn out_of_time(limit: f64, method: Method, counts: &Counts) -> Failed {
    let (limit, steps) = (four_digits(limit), counts.steps);
    let reason = counts.notice.as_deref().unwrap_or(
        "raise max_time, loosen rtol, choose another method or a coarser mesh, or continue from the state that was reached",
    );
    format!("the {limit} s of wall-clock time that max_time allows are used up ({method}, {steps} steps since the last start): {reason}")
        .into()
}

/// The error of an integrator in terms of mechanics, with the likely cause, which is the `doom` of the scene
/// if it has one, and what to try. Other errors remain as they are, with the `doom` added.
pub(super) fn in_mechanics(source: Failed, doom: Option<&str>) -> Failed {
    let Some(common::Error::Integration(error)) = source.downcast_ref() else {
        return match doom.filter(|_| !source.is::<Interrupted>()) {
            Some(doom) => format!("{source}; most likely as {doom}").into(),
            None => source,
        };
    };
    let (what, help) = match &error.cause {
        // the message of a force, or of a function of the scene
        Cause::Fatal(_) => match &error.source {
            Some(source) => return source.to_string().into(),
            None => return source,
        },
        Cause::Rejected { message, .. } => ("the time step collapsed", message.as_str()),
        Cause::NotFinite { .. } => (
            "forces grew beyond the range of double precision",
            "displacements have blown up: look for a load or a stiffness that is far too large",
        ),
        Cause::TooMuchAccuracy => {
            ("rtol asks for more digits than double precision has", "raise it")
        }
        Cause::ErrorTest | Cause::StandsStill { .. } => (
            "the time step collapsed",
            "a force changes too abruptly there: look for a contact, spring or damper that is far stiffer than the \
             body, or a load that jumps without a break",
        ),
        Cause::Convergence => (
            "no balance of forces was found at the end of a step of any size",
            "the body may buckle or collapse there, or a contact may be far stiffer than the body: lower the load, \
             soften the contact, or try another method",
        ),
        Cause::LinearSolver | Cause::LinearConvergence => (
            "the linear equations of a step are singular, or nearly so",
            "look for a part of the body that nothing holds, or a stiffness that is far too large or small",
        ),
        Cause::InconsistentStart => (
            "no start that satisfies the constraints was found",
            "look for constraints that contradict each other or the velocities at the start",
        ),
        Cause::TooManySteps { .. }
        | Cause::SignConstraint { .. }
        | Cause::MassMatrix
        | Cause::WrongJacobian { .. }
        | Cause::MissingEntry { .. }
        | Cause::WrongSolver
        | Cause::HigherIndex { .. }
        | Cause::Other => return source,
    };
    let help = doom.unwrap_or(help);
    format!("{what}: {help} ({}, order {})", error.integrator, error.order).into()
}
