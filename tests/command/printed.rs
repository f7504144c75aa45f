//! Summaries, lists and pages that the command prints, and the scenes to start from.

use std::fs;

use pliant::Method;
use serde_json::Value;

use super::{Place, bar, says, shipped, stderr, stdout};

#[test]
fn check_prints_what_a_scene_contains() {
    let place = Place::new();
    let output = place.run(&["check", &shipped("ring-springs.toml")]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let text = stdout(&output);
    // 32 x 3 nodes and the mass in the middle, two triangles in each of 32 x 2 quadrangles
    says(&text, &["97 nodes (64 on the boundary)", "128 cells (triangle)", "194 displacements"]);
    says(&text, &["gravity", "-9.8", "springs", "A1, A2", "A8", "obstacles", "floor", "mass (1)"]);
    says(&text, &["green strain, natural viscosity", "rtol", "atol", "alpha", "fastest (1/s)"]);
    says(&text, &["phase ", "A3 and A7 ", "actuators of A2, A6; contact with floor"]);
    assert_eq!(place.files("."), Vec::<String>::new());

    let text = stdout(&place.run(&["check", &shipped("square-jump.toml")]));
    let row = |name: &str| -> Vec<&str> {
        text.lines().find(|line| line.starts_with(name)).unwrap().split_whitespace().collect()
    };
    // bottom and two nodes of the top are held in the first two phases
    assert_eq!(row("push")[1..4], ["0", "0.5", "12"]);
    assert_eq!(row("hold")[1..4], ["0.5", "1", "12"]);
    assert_eq!(row("free")[1..4], ["1", "1.5", "0"]);
    assert_eq!(row("free")[7..], ["contact", "with", "floor"]);
    // its greatest eigenvalue, by an independent program; the estimate is some per cent below
    let fastest: f64 = row("push")[4].parse().unwrap();
    assert!((0.95 * 4.6e3..4.6e3).contains(&fastest), "{fastest}");
    says(&text, &["every 0.01 s"]);
    // a bar that swings along itself, a quarter wave in its length: 4 L sqrt(rho/E) = 56.6 ms, and
    // 0.4 % less on five cells, (k h)^2/24
    let text = stdout(&place.run(&["check", place.scene(&bar(1.0))]));
    says(&text, &["5.63", "loads on 1 node(s)", "6 displacements"]);
    assert!(!text.contains("note:") && !text.contains("gravity"), "{text}");
    // where a phase has its own
    let falling = bar(1.0).replace("dimension = 1", "dimension = 1\ngravity = [-1.0]");
    let checked = ["check", place.scene(&falling), "--set", "phase.pull.gravity=[-2.5]"];
    says(
        &stdout(&place.run(&checked)),
        &["gravity    [-1.0] m/s^2", "  gravity [-2.5] m/s^2; loads on"],
    );
    let same = ["check", place.scene(&falling), "--set", "phase.pull.gravity=[-1.0]"];
    assert_eq!(stdout(&place.run(&same)).matches("gravity").count(), 1);
    let old = fs::read_to_string(shipped("problem-4.toml")).unwrap();
    let old = old.replace("\ntangential_damping =", "\nfriction =");
    let text = stdout(&place.run(&["check", place.scene(&old)]));
    says(&text, &["note: line 29: obstacle.friction is read as tangential_damping"]);
}

#[test]
fn methods_are_listed() {
    let output = Place::new().run(&["methods"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let text = stdout(&output);
    assert_eq!(text.lines().count(), Method::ALL.len());
    for (line, method) in text.lines().zip(Method::ALL) {
        assert!(
            line.starts_with(method.name()) && line.contains(method.information().purpose),
            "{line}"
        );
    }
    assert_eq!(text.matches("[default]").count(), 1);
}

/// Scenes to start from are right, say nothing of doubt, and are never written over.
#[test]
fn new_writes_scenes_that_run() {
    let place = Place::new();
    for kind in ["square", "ring", "finger", "cantilever", "blank"] {
        let file = format!("{kind}.toml");
        says(&stdout(&place.run(&["new", kind])), &["written to", &file, "pliant run"]);
        assert_eq!(place.run(&["check", &file]).status.code(), Some(0), "{kind}");
        let output = place.run(&["run", &file, "--rtol", "1e-3"]);
        assert_eq!(output.status.code(), Some(0), "{kind}: {}", stderr(&output));
        assert!(!stdout(&output).contains("WARNING"), "{kind}: {}", stdout(&output));
        let again = place.run(&["new", kind]);
        assert_eq!(again.status.code(), Some(2));
        says(&stderr(&again), &[&file, "is there already", "name another file"]);
    }
    assert_eq!(place.run(&["new", "blank", "mine.toml"]).status.code(), Some(0));
    assert_eq!(place.run(&["static", "cantilever.toml"]).status.code(), Some(0));
    assert_eq!(place.run(&["new", "pyramid"]).status.code(), Some(2));
}

/// `docs/reference.md` is what the command prints. Made anew by `pliant reference > docs/reference.md`.
#[cfg(feature = "play")]
#[test]
fn the_reference_is_up_to_date() {
    let printed = stdout(&Place::new().run(&["reference"]));
    let page = include_str!("../../docs/reference.md");
    let apart = page.lines().zip(printed.lines()).find(|(old, new)| old != new);
    assert_eq!(apart, None);
    assert_eq!(page.len(), printed.len());
}

/// `docs/scene.schema.json`, made anew by `pliant schema > docs/scene.schema.json`.
#[test]
fn the_schema_is_up_to_date() {
    let printed = stdout(&Place::new().run(&["schema"]));
    assert_eq!(include_str!("../../docs/scene.schema.json"), printed);
    let schema: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(schema["properties"]["phase"]["anyOf"][0]["$ref"], "#/definitions/[[phase]]");
}
