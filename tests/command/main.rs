//! The command `pliant` as a whole: what it writes, what it says, how it ends.

mod beside;
mod fit;
mod gradient;
mod optimize;
mod printed;
mod reduce;
mod statics;
mod sweep;
mod trust;
mod world;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use pliant::output::write_csv;
use pliant::{SceneFile, sundials};
use serde_json::{Value, json};
use tempfile::TempDir;

/// A directory to run the command in, and what is done there.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pliant"));
        command.args(arguments).current_dir(self.0.path());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Writes a scene file and returns its name.
    fn scene(&self, text: &str) -> &'static str {
        fs::write(self.0.path().join("scene.toml"), text).unwrap();
        "scene.toml"
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Names of the files in a directory, in alphabetical order.
    fn files(&self, directory: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(directory)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    fn report(&self, directory: &str) -> Value {
        let text = fs::read_to_string(self.path(directory).join("report.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    }

    /// Header and rows of trajectory.csv.
    fn table(&self, directory: &str) -> (Vec<String>, Vec<Vec<f64>>) {
        let path = self.path(directory).join("trajectory.csv");
        let mut reader = csv::Reader::from_path(path).unwrap();
        let header = reader.headers().unwrap().iter().map(String::from).collect();
        (header, reader.deserialize().collect::<Result<_, _>>().unwrap())
    }
}

/// A scene file of the project.
fn shipped(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    path.to_str().unwrap().into()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[track_caller]
fn says(text: &str, parts: &[&str]) {
    parts
        .iter()
        .for_each(|part| assert!(text.contains(part), "\"{part}\" is missing from: {text}"));
}

/// The bar of the jumping beam, held at its lower end: a motion of a second or of days.
fn bar(until: f64) -> String {
    format!(
        r#"
        dimension = 1
        [body]
        mesh = {{ kind = "bar", length = 0.10, nodes = 6 }}
        area = 2.0e-4
        material = {{ density = 1000.0, young = 5.0e4, poisson = 0.0, viscosity = 200.0 }}
        [[phase]]
        name = "pull"
        until = {until}
        hold = [{{ nodes = "left" }}]
        load = [{{ nodes = "right", force = [0.1] }}]
        [output]
        step = 0.1
        "#
    )
}

/// Times of samples stand in the file, and flags go before them.
#[test]
fn samples_are_taken_at_times() {
    let place = Place::new();
    let text = bar(0.2).replace("step = 0.1", "times = [0.15, 0.05]");
    let times = |flags: &[&str]| -> Vec<f64> {
        let output = place.run(&[&["run", place.scene(&text), "--quiet"], flags].concat());
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
        place.table("out/scene").1.iter().map(|row| row[0]).collect()
    };
    assert_eq!(times(&[]), [0.0, 0.05, 0.15, 0.2]);
    assert_eq!(times(&["--until", "0.1"]), [0.0, 0.05, 0.1]);
    assert_eq!(times(&["--step", "0.1"]), [0.0, 0.1, 0.2]);
    says(&stdout(&place.run(&["check", place.scene(&text)])), &["at 2 times"]);
}

#[test]
fn run_writes_the_motion_and_how_it_was_computed() {
    let place = Place::new();
    let output = place.run(&["run", &shipped("square-jump.toml"), "--formats", "csv"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["Jumping", "push", "hold", "free", "energy balance", "report.json"]);
    assert_eq!(place.files("."), ["out"]);
    assert_eq!(place.files("out/square-jump"), ["report.json", "state.json", "trajectory.csv"]);

    let (header, rows) = place.table("out/square-jump");
    let names = "t com_x com_y momentum_x momentum_y angular_momentum kinetic strain gravity contact \
                 springs constraint_drift u14_x u14_y u15_x u15_y dissipated supplied \
                 reaction_bottom_x reaction_bottom_y reaction_14_15_x reaction_14_15_y";
    assert_eq!(header, names.split_whitespace().collect::<Vec<_>>());
    assert_eq!(rows.len(), 151);
    // the very numbers of the same run in Rust
    let file = SceneFile::read(shipped("square-jump.toml")).unwrap();
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    let expected = place.path("expected.csv");
    write_csv(&motion, &expected, file.output.track.as_ref()).unwrap();
    let written = fs::read(place.path("out/square-jump/trajectory.csv")).unwrap();
    assert!(written == fs::read(expected).unwrap(), "trajectory.csv differs");

    let report = place.report("out/square-jump");
    let keys: Vec<&String> = report.as_object().unwrap().keys().collect();
    let required = "method rtol alpha states steps rhs_evaluations jacobian_evaluations \
                    factorizations error_test_failures wall_seconds phases energy_balance_error \
                    max_constraint_drift versions";
    for key in required.split_whitespace() {
        assert!(keys.iter().any(|known| *known == key), "{key} is missing");
    }
    assert_eq!((&report["status"], &report["failure"]), (&json!("finished"), &Value::Null));
    assert_eq!(report["steps"], motion.report().steps());
    assert_eq!(report["phases"].as_array().unwrap().len(), 3);
    assert_eq!(report["versions"]["sundials"], sundials::version());
}

#[test]
fn flags_override_the_file() {
    let place = Place::new();
    let scene = shipped("square-jump.toml");
    let flags = "--method rk --rtol 1e-4 --alpha 50 --atol-position 1e-6 --atol-velocity 1e-5 \
                 --step 0.05 --until 0.72 --track bottom --formats svg,vtk,html --out some/where";
    let mut arguments = vec!["run", &scene];
    arguments.extend(flags.split_whitespace());
    let output = place.run(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = place.report("some/where");
    assert_eq!((&report["method"], &report["rtol"]), (&json!("rk"), &json!(1e-4)));
    assert_eq!((&report["alpha"], &report["status"]), (&json!(50.0), &json!("finished")));
    let phases = report["phases"].as_array().unwrap();
    let ends: Vec<_> = phases.iter().map(|phase| (&phase["name"], &phase["end"])).collect();
    assert_eq!(ends, [(&json!("push"), &json!(0.5)), (&json!("hold"), &json!(0.72))]);

    let (header, rows) = place.table("some/where");
    let tracked: Vec<&str> = header[12..20].iter().map(String::as_str).collect();
    assert_eq!(tracked, ["u1_x", "u1_y", "u2_x", "u2_y", "u3_x", "u3_y", "u4_x", "u4_y"]);
    // every 0.05 s to 0.7 s, and the end at 0.72 s
    assert_eq!((rows.len(), rows[15][0]), (16, 0.72));
    let files = place.files("some/where");
    assert_eq!(files.iter().filter(|name| name.ends_with(".vtu")).count(), 16);
    for name in ["body.pvd", "body_0000.vtu", "snapshots.svg", "report.json", "trajectory.csv"] {
        assert!(files.iter().any(|file| file == name), "{name} is missing");
    }
    for picture in ["snapshots.svg", "animation.html"] {
        let text = fs::read_to_string(place.path("some/where").join(picture)).unwrap();
        says(&text, &["Jumping square"]);
    }
}

/// A ring that forgets `strain` swells where it should roll, and the run says so; `check` says what it can know.
#[test]
fn wrong_motions_are_told() {
    let place = Place::new();
    let text = fs::read_to_string(shipped("ring-roll-objective.toml")).unwrap();
    assert!(text.contains("strain = \"green\"\nviscous = \"objective\"\n"));
    let linear =
        text.replace("strain = \"green\"\nviscous = \"objective\"\n", "strain = \"cauchy\"\n");
    let scene = place.scene(&linear);
    let output = place.run(&["run", scene, "--until", "0.5", "--formats", "html", "-q"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["WARNING: cells turn by up to", "use strain = \"green\""]);
    let report = place.report("out/scene");
    let warnings: Vec<&str> =
        report["warnings"].as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect();
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    says(warnings[0], &["Poisson's ratio 0.48 in linear triangles", "limit: 0.45"]);
    says(warnings[1], &["cells turn by up to", "Cauchy strain", "limit: 10 degrees"]);
    says(&fs::read_to_string(place.path("out/scene/animation.html")).unwrap(), &["cells turn by"]);

    let checked = place.run(&["check", scene]);
    assert_eq!(checked.status.code(), Some(0));
    says(&stdout(&checked), &[&format!("WARNING: {}", warnings[0])]);
    assert!(!stdout(&checked).contains("cells turn"));
    let looked = place.run(&["check", scene, "--look"]);
    assert_eq!(looked.status.code(), Some(0));
    let told = [
        "doubtful          Poisson's ratio 0.48",
        "doubtful          cells turn",
        "fine              ",
    ];
    says(&stdout(&looked), &told);

    let output = place.run(&["static", &shipped("beam-static-cauchy.toml"), "-q"]);
    says(&stdout(&output), &["WARNING: cells turn by up to"]);
    let report = place.report("out/beam-static-cauchy-static");
    assert!(report["warnings"][1].as_str().unwrap().contains("cells turn by up to"));
}

#[test]
fn solver_flags_reach_the_solver() {
    let place = Place::new();
    let scene = place.scene(&bar(1.0));
    let steps = |flags: &[&str]| {
        let common = ["run", scene, "--out", "out", "--method", "cvode-bdf"];
        let output = place.run(&[&common[..], flags].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        place.report("out")["steps"].as_u64().unwrap()
    };
    let plain = steps(&[]);
    assert!(steps(&["--rtol", "1e-9"]) > 2 * plain);
    // tolerances a million times those in force
    assert!(steps(&["--atol-position", "1", "--atol-velocity", "1"]) < plain);
    assert!(steps(&["--max-order", "1", "--rtol", "1e-7"]) > 5 * steps(&["--rtol", "1e-7"]));
}

#[test]
fn a_failing_run_keeps_what_it_has() {
    let place = Place::new();
    let output = place.run(&["run", &shipped("ring-springs-5N.toml"), "--step", "0.01"]);
    assert_eq!(output.status.code(), Some(1));
    let message = stderr(&output);
    assert!(message.starts_with("pliant: phase \""), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    says(&message, &["stopped at t = 0.2", "spring \"A"]);
    says(&stdout(&output), &["written to out/ring-springs-5N"]);

    let report = place.report("out/ring-springs-5N");
    assert_eq!(report["status"], "failed");
    let failure = &report["failure"];
    // the springs collapse 10 ms after they are told to shrink, at 0.2 s
    let time = failure["time"].as_f64().unwrap();
    assert!((time - 0.21).abs() < 0.003, "{time}");
    assert!(failure["step"].as_f64().unwrap() > 0.0);
    says(failure["cause"].as_str().unwrap(), &["spring \"A"]);
    assert_eq!(failure["phase"], report["phases"][1]["name"]);
    let (_, rows) = place.table("out/ring-springs-5N");
    assert!(rows.len() > 20);
    assert!((rows.last().unwrap()[0] - time).abs() <= f64::EPSILON * time);

    let output = place.run(&["run", place.scene(&bar(1.0)), "--max-steps", "7"]);
    assert_eq!(output.status.code(), Some(1));
    says(&stderr(&output), &["pliant: phase \"pull\"", "max_steps"]);
    assert_eq!(place.report("out/scene")["steps"], 7);

    let output = place.run(&["run", place.scene(&bar(1.0)), "--max-time", "1e-9"]);
    assert_eq!(output.status.code(), Some(1));
    says(&stderr(&output), &["pliant: phase \"pull\"", "stopped at t = 0", "max_time allows"]);
    assert_eq!(place.report("out/scene")["status"], "failed");
}

#[test]
fn bad_input_writes_nothing() {
    let place = Place::new();
    let good = place.scene(&bar(1.0));
    fs::write(place.path("bad.toml"), bar(1.0).replace("area", "aera")).unwrap();
    fs::write(place.path("phase.toml"), bar(-1.0)).unwrap();
    fs::write(place.path("file"), "").unwrap();
    let before = place.files(".");
    let cases: &[(&[&str], &[&str])] = &[
        (&["run", "nowhere.toml"], &["pliant: cannot read nowhere.toml"]),
        (&["run", "bad.toml"], &["pliant: bad.toml:", "aera", "area"]),
        (&["check", "bad.toml"], &["pliant: bad.toml:", "aera"]),
        (&["static", "bad.toml"], &["pliant: bad.toml:", "aera"]),
        (&["run", "phase.toml"], &["pliant: phase.toml:", "-1"]),
        (&["run", good, "--rtol", "2"], &["pliant: rtol = 2 cannot be used"]),
        (&["run", good, "--rtol", "-1"], &["pliant: rtol = -1 cannot be used"]),
        (&["run", good, "--alpha", "nan"], &["pliant: alpha = NaN cannot be used"]),
        (&["run", good, "--max-order", "9"], &["pliant: max_order = 9", "1 to 5"]),
        (&["run", good, "--max-steps", "0"], &["pliant: max_steps = 0"]),
        (&["run", good, "--max-time", "0"], &["pliant: max_time = 0"]),
        (&["run", good, "--step", "0"], &["pliant: sampling step = 0"]),
        (&["run", good, "--until", "-1"], &["pliant: end of phase \"pull\" = -1 s"]),
        (&["run", good, "--until", "nan"], &["pliant: end of phase \"pull\" = NaN"]),
        (&["run", good, "--until", "2"], &["pliant: --until = 2 s", "ends at 1 s", "last longer"]),
        (&["chart", good, "--until", "2"], &["pliant: --until = 2 s", "ends at 1 s"]),
        (&["run", good, "--track", "7"], &["pliant: node = 7", "1 to 6"]),
        (&["run", good, "--track", "lid"], &["pliant: node set = \"lid\"", "right"]),
        (&["static", good, "--track", "lid"], &["pliant: node set = \"lid\"", "right"]),
        (&["static", good, "--quantity", "motion"], &["pliant: quantity of", "name a reading"]),
        (&["run", good, "--out", "file"], &["pliant: cannot write to file"]),
        (&["run", good, "--out", "file/below"], &["pliant: cannot write to file/below"]),
        (&["run", good, "--method", "euler"], &["euler", "cvode-bdf, cvode-adams"]),
        (&["run", good, "--formats", "pdf"], &["pdf", "csv, vtk, svg, html"]),
        (&["run", good, "--rtoll", "1"], &["--rtoll", "--rtol"]),
        (&["rum", good], &["rum", "run"]),
        (&["run"], &["FILE"]),
        (&[], &["Usage"]),
    ];
    for (arguments, parts) in cases {
        let output = place.run(arguments);
        let message = stderr(&output);
        println!("{arguments:?}: {message}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        says(&message, parts);
        assert!(!message.contains("panicked"), "{message}");
        assert_eq!(stdout(&output), "", "{arguments:?}");
        assert_eq!(place.files("."), before, "{arguments:?}");
    }
}

#[test]
fn chart_compares_methods_and_goes_on_where_it_stopped() {
    let place = Place::new();
    let scene = place.scene(&bar(0.2));
    fs::write(place.path("softer.toml"), bar(0.2).replace("5.0e4", "4.0e4")).unwrap();
    let flags = ["--methods", "rk,cvode-bdf", "--repetitions", "1", "--alpha", "1e2,1e3"];
    let chart = |rtol: &str| {
        let arguments =
            [&["chart", scene, "--rtol", rtol, "--variants", "softer.toml"], &flags[..]];
        place.run(&arguments.concat())
    };
    let output = chart("1e-3");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let written = ["chart.csv", "chart.md", "chart.png", "chart.svg"];
    assert_eq!(place.files("out/scene-chart"), written);
    let table = || fs::read_to_string(place.path("out/scene-chart/chart.csv")).unwrap();
    let first = table();
    assert_eq!(first.lines().count(), 1 + 8);
    says(&first, &["\"rk, alpha 1e2\"", "\"softer: cvode-bdf, alpha 1e3\""]);
    says(&stdout(&output), &["error", "fastest", "reference", "written to out/scene-chart"]);
    // what was measured stays to the digit
    assert_eq!(chart("1e-3,1e-4").status.code(), Some(0));
    let both = table();
    assert!(both.starts_with(&first) && both.lines().count() == 1 + 16, "{both}");

    // other values are another problem beside it, for the variants too, and are kept as well
    let softer = ["chart", scene, "--rtol", "1e-3", "--variants", "softer.toml"];
    let softer = [&softer, &flags[..], &["--set", "body.material.young=3e4"]].concat();
    assert_eq!(place.run(&softer).status.code(), Some(0));
    let all = table();
    assert!(all.starts_with(&both) && all.lines().count() == 1 + 24, "{all}");
    let overridden = all.lines().skip(1 + 16);
    assert!(overridden.clone().all(|line| line.contains("(body.material.young=3e4)")), "{all}");
    assert_eq!(place.run(&softer).status.code(), Some(0));
    assert_eq!(table(), all);

    let output = place.run(&["chart", scene, "--rtol", "2", "--out", "bad"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let output =
        place.run(&["chart", scene, "--methods", "rk", "--max-order", "2", "--out", "bad"]);
    says(&stderr(&output), &["max_order", "one order only"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let output = place.run(&["chart", scene, "--limit", "1e-9", "--out", "bad"]);
    says(&stderr(&output), &["no two methods solve the scene"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(!place.path("bad").exists());
}

#[test]
fn quiet_prints_results_only() {
    let place = Place::new();
    let scene = shipped("beam-jump.toml");
    let output = place.run(&["run", &scene, "--quiet"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert_eq!(stdout(&output), "");
    let output = place.run(&["static", &scene, "--quiet"]);
    assert_eq!((stdout(&output).lines().count(), stderr(&output)), (1, String::new()));
}

/// Whoever reads may stop reading; what cannot be written is said.
#[test]
fn standard_output_may_break() {
    let place = Place::new();
    for arguments in [vec!["methods"], vec!["check", place.scene(&bar(1.0))]] {
        let mut command = place.command(&arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    }
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = place.command(&["methods"]).stdout(full).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    says(&stderr(&output), &["pliant: cannot write to the standard output"]);
}

/// Sensors of a scene file become columns and plots, and `plot` draws them once more from the results.
#[test]
fn sensors_are_plotted() {
    let place = Place::new();
    let scene = std::fs::read_to_string(shipped("square-jump.toml")).unwrap();
    let sensor = "[[sensor]]\nname = \"top\"\nkind = \"position\"\nnodes = \"top\"\n";
    fs::write(place.path("scene.toml"), format!("{scene}\n{sensor}")).unwrap();
    let run = ["run", "scene.toml", "--formats", "plot,png", "--until", "0.1", "--quiet"];
    let output = place.run(&run);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let files = ["plot.png", "plot.svg", "report.json", "state.json", "trajectory.csv"];
    assert_eq!(place.files("out/scene"), files);
    let (header, rows) = place.table("out/scene");
    let top = header.iter().position(|name| name == "top.y").unwrap();
    // the press has come down by 1.6 cm, with two of the four nodes on top
    assert!((0.28..0.295).contains(&rows.last().unwrap()[top]), "{:?}", rows.last());
    assert_eq!(place.report("out/scene")["sensors"][1], json!({ "name": "top.y", "unit": "m" }));

    let drawn = fs::read_to_string(place.path("out/scene/plot.svg")).unwrap();
    let title = drawn.contains("font-weight=\"600\"");
    assert!(title && drawn.contains("top.y"), "{drawn}");
    fs::remove_file(place.path("out/scene/plot.svg")).unwrap();
    let output = place.run(&["plot", "out/scene", "--columns", "com_y,top.y"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["out/scene/plot.svg"]);
    let drawn = fs::read_to_string(place.path("out/scene/plot.svg")).unwrap();
    assert!(drawn.contains("com_y") && !drawn.contains("kinetic"));
    // under the title of the scene, or another one
    let title = SceneFile::read(shipped("square-jump.toml")).unwrap().title;
    assert!(!title.is_empty() && drawn.contains(&title), "{title}: {drawn}");
    place.run(&["plot", "out/scene", "--title", "Mine"]);
    let drawn = fs::read_to_string(place.path("out/scene/plot.svg")).unwrap();
    assert!(drawn.contains("Mine") && !drawn.contains(&title), "{drawn}");

    for (arguments, part) in [
        (&["plot", "out/scene", "--columns", "com_z"][..], "did you mean"),
        (&["plot", "nowhere"], "trajectory.csv"),
    ] {
        let output = place.run(arguments);
        assert_eq!(output.status.code(), Some(2));
        says(&stderr(&output), &[part]);
    }
}
