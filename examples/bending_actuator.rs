//! A soft robot's finger, drawn in Gmsh: a row of bellows above a stiff layer curls up under air
//! pressure, and swings back when the air is let out.
//!
//! `cargo run --release --example bending_actuator`
//!
//! What to look for: the air lengthens the side of the bellows, the layer keeps its length, so the
//! finger bends to the layer. In rest the tip moves about in proportion to the pressure at first. The
//! mesh is `scenes/meshes/bending-actuator.msh`; `--mesh` takes another one of the same drawing, to
//! see how much a finer one changes (`gmsh -2 -clscale 0.5 bending-actuator.geo -o finer.msh`).

mod common;

use std::path::PathBuf;

use clap::Parser;
use common::{Common, finish};
use pliant::output::{Chart, Snapshots, write_csv};
use pliant::samples::bending_actuator;
use pliant::{Chamber, Error, Mesh, Phase, Sample, Sampling, Scene, Statics};

/// How far the finger bends at rest and in motion, and pictures.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
    /// Mesh of the finger
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/meshes/bending-actuator.msh"))]
    mesh: PathBuf,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let mesh = Mesh::read_gmsh(&arguments.mesh)?;
    let tip = mesh.select(&"tip".into())?[0];
    println!("{} nodes, {} cells", mesh.node_count(), mesh.cell_count());
    let scene = bending_actuator(mesh)?;

    println!("\n{:>13} {:>10} {:>10}", "pressure (Pa)", "x (mm)", "y (mm)");
    for pressure in [1000.0, 2000.0, 3000.0, 4000.0, 5000.0] {
        let blown = Phase::until(1.0).hold("clamp").pressure("air", pressure);
        let finger = Scene::new(scene.body().clone()).chamber(Chamber::within("air", "chamber"));
        let equilibrium = finger.phase(blown).equilibrium(&Statics::default())?;
        let u = &equilibrium.displacements()[2 * tip..][..2];
        println!("{pressure:>13} {:>10.3} {:>10.3}", 1e3 * u[0], 1e3 * u[1]);
    }

    let trajectory = scene.simulate(&arguments.common.settings(), &Sampling::every(0.005))?;
    println!("\n{}", trajectory.report());

    let directory = arguments.common.out.join("bending_actuator");
    let height = |sample: &Sample| (sample.time, 1e3 * sample.u[2 * tip + 1]);
    Chart::new("Bending actuator")
        .axes("time (s)", "height of the tip (mm)")
        .series("tip", trajectory.samples().iter().map(height).collect::<Vec<_>>())
        .write(directory.join("tip.svg"))?;
    Snapshots::at([0.0, 0.05, 0.1, 1.0, 1.05, 1.1, 1.2, 2.0])
        .title("A finger bends under air pressure and is let go")
        .columns(4)
        .write(&trajectory, directory.join("snapshots.svg"))?;
    write_csv(&trajectory, directory.join("trajectory.csv"), Some(&"tip".into()))?;
    println!("written to {}: snapshots.svg, tip.svg, trajectory.csv", directory.display());
    Ok(())
}
