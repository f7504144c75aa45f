//! Heaps of soft rings that fall into a box: what contact costs as it grows.
//!
//! `cargo run --release --example heap -- --most 40`
//!
//! What to look for: the time for a step grows about in proportion to the number of rings, like that of the same rings
//! without contact, which fall through each other; the pattern of the Newton matrix changes a few times in a hundred
//! steps. `out/heap` has pictures.

mod common;

use std::time::Instant;

use clap::Parser;
use common::{finish, patterns_and_overlaps};
use pliant::output::Snapshots;
use pliant::{
    Body, Cells, Error, Law, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings, Touch,
};

/// A table of heaps: steps, time and changes of the pattern with contact, and time without.
#[derive(Parser)]
struct Arguments {
    /// Rings of the largest heap
    #[arg(long, default_value_t = 20)]
    most: usize,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: std::path::PathBuf,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    println!(
        "{:>6} {:>9} {:>7} {:>9} {:>10} {:>14} {:>22} {:>9}",
        "rings",
        "unknowns",
        "steps",
        "patterns",
        "time (s)",
        "per step (ms)",
        "without contact (ms)",
        "overlaps"
    );
    let settings = Settings { rtol: 1e-3, ..Settings::default() };
    for rings in [5, 10, 20, 40, 80].into_iter().filter(|&rings| rings <= arguments.most) {
        let timed = |touches: bool| {
            let scene = heap(rings, touches)?;
            let clock = Instant::now();
            let motion = scene.simulate(&settings, &Sampling::every(0.05))?;
            Ok::<_, Error>((clock.elapsed().as_secs_f64(), motion))
        };
        let (seconds, motion) = timed(true)?;
        let (alone, free) = timed(false)?;
        let report = motion.report();
        let (changes, overlaps) = patterns_and_overlaps(&motion);
        println!(
            "{rings:>6} {:>9} {:>7} {changes:>9} {seconds:>10.2} {:>14.2} {:>22.2} {:>9}",
            report.states,
            report.steps(),
            1e3 * seconds / report.steps() as f64,
            1e3 * alone / free.report().steps() as f64,
            overlaps,
        );
        let file = arguments.out.join("heap").join(format!("{rings}.svg"));
        Snapshots::at([0.0, 0.2, 0.4, 0.6]).title(format!("{rings} rings")).write(&motion, file)?;
    }
    println!("written to {}", arguments.out.join("heap").display());
    Ok(())
}

/// Rings of 4 cm, five to a row, above a box that is as wide.
fn heap(rings: usize, touches: bool) -> Result<Scene, Error> {
    let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 30.0 };
    let ring = |number: usize| {
        let (column, row) = (number % 5, number / 5);
        let aside = if row % 2 == 0 { 0.0 } else { 0.006 };
        let place = [0.026 + 0.045 * column as f64 + aside, 0.03 + 0.045 * row as f64];
        let mesh = Mesh::ring(0.014, 0.02, [16, 2], Cells::Crossed)?.translated(&place)?;
        Body::new(mesh, soft.law(Law::NeoHookean))
            .thickness(0.02)
            .named(format!("{number}"))
            .build()
    };
    let bodies = (0..rings).map(ring).collect::<Result<Vec<_>, _>>()?;
    let wall = |name: &str, point: [f64; 2], normal: [f64; 2]| {
        Obstacle::half_plane(point, normal).named(name).stiffness_density(1e7).damping(1e4)
    };
    let scene = Scene::new(Body::join(bodies)?)
        .obstacle(
            wall("floor", [0.0, 0.0], [0.0, 1.0]).friction_coefficient(0.3).sticking_speed(0.01),
        )
        .obstacle(wall("left", [0.0, 0.0], [1.0, 0.0]))
        .obstacle(wall("right", [0.24, 0.0], [-1.0, 0.0]))
        .gravity([0.0, -9.8])
        .phase(Phase::until(0.6));
    let touch = Touch::all().distance(1e-3).friction_coefficient(0.3).sticking_speed(0.01);
    Ok(if touches { scene.touch(touch) } else { scene })
}
