//! Tolerances of runs that are repeated until two agree.

/// The tolerance of the first run, as part of the accuracy, and the loosest there is.
const FIRST: f64 = 0.1;
const LOOSEST: f64 = 1e-3;
/// What each run's tolerance is of the one before.
const TIGHTER: f64 = 0.1;
/// No tolerance below: round-off rules there, as methods that are chosen are given a part of it.
const TIGHTEST: f64 = 1e-11;

/// The relative tolerance of the first of the runs that are to agree to `accuracy`.
pub(super) fn first(accuracy: f64) -> f64 {
    (FIRST * accuracy).clamp(TIGHTEST, LOOSEST)
}

/// That of the run after one with `rtol`.
pub(super) fn tighter(rtol: f64) -> f64 {
    (TIGHTER * rtol).max(TIGHTEST)
}

/// Whether there is none after one with `rtol`.
pub(super) fn is_tightest(rtol: f64) -> bool {
    rtol < 2.0 * TIGHTEST
}
