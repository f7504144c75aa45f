//! Barrier against springs: two blocks that collide, the nearer the contact distance comes to 0.
//!
//! `cargo run --release --example contact_laws`
//!
//! What to look for: both laws converge to the same motion as the distance and the compliance go to 0, and the barrier
//! gets there without any overlap; springs that are too soft let the blocks through each other, which the report tells.

mod common;

use std::time::Instant;

use clap::Parser;
use common::finish;
use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Error, Law, Material, Mesh, Phase, Sampling, Scene, Settings, Touch, Trajectory,
};

/// A table of error, least gap, steps and time over the contact distance, for both laws.
#[derive(Parser)]
struct Arguments {
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-5)]
    rtol: f64,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let settings = Settings { rtol: arguments.rtol, ..Settings::default() };
    let simulate = |touch: Touch, settings: &Settings| -> Result<(f64, Trajectory), Error> {
        let scene = collision(touch)?;
        let sampling = Sampling::every(0.001).read("gap", Reading::gap("touch"));
        let clock = Instant::now();
        let motion = scene.simulate(settings, &sampling)?;
        Ok((clock.elapsed().as_secs_f64(), motion))
    };
    let fine = Settings { rtol: 0.1 * arguments.rtol, ..Settings::default() };
    let (_, exact) = simulate(Touch::all().distance(2e-5), &fine)?;
    println!(
        "{:>8} {:>12} {:>16} {:>14} {:>10} {:>8} {:>10}",
        "law", "D (mm)", "k D (kPa)", "error (mm)", "gap (D)", "steps", "time (s)"
    );
    for (law, spring) in [("barrier", false), ("spring", true)] {
        for distance in [2e-3, 1e-3, 5e-4, 2e-4, 1e-4] {
            for pressure in [1e4, 1e5] {
                let touch = Touch::all().distance(distance).stiffness_density(pressure / distance);
                let touch = if spring { touch.spring() } else { touch };
                let (seconds, motion) = simulate(touch, &settings)?;
                let squares = motion.samples().iter().zip(exact.samples()).flat_map(|(a, b)| {
                    a.u.iter().zip(&b.u).map(|(a, b)| (a - b).powi(2)).collect::<Vec<_>>()
                });
                let squares: Vec<f64> = squares.collect();
                let error = (2.0 * squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
                let gaps = motion.samples().iter().map(|sample| sample.sensors[0] / distance);
                let passed =
                    motion.indicators().iter().any(|of| of.name == "overlap" && of.value > 0.0);
                println!(
                    "{law:>8} {:>12.2} {:>16.0} {:>14.4} {:>10.3} {:>8} {seconds:>10.3}{}",
                    1e3 * distance,
                    1e-3 * pressure,
                    1e3 * error,
                    gaps.fold(1.0, f64::min),
                    motion.report().steps(),
                    if passed { "  passes through" } else { "" }
                );
            }
        }
    }
    Ok(())
}

/// Two blocks of rubber, one of them thrown at the other one off its centre.
fn collision(touch: Touch) -> Result<Scene, Error> {
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 5.0 };
    let block = |name: &str, at: [f64; 2], nodes: [usize; 2], cells: Cells| {
        let mesh = Mesh::rectangle([0.1, 0.1], nodes, cells)?.translated(&at)?;
        Body::new(mesh, rubber.law(Law::NeoHookean)).thickness(0.01).named(name).build()
    };
    let left = block("left", [0.0, 0.0], [7, 7], Cells::Triangles)?;
    let right = block("right", [0.11, 0.03], [6, 6], Cells::Rectangles)?;
    Ok(Scene::new(Body::join([left, right])?)
        .touch(touch)
        .initial_velocity(|x| vec![if x[0] < 0.105 { 1.0 } else { 0.0 }, 0.0])
        .phase(Phase::until(0.06)))
}
