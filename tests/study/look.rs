//! A first look at a scene.

use pliant::samples::square_jump;
use pliant::study::Look;
use pliant::{Error, Indicator, Sampling, Settings, Verdict};

#[test]
fn a_look_at_a_whole_scene() {
    let scene = square_jump(4).unwrap();
    let look = Look::of(&scene, &Settings::default(), 60.0).unwrap();
    assert_eq!((look.until(), look.cause()), (scene.end(), None));
    // the same as a run by these settings measures
    let coarse = Settings { rtol: 1e-2, ..Settings::default() };
    let motion = scene.simulate(&coarse, &Sampling::every(scene.end() / 200.0)).unwrap();
    assert_eq!(look.indicators(), motion.indicators());
    let doubts: Vec<&str> =
        look.indicators().iter().filter(|i| i.is_doubtful()).map(|i| i.name).collect();
    assert_eq!(
        doubts,
        [
            "poisson",
            "turn",
            "stiffness-of-cells",
            "depth",
            "strain",
            "cells-in-a-wave",
            "depth-of-way"
        ]
    );
    // warnings are among them
    let warnings = motion.report().doubts();
    let is_told = |text: &String| look.indicators().iter().any(|indicator| indicator.text == *text);
    assert!(warnings.len() == 4 && warnings.iter().all(is_told), "{warnings:?}");
    let lines: Vec<String> = look.indicators().iter().map(Indicator::to_string).collect();
    assert_eq!(look.to_string(), lines.join("\n"));

    let data = look.to_json();
    assert_eq!(data["until"], scene.end());
    let turn =
        data["indicators"].as_array().unwrap().iter().find(|one| one["name"] == "turn").unwrap();
    let own = look.indicators().iter().find(|one| one.name == "turn").unwrap();
    assert_eq!((&turn["value"], &turn["verdict"]), (&own.value.into(), &"doubtful".into()));
    assert_eq!((&turn["limits"][0], &turn["limits"][1]), (&0.0.into(), &10.0.into()));
    let told =
        data["indicators"].as_array().unwrap().iter().find(|one| one["name"] == "damping").unwrap();
    assert!(told["limits"][0].is_null() && told["limits"][1].is_null(), "{told}");
}

/// A look that ends early tells when and why, and about what it saw.
#[test]
fn a_look_at_a_part() {
    let scene = square_jump(4).unwrap();
    let look = Look::of(&scene, &Settings::default(), 1e-9).unwrap();
    assert!(look.until() > 0.0 && look.until() < 0.1 * scene.end(), "{}", look.until());
    assert_eq!(look.cause(), Some("1e-9 s of computing"));
    assert!(look.to_string().starts_with("looked at until t = "), "{look}");
    let poisson = look.indicators().iter().find(|one| one.name == "poisson").unwrap();
    assert_eq!(poisson.verdict, Verdict::Doubtful);
    // what it did not come to is not told
    assert!(look.indicators().iter().all(|one| one.name != "distance"), "{look}");
    // nor what compares with a way that is not yet gone
    assert!(look.indicators().iter().all(|one| one.name != "tolerance"), "{look}");
    for seconds in [0.0, -1.0, f64::NAN] {
        let result = Look::of(&scene, &Settings::default(), seconds);
        assert!(matches!(&result, Err(Error::Input(_))), "{result:?}");
    }
}
