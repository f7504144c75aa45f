//! Tables that end before their phase begins.

use crate::base::input::four_digits;
use crate::dynamics::report::Indicator;
use crate::scene::timeline::Scene;

/// Their number, and a description of the first.
pub(super) fn tables(scene: &Scene) -> Option<Indicator> {
    let early = scene.early_tables();
    let first = early.first()?;
    let beyond = || {
        let [before, behind] = first.values.map(four_digits);
        format!(
            "{} in phase \"{}\" is a step from {before} to {behind} where the phase begins, at t = {} s: its table ends before, at {} s \
             ({} such table(s), limit: 0); times count from the start of the run, not from that of the phase",
            first.of,
            first.phase,
            four_digits(first.start),
            four_digits(first.last),
            early.len()
        )
    };
    let count = (early.len() as f64, "");
    Some(Indicator::trusted("early-table", count, [0.0, 0.0], String::new, beyond))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::timeline::Phase;
    use crate::studies::samples::square_jump;

    fn told_of(times: [f64; 2], before: bool) -> Vec<String> {
        let first = Phase::until(1.0);
        let first = if before { first.load("top", [0.0, 0.2]) } else { first };
        let second = Phase::until(2.0).named("later");
        let second = second.load_table("top", times, [[0.0, 0.0], [0.0, 0.2]]);
        let scene = Scene::new(square_jump(4).unwrap().body().clone()).phase(first).phase(second);
        tables(&scene).into_iter().map(|told| told.text).collect()
    }

    /// A table of the times within its phase, mistaken for those since the start of the run, is reported; one that continues the last
    /// phase ended, or begins within its phase, is not.
    #[test]
    fn tables_that_are_over_are_told() {
        let told = told_of([0.0, 0.5], false);
        assert!(
            told[0].contains("the load on \"top\" in phase \"later\" is a step from 0 to 0.2"),
            "{told:?}"
        );
        assert!(told_of([0.0, 0.5], true).is_empty());
        assert!(told_of([1.0, 1.5], false).is_empty());
    }
}
