//! Studies: errors against closed forms, the reference, files, failures, charts.

mod advise;
mod gradient;
mod look;
mod mesh_estimate;
mod optimize;
mod page;
mod sweep;
mod verified;

use std::f64::consts::PI;
use std::fs;
use std::time::Duration;

use pliant::samples::clamped_beam;
use pliant::study::{
    Failed, Findings, General, Line, Measured, Point, Problem, Row, Scenes, Study,
};
use pliant::{Body, Error, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Strain};

/// Nothing is watched.
fn run(problem: &mut dyn Problem) -> Findings {
    Study::new(problem).repetitions(1).run(&mut |_| ()).unwrap()
}

fn rows<'a>(findings: &'a Findings, line: &str) -> &'a [Row] {
    let line = findings.lines().iter().find(|known| known.name == line);
    &line.unwrap_or_else(|| panic!("{findings:?}")).rows
}

/// An undamped bar of 1 m without density but for `nodes`, clamped at its left end, that starts with
/// its lowest mode as displacement.
fn bar(nodes: usize) -> Scene {
    let material = Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity: 0.0 };
    let body = Body::new(Mesh::bar(1.0, nodes).unwrap(), material)
        .strain(Strain::Cauchy)
        .area(1.0)
        .build()
        .unwrap();
    Scene::new(body)
        .initial_displacement(|x| vec![0.1 * (0.5 * PI * x[0]).sin()])
        .phase(Phase::until(20.0).hold("left"))
}

/// Angular frequency of the lowest mode of the bar, divided into segments of length h with consistent
/// inertia: (1/h) sqrt(6 (1 - cos t)/(2 + cos t)), t = pi h/2.
fn frequency(nodes: usize) -> f64 {
    let h = 1.0 / (nodes - 1) as f64;
    let cosine = (0.5 * PI * h).cos();
    (6.0 * (1.0 - cosine) / (2.0 + cosine)).sqrt() / h
}

/// The mode of the bar is that of the discrete one: each node moves as cos(omega t). What the
/// study gives as error must be the distance from that, up to the resolution of its reference.
#[test]
fn errors_are_distances_from_the_exact_motion() {
    let methods = [Method::CvodeBdf, Method::CvodeAdams, Method::Ida, Method::Rk];
    let tolerances = [1e-3, 1e-5, 1e-7];
    let mut scenes = Scenes::new("bar", bar(5)).tolerances(tolerances);
    for method in methods {
        scenes = scenes.line(method.name(), Settings { method, ..Settings::default() });
    }
    let findings = run(&mut scenes);
    // Which two methods make the reference is a matter of their processor times: 3e-9 to 1.4e-8.
    assert!(findings.resolution() < 1e-7 / 5.0, "{}", findings.resolution());
    for method in methods {
        let rows = rows(&findings, method.name());
        for (row, rtol) in rows.iter().zip(tolerances) {
            let settings = Settings { method, rtol, ..Settings::default() };
            let times: Vec<f64> = (1..=101).map(|k| 20.0 * (f64::from(k) / 101.0)).collect();
            let trajectory = bar(5).simulate(&settings, &Sampling::at(times)).unwrap();
            let start = &trajectory.samples()[0].u;
            let (mut squares, mut motion, mut largest) = (0.0, 0.0, 0.0_f64);
            for sample in &trajectory.samples()[1..] {
                for (u, start) in sample.u.iter().zip(start) {
                    let exact = start * (frequency(5) * sample.time).cos();
                    squares += (u - exact).powi(2);
                    motion += exact.powi(2);
                    largest = largest.max((u - exact).abs());
                }
            }
            let nodes_and_times = 5.0 * 101.0;
            let scale = (motion / nodes_and_times).sqrt();
            for (found, exact) in [
                (row.error, (squares / nodes_and_times).sqrt() / scale),
                (row.largest_error, largest / scale),
            ] {
                // The reference is exact to its resolution in the mean; the largest distance at
                // one node and time can be some times that.
                let off = (found.unwrap() - exact).abs();
                assert!(off < 10.0 * row.resolution, "{method} {rtol}: {found:?} {exact}");
            }
        }
        // A variable-step method follows the tolerance, up to a factor.
        for pair in rows.windows(2) {
            assert!(pair[1].error.unwrap() < 0.2 * pair[0].error.unwrap(), "{pair:?}");
        }
    }
}

/// Root mean square of cos(omega t) - cos(exact t) at the times of a study, relative to that of
/// cos(exact t).
fn dephased(omega: f64, exact: f64) -> f64 {
    let (mut squares, mut motion) = (0.0, 0.0);
    for k in 1..=101 {
        let t = 20.0 * (f64::from(k) / 101.0);
        squares += ((omega * t).cos() - (exact * t).cos()).powi(2);
        motion += (exact * t).cos().powi(2);
    }
    (squares / motion).sqrt()
}

/// Coarse meshes are too stiff, by the square of the length of their segments: what a study finds
/// at the three nodes that all meshes share is what that makes of the motion.
#[test]
fn a_mesh_study_finds_the_error_of_the_mesh() {
    let settings = Settings { method: Method::CvodeAdams, rtol: 1e-8, ..Settings::default() };
    let meshes = [3, 5, 9, 17].map(|nodes| (format!("{nodes} nodes"), bar(nodes)));
    let mut scenes = Scenes::new("bar", bar(129))
        .finest(1e-3)
        .checked_by(bar(65))
        .meshes("segments", meshes, &settings);
    let findings = run(&mut scenes);
    for (row, nodes) in rows(&findings, "segments").iter().zip([3, 5, 9, 17]) {
        let exact = dephased(frequency(nodes), frequency(129));
        // the methods agree on the reference to 1e-3/30
        assert!((row.error.unwrap() - exact).abs() < 4e-5, "{nodes}: {:?} {exact}", row.error);
        assert_eq!(row.point, format!("{nodes} nodes"));
    }
    // The check is off by four times as much as the reference, which leaves three.
    let exact = dephased(frequency(65), frequency(129));
    assert!((findings.resolution() - exact).abs() < 1e-5, "{} {exact}", findings.resolution());
    assert!(findings.resolution() > dephased(frequency(129), 0.5 * PI));
}

/// A line that starts another scene is compared with the first one.
#[test]
fn a_variant_is_wrong_by_what_it_does_differently() {
    let material = Material { density: 1.0, young: 1.1, poisson: 0.0, viscosity: 0.0 };
    let stiffer = Body::new(Mesh::bar(1.0, 5).unwrap(), material)
        .strain(Strain::Cauchy)
        .area(1.0)
        .build()
        .unwrap();
    let stiffer = Scene::new(stiffer)
        .initial_displacement(|x| vec![0.1 * (0.5 * PI * x[0]).sin()])
        .phase(Phase::until(20.0).hold("left"));
    let mut scenes = Scenes::new("bar", bar(5))
        .tolerances([1e-6])
        .line("same", Settings::default())
        .variant("stiffer", stiffer, Settings::default());
    let findings = run(&mut scenes);
    let error = rows(&findings, "stiffer")[0].error.unwrap();
    let exact = dephased(1.1_f64.sqrt() * frequency(5), frequency(5));
    assert!((error - exact).abs() < 1e-4, "{error} {exact}");
    assert!(rows(&findings, "same")[0].error.unwrap() < 1e-4);
}

/// A problem that is made up: what each run takes and finds is known beforehand.
struct Made {
    title: &'static str,
    lines: Vec<Line>,
    /// What was asked for: line, point, limit (s).
    asked: Vec<(usize, usize, f64)>,
    prepared: usize,
}

impl Made {
    fn new(title: &'static str, points: &[&str]) -> Self {
        let line = |name: &str| Line {
            name: name.into(),
            family: "made up".into(),
            points: points.iter().map(|&name| Point { name: name.into(), rtol: 0.1 }).collect(),
        };
        let lines = ["first", "second", "broken"].map(line).into();
        Self { title, lines, asked: Vec::new(), prepared: 0 }
    }
}

impl Problem for Made {
    fn title(&self) -> &str {
        self.title
    }

    fn lines(&self) -> &[Line] {
        &self.lines
    }

    fn fingerprint(&self, line: usize, point: usize) -> u64 {
        (100 * self.title.len() + 10 * line + point) as u64
    }

    fn prepare(&mut self, _limit: Duration, _tell: &mut dyn FnMut(&str)) -> Result<f64, Error> {
        self.prepared += 1;
        Ok(1e-5)
    }

    /// The first line reaches 1e-1, 1e-2, ... in 1, 10, ... s, the second in half the time of that
    /// and a fourfold one for each further digit.
    fn measure(&mut self, line: usize, point: usize, limit: Duration) -> Result<Measured, Failed> {
        self.asked.push((line, point, limit.as_secs_f64()));
        if self.lines[line].name == "broken" {
            return Err("out, of \"order\"\nfor ever".into());
        }
        let error = 10_f64.powi(-1 - point as i32);
        let seconds = self.time(line, point)?;
        Ok(Measured { error, largest_error: 2.0 * error, seconds, steps: 7, ..Measured::default() })
    }

    fn time(&mut self, line: usize, point: usize) -> Result<f64, Failed> {
        Ok([1.0, 0.5][line] * [10.0_f64, 40.0][line].powi(point as i32))
    }
}

#[test]
fn a_run_that_fails_is_a_row_and_slow_ones_are_given_up() {
    let mut problem = Made::new("made", &["a", "b", "c"]);
    let findings = Study::new(&mut problem).limit(500.0).run(&mut |_| ()).unwrap();
    let broken = rows(&findings, "broken");
    assert_eq!(broken.len(), 3);
    for row in broken {
        assert_eq!(row.failure.as_deref(), Some("out, of \"order\"\nfor ever"));
        assert_eq!((row.error, row.steps), (None, None));
    }
    let steps: Vec<_> = rows(&findings, "first").iter().map(|row| row.steps).collect();
    assert_eq!(steps, [Some(7); 3]);
    // rough points first; twenty times the fastest at the point so far, and never above the limit
    assert_eq!(
        problem.asked,
        [
            (0, 0, 500.0),
            (1, 0, 20.0),
            (2, 0, 10.0),
            (0, 1, 500.0),
            (1, 1, 200.0),
            (2, 1, 200.0),
            (0, 2, 500.0),
            (1, 2, 500.0),
            (2, 2, 500.0),
        ]
    );
    let notes = findings.notes().join("\n");
    assert!(notes.contains("broken at a failed: out, of"), "{notes}");
}

#[test]
fn the_table_names_the_fastest_for_each_accuracy() {
    let findings = run(&mut Made::new("made", &["a", "b", "c", "d", "e"]));
    let fastest = findings.fastest();
    let of = |digits: usize| &fastest.accuracies[digits - 1];
    // 10^-k: 10^(k-1) s by the first line, 0.5 x 40^(k-1) s by the second
    assert_eq!(of(1).reached, [("second".into(), 0.5), ("first".into(), 1.0)]);
    assert_eq!(of(2).reached, [("first".into(), 10.0), ("second".into(), 20.0)]);
    assert_eq!(of(2).missed, ["broken"]);
    // The reference resolves 1e-5: 1e-4 is ten times that, and 1e-5 is not.
    assert!(of(4).is_resolved && !of(5).is_resolved && of(5).reached.is_empty());
    let table = fastest.markdown();
    let second = "| 1e-2 | first | 10.0 s | second 2.0; not reached: broken |";
    assert_eq!(table.lines().nth(3), Some(second));
    assert_eq!(table.lines().nth(6), Some("| 1e-5 | beyond the reference |  |  |"));
    let text = fastest.to_string();
    assert_eq!(text.lines().nth(1).unwrap().split_whitespace().nth(1), Some("second"));
    assert_eq!(text.lines().count(), 8);
}

#[test]
fn a_study_is_resumed_where_it_stopped() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("kept.csv");
    let keep = |problem: &mut Made| {
        Study::new(problem).repetitions(2).keep(&file).run(&mut |_| ()).unwrap()
    };
    let mut other = Made::new("another", &["a"]);
    let others = keep(&mut other);
    let mut stopped = Made::new("made", &["a"]);
    keep(&mut stopped);
    assert_eq!((stopped.asked.len(), stopped.prepared), (3, 1));
    let mut resumed = Made::new("made", &["a", "b"]);
    let findings = keep(&mut resumed);
    assert_eq!(resumed.asked.iter().map(|run| run.1).collect::<Vec<_>>(), [1, 1, 1]);
    let mut done = Made::new("made", &["a", "b"]);
    // the same to the last digit, with its commas, quotes and line ends
    assert_eq!(keep(&mut done), findings);
    assert_eq!((done.asked.len(), done.prepared), (0, 0));
    assert_eq!(keep(&mut Made::new("another", &["a"])), others);
    assert_eq!(findings.rows().count(), 6);
    let table = directory.path().join("table.csv");
    findings.write_csv(&table).unwrap();
    let header = fs::read_to_string(&table).unwrap();
    assert!(header.starts_with("problem,line,family,point,rtol,error,largest_error,resolution,"));

    fs::write(&file, "rubbish,more\n1,2\n").unwrap();
    let result = Study::new(&mut done).keep(&file).run(&mut |_| ());
    assert!(matches!(&result, Err(Error::Read { path, .. }) if *path == file), "{result:?}");
}

#[test]
fn scenes_are_told_apart_by_what_they_are_and_how_they_are_solved() {
    let settings = Settings::default();
    let beam = |viscosity| Scenes::new("beam", clamped_beam([6, 2], viscosity).unwrap());
    let of = |scenes: Scenes, settings: &Settings| {
        scenes.tolerances([1e-3, 1e-4]).line("line", settings.clone()).fingerprint(0, 1)
    };
    let same = of(beam(0.0), &settings);
    assert_eq!(same, of(beam(0.0), &Settings { rtol: 1e-9, ..settings.clone() }));
    let more = beam(0.0).tolerances([1e-4, 1e-5]).line("line", settings.clone());
    assert_eq!((same, false), (more.fingerprint(0, 0), same == more.fingerprint(0, 1)));
    let low = Settings { max_order: Some(2), ..settings.clone() };
    let variant = clamped_beam([6, 2], 1.0).unwrap();
    let variant = beam(0.0).tolerances([1e-3, 1e-4]).variant("line", variant, settings.clone());
    for other in [
        of(beam(1.0), &settings),
        of(beam(0.0).alpha(1e4), &settings),
        of(beam(0.0).finest(1e-4), &settings),
        of(beam(0.0), &low),
        variant.fingerprint(0, 1),
    ] {
        assert_ne!(same, other);
    }
}

#[test]
fn general_problems_are_measured_against_their_trusted_end_states() {
    let mut hires = General::hires().tolerances([1e-3, 1e-5, 1e-7]);
    let findings = run(&mut hires);
    assert_eq!(findings.resolution(), 1e-13);
    for line in findings.lines() {
        let errors: Vec<f64> = line.rows.iter().map(|row| row.error.unwrap()).collect();
        let steps: Vec<usize> = line.rows.iter().map(|row| row.steps.unwrap()).collect();
        assert!(steps.is_sorted(), "{}: {steps:?}", line.name);
        // Errors add up over the run; stiff ones are damped on the way.
        assert!(errors[2] < 1e-4 && errors[2] < 0.03 * errors[0], "{}: {errors:?}", line.name);
    }
    // The end of Robertson's problem is far beyond what an explicit method can reach.
    let mut robertson = General::robertson().tolerances([1e-6]);
    let findings = Study::new(&mut robertson).repetitions(1).limit(1.0).run(&mut |_| ()).unwrap();
    let failure = rows(&findings, "rk")[0].failure.as_deref().unwrap();
    assert!(failure.starts_with("given up after"), "{failure}");
    assert!(rows(&findings, "cvode-bdf")[0].error.unwrap() < 1e-4);
    assert!(rows(&findings, "ida")[0].error.unwrap() < 1e-4);
}

#[test]
fn charts_are_drawn_as_lines_and_as_pixels() {
    let directory = tempfile::tempdir().unwrap();
    let findings = run(&mut Made::new("made & <drawn>", &["a", "b", "c", "d", "e"]));
    let file = directory.path().join("chart.svg");
    findings.write_chart(&file).unwrap();
    let drawing = fs::read_to_string(&file).unwrap();
    let document = roxmltree::Document::parse(&drawing).unwrap();
    let lines = document.descendants().filter(|node| node.has_attribute("stroke-dasharray"));
    // two lines, and three in the legend
    assert_eq!(lines.count(), 5);
    let texts: Vec<_> =
        document.descendants().filter_map(|node| Some(node.text()?.trim())).collect();
    for text in ["made & <drawn>", "broken (5 of 5 runs failed)", "10⁻³", "100 s"] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    let file = directory.path().join("chart.png");
    findings.write_chart(&file).unwrap();
    let picture = fs::read(&file).unwrap();
    assert_eq!(&picture[1..4], b"PNG");
    let size = [16, 20].map(|at| u32::from_be_bytes(picture[at..at + 4].try_into().unwrap()));
    assert_eq!(size, [2 * 980, 2 * 528]);
}

fn message<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn bad_input_is_named() {
    let scenes = || Scenes::new("bar", bar(3)).tolerances([1e-3]).line("bdf", Settings::default());
    let study = |scenes: &mut Scenes| Study::new(scenes).run(&mut |_| ());
    let said = message(Study::new(&mut scenes()).repetitions(0).run(&mut |_| ()));
    assert!(said.starts_with("repetitions = 0"), "{said}");
    for (name, value) in [("limit", 0.0), ("limit", 1e300), ("patience", f64::NAN)] {
        let mut scenes = scenes();
        let study = Study::new(&mut scenes);
        let study = if name == "limit" { study.limit(value) } else { study.patience(value) };
        let said = message(study.run(&mut |_| ()));
        assert!(said.starts_with(&format!("{name} = ")), "{said}");
    }
    let said = message(study(&mut scenes().finest(0.0)));
    assert!(said.starts_with("finest = 0"), "{said}");
    let said = message(study(&mut scenes().tolerances([2.0]).line("rough", Settings::default())));
    assert!(said.starts_with("rtol = 2"), "{said}");
    let said = message(study(&mut scenes().line("bdf", Settings::default())));
    assert!(said.starts_with("name of a line = \"bdf\""), "{said}");
    let longer = bar(3).phase(Phase::until(21.0));
    let said = message(study(&mut scenes().variant("longer", longer, Settings::default())));
    assert!(said.starts_with("end of a scene = 21 s"), "{said}");
    let elsewhere = Body::new(
        Mesh::bar(1.0, 3).unwrap().translated(&[5.0]).unwrap(),
        Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity: 0.0 },
    )
    .strain(Strain::Cauchy);
    let elsewhere = Scene::new(elsewhere.area(1.0).build().unwrap()).phase(Phase::until(20.0));
    let said = message(study(&mut scenes().variant("elsewhere", elsewhere, Settings::default())));
    assert!(said.starts_with("number of nodes that all meshes share = 0"), "{said}");
    let result = Study::new(&mut scenes()).limit(1e-9).run(&mut |_| ());
    assert!(matches!(result, Err(Error::Reference { .. })), "{result:?}");

    let findings = run(&mut Made::new("made", &["a"]));
    let said = message(findings.write_chart("chart.pdf"));
    assert!(said.starts_with("file of a chart = chart.pdf"), "{said}");
    let mut nothing = Made::new("made", &["a"]);
    nothing.lines.drain(..2);
    let said = message(run(&mut nothing).write_chart("chart.svg"));
    assert!(said.starts_with("number of successful runs = 0"), "{said}");
}
