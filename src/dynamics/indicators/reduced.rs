//! Reliability of a run by a reduced model.

use crate::base::input::percent;
use crate::dynamics::report::{Indicator, ReducedReport};

/// Multiple of the requested error from which a run is doubtful, as its own error is an estimate.
const TIMES_WANTED: f64 = 2.0;
/// Fraction of the widest range of a shape by which a state may be outside the training range.
const MOST_OUTSIDE: f64 = 0.05;
/// Fraction of the requested error by which the estimated error of a run may differ from that of the training run, if both are the
/// same run: methods and tolerances may differ.
const SAME_RUN: f64 = 0.05;

/// The most keys that are named.
const MOST_KEYS: usize = 5;

/// The estimated error, the extrapolation beyond the training range, whether the training run was another one, and keys without training.
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
        "the motion leaves the training range of the reduced model by {} of that range (limit: {})",
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
            "the reduced model was learned from one run, with an error of {}; the estimated error of this run is {}",
            percent(run.checked_error),
            percent(run.estimated_error)
        );
        let beyond = || {
            format!(
                "{said}: it is another run, or only a part of that one, and its error may be many times the estimate: reduce the \
                 scene over a range (--vary), or have such a run checked (pliant reduce --verify)"
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
                "the reduced model was not learned over {}{others} (limit: no such key): its error may be many times the estimated {}; \
                 reduce the scene over a range of these keys (--vary), or have such a run checked (pliant reduce --verify)",
                first.join(", "),
                percent(run.estimated_error)
            )
        };
        let value = (run.unlearned.len() as f64, "");
        Indicator::trusted("reduced-keys", value, [0.0, 0.0], String::new, beyond)
    });
    [error, range].into_iter().chain(other).chain(unlearned).collect()
}
