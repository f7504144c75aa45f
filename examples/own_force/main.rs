//! Forces of one's own: a strip of rubber that stands in the wind beside a magnet.
//!
//! `cargo run --release --example own_force`, or with `-- --strength 0`
//!
//! What to look for: `forces.rs` has a magnet (with a potential) and a wind (with drag in proportion to the square of
//! the speed) by the public trait `Force` alone. A gust bends the strip to the magnet, which keeps it when
//! the air is still again; without the magnet it swings back. The energy balance closes, as the magnet gives its
//! potential and the wind says what it supplies and what becomes heat.

#[path = "../common/mod.rs"]
mod common;
mod forces;

use clap::Parser;
use common::{Common, finish};
use forces::{Magnet, Wind};
use pliant::output::{Chart, Snapshots, write_animation, write_energies};
use pliant::{Body, Cells, Error, Material, Mesh, Phase, Sample, Sampling, Scene, Strain};

/// A strip in the wind beside a magnet: where it ends, its energies, and pictures.
#[derive(Parser)]
struct Arguments {
    /// Strength of the magnet (J m^3/kg)
    #[arg(long, default_value_t = 5e-7)]
    strength: f64,
    #[command(flatten)]
    common: Common,
}

const RUBBER: Material = Material { density: 1100.0, young: 2e6, poisson: 0.45, viscosity: 4e3 };
/// Where the magnet is (m).
const MAGNET: [f64; 2] = [0.045, 0.09];

/// A gust (m/s) to the right: it rises within half a second, and is over after 1.5 s.
fn gust(t: f64) -> [f64; 2] {
    [8.0 * (std::f64::consts::PI * (t / 1.5).min(1.0)).sin().powi(2), 0.0]
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { strength, ref common } = arguments;
    let mesh = Mesh::rectangle([0.004, 0.1], [3, 21], Cells::Triangles6)?;
    let body = Body::new(mesh, RUBBER).thickness(0.03).strain(Strain::Green).build()?;
    let windward = body.mesh().select(&"left".into())?;
    let tip = body.mesh().select(&"top".into())?[0];
    // air of 1.2 kg/m^3 and a drag coefficient of 1.2 on 0.1 x 0.03 m^2
    let drag = 1.2 * 1.2 * 0.1 * 0.03 / windward.len() as f64;
    let magnet = Magnet::new(&body, MAGNET, strength, 0.01);
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .force(magnet)
        .force(Wind::new(windward, drag, gust))
        .phase(Phase::until(3.0).hold("bottom").named("gust"));
    let trajectory = scene.simulate(&common.settings(), &Sampling::every(0.01))?;
    println!("{}", trajectory.report());

    println!(
        "\ntime (s)  tip (mm)   balance of energies (mJ): stored  dissipated  supplied       sum"
    );
    for sample in trajectory.samples().iter().step_by(30) {
        let energy = sample.energy;
        let stored = energy.balance() - energy.dissipated + energy.supplied;
        let [stored, heat, supplied, sum] =
            [stored, energy.dissipated, energy.supplied, energy.balance()].map(|x| 1e3 * x);
        let (t, x) = (sample.time, 1e3 * sample.u[2 * tip]);
        println!("{t:8.1} {x:9.2} {stored:33.4} {heat:11.4} {supplied:9.4} {sum:9.6}");
    }

    let directory = common.out.join("own_force");
    let series = |value: &dyn Fn(&Sample) -> f64| -> Vec<(f64, f64)> {
        trajectory.samples().iter().map(|sample| (sample.time, value(sample))).collect()
    };
    Chart::new("A strip in the wind beside a magnet")
        .axes("time (s)", "tip (mm), wind (m/s)")
        .series("tip to the right", series(&|sample| 1e3 * sample.u[2 * tip]))
        .series("wind", series(&|sample| gust(sample.time)[0]))
        .write(directory.join("tip.svg"))?;
    let title = "A strip in the wind beside a magnet";
    Snapshots::at([0.0, 0.3, 0.6, 0.75, 1.0, 1.5, 2.0, 3.0])
        .title(title)
        .columns(4)
        .write(&trajectory, directory.join("snapshots.svg"))?;
    write_animation(&trajectory, directory.join("animation.html"), title)?;
    write_energies(&trajectory, directory.join("energies.csv"))?;
    println!(
        "written to {}: tip.svg, snapshots.svg, animation.html, energies.csv",
        directory.display()
    );
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
