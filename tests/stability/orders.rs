//! c. BDF near the imaginary axis. That a cap of 3 runs away, that the report says so, and that the
//! automatic choice does not: `tests/scenes/auto.rs`.

use pliant::{Method, Sampling, Settings};

use crate::gallery::orders::{CRITICAL, LinearBeam, bdf, beam, reference};

/// The border of stability of BDF of order k is z = sum (1 - e^-ia)^j / j, j = 1 to k; damping ratios
/// on it are -Re z/|z|.
#[test]
fn critical_damping_ratios_follow_from_the_formulas() {
    for (order, critical) in (3..).zip(CRITICAL) {
        let ratio = |a: f64| {
            let (re, im) = (1.0 - a.cos(), a.sin());
            let (mut z, mut power) = ((0.0, 0.0), (1.0, 0.0));
            for j in 1..=order {
                power = (power.0 * re - power.1 * im, power.0 * im + power.1 * re);
                z = (z.0 + power.0 / f64::from(j), z.1 + power.1 / f64::from(j));
            }
            -z.0 / z.0.hypot(z.1)
        };
        let largest = (1..100_000).map(|k| ratio(f64::from(k) * 3e-5)).fold(0.0, f64::max);
        // angles are known to 0.01 degrees
        assert!((largest - critical).abs() < 2e-4, "{order}: {largest}");
    }
}

#[test]
fn without_damping_order_two_walks_and_order_five_crawls() {
    let scene = beam([36, 3], 0.0, 1.0).unwrap();
    let exact = reference(&scene, 1e-3).unwrap();
    let two = bdf(&scene, 2, 1e-3, 5000, &exact).unwrap();
    assert!(two.time == 1.0 && two.steps < 500 && two.error < 0.05, "{two:?}");
    let five = bdf(&scene, 5, 1e-3, 5000, &exact).unwrap();
    assert!(five.time < 0.6, "{five:?}");
}

#[test]
fn with_damping_order_five_is_the_better_one() {
    let scene = beam([36, 3], 0.03, 1.0).unwrap();
    let exact = reference(&scene, 1e-3).unwrap();
    let [two, five] = [2, 5].map(|order| bdf(&scene, order, 1e-3, 5000, &exact).unwrap());
    assert!(five.error < 0.5 * two.error, "{two:?} {five:?}");
    assert!(five.steps < 2 * two.steps, "{two:?} {five:?}");
}

/// It lowers the order where damping is next to none; not enough to come near a cap of 2.
#[test]
fn stability_limit_detection_does_not_replace_the_cap() {
    let light = LinearBeam::new([21, 2], 1e-4).unwrap();
    let (two, ..) = light.bdf(2, false, 1e-4).unwrap().unwrap();
    let (detecting, _, reductions) = light.bdf(5, true, 1e-4).unwrap().unwrap();
    assert!(reductions > 0 && detecting > 2 * two, "{reductions} {detecting} {two}");
    let strong = LinearBeam::new([21, 2], 0.03).unwrap();
    let [with, without] = [true, false].map(|on| strong.bdf(5, on, 1e-4).unwrap().unwrap());
    assert_eq!((with.0, with.2), (without.0, 0));
}

/// The setting reaches CVODE: orders that are unstable where damping is next to none cost steps, which
/// the detection saves; where there is more damping it changes nothing.
#[test]
fn scenes_are_integrated_with_the_detection() {
    let steps = |ratio: f64, stability_limit_detection: bool| {
        let (method, rtol) = (Method::CvodeBdf, 1e-5);
        let settings = Settings { method, rtol, stability_limit_detection, ..Settings::default() };
        let scene = beam([22, 3], ratio, 1.0).unwrap();
        scene.simulate(&settings, &Sampling::phase_ends()).unwrap().report().steps()
    };
    let [light, strong] = [1e-4, 0.03].map(|ratio| [true, false].map(|on| steps(ratio, on)));
    println!("{light:?} {strong:?}");
    assert!(10 * light[0] < 9 * light[1] && strong[0] == strong[1], "{light:?} {strong:?}");
}
