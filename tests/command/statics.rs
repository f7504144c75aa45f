//! `pliant static`: equilibria, their sensors and load curves, and scenes that start from them.

use std::fs;

use serde_json::json;

use super::{Place, bar, says, shipped, stderr, stdout};

/// The slides' square, whose equilibrium is also that of a slow motion.
#[test]
fn static_finds_the_equilibrium() {
    let place = Place::new();
    let scene = shipped("static-square.toml");
    let asked = ["--track", "all", "--formats", "csv", "--quantity", "com.y"];
    let output = place.run(&[&["static", &scene], &asked[..]].concat());
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["Static square", "stable, lowest natural frequency", "-static"]);
    says(&stdout(&output), &["com.y is", "off by about", "% of its change) because of the mesh"]);
    assert_eq!(
        place.files("out/static-square-static"),
        ["report.json", "state.json", "trajectory.csv"]
    );
    let report = place.report("out/static-square-static");
    assert_eq!((&report["status"], &report["method"]), (&json!("finished"), &json!("static")));
    assert_eq!(report["stability"]["kind"], "stable");
    assert_eq!(report["mesh_estimate"]["quantity"], "com.y");
    let (header, rows) = place.table("out/static-square-static");
    assert_eq!((rows.len(), rows[0][0]), (1, 1.0));
    let value =
        |row: &[f64], name: &str| row[header.iter().position(|other| other == name).unwrap()];
    assert!((value(&rows[0], "u14_y") + 0.3).abs() < 1e-15);
    assert_eq!((value(&rows[0], "kinetic"), value(&rows[0], "momentum_x")), (0.0, 0.0));

    let text = fs::read_to_string(&scene).unwrap();
    let slow = text.replace("until = 1.0", "until = 100.0").replace("-0.3]", "-0.003]");
    let slow = slow.replace("viscosity = 0.0", "viscosity = 1e4");
    let output = place.run(&["run", place.scene(&slow), "--track", "all", "--out", "slow"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (_, moved) = place.table("slow");
    for node in 1..=16 {
        for axis in ["x", "y"] {
            let name = format!("u{node}_{axis}");
            let (still, slow) = (value(&rows[0], &name), value(moved.last().unwrap(), &name));
            // viscosity holds it back by its rate times c/E, 0.003 x 0.01 m
            assert!((still - slow).abs() < 5e-5, "{name}: {still} {slow}");
        }
    }
}

/// Sensors of a scene are columns of its equilibrium, too, with degrees in their headings.
#[test]
fn static_reads_sensors() {
    let place = Place::new();
    let scene = fs::read_to_string(shipped("beam-static-green.toml")).unwrap();
    let sensors = "[[sensor]]\nname = \"tip\"\nkind = \"position\"\nnodes = \"right\"\n\
                   [[sensor]]\nname = \"clamp\"\nkind = \"constraint-force\"\nnodes = \"left\"\n\
                   [[sensor]]\nname = \"turn\"\nkind = \"rotation\"\nunit = \"deg\"\n";
    let scene = place.scene(&format!("{scene}\n{sensors}"));
    let output = place.run(&["static", scene, "--track", "all"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let (header, rows) = place.table("out/scene-static");
    let value = |name: &str| rows[0][header.iter().position(|other| other == name).unwrap()];
    // the clamp carries what hangs on the beam, and turns it clockwise
    let reaction = value("reaction_left_y");
    assert!(reaction > 0.0 && (value("clamp.y") - reaction).abs() < 1e-12 * reaction);
    let sunk = value("tip.y") - 0.01;
    assert!(sunk < -0.01 && (-90.0..-1.0).contains(&value("turn (deg)")), "{sunk}");
    let units = place.report("out/scene-static")["sensors"].clone();
    assert_eq!(units[4], json!({ "name": "turn", "unit": "deg" }));
}

/// A bar in two phases: the load of the second comes on in steps, by arc length or at once.
#[test]
fn static_writes_load_curves() {
    let place = Place::new();
    let two = bar(1.0).replace("area", "strain = \"green\"\narea")
        + "[[phase]]\nname = \"push\"\nuntil = 2.0\nhold = [{ nodes = \"left\" }]\n\
           load = [{ nodes = \"right\", force = [-0.2] }]\n\
           [statics]\nphase = \"push\"\nload_steps = 4\n";
    let output =
        place.run(&["static", place.scene(&two), "--formats", "vtk,html,plot", "--out", "curve"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (header, rows) = place.table("curve");
    let column = header.iter().position(|name| name == "load factor").unwrap();
    let factors: Vec<f64> = rows.iter().map(|row| row[column]).collect();
    assert_eq!(factors, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let frames =
        |directory| place.files(directory).iter().filter(|name| name.ends_with(".vtu")).count();
    assert_eq!(frames("curve"), 5);
    // sensors are drawn over the load factor
    let plot = fs::read_to_string(place.path("curve/plot.svg")).unwrap();
    says(&plot, &["load factor", "class=\"series\""]);

    let arc = ["--arc-steps", "50", "--out", "arc", "--quiet"];
    let output = place.run(&[&["static", "scene.toml"][..], &arc].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let end = place.table("arc").1;
    // steps of equal length along a path that bends a little
    assert!((4..=6).contains(&(end.len() - 1)), "{}", end.len());
    let pulled = |rows: &[Vec<f64>]| rows.last().unwrap()[column];
    assert_eq!((pulled(&end), pulled(&rows)), (1.0, 1.0));

    // the first phase pulls by as much as none of the second; one equilibrium is one file
    let plain = ["--phase", "pull", "--load-steps", "1", "--formats", "vtk,svg", "--out", "plain"];
    let output = place.run(&[&["static", "scene.toml"][..], &plain].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let (header, rows) = place.table("plain");
    assert_eq!((rows.len(), rows[0][0], frames("plain")), (1, 1.0, 1));
    assert!(!header.contains(&"load factor".to_owned()));
    // the undeformed shape and the equilibrium, each once
    let picture = fs::read_to_string(place.path("plain/snapshots.svg")).unwrap();
    assert_eq!(picture.matches("class=\"panel\"").count(), 2);
    let output = place.run(&["static", "scene.toml", "--phase", "pul"]);
    assert_eq!(output.status.code(), Some(2));
    says(&stderr(&output), &["phase of statics = \"pul\"", "\"pull\""]);
    for (bad, told) in [
        ("phase = \"puhs\"", "\"push\""),
        ("load_steps = 0", "statics.load_steps"),
        ("rtol = 1.0", "statics.rtol"),
    ] {
        let (key, _) = bad.split_once(' ').unwrap();
        let kept = two.lines().filter(|line| key == "phase" || !line.starts_with(key));
        let kept = kept.filter(|line| key != "phase" || *line != "phase = \"push\"");
        let text = kept.collect::<Vec<_>>().join("\n") + "\n" + bad + "\n";
        let output = place.run(&["static", place.scene(&text)]);
        assert_eq!(output.status.code(), Some(2), "{bad}");
        says(&stderr(&output), &["scene.toml:", told]);
    }
}

#[test]
fn static_tells_what_it_cannot_hold() {
    let place = Place::new();
    let linear = bar(1.0).replace("area", "strain = \"cauchy\"\narea");
    let loose = linear.replace("hold = [{ nodes = \"left\" }]", "");
    let output = place.run(&["static", place.scene(&loose)]);
    assert_eq!(output.status.code(), Some(2));
    says(&stderr(&output), &["pliant: constraints of phase \"pull\"", "hold more of its nodes"]);
    assert_eq!(place.files("."), ["scene.toml"]);

    // pressed together by far more than it can bear
    let green = bar(1.0).replace("area", "strain = \"green\"\narea").replace("0.1]", "-50.0]");
    let output = place.run(&["static", place.scene(&green), "--out", "lost"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    says(&stderr(&output), &["pliant: phase \"pull\": no equilibrium at"]);
    assert_eq!(place.report("lost")["status"], "failed");
    assert_eq!(place.table("lost").1.len(), 1);
}

/// The square is pressed by statics, let go, and cut off; each scene starts from what the one before has left.
#[test]
fn a_scene_starts_from_what_another_has_left() {
    let place = Place::new();
    let scene = |initial: &str, phase: &str| {
        format!(
            r#"
            [body]
            mesh = {{ kind = "rectangle", size = [0.3, 0.3], nodes = [4, 4], cells = "triangles" }}
            thickness = 0.01
            material = {{ density = 1000.0, young = 1e6, poisson = 0.3, viscosity = 40.0 }}
            {initial}
            [[phase]]
            hold = [{{ nodes = "bottom" }}]
            {phase}
            [solver]
            method = "cvode-bdf"
            [output]
            step = 0.01
            track = "all"
            "#
        )
    };
    let ran = |arguments: &[&str], text: &str| {
        place.scene(text);
        let output = place.run(&[arguments, &["scene.toml", "-q"]].concat());
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    };
    let pressed = "until = 1.0\nload = [{ nodes = \"top\", force = [3.0, -5.0] }]";
    ran(&["static"], &scene("", pressed));
    let from = |left: &str| format!("[initial]\nfrom = \"{left}\"");
    let [whole, rest] = ["until = 0.04", "until = 0.02"];
    ran(&["run", "--out", "whole"], &scene(&from("out/scene-static"), whole));
    ran(&["run", "--out", "half"], &scene(&from("out/scene-static/state.json"), rest));
    ran(&["run", "--out", "rest"], &scene(&from("half"), rest));
    let (header, all) = place.table("whole");
    let (_, cut) = place.table("rest");
    assert_eq!((all.len(), cut.len()), (5, 3));
    for column in (0..header.len()).filter(|&column| header[column].starts_with('u')) {
        let [whole, cut] = [all[4][column], cut[2][column]];
        // displacements of millimetres at rtol 1e-5, in other steps: 2e-7 apart
        assert!((whole - cut).abs() < 1e-6, "{}: {whole} {cut}", header[column]);
    }
    assert!(all[0].iter().zip(&all[4]).skip(1).any(|(a, b)| (a - b).abs() > 1e-4));

    let told = |initial: &str| {
        place.scene(&scene(initial, rest));
        let output = place.run(&["check", "scene.toml"]);
        assert_eq!(output.status.code(), Some(2));
        stderr(&output)
    };
    let thrown = format!("{}\nvelocity = [1.0, 0.0]", from("half"));
    says(&told(&thrown), &["scene.toml:8: initial.velocity", "move already"]);
    says(&told(&from("nowhere")), &["scene.toml:7: initial.from", "nowhere"]);
    says(&told(&from("half/report.json")), &["scene.toml:7: initial.from", "pliant state"]);
    let other = scene(&from("half"), rest).replace("[4, 4]", "[4, 5]");
    place.scene(&other);
    let output = place.run(&["check", "scene.toml"]);
    says(&stderr(&output), &["scene.toml:7: initial.from", "16 nodes", "20"]);
    // a scene that moves to a finer mesh starts from states of either mesh
    let finer = |left: &str| {
        scene(&from(left), rest).replace("nodes = [4, 4]", "nodes = [4, 4], halved = 1")
    };
    ran(&["run", "--out", "fine"], &finer("half"));
    ran(&["run", "--out", "finer"], &finer("fine"));
    // an equilibrium may be thrown
    place.scene(&scene(&thrown.replace("half", "out/scene-static"), rest));
    assert_eq!(place.run(&["check", "scene.toml"]).status.code(), Some(0));
}
