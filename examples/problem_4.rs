//! Problem 4 of Hirai's chapter: how the tangential damping B_t of the floor affects the rolling
//! ring.
//!
//! `cargo run --release --example problem_4`
//!
//! What to look for: with Hirai's viscosity the ring creeps, does not slip, and B_t from 2 to
//! 200 N s/m hardly matters. With objective viscosity it rolls fast, and slips the more the less B_t
//! is: at 0.02 N s/m it turns almost on the spot, about its centre of mass.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::Chart;
use pliant::samples::RingRoll;
use pliant::{Error, Sample, Sampling, Viscosity};

/// The rolling ring on floors of different tangential damping.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse().common));
}

fn run(common: &Common) -> Result<(), Error> {
    let directory = common.out.join("problem_4");
    println!(
        "{:10} {:>12} {:>14} {:>14} {:>8}",
        "viscosity", "B_t (N s/m)", "distance (cm)", "turned (deg)", "steps"
    );
    for viscosity in [Viscosity::Natural, Viscosity::Objective] {
        let name = format!("{viscosity:?}").to_lowercase();
        let mut chart = Chart::new(format!("Centre of mass of the rolling ring, {name} viscosity"))
            .axes("time (s)", "distance (m)");
        for tangential_damping in [0.02, 0.2, 2.0, 20.0, 200.0] {
            let ring =
                RingRoll { tangential_damping, viscosity, until: 2.0, ..RingRoll::default() };
            let trajectory = ring.scene()?.simulate(&common.settings(), &Sampling::every(0.01))?;
            let start = trajectory.centre_of_mass(&trajectory.samples()[0])[0];
            let distance = |sample: &Sample| trajectory.centre_of_mass(sample)[0] - start;
            let (last, steps) = (trajectory.last(), trajectory.report().steps());
            println!(
                "{name:10} {tangential_damping:12} {:14.3} {:14.2} {steps:8}",
                100.0 * distance(last),
                trajectory.rotation(last).unwrap_or(0.0).to_degrees(),
            );
            let points = trajectory.samples().iter().map(|s| (s.time, distance(s)));
            chart = chart
                .series(format!("B_t = {tangential_damping} N s/m"), points.collect::<Vec<_>>());
        }
        chart.write(directory.join(format!("{name}.svg")))?;
    }
    println!("written to {}: natural.svg, objective.svg", directory.display());
    Ok(())
}
