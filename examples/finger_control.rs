//! A soft finger under control: a thousand times a second a PID controller looks at the angle of its tip
//! and sets the pressure in its rooms.
//!
//! `cargo run --release --example finger_control`, or with `-- --windup`
//!
//! What to look for: the angle follows the target, first in steps, then along a sine; a load at the tip,
//! which the controller knows nothing of, comes and goes and is made up for within some tenths of a second.
//! From 1 to 1.4 s the target is beyond what the largest pressure reaches: the pressure stays at its limit, and comes
//! down as soon as the target does, because the integral of the error stands still meanwhile. `--windup`
//! lets it grow, and the finger stays up too long (mean error of the step down: 24 degrees in place of 4).

mod common;

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use common::finish;
use pliant::output::{Chart, write_animation};
use pliant::samples::bending_actuator;
use pliant::{
    Chamber, Error, InputError, Mesh, Method, Phase, Sampling, Scene, Selection, Settings, View,
};

/// Period of the controller (s), and end (s).
const PERIOD: f64 = 1e-3;
const END: f64 = 3.5;
/// Pressure (Pa): no suction, and no more than the walls bear.
const LIMITS: [f64; 2] = [0.0, 6000.0];
/// Gains: Pa per degree, per degree and second, per degree/s.
const GAINS: [f64; 3] = [60.0, 2000.0, 2.0];
/// Time constant of the filter (s) in front of the derivative.
const FILTER: f64 = 5e-3;
/// The load (N) on the tip, upward, and when it acts (s).
const LOAD: f64 = 0.02;
const LOADED: [f64; 2] = [0.6, 2.6];

/// What is told apart in the table (s).
const STRETCHES: [(f64, f64, &str); 7] = [
    (0.1, 0.4, "step to 20 degrees"),
    (0.4, 0.6, "at rest"),
    (0.6, 1.0, "the load comes"),
    (1.0, 1.4, "out of reach"),
    (1.4, 1.9, "step down to 10 degrees"),
    (1.9, 2.6, "sine under load"),
    (2.6, 3.5, "the load goes"),
];

/// The finger under control: the errors of its angle, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Let the integral grow while the pressure is at a limit
    #[arg(long)]
    windup: bool,
    /// Integration method
    #[arg(long, default_value_t = Method::Arkode)]
    method: Method,
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-4)]
    rtol: f64,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// The angle (degrees) that the tip should have.
fn target(t: f64) -> f64 {
    match t {
        t if t < 0.1 => 0.0,
        t if t < 1.0 => 20.0,
        t if t < 1.4 => 80.0,
        t if t < 1.9 => 10.0,
        t => 10.0 + 8.0 * (2.0 * TAU * (t - 1.9) / 1.6).sin(),
    }
}

/// How far (degrees) the end of the finger has turned downward: the direction of its end wall.
fn angle(view: &View) -> Result<f64, InputError> {
    let corner = Selection::Box { min: vec![0.0514, 0.0139], max: vec![0.0516, 0.0141] };
    let (low, high) = (view.position("tip")?, view.position(corner)?);
    Ok((high[0] - low[0]).atan2(high[1] - low[1]).to_degrees())
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let drawing = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/meshes/bending-actuator.msh");
    let body = bending_actuator(Mesh::read_gmsh(drawing)?)?.body().clone();
    let scene = Scene::new(body)
        .chamber(Chamber::within("air", "chamber"))
        .phase(Phase::until(END).hold("clamp").named("controlled"));
    let &Arguments { method, rtol, windup, .. } = arguments;
    let mut finger = scene.start(&Settings { method, rtol, ..Settings::default() })?;
    finger.record(&Sampling::every(0.02))?;

    let [lowest, highest] = LIMITS;
    let [proportional, integral, derivative] = GAINS;
    let (mut sum, mut rate, mut before, mut load) = (0.0, 0.0, 0.0, 0.0);
    // time, target, angle, pressure, load
    let mut log: Vec<[f64; 5]> = Vec::new();
    let clock = Instant::now();
    finger.control(PERIOD, END, |finger| {
        let (t, now) = (finger.time(), angle(&finger.view())?);
        let error = target(t) - now;
        rate += PERIOD / FILTER * ((now - before) / PERIOD - rate);
        before = now;
        let wanted = proportional * error + sum - derivative * rate;
        let pressure = wanted.clamp(lowest, highest);
        if windup || pressure == wanted || (wanted - pressure) * error < 0.0 {
            sum += integral * PERIOD * error;
        }
        finger.pressure("air", pressure)?;
        let disturbance = if (LOADED[0]..LOADED[1]).contains(&t) { LOAD } else { 0.0 };
        if disturbance != load {
            load = disturbance;
            finger.load("tip", [0.0, load])?;
        }
        log.push([t, target(t), now, pressure, load]);
        Ok(())
    })?;
    let seconds = clock.elapsed().as_secs_f64();

    println!("{}", finger.report());
    println!("{:.0} ticks of the controller per second", log.len() as f64 / seconds);
    println!("\nfrom (s)  to (s)  error (degrees):           largest     mean     last");
    for (from, to, what) in STRETCHES {
        let rows = log.iter().filter(|row| (from..to).contains(&row[0]));
        let errors: Vec<f64> = rows.map(|row| (row[1] - row[2]).abs()).collect();
        let largest = errors.iter().copied().fold(0.0, f64::max);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let last = errors.last().copied().unwrap_or(0.0);
        println!("{from:8.2} {to:7.2}  {what:24} {largest:9.3} {mean:8.3} {last:8.3}");
    }

    let directory = arguments.out.join("finger_control");
    let series = |column: usize, scale: f64| -> Vec<(f64, f64)> {
        log.iter().map(|row| (row[0], scale * row[column])).collect()
    };
    Chart::new("A soft finger follows a target")
        .axes("time (s)", "angle (degrees), pressure (hPa), load (mN)")
        .series("angle", series(2, 1.0))
        .series("pressure", series(3, 0.01))
        .series("load", series(4, 1e3))
        .reference("target", series(1, 1.0))
        .write(directory.join("control.svg"))?;
    let title = "A soft finger follows a target";
    write_animation(finger.trajectory(), directory.join("animation.html"), title)?;
    println!("written to {}: control.svg, animation.html", directory.display());
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
