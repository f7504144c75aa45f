//! a. Explicit Runge-Kutta methods on viscous bodies.

use pliant::{Inertia, Method, Sampling, Settings};

use crate::gallery::explicit::{LIMIT, UNTIL, at_fixed_steps, matrices, released, steps};

/// The stability polynomial of the method: Taylor's to z^5/120, and z^6/600.
#[test]
fn the_limit_is_that_of_the_polynomial() {
    let z = -LIMIT;
    let r = 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0 * (1.0 + z / 5.0))));
    let r = r + z.powi(6) / 600.0;
    // five digits of the limit
    assert!((r - 1.0).abs() < 1e-3, "{r}");
}

#[test]
fn just_beyond_the_limit_it_blows_up() {
    let body = matrices(4, 4e3, Inertia::Consistent).unwrap();
    let end = |part| *at_fixed_steps(&body, part, 300).unwrap().last().unwrap();
    assert!(end(0.99) < 1.0, "{}", end(0.99));
    assert!(end(1.02) > 1e6, "{}", end(1.02));
}

#[test]
fn steps_follow_the_spectral_radius() {
    for (nodes, viscosity) in [(4, 6.4e3), (4, 2.56e4), (7, 4e3)] {
        let scene = released(nodes, viscosity, Inertia::Consistent).unwrap();
        let rho =
            matrices(nodes, viscosity, Inertia::Consistent).unwrap().spectral_radius().unwrap();
        let explicit = steps(&scene, Method::Rk, 1e-3).unwrap() as f64;
        // some steps more for the start, where accuracy rules
        let part = explicit / (rho * UNTIL / LIMIT);
        assert!((0.99..1.05).contains(&part), "{nodes} {viscosity}: {part}");
        let implicit = steps(&scene, Method::CvodeBdf, 1e-3).unwrap();
        assert!(implicit < 200, "{nodes} {viscosity}: {implicit}");
        // the estimate before a run, from below
        let estimate = scene.spectrum().unwrap()[0].stiffest_rate() / rho;
        assert!((0.9..1.01).contains(&estimate), "{estimate}");
    }
}

#[test]
fn the_automatic_choice_is_implicit() {
    let scene = released(4, 2.56e4, Inertia::Consistent).unwrap();
    let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    assert_eq!(motion.report().phases[0].method, Method::CvodeBdf);
    let rk = Settings { method: Method::Rk, ..Settings::default() };
    let motion = scene.simulate(&rk, &Sampling::phase_ends()).unwrap();
    let notice = motion.report().phases[0].counts.notice.clone().unwrap();
    assert!(notice.contains("stability"), "{notice}");
}

/// Steps of 2/omega without viscosity, which leaves half of that at most.
#[test]
fn central_differences_live_by_the_highest_frequency() {
    let part = |nodes, viscosity| {
        let scene = released(nodes, viscosity, Inertia::Lumped).unwrap();
        let body = matrices(nodes, viscosity, Inertia::Lumped).unwrap();
        let taken = steps(&scene, Method::CentralDifference, 0.5).unwrap() as f64;
        taken / (0.5 * body.spectral_radius().unwrap() * UNTIL)
    };
    // accuracy asks for some steps more at the start
    let undamped = part(10, 0.0);
    assert!((1.0..1.4).contains(&undamped), "{undamped}");
    let viscous = part(4, 4e3);
    assert!((2.0..2.3).contains(&viscous), "{viscous}");
}
