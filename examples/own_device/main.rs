//! A device of one's own: a strip of rubber with a jet at its end.
//!
//! `cargo run --release --example own_device`
//!
//! What to look for: `jet.rs` is all that knows of the jet, by the public traits `Device` and `Force`. It has a table in the scene
//! file, `[[jet]]`, inputs that phases set and a program commands, a sensor, a place in checkpoints and lines in the pictures. First the
//! phase of the file fires it to and fro; then a program takes over: it steers the jet so that the end goes up to 18.9 of the 20 mm that are
//! wanted (the strip pulls back on a proportional controller) and stays there, and goes on once more from a checkpoint, with the
//! commands that it holds.

#[path = "../common/mod.rs"]
mod common;
mod jet;

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use clap::Parser;
use common::{Common, finish};
use jet::Jet;
use pliant::output::{Snapshots, write_animation};
use pliant::{DeviceTable, Error, SceneReader, Simulation};

/// A strip with a jet at its end: where the end goes, and pictures.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

/// Proportional and derivative gains of the controller (N/m, N s/m), and where the end should be (m).
const GAINS: [f64; 2] = [4.0, 0.1];
const WANTED: f64 = 0.02;

fn run(arguments: &Arguments) -> Result<(), Error> {
    let Arguments { common } = arguments;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/own_device/scene.toml");
    let reader = SceneReader::new(&[DeviceTable::of::<Jet>("jet")]);
    let file = reader.read_with(path, &[])?;
    let motion = file.scene.simulate(&common.settings(), &file.output.sampling())?;
    println!("{}\ntime (s)  end: x, y (mm)   power (mW)", motion.report());
    for sample in motion.samples().iter().step_by(10) {
        let [x, y, power] = [0, 1, 2].map(|column| 1e3 * sample.sensors[column]);
        println!("{:8.1} {x:9.2} {y:6.2} {power:12.4}", sample.time);
    }

    let mut simulation = file.scene.start(&common.settings())?;
    simulation.device_input("tail", Jet::ANGLE.word, FRAC_PI_2)?;
    steer(&mut simulation, 1.0)?;
    let held = simulation.checkpoint();
    for _ in 0..2 {
        simulation.restore(&held)?;
        steer(&mut simulation, 1.6)?;
        let view = simulation.view();
        let [height, power] =
            [view.position("right")?[1], view.device("tail", Jet::POWER.word)?[0]];
        println!("steered: {:.4} mm above the ground, {:.1e} W", 1e3 * height, power);
    }

    let directory = common.out.join("own_device");
    let title = "A strip with a jet";
    Snapshots::at([0.0, 0.5, 1.0, 1.5])
        .title(title)
        .columns(2)
        .write(&motion, directory.join("snapshots.svg"))?;
    write_animation(&motion, directory.join("animation.html"), title)?;
    println!("written to {}: snapshots.svg, animation.html", directory.display());
    Ok(())
}

/// Steers the thrust up to time `end` (s), a thousand times in a second: at a hundred the damping of the controller shakes the end.
fn steer(simulation: &mut Simulation, end: f64) -> Result<(), Error> {
    while simulation.time() < end - 1e-9 {
        let view = simulation.view();
        let (place, velocity) = (view.position("right")?[1], view.velocity("right")?[1]);
        // the middle of the end is 5 mm above the ground when nothing acts
        let thrust = GAINS[0] * (WANTED - place) - GAINS[1] * velocity;
        simulation.device_input("tail", Jet::THRUST.word, thrust)?;
        simulation.advance_by(0.001)?;
    }
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
