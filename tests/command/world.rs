//! Runs that live in the world: signals, kills, other runs in the same directory, files and numbers without end.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::{Place, bar, says, stderr};

/// Waits until something holds.
#[track_caller]
fn wait(what: &str, mut holds: impl FnMut() -> bool) {
    let patience = Instant::now();
    while !holds() {
        assert!(patience.elapsed() < Duration::from_secs(120), "{what}");
        sleep(Duration::from_millis(5));
    }
}

/// Waits until a child watches for SIGINT.
fn wait_for_watch(child: &Child) {
    let status = format!("/proc/{}/status", child.id());
    wait("it does not watch for SIGINT", || {
        let text = fs::read_to_string(&status).unwrap();
        let mask = text.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
        u64::from_str_radix(mask.trim(), 16).unwrap() & 0b10 != 0 // SIGINT is number 2
    });
}

fn send(signal: &str, child: &Child) {
    let kill = format!("kill -{signal} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

fn endless_bar() -> String {
    bar(1e6).replace("viscosity = 200.0", "viscosity = 0.0")
}

/// A run of days of motion that never comes to rest: it cannot be over before it is stopped.
fn endless(place: &Place, flags: &[&str]) -> Child {
    let scene = place.scene(&endless_bar());
    let mut run = place.command(&[&["run", scene, "--max-steps", "1000000000"], flags].concat());
    run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn a_signal_keeps_what_was_computed() {
    for signal in ["INT", "TERM", "HUP"] {
        let place = Place::new();
        let child = endless(&place, &[]);
        wait_for_watch(&child);
        // it takes steps
        wait("no directory", || place.path("out/scene").exists());
        send(signal, &child);
        let sent = Instant::now();
        let output = child.wait_with_output().unwrap();
        assert!(sent.elapsed() < Duration::from_secs(20), "{signal}");
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let message = stderr(&output);
        let parts = ["pliant: stopping after this step", "pliant: phase \"pull\"", "interrupted"];
        says(&message, &parts);
        let report = place.report("out/scene");
        assert_eq!(report["status"], "interrupted");
        assert_eq!(report["failure"]["cause"], "interrupted");
        let (_, rows) = place.table("out/scene");
        assert!(report["steps"].as_u64().unwrap() >= 1 && rows.len() >= 2);
        let (last, time) = (rows.last().unwrap()[0], report["failure"]["time"].as_f64().unwrap());
        assert!((last - time).abs() <= f64::EPSILON * time, "{last} {time}");
        assert_eq!(
            place.files("out/scene"),
            ["checkpoint.json", "report.json", "state.json", "trajectory.csv"]
        );
    }
}

/// Two runs, of which the second goes on with the first, leave one table without gaps, and the energy balance
/// closes from the start on.
#[test]
fn a_run_that_was_ended_goes_on() {
    let place = Place::new();
    let table = place.path("out/scene/trajectory.csv");
    let rows = || fs::read_to_string(&table).map_or(0, |text| text.lines().count());
    let mut ends = Vec::new();
    for flags in [&["--rtol", "1e-8"][..], &["--rtol", "1e-8", "--resume"]] {
        let (child, before) = (endless(&place, flags), rows());
        wait("no rows", || rows() > before + 10);
        send("TERM", &child);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        ends.push(place.report("out/scene")["failure"]["time"].as_f64().unwrap());
    }
    let times: Vec<f64> = place.table("out/scene").1.iter().map(|row| row[0]).collect();
    assert!(ends[1] > ends[0] && times.last() == Some(&ends[1]));
    // samples every 0.1 s, and where the last run has ended; the row where the first one had come to is gone
    let mut expected: Vec<f64> =
        (0..).map(|k| 0.1 * f64::from(k)).take_while(|&t| t < ends[1]).collect();
    expected.push(ends[1]);
    assert_eq!(times.len(), expected.len());
    assert!(times.iter().zip(&expected).all(|(t, expected)| (t - expected).abs() < 1e-9));
    let report = place.report("out/scene");
    let [error, scale] =
        ["energy_balance_error", "energy_scale"].map(|key| report[key].as_f64().unwrap());
    assert!(error < 1e-3 * scale, "{error} {scale}");

    // other columns, no checkpoint
    let scene = place.scene(&endless_bar());
    let refused = |flags: &[&str]| {
        let output = place.run(&[&["run", scene, "--resume"], flags].concat());
        assert_eq!(output.status.code(), Some(2));
        stderr(&output)
    };
    says(&refused(&["--track", "3"]), &["its columns are others"]);
    says(&refused(&["--out", "elsewhere"]), &["there is no elsewhere/checkpoint.json"]);
    says(&refused(&["--until", "5"]), &["checkpoint file", "phases"]);
    assert_eq!(place.table("out/scene").1.len(), times.len());
}

/// Before the first step there is nothing to be kept: here of a mesh so fine that it takes seconds.
#[test]
fn ctrl_c_before_the_first_step_ends_at_once() {
    let place = Place::new();
    let text = r#"
        dimension = 3
        [body]
        mesh = { kind = "cuboid", size = [0.3, 0.3, 0.3], nodes = [22, 22, 22], cells = "hexahedra" }
        material = { density = 1000.0, young = 1.0e6, poisson = 0.4, viscosity = 40.0 }
        [[phase]]
        until = 10.0
        load = [{ nodes = "top", force = [1.0, 0.0, 0.0] }]
    "#;
    let mut command = place.command(&["run", place.scene(text)]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_for_watch(&child);
    send("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(place.files("."), ["scene.toml"]);
}

/// Rows are written while the scene runs: a kill loses the last ones alone, and the next run begins with a clean
/// directory.
#[test]
fn a_kill_leaves_the_rows_until_then() {
    let place = Place::new();
    let mut child = endless(&place, &[]);
    let table = place.path("out/scene/trajectory.csv");
    let rows = || fs::read_to_string(&table).map_or(0, |text| text.lines().count());
    wait("no rows", || rows() > 2);
    let before = rows();
    wait("no more rows", || rows() > before);
    send("KILL", &child);
    child.wait().unwrap();
    let text = fs::read_to_string(&table).unwrap();
    // the last line may be cut off
    let lines: Vec<&str> = text.lines().rev().skip(1).collect();
    let columns = lines.last().unwrap().split(',').count();
    for (number, line) in lines.iter().rev().skip(1).enumerate() {
        let row: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        assert_eq!(row.len(), columns);
        assert!((row[0] - 0.1 * number as f64).abs() < 1e-9 * row[0].max(1.0), "row {number}");
    }
    assert!(lines.len() > before);
}

#[test]
fn a_run_owns_its_directory() {
    let place = Place::new();
    let scene = place.scene(&bar(1.0));
    let of = |step: &str| place.run(&["run", scene, "--step", step, "--formats", "vtk,svg,html"]);
    assert_eq!(of("0.1").status.code(), Some(0));
    fs::write(place.path("out/scene/notes.txt"), "mine").unwrap();
    let frames = |place: &Place| {
        place.files("out/scene").iter().filter(|name| name.ends_with(".vtu")).count()
    };
    assert_eq!(frames(&place), 11);
    // bad input leaves what is there
    assert_eq!(place.run(&["run", scene, "--rtol", "7"]).status.code(), Some(2));
    assert_eq!(frames(&place), 11);
    assert_eq!(of("0.5").status.code(), Some(0));
    assert_eq!(frames(&place), 3);
    assert_eq!(place.run(&["run", scene]).status.code(), Some(0));
    assert_eq!(
        place.files("out/scene"),
        ["notes.txt", "report.json", "state.json", "trajectory.csv"]
    );

    fs::remove_file(place.path("out/scene/trajectory.csv")).unwrap();
    let mut child = endless(&place, &[]);
    wait("no rows", || place.path("out/scene/trajectory.csv").exists());
    let other = place.run(&["run", scene, "--step", "0.5"]);
    assert_eq!(other.status.code(), Some(2));
    says(&stderr(&other), &["another run writes to out/scene", "another directory by --out"]);
    assert_eq!(place.run(&["static", scene, "--out", "out/scene"]).status.code(), Some(2));
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(place.run(&["static", scene, "--out", "out/scene"]).status.code(), Some(0));
}

/// What cannot fit, end or be meant is refused by its name, before anything is computed or written.
#[test]
fn what_cannot_be_meant_is_refused() {
    let place = Place::new();
    let with = |from: &str, to: &str| {
        let text = bar(1.0);
        assert!(text.contains(from), "{from}");
        place.run(&["run", place.scene(&text.replace(from, to))])
    };
    let cases = [
        (with("young = 5.0e4", "young = 1e200"), vec!["scene.toml:6", "young", "1e200", "1e30"]),
        (with("[0.1]", "[1e308]"), vec!["scene.toml:11", "load", "1e308", "1e30 at most"]),
        (with("until = 1", "until = 1e300"), vec!["end of phase", "1e300", "1e30"]),
        (with("nodes = 6", "nodes = 600000000000"), vec!["nodes", "GiB", "are free", "fewer"]),
        (with("step = 0.1", "step = 1e-12"), vec!["sampling step = 1e-12 s", "GiB", "less often"]),
        (place.run(&["run", "/dev/zero"]), vec!["/dev/zero", "more than 16 MiB"]),
    ];
    for (output, parts) in cases {
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        says(&stderr(&output), &parts);
    }
    assert!(!Path::new(&place.path("out")).exists());
}

/// A script that reads the report after bad input does not find that of an earlier run. Nothing else is lost, and where nothing is there
/// nothing is made.
#[test]
fn bad_input_leaves_no_older_report() {
    let place = Place::new();
    let (right, wrong) = (bar(0.1), bar(0.1).replace("young = 5.0e4", "young = -5.0e4"));
    for command in ["run", "static"] {
        let results = place.path(if command == "run" { "out/scene" } else { "out/scene-static" });
        let failed = || {
            let output = place.run(&[command, place.scene(&wrong), "-q"]);
            assert_eq!(output.status.code(), Some(2));
            stderr(&output)
        };
        assert!(!failed().contains("removed") && !results.exists());
        let output = place.run(&[command, place.scene(&right), "-q"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(results.join("report.json").exists());
        says(&failed(), &["young", "report.json of an earlier run was removed"]);
        assert!(!results.join("report.json").exists() && results.join("trajectory.csv").exists());
        assert!(!failed().contains("removed"));
    }
}
