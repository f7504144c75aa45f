//! The static square of the slides: 4 x 4 nodes in unit cells, its bottom fixed, nodes 14 and 15
//! pressed down by 0.3.
//!
//! `cargo run --release --example static_square -- --strain green`
//!
//! What to look for: nearly incompressible, the square bulges sideways. The triangles, all cut the
//! same way, make the result lopsided though the load is not: corner 13 sinks less than corner 16.
//! With Green strain the probe feels a quarter less: 0.3 is a tenth of the height, and no small
//! strain any more.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use pliant::output::Snapshots;
use pliant::samples::static_square;
use pliant::{Error, Statics, Strain};

/// The static square: displacements of its top, the force of the probe, and a picture.
#[derive(Parser)]
struct Arguments {
    /// Measure of strain
    #[arg(long, value_enum, default_value_t = Measure::Cauchy)]
    strain: Measure,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Measure {
    Cauchy,
    Green,
}

fn main() {
    if let Err(error) = run(&Arguments::parse()) {
        eprintln!("static_square: {error}");
        std::process::exit(1);
    }
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let strain = match arguments.strain {
        Measure::Cauchy => Strain::Cauchy,
        Measure::Green => Strain::Green,
    };
    let equilibrium = static_square(strain)?.equilibrium(&Statics::default())?;
    println!("Static square, {strain:?} strain: {equilibrium}");
    println!("{:>6} {:>12} {:>12}", "node", "u (m)", "v (m)");
    for node in 13..=16 {
        let u = &equilibrium.displacements()[2 * (node - 1)..2 * node];
        println!("{node:6} {:12.8} {:12.8}", u[0], u[1]);
    }
    let probe = equilibrium.trajectory().constraint_force(equilibrium.sample(), [14, 15])?;
    let (across, up) = (probe[0] / 1e3, probe[1] / 1e3);
    println!("force of the probe on the square: ({across:.3}, {up:.3}) kN");
    println!("strain energy {:.3} kJ", equilibrium.sample().energy.strain / 1e3);

    let path = arguments.out.join(format!("static_square/{strain:?}.svg").to_lowercase());
    let title = format!("Static deformation of an elastic square, {strain:?} strain");
    Snapshots::at([0.0, 1.0]).title(title).write(equilibrium.trajectory(), &path)?;
    println!("written to {}", path.display());
    Ok(())
}
