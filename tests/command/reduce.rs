//! `pliant reduce`: what it learns, writes and says, and what is refused.

use std::fs;

use serde_json::{Value, json};

use super::{Place, says, stderr, stdout};

/// A beam that a load bends; both phases are needed for a way back.
const SCENE: &str = r#"
[body]
mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [9, 3], cells = "triangles" }
thickness = 0.01
strain = "green"
material = { density = 1000.0, young = 1.0e5, poisson = 0.4, viscosity = 500.0 }

[[spring]]
name = "tendon"
ends = [9, { point = [0.2, -0.1] }]

[[phase]]
name = "pull"
until = 0.2
hold = [{ nodes = "left" }]
actuate = [{ springs = "tendon", force = 0.02 }]
"#;

const FORCE: &str = "phase.pull.actuate.1.force";

/// A file of a model of no scene at all.
fn stranger() -> String {
    let model = json!({
        "dofs": 54, "cell_count": 32, "phases": [], "cells": {}, "error": 0.01, "error_per_imbalance": 1.0,
        "within": 0.02, "travel": 0.1, "learned_from": "1 run",
    });
    json!({ "what": "pliant reduced model", "format": 1, "scene": [], "model": model }).to_string()
}

/// A model of a range of forces is within what was asked for, and runs by the file are what `--verify` says of them.
#[test]
fn a_model_is_learned_written_and_run() {
    let place = Place::new();
    let scene = place.scene(SCENE);
    let vary = format!("{FORCE}=0.005..0.02");
    let done = place.run(&["reduce", scene, "--within", "5%", "--vary", &vary]);
    assert!(done.status.success(), "{done:?}");
    says(&stdout(&done), &["unknowns", "speed-up", "learning it took", "scene.reduced"]);
    assert_eq!(
        place.files("."),
        [
            "scene-reduced.json",
            "scene-reduced.png",
            "scene-reduced.svg",
            "scene.reduced",
            "scene.toml"
        ]
    );
    let numbers: Value =
        serde_json::from_slice(&fs::read(place.path("scene-reduced.json")).unwrap()).unwrap();
    assert_eq!(numbers["is_within"], true);
    assert!(numbers["error"].as_f64().unwrap() <= 0.05);
    assert!(
        numbers["learned_from"].as_str().unwrap().contains(&format!("{FORCE} from 0.005 to 0.02"))
    );

    // a changed digit of a shape is noticed
    let mut changed = fs::read(place.path("scene.reduced")).unwrap();
    let shapes = changed.windows(8).position(|word| word == b"\"shapes\"").unwrap();
    let digit = changed[shapes..].iter().position(u8::is_ascii_digit).unwrap() + shapes + 4;
    assert!(changed[digit].is_ascii_digit());
    changed[digit] = if changed[digit] == b'9' { b'8' } else { changed[digit] + 1 };
    fs::write(place.path("changed.reduced"), changed).unwrap();
    let refused = place.run(&["check", scene, "--set", "solver.reduced=changed.reduced"]);
    assert_eq!(refused.status.code(), Some(2));
    says(&stderr(&refused), &["changed.reduced", "checksum"]);
    fs::remove_file(place.path("changed.reduced")).unwrap();

    let check = place.run(&["check", scene, "--set", "solver.reduced=scene.reduced"]);
    says(&stdout(&check), &["reduced", "unknowns", "learned from 5 runs"]);
    for flags in [["--reduced", "scene.reduced"], ["--set", "solver.reduced=scene.reduced"]] {
        let run = place.run(&[&["run", scene, "--step", "0.02"][..], &flags].concat());
        assert!(run.status.success(), "{run:?}");
        says(&stdout(&run), &["reduced model"]);
    }
    // a key that is outside of its range, and one that was the same in all runs that were learned from
    for (set, told) in [
        (format!("{FORCE}=0.03"), Some("phase.pull.actuate.force = 0.03 (learned: 0.005 to 0.02)")),
        ("gravity=[0.0, -0.5]".to_owned(), Some("gravity.2 = -0.5 (learned: not given)")),
        (format!("{FORCE}=0.01"), None),
    ] {
        let run = place.run(&["run", scene, "--reduced", "scene.reduced", "--set", &set]);
        let said = stdout(&run) + &stderr(&run);
        assert_eq!(said.contains("was not learned over"), told.is_some(), "{set}: {said}");
        told.into_iter().for_each(|told| says(&said, &[told]));
    }
    place.run(&["run", scene, "--step", "0.02", "--reduced", "scene.reduced", "--quiet"]);
    let reduced = place.table("out/scene").1;
    place.run(&["run", scene, "--step", "0.02", "--quiet"]);
    let full = place.table("out/scene").1;
    assert!(reduced.len() == full.len() && reduced != full);
    let verified = place.run(&[
        "reduce",
        scene,
        "--verify",
        "scene.reduced",
        "--within",
        "10%",
        "--vary",
        &vary,
    ]);
    assert!(verified.status.success(), "{verified:?}");
    says(&stdout(&verified), &["run 1: off by", "run 2: off by", "the run estimates"]);
}

/// Without a run of all unknowns: the error is an estimate, and everything says so.
#[test]
fn a_model_is_found_without_a_full_run() {
    let place = Place::new();
    let scene = place.scene(SCENE);
    let done = place.run(&["reduce", scene, "--within", "10%", "--modes"]);
    assert!(done.status.success(), "{done:?}");
    says(&stdout(&done), &["as its own runs tell", "no run of all unknowns", "--verify"]);
    assert!(!stdout(&done).contains("speed"), "{done:?}");
    let numbers: Value =
        serde_json::from_slice(&fs::read(place.path("scene-reduced.json")).unwrap()).unwrap();
    assert_eq!(
        (&numbers["is_estimate"], &numbers["full"]["seconds"]),
        (&json!(true), &Value::Null)
    );
    let run = place.run(&["run", scene, "--step", "0.02", "--reduced", "scene.reduced"]);
    says(&stdout(&run), &["estimated by this run, not verified with all unknowns"]);
    let verified = place.run(&["reduce", scene, "--verify", "scene.reduced", "--within", "10%"]);
    assert!(verified.status.success(), "{verified:?}");
    let both = place.run(&["reduce", scene, "--modes", "--verify", "scene.reduced"]);
    assert_eq!(both.status.code(), Some(2), "{both:?}");
}

/// One shape of a beam that is bent to large angles is not enough: the best model is written, and the code says so.
#[test]
fn a_model_that_is_not_good_enough_is_written_and_told_of() {
    let place = Place::new();
    let scene = place.scene(SCENE);
    let done = place
        .run(&["reduce", scene, "--within", "1e-6", "--most", "4", "--out", "models", "--quiet"]);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(1), "{said}");
    says(&said, &["no model of 4 unknowns at most is within", "--vary", "--most 8"]);
    assert!(place.path("models/scene.reduced").exists());
}

#[test]
fn what_cannot_be_reduced_is_refused_before_anything_runs() {
    let place = Place::new();
    let scene = place.scene(SCENE);
    fs::write(place.path("other.reduced"), stranger()).unwrap();
    fs::write(place.path("text.reduced"), "text").unwrap();
    let force = |range: &str| format!("{FORCE}={range}");
    for (flags, words) in [
        (
            vec!["--vary", &force("0.02..0.005")],
            &["range of phase.pull", "least value to the largest"][..],
        ),
        (vec!["--vary", &force("0.02")], &["KEY=LEAST..MOST"]),
        (vec!["--vary", &force("0..0.02:1")], &["two values at least"]),
        (vec!["--vary", &force("0..1"), "--vary", &force("0..2")], &["has a range already"]),
        (vec!["--vary", "phase.pull.actuat.1.force=0..1"], &["actuat", "did you mean"]),
        (
            vec!["--vary", "body.material.young=1e5..2e5"],
            &["body.material.young", "changes the materials"],
        ),
        (vec!["--vary", "solver.rtol=1e-5..1e-3"], &["solver.rtol", "does not change the motion"]),
        (vec!["--within", "150%"], &["150%", "above 0 and below 1"]),
        (vec!["--verify", "none.reduced"], &["none.reduced", "No such file"]),
        (vec!["--verify", "text.reduced"], &["text.reduced", "damaged or cut off"]),
        (
            vec!["--verify", "other.reduced"],
            &["other.reduced", "positions of the nodes", "run `pliant reduce`"],
        ),
    ] {
        let done = place.run(&[&["reduce", scene][..], &flags].concat());
        assert_eq!(done.status.code(), Some(2), "{flags:?}: {done:?}");
        says(&String::from_utf8_lossy(&done.stderr), words);
    }
    for command in ["run", "play"] {
        let done = place.run(&[command, scene, "--reduced", "other.reduced"]);
        assert_eq!(done.status.code(), Some(2), "{done:?}");
        says(&String::from_utf8_lossy(&done.stderr), &["other.reduced", "positions of the nodes"]);
    }
    let done = place.run(&["check", scene, "--set", "solver.reduced=other.reduced"]);
    says(
        &String::from_utf8_lossy(&done.stderr),
        &["--set:1: solver.reduced", "positions of the nodes"],
    );
    assert_eq!(place.files("."), ["other.reduced", "scene.toml", "text.reduced"]);
}
