//! Motions with their errors: what is said of them holds against closed forms.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use pliant::simulate::{Component, Reading};
use pliant::study::{Part, Quantity, Verification};
use pliant::{
    Achieved, Body, ContactEvents, Error, Inertia, Material, Mesh, Method, Obstacle, Phase, Sample,
    Sampling, Scene, SceneFile, Settings, Strain, Trajectory,
};

type Outcome = Result<(), Error>;

/// An undamped bar of 4 segments, clamped at its left end, that starts with its lowest mode as displacement.
fn bar(inertia: Inertia) -> Result<Scene, Error> {
    let material = Material { density: 1.0, young: 1.0, poisson: 0.0, viscosity: 0.0 };
    let body = Body::new(Mesh::bar(1.0, 5)?, material).strain(Strain::Cauchy).inertia(inertia);
    Ok(Scene::new(body.area(1.0).build()?)
        .initial_displacement(|x| vec![0.1 * (0.5 * PI * x[0]).sin()])
        .phase(Phase::until(20.0).hold("left")))
}

/// Angular frequency of its motion: that of the discrete mode.
fn omega(inertia: Inertia) -> f64 {
    let h = 0.25;
    let cosine = (0.5 * PI * h).cos();
    match inertia {
        Inertia::Consistent => (6.0 * (1.0 - cosine) / (2.0 + cosine)).sqrt() / h,
        Inertia::Lumped => (2.0 * (1.0 - cosine)).sqrt() / h,
    }
}

fn verify(verification: Verification) -> Result<Trajectory, Error> {
    verification.finish(|_| ControlFlow::Continue(()))
}

fn achieved(trajectory: &Trajectory) -> &Achieved {
    trajectory.report().achieved.as_ref().unwrap()
}

/// Values of a column among the sensors.
fn column(trajectory: &Trajectory, name: &str) -> Vec<f64> {
    let number = trajectory.sensors().iter().position(|sensor| sensor.name == name).unwrap();
    trajectory.samples().iter().map(|sample| sample.sensors[number]).collect()
}

/// The true error is below the accuracy that was asked for, and below the difference that is told.
#[test]
fn errors_are_below_what_is_told() -> Outcome {
    for (method, inertia) in [
        (Method::Auto, Inertia::Consistent),
        (Method::CvodeBdf, Inertia::Consistent),
        (Method::Arkode, Inertia::Consistent),
        (Method::Rk, Inertia::Lumped),
        // its steps are bounded by stability, whatever the tolerance
        (Method::CentralDifference, Inertia::Lumped),
    ] {
        let scene = bar(inertia)?;
        for accuracy in [1e-2, 1e-4] {
            let end = Reading::displacement("right").component(Component::X);
            let verification = Verification::new(&scene, accuracy)
                .settings(Settings { method, ..Settings::default() })
                .sampling(Sampling::every(0.2).read("end", end));
            let motion = verify(verification)?;
            let exact = |t: f64, start: f64| start * (omega(inertia) * t).cos();
            let (mut off, mut moved) = (0.0, 0.0);
            let start = &motion.samples()[0].u;
            for sample in motion.samples() {
                for (u, start) in sample.u.iter().zip(start) {
                    off += (u - exact(sample.time, *start)).powi(2);
                    moved += u.powi(2);
                }
            }
            let error = (off / moved).sqrt();
            let achieved = achieved(&motion);
            println!("{method} {accuracy}: {error:.1e} {achieved}");
            assert!(achieved.is_enough() && achieved.difference <= accuracy, "{achieved}");
            assert!(error < achieved.difference, "{method} {accuracy}: {error} {achieved}");
            let scale = (moved / (motion.samples().len() * start.len()) as f64).sqrt();
            // it is the mean over a hundred times more (0.5 %)
            assert!((achieved.scale / scale - 1.0).abs() < 0.01, "{achieved} {scale}");
            // column by column: a tolerance a tenth of the other is worth a factor of 2 at least
            let [end, difference] = ["end", "end.difference"].map(|name| column(&motion, name));
            for (sample, (end, difference)) in
                motion.samples().iter().zip(end.iter().zip(difference))
            {
                let off = (end - exact(sample.time, start[4])).abs();
                assert!(off < difference + 0.3 * accuracy * scale, "{off} {difference}");
            }
        }
    }
    Ok(())
}

/// The frequency of the end of the bar, and its largest displacement.
#[test]
fn numbers_of_a_motion_are_verified() -> Outcome {
    let scene = bar(Inertia::Consistent)?;
    let end = Quantity::reading("end", Reading::displacement("right").component(Component::X));
    for (part, exact) in [
        (Part::Frequency, omega(Inertia::Consistent) / (2.0 * PI)),
        (Part::Least, -0.1),
        (Part::End, 0.1 * (20.0 * omega(Inertia::Consistent)).cos()),
    ] {
        let verification = Verification::new(&scene, 1e-4).quantity(end.clone().part(part));
        let motion = verify(verification.sampling(Sampling::every(0.01)))?;
        let achieved = achieved(&motion);
        println!("{achieved}; {exact}");
        assert!(achieved.is_enough(), "{achieved}");
        if part == Part::Frequency {
            assert!((achieved.scale / exact - 1.0).abs() < 1e-4, "{achieved} {exact}");
        }
    }
    Ok(())
}

/// Of a scene file that asks for no samples there are a hundred, and the quantity that it names is accurate.
#[test]
fn scene_files_say_what_has_to_be_accurate() -> Outcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/report-8.toml");
    let mut file = SceneFile::read(path)?;
    (file.output.step, file.accuracy.quantity) = (None, Some("top.x".into()));
    let motion = verify(Verification::of_file(&file, "1%".parse()?)?)?;
    assert_eq!(achieved(&motion).quantity, "top.x");
    for k in 0..=100 {
        let is_there = |sample: &Sample| (sample.time - 0.01 * f64::from(k)).abs() < 1e-12;
        assert!(motion.samples().iter().any(is_there), "{k}");
    }
    Ok(())
}

/// Hirai's square on a hard floor: what is said until when its motion is known holds against another method.
#[test]
fn hard_bounces_are_known_until_a_time() -> Outcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/square-jump-hard.toml");
    let scene = SceneFile::read_with(path, &["phase.free.until=6".into()])?.scene;
    let sampling = Sampling::every(0.02);
    let mut verification = Verification::new(&scene, 1e-5).sampling(sampling.clone());
    for _ in 0..3 {
        assert!(verification.refine(|_| ControlFlow::Continue(()))?);
    }
    let motion = verification.trajectory().unwrap();
    let achieved = achieved(motion);
    println!("{achieved} {}", achieved.known_until);
    assert!(!achieved.is_enough() && achieved.known_until < 6.0, "{achieved}");
    assert!(achieved.known_until > 3.0, "{achieved}");
    assert!(motion.report().warnings().iter().any(|warning| warning.contains("still differ by")));
    let settings = Settings { method: Method::CvodeAdams, rtol: 1e-11, ..Settings::default() };
    let settings = Settings { contact_events: ContactEvents::Locate, ..settings };
    let other = scene.simulate(&settings, &sampling)?;
    let pairs = motion.samples().iter().zip(other.samples());
    let apart = |(a, b): (&Sample, &Sample)| -> f64 {
        let squares: f64 = a.u.iter().zip(&b.u).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / 16.0).sqrt() / achieved.scale
    };
    let known = pairs.filter(|(a, _)| a.time < achieved.known_until);
    let worst = known.map(apart).fold(0.0, f64::max);
    println!("{worst:.1e}");
    // asked: 1e-5; found: 2.5e-7
    assert!(worst < 1e-6, "{worst}");
    Ok(())
}

/// An accuracy beyond what round-off leaves ends with the tightest tolerance, and is not said to be reached.
#[test]
fn what_no_tolerance_reaches_is_told() -> Outcome {
    let scene = bar(Inertia::Consistent)?;
    let settings = Settings { method: Method::CvodeBdf, ..Settings::default() };
    let motion = verify(Verification::new(&scene, 5e-10).settings(settings))?;
    let achieved = achieved(&motion);
    println!("{achieved}");
    assert!(!achieved.is_enough() && achieved.runs == 2, "{achieved}");
    assert!(achieved.difference > 5e-10 && achieved.known_until < scene.end(), "{achieved}");
    assert!(motion.report().warnings().iter().any(|warning| warning.contains("still differ by")));
    Ok(())
}

/// A bar of 1 kg hits a soft floor once in a minute, for 31 ms: the looks at the motion, 30 ms apart, miss the peak of the force, which is
/// v sqrt(k m) but for vibrations within the bar, 5 % of it. Runs that were sampled densely around it know it better.
#[test]
fn peaks_between_samples_are_found() -> Outcome {
    let material = Material { density: 1000.0, young: 1e7, poisson: 0.0, viscosity: 2e4 };
    let body = Body::new(Mesh::bar(0.1, 4)?, material).area(0.01).build()?;
    let [speed, stiffness, gap] = [0.1, 1e4, 0.01_f64];
    let floor = Obstacle::half_plane([-gap], [1.0]).named("floor").stiffness(stiffness);
    let scene = Scene::new(body)
        .initial_velocity(move |_| vec![-speed])
        .obstacle(floor)
        .phase(Phase::until(60.0));
    let peak = |quantity: Quantity| -> Result<f64, Error> {
        let verification = Verification::new(&scene, 0.01)
            .settings(Settings { method: Method::Arkode, ..Settings::default() })
            .sampling(Sampling::every(1.0))
            .quantity(quantity);
        Ok(achieved(&verify(verification)?).scale)
    };
    let force = Reading::contact_force("floor").component(Component::X);
    let largest = peak(Quantity::reading("floor.x", force.clone()).part(Part::Largest))?;
    let times: Vec<f64> = (0..8000).map(|k| gap / speed + 5e-6 * f64::from(k)).collect();
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let dense = scene.simulate(&settings, &Sampling::at(times).read("force", force))?;
    let expected = column(&dense, "force").into_iter().fold(0.0, f64::max);
    let rigid = speed * stiffness.sqrt();
    println!("{largest} {expected} {rigid}");
    assert!((expected / rigid - 1.0).abs() < 0.05, "{expected} {rigid}");
    // 1 % was asked for
    assert!((largest / expected - 1.0).abs() < 0.01, "{largest} {expected}");
    Ok(())
}

/// A bar that is held at one end and pulled at the other from t = 0: the largest force at its held end comes between samples, for which all
/// forces are evaluated there. A dense sampling knows it.
#[test]
fn peaks_of_constraint_forces_are_found() -> Outcome {
    let material = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 20.0 };
    let body = Body::new(Mesh::bar(0.1, 6)?, material).area(0.01).build()?;
    let scene = Scene::new(body).phase(Phase::until(0.2).hold("left").load("right", [1.0]));
    let force = Reading::constraint_force("left").component(Component::Norm);
    let verification = Verification::new(&scene, 0.001)
        .settings(Settings { method: Method::Arkode, ..Settings::default() })
        .sampling(Sampling::every(0.2))
        .quantity(Quantity::reading("held", force.clone()).part(Part::Largest));
    let largest = achieved(&verify(verification)?).scale;
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let dense = scene.simulate(&settings, &Sampling::every(1e-5).read("held", force))?;
    let expected = column(&dense, "held").into_iter().fold(0.0, f64::max);
    println!("{largest} {expected}");
    // twice the load but for damping and waves in the bar
    assert!((1.8..2.5).contains(&expected), "{expected}");
    // 0.1 % was asked for; four looks in a step miss a peak by 0.3 % at most
    assert!((largest / expected - 1.0).abs() < 0.003, "{largest} {expected}");
    Ok(())
}

/// A pulse of a function of a program between the looks of the first run, and between those of the second were they but as often as its tolerance
/// takes: the second looks at other times, and runs go on until they agree that it is there.
#[test]
fn a_pulse_between_looks_is_seen() -> Outcome {
    // a look of the second run; 0.66 and 0.5 of the way between the others
    let (middle, width, impulse) = (0.300015, 3e-6, 1e-4);
    let load = move |t: f64| {
        let acts = (t - middle).abs() < 0.5 * width;
        [if acts { impulse / width } else { 0.0 }]
    };
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 3e3 };
    let body = Body::new(Mesh::bar(0.1, 4)?, material).area(1e-4).build()?;
    let mass = body.mass();
    let scene = Scene::new(body)
        .initial_velocity(|_| vec![0.01])
        .phase(Phase::until(1.0).load_with("right", load));
    let motion = verify(Verification::new(&scene, 1e-2))?;
    let (found, expected) = (motion.momentum(motion.last())[0], 0.01 * mass + impulse);
    println!("{found} N s, {expected} N s: {}", achieved(&motion));
    assert!(achieved(&motion).is_enough());
    assert!((found / expected - 1.0).abs() < 1e-2, "{found} {expected}");
    Ok(())
}
