//! Angles that go on over whole turns, whenever they are read.

use std::f64::consts::{PI, TAU};

use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Error, Material, Mesh, Phase, Sampling, Scene, Settings, Simulation, Trajectory,
};

type Outcome = Result<(), Error>;

/// Angular velocity (rad/s).
const RATE: f64 = -9.0;

/// A square that its nodes turn about a corner, clockwise: 18 rad in 2 s.
fn wheel() -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    let body = Body::new(mesh, soft).thickness(0.01).build()?;
    let turn = Phase::until(2.0).rotate("all", [0.0, 0.0], [RATE]).project_velocity();
    Ok(Scene::new(body).phase(turn))
}

fn read(sampling: Sampling) -> Sampling {
    sampling
        .read("turned", Reading::rotation())
        .read("in degrees", Reading::rotation().in_degrees())
        // from the diagonal as the angle of the right side: 3/4 of a right angle more than -pi/2 or so
        .read("apart", Reading::angle([[1], [3]], [[1], [9]]))
}

/// What the sensors should say: the lines of the last one turn together.
fn check(trajectory: &Trajectory, from: f64) {
    for sample in trajectory.samples().iter().filter(|sample| sample.time >= from) {
        let expected = [RATE * sample.time, RATE.to_degrees() * sample.time, PI / 4.0];
        for (found, expected) in sample.sensors.iter().zip(expected) {
            // rtol 1e-8, of 18 rad and 1000 degrees
            let off = (found - expected).abs() / expected.abs().max(1.0);
            assert!(off < 2e-7, "{} s: {found} {expected}", sample.time);
        }
    }
}

fn settings() -> Settings {
    Settings { rtol: 1e-8, ..Settings::default() }
}

/// Samples may be more than a turn apart: the run follows the angle from step to step.
#[test]
fn rotations_do_not_depend_on_when_they_are_read() -> Outcome {
    for step in [0.01, 0.9, 2.0] {
        let trajectory = wheel()?.simulate(&settings(), &read(Sampling::every(step)))?;
        check(&trajectory, 0.0);
        let units: Vec<&str> = trajectory.sensors().iter().map(|sensor| &sensor.unit[..]).collect();
        assert_eq!(units, ["rad", "deg", "rad"]);
    }
    Ok(())
}

/// Right after each of them, and later.
#[test]
fn whole_turns_outlive_restores_forks_and_files() -> Outcome {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("wheel.json");
    let mut wheel_now = wheel()?.start(&settings())?;
    wheel_now.record(&read(Sampling::every(0.7)))?;
    wheel_now.advance_to(1.1)?;
    let (kept, mut fork) = (wheel_now.checkpoint(), wheel_now.fork()?);
    kept.write(&path)?;
    let now = |simulation: &mut Simulation| -> Outcome {
        let read = simulation.sample()?.sensors[0];
        let expected = RATE * simulation.time();
        assert!((read - expected).abs() < 2e-7 * TAU, "{read} {expected}");
        Ok(())
    };
    now(&mut wheel_now)?;
    wheel_now.advance_to(1.9)?;
    now(&mut wheel_now)?;
    wheel_now.restore(&kept)?;
    now(&mut wheel_now)?;
    now(&mut fork)?;
    fork.advance_to(2.0)?;
    check(fork.trajectory(), 1.2);
    // in another process, before sensors are recorded and after
    for records_first in [true, false] {
        let mut again = wheel()?.start(&settings())?;
        if records_first {
            again.record(&read(Sampling::every(0.7)))?;
        }
        let kept = again.read_checkpoint(&path)?;
        again.restore(&kept)?;
        if !records_first {
            again.record(&read(Sampling::every(0.7)))?;
        }
        now(&mut again)?;
        again.advance_to(2.0)?;
        check(again.trajectory(), 1.2);
    }
    // without a past it begins within half a turn
    let mut late = wheel()?.start(&settings())?;
    late.advance_to(1.0)?;
    late.record(&read(Sampling::every(0.7)))?;
    let angle = late.sample()?.sensors[0];
    assert!(angle.abs() <= PI && ((angle - RATE) / TAU + 1e-9).fract().abs() < 1e-6, "{angle}");
    Ok(())
}

#[test]
fn degrees_are_for_angles() -> Outcome {
    let sampling = Sampling::phase_ends().read("x", Reading::position("left").in_degrees());
    let error = wheel()?.simulate(&settings(), &sampling).unwrap_err().to_string();
    let parts = ["unit of sensor \"x\"", "\"deg\"", "angles and rotations alone", "in m"];
    assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    Ok(())
}
