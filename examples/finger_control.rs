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
//!
//! With `-- --reduced` a model of 12 unknowns is learned first, from steps, ramps and sines of the pressure and the load. The
//! controller runs on it, 19 times as fast as on the finger itself, which comes next, and both motions are compared: the angles are
//! 0.21 degrees apart at most, the displacements 0.33 % of the largest one.

mod common;

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use common::finish;
use pliant::output::{Chart, write_animations};
use pliant::reduce::{Training, error, reduce};
use pliant::samples::bending_actuator;
use pliant::{
    Chamber, Error, InputError, Mesh, Method, Phase, Sampling, Scene, Selection, Settings,
    Trajectory, View,
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

/// Time intervals of the table (s).
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
    /// Learn a reduced model, and control it before the finger itself
    #[arg(long)]
    reduced: bool,
    /// Error of the reduced model that is wanted, relative to the largest displacement
    #[arg(long, default_value_t = 0.005)]
    within: f64,
    /// Most unknowns of the reduced model: more of them are better and slower
    #[arg(long, default_value_t = 12)]
    unknowns: usize,
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

/// The finger from a `phase` on, that holds it.
fn finger(phase: Phase) -> Result<Scene, Error> {
    let drawing = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/meshes/bending-actuator.msh");
    let body = bending_actuator(Mesh::read_gmsh(drawing)?)?.body().clone();
    let air = Chamber::within("air", "chamber");
    Ok(Scene::new(body).chamber(air).phase(phase.hold("clamp").named("controlled")))
}

/// A `scene` of the finger in the unknowns of a model that is learned from other pressures and loads than those of the controller.
fn learned(scene: &Scene, arguments: &Arguments, settings: &Settings) -> Result<Scene, Error> {
    // times (s), parts of the largest pressure and of the load
    let table = |rows: &[[f64; 3]]| {
        let column = |column: usize| rows.iter().map(move |row| row[column]);
        let times: Vec<f64> = column(0).collect();
        let pressures: Vec<f64> = column(1).map(|part| LIMITS[1] * part).collect();
        let loads = column(2).map(|part| [0.0, LOAD * part]);
        let phase = Phase::until(times[times.len() - 1]);
        let phase = phase.pressure_table("air", times.clone(), pressures);
        finger(phase.load_table("tip", times, loads))
    };
    let sines = |pressure: f64, load: f64| {
        let half = |rate: f64, t: f64| 0.5 * (1.0 - (TAU * rate * t).cos());
        let phase = Phase::until(1.5).pressure_with("air", move |t| LIMITS[1] * half(pressure, t));
        finger(phase.load_with("tip", move |t| [0.0, LOAD * half(load, t)]))
    };
    let steps = [
        [0.0, 0.0, 0.0],
        [0.001, 0.5, 0.0],
        [0.3, 0.5, 0.0],
        [0.301, 0.5, 1.0],
        [0.6, 0.5, 1.0],
        [0.601, 1.0, 1.0],
        [1.0, 1.0, 1.0],
        [1.001, 0.0, 1.0],
        [1.3, 0.0, 1.0],
        [1.301, 0.0, 0.0],
        [1.6, 0.0, 0.0],
    ];
    let ramps = [[0.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.0, 1.0, 0.0], [1.5, 0.0, 1.0]];
    let other_steps = [
        [0.0, 0.0, 0.0],
        [0.001, 0.3, 0.0],
        [0.3, 0.3, 0.7],
        [0.5, 0.3, 0.7],
        [0.501, 1.0, 0.7],
        [0.9, 1.0, 0.7],
        [0.901, 0.4, 0.7],
        [1.3, 0.4, 0.7],
    ];
    let training = Training {
        scenes: vec![table(&steps)?, table(&ramps)?, sines(1.0, 4.0)?],
        held_out: vec![table(&other_steps)?, sines(3.0, 1.4)?],
        settings: settings.clone(),
        within: arguments.within,
        most_unknowns: arguments.unknowns,
    };
    let reduced = reduce(&training, &mut |_| ControlFlow::Continue(()))?;
    println!("{reduced}\n");
    Ok(scene.clone().reduced(reduced.model)?)
}

/// The finger in the hands of the controller.
struct Controlled {
    /// Time (s), target, angle (degrees), pressure (Pa), load (N) at each tick.
    log: Vec<[f64; 5]>,
    motion: Trajectory,
}

/// Runs the controller on `finger`, and prints errors of the angle and times of ticks.
fn controlled(finger: &Scene, settings: &Settings, windup: bool) -> Result<Controlled, Error> {
    let mut finger = finger.start(settings)?;
    finger.record(&Sampling::every(0.02))?;

    let [lowest, highest] = LIMITS;
    let [proportional, integral, derivative] = GAINS;
    let (mut sum, mut rate, mut before, mut load) = (0.0, 0.0, 0.0, 0.0);
    let mut log: Vec<[f64; 5]> = Vec::new();
    let mut begun: Vec<Instant> = Vec::new();
    finger.control(PERIOD, END, |finger| {
        begun.push(Instant::now());
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
    begun.push(Instant::now());
    let mut ticks: Vec<f64> = begun.windows(2).map(|w| (w[1] - w[0]).as_secs_f64()).collect();

    println!("{}", finger.report());
    println!(
        "{:.0} ticks of the controller per second",
        log.len() as f64 / ticks.iter().sum::<f64>()
    );
    ticks.sort_by(f64::total_cmp);
    let [median, most] = [ticks.len() / 2, ticks.len() * 99 / 100].map(|k| 1e6 * ticks[k]);
    println!("a tick takes {median:.0} us (median), {most:.0} us (99 %)");
    println!("\nfrom (s)  to (s)  error (degrees):           largest     mean     last");
    for (from, to, what) in STRETCHES {
        let rows = log.iter().filter(|row| (from..to).contains(&row[0]));
        let errors: Vec<f64> = rows.map(|row| (row[1] - row[2]).abs()).collect();
        let (largest, mean) = largest_and_mean(&errors);
        let last = errors.last().copied().unwrap_or(0.0);
        println!("{from:8.2} {to:7.2}  {what:24} {largest:9.3} {mean:8.3} {last:8.3}");
    }
    println!();
    Ok(Controlled { log, motion: finger.into_trajectory() })
}

/// The largest one of `values` that are not negative, and their mean.
fn largest_and_mean(values: &[f64]) -> (f64, f64) {
    let largest = values.iter().copied().fold(0.0, f64::max);
    (largest, values.iter().sum::<f64>() / values.len() as f64)
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { method, rtol, windup, reduced, .. } = arguments;
    let settings = Settings { method, rtol, ..Settings::default() };
    let scene = finger(Phase::until(END))?;
    let by_model = if reduced {
        let scene = learned(&scene, arguments, &settings)?;
        Some(controlled(&scene, &settings, windup)?)
    } else {
        None
    };
    let full = controlled(&scene, &settings, windup)?;

    let directory = arguments.out.join("finger_control");
    let series = |log: &[[f64; 5]], column: usize, scale: f64| -> Vec<(f64, f64)> {
        log.iter().map(|row| (row[0], scale * row[column])).collect()
    };
    let title = "A soft finger follows a target";
    let mut chart = Chart::new(title)
        .axes("time (s)", "angle (degrees), pressure (hPa), load (mN)")
        .series("angle", series(&full.log, 2, 1.0))
        .series("pressure", series(&full.log, 3, 0.01))
        .series("load", series(&full.log, 4, 1e3))
        .reference("target", series(&full.log, 1, 1.0));
    let mut motions = vec![("", &full.motion)];
    if let Some(model) = &by_model {
        for (column, what, unit) in [(2, "angle", "degrees"), (3, "pressure", "Pa")] {
            let pairs = model.log.iter().zip(&full.log);
            let apart: Vec<f64> = pairs.map(|(a, b)| (a[column] - b[column]).abs()).collect();
            let (largest, mean) = largest_and_mean(&apart);
            println!(
                "{what} by the model and in full: {largest:.3} {unit} apart at most, {mean:.3} on average"
            );
        }
        let off = 100.0 * error(&full.motion, &model.motion);
        println!("displacements: {off:.2} % of the largest one apart at most");
        let pairs = model.log.iter().zip(&full.log);
        let apart = pairs.map(|(a, b)| (b[0], 10.0 * (a[2] - b[2])));
        chart = chart.series("10 times the error of the model's angle", apart);
        motions = vec![("all unknowns", &full.motion), ("reduced model", &model.motion)];
    }
    chart.write(directory.join("control.svg"))?;
    write_animations(&motions, directory.join("animation.html"), title)?;
    println!("written to {}: control.svg, animation.html", directory.display());
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
