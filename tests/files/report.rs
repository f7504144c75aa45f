//! `report.json`: every key, and the numbers of the run itself.

use std::fs;
use std::ops::ControlFlow;

use pliant::IntegrationFailure;
use pliant::output::{write_report, write_static_report};
use pliant::samples::{SQUARE_MATERIAL, ring_springs, square_jump};
use pliant::simulate::Reading;
use pliant::study::{Quantity, Verification};
use pliant::{
    Body, Cells, Error, Mesh, MeshEstimate, Method, Phase, Sampling, Scene, SceneFile, Settings,
    Statics, Strain,
};
use pliant::{Trajectory, sundials};
use serde_json::{Value, json};

const COUNTS: [&str; 8] = [
    "steps",
    "rhs_evaluations",
    "jacobian_evaluations",
    "difference_evaluations",
    "factorizations",
    "linear_iterations",
    "error_test_failures",
    "convergence_failures",
];

/// All keys of a report in their order, those of tables after a dot, as the reference page has them.
fn keys(value: &Value) -> Vec<String> {
    let mut all = Vec::new();
    for (key, value) in value.as_object().unwrap() {
        all.push(key.clone());
        let (inner, dot) = match value {
            Value::Array(list) => (list.first().unwrap_or(&Value::Null), "[]."),
            value => (value, "."),
        };
        if inner.is_object() {
            all.extend(keys(inner).iter().map(|inner| format!("{key}{dot}{inner}")));
        }
    }
    all
}

/// The keys that the reference page has under a heading.
fn documented(command: &str) -> Vec<String> {
    let page = include_str!("../../docs/reference.md");
    let heading = format!("### Keys of `report.json` of `pliant {command}`");
    let section = page.split_once(&heading).unwrap().1.split("\n#").next().unwrap();
    let keys = section.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    keys.map(String::from).collect()
}

fn without(keys: Vec<String>, table: &str) -> Vec<String> {
    keys.into_iter().filter(|key| !key.starts_with(table)).collect()
}

/// The keys of a run with all unknowns, and of one that was not verified.
fn of_full_run() -> Vec<String> {
    without(documented("run"), "reduced.")
}

fn of_run() -> Vec<String> {
    without(of_full_run(), "achieved.")
}

fn written(run: Result<&Trajectory, &IntegrationFailure>) -> Value {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("new/report.json");
    write_report(run, &path).unwrap();
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn sum(report: &Value, key: &str) -> f64 {
    report["phases"].as_array().unwrap().iter().map(|phase| phase[key].as_f64().unwrap()).sum()
}

#[test]
fn a_finished_run() {
    let settings =
        Settings { method: Method::Ida, rtol: 1e-4, alpha: 500.0, ..Settings::default() };
    let sampling = Sampling::every(0.01).read("top", Reading::position("top"));
    let run = square_jump(4).unwrap().simulate(&settings, &sampling).unwrap();
    let report = written(Ok(&run));
    let expected = without(without(of_run(), "failure."), "phases[].slips[].");
    assert_eq!(keys(&report), expected);
    let phases = report["phases"].as_array().unwrap();
    for (phase, (name, end)) in phases.iter().zip([("push", 0.5), ("hold", 1.0), ("free", 1.5)]) {
        assert_eq!((&phase["name"], &phase["end"]), (&json!(name), &json!(end)));
        assert!((1..=5).contains(&phase["last_order"].as_u64().unwrap()));
        assert!(phase["last_step"].as_f64().unwrap() > 0.0);
    }
    assert_eq!(phases.len(), 3);
    assert_eq!((&report["status"], &report["failure"]), (&json!("finished"), &Value::Null));
    assert_eq!((&report["method"], &report["rtol"]), (&json!("ida"), &json!(1e-4)));
    assert_eq!(report["alpha"], 500.0);
    // 16 nodes: displacements, velocities, two energies, and 12 multipliers while it is held
    assert_eq!((&report["states"], &phases[0]["states"]), (&json!(66), &json!(78)));
    for key in COUNTS {
        assert_eq!(report[key].as_f64().unwrap(), sum(&report, key), "{key}");
    }
    assert!(report["wall_seconds"].as_f64().unwrap() >= sum(&report, "wall_seconds"));
    // the energy balance, once more from the samples
    let balance = run.samples().iter().map(|sample| sample.energy.balance().abs());
    let error = report["energy_balance_error"].as_f64().unwrap();
    assert!((error - balance.fold(0.0, f64::max)).abs() < 1e-12, "{error}");
    assert!(error < 0.01 * report["energy_scale"].as_f64().unwrap());
    // the square is Hirai's, whose few cells lock and turn under Cauchy strain, on a floor as soft as foam
    let warnings: Vec<&str> =
        report["warnings"].as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect();
    assert_eq!(warnings, run.report().doubts());
    for (warning, part) in
        warnings.iter().zip(["Poisson's ratio", "Cauchy", "too coarse", "inside obstacle"])
    {
        assert!(warning.contains(part), "{warning}");
    }
    assert_eq!(warnings.len(), 4);
    let drift = report["max_constraint_drift"].as_f64().unwrap();
    assert!(drift > 0.0 && run.samples().iter().all(|sample| sample.constraint_drift <= drift));
    assert_eq!(report["versions"]["sundials"], sundials::version());
}

#[test]
fn what_two_runs_differ_by() {
    let scene = square_jump(4).unwrap();
    let verification = Verification::new(&scene, 0.01);
    let motion = verification.finish(|_| ControlFlow::Continue(())).unwrap();
    let report = written(Ok(&motion));
    let documented = without(without(of_full_run(), "failure."), "phases[].slips[].");
    assert_eq!(keys(&report), documented);
    let achieved = &report["achieved"];
    assert_eq!([&achieved["quantity"], &achieved["unit"]], [&json!("motion"), &json!("m")]);
    assert!(achieved["difference"].as_f64().unwrap() <= achieved["asked"].as_f64().unwrap());
    assert_eq!(report["sensors"], json!([{ "name": "difference", "unit": "m" }]));
}

#[test]
fn what_slips_and_sticks() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/stick-slip.toml");
    let SceneFile { scene, settings, .. } = SceneFile::read(file).unwrap();
    let run = scene.simulate(&settings, &Sampling::phase_ends());
    let report = written(Ok(&run.unwrap()));
    let documented = without(without(of_run(), "failure."), "sensors[].");
    assert_eq!(keys(&report), documented);
    let slips = report["phases"][0]["slips"].as_array().unwrap();
    for (slip, slides) in slips.iter().zip([true, false]) {
        assert_eq!([&slip["obstacle"], &slip["slides"]], [&json!("belt"), &json!(slides)]);
    }
}

#[test]
fn runs_that_end_early() {
    let failed = ring_springs(5.0).unwrap().simulate(&Settings::default(), &Sampling::every(0.01));
    let Err(Error::Integration(failure)) = failed else { panic!("no failure") };
    let report = written(Err(&failure));
    assert_eq!(report["status"], "failed");
    let expected = without(without(of_run(), "sensors[]."), "phases[].slips[].");
    assert_eq!(keys(&report), expected);
    // the springs A2 and A6 shrink to nothing 10 ms after they begin to
    assert!((report["failure"]["time"].as_f64().unwrap() - 0.21).abs() < 0.003);
    let cause = report["failure"]["cause"].as_str().unwrap();
    assert!(cause.contains("spring \"A2\"") || cause.contains("spring \"A6\""), "{cause}");
    assert_eq!(report["phases"].as_array().unwrap().len(), 2);
    assert_eq!(report["phases"][1]["end"], report["failure"]["time"]);

    let stopped = square_jump(4).unwrap().simulate_with(
        &Settings::default(),
        &Sampling::phase_ends(),
        |_| ControlFlow::Break(()),
    );
    let Err(Error::Integration(end)) = stopped else { panic!("not stopped") };
    let report = written(Err(&end));
    assert_eq!((&report["status"], &report["steps"]), (&json!("interrupted"), &json!(1)));
    assert_eq!(report["failure"]["cause"], "interrupted");
}

/// Rough tolerances make energy from nothing: the report says so.
#[test]
fn warnings_are_told() {
    let bar = Mesh::bar(0.1, 6).unwrap();
    let material = pliant::Material { viscosity: 0.0, ..pliant::samples::BEAM_MATERIAL };
    let body = Body::new(bar, material).strain(Strain::Cauchy).area(2e-4).build().unwrap();
    let scene = Scene::new(body)
        .initial_velocity(|x| vec![20.0 * x[0]])
        .phase(Phase::until(0.5).hold("left"));
    let rough = Settings { method: Method::CvodeBdf, rtol: 0.5, ..Settings::default() };
    let run = scene.simulate(&rough, &Sampling::every(0.01)).unwrap();
    let report = written(Ok(&run));
    let warning = report["warnings"][0].as_str().unwrap();
    assert!(warning.contains("the integrator created"), "{warning}");
    assert!(run.report().to_string().contains(&format!("WARNING: {warning}")));
    // Runge and Kutta's notice that stability bounds the steps
    let stiff = Settings { method: Method::Rk, alpha: 1e5, ..Settings::default() };
    let run = square_jump(4).unwrap().simulate(&stiff, &Sampling::phase_ends()).unwrap();
    let report = written(Ok(&run));
    let warning = report["warnings"][0].as_str().unwrap();
    assert!(warning.contains("phase \"push\""), "{warning}");
}

#[test]
fn equilibria() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("report.json");
    let read = || -> Value { serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap() };
    let scene = |strain, force: f64| {
        let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
        let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(strain);
        let phase = Phase::until(1.0).hold("bottom").load_total("top", [0.0, force]);
        Scene::new(body.build().unwrap()).phase(phase)
    };
    let found = scene(Strain::Cauchy, -100.0).equilibrium(&Statics::default()).unwrap();
    write_static_report(Ok(&found), &path).unwrap();
    let report = read();
    assert_eq!(
        keys(&report),
        without(without(without(documented("static"), "failure."), "mesh_estimate."), "sensors[].")
    );
    assert_eq!((&report["status"], &report["method"]), (&json!("finished"), &json!("static")));
    assert_eq!(report["states"], 32);
    assert_eq!(report["stability"]["kind"], "stable");
    let frequency = report["stability"]["frequency"].as_f64().unwrap();
    let lowest = scene(Strain::Cauchy, 0.0).spectrum().unwrap()[0].lowest_frequency.unwrap();
    // both iterations end at three digits
    assert!((std::f64::consts::TAU * frequency / lowest - 1.0).abs() < 2e-7, "{frequency}");

    let mut found = found;
    let quantity = Quantity::named("top.y", found.trajectory().scene(), &[]).unwrap();
    found.mesh_estimate = Some(MeshEstimate::of(&found, &quantity).unwrap());
    write_static_report(Ok(&found), &path).unwrap();
    let report = read();
    assert_eq!(keys(&report), without(without(documented("static"), "failure."), "sensors[]."));
    let estimate = &report["mesh_estimate"];
    assert_eq!([&estimate["quantity"], &estimate["unit"]], [&json!("top.y"), &json!("m")]);
    // 7 x 7 nodes with those in the middles of edges
    assert_eq!(estimate["unknowns"], 98);
    let number = |key: &str| estimate[key].as_f64().unwrap();
    assert!((number("value") - number("change") - 0.3).abs() < 1e-12, "{estimate}");
    let relative = number("correction") / number("change");
    assert!(number("value") < 0.3 && relative > 0.0 && relative == number("relative"));
    // a linear problem leaves round-off
    assert!(number("remainder").abs() < 1e-9 * number("correction").abs(), "{estimate}");

    // pressed by ten times its stiffness, a St. Venant-Kirchhoff square collapses
    let lost = scene(Strain::Green, -5e4).equilibrium(&Statics::default());
    let Err(Error::Statics(lost)) = lost else { panic!("no failure") };
    write_static_report(Err(&lost), &path).unwrap();
    let report = read();
    assert_eq!(report["status"], "failed");
    assert_eq!(
        keys(&report),
        without(
            without(without(documented("static"), "stability."), "mesh_estimate."),
            "sensors[]."
        )
    );
    let (fraction, tried) = (&report["failure"]["fraction"], &report["failure"]["tried"]);
    assert!(fraction.as_f64().unwrap() < tried.as_f64().unwrap());
    assert_eq!((&report["stability"], &report["load_steps"]), (&Value::Null, &Value::Null));
}

#[test]
fn a_run_by_a_reduced_model() {
    let scene = square_jump(4).unwrap().ended_at(0.5);
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    let training = pliant::reduce::Training {
        scenes: vec![scene.clone()],
        held_out: Vec::new(),
        settings: settings.clone(),
        within: 0.05,
        most_unknowns: 64,
    };
    let model = pliant::reduce::reduce(&training, &mut |_| std::ops::ControlFlow::Continue(()))
        .unwrap()
        .model;
    let [unknowns, error] = [model.unknowns() as f64, model.error()];
    let reduced = scene.reduced(model).unwrap();
    let sampling = Sampling::every(0.1).read("top", pliant::simulate::Reading::position("top"));
    let report = written(Ok(&reduced.simulate(&settings, &sampling).unwrap()));
    assert!(documented("run").iter().filter(|key| key.starts_with("reduced.")).all(|key| {
        let pointer = format!("/{}", key.replace("[].", ".0.").replace('.', "/"));
        report.pointer(&pointer).is_some_and(|value| !value.is_null())
    }));
    assert_eq!(report["reduced"]["is_estimate"], false);
    let told = &report["reduced"]["readings"][1];
    assert_eq!((&told["name"], &told["unit"]), (&"top.y".into(), &"m".into()));
    assert!(told["error"].as_f64().unwrap() > 0.0);
    assert_eq!(report["reduced"]["shapes"].as_f64(), Some(unknowns));
    assert_eq!(report["reduced"]["checked_error"].as_f64(), Some(error));
}
