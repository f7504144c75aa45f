//! Error messages of runs that do not reach their end.

use super::stepper::Failed;
use crate::report::Counts;

/// Steps in a row that may be too small to move time ahead in double precision.
pub(super) const STANDING: usize = 100;

pub(super) fn standing_still(refusal: &str) -> Failed {
    let reason = match refusal {
        "" => "the motion changes without end in no time: check the model near this time",
        reason => reason,
    };
    format!("{STANDING} steps, too small to move time ahead, have not led past this: {reason}")
        .into()
}

pub(super) fn too_many_steps(steps: usize, counts: &Counts) -> Failed {
    let reason = counts.notice.as_deref().unwrap_or("loosen rtol, or choose another method");
    format!("{steps} steps taken, as many as max_steps allows: {reason}").into()
}
