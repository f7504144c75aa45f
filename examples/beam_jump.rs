//! The jumping beam of Hirai's Fig. 4.1: a bar of six nodes, pressed from above, then let go.
//!
//! `cargo run --release --example beam_jump -- --method rk`
//!
//! With `--gravity 9.8` the bar jumps 8.46 cm high instead of flying on.
//!
//! What to look for: pressed with 2 N the bar shortens by F L/(E A) = 2 cm; let go it leaves the
//! floor after 13 ms with 0.870 m/s. These numbers are known from the matrix exponential; the
//! table shows how near the integration comes to them.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv};
use pliant::samples::BeamJump;
use pliant::{Error, Sample, Sampling, Trajectory};

/// The jumping beam: a table of its phases, its key figures beside exact ones, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Gravity (m/s^2)
    #[arg(long, default_value_t = 0.0)]
    gravity: f64,
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { gravity, ref common } = arguments;
    let trajectory = BeamJump { gravity, ..BeamJump::default() }
        .scene()?
        .simulate(&common.settings(), &Sampling::every(0.0005))?;
    println!("Jumping beam\n{}", trajectory.report());

    match gravity {
        0.0 => compare(&trajectory),
        _ => {
            let tops = trajectory.samples().iter().map(|s| (height(&trajectory, s), s.time));
            let top = tops.fold((0.0, 0.0), |top, now| if now.0 > top.0 { now } else { top });
            println!(
                "greatest height of the centre of mass: {:.4} cm at {} s",
                100.0 * top.0,
                top.1
            );
        }
    }

    let directory = common.out.join("beam_jump");
    let times = [0.0, 0.05, 0.1, 0.2, 0.205, 0.21, 0.22, 0.23, 0.24, 0.25];
    Snapshots::at(times)
        .title("One-dimensional elastic beam jumping")
        .write(&trajectory, directory.join("snapshots.svg"))?;
    let early = || trajectory.samples().iter().filter(|sample| sample.time <= 0.35);
    let node = |number: usize| {
        let natural = trajectory.body().mesh().position(number - 1)[0];
        early().map(move |s| (s.time, natural + s.u[number - 1])).collect::<Vec<_>>()
    };
    Chart::new("Jumping beam")
        .axes("time (s)", "height (m)")
        .series("tip", node(6))
        .series(
            "centre of mass",
            early().map(|s| (s.time, height(&trajectory, s))).collect::<Vec<_>>(),
        )
        .series("foot", node(1))
        .write(directory.join("heights.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&"all".into()))?;
    println!("written to {}: snapshots.svg, heights.svg, trajectory.csv", directory.display());
    Ok(())
}

/// Prints key figures beside exact ones.
fn compare(trajectory: &Trajectory) {
    let last = trajectory.last();
    let tip = |time: f64| {
        let at = trajectory.samples().iter().find(|sample| (sample.time - time).abs() < 1e-9);
        at.map_or(f64::NAN, |sample| 100.0 * sample.u[5])
    };
    println!("{:36} {:>12} {:>12}", "", "found", "exact");
    for (what, found, exact) in [
        ("tip at the end of the push (cm)", tip(0.2), -2.010310969),
        ("velocity of the flight (m/s)", trajectory.mean_velocity(last)[0], 0.8702088819),
        ("centre of mass at 0.6 s (cm)", 100.0 * height(trajectory, last), 38.32329530),
    ] {
        println!("{what:36} {found:12.7} {exact:12.7}");
    }
}

/// Height of the centre of mass (m).
fn height(trajectory: &Trajectory, sample: &Sample) -> f64 {
    trajectory.centre_of_mass(sample)[0]
}
