//! Random throws of two and three bodies at each other: does any pass through another?
//!
//! `cargo run --release --example throws -- --count 1000`
//!
//! What to look for: no throw ends with an overlap, however fast it is (up to a third of the speed of waves in the
//! bodies, a step of the integrator leads farther than the contact distance); momentum is kept to round-off. The springs
//! in place of the barrier let fast bodies through: `--spring`.

mod common;

use clap::Parser;
use common::finish;
use pliant::{
    Body, Cells, Error, Law, Material, Mesh, Phase, Sampling, Scene, Settings, Touch, Trajectory,
};

/// A table of throws by their speed.
#[derive(Parser)]
struct Arguments {
    /// Number of throws
    #[arg(long, default_value_t = 100)]
    count: usize,
    /// Springs in place of the barrier
    #[arg(long)]
    spring: bool,
    /// Relative tolerance
    #[arg(long, default_value_t = 1e-3)]
    rtol: f64,
}

fn main() {
    finish(run(&Arguments::parse()));
}

/// Speeds (m/s) up to which throws are counted together; waves run at 10 m/s.
const SPEEDS: [f64; 3] = [0.3, 1.0, 3.0];

#[derive(Default)]
struct Row {
    throws: usize,
    met: usize,
    overlaps: usize,
    failed: usize,
    steps: usize,
    changes: usize,
    least_gap: f64,
    momentum: f64,
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let mut rows: [Row; 3] = std::array::from_fn(|_| Row { least_gap: 1.0, ..Row::default() });
    for number in 0..arguments.count {
        let kind = number % SPEEDS.len();
        let (scene, distance) = throw(number, SPEEDS[kind], arguments.spring)?;
        let sampling = Sampling::every(scene.end() / 20.0)
            .read("gap", pliant::simulate::Reading::gap("touch"));
        let settings = Settings { rtol: arguments.rtol, ..Settings::default() };
        let row = &mut rows[kind];
        row.throws += 1;
        let motion = match scene.simulate(&settings, &sampling) {
            Ok(motion) => motion,
            Err(error) => {
                eprintln!("throw {number}: {error}");
                row.failed += 1;
                continue;
            }
        };
        let gaps = motion.samples().iter().map(|sample| sample.sensors[0] / distance);
        let gap = gaps.fold(1.0, f64::min);
        row.met += usize::from(gap < 1.0);
        row.least_gap = row.least_gap.min(gap);
        let overlaps = motion.indicators().iter().any(|of| of.name == "overlap" && of.value > 0.0);
        if overlaps {
            eprintln!("throw {number}: {:?}", motion.report().warnings());
        }
        row.overlaps += usize::from(overlaps);
        row.steps += motion.report().steps();
        row.changes +=
            motion.report().phases.iter().map(|phase| phase.counts.pattern_changes).sum::<usize>();
        row.momentum = row.momentum.max(momentum_lost(&motion));
    }
    println!(
        "{:>14} {:>7} {:>5} {:>9} {:>7} {:>7} {:>9} {:>10} {:>14}",
        "speed (m/s)",
        "throws",
        "met",
        "overlaps",
        "failed",
        "steps",
        "patterns",
        "least gap",
        "momentum lost"
    );
    for (row, speed) in rows.iter().zip(SPEEDS) {
        let each = |count: usize| count as f64 / row.throws.max(1) as f64;
        println!(
            "{:>14} {:>7} {:>5} {:>9} {:>7} {:>7.0} {:>9.1} {:>8.4} D {:>14.1e}",
            format!("up to {speed}"),
            row.throws,
            row.met,
            row.overlaps,
            row.failed,
            each(row.steps),
            each(row.changes),
            row.least_gap,
            row.momentum
        );
    }
    Ok(())
}

/// The largest change of the momentum of all bodies, over that of one of them at the start.
fn momentum_lost(motion: &Trajectory) -> f64 {
    let body = motion.body();
    let masses = body.nodal_masses();
    let sum = |v: &[f64], axis: usize| -> f64 {
        masses.iter().zip(v.chunks_exact(2)).map(|(mass, v)| mass * v[axis]).sum()
    };
    let samples = motion.samples();
    let first = &samples[0].v;
    let size: f64 =
        masses.iter().zip(first.chunks_exact(2)).map(|(mass, v)| mass * v[0].hypot(v[1])).sum();
    let lost =
        |v: &[f64]| (0..2).map(|axis| (sum(v, axis) - sum(first, axis)).abs()).fold(0.0, f64::max);
    samples.iter().map(|sample| lost(&sample.v)).fold(0.0, f64::max) / size
}

/// Two or three bodies of random shapes that fly towards each other, and the contact distance (m).
fn throw(number: usize, speed: f64, spring: bool) -> Result<(Scene, f64), Error> {
    let mut state = number as u64;
    let mut random = |from: f64, to: f64| {
        // splitmix64
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        from + (to - from) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let count = 2 + number / 3 % 2;
    let (mut bodies, mut throws) = (Vec::new(), Vec::new());
    for k in 0..count {
        let around = std::f64::consts::TAU * (k as f64 + random(-0.1, 0.1)) / count as f64;
        let away = random(0.12, 0.16);
        let centre = [away * around.cos(), away * around.sin()];
        let turn = random(0.0, std::f64::consts::TAU);
        let mesh = match random(0.0, 3.0) as usize {
            0 => Mesh::rectangle([0.08, 0.01], [9, 2], Cells::Rectangles)?,
            1 => Mesh::rectangle([0.05, 0.04], [4, 4], Cells::Triangles)?,
            _ => Mesh::ring(0.03, 0.04, [16, 2], Cells::Crossed)?.translated(&[0.03, 0.02])?,
        };
        let mesh = mesh.mapped(|x| {
            let (x, y) = (x[0] - 0.03, x[1] - 0.02);
            [
                centre[0] + x * turn.cos() - y * turn.sin(),
                centre[1] + x * turn.sin() + y * turn.cos(),
            ]
        })?;
        let young = 1e5 * random(1.0, 3.0);
        let material = Material { density: 1000.0, young, poisson: 0.3, viscosity: 0.0 };
        let body = Body::new(mesh, material.law(Law::NeoHookean)).thickness(0.01);
        bodies.push(body.named(format!("{k}")).build()?);
        let fast = speed * random(0.3, 1.0);
        throws.push((centre, [-fast * around.cos(), -fast * around.sin()]));
    }
    let distance = 5e-4;
    let touch = Touch::all().distance(distance).friction_coefficient(0.3).sticking_speed(0.02);
    let touch = if spring { touch.spring() } else { touch };
    let nearest = move |x: &[f64]| {
        let away = |(centre, _): &&([f64; 2], [f64; 2])| (x[0] - centre[0]).hypot(x[1] - centre[1]);
        let nearest = throws.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.map_or(vec![0.0; 2], |(_, velocity)| velocity.to_vec())
    };
    let scene = Scene::new(Body::join(bodies)?).touch(touch).initial_velocity(nearest);
    Ok((scene.phase(Phase::until(0.4 / speed)), distance))
}
