//! The ring with eight springs rolls by feedback: a hundred times a second a controller looks how far it has
//! turned and how fast it is, and lets those springs pull that make it fall over to the right.
//!
//! `cargo run --release --example ring_crawl`, or with `-- --viscosity natural`
//!
//! What to look for: a pair of opposite springs that leans to the left squashes the ring to an ellipse that
//! leans to the right, and its weight lays it down. The controller hands the pull on from pair to pair as they
//! turn past the upright, pulls less as the ring nears the wanted speed, and on the other side when it is too
//! fast. The ring travels thirteen times its size in 6 s; by a timetable, without looking, it walks 11 cm in 12 s
//! (`ring_springs`). Natural viscosity brakes every rotation, and the ring creeps: 5 cm in 6 s, and with
//! `--force 1` some 70 cm in a minute.

mod common;

use std::path::PathBuf;
use std::time::Instant;

use clap::{Parser, ValueEnum};
use common::finish;
use pliant::output::{Chart, Snapshots, write_animation};
use pliant::samples::spring_ring;
use pliant::{Error, InputError, Method, Phase, Sampling, Settings, View, Viscosity};

/// Period of the controller (s).
const PERIOD: f64 = 0.01;
/// How far below the wanted speed (m/s) springs pull with all their force.
const SLACK: f64 = 0.1;
/// Outer diameter of the ring (m).
const SIZE: f64 = 0.1;

/// The crawling ring: how far it comes, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Largest force of a spring (N)
    #[arg(long, default_value_t = 0.3)]
    force: f64,
    /// Speed to be kept (m/s)
    #[arg(long, default_value_t = 0.25)]
    speed: f64,
    /// How viscosity acts
    #[arg(long, value_enum, default_value_t = Law::Objective)]
    viscosity: Law,
    /// End (s)
    #[arg(long, default_value_t = 6.0)]
    until: f64,
    /// Integration method
    #[arg(long, default_value_t = Method::Auto)]
    method: Method,
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-4)]
    rtol: f64,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Law {
    Natural,
    Objective,
}

/// Direction (rad) of the springs of pair number `k`, from 1 on, through the ring.
fn direction(view: &View, k: usize) -> Result<f64, InputError> {
    let [near, far] = [k, k + 4].map(|spring| view.position([12 * (spring - 1) + 1]));
    let (near, far) = (near?, far?);
    Ok((far[1] - near[1]).atan2(far[0] - near[0]))
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { force, speed, until, method, rtol, .. } = arguments;
    let viscosity = match arguments.viscosity {
        Law::Natural => Viscosity::Natural,
        Law::Objective => Viscosity::Objective,
    };
    let scene = spring_ring(viscosity)?.phase(Phase::until(until).named("crawl"));
    let mut ring = scene.start(&Settings { method, rtol, ..Settings::default() })?;
    ring.record(&Sampling::every(0.02))?;
    let clock = Instant::now();
    ring.control(PERIOD, until, |ring| {
        let now = ring.view().mean_velocity()[0];
        let drive = ((speed - now) / SLACK).clamp(-1.0, 1.0);
        for pair in 1..=4 {
            // upright at 90 degrees: between there and 180 the springs lean to the left, and the sine is negative
            let lean = (2.0 * direction(&ring.view(), pair)?).sin();
            for spring in [pair, pair + 4] {
                ring.actuate(&format!("A{spring}"), force * (drive * lean).min(0.0))?;
            }
        }
        Ok(())
    })?;
    let seconds = clock.elapsed().as_secs_f64();
    println!("{}", ring.report());
    println!("{until} s of motion in {seconds:.1} s");

    let trajectory = ring.trajectory();
    let x = |k: usize| trajectory.centre_of_mass(&trajectory.samples()[k])[0];
    println!("\ntime (s)  distance (m)  in sizes of the ring");
    for (k, sample) in trajectory.samples().iter().enumerate().step_by(50) {
        println!("{:8.1} {:13.3} {:8.2}", sample.time, x(k), x(k) / SIZE);
    }
    let directory = arguments.out.join("ring_crawl");
    let path = trajectory.samples().iter().enumerate().map(|(k, sample)| (sample.time, x(k)));
    Chart::new("A ring crawls")
        .axes("time (s)", "distance (m)")
        .series("centre of mass", path)
        .reference("at the wanted speed", [(0.0, 0.0), (until, speed * until)])
        .write(directory.join("distance.svg"))?;
    Snapshots::at([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
        .title("A ring crawls")
        .columns(4)
        .mark([1])
        .write(trajectory, directory.join("snapshots.svg"))?;
    write_animation(trajectory, directory.join("animation.html"), "A ring crawls")?;
    println!("written to {}: distance.svg, snapshots.svg, animation.html", directory.display());
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
