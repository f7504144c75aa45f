//! Tolerances of runs that are repeated until two agree.

/// The tolerance of the first run, as part of the accuracy, and the loosest tolerance that is used.
const FIRST: f64 = 0.1;
const LOOSEST: f64 = 1e-3;
/// Ratio of each run's tolerance to the one before.
const TIGHTER: f64 = 0.1;
/// No tolerance is below this, where round-off dominates: methods that are chosen automatically get only a
/// part of it.
const TIGHTEST: f64 = 1e-11;

/// The relative tolerance of the first of the runs that are to agree to `accuracy`.
pub(crate) fn first(accuracy: f64) -> f64 {
    (FIRST * accuracy).clamp(TIGHTEST, LOOSEST)
}

/// The tolerance of the run after one with `rtol`.
pub(crate) fn tighter(rtol: f64) -> f64 {
    (TIGHTER * rtol).max(TIGHTEST)
}

/// Whether there is no tighter tolerance after `rtol`.
pub(crate) fn is_tightest(rtol: f64) -> bool {
    rtol < 2.0 * TIGHTEST
}
