//! The membrane of Hirai's Fig. 4.8, inflated by 2 kPa until 1.5 s and then left alone; and an arch.
//!
//! `cargo run --release --example membrane`
//!
//! What to look for: the membrane bulges at once, swings about its inflated shape, and is back in its
//! natural one, after some more swings, half a second after the pressure is gone. The arch, over a
//! wider chamber, does likewise and less.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv};
use pliant::samples::{membrane, membrane_arch};
use pliant::{Error, Sample, Sampling};

/// Two inflated membranes: how far they bulge, and pictures.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse().common));
}

fn run(common: &Common) -> Result<(), Error> {
    let directory = common.out.join("membrane");
    let mut chart =
        Chart::new("Inflated membranes").axes("time (s)", "rise of the centre of mass (m)");
    for (name, scene) in [("strip", membrane()?), ("arch", membrane_arch()?)] {
        let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.01))?;
        println!("{name}\n{}", trajectory.report());
        let natural = trajectory.centre_of_mass(&trajectory.samples()[0])[1];
        let rise = |sample: &Sample| trajectory.centre_of_mass(sample)[1] - natural;
        for time in [0.1, 1.5, 1.6, 2.0, 3.0] {
            if let Some(sample) = trajectory.samples().iter().find(|s| (s.time - time).abs() < 1e-9)
            {
                println!("risen by {:7.3} mm at {time} s", 1e3 * rise(sample));
            }
        }
        println!();
        chart = chart.series(
            name,
            trajectory.samples().iter().map(|s| (s.time, rise(s))).collect::<Vec<_>>(),
        );
        Snapshots::at([0.0, 0.02, 0.05, 0.1, 1.5, 1.52, 1.6, 2.0])
            .title(format!("Dynamic expansion of an elastic membrane by air pressure: {name}"))
            .columns(4)
            .write(&trajectory, directory.join(format!("{name}.svg")))?;
        write_csv(&trajectory, directory.join(format!("{name}.csv")), None)?;
    }
    chart.write(directory.join("rise.svg"))?;
    println!("written to {}: strip.svg, arch.svg, rise.svg, *.csv", directory.display());
    Ok(())
}
