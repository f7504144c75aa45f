//! `pliant fit`: what was put into a motion comes out of it, and what cannot.

use std::fmt::Write;
use std::fs;

use pliant::fit::{Measured, SceneFit, Unknown, least_squares};
use pliant::{Error, InputError};

use super::{Place, says, stderr, stdout};

/// A beam that is let go under its own weight.
const SCENE: &str = r#"
gravity = [0.0, -9.8]

[body]
mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [6, 2], cells = "triangles6" }
thickness = 0.01
material = { density = 1000.0, young = 1.0e5, poisson = 0.4, viscosity = 100.0 }

[[obstacle]]
name = "far"
kind = "half-plane"
point = [0.0, -1.0]
normal = [0.0, 1.0]
stiffness = 100.0

[[phase]]
until = 0.6
hold = [{ nodes = "left" }]

[[sensor]]
name = "tip"
kind = "position"
nodes = "right"

[solver]
rtol = 1e-6
"#;

/// Noise (m) of the measurement: between -1 and 1 times this, by a linear congruence.
const NOISE: f64 = 2e-4;

/// What a sensor would have measured of the scene as it stands.
fn measured(place: &Place) -> usize {
    let scene = place.scene(SCENE);
    let done = place.run(&["run", scene, "--step", "0.02", "--quiet", "--out", "truth"]);
    assert!(done.status.success(), "{done:?}");
    let (head, rows) = place.table("truth");
    let tip = head.iter().position(|name| name == "tip.y").unwrap();
    let mut table = "time, tip.y\n".to_owned();
    let mut state = 1_u64;
    for row in &rows {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let noise = NOISE * ((state >> 11) as f64 / 2_f64.powi(52) - 1.0);
        writeln!(table, "{}, {}", row[0], row[tip] + noise).unwrap();
    }
    fs::write(place.path("tip.csv"), table).unwrap();
    rows.len()
}

fn fit(place: &Place, unknowns: &[Unknown]) -> Result<pliant::fit::SceneFitted, pliant::Error> {
    let data = Measured::read(place.path("tip.csv"))?;
    SceneFit::new(place.path("scene.toml"), &[], &data)?.fit(unknowns, &mut |_, _| {})
}

/// The values with which the motion was made lie within the intervals of 95 % that the fit tells, which are no wider than 3 %;
/// what is left over is the noise, of root mean square 1/sqrt(3) of its bound.
#[test]
fn what_made_a_motion_is_found_in_it() {
    let place = Place::new();
    let count = measured(&place);
    let unknowns = [
        Unknown::new("body.material.young", 3e4, 4e5),
        Unknown::new("body.material.viscosity", 10.0, 1000.0),
    ];
    let found = fit(&place, &unknowns).unwrap();
    for (found, truth) in found.fitted.unknowns.iter().zip([1e5, 100.0]) {
        let (off, within) = ((found.value - truth).abs(), found.confidence);
        assert!(off < within && within < 0.03 * truth, "{found:?}");
    }
    let [before, after] = found.columns[0].rms;
    assert!(found.fitted.is_converged && found.columns[0].residuals.len() == count);
    assert!(
        (after / (NOISE / 3_f64.sqrt()) - 1.0).abs() < 0.2 && before > 10.0 * after,
        "{before} {after}"
    );

    // the flags that the command prints lead to the same motion
    let flags = "--unknown body.material.young=3e4..4e5 --unknown body.material.viscosity=10..1000 --plot left.svg --quiet";
    let mut arguments = vec!["fit", "scene.toml", "--data", "tip.csv"];
    arguments.extend(flags.split(' '));
    let done = place.run(&arguments);
    assert!(done.status.success(), "{done:?}");
    let told = stdout(&done);
    let set = told.lines().find(|line| line.starts_with("--set")).unwrap();
    assert_eq!(
        set,
        found.overrides().iter().map(|over| format!("--set {over}")).collect::<Vec<_>>().join(" ")
    );
    assert!(fs::read_to_string(place.path("left.svg")).unwrap().contains("tip.y (m)"));
}

/// An obstacle that nothing touches, a stiffness and a density of which only the ratio moves the beam: neither can be told.
#[test]
fn what_the_data_do_not_tell_is_named() {
    let place = Place::new();
    measured(&place);
    let young = Unknown::new("body.material.young", 3e4, 4e5);
    let untouched =
        fit(&place, &[young.clone(), Unknown::new("obstacle.far.stiffness", 10.0, 1e3)]);
    let message = untouched.unwrap_err().to_string();
    assert!(message.starts_with("unknown = obstacle.far.stiffness cannot be used"), "{message}");

    let density = Unknown::new("body.material.density", 300.0, 3000.0);
    let viscosity = Unknown::new("body.material.viscosity", 10.0, 1000.0);
    let message = fit(&place, &[young, density, viscosity]).unwrap_err().to_string();
    assert!(
        message.starts_with("unknowns = body.material.young, body.material.density"),
        "{message}"
    );
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let place = Place::new();
    measured(&place);
    fs::write(place.path("other.csv"), "t,top.y\n0.1,0.2\n").unwrap();
    fs::write(place.path("late.csv"), "t,tip.y\n7.0,0.2\n8.0,0.2\n").unwrap();
    fs::write(place.path("few.csv"), "t,tip.y\n0.1,0.2\n").unwrap();
    fs::write(place.path("word.csv"), "t,tip.y\n0.1,high\n").unwrap();
    fs::write(place.path("row.csv"), "tip.y\n0.1\n").unwrap();
    let young = "body.material.young=3e4..4e5";
    for (data, unknown, message) in [
        ("tip.csv", "body.material.yuong=1..2", "young"),
        ("tip.csv", "body.material.young=2..1", "range of body.material.young = 2.0..1.0"),
        ("tip.csv", "body.material.young", "write KEY=LEAST..MOST"),
        ("other.csv", young, "column of the data = \"top.y\""),
        ("late.csv", young, "times of the data = 7 s to 8 s"),
        ("few.csv", young, "number of measured values = 1"),
        ("word.csv", young, "line 2, column tip.y: \"high\" is no finite number"),
        ("row.csv", young, "its first column is \"tip.y\""),
        ("none.csv", young, "none.csv"),
    ] {
        let done = place.run(&["fit", "scene.toml", "--data", data, "--unknown", unknown]);
        let told = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(2), "{told}");
        assert!(told.contains(message), "{unknown}: {told}");
    }
}

/// A bar on which its end is pulled.
fn pulled(material: &str) -> String {
    format!(
        r#"
        body = {{ mesh = {{ kind = "bar", length = 0.1, nodes = 3 }}, area = 1e-4, strain = "green", material = {{ {material} }} }}
        phase = {{ name = "pull", until = 1.0, hold = {{ nodes = "left" }}, load = {{ nodes = "right", force = [2.0] }} }}
        sensor = [{{ name = "tip", kind = "displacement", nodes = "right" }}, {{ name = "middle", kind = "displacement", nodes = [2] }}]
        "#
    )
}

/// The value that the command finds of an unknown, and its words.
fn found_at_rest(place: &Place, unknowns: &[&str]) -> (Vec<f64>, String) {
    let mut arguments = vec!["fit", "scene.toml", "--static", "--data", "curve.csv", "--quiet"];
    arguments.extend(unknowns.iter().flat_map(|unknown| ["--unknown", unknown]));
    let done = place.run(&[&arguments[..], &["--plot", "left.svg"]].concat());
    assert!(done.status.success(), "{done:?}");
    let told = stdout(&done);
    let set = told.lines().find(|line| line.starts_with("--set")).unwrap();
    let values = set.split("--set ").skip(1).map(|one| one.trim().split_once('=').unwrap().1);
    (values.map(|value| value.parse().unwrap()).collect(), told)
}

/// A bar of St. Venant-Kirchhoff's law, F = E A (s^3 - s)/2 at a stretch s, under one load with several sections.
#[test]
fn a_modulus_is_found_in_equilibria() {
    let place = Place::new();
    place.scene(&pulled("density = 1000.0, young = 1e5, poisson = 0.0, viscosity = 0.0"));
    let young = 7e4;
    let mut curve = "body.area, tip.x\n".to_owned();
    for area in [1e-4, 2e-4, 3e-4, 5e-4] {
        let mut s: f64 = 1.1;
        for _ in 0..50 {
            s -= (s.powi(3) - s - 2.0 * 2.0 / (young * area)) / (3.0 * s * s - 1.0);
        }
        writeln!(curve, "{area:?}, {:?}", 0.1 * (s - 1.0)).unwrap();
    }
    fs::write(place.path("curve.csv"), curve).unwrap();
    let (found, told) = found_at_rest(&place, &["body.material.young=2e4..3e5"]);
    println!("{} {told}", found[0] / young - 1.0);
    assert!((found[0] / young - 1.0).abs() < 1e-8, "{told}");
    let chart = fs::read_to_string(place.path("left.svg")).unwrap();
    assert!(chart.contains("body.area (m^2)") && chart.contains("tip.x (m)"), "{chart}");
}

/// Mooney and Rivlin's constants from a curve of forces, each a list, and two sensors: F/A = 2 (l - 1/l^2) (c1 + c2/l) at a stretch l
/// of what keeps its volume. With c2 = 0 that is the neo-Hookean law.
#[test]
fn constants_of_rubber_are_found_in_its_stretches() {
    let place = Place::new();
    let constants = [3e4, 1e4];
    for (law, unknowns, used) in [
        (
            "mooney-rivlin\", c1 = 5e4, c2 = 5e3, bulk = 1e10",
            vec!["c1=1e4..1e5", "c2=1e3..1e5"],
            constants,
        ),
        ("neo-hookean\"", vec!["young=1e5..4e5"], [3e4, 0.0]),
    ] {
        let moduli = if unknowns.len() > 1 { "" } else { "young = 1e5, poisson = 0.499998, " };
        let material =
            format!("density = 1000.0, {moduli}viscosity = 0.0, law = {{ kind = \"{law} }}");
        place.scene(&pulled(&material));
        let mut curve = "phase.pull.load.force, middle.x, tip.x\n".to_owned();
        for stretch in [0.8_f64, 1.2, 1.6, 2.0, 2.5] {
            let stress = 2.0 * (stretch - stretch.powi(-2)) * (used[0] + used[1] / stretch);
            let tip = 0.1 * (stretch - 1.0);
            writeln!(curve, "[{:?}], {:?}, {tip:?}", 1e-4 * stress, 0.5 * tip).unwrap();
        }
        fs::write(place.path("curve.csv"), curve).unwrap();
        let keys = if unknowns.len() > 1 { "body.material.law." } else { "body.material." };
        let unknowns: Vec<String> = unknowns.iter().map(|one| format!("{keys}{one}")).collect();
        let unknowns: Vec<&str> = unknowns.iter().map(String::as_str).collect();
        let (found, told) = found_at_rest(&place, &unknowns);
        // E = 3 mu = 6 c1 where nothing changes the volume
        let truth = if unknowns.len() > 1 { constants.to_vec() } else { vec![6.0 * used[0]] };
        for (found, truth) in found.iter().zip(truth) {
            println!("{law}: {found} {truth} {:e}", found / truth - 1.0);
            // what is left of the change of volume, shear over bulk modulus, is 1e-5; measured: 6e-5 in the smaller constant
            assert!((found / truth - 1.0).abs() < 1e-4, "{told}");
        }
    }
}

#[test]
fn equilibria_that_cannot_be_fitted_are_refused() {
    let place = Place::new();
    place.scene(&pulled("density = 1000.0, young = 1e5, poisson = 0.0, viscosity = 0.0"));
    let young = "body.material.young=3e4..4e5";
    let cases: [(&str, &[&str]); 9] = [
        (
            "body.area, tpi.x\n1e-4, 0.1\n",
            &["\"tpi.x\" of the data, row 1", "did you mean \"tip.x\""],
        ),
        (
            "body.aera, tip.x\n1e-4, 0.1\n",
            &["\"body.aera\" of the data, row 1", "did you mean \"area\""],
        ),
        (
            "body.area, tip.x\n1e-4, 0.1\n-1e-4, 0.1\n",
            &["\"body.area\" of the data, row 2 = -1e-4", "above 0"],
        ),
        (
            "body.area, tip.x\n1e-4, high\n",
            &["\"tip.x\" of the data, row 1 = high", "finite number"],
        ),
        ("body.area, tip.x\n1e-4\n", &["curve.csv"]),
        ("body.area\n1e-4\n", &["none of them is measured", "\"tip.x\", \"middle.x\""]),
        ("tip.x, tip.x\n0.1, 0.1\n", &["\"tip.x\"", "stands twice"]),
        ("time, tip.x\n0.1, 0.1\n", &["\"time\"", "no time"]),
        ("body.area, tip.x\n1e-4, 0.1\n", &["number of measured values = 1"]),
    ];
    for (curve, parts) in cases {
        fs::write(place.path("curve.csv"), curve).unwrap();
        let done = place.run(&[
            "fit",
            "scene.toml",
            "--static",
            "--data",
            "curve.csv",
            "--unknown",
            young,
        ]);
        assert_eq!(done.status.code(), Some(2), "{curve}");
        says(&stderr(&done), parts);
    }
    fs::remove_file(place.path("curve.csv")).unwrap();
    let done =
        place.run(&["fit", "scene.toml", "--static", "--data", "curve.csv", "--unknown", young]);
    says(&stderr(&done), &["cannot read curve.csv"]);
    // sections do not matter where the key that is sought is a column
    let both = "body.material.young, tip.x\n1e5, 0.01\n2e5, 0.005\n";
    fs::write(place.path("curve.csv"), both).unwrap();
    let done =
        place.run(&["fit", "scene.toml", "--static", "--data", "curve.csv", "--unknown", young]);
    says(&stderr(&done), &["unknown = body.material.young cannot be used"]);
}

/// A line through points with errors, whose confidence has a closed form (N. R. Draper, H. Smith, *Applied Regression Analysis*, 1.4):
/// t s / sqrt(sum (x - mean)^2) for the slope.
#[test]
fn the_confidence_of_a_line_is_that_of_the_books() {
    let points = [(0.0, 1.1), (1.0, 2.9), (2.0, 5.2), (3.0, 6.9), (4.0, 9.1), (5.0, 10.8)];
    let residuals =
        |at: &[f64]| Ok(vec![points.iter().map(|(x, y)| at[0] + at[1] * x - y).collect()]);
    let unknowns = [Unknown::new("constant", -10.0, 10.0), Unknown::new("slope", -5.0, 10.0)];
    let found = least_squares(&unknowns, 1e-12, &residuals, &mut |_, _| {}).unwrap();
    let mean = [3.5 - 1.0, points.iter().map(|point| point.1).sum::<f64>() / 6.0];
    let spread = points.iter().map(|(x, _)| (x - mean[0]).powi(2)).sum::<f64>();
    let slope = points.iter().map(|(x, y)| (x - mean[0]) * (y - mean[1])).sum::<f64>() / spread;
    let left =
        points.iter().map(|(x, y)| (mean[1] + slope * (x - mean[0]) - y).powi(2)).sum::<f64>();
    // 2.776: Student's for 4 degrees of freedom, from a table
    let confidence = 2.776 * (left / 4.0 / spread).sqrt();
    let found = &found.unknowns[1];
    assert!(
        (found.value - slope).abs() < 1e-6 && (found.confidence / confidence - 1.0).abs() < 0.005,
        "{found:?} {confidence}"
    );
}

/// A run that fails is a bad step: the first step goes too far, as the slope of the arc tangent falls, to where there is nothing; the next is shorter.
/// Where the solution is at the edge of that, derivatives are those of the side that is left.
#[test]
fn runs_that_fail_are_bad_steps() {
    for edge in [0.1, 0.3 - 1e-9] {
        let residuals = |at: &[f64]| match at[0] < edge {
            true => Err(Error::Input(InputError {
                input: "number".into(),
                value: at[0].to_string(),
                help: "it runs away".into(),
            })),
            false => Ok(vec![vec![(10.0 * (at[0] - 0.3)).atan(), at[0] - 0.3]]),
        };
        let unknowns = [Unknown::new("number", -2.0, 3.0)];
        let found = least_squares(&unknowns, 1e-12, &residuals, &mut |_, _| {}).unwrap();
        println!("{found:?}");
        let value = found.unknowns[0].value;
        assert!((value - 0.3).abs() < 1e-3 && found.failed > 0, "{edge}: {found:?}");
    }
    // nothing in the middle is an error
    let none = |_: &[f64]| {
        let [input, value, help] = ["number", "0.5", "it runs away"].map(String::from);
        Err(Error::Input(InputError { input, value, help }))
    };
    let error = least_squares(&[Unknown::new("number", 0.0, 1.0)], 1e-12, &none, &mut |_, _| {});
    assert!(error.unwrap_err().to_string().contains("it runs away"));
}
