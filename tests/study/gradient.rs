//! Derivatives of scenes: against closed forms, by different methods, and where they mean little.

use std::path::Path;

use pliant::fit::Measured;
use pliant::gradient::{Derivative, Gradient, Method, Objective, SceneGradient};
use pliant::{Error, SceneReader};

/// A bar of one element, pulled from rest by a constant force: an oscillator with one degree of freedom.
const BAR: &str = r#"
body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 20.0 } }
phase = { name = "pull", until = 0.05, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1] } }
sensor = { name = "tip", kind = "displacement", nodes = "right" }
"#;

/// The same bar, let go where its tip is by 1 mm away.
const CUT: &str = r#"
body = { mesh = { kind = "bar", length = 0.1, nodes = 2 }, area = 1e-4, strain = "cauchy", material = { density = 1e3, young = 1e5, poisson = 0.0, viscosity = 20.0 } }
sensor = { name = "tip", kind = "displacement", nodes = "right" }
[[phase]]
name = "pull"
until = 0.05
end = { sensor = "tip.x", above = 1e-3 }
hold = { nodes = "left" }
load = { nodes = "right", force = [0.1] }
[[phase]]
until = 0.06
hold = { nodes = "left" }
"#;

/// The numbers of that scene, and its tip (m) by them: a damped oscillator of stiffness E A / L, mass rho A L / 3 (consistent inertia
/// of a linear element) and damping eta A / L, from rest under a step of the force.
const NUMBERS: [(&str, f64); 7] = [
    ("body.material.young", 1e5),
    ("body.material.density", 1e3),
    ("body.material.viscosity", 20.0),
    ("body.mesh.length", 0.1),
    ("body.area", 1e-4),
    ("phase.pull.load.force.1", 0.1),
    ("phase.pull.until", 0.05),
];

fn tip([young, density, viscosity, length, area, force, time]: [f64; 7]) -> f64 {
    let (stiffness, mass) = (young * area / length, density * area * length / 3.0);
    let rate = viscosity * area / length / (2.0 * mass);
    let frequency = (stiffness / mass - rate * rate).sqrt();
    let (sin, cos) = (frequency * time).sin_cos();
    force / stiffness * (1.0 - (-rate * time).exp() * (cos + rate / frequency * sin))
}

/// Its derivative by one of the numbers, to ten digits: central differences of the closed form, extrapolated once.
fn tip_by(number: usize) -> f64 {
    let quotient = |part: f64| {
        let at = |sign: f64| {
            let mut numbers = NUMBERS.map(|(_, value)| value);
            numbers[number] *= 1.0 + sign * part;
            tip(numbers)
        };
        (at(1.0) - at(-1.0)) / (2.0 * part * NUMBERS[number].1)
    };
    (4.0 * quotient(5e-4) - quotient(1e-3)) / 3.0
}

fn gradient(scene: &str, set: &[&str], of: Objective, by: &[&str]) -> Result<SceneGradient, Error> {
    let set: Vec<String> = set.iter().map(|set| (*set).to_owned()).collect();
    SceneGradient::of_text(&SceneReader::default(), scene, Path::new("scene.toml"), &set, of, by)
}

fn found(scene: &str, set: &[&str], of: &str, by: &[&str]) -> Gradient {
    let gradient = gradient(scene, set, Objective::Quantity(of.into()), by).unwrap();
    gradient.value_and_gradient(&mut |_| {}).unwrap()
}

fn by<'a>(gradient: &'a Gradient, key: &str) -> &'a Derivative {
    gradient.derivatives.iter().find(|derivative| derivative.key == key).unwrap()
}

/// The mean over time m of the tip x changes with the length T of the phase by (x(T) - m)/T, and with the force by m/F. The
/// trapezoidal rule over 2000 parts is off by 2e-6 of it.
#[test]
fn a_mean_over_time() {
    let gradient = found(BAR, &[], "tip.x:mean", &["phase.pull.until", "phase.pull.load.force.1"]);
    let numbers = NUMBERS.map(|(_, value)| value);
    let [.., force, end] = numbers;
    let at = |part: f64| {
        let mut numbers = numbers;
        numbers[6] *= part;
        tip(numbers)
    };
    // Simpson's rule
    let parts = 1000;
    let sum: f64 = (0..=parts)
        .map(|k| {
            let weight = if k == 0 || k == parts { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
            weight * at(f64::from(k) / f64::from(parts))
        })
        .sum();
    let mean = sum / (3.0 * f64::from(parts));
    let off = |found: f64, exact: f64| {
        println!("{found:e}: {:.1e}", found / exact - 1.0);
        (found / exact - 1.0).abs()
    };
    assert!(off(gradient.value, mean) < 1e-5);
    assert!(off(by(&gradient, "phase.pull.until").value, (at(1.0) - mean) / end) < 1e-5);
    assert!(off(by(&gradient, "phase.pull.load.force.1").value, mean / force) < 1e-5);
}

/// All numbers of the bar, among them its length and the end of its phase, by steps that are taken back: estimated errors hold,
/// and are below 1e-5 at the default tolerance and 1e-7 at a tight one.
#[test]
fn derivatives_are_those_of_the_closed_form() {
    let keys = NUMBERS.map(|(key, _)| key);
    for (rtol, most) in [("1e-5", 1e-5), ("1e-8", 1e-7)] {
        let found = found(BAR, &[&format!("solver.rtol={rtol}")], "tip.x", &keys);
        assert_eq!((found.method, &found.reason), (Method::Adjoint, &None));
        for (number, derivative) in found.derivatives.iter().enumerate() {
            let exact = tip_by(number);
            let Derivative { key, value, error, doubt, .. } = derivative;
            let off = (value - exact).abs();
            assert!(off <= error + 1e-10 * exact.abs(), "{key}: {off:e} {error:e}");
            assert!(
                *error < most * exact.abs() && doubt.is_none(),
                "{key}: {error:e} of {exact:e}"
            );
        }
    }
}

/// Whole runs agree with the same steps within both errors; they are what is left where a phase ends by a sensor.
#[test]
fn methods_agree() {
    let keys = ["body.material.young", "body.material.viscosity"];
    let same = gradient(BAR, &[], Objective::Quantity("tip.x".into()), &keys).unwrap();
    let same = same.by_method(Method::SameSteps).unwrap().checked();
    for Derivative { value, error, check, .. } in
        same.value_and_gradient(&mut |_| {}).unwrap().derivatives
    {
        let check = check.unwrap();
        assert!((value - check.value).abs() <= error + check.error, "{value:e} {check:?}");
        assert!(check.error < 1e-5 * value.abs(), "{check:?}");
    }
    let cut = gradient(CUT, &[], Objective::Quantity("tip.x:max".into()), &keys).unwrap();
    for method in [Method::Adjoint, Method::SameSteps] {
        assert!(cut.clone().by_method(method).is_err());
    }
    let cut = cut.value_and_gradient(&mut |_| {}).unwrap();
    assert_eq!(cut.method, Method::Differences);
    assert!(cut.reason.is_some_and(|why| why.contains("ends by a sensor")));
    // the tip is let go at the same place with more speed if it is stiffer, and goes less far
    assert!(cut.derivatives[0].value < 0.0, "{:?}", cut.derivatives[0]);
}

/// The tip of a linear beam in equilibrium goes as 1 / E and as the load; Poisson's ratio 0 has values above it alone.
#[test]
fn equilibria_follow_their_scaling() {
    let beam = r#"
        body = { mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [5, 2], cells = "triangles6" }, thickness = 0.01, strain = "cauchy", material = { density = 1000.0, young = 1e5, poisson = 0.0, viscosity = 1.0 } }
        phase = { name = "sag", until = 1.0, hold = { nodes = "left" }, load = { nodes = "right", total = [0.0, -0.01] } }
        sensor = { name = "tip", kind = "displacement", nodes = "right" }
    "#;
    let keys = [
        "body.material.young",
        "phase.sag.load.total.2",
        "body.material.poisson",
        "body.material.density",
    ];
    let of = Objective::QuantityAtRest("tip.y".into());
    let found = gradient(beam, &[], of, &keys).unwrap().value_and_gradient(&mut |_| {}).unwrap();
    let [young, load] = [by(&found, keys[0]), by(&found, keys[1])];
    for (derivative, exact) in [(young, -found.value / 1e5), (load, found.value / -0.01)] {
        let off = (derivative.value / exact - 1.0).abs();
        assert!(off < 1e-9 && derivative.error < 1e-8 * exact.abs(), "{derivative:?} {exact:e}");
    }
    let poisson = by(&found, keys[2]);
    assert!(!poisson.is_constant && poisson.error < 1e-5 * poisson.value.abs(), "{poisson:?}");
    // nothing is heavy
    let density = by(&found, keys[3]);
    assert!(density.is_constant && density.value == 0.0, "{density:?}");
    assert!(found.to_string().contains("nothing depends on it"), "{found}");
}

/// A beam of large rotations under a pressure, and a force that follows its end, whose stiffness is not symmetric, held by a spring and a grip that
/// moves: the dual of its equations has the derivatives that differences of whole equilibria have, within their errors, which are below
/// 1e-8 of each.
#[test]
fn equilibria_are_linearized() {
    let beam = r#"
        gravity = [0.0, -9.8]
        body = { mesh = { kind = "rectangle", size = [0.1, 0.02], nodes = [7, 3], cells = "triangles6" }, thickness = 0.01, strain = "green", material = { density = 1000.0, young = 1e5, poisson = 0.4, viscosity = 1.0 } }
        chamber = { name = "room", nodes = "top", closed_by_line = true }
        spring = { name = "stay", ends = [7, { point = [0.1, -0.1] }], stiffness = 5.0, length = 0.05 }
        phase = { name = "sag", until = 1.0, hold = { nodes = "left" }, move = { nodes = [5], axes = "y", velocity = 0.01 }, pressure = { chamber = "room", value = 200.0 }, follower = { nodes = "right", force = [0.0, -0.02] } }
        sensor = [
            { name = "tip", kind = "position", nodes = [7] },
            { name = "grip", kind = "constraint-force", nodes = "left" },
            { name = "stress", kind = "stress", nodes = [1] },
            { name = "span", kind = "distance", from = 1, to = 21 },
        ]
    "#;
    let keys = [
        "body.material.young",
        "body.material.poisson",
        "body.material.density",
        "body.mesh.size.2",
        "body.thickness",
        "spring.stay.length",
        "phase.sag.move.velocity",
        "phase.sag.pressure.value",
        "phase.sag.follower.force.2",
    ];
    for (of, unit, keys) in
        [("tip.y", "m", &keys[..]), ("grip.x", "N", &keys[..1]), ("span", "m", &keys[7..])]
    {
        let of = Objective::QuantityAtRest(of.into());
        let found = gradient(beam, &[], of, keys).unwrap().checked();
        let found = found.value_and_gradient(&mut |_| {}).unwrap();
        println!("{found}");
        assert_eq!((found.method, &found.reason, &found.unit[..]), (Method::Adjoint, &None, unit));
        assert_eq!(found.runs, 2);
        for Derivative { key, value, error, check, .. } in &found.derivatives {
            let check = check.unwrap();
            println!("{key}: {:.1e}", value / check.value - 1.0);
            assert!((value - check.value).abs() <= error + check.error, "{key}: {value} {check:?}");
            assert!(
                [*error, check.error].iter().all(|error| *error < 1e-8 * value.abs()),
                "{error:e}"
            );
        }
    }
    // by differences, with the reason
    let of = Objective::QuantityAtRest("stress.xx".into());
    let stress = gradient(beam, &[], of, &keys[..1]).unwrap();
    let found = stress.value_and_gradient(&mut |_| {}).unwrap();
    assert_eq!(found.method, Method::Differences);
    assert!(found.reason.is_some_and(|why| why.contains("linearized for positions")));
    let error = stress.by_method(Method::SameSteps).unwrap_err().to_string();
    assert!(error.contains("no steps: take adjoint"), "{error}");
}

/// The gradient of squares is twice the residuals times their derivatives.
#[test]
fn squares_have_the_gradient_of_their_residuals() {
    let key = "body.material.young";
    let [early, late] = ["0.02", "0.05"].map(|end| {
        let found = found(BAR, &[&format!("phase.pull.until={end}")], "tip.x", &[key]);
        (found.value, by(&found, key).value)
    });
    let measured =
        Measured { times: vec![0.02, 0.05], columns: vec![("tip.x".into(), vec![1e-3, 1e-3])] };
    let squares = gradient(BAR, &[], Objective::LeastSquares(measured), &[key]).unwrap();
    let squares = squares.value_and_gradient(&mut |_| {}).unwrap();
    let exact: f64 = [early, late].iter().map(|(tip, slope)| 2.0 * (tip - 1e-3) * slope).sum();
    let derivative = by(&squares, key);
    assert!((derivative.value / exact - 1.0).abs() < 1e-4, "{derivative:?} {exact:e}");
    assert_eq!(squares.unit, "m^2");
}

/// A key without a derivative is told before anything runs.
#[test]
fn numbers_that_are_none_are_refused() {
    let of = |of: &str, by: &[&str]| {
        gradient(BAR, &[], Objective::Quantity(of.into()), by).unwrap_err().to_string()
    };
    let young = "body.material.young";
    for (text, words) in [
        (of("tipp.x", &[young]), "tipp.x"),
        (of("tip.z", &[young]), "tip.z"),
        (of("motion", &[young]), "no single number"),
        (of("tip.x", &[]), "name a number"),
        (of("tip.x", &[young, young]), "once"),
        (of("tip.x", &["body.material.yuong"]), "young"),
        (of("tip.x", &["body.strain"]), "derivative is by a number"),
        (of("tip.x", &["phase.pull.load.force"]), "by its place"),
        (of("tip.x", &["solver.alpha"]), "--set solver.alpha=VALUE"),
        (of("tip.x", &["body.mesh.nodes"]), "no value next to this one"),
    ] {
        assert!(text.contains(words), "{text}");
    }
}

/// A soft brick falls on a slope: the derivative of its height by where it starts is 1 as long as it falls, and after some bounces
/// derivatives at two tolerances have nothing in common.
#[test]
fn bounces_end_the_meaning() {
    let brick = r#"
        gravity = [0.0, -9.8]
        body = { mesh = { kind = "rectangle", size = [0.1, 0.06], nodes = [2, 2], cells = "triangles", origin = [0.0, 0.05] }, thickness = 0.01, strain = "green", material = { density = 1000.0, young = 2.0e4, poisson = 0.3, viscosity = 1.0 } }
        obstacle = { name = "floor", kind = "half-plane", point = [0.0, 0.0], normal = [0.2, 1.0], stiffness = 500.0 }
        phase = { until = 0.35 }
        solver = { method = "rk", rtol = 1e-2 }
    "#;
    let key = "body.mesh.origin.2";
    let falling = found(brick, &["phase.1.until=0.08"], "com.y", &[key]);
    let height = by(&falling, key);
    assert!((height.value - 1.0).abs() <= height.error + 1e-9 && height.error < 1e-6, "{height:?}");
    assert_eq!(height.doubt, None);
    let bounced = found(brick, &[], "com.x", &[key]);
    let doubt = by(&bounced, key).doubt.unwrap();
    assert!(doubt.by_tolerance && doubt.since.is_some_and(|time| time > 0.1), "{doubt:?}");
    assert!(bounced.to_string().contains("means little"), "{bounced}");
}

/// Steps taken back and differences of runs by these steps both have the derivative of the computed motion: they are apart by this part
/// of it at most.
fn assert_same_derivative(scene: &str, of: &str, keys: &[&str], most: f64) {
    let [adjoint, same] = [Method::Adjoint, Method::SameSteps].map(|method| {
        let gradient = gradient(scene, &[], Objective::Quantity(of.into()), keys).unwrap();
        let found = gradient.by_method(method).unwrap().value_and_gradient(&mut |_| {}).unwrap();
        println!("{found}");
        assert_eq!((found.method, &found.reason), (method, &None));
        found
    });
    for (adjoint, same) in adjoint.derivatives.iter().zip(&same.derivatives) {
        let apart = (adjoint.value / same.value - 1.0).abs();
        println!("{}: {apart:.1e}", adjoint.key);
        assert!(apart < most, "{}: {} {}", adjoint.key, adjoint.value, same.value);
    }
}

/// Constraints, damping, a mass matrix and times that depend on numbers, linear: 2e-10 apart, the viscosity; the others less than 1e-10.
#[test]
fn linear_steps_are_taken_back() {
    assert_same_derivative(BAR, "tip.x", &NUMBERS.map(|(key, _)| key), 1e-9);
}

/// Large rotations, a load that changes with time, and phases that hold a node from where it is, and go on to hold it.
#[test]
fn steps_are_taken_back_through_phases() {
    let beam = r#"
        gravity = [0.0, -9.8]
        body = { mesh = { kind = "rectangle", size = [0.1, 0.04], nodes = [3, 2], cells = "triangles" }, thickness = 0.01, strain = "green", material = { density = 1000.0, young = 2e4, poisson = 0.3, viscosity = 100.0 } }
        phase = [
            { name = "sag", until = 0.05, hold = { nodes = "left" }, load = { nodes = "right", force = [0.1, "-0.1*sin(30*t)"] } },
            { name = "swing", until = 0.07, hold = [{ nodes = "left" }, { nodes = [6] }] },
            { until = 0.08, hold = { nodes = [6] } },
        ]
        sensor = { name = "tip", kind = "position", nodes = [3] }
        solver = { rtol = 1e-2 }
    "#;
    let keys =
        ["body.material.young", "body.mesh.size.1", "phase.sag.load.force.1", "phase.sag.until"];
    assert_same_derivative(beam, "tip.y", &keys, 1e-7);
}

/// Two bodies that touch and rub: a barrier, and a Newton matrix that is not symmetric.
#[test]
fn steps_are_taken_back_through_contact() {
    let bodies = r#"
        gravity = [0.0, -9.8]
        body = [
            { name = "low", mesh = { kind = "rectangle", size = [0.03, 0.01], nodes = [3, 2], cells = "triangles" }, thickness = 0.01, strain = "green", material = { density = 1000.0, young = 5e4, poisson = 0.3, viscosity = 20.0 } },
            { name = "high", mesh = { kind = "rectangle", size = [0.012, 0.01], nodes = [2, 2], cells = "triangles", origin = [0.008, 0.0108] }, thickness = 0.01, strain = "green", material = { density = 1000.0, young = 3e4, poisson = 0.3, viscosity = 20.0 } },
        ]
        touch = { name = "rub", distance = 1e-3, friction_coefficient = 0.3, sticking_speed = 5e-2 }
        phase = { until = 0.02, hold = { nodes = "low/bottom" }, load = { nodes = "high/right", force = [0.01, 0.0] } }
        sensor = { name = "high", kind = "centre-of-mass", body = "high" }
        solver = { rtol = 1e-2 }
    "#;
    let keys = ["body.low.material.young", "touch.rub.friction_coefficient"];
    assert_same_derivative(bodies, "high.x", &keys, 1e-6);
}

/// A reading that is not at the end, and a method that is not taken back, fall to the same steps, and say so.
#[test]
fn what_is_not_taken_back_is_said() {
    let keys = ["body.material.young", "phase.pull.load.force.1"];
    let mean = gradient(BAR, &[], Objective::Quantity("tip.x:mean".into()), &keys).unwrap();
    let error = mean.by_method(Method::Adjoint).unwrap_err().to_string();
    assert!(error.contains("at the end") && error.contains("same-steps"), "{error}");
    let mean = found(BAR, &[], "tip.x:mean", &keys);
    assert_eq!(mean.method, Method::SameSteps);
    assert!(mean.reason.is_some_and(|why| why.contains("at the end")));
    let by_rk = found(BAR, &["solver.method=rk"], "tip.x", &keys);
    assert_eq!(by_rk.method, Method::SameSteps);
    assert!(by_rk.reason.is_some_and(|why| why.contains("rk")));
}
