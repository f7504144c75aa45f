//! `pliant optimize`: what it writes, that the scene that it writes has the value that it tells, and that it writes nothing of bad input.

use std::fs;

use serde_json::Value;

use super::{Place, says, stderr, stdout};

/// A bar of one element.
const BAR: &str = r#"
body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 20.0 } }
phase = { name = "pull", until = 0.01, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
sensor = { name = "tip", kind = "displacement", nodes = "right" }
"#;

/// A bar that is stretched by F L / (E A): by 5 mm where E is 2e4 Pa.
#[test]
fn an_optimum_is_written_and_runs() {
    let place = Place::new();
    let scene = place.scene(BAR);
    let by = "body.material.young=1e3..1e6";
    let ran = place.run(&[
        "optimize",
        scene,
        "--static",
        "--of",
        "tip.x",
        "--by",
        by,
        "--goal",
        "5e-3",
        "--out",
        "o",
        "--plot",
        "o/way.svg",
    ]);
    assert!(ran.status.success(), "{}", stderr(&ran));
    let told = stdout(&ran);
    says(
        &told,
        &["tip.x: 1.000000e-3 m before, 5.0000", "body.material.young = 2.00000e4", "an optimum"],
    );
    let text = fs::read_to_string(place.path("o/optimum.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let young = &record["numbers"]["body.material.young"];
    assert!((number(&young["value"]) - 2e4).abs() < 0.01, "{young}");
    assert_eq!([&young["before"], &young["at"]], [&Value::from(1e5), &Value::Null]);
    let after = number(&record["of"][0]["after"]);

    // the scene with the best numbers, by itself
    let ran = place.run(&["static", "o/optimum.toml", "--out", "again", "--quiet"]);
    assert!(ran.status.success(), "{}", stderr(&ran));
    let (head, rows) = place.table("again");
    let tip = head.iter().position(|name| name == "tip.x").unwrap();
    assert!((rows[rows.len() - 1][tip] / after - 1.0).abs() < 1e-9, "{rows:?} {after}");

    // a row for each evaluation, the first of which is the file's
    let mut table = csv::Reader::from_path(place.path("o/evaluations.csv")).unwrap();
    let head = table.headers().unwrap().iter().map(String::from).collect::<Vec<_>>();
    let young = "body.material.young";
    assert_eq!(
        head,
        ["evaluation", young, "tip.x", "tip.x by body.material.young", "best", "failure"]
    );
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len() as f64, number(&record["evaluations"]));
    assert_eq!([&rows[0][1], &rows[0][4]], ["100000.0", "true"]);
    assert!(fs::read_to_string(place.path("o/way.svg")).unwrap().contains("goal of tip.x"));
}

/// A bar under compression gives way where the force is E A (l - l^3) / 2 at its largest, with l = 1/sqrt(3): 1.9245 N. Beyond that there is
/// no equilibrium: evaluations fail, the search comes as near as derivatives go, and says why it went no farther.
#[test]
fn failed_evaluations_are_steps_that_are_not_made() {
    let place = Place::new();
    let scene = place.scene(&BAR.replace("cauchy", "green").replace("[0.1]", "[-1.5]"));
    let by = "phase.pull.load.force.1=-2.5..0";
    let arguments = ["optimize", scene, "--static", "--of", "tip.x", "--by", by, "--out", "o"];
    let ran = place.run(&arguments);
    assert!(ran.status.success(), "{}", stderr(&ran));
    says(&stdout(&ran), &["of which failed (phase \"pull\": no equilibrium", "no optimum"]);
    let text = fs::read_to_string(place.path("o/optimum.json")).unwrap();
    let record: Value = serde_json::from_str(&text).unwrap();
    let force = record["numbers"]["phase.pull.load.force.1"]["value"].as_f64().unwrap();
    // derivatives need no equilibrium beyond
    let most = -10.0 / 27_f64.sqrt();
    assert!(force > most && force < 0.99995 * most, "{force} {most}");
    assert_eq!(record["is_optimum"], false);
}

#[test]
fn bad_input_leaves_no_optimum() {
    let place = Place::new();
    let scene = place.scene(BAR);
    let young = "body.material.young=1e4..1e6";
    for (more, code, words) in [
        (&["--of", "top.x", "--by", young][..], 2, "top.x"),
        (&["--of", "tip.x", "--by", "body.strain=0..1"], 2, "is by a number"),
        (&["--of", "tip.x", "--by", "body.material.young"], 2, "write KEY=LEAST..MOST"),
        (&["--of", "tip.x", "--by", "body.material.young=1e6..1e4"], 2, "first end"),
        (&["--of", "tip.x", "--by", "body.material.young=2e5..1e6"], 2, "widen the range"),
        (&["--of", "tip.x", "--by", "body.material.poisson=0..0.6"], 2, "does not take this end"),
        (&["--of", "tip.x", "--of", "tip.x", "--by", young], 2, "give each of them a goal"),
        (&["--of", "tip.x", "--by", young, "--goal", "1", "--maximize"], 2, "cannot be used with"),
        (&["--of", "tip.x", "--static", "--by", "body.material.density=1..1e4"], 2, "leave it out"),
    ] {
        let ran = place.run(&[&["optimize", scene, "--out", "o"], more].concat());
        assert_eq!(ran.status.code(), Some(code), "{more:?}: {}", stderr(&ran));
        says(&stderr(&ran), &[words]);
        assert!(!place.path("o").exists(), "{more:?}");
    }
}
