//! "Report #8" of the slides: a rectangle on its fixed bottom, pressed from both sides by opposite
//! forces along different lines, then let go.
//!
//! `cargo run --release --example report_8`
//!
//! What to look for: the two forces make no resultant but a couple, which shears and bends the
//! rectangle clockwise; it sways, comes to rest, and sways again when it is let go.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv};
use pliant::samples::report_8;
use pliant::{Error, Sampling};

/// The rectangle between two forces: a table and pictures.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse().common));
}

fn run(common: &Common) -> Result<(), Error> {
    let trajectory = report_8()?.simulate(&common.settings(), &Sampling::every(0.005))?;
    println!("Rectangle between two forces\n{}", trajectory.report());
    let node = |number: usize| -> Vec<(f64, f64)> {
        trajectory.samples().iter().map(|s| (s.time, s.u[2 * (number - 1)])).collect()
    };
    let directory = common.out.join("report_8");
    Snapshots::at([0.0, 0.02, 0.05, 0.1, 0.5, 0.52, 0.6, 1.0])
        .title("A viscoelastic rectangle between two forces")
        .columns(4)
        .mark([43, 28])
        .write(&trajectory, directory.join("snapshots.svg"))?;
    Chart::new("Where the forces act")
        .axes("time (s)", "horizontal displacement (m)")
        .series("node 43, pressed to the right", node(43))
        .series("node 28, pressed to the left", node(28))
        .write(directory.join("displacements.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&[28, 43].into()))?;
    println!(
        "written to {}: snapshots.svg, displacements.svg, trajectory.csv",
        directory.display()
    );
    Ok(())
}
