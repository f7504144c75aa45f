//! Many scenes at once: how fast the pressed square takes off from floors of different stiffness, for
//! squares of different meshes.
//!
//! `cargo run --release --example sweep`
//!
//! What to look for: scenes are plain values and solvers are `Send`, so a sweep is a parallel iterator of
//! `rayon`; `RAYON_NUM_THREADS=1` shows what one core would take. A soft floor gives way while the square
//! unfolds, and little of its strain energy becomes speed; on a hard one the mesh matters more.

mod common;

use std::time::Instant;

use common::finish;
use indicatif::{ParallelProgressIterator, ProgressStyle};
use pliant::samples::SquareJump;
use pliant::{Error, Sampling, Settings};
use rayon::prelude::*;

/// Nodes along a side.
const MESHES: [usize; 3] = [4, 7, 10];
/// Stiffnesses of the floor, per decade from 10 N/m to 100 kN/m.
const PER_DECADE: i32 = 4;

/// Speed (m/s) at which the square rises in the end.
fn speed(nodes: usize, floor: f64) -> Result<f64, Error> {
    let scene = SquareJump { nodes, floor, ..SquareJump::default() }.scene()?;
    let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    Ok(trajectory.mean_velocity(trajectory.last())[1])
}

fn sweep() -> Result<(), Error> {
    let floors: Vec<f64> = (PER_DECADE..=5 * PER_DECADE)
        .map(|k| 10f64.powf(f64::from(k) / f64::from(PER_DECADE)))
        .collect();
    let scenes: Vec<(usize, f64)> =
        floors.iter().flat_map(|&floor| MESHES.map(|nodes| (nodes, floor))).collect();
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} scenes, {eta} to go")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let clock = Instant::now();
    let speeds: Vec<f64> = scenes
        .par_iter()
        .progress_with_style(style)
        .map(|&(nodes, floor)| speed(nodes, floor))
        .collect::<Result<_, _>>()?;
    let seconds = clock.elapsed().as_secs_f64();

    println!("floor (N/m)   speed (m/s) with {MESHES:?} nodes along a side");
    for (floor, speeds) in floors.iter().zip(speeds.chunks(MESHES.len())) {
        let speeds: String = speeds.iter().map(|speed| format!("{speed:10.4}")).collect();
        println!("{floor:11.0}{speeds}");
    }
    let threads = rayon::current_num_threads();
    println!("{} scenes in {seconds:.2} s on {threads} threads", scenes.len());
    Ok(())
}

fn main() {
    finish(sweep());
}
