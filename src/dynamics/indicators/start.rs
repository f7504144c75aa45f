//! Initial states that come from another scene.

use crate::dynamics::report::Indicator;
use crate::scene::timeline::Scene;

/// Unknowns that the scene or the state from which it starts does not have.
pub(super) fn lacking(scene: &Scene) -> Option<Indicator> {
    let lacking = scene.lacking_in_state();
    let beyond = || {
        format!(
            "the scene starts from a state that does not fit it whole: {}. If that is not meant, start from the state of a run of \
             the same scene by this version",
            lacking.join("; ")
        )
    };
    (!lacking.is_empty()).then(|| {
        let count = (lacking.len() as f64, "");
        Indicator::trusted("start-state", count, [0.0, 0.0], String::new, beyond)
    })
}
