//! Reliability of a run by a reduced model.

use crate::base::input::percent;
use crate::dynamics::report::{Indicator, ReducedReport};

/// Multiple of the error that was wanted from which a run is doubtful: what it tells is an estimate.
const TIMES_WANTED: f64 = 2.0;
/// Part of the widest range of a shape by which a state may be outside of those learned from.
const MOST_OUTSIDE: f64 = 0.05;
/// Part of what was wanted by which the error that a run tells may differ from that of the one that the model was learned from, if it is
/// that run: methods and tolerances may be others.
const SAME_RUN: f64 = 0.05;

/// The most keys that are named.
const MOST_KEYS: usize = 5;

/// The error that the run tells, how far it was outside of what the model has learned, whether that was another run, and keys that it has not learned.
pub(crate) fn reduced(run: &ReducedReport) -> Vec<Indicator> {
    let limit = TIMES_WANTED * run.within;
    let said = format!(
        "the estimated error of the reduced model is {} of the largest displacement (limit: {})",
        percent(run.estimated_error),
        percent(limit)
    );
    let beyond =
        || format!("{said}: reduce the scene with runs such as this one, or run it unreduced");
    let value = (run.estimated_error, "1");
    let error = Indicator::trusted("reduced-error", value, [0.0, limit], || said.clone(), beyond);
    let said = format!(
        "the motion is outside of those that the reduced model has learned by {} of their range (limit: {})",
        percent(run.outside),
        percent(MOST_OUTSIDE)
    );
    let beyond =
        || format!("{said}: reduce the scene with a wider range (--vary), or run it unreduced");
    let value = (run.outside, "1");
    let range =
        Indicator::trusted("reduced-range", value, [0.0, MOST_OUTSIDE], || said.clone(), beyond);
    let other = run.apart_from_one_run().map(|apart| {
        let said = format!(
            "the reduced model was learned from one run, off by {}; this one tells {}",
            percent(run.checked_error),
            percent(run.estimated_error)
        );
        let beyond = || {
            format!(
                "{said}: it is another run, or not all of that, and may be off by many times what it tells: reduce the scene \
                 over a range (--vary), or have a run such as this one checked (pliant reduce --verify)"
            )
        };
        let value = (apart, "1");
        Indicator::trusted("reduced-one-run", value, [0.0, SAME_RUN], || said.clone(), beyond)
    });
    let unlearned = (!run.unlearned.is_empty()).then(|| {
        let first: Vec<&str> = run.unlearned.iter().take(MOST_KEYS).map(String::as_str).collect();
        let others = match run.unlearned.len() - first.len() {
            0 => String::new(),
            others => format!(" and {others} more"),
        };
        let beyond = || {
            format!(
                "the reduced model was not learned over {}{others} (limit: no such key): it may be off by many times the {} that this run \
                 tells; reduce the scene over a range of these keys (--vary), or have a run such as this one checked (pliant reduce --verify)",
                first.join(", "),
                percent(run.estimated_error)
            )
        };
        let value = (run.unlearned.len() as f64, "");
        Indicator::trusted("reduced-keys", value, [0.0, 0.0], String::new, beyond)
    });
    [error, range].into_iter().chain(other).chain(unlearned).collect()
}
