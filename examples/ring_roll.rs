//! The rolling ring of Hirai's Fig. 4.11: its right half is ten times as heavy as its left one.
//!
//! `cargo run --release --example ring_roll -- --viscosity objective`
//!
//! What to look for: the ring rolls clockwise, to the right, and comes to rest with its heavy half
//! down. Hirai's viscosity -B v brakes every rotation: the ring creeps (67 degrees in the
//! first second, 76 in two) and stops at 90. Viscosity on the rate of Green's strain, which a rigid
//! rotation leaves alone, lets it roll through and swing.

mod common;

use clap::{Parser, ValueEnum};
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_animation, write_csv, write_vtk};
use pliant::samples::RingRoll;
use pliant::{Error, Sample, Sampling, Viscosity};

/// The rolling ring: a table, where it comes to rest, and pictures.
#[derive(Parser)]
struct Arguments {
    /// How viscosity acts
    #[arg(long, value_enum, default_value_t = Law::Natural)]
    viscosity: Law,
    /// Tangential damping of the floor (N s/m per node)
    #[arg(long, default_value_t = 20.0)]
    tangential_damping: f64,
    /// End (s)
    #[arg(long, default_value_t = 5.0)]
    until: f64,
    #[command(flatten)]
    common: Common,
}

#[derive(Clone, Copy, ValueEnum)]
enum Law {
    Natural,
    Objective,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { viscosity, tangential_damping, until, ref common } = arguments;
    let (viscosity, name) = match viscosity {
        Law::Natural => (Viscosity::Natural, "natural"),
        Law::Objective => (Viscosity::Objective, "objective"),
    };
    let scene = RingRoll { viscosity, tangential_damping, until, ..RingRoll::default() }.scene()?;
    let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.01))?;
    println!("Rolling ring, {name} viscosity\n{}", trajectory.report());
    let centre = |sample: &Sample| trajectory.centre_of_mass(sample);
    let degrees = |sample: &Sample| trajectory.rotation(sample).unwrap_or(0.0).to_degrees();
    for sample in trajectory.samples().iter().step_by(50) {
        let (t, x, angle) = (sample.time, 100.0 * centre(sample)[0], degrees(sample));
        println!("t = {t:4.1} s   centre of mass at {x:5.2} cm   turned by {angle:7.2} degrees");
    }

    let directory = common.out.join(format!("ring_roll_{name}"));
    let title = format!("Rolling of an elastic ring, {name} viscosity");
    write_animation(&trajectory, directory.join("animation.html"), &title)?;
    let times: Vec<f64> = [0.0, 0.1, 0.2, 0.5, 1.0, until].into();
    Snapshots::at(times)
        .title(title)
        .columns(6)
        .mark([1])
        .write(&trajectory, directory.join("snapshots.svg"))?;
    let series = |value: &dyn Fn(&Sample) -> f64| -> Vec<(f64, f64)> {
        trajectory.samples().iter().map(|sample| (sample.time, value(sample))).collect()
    };
    Chart::new("Rotation of the ring")
        .axes("time (s)", "angle (degrees)")
        .series(format!("{name} viscosity"), series(&degrees))
        .write(directory.join("rotation.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), None)?;
    write_vtk(&trajectory, directory.join("vtk"), "ring")?;
    println!(
        "written to {}: animation.html, snapshots.svg, rotation.svg, trajectory.csv, vtk/",
        directory.display()
    );
    Ok(())
}
