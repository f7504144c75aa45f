//! `pliant sweep`: rows against single runs, kills, processes side by side, engines, and what is refused.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::thread::sleep;
use std::time::Instant;

use super::{Place, bar, says, stderr, stdout};

const STUDY: &str = r#"
title = "A bar is pulled"
scene = "scene.toml"
quantities = ["com.x:end", "right.x:max", "tip:end"]

[[key]]
name = "body.material.young"
values = [4e4, 8e4]

[[key]]
name = "phase.pull.load.1.force"
values = [[0.1], [0.2], [0.4]]
"#;

const SENSOR: &str = "
[[sensor]]
name = \"tip\"
kind = \"position\"
nodes = \"right\"
";

impl Place {
    /// A place with a scene and a study of it.
    fn of_study(study: &str) -> Self {
        let place = Self::new();
        place.scene(&(bar(0.3) + SENSOR));
        place.study(study);
        place
    }

    fn study(&self, text: &str) {
        fs::write(self.path("study.toml"), text).unwrap();
    }

    /// Runs the command for the study, which succeeds.
    fn sweep(&self, flags: &[&str]) -> String {
        let output = self.run(&[&["sweep", "study.toml"], flags].concat());
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
        stdout(&output)
    }

    /// The head and the rows of the table of a study.
    fn rows(&self, directory: &str) -> (Vec<String>, Vec<Vec<String>>) {
        let mut reader = csv::Reader::from_path(self.path(directory).join("table.csv")).unwrap();
        let head = reader.headers().unwrap().iter().map(String::from).collect();
        (head, reader.deserialize().collect::<Result<_, _>>().unwrap())
    }

    /// The table without the times at its end.
    fn found(&self, directory: &str) -> Vec<Vec<String>> {
        let (_, rows) = self.rows(directory);
        rows.into_iter().map(|row| row[..row.len() - 2].to_vec()).collect()
    }

    /// The files of the rows.
    fn row_files(&self, directory: &str) -> BTreeMap<String, Vec<u8>> {
        let rows = self.path(directory).join("rows");
        let Ok(entries) = fs::read_dir(rows) else { return BTreeMap::new() };
        let names = entries.map(|entry| entry.unwrap()).map(|entry| {
            (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())
        });
        // what was killed while it was written has another name
        names.filter(|(name, _)| name.ends_with(".json")).collect()
    }
}

/// What a row has is what `pliant run --set` finds, to the last digit.
#[test]
fn rows_are_those_of_single_runs() {
    let place = Place::of_study(STUDY);
    says(
        &place.sweep(&[]),
        &["6 rows: 6 fine, 0 doubtful, 0 failed", "table.csv, plot.svg, sweep.html"],
    );
    let plot = fs::read_to_string(place.path("out/study-sweep/plot.svg")).unwrap();
    assert!(plot.contains("body.material.young (kPa)"), "{plot}");
    let (head, rows) = place.rows("out/study-sweep");
    let names = "id body.material.young phase.pull.load.1.force com.x:end right.x:max tip:end verdict warnings failure \
                 difference reached steps wall_seconds processor_seconds";
    assert_eq!(head, names.split_whitespace().collect::<Vec<_>>());
    let mut ends = Vec::new();
    for row in &rows {
        let set = [
            format!("body.material.young={}", row[1]),
            format!("phase.pull.load.1.force={}", row[2]),
        ];
        let run = ["run", "scene.toml", "-q", "--set", &set[0], "--set", &set[1]];
        assert!(place.run(&run).status.success());
        let (columns, table) = place.table("out/scene");
        let end = |of: &str| {
            let column = columns.iter().position(|name| name == of).unwrap();
            table.last().unwrap()[column]
        };
        let number = |at: usize| row[at].parse::<f64>().unwrap();
        assert_eq!(number(5), end("tip.x"), "{row:?}");
        // that column of the table is a sum in another order
        assert!((number(3) / end("com_x") - 1.0).abs() < 1e-15, "{row:?}");
        let report = place.report("out/scene");
        assert_eq!(row[11], report["steps"].to_string());
        assert_eq!((&row[6][..], &report["warnings"]), ("fine", &serde_json::json!([])));
        ends.push(row[4].parse::<f64>().unwrap() - 0.1);
    }
    // a linear bar: twice the force, or half of the modulus (with the same damping, which hardly matters at the end of
    // the swing), twice the way; the tip swings to between once and twice F L/(E A)
    for (end, (force, young)) in
        ends.iter().zip([(0.1, 4e4), (0.2, 4e4), (0.4, 4e4), (0.1, 8e4), (0.2, 8e4), (0.4, 8e4)])
    {
        let at_rest = force * 0.1 / (young * 2e-4);
        assert!((1.0..2.0).contains(&(end / at_rest)), "{end} {at_rest}");
    }
}

/// With an accuracy, too: the same runs, and the same difference between them.
#[test]
fn rows_have_an_accuracy() {
    let place = Place::of_study(STUDY);
    place.sweep(&["-q", "--accuracy", "1%", "--limit", "1"]);
    let row = &place.rows("out/study-sweep").1[0];
    let set = ["body.material.young", "phase.pull.load.1.force"];
    let set = [0, 1].map(|at| format!("{}={}", set[at], row[1 + at]));
    let run = ["run", "scene.toml", "-q", "--accuracy", "1%", "--quantity", "com.x:end"];
    assert!(
        place.run(&[&run[..], &["--set", &set[0], "--set", &set[1]]].concat()).status.success()
    );
    let report = place.report("out/scene");
    assert_eq!(row[9].parse::<f64>().unwrap(), report["achieved"]["difference"]);
    assert_eq!((&row[6][..], &row[11]), ("fine", &report["steps"].to_string()));
}

/// A bar of Green's strain under dead loads, at rest: E A (s^3 - s)/2 at a stretch s.
const AT_REST: &str = r#"
scene = "scene.toml"
static = true
quantities = ["tip", "right.x:end", "speed"]

[[key]]
name = "body.material.young"
values = [4e4, 8e4]

[[key]]
name = "phase.pull.load.1.force"
values = [[0.1], [2.0], [-0.4]]
"#;

/// Rows of equilibria are what `pliant static --set` finds, to the last digit, and so is the output that is kept.
#[test]
fn rows_of_equilibria_are_those_of_single_ones() {
    let place = Place::of_study(AT_REST);
    let speed = SENSOR.replace("tip", "speed").replace("position", "velocity");
    let green = bar(0.3).replace("area =", "strain = \"green\"\narea =");
    place.scene(&(green.replace("[output]", "[output]\nformats = [\"plot\"]") + SENSOR + &speed));
    says(&place.sweep(&["--keep", "tip > 0.1"]), &["6 rows: 6 fine, 0 doubtful, 0 failed"]);
    let plot = fs::read_to_string(place.path("out/study-sweep/plot.svg")).unwrap();
    assert!(plot.contains("6 equilibria") && plot.contains("tip (mm)"), "{plot}");
    let (_, rows) = place.rows("out/study-sweep");
    for row in &rows {
        let [young, force] = [&row[1], &row[2]];
        let set =
            [format!("body.material.young={young}"), format!("phase.pull.load.1.force={force}")];
        let found = ["static", "scene.toml", "-q", "--set", &set[0], "--set", &set[1]];
        assert!(place.run(&found).status.success());
        let (columns, table) = place.table("out/scene-static");
        let tip = columns.iter().position(|name| name == "tip.x").unwrap();
        let [at_rest, right, speed] = [3, 4, 5].map(|at| row[at].parse::<f64>().unwrap());
        assert_eq!([at_rest, right, speed], [table[0][tip], table[0][tip], 0.0], "{row:?}");
        let report = place.report("out/scene-static");
        assert_eq!([&row[11], &row[6]], [&report["iterations"].to_string(), "fine"]);

        let number = |text: &str| text.trim_matches(['[', ']']).parse::<f64>().unwrap();
        let (stretch, stiffness) = (at_rest / 0.1, number(young) * 2e-4);
        let held = 0.5 * stiffness * (stretch.powi(3) - stretch);
        println!("{row:?}: {held}");
        // forces are in balance to 1e-10 of the largest
        assert!((held / number(force) - 1.0).abs() < 2e-10, "{row:?}: {held}");

        let kept = place.path("out/study-sweep/runs").join(&row[0]);
        // a single state has no plot
        assert_eq!((kept.exists(), kept.join("plot.svg").exists()), (at_rest > 0.1, false));
        for name in ["trajectory.csv", "state.json"].into_iter().filter(|_| kept.exists()) {
            let single = fs::read(place.path("out/scene-static").join(name)).unwrap();
            assert_eq!(fs::read(kept.join(name)).unwrap(), single, "{name}");
        }
    }
}

/// Equilibria that are not found are rows; one that a small push ends is doubtful.
#[test]
fn equilibria_that_fail_are_rows() {
    let steps = "
        scene = \"scene.toml\"
        static = true
        quantities = [\"com.x\"]
        set = [\"body.strain=green\", \"statics.load_steps=20\"]
        [[key]]
        name = \"statics.arc_steps\"
        values = [3, 0]
    ";
    let place = Place::of_study(steps);
    let said = place.sweep(&["--keep", "all"]);
    says(&said, &["2 rows: 1 fine, 0 doubtful, 1 failed", "the first failure: phase \"pull\": no"]);
    let (_, rows) = place.rows("out/study-sweep");
    assert_eq!([&rows[0][3], &rows[1][3]], ["failed", "fine"]);
    // part of the load, and the whole
    let reached = |at: usize| rows[at][7].parse::<f64>().unwrap();
    assert!(rows[0][2].is_empty() && reached(0) < 0.2 && reached(1) == 0.3, "{rows:?}");
    let kept = place.files(&format!("out/study-sweep/runs/{}", rows[0][0]));
    assert_eq!(kept, ["animation.html", "report.json", "trajectory.csv"]);

    // a column below and above Euler's load, pi^2 E I/(4 L^2) = 0.00164 N
    let column = r#"
        [body]
        mesh = { kind = "rectangle", size = [0.1, 0.002], nodes = [21, 3], cells = "triangles6" }
        thickness = 0.01
        strain = "green"
        material = { density = 1000.0, young = 1e6, poisson = 0.0, viscosity = 0.0 }
        [[phase]]
        name = "press"
        until = 1.0
        hold = { nodes = "left" }
        load = { nodes = "right", total = [-0.001, 0.0] }
    "#;
    place.scene(column);
    place.study(
        "scene = \"scene.toml\"\nstatic = true\nquantities = [\"com.x\"]\n[[key]]\n\
         name = \"phase.press.load.total\"\nvalues = [[-0.00148, 0.0], [-0.00189, 0.0]]",
    );
    says(&place.sweep(&["--out", "column"]), &["1 fine, 1 doubtful", "warnings: unstable (1)"]);
    let (_, rows) = place.rows("column");
    assert_eq!([&rows[0][4], &rows[1][4]], ["", "unstable"]);
}

/// A run that fails, or cannot begin, is a row; the others go on.
#[test]
fn failures_are_rows() {
    let study = "
        scene = \"scene.toml\"
        quantities = [\"com.x:end\"]
        [[key]]
        name = \"body.material.young\"
        values = [4e4, 8e4]
        [[key]]
        name = \"solver.max_steps\"
        values = [3, 100000]
    ";
    let place = Place::of_study(study);
    let said = place.sweep(&[]);
    says(&said, &["4 rows: 2 fine, 0 doubtful, 2 failed", "the first failure: ", "steps"]);
    let (_, rows) = place.rows("out/study-sweep");
    let verdicts: Vec<&str> = rows.iter().map(|row| &row[4][..]).collect();
    assert_eq!(verdicts, ["failed", "fine", "failed", "fine"]);
    assert!(rows[0][3].is_empty() && !rows[0][6].is_empty() && rows[0][8] != "0.3", "{rows:?}");
    let study = study.replace("max_steps", "max_time");
    place.study(&study.replace("[3, 100000]", "[1e-9, 1e3]"));
    let said = place.sweep(&["--out", "timed"]);
    says(&said, &["4 rows: 2 fine, 0 doubtful, 2 failed", "the first failure: ", "max_time"]);
    place.study(&study.replace("[3, 100000]", "[1e-9]"));
    let output = place.run(&["sweep", "study.toml", "--out", "none"]);
    assert_eq!(output.status.code(), Some(1));
    says(&stderr(&output), &["no run succeeded"]);
}

/// Killed at twenty random moments and given again, a study computes no row twice, loses none, and finds the same.
#[test]
fn a_killed_study_goes_on() {
    let study = STUDY.replace("values = [4e4, 8e4]", "from = 4e4\nto = 8e4\ncount = 40");
    let place = Place::of_study(&study);
    let clock = Instant::now();
    place.sweep(&["--out", "whole", "-q"]);
    let whole = clock.elapsed();
    let clock = Instant::now();
    place.sweep(&["--out", "whole", "-q", "--gather"]);
    // on an average as long as it takes to begin, and to compute a twentieth
    let longest = 2 * (clock.elapsed() + whole / 20);
    let (mut state, mut before) = (5_u64, BTreeMap::new());
    let mut unfinished = 0;
    for _ in 0..20 {
        let mut child = place.command(&["sweep", "study.toml", "-q"]).spawn().unwrap();
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        sleep(longest.mul_f64((state >> 33) as f64 / 2_f64.powi(31)));
        child.kill().unwrap(); // by SIGKILL
        child.wait().unwrap();
        let now = place.row_files("out/study-sweep");
        assert!(before.iter().all(|(name, row)| now.get(name) == Some(row)));
        unfinished += usize::from(now.len() < 120);
        before = now;
    }
    println!("{} rows after 20 kills, {unfinished} of them before the end", before.len());
    place.sweep(&["-q"]);
    let all = place.row_files("out/study-sweep");
    assert!(before.iter().all(|(name, row)| all.get(name) == Some(row)));
    assert_eq!(all.len(), 120);
    assert_eq!(place.found("out/study-sweep"), place.found("whole"));
    assert_eq!(place.files("out/study-sweep/claims"), Vec::<String>::new());
}

/// Tasks of an array are parts of the same study; what they leave, the command computes; values can be added.
#[test]
fn tasks_and_limits_are_parts_of_a_study() {
    let place = Place::of_study(STUDY);
    place.sweep(&["--out", "whole", "-q"]);
    place.sweep(&["--task", "1", "--batch", "2"]);
    assert_eq!(place.row_files("out/study-sweep").len(), 2);
    assert!(!place.path("out/study-sweep/table.csv").exists());
    says(&place.sweep(&["--gather"]), &["2 rows", "4 are not there yet"]);
    assert_eq!(place.found("out/study-sweep"), place.found("whole")[2..4]);
    says(&place.sweep(&["--limit", "1"]), &["3 rows"]);
    let task =
        place.command(&["sweep", "study.toml", "--task", "env:TASK"]).env("TASK", "5").output();
    assert!(task.unwrap().status.success());
    says(&place.sweep(&[]), &["6 rows"]);
    assert_eq!(place.found("out/study-sweep"), place.found("whole"));
    let before = place.row_files("out/study-sweep");
    place.study(&STUDY.replace("[4e4, 8e4]", "[40000, 6e4, 8.0e4]"));
    says(&place.sweep(&[]), &["9 rows"]);
    let after = place.row_files("out/study-sweep");
    assert!(after.len() == 9 && before.iter().all(|(name, row)| after.get(name) == Some(row)));
    let plan = place.sweep(&["--plan"]);
    assert!(plan.starts_with("id,body.material.young,phase.pull.load.1.force\n"), "{plan}");
    assert_eq!(plan.lines().count(), 10);
}

/// Whole outputs of the runs that fulfil a condition; asked for later, these runs are run again and their rows stay.
#[test]
fn outputs_are_kept() {
    let place = Place::of_study(STUDY);
    place.scene(
        &(bar(0.3).replace("[output]", "[output]\nformats = [\"html\", \"plot\"]") + SENSOR),
    );
    place.sweep(&["-q", "--keep", "body.material.young > 5e4 and right.x:max < 0.1015"]);
    let kept = place.files("out/study-sweep/runs");
    let rows = place.row_files("out/study-sweep");
    let (_, table) = place.rows("out/study-sweep");
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let expected = table.iter().filter(|row| number(&row[1]) > 5e4 && number(&row[4]) < 0.1015);
    let mut expected: Vec<&String> = expected.map(|row| &row[0]).collect();
    expected.sort();
    assert!(!expected.is_empty() && expected.len() < 6);
    assert_eq!(kept.iter().collect::<Vec<_>>(), expected);
    let run = format!("out/study-sweep/runs/{}", kept[0]);
    assert_eq!(
        place.files(&run),
        ["animation.html", "plot.svg", "report.json", "state.json", "trajectory.csv"]
    );
    // nothing of what reads the quantities is left
    assert!(!place.table(&run).0.iter().any(|name| name.contains("sweep")));
    let page = fs::read_to_string(place.path("out/study-sweep/sweep.html")).unwrap();
    says(
        &page,
        &[&format!("runs/{}/animation.html", kept[0]), "data-row=\"5\"", "A bar is pulled"],
    );
    place.sweep(&["-q", "--keep", "verdict = fine"]);
    assert_eq!(place.files("out/study-sweep/runs").len(), 6);
    assert_eq!(place.row_files("out/study-sweep"), rows);
}

/// What stands in for HyperQueue: it runs the tasks of an array one after the other.
const HQ: &str = r#"#!/bin/sh
echo "$@" > hq.txt
while [ "$1" != "--" ]; do
    [ "$1" = "--array" ] && array="$2"
    shift
done
shift
for span in $(echo "$array" | tr , ' '); do
    for HQ_TASK_ID in $(seq ${span%-*} ${span#*-}); do
        export HQ_TASK_ID
        "$@" || exit 1
    done
done
"#;

/// A task array has the tasks whose rows are not there, and its rows are gathered.
#[test]
fn engines_compute_the_same() {
    let place = Place::of_study(STUDY);
    place.sweep(&["--out", "whole", "-q"]);
    place.sweep(&["--task", "2"]);
    let hq = place.path("hq");
    fs::write(&hq, HQ).unwrap();
    fs::set_permissions(&hq, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", place.path("").display(), std::env::var("PATH").unwrap());
    let submit = ["sweep", "study.toml", "--engine", "hyperqueue"];
    let output = place.command(&submit).env("PATH", path).output().unwrap();
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    says(&stdout(&output), &["6 rows: 6 fine"]);
    says(
        &fs::read_to_string(place.path("hq.txt")).unwrap(),
        &["submit --wait", "--array 0-1,3-5", "--cpus 1"],
    );
    assert_eq!(place.found("out/study-sweep"), place.found("whole"));

    says(
        &place.sweep(&["--engine", "slurm", "--batch", "4", "--out", "a b's"]),
        &["slurm.sh: 2 tasks", "--gather"],
    );
    let script = place.path("a b's/slurm.sh");
    says(&fs::read_to_string(&script).unwrap(), &["#SBATCH --array=0-1\n"]);
    for task in ["0", "1"] {
        let mut shell = std::process::Command::new("sh");
        assert!(shell.arg(&script).env("SLURM_ARRAY_TASK_ID", task).status().unwrap().success());
    }
    place.sweep(&["--gather", "--out", "a b's"]);
    assert_eq!(place.found("a b's"), place.found("whole"));

    // two rows, spread over the study, are of two tasks; whole tasks are counted
    says(
        &place.sweep(&["--engine", "slurm", "--batch", "2", "--limit", "2", "--out", "few"]),
        &["slurm.sh: 1 tasks"],
    );

    let output = place
        .command(&[&submit[..], &["--out", "new"]].concat())
        .env("PATH", "/nowhere")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    says(&stderr(&output), &["--engine hyperqueue", "cannot run hq", "hq server start"]);
}

/// Errors name what is wrong, its value, its line, and how to mend it; nothing is computed or written.
#[test]
fn bad_studies_are_refused() {
    let place = Place::of_study(STUDY);
    let young = "[[key]]\nname = \"body.material.young\"\n";
    let head = "scene = \"scene.toml\"\nquantities = [\"com.x:end\"]\n";
    let cases: [(String, &[&str]); 24] = [
        (STUDY.replace("young", "yuong"), &["study.toml:7", "yuong", "did you mean \"young\""]),
        (STUDY.replace("4e4, 8e4", "4e4,\n -1"), &["study.toml:9", "young", "-1", "above 0"]),
        (STUDY.replace("[4e4, 8e4]", "[]"), &["study.toml:7", "body.material.young", "empty"]),
        (STUDY.replace("[4e4, 8e4]", "[4e4, 40000]"), &["study.toml:8", "40000 stands twice"]),
        (format!("{STUDY}{young}values = [1.0]"), &["study.toml:14", "values already (line 7)"]),
        (
            format!("{STUDY}[[key]]\nname = \"phase.1.load.1.force\"\nvalues = [[0.1]]"),
            &["study.toml:14", "the same as phase.pull.load.1.force"],
        ),
        (
            format!("{STUDY}[[key]]\nname = \"body\"\nvalues = [1]"),
            &["study.toml:14", "a part of it"],
        ),
        (STUDY.replace("com.x", "con.x"), &["study.toml:4", "quantities", "con.x", "com"]),
        (STUDY.replace("com.x:end", "com.x"), &["study.toml:4", "one number", "com.x:end"]),
        (STUDY.replace("com.x:end", "motion"), &["study.toml:4", "motion", "one number"]),
        (
            format!("{head}{young}from = 2e4\nto = 1e4\ncount = 3"),
            &["study.toml:4", "20000.0 to 10000.0 is empty"],
        ),
        (format!("{head}{young}from = 1e4\nto = 2e4\ncount = 1"), &["study.toml:4", "count = 1"]),
        (format!("{head}{young}from = 1e4\nto = 2e4\nstep = 0"), &["study.toml:4", "step = 0"]),
        (
            format!("{head}{young}from = 1e4\nto = 2e4"),
            &["study.toml:4", "neither count nor step", "[sample]"],
        ),
        (format!("{head}{young}from = 1e4\ncount = 2"), &["study.toml:3", "to"]),
        (
            format!("{head}{young}from = 0\nto = 2e4\ncount = 3\nscale = \"logarithmic\""),
            &["study.toml:4", "above 0 on a logarithmic"],
        ),
        (format!("{head}{young}from = 1e4\nto = 2e4\ncount = 1000001"), &["1000001", "--yes"]),
        (
            format!(
                "{head}{young}from = 1e4\nto = 2e4\n[sample]\nkind = \"sobol\"\ncount = 2000000"
            ),
            &["2000000", "--yes"],
        ),
        (
            format!("{head}{young}values = [1e4]\n[sample]\nkind = \"sobl\"\ncount = 2"),
            &["study.toml:7", "sobol"],
        ),
        (head.into(), &["none is varied"]),
        (
            AT_REST.replace("\"tip\"", "\"tip:max\"").replace(", \"speed\"", ""),
            &["study.toml:4", "tip:max", "does not move"],
        ),
        (
            AT_REST.replace("static = true", "static = 1"),
            &["study.toml:3", "static", "true or false"],
        ),
        (
            format!("accuracy = 0.01\n{}", AT_REST.replace(", \"speed\"", "")),
            &["accuracy of equilibria = 0.01", "rtol"],
        ),
        (format!("table = \"points.csv\"\n{head}"), &["points.csv"]),
    ];
    for (study, parts) in cases {
        place.study(&study);
        let output = place.run(&["sweep", "study.toml"]);
        assert_eq!(output.status.code(), Some(2), "{study}: {}", stderr(&output));
        says(&stderr(&output), parts);
        assert!(!place.path("out").exists(), "{study}");
    }
    let table = format!("table = \"points.csv\"\n{head}");
    let cases: [(&str, &[&str]); 4] = [
        (
            "body.material.young, solver.rtol\n1e4, 1e-4\n10000, 0.0001\n",
            &["points.csv:3", "line 2"],
        ),
        ("body.material.young\n1e4\n-5\n", &["points.csv:3", "young", "above 0"]),
        ("body.material.young, solver.rtol\n1e4,\n", &["points.csv:2", "solver.rtol", "missing"]),
        ("body.material.young\n", &["points.csv:1", "no rows"]),
    ];
    for (points, parts) in cases {
        place.study(&table);
        fs::write(place.path("points.csv"), points).unwrap();
        let output = place.run(&["sweep", "study.toml"]);
        assert_eq!(output.status.code(), Some(2), "{points}");
        says(&stderr(&output), parts);
    }
    assert!(!place.path("out").exists());
    place.study(STUDY);
    let cases: [(&[&str], &[&str]); 5] = [
        (&["--keep", "con.x:end > 1"], &["con.x:end", "did you mean \"com.x:end\""]),
        (&["--task", "6"], &["--task", "no task 6", "6, from 0"]),
        (&["--batch", "0"], &["--batch = 0"]),
        (&["--cores", "0"], &["cores = 0"]),
        (&["--set", "body.material.yuong=1"], &["yuong", "did you mean"]),
    ];
    for (flags, parts) in cases {
        let output = place.run(&[&["sweep", "study.toml"], flags].concat());
        assert_eq!(output.status.code(), Some(2), "{flags:?}");
        says(&stderr(&output), parts);
    }
}

/// A directory keeps to its study.
#[test]
fn another_study_is_refused() {
    let place = Place::of_study(STUDY);
    place.sweep(&["-q", "--limit", "1"]);
    let refused = |flags: &[&str], parts: &[&str]| {
        let output = place.run(&[&["sweep", "study.toml"], flags].concat());
        assert_eq!(output.status.code(), Some(2));
        says(
            &stderr(&output),
            &[&["out/study-sweep", "holds another study", "--out"], parts].concat(),
        );
    };
    refused(&["--set", "solver.rtol=1e-3"], &["set = [] there, [solver.rtol=1e-3] here"]);
    refused(&["--accuracy", "1%"], &["accuracy = none there, 0.01 here"]);
    place.study(&STUDY.replace("\"com.x:end\", ", ""));
    refused(&[], &["quantities"]);
    place.study(STUDY);
    place.scene(&(bar(0.2) + SENSOR));
    refused(&[], &["its scene differs"]);

    // equilibria and runs of the same quantities
    let ends = STUDY.replace(":max", ":end");
    place.study(&ends);
    place.sweep(&["-q", "--limit", "1", "--out", "ends"]);
    place.study(&("static = true".to_owned() + &ends));
    let output = place.run(&["sweep", "study.toml", "--out", "ends"]);
    says(&stderr(&output), &["holds another study: static = false there, true here"]);
    assert_eq!(place.row_files("out/study-sweep").len(), 1);
}
