//! f. The index of the equations.

use crate::gallery::forms::Form;
use crate::gallery::index::{pendulum, pressed, refusals, square};

#[test]
fn index_three_fails() {
    for tested in [true, false] {
        assert!(pendulum(Form::Three, tested, 1e-6, 5).unwrap().failure.is_some(), "{tested}");
    }
}

#[test]
fn stabilized_forms_keep_the_length() {
    let drift = |form, tested| {
        let run = pendulum(form, tested, 1e-5, 5).unwrap();
        assert_eq!(run.failure, None, "{form:?}");
        run.drift
    };
    let stabilized = drift(Form::StabilizedTwo, false).max(drift(Form::StabilizedOne, true));
    // ten times rtol
    assert!(stabilized < 1e-4, "{stabilized}");
    let plain = drift(Form::One, true);
    assert!(plain > 5.0 * stabilized, "{plain} {stabilized}");
}

/// A body with 12 nodal rows: the same motion and the same reading of the probe as its scene, but for
/// index 3.
#[test]
fn a_body_in_the_forms_that_work_moves_as_its_scene() {
    let exact = pressed().unwrap();
    for (form, tested) in [(Form::StabilizedTwo, false), (Form::StabilizedOne, true)] {
        let run = square(form, tested, 1e-4, &exact).unwrap();
        assert_eq!(run.failure, None, "{form:?}");
        // of 4 cm; ten times rtol in the multiplier
        assert!(run.error < 1e-5 && run.multiplier_error < 1e-3, "{form:?}: {run:?}");
    }
    assert!(square(Form::Three, true, 1e-4, &exact).unwrap().failure.is_some());
}

#[test]
fn starts_that_contradict_the_equations_are_refused() {
    for message in refusals().unwrap() {
        assert!(message.contains("initial values do not satisfy the equations"), "{message}");
    }
}
