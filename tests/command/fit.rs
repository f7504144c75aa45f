//! `pliant fit`: what was put into a motion comes out of it, and what cannot.

use std::fmt::Write;
use std::fs;

use pliant::fit::{Measured, SceneFit, Unknown, least_squares};
use pliant::{Error, InputError};

use super::{Place, stdout};

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
