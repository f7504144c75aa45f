//! e. Penalty contact. Located events against closed forms: `tests/scenes/contact_events.rs`.

use pliant::{ContactEvents, Method};

use crate::gallery::contact::{
    bar, bar_contact, bar_force, error, exact_restitution, fall, penetration, restitution,
    rigid_penetration,
};

#[test]
fn a_soft_floor_gives_way_as_to_a_rigid_body() {
    let part = |stiffness| {
        let motion = fall(stiffness, Method::Rk, ContactEvents::StepOver, 1e-6).unwrap();
        penetration(&motion) / rigid_penetration(stiffness, motion.body().mass())
    };
    // the body's own springs carry some 1e4 N/m
    assert!((part(1e2) - 1.0).abs() < 0.01);
    assert!(part(1e5) < 0.8);
}

#[test]
fn stiff_floors_cost_steps_and_located_events_gain_digits() {
    let run = |stiffness, events| fall(stiffness, Method::Rk, events, 1e-4).unwrap();
    let steps = |stiffness| run(stiffness, ContactEvents::StepOver).report().steps();
    assert!(steps(1e6) as f64 > 1.5 * steps(1e3) as f64);
    for stiffness in [1e3, 1e4] {
        let exact = fall(stiffness, Method::CvodeAdams, ContactEvents::StepOver, 1e-9).unwrap();
        let [over, located] = [ContactEvents::StepOver, ContactEvents::Locate]
            .map(|events| error(&run(stiffness, events), &exact));
        assert!(located < 0.1 * over, "{stiffness}: {located} {over}");
    }
}

#[test]
fn damping_makes_the_bounce_that_the_closed_form_has() {
    for zeta in [0.05, 0.2, 0.6] {
        for adhesion in [true, false] {
            let (found, exact) =
                (restitution(zeta, adhesion).unwrap(), exact_restitution(zeta, adhesion));
            // the bar gives way by 1e-3 of what the floor does, and rings
            assert!((found - exact).abs() < 2e-3, "{zeta} {adhesion}: {found} {exact}");
        }
    }
}

/// Until the wave is back, at 2 L/c, a floor of stiffness h E A/L is pressed by 1 - exp(-h t c/L) of
/// E A v/c.
#[test]
fn a_bar_hits_the_floor_as_the_wave_equation_says() {
    for hardness in [1.0, 10.0] {
        let force = bar_force(&bar(hardness, 100).unwrap(), hardness);
        for &(t, force) in force.iter().take_while(|at| at.0 < 1.9) {
            // of 100 cells, the wave's front is some cells wide
            assert!(
                (force - (1.0 - (-hardness * t).exp())).abs() < 0.01,
                "{hardness} {t}: {force}"
            );
        }
    }
    let [time, impulse] = bar_contact(&bar_force(&bar(100.0, 100).unwrap(), 100.0));
    assert!((time - 2.0).abs() < 0.05 && (impulse - 1.0).abs() < 0.01, "{time} {impulse}");
}
