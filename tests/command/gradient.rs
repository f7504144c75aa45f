//! `pliant gradient`: what it writes, and that it writes nothing of bad input.

use std::fs;

use serde_json::Value;

use super::{Place, says, stderr, stdout};

/// A bar of one element, pulled from rest.
const BAR: &str = r#"
body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 20.0 } }
phase = { name = "pull", until = 0.05, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
sensor = { name = "tip", kind = "displacement", nodes = "right" }
"#;

#[test]
fn derivatives_are_printed_and_written() {
    let place = Place::new();
    let scene = place.scene(BAR);
    let by = "body.material.young,phase.pull.load.force.1";
    let ran = place.run(&["gradient", scene, "--of", "tip.x", "--by", by, "--check", "--out", "g"]);
    assert!(ran.status.success(), "{}", stderr(&ran));
    says(
        &stdout(&ran),
        &["tip.x:end = 1.61", "by body.material.young", "m/Pa", "whole runs", "adjoint"],
    );
    let text = fs::read_to_string(place.path("g/gradient.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let force = &record["gradient"]["phase.pull.load.force.1"];
    let number = |value: &Value| value.as_f64().unwrap();
    // the bar is linear
    let exact = number(&record["value"]) / 0.1;
    assert!((number(&force["value"]) - exact).abs() < 1e-6 * exact, "{force}");
    assert_eq!(force["unit"], "m/N");
    assert_eq!([&force["meaningful"], &force["depends"]], [true, true]);
    assert!(number(&force["check"]["error"]) < 1e-5 * exact, "{force}");
    // two runs, and their steps taken back
    assert_eq!(number(&record["runs"]), 4.0);
    assert!((1.0..20.0).contains(&number(&record["cost"])), "{record}");
}

#[test]
fn bad_input_leaves_no_gradient() {
    let place = Place::new();
    let scene = place.scene(BAR);
    let arguments = |of: &'static str, by: &'static str| {
        ["gradient", scene, "--of", of, "--by", by, "--out", "g", "--quiet"]
    };
    assert!(place.run(&arguments("tip.x", "body.material.young")).status.success());
    for (of, by, words) in [
        ("top.x", "body.material.young", "top.x"),
        ("tip.x", "body.material.young,body.strain", "body.strain"),
        ("tip.x", "body.mesh.nodes", "no value next to this one"),
    ] {
        let ran = place.run(&arguments(of, by));
        assert_eq!(ran.status.code(), Some(2));
        says(&stderr(&ran), &[words]);
        assert!(!place.path("g/gradient.json").exists(), "{of} by {by}");
    }
    let both =
        [&arguments("tip.x", "body.material.young")[..], &["--static", "--method", "same-steps"]];
    says(&stderr(&place.run(&both.concat())), &["equilibria have no steps", "adjoint"]);
}
