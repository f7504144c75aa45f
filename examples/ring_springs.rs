//! The ring with eight spring actuators of Hirai's Fig. 4.12: pairs of opposite springs shrink one
//! after the other.
//!
//! `cargo run --release --example ring_springs`, or with `-- --jump`, or with `-- --force 5`
//!
//! What to look for: with 1 N the ring walks 11 cm to the right in 12 s. With Hirai's 5 N
//! A2 is pulled to length zero 10 ms after it was told to shrink: the run ends, and says so. With
//! `--jump` the ring crouches (A1 and A5 shrink by up to 1 N within 0.1 s), and its centre of mass
//! jumps to 7.1 cm at 0.2 s.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv, write_vtk};
use pliant::samples::{ring_jump, ring_springs};
use pliant::{Error, Sample, Sampling};

/// The ring with eight springs: where it walks, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Force with which a pair of springs shrinks (N)
    #[arg(long, default_value_t = 1.0)]
    force: f64,
    /// Jump instead of walking
    #[arg(long)]
    jump: bool,
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { force, jump, ref common } = arguments;
    let (scene, name, step, times) = match jump {
        true => (ring_jump()?, "ring_jump", 0.005, vec![0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 1.0]),
        false => {
            let times = vec![0.0, 0.2, 1.0, 2.0, 2.1, 4.0, 5.5, 6.9, 7.0, 8.5, 10.0, 12.0];
            (ring_springs(force)?, "ring_springs", 0.02, times)
        }
    };
    let trajectory = scene.simulate(&common.settings(), &Sampling::every(step))?;
    println!("Ring with eight springs\n{}", trajectory.report());
    let centre = |sample: &Sample| trajectory.centre_of_mass(sample);
    let last = trajectory.last();
    println!(
        "centre of mass at the end: {:.3} cm to the right, {:.3} cm high; turned by {:.3} rad",
        100.0 * centre(last)[0],
        100.0 * centre(last)[1],
        trajectory.rotation(last).unwrap_or(0.0)
    );
    let top = trajectory
        .samples()
        .iter()
        .map(|s| (centre(s)[1], s.time))
        .fold((0.0, 0.0), |top, now| if now.0 > top.0 { now } else { top });
    println!("its greatest height: {:.3} cm at {:.3} s", 100.0 * top.0, top.1);

    let directory = common.out.join(name);
    Snapshots::at(times)
        .title("An elastic ring driven by spring actuators")
        .columns(4)
        .mark("mass")
        .write(&trajectory, directory.join("snapshots.svg"))?;
    let path = |axis: usize| -> Vec<(f64, f64)> {
        trajectory.samples().iter().map(|sample| (sample.time, centre(sample)[axis])).collect()
    };
    Chart::new("Centre of mass")
        .axes("time (s)", "position (m)")
        .series("to the right", path(0))
        .series("height", path(1))
        .write(directory.join("centre.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&"mass".into()))?;
    write_vtk(&trajectory, directory.join("vtk"), "ring")?;
    println!("written to {}: snapshots.svg, centre.svg, trajectory.csv, vtk/", directory.display());
    Ok(())
}
