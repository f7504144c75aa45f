//! i. Large steps over short pulses.

use pliant::Method;

use crate::gallery::pulses::{Pulse, general};

const METHODS: [Method; 5] =
    [Method::CvodeBdf, Method::CvodeAdams, Method::Ida, Method::Arkode, Method::Rk];

#[test]
fn what_is_said_by_points_is_not_skipped() {
    for method in METHODS {
        for (width, vibrates) in [(0.1, false), (1e-3, true), (1e-5, false), (1e-5, true)] {
            let momentum = Pulse { width, told: true, vibrates }.momentum(method, 1e-5).unwrap();
            // ten times rtol
            assert!((momentum - 1.0).abs() < 1e-4, "{method} {width} {vibrates}: {momentum}");
        }
    }
}

#[test]
fn a_function_of_time_is_found() {
    for method in METHODS {
        for (width, vibrates) in [(0.1, false), (1e-3, false), (1e-3, true), (1e-4, false)] {
            let momentum = Pulse { width, told: false, vibrates }.momentum(method, 1e-5).unwrap();
            // a function has kinks, before which a step may end: 3.9e-3 by `ida` at 0.1 ms, by the others 6.5e-4 and less
            let limit = if method == Method::Ida { 5e-3 } else { 1e-3 };
            assert!((momentum - 1.0).abs() < limit, "{method} {width} {vibrates}: {momentum}");
        }
    }
}

#[test]
fn the_general_layer_has_to_be_told_as_well() {
    assert_eq!(general(1e-3, false, 1e-5).unwrap(), 0.0);
    // two rtol of the momentum
    assert!((general(1e-3, true, 1e-5).unwrap() - 1.0).abs() < 1e-4);
}
