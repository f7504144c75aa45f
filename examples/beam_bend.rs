//! The bent beam of Hirai's Figs 4.9 and 4.10: its tip is pushed down by 5 cm in 5 s and released.
//!
//! `cargo run --release --example beam_bend`
//!
//! What to look for: under Cauchy strain the tip swells, because that strain takes rotation for
//! compression; under Green strain it bends as rubber does. Released, the Green beam swings
//! faster: the swollen one is softer.

mod common;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots};
use pliant::samples::beam_bend;
use pliant::{Error, Sampling, Strain};

/// The bent beam under Cauchy and Green strain: tables, swelling of the tip, pictures.
#[derive(Parser)]
struct Arguments {
    /// Hold the horizontal component of the pushed node, too
    #[arg(long)]
    holds_tip: bool,
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { holds_tip, ref common } = arguments;
    let directory = common.out.join("beam_bend");
    let mut chart = Chart::new("Tip of the beam after its release")
        .axes("time (s)", "vertical displacement (m)");
    for strain in [Strain::Cauchy, Strain::Green] {
        let scene = beam_bend(strain, holds_tip)?;
        let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.005))?;
        println!("Bent beam, {strain:?} strain\n{}", trajectory.report());
        if let Some(bent) = trajectory.samples().iter().find(|sample| sample.time == 5.0) {
            let ratios = trajectory.body().volume_ratios(&bent.u);
            let largest = ratios.iter().fold(0.0_f64, |largest, &ratio| largest.max(ratio));
            println!("most swollen cell of the bent beam: area x {largest:.3}\n");
        }
        let name = format!("{strain:?}").to_lowercase();
        Snapshots::at([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 5.05, 5.1, 5.15, 5.2, 5.25, 5.3])
            .title(format!("Dynamic bending of an elastic beam, {strain:?} strain"))
            .columns(6)
            .write(&trajectory, directory.join(format!("{name}.svg")))?;
        let after = trajectory.samples().iter().filter(|sample| sample.time >= 5.0);
        chart = chart.series(
            format!("{strain:?} strain"),
            after.map(|sample| (sample.time, sample.u[2 * 21 + 1])).collect::<Vec<_>>(),
        );
    }
    chart.write(directory.join("tip.svg"))?;
    println!("written to {}: cauchy.svg, green.svg, tip.svg", directory.display());
    Ok(())
}
