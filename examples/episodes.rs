//! A thousand jumps at random, as a program that learns would try them: a ring with eight springs crouches by
//! forces drawn by lot, lets go, and its centre of mass flies.
//!
//! `cargo run --release --example episodes`, or with `-- --seed 2`
//!
//! What to look for: the ring settles once; each thread has a fork of it, and each episode begins with the restored
//! state. No mesh, no matrix and no ordering is made anew. The histogram is the same for the same seed, bit
//! by bit and on any number of threads (`RAYON_NUM_THREADS=1`). Most of an episode is motion: a new start for each,
//! which has to settle again, costs more, as the last lines say. Jumps of 2 to 4 mm are the rule; those few that
//! fly far have nearly all of their force in the upright pair A1 and A5.

mod common;

use std::path::PathBuf;
use std::time::Instant;

use clap::Parser;
use common::finish;
use pliant::output::Chart;
use pliant::samples::spring_ring;
use pliant::{Checkpoint, Error, Phase, Scene, Settings, Signal, Simulation, Viscosity};
use rayon::prelude::*;

/// The ring is at rest on the floor by then (s).
const SETTLED: f64 = 0.3;
/// Episodes by which ways to begin are compared.
const COMPARED: usize = 50;
/// Width of a bar of the histogram (m).
const BAR: f64 = 0.002;

/// Random jumps: a histogram of their heights, and episodes per second.
#[derive(Parser)]
struct Arguments {
    /// Number of episodes
    #[arg(long, default_value_t = 1000)]
    episodes: usize,
    /// What all random numbers come from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Directory for the picture
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// Random numbers in [0, 1): SplitMix64 of Steele, Lea and Flood, 2014.
struct Lot(u64);

impl Lot {
    fn draw(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Lets the settled ring jump; gives how high (m) its centre of mass comes above where it was.
///
/// Each pair of opposite springs shrinks by a force that grows to at most 1 N together within
/// 0.05 to 0.15 s, and then lets go.
fn episode(ring: &mut Simulation, seed: u64, number: usize) -> Result<f64, Error> {
    let mut lot = Lot(seed.wrapping_add((number as u64) << 32));
    let (start, rest) = (ring.time(), ring.view().centre_of_mass()[1]);
    let crouch = 0.05 + 0.1 * lot.draw();
    let shares = [(); 4].map(|()| lot.draw().powi(4));
    let total = lot.draw() / shares.iter().sum::<f64>();
    for (pair, share) in shares.iter().enumerate() {
        for spring in [pair + 1, pair + 5] {
            let force = Signal::ramp(0.0, -total * share, start, crouch);
            ring.actuate(&format!("A{spring}"), force)?;
        }
    }
    ring.advance_by(crouch)?;
    for spring in 1..=8 {
        ring.actuate(&format!("A{spring}"), 0.0)?;
    }
    // up, until it falls again
    let (end, mut height) = (ring.time() + 0.3, rest);
    while ring.advance_until(end, |view| view.mean_velocity()[1])? {
        height = height.max(ring.view().centre_of_mass()[1]);
    }
    Ok(height - rest)
}

fn start(scene: &Scene, settings: &Settings) -> Result<Simulation, Error> {
    let mut ring = scene.start(settings)?;
    ring.advance_to(SETTLED)?;
    Ok(ring)
}

/// Episodes of each of the `rings`, side by side; the heights are those of numbers 0, 1, 2, ...
fn play(
    rings: &mut [Simulation],
    settled: &Checkpoint,
    seed: u64,
    episodes: usize,
) -> Result<Vec<f64>, Error> {
    let count = rings.len();
    let heights = rings.par_iter_mut().enumerate().map(|(first, ring)| {
        let one = |number| ring.restore(settled).and_then(|()| episode(ring, seed, number));
        (first..episodes).step_by(count).map(one).collect::<Result<Vec<f64>, Error>>()
    });
    let heights: Vec<Vec<f64>> = heights.collect::<Result<_, _>>()?;
    Ok((0..episodes).map(|number| heights[number % count][number / count]).collect())
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let &Arguments { episodes, seed, ref out } = arguments;
    let settings = Settings { rtol: 1e-3, ..Settings::default() };
    let clock = Instant::now();
    let scene = spring_ring(Viscosity::Objective)?.phase(Phase::until(1.0).named("jump"));
    let ring = start(&scene, &settings)?;
    let settled = ring.checkpoint();
    println!("the ring made and settled in {:.1} ms", 1e3 * clock.elapsed().as_secs_f64());

    let mut rings = Vec::new();
    for _ in 0..rayon::current_num_threads() {
        rings.push(ring.fork()?);
    }
    let clock = Instant::now();
    let heights = play(&mut rings, &settled, seed, episodes)?;
    let seconds = clock.elapsed().as_secs_f64();
    let rate = episodes as f64 / seconds;
    println!(
        "{episodes} episodes in {seconds:.2} s on {} threads: {rate:.0} per second",
        rings.len()
    );
    let highest = heights.iter().copied().fold(0.0, f64::max);
    println!(
        "mean height {:.3} mm, largest {:.3} mm",
        1e3 * heights.iter().sum::<f64>() / episodes as f64,
        1e3 * highest
    );

    let mut bars = vec![0_usize; (highest / BAR) as usize + 1];
    heights.iter().for_each(|height| bars[(height / BAR) as usize] += 1);
    println!("\nheight (mm)  episodes");
    let most = bars.iter().max().copied().unwrap_or(1).max(1);
    for (k, bar) in bars.iter().enumerate() {
        println!("{:5} to {:2} {bar:9}  {}", 2 * k, 2 * k + 2, "#".repeat(60 * bar / most));
    }

    let bar = |(k, bar): (usize, &usize)| (BAR * (k as f64 + 0.5) * 1e3, *bar as f64);
    Chart::new(format!("{episodes} random jumps of a ring"))
        .axes("height of the jump (mm)", "episodes per 2 mm")
        .marked("episodes", bars.iter().enumerate().map(bar))
        .write(out.join("episodes/heights.svg"))?;

    println!("\neach episode begins with    ms per episode, of {COMPARED} on one thread");
    let compare = |what: &str, begin: &mut dyn FnMut(usize) -> Result<f64, Error>| {
        let clock = Instant::now();
        for (number, height) in heights.iter().enumerate().take(COMPARED) {
            assert_eq!(begin(number)?, *height, "episode {number}");
        }
        let each = clock.elapsed().as_secs_f64() / COMPARED.min(episodes) as f64;
        println!("{what:25} {:7.2}", 1e3 * each);
        Ok::<(), Error>(())
    };
    compare("the restored checkpoint", &mut |number| {
        rings[0].restore(&settled)?;
        episode(&mut rings[0], seed, number)
    })?;
    compare("a fork", &mut |number| episode(&mut ring.fork()?, seed, number))?;
    compare("a new start", &mut |number| episode(&mut start(&scene, &settings)?, seed, number))?;
    println!("written to {}", out.join("episodes/heights.svg").display());
    Ok(())
}

fn main() {
    finish(run(&Arguments::parse()));
}
