//! The flag of Turek and Hron (CSM1 and CSM2) in equilibrium under gravity: which cells does
//! accuracy ask for?
//!
//! `cargo run --release --example flag`
//!
//! What to look for: linear triangles lock in bending, crossed triangles and rectangles less so.
//! 710 unknowns of quadratic triangles come nearer (0.6 %) than 9,554 of linear ones (2.1 %), in a
//! tenth of the time.

mod common;

use std::time::Instant;

use clap::Parser;
use common::{Common, finish};
use pliant::output::Snapshots;
use pliant::{Body, Cells, Error, Material, Mesh, Phase, Scene, Statics, Strain};

/// A table of error against unknowns and time, and a picture of the hanging flag.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: Common,
}

fn main() {
    finish(run(&Arguments::parse().common));
}

fn run(common: &Common) -> Result<(), Error> {
    for (name, mu, expected) in [("CSM1", 0.5e6, -66.103), ("CSM2", 2.0e6, -16.974)] {
        println!("{name}: shear modulus {mu:.1e} Pa, the tip sinks by {expected} mm");
        println!(
            "{:12} {:>10} {:>10} {:>12} {:>10} {:>10}",
            "cells", "mesh", "unknowns", "tip (mm)", "error (%)", "time (s)"
        );
        for cells in Cells::ALL {
            for (along, across) in [(35, 2), (70, 4), (140, 8), (280, 16)] {
                let scene = flag(cells, along, across, mu)?;
                let clock = Instant::now();
                let equilibrium = scene.equilibrium(&Statics::default())?;
                let seconds = clock.elapsed().as_secs_f64();
                let tip = 1e3 * tip_height(&scene, equilibrium.displacements());
                let (error, unknowns) = (100.0 * (tip / expected - 1.0), scene.body().dofs());
                let mesh = format!("{along} x {across}");
                println!(
                    "{cells:12} {mesh:>10} {unknowns:>10} {tip:>12.4} {error:>10.3} {seconds:>10.4}"
                );
                if cells == Cells::Triangles6 && across == 2 {
                    let file = common.out.join("flag").join(format!("{name}.svg"));
                    Snapshots::at([0.0, 1.0])
                        .title(format!("{name}: a flag hangs"))
                        .write(equilibrium.trajectory(), file)?;
                }
            }
        }
        println!();
    }
    println!("written to {}: CSM1.svg, CSM2.svg", common.out.join("flag").display());
    Ok(())
}

/// The flag: 0.02 m high, from the arc of a cylinder of radius 0.05 m round (0.2, 0.2), where it is
/// clamped, to x = 0.6; density 1000, nu = 0.4, gravity 2 m/s^2.
fn flag(cells: Cells, along: usize, across: usize, mu: f64) -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([1.0, 0.02], [along + 1, across + 1], cells)?.mapped(|x| {
        let y = 0.19 + x[1];
        let arc = 0.2 + (0.05_f64.powi(2) - (y - 0.2).powi(2)).sqrt();
        [arc + x[0] * (0.6 - arc), y]
    })?;
    let material = Material { density: 1000.0, young: 2.8 * mu, poisson: 0.4, viscosity: 0.0 };
    let body = Body::new(mesh, material).thickness(1.0).strain(Strain::Green).build()?;
    Ok(Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(1.0).named("hangs").hold("left")))
}

/// Vertical displacement (m) of the middle of the free end.
fn tip_height(scene: &Scene, u: &[f64]) -> f64 {
    let places = scene.body().mesh().positions().chunks(2);
    let distance = |x: &[f64]| (x[0] - 0.6).hypot(x[1] - 0.2);
    let tip = places.enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    tip.map_or(f64::NAN, |(node, _)| u[2 * node + 1])
}
