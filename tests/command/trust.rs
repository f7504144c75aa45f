//! How good a result is, and what a scene needs: `run --accuracy`, `advise`.

use std::fs;

use serde_json::Value;

use super::{Place, bar, says, stderr, stdout};

#[test]
fn an_accuracy_is_reached_and_told() {
    let place = Place::new();
    let scene = place.scene(&bar(0.3));
    let output = place.run(&["run", scene, "--accuracy", "0.1%", "--quantity", "right.x", "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    says(&stdout(&output), &["right.x is known to"]);
    let report = fs::read_to_string(place.path("out/scene/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let achieved = &report["achieved"];
    assert!(achieved["difference"].as_f64().unwrap() <= 1e-3, "{achieved}");
    assert_eq!(achieved["quantity"], "right.x");
    let table = fs::read_to_string(place.path("out/scene/trajectory.csv")).unwrap();
    assert!(table.lines().next().unwrap().contains(",difference,"), "{table}");
    // from which another scene can start
    assert!(place.path("out/scene/state.json").exists());
}

#[test]
fn what_contradicts_an_accuracy_is_refused() {
    let place = Place::new();
    let scene = place.scene(&bar(0.3));
    for (flags, message) in [
        (&["--accuracy", "1%", "--rtol", "1e-3"][..], "leave one of them out"),
        (&["--accuracy", "1%", "--resume"], "leave one of them out"),
        (&["--quantity", "right.x"], "give both"),
        (
            &["--accuracy", "1%", "--quantity", "rigth.x"],
            "a set of nodes (all, boundary, left, right)",
        ),
        (&["--accuracy", "1%", "--quantity", "right.x:ende"], "did you mean \"end\"?"),
        (&["--accuracy", "1"], "above 0 and below 1"),
    ] {
        let output = place.run(&[&["run", scene], flags].concat());
        assert_eq!(output.status.code(), Some(2), "{flags:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{flags:?}: {}", stderr(&output));
    }
    assert!(!place.path("out").exists());
}

#[test]
fn advice_is_written_into_a_scene_that_runs() {
    let place = Place::new();
    let scene = place.scene(&bar(0.3));
    let ask =
        ["advise", scene, "--within", "5%", "--quantity", "right.x", "--write", "enough.toml"];
    let output = place.run(&[&ask[..], &["--out", "advice", "-q"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let parts =
        ["right.x to 5 %", "Enough:", "As written:", "Cauchy strain in place of Green strain"];
    says(&stdout(&output), &parts);
    let files = ["advice.html", "advice.json", "candidates.csv", "runs.jsonl"];
    assert_eq!(place.files("advice"), files);
    let advice = fs::read_to_string(place.path("advice/advice.json")).unwrap();
    let advice: Value = serde_json::from_str(&advice).unwrap();
    assert!(advice["enough"]["error"].as_f64().unwrap() <= 0.05, "{advice}");
    let output = place.run(&["run", "enough.toml", "-q"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // what is there is not written over
    let output = place.run(&ask);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("is there already"), "{}", stderr(&output));
}

/// A thick strip between held ends is advised to be run as its section, and so is the file that is written, which moves as the file
/// with the other settings does; with a sensor that the section does not have, it is run in space.
#[test]
fn a_section_that_is_advised_is_written() {
    let place = Place::new();
    let text = "gravity = [0.0, 0.0, -2.0]\n[body]\n\
        mesh = { kind = \"cuboid\", size = [0.1, 0.1, 0.02], nodes = [4, 9, 2], cells = \"hexahedra\" }\n\
        material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 20.0 }\n\
        [[sensor]]\nname = \"tip\"\nkind = \"position\"\nnodes = \"right\"\ncomponent = \"z\"\n\
        [[phase]]\nuntil = 0.05\nhold = [{ nodes = \"left\" }, { nodes = \"front\", axes = [\"y\"] }, \
        { nodes = \"back\", axes = [\"y\"] }]\n[output]\nformats = [\"csv\"]\n";
    let ask = ["--within", "20%", "--quantity", "tip.z", "--budget", "20", "-q", "--write"];
    let scene = place.scene(text);
    let output = place.run(&[&["advise", scene][..], &ask, &["enough.toml"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    println!("{}", stdout(&output));
    says(&stdout(&output), &["Smaller:     in a plane across y (plane strain)", "solver.plane=y"]);
    let tip = |arguments: &[&str]| {
        let output = place.run(&[&["run", "enough.toml", "--out", "found"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let (header, rows) = place.table("found");
        let column = header.iter().position(|name| name.starts_with("tip")).unwrap();
        rows[rows.len() - 1][column] - rows[0][column]
    };
    let output = place.run(&["check", "enough.toml"]);
    says(&stdout(&output), &["in a plane across y (plane strain)"]);
    let [own, space] = [&["-q"][..], &["-q", "--set", "solver.plane=\"\""]].map(tip);
    println!("{own:e} {space:e}");
    // plane strain is exact, and the tolerances are those of both (measured: 1e-5 apart, at rtol 1e-4)
    assert!((own / space - 1.0).abs() < 1e-3, "{own:e} {space:e}");

    let stress = "[[sensor]]\nname = \"stress\"\nkind = \"stress\"\nnodes = [1]\n[[phase]]";
    let scene = place.scene(&text.replace("[[phase]]", stress));
    let output = place.run(&[&["advise", scene][..], &ask, &["whole.toml"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    says(
        &stdout(&output),
        &[
            "The smaller model (in a plane across y (plane strain)) is not for all of the file",
            "of another kind",
        ],
    );
    assert_eq!(place.run(&["run", "whole.toml", "-q"]).status.code(), Some(0));
}

/// A clamp divides less than its cells everywhere, and comes as near to what many cells give; the file that is written gives the same.
#[test]
fn cells_are_divided_where_the_estimate_says() {
    let place = Place::new();
    let silicone = |cells: &str| {
        format!(
            "[body]\nmesh = {{ kind = \"rectangle\", size = [0.1, 0.02], nodes = {cells}, cells = \"triangles6\", bubbles = true }}\n\
             thickness = 0.01\nstrain = \"cauchy\"\n\
             material = {{ density = 1000.0, young = 1e5, poisson = 0.49, viscosity = 1.0 }}\n\
             [[sensor]]\nname = \"tip\"\nkind = \"displacement\"\nnodes = \"right\"\ncomponent = \"y\"\n\
             [[phase]]\nuntil = 1.0\nhold = [{{ nodes = \"left\" }}]\nload = [{{ nodes = \"right\", total = [0.0, -0.05] }}]\n"
        )
    };
    let tip = |scene: &str, arguments: &[&str]| -> (f64, String) {
        let asked = ["static", scene, "--out", "found", "--formats", "csv"];
        let output = place.run(&[&asked[..], arguments].concat());
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
        let (header, rows) = place.table("found");
        let column = header.iter().position(|name| name.starts_with("tip")).unwrap();
        (rows[0][column], stdout(&output))
    };
    let fine = place.scene(&silicone("[161, 33]"));
    let (exact, _) = tip(fine, &[]);
    let scene = place.scene(&silicone("[11, 3]"));
    let (coarse, _) = tip(scene, &[]);
    let refine = ["--quantity", "tip", "--refine", "400"];
    let (divided, said) = tip(scene, &refine);
    println!("{said}");
    says(&said, &["145 nodes: tip is", "% of its change from the one before", "refined.toml"]);
    let (again, _) = tip("found/refined.toml", &["-q"]);
    assert_eq!(divided, again);
    let off = [coarse, divided].map(|found| found / exact - 1.0);
    println!("{off:?}");
    assert!(off[1].abs() < 0.25 * off[0].abs(), "{off:?}");

    // what cannot be divided is told before anything is written
    let grid = silicone("[11, 3]").replace("triangles6\", bubbles = true", "rectangles9\"");
    let output =
        place.run(&[&["static", place.scene(&grid), "--out", "none"], &refine[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    says(&stderr(&output), &["a grid that is graded"]);
    assert!(!place.path("none").exists());
}
