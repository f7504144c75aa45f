//! b. The stabilization rate alpha.

use pliant::Method;

use crate::gallery::alpha::{SPEED, drift, square};
use crate::gallery::explicit::LIMIT;

#[test]
fn without_stabilization_the_pendulum_forgets_its_length() {
    let last = |alpha| *drift(alpha, 0.0, 20).unwrap().0.last().unwrap();
    assert!(last(0.0) > 0.1, "{}", last(0.0));
    assert!(last(10.0) < 1e-4, "{}", last(10.0));
}

/// R = R'(0) t: after 2 s with R' = 0.1 m/s, |x|^2 = 1.4.
#[test]
fn an_inconsistent_start_stays_without_stabilization() {
    let off = drift(0.0, 0.1, 1).unwrap().0[0];
    // rtol 1e-4 lets the length drift by 2 mm in this time
    assert!((off - (1.4_f64.sqrt() - 1.0)).abs() < 5e-3, "{off}");
    let off = drift(100.0, 0.1, 1).unwrap().0[0];
    assert!(off < 2e-6, "{off}");
}

/// R = v t exp(-alpha t).
#[test]
fn a_jump_of_the_rate_leaves_its_mark_unless_it_is_projected() {
    for alpha in [1e3, 1e5] {
        let expected = SPEED / std::f64::consts::E / alpha;
        let (_, met) = square(Method::CvodeBdf, alpha, false).unwrap();
        // seen at the ends of steps only, near the maximum
        assert!((0.98..1.001).contains(&(met / expected)), "{alpha}: {met} {expected}");
        let (_, met) = square(Method::CvodeBdf, alpha, true).unwrap();
        assert!(met < 1e-15, "{alpha}: {met}");
    }
}

#[test]
fn a_large_alpha_costs_explicit_steps_only() {
    let steps = |method, alpha| square(method, alpha, true).unwrap().0 as f64;
    let part = steps(Method::Rk, 1e5) / (0.1 * 1e5 / LIMIT);
    assert!((0.99..1.05).contains(&part), "{part}");
    for method in [Method::CvodeBdf, Method::Ida, Method::Arkode] {
        let part = steps(method, 1e8) / steps(method, 1e2);
        // other round-off, other steps: IDA takes some more
        assert!((0.8..1.3).contains(&part), "{method}: {part}");
    }
}

#[test]
fn no_stabilization_is_refused_by_name() {
    let message = square(Method::Rk, 0.0, true).unwrap_err().to_string();
    assert!(message.contains("alpha = 0"), "{message}");
}
