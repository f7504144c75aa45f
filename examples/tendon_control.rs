//! A soft finger on two tendons under control: every 4 ms a controller looks at the angle of its tip and at the tensions of
//! the tendons, and sets what two winches draw in until the next tick.
//!
//! `cargo run --release --example tendon_control`, or with `-- --tick 0.002`
//!
//! The winches follow a beam in closed form ([`Beam`]). Two loops correct what is asked of it: one adds to the angle (proportional
//! and integral), the other one to the tension of the slacker tendon. The same motion is run without the loops, too, and with
//! them at half of the tick.
//!
//! What to look for: the closed form alone is 0.7 degrees short at 30 degrees. A load that hangs at the tip turns it by 1.5 degrees, and the
//! lower tendon becomes slack as it comes. With the loops the error goes to zero, under the load within 0.3 s to half a degree, and both
//! tendons stay taut. Half of the tick makes the same motion to 0.2 degrees. Steps rise as fast as the winches turn.

mod common;

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use common::finish;
use pliant::output::{Chart, write_animation};
use pliant::{
    Body, CellSelection, Cells, Error, Guide, InputError, Law, Material, Mesh, Method, Phase,
    Report, Sampling, Scene, Settings, Signal, Simulation, Spring, Trajectory, View,
};

/// Length, height and thickness of the finger (m), and the length of its rigid cap.
const SIZE: [f64; 3] = [0.1, 0.012, 0.015];
const CAP: f64 = 0.005;
const DENSITY: f64 = 1100.0;
const YOUNG: f64 = 3.0e5;
const POISSON: f64 = 0.45;
const GRAVITY: f64 = 9.8;
/// Stiffness (N/m) and damping (N s/m) of a tendon.
const STIFFNESS: f64 = 2.0e3;
const DAMPING: f64 = 2.0;
const TENDONS: [&str; 2] = ["upper", "lower"];
/// The corners of the tip: nodes.
const CORNERS: [usize; 2] = [42, 21];

/// Largest speed of a winch (m/s).
const SPEED: f64 = 0.02;
/// Tension (N) of the slacker tendon, and the largest that the loop asks for.
const TENSE: f64 = 0.4;
const TENSEST: f64 = 1.5;
/// Gains of the angle: proportional (1), integral (1/s); of the tension: integral (1/s).
const GAINS: [f64; 3] = [0.2, 12.0, 6.0];

/// When the target begins to move, and the end (s). Until then the tendons are drawn taut.
const START: f64 = 0.6;
const END: f64 = 5.0;
/// The load (N) on the tip, downward, and when it hangs there (s).
const LOAD: f64 = 0.08;
const LOADED: [f64; 2] = [2.2, 3.2];
/// Time intervals of the table (s).
const STRETCHES: [(f64, f64, &str); 5] = [
    (0.6, 1.4, "step to 30 degrees"),
    (1.4, 2.2, "step to -20 degrees"),
    (2.2, 3.2, "the load hangs at the tip"),
    (3.2, 3.8, "the load is gone"),
    (3.8, 5.0, "sine of 20 degrees"),
];

/// The finger under control: errors of its angle, tensions, times, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Period of the controller (s)
    #[arg(long, default_value_t = 4e-3)]
    tick: f64,
    /// Integration method
    #[arg(long, default_value_t = Method::Arkode)]
    method: Method,
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-3)]
    rtol: f64,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// The angle (degrees) that the tip should have.
fn target(t: f64) -> f64 {
    match t {
        t if t < START => 0.0,
        t if t < 1.4 => 30.0,
        t if t < 3.8 => -20.0,
        t => -20.0 * (TAU * (t - 3.8) / 1.2).cos(),
    }
}

/// How far (degrees) the tip has turned upward: the direction of its end wall.
fn angle(view: &View) -> Result<f64, InputError> {
    let [high, low] = CORNERS.map(|corner| view.position([corner]));
    let (high, low) = (high?, low?);
    Ok((low[0] - high[0]).atan2(high[1] - low[1]).to_degrees())
}

fn finger() -> Result<Scene, Error> {
    let [length, height, thickness] = SIZE;
    let silicone = Material { density: DENSITY, young: YOUNG, poisson: POISSON, viscosity: 1e3 };
    let cap = CellSelection::inside([length - CAP, 0.0], [length, height]);
    let body = Body::new(
        Mesh::rectangle([length, height], [21, 2], Cells::Rectangles9)?,
        silicone.law(Law::NeoHookean),
    );
    let body = body.thickness(thickness).region(cap, Material::rigid(DENSITY)).build()?;
    // from a winch at the wall along every fourth node of a side
    let tendon = |name: &str, first: usize, y: f64| {
        let nodes: Vec<usize> = (first..=first + 20).step_by(4).collect();
        Spring::cable([Guide::point([-0.01, y]), Guide::nodes(nodes)])
            .winch()
            .stiffness(STIFFNESS)
            .damping(DAMPING)
            .friction_coefficient(0.1)
            .sticking_speed(5e-3)
            .named(name)
    };
    Ok(Scene::new(body)
        .gravity([0.0, -GRAVITY])
        .spring(tendon(TENDONS[0], 22, height))
        .spring(tendon(TENDONS[1], 1, 0.0))
        .phase(Phase::until(END).hold("left").named("controlled")))
}

/// The finger as a beam of Euler and Bernoulli in plane strain, which two tendons bend and press.
struct Beam {
    /// Distance of the tendons from the axis, and flexible length (m).
    lever: f64,
    length: f64,
    /// E I/(1 - nu^2) (N m^2), and E A/(1 - nu^2) (N)
    bending: f64,
    axial: f64,
    weight: f64,
}

impl Beam {
    fn new() -> Self {
        let [length, height, thickness] = SIZE;
        let young = YOUNG / (1.0 - POISSON * POISSON);
        let area = height * thickness;
        Self {
            lever: height / 2.0,
            length: length - CAP,
            bending: young * area * height * height / 12.0,
            axial: young * area,
            weight: DENSITY * GRAVITY * area * length,
        }
    }

    /// Lengths (m) that the winches have to draw in, for the tip to turn by `angle` (degrees) while the slacker tendon bears
    /// `tense` (N).
    ///
    /// The difference of the tensions times the lever is the mean moment: that which bends the beam and that of its weight, as if it
    /// lay straight. A tendon is shorter than at first by lever times angle (the other one is longer), by what the beam is pressed
    /// together, and by its own stretch.
    fn winches(&self, angle: f64, tense: f64) -> [f64; 2] {
        let &Self { lever, length, bending, axial, weight } = self;
        let angle = angle.to_radians();
        let moment = bending * angle / length + weight * length / 6.0;
        let apart = moment / lever;
        let pressed = (2.0 * tense + apart.abs()) * length / axial;
        [1.0, -1.0].map(|side| {
            let tension = tense + (side * apart).max(0.0);
            side * lever * angle + pressed + tension / STIFFNESS
        })
    }
}

/// Controller with its gains and states.
struct Controller {
    beam: Beam,
    tick: f64,
    /// Gains of the angle and the tension; 0 without feedback.
    gains: [f64; 3],
    /// Integral terms of the angle (degrees) and of the tension (N).
    turned: f64,
    tightened: f64,
    /// Lengths drawn in by the winches (m).
    drawn: [f64; 2],
}

impl Controller {
    /// Winch commands (m) at time `t` (s), for the `target` and the `angle` (degrees) of the tip and both `tensions` (N).
    fn act(&mut self, t: f64, [target, angle]: [f64; 2], tensions: [f64; 2]) -> [f64; 2] {
        let [proportional, integral, tension] = self.gains;
        let error = target - angle;
        // drawn taut little by little
        let tense = TENSE * (t / START).min(1.0);
        let asked = target + proportional * error + self.turned;
        let wanted = self.beam.winches(asked, tense + self.tightened);
        let (most, mut follow) = (SPEED * self.tick, true);
        for (drawn, wanted) in self.drawn.iter_mut().zip(wanted) {
            let change = wanted - *drawn;
            follow &= change.abs() <= most;
            *drawn += change.clamp(-most, most);
        }
        // the integrals stand still while a winch cannot follow
        if follow {
            self.turned += integral * self.tick * error;
            self.tightened += tension * self.tick * (tense - tensions[0].min(tensions[1]));
            self.tightened = self.tightened.clamp(-tense, TENSEST - tense);
        }
        self.drawn
    }
}

/// Record of a tick.
struct Row {
    /// The middle of the tick (s): no change of the target falls on it.
    t: f64,
    /// Angles of the tip (degrees), as it should be and is.
    target: f64,
    angle: f64,
    /// At the winches (N), and the least of both tendons at either end.
    tensions: [f64; 2],
    least: f64,
    /// Wall time (s) of the tick: the controller, and the motion until the next one.
    seconds: f64,
}

/// The motion of the finger, with a tick of the controller of `tick` (s), with or without feedback.
fn trial(
    scene: &Scene,
    settings: &Settings,
    tick: f64,
    feedback: bool,
) -> Result<(Vec<Row>, Report, Trajectory), Error> {
    let mut finger: Simulation = scene.start(settings)?;
    finger.record(&Sampling::every(0.02))?;
    let mut controller = Controller {
        beam: Beam::new(),
        tick,
        gains: if feedback { GAINS } else { [0.0; 3] },
        turned: 0.0,
        tightened: 0.0,
        drawn: [0.0; 2],
    };
    let mut rows: Vec<Row> = Vec::new();
    let mut load = 0.0;
    let mut clock = Instant::now();
    finger.control(tick, END, |finger| {
        if let Some(last) = rows.last_mut() {
            last.seconds = clock.elapsed().as_secs_f64();
        }
        clock = Instant::now();
        let (view, t) = (finger.view(), finger.time() + 0.5 * tick);
        let (target, angle) = (target(t), angle(&view)?);
        let [upper, lower] = TENDONS.map(|tendon| view.spring_pulls(tendon));
        let (upper, lower) = (upper?, lower?);
        let tensions = [upper[0], lower[0]];
        let least = upper.into_iter().chain(lower).fold(f64::MAX, f64::min);
        rows.push(Row { t, target, angle, tensions, least, seconds: 0.0 });
        let (before, now) = (controller.drawn, finger.time());
        let after = controller.act(t, [target, angle], tensions);
        for (number, tendon) in TENDONS.into_iter().enumerate() {
            // evenly, until the next tick
            let drawn = Signal::ramp(before[number], after[number], now, tick);
            finger.actuate(tendon, drawn)?;
        }
        let disturbance = if (LOADED[0]..LOADED[1]).contains(&t) { LOAD } else { 0.0 };
        if disturbance != load {
            load = disturbance;
            finger.load([CORNERS[0]], [0.0, -load])?;
        }
        Ok(())
    })?;
    if let Some(last) = rows.last_mut() {
        last.seconds = clock.elapsed().as_secs_f64();
    }
    let report = finger.report();
    Ok((rows, report, finger.into_trajectory()))
}

/// The time (s) from `start` to the first row whose angle lies at least as far as `angle` (degrees) on the way to it.
fn reached(rows: &[Row], start: f64, angle: f64) -> f64 {
    let way = rows.iter().filter(|row| row.t >= start);
    let mut way = way.skip_while(|row| row.angle < angle);
    way.next().map_or(f64::NAN, |row| row.t - start)
}

/// Errors of the angle in each stretch, and tensions.
fn tell(rows: &[Row]) {
    println!(
        "from (s)  to (s)  error (degrees):            largest     mean  at the end  slack (s)"
    );
    for (from, to, what) in STRETCHES {
        let rows: Vec<&Row> = rows.iter().filter(|row| (from..to).contains(&row.t)).collect();
        let errors: Vec<f64> = rows.iter().map(|row| row.target - row.angle).collect();
        let mean = errors.iter().map(|error| error.abs()).sum::<f64>() / errors.len() as f64;
        let largest = errors.iter().fold(0.0, |most: f64, error| most.max(error.abs()));
        // with its sign, over the last 0.1 s
        let end = &errors[rows.partition_point(|row| row.t < to - 0.1)..];
        let end = end.iter().sum::<f64>() / end.len() as f64;
        let slack = rows.iter().filter(|row| row.least <= 0.0).count();
        let slack = slack as f64 / rows.len() as f64 * (to - from);
        println!("{from:8.2} {to:7.2}  {what:25} {largest:9.3} {mean:8.3} {end:11.3} {slack:10.3}");
    }
    let under_way = || rows.iter().filter(|row| row.t >= START);
    let most = under_way().flat_map(|row| row.tensions).fold(0.0, f64::max);
    let least = under_way().map(|row| row.least).fold(f64::MAX, f64::min);
    println!("tensions from {least:.3} N to {most:.3} N");
}

/// Median, 99 % and worst of the wall time of a tick beside its `period` (s).
fn tell_ticks(rows: &[Row], period: f64) {
    let mut seconds: Vec<f64> = rows.iter().map(|row| row.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let [median, most, worst] =
        [seconds.len() / 2, seconds.len() * 99 / 100, seconds.len() - 1].map(|k| 1e3 * seconds[k]);
    let late = seconds.iter().filter(|&&seconds| seconds > period).count();
    println!(
        "a tick of {} ms takes {median:.2} ms (median), {most:.2} ms (99 %), {worst:.2} ms (worst); \
         {:.1} % take longer than it; all of them {:.2} of real time",
        1e3 * period,
        100.0 * late as f64 / seconds.len() as f64,
        seconds.iter().sum::<f64>() / (seconds.len() as f64 * period)
    );
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { tick, method, rtol, .. } = arguments;
    let (scene, settings) = (finger()?, Settings { method, rtol, ..Settings::default() });

    println!("without feedback");
    let (open, ..) = trial(&scene, &settings, tick, false)?;
    tell(&open);
    println!("\nwith feedback");
    let (closed, report, motion) = trial(&scene, &settings, tick, true)?;
    tell(&closed);
    let rise = reached(&closed, START, 27.0) - reached(&closed, START, 3.0);
    let back = closed.iter().rfind(|row| row.t < LOADED[1] && (row.target - row.angle).abs() > 0.5);
    let back = back.map_or(f64::NAN, |row| row.t - LOADED[0]);
    println!("under the load the angle is back within 0.5 degrees after {:.0} ms", 1e3 * back);
    println!("the step to 30 degrees rises from 10 to 90 % within {:.0} ms", 1e3 * rise);
    tell_ticks(&closed, tick);
    println!("\n{report}");

    let (finer, ..) = trial(&scene, &settings, 0.5 * tick, true)?;
    let apart = closed.iter().zip(finer.iter().step_by(2));
    let apart = apart.map(|(row, fine)| (row.angle - fine.angle).abs());
    println!(
        "\nwith half of the tick the angle differs by at most {:.3} degrees",
        apart.fold(0.0, f64::max)
    );

    let directory = arguments.out.join("tendon_control");
    let every = (0.01 / tick).ceil() as usize;
    let of = |rows: &[Row], value: &dyn Fn(&Row) -> f64| -> Vec<(f64, f64)> {
        rows.iter().step_by(every).map(|row| (row.t, value(row))).collect()
    };
    Chart::new("A finger on two tendons follows a target")
        .axes("time (s)", "angle (degrees)")
        .series("with feedback", of(&closed, &|row| row.angle))
        .series("without", of(&open, &|row| row.angle))
        .reference("target", of(&closed, &|row| row.target))
        .write(directory.join("angle.svg"))?;
    Chart::new("Tensions at the winches")
        .axes("time (s)", "tension (N)")
        .series("upper", of(&closed, &|row| row.tensions[0]))
        .series("lower", of(&closed, &|row| row.tensions[1]))
        .reference("lower, without feedback", of(&open, &|row| row.tensions[1]))
        .write(directory.join("tensions.svg"))?;
    let title = "A finger on two tendons follows a target";
    write_animation(&motion, directory.join("animation.html"), title)?;
    println!("written to {}: angle.svg, tensions.svg, animation.html", directory.display());
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
