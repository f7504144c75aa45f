//! The pressed square of Hirai's Figs 4.3 and 4.4: its bottom fixed, the middle third of its top
//! pressed down, held, and let go.
//!
//! `cargo run --release --example square_press -- --nodes 10`
//!
//! What to look for: after the release the square swings about its undeformed shape and calms down.
//! The constraint forces (`forces.svg`) are what a probe that presses it would read. They begin
//! and end with a jump: the square has to move at once.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv, write_vtk};
use pliant::samples::{pushed_nodes, square_press};
use pliant::{Error, Sampling};

/// The pressed square: a table of its phases, the force of the probe, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Nodes along a side of the square
    #[arg(long, default_value_t = 4)]
    nodes: usize,
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { nodes, ref common } = arguments;
    let trajectory = square_press(nodes)?.simulate(&common.settings(), &Sampling::every(0.005))?;
    println!("Pressed square, {nodes} x {nodes} nodes\n{}", trajectory.report());

    let mut forces = Vec::new();
    let pressed = trajectory.samples().iter().filter(|s| s.phase < 2 && s.time > 0.0);
    for sample in pressed {
        let force = trajectory.constraint_force(sample, pushed_nodes(nodes))?;
        forces.push((sample.time, -force[1]));
    }
    for time in [0.25, 0.5, 1.0] {
        if let Some((_, force)) = forces.iter().find(|(t, _)| (t - time).abs() < 1e-9) {
            println!("the probe presses with {force:.2} N at {time} s");
        }
    }

    let directory = common.out.join(format!("square_press_{nodes}x{nodes}"));
    let title = format!("Dynamic deformation of an elastic square body, {nodes} x {nodes} nodes");
    let times = [0.0, 0.25, 0.5, 1.0, 1.05, 1.1, 1.2, 1.4, 1.7, 2.0];
    Snapshots::at(times).title(&title).write(&trajectory, directory.join("snapshots.svg"))?;
    Chart::new("Force of the probe")
        .axes("time (s)", "force (N)")
        .series("all pushed nodes", forces)
        .write(directory.join("forces.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&pushed_nodes(nodes).into()))?;
    write_vtk(&trajectory, directory.join("vtk"), "square")?;
    println!("written to {}: snapshots.svg, forces.svg, trajectory.csv, vtk/", directory.display());
    Ok(())
}
