//! Benchmarks of rubber in large motion, on meshes and by methods that get finer: which digits agree.
//!
//! ```sh
//! cargo run --release --example rubber -- cantilever   # or column, nearly-incompressible-column, block
//! ```
//!
//! The output is in docs/benchmarks.md.

use std::error::Error;
use std::time::Instant;

use clap::{Parser, ValueEnum};
use pliant::samples::{LoadedCantilever, TumblingBlock, TwistingColumn};
use pliant::{Dilatation, Method, Sampling, Scene, Settings, SolidCells, Trajectory};

/// Benchmarks of rubber in large motion, on meshes and by methods that get finer
#[derive(Parser)]
struct Arguments {
    /// Which one
    benchmark: Benchmark,
    /// Only rows whose words contain this
    #[arg(long, default_value = "")]
    only: String,
}

#[derive(Clone, Copy, ValueEnum)]
enum Benchmark {
    Cantilever,
    Column,
    NearlyIncompressibleColumn,
    Block,
}

/// One computation.
struct Row {
    name: String,
    scene: Scene,
    settings: Settings,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { benchmark, only } = Arguments::parse();
    let (rows, step, read): (_, _, fn(&Trajectory) -> String) = match benchmark {
        Benchmark::Cantilever => (cantilever()?, 1e-3, swing),
        Benchmark::Column => (column(0.45)?, 5e-4, twist),
        Benchmark::NearlyIncompressibleColumn => (column(0.495)?, 5e-4, twist),
        Benchmark::Block => (block()?, 0.05, flight),
    };
    for Row { name, scene, settings } in rows {
        if !name.contains(&only) {
            continue;
        }
        let start = Instant::now();
        match scene.simulate(&settings, &Sampling::every(step)) {
            Ok(motion) => println!(
                "{name} | {} | {} | {:.1e} | {:.1} s",
                scene.body().dofs(),
                read(&motion),
                motion.report().energy_error / motion.report().energy_scale,
                start.elapsed().as_secs_f64()
            ),
            Err(error) => println!("{name} | {error}"),
        }
    }
    Ok(())
}

const HEXAHEDRA: SolidCells = SolidCells::Hexahedra;
const HEXAHEDRA20: SolidCells = SolidCells::Hexahedra20;
const TETRAHEDRA10: SolidCells = SolidCells::Tetrahedra10;

fn by(method: Method, rtol: f64) -> Settings {
    Settings { method, rtol, ..Settings::default() }
}

fn row(name: String, scene: Scene, settings: Settings) -> Row {
    Row { name: format!("{name} | {} {:e}", settings.method, settings.rtol), scene, settings }
}

fn cantilever() -> Result<Vec<Row>, Box<dyn Error>> {
    let auto = |rtol| by(Method::Auto, rtol);
    let mut rows = Vec::new();
    let mut add = |cells: SolidCells, nodes, dilatation, settings: Settings| {
        let scene = LoadedCantilever { nodes, cells, dilatation, ..Default::default() }.scene()?;
        let name = format!("{} {nodes:?} {dilatation:?}", cells.name());
        rows.push(row(name, scene, settings));
        Ok::<(), Box<dyn Error>>(())
    };
    let (points, mean) = (Dilatation::AtPoints, Dilatation::Mean);
    for rtol in [1e-4, 1e-5, 1e-6] {
        add(HEXAHEDRA20, [3, 3, 21], points, auto(rtol))?;
    }
    add(HEXAHEDRA20, [3, 3, 21], points, by(Method::CvodeBdf, 1e-6))?;
    add(HEXAHEDRA20, [3, 3, 21], points, by(Method::Rosenbrock, 1e-5))?;
    for nodes in [[3, 3, 11], [5, 5, 41], [7, 7, 61]] {
        add(HEXAHEDRA20, nodes, points, auto(1e-5))?;
    }
    add(TETRAHEDRA10, [3, 3, 21], points, auto(1e-5))?;
    add(TETRAHEDRA10, [5, 5, 41], points, auto(1e-5))?;
    for nodes in [[3, 3, 21], [5, 5, 41], [9, 9, 81]] {
        add(HEXAHEDRA, nodes, mean, auto(1e-5))?;
    }
    Ok(rows)
}

fn column(poisson: f64) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut add = |cells: SolidCells, nodes, settings: Settings| {
        let scene = TwistingColumn { poisson, nodes, cells, ..Default::default() }.scene()?;
        rows.push(row(format!("{} {nodes:?}", cells.name()), scene, settings));
        Ok::<(), Box<dyn Error>>(())
    };
    for rtol in [1e-4, 1e-5, 1e-6] {
        add(HEXAHEDRA20, [13, 3, 3], by(Method::Auto, rtol))?;
    }
    add(HEXAHEDRA20, [13, 3, 3], by(Method::CvodeBdf, 1e-6))?;
    add(HEXAHEDRA20, [13, 3, 3], by(Method::CvodeAdams, 1e-6))?;
    add(HEXAHEDRA20, [13, 3, 3], by(Method::Rosenbrock, 1e-5))?;
    for nodes in [[25, 5, 5], [37, 7, 7], [49, 9, 9]] {
        add(HEXAHEDRA20, nodes, by(Method::Auto, 1e-5))?;
    }
    for nodes in [[13, 3, 3], [25, 5, 5], [37, 7, 7]] {
        add(TETRAHEDRA10, nodes, by(Method::Auto, 1e-5))?;
    }
    for nodes in [[25, 5, 5], [49, 9, 9], [97, 17, 17]] {
        add(HEXAHEDRA, nodes, by(Method::Auto, 1e-5))?;
    }
    Ok(rows)
}

fn block() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut add = |cells: SolidCells, cells_per_metre, settings: Settings| {
        let scene = TumblingBlock { cells_per_metre, cells, ..Default::default() }.scene()?;
        rows.push(row(format!("{}, {cells_per_metre} a metre", cells.name()), scene, settings));
        Ok::<(), Box<dyn Error>>(())
    };
    for rtol in [1e-4, 1e-5, 1e-6] {
        add(HEXAHEDRA20, 1, by(Method::Auto, rtol))?;
    }
    add(HEXAHEDRA20, 1, by(Method::CvodeBdf, 1e-6))?;
    add(HEXAHEDRA20, 1, by(Method::CvodeAdams, 1e-6))?;
    add(HEXAHEDRA20, 2, by(Method::Auto, 1e-5))?;
    add(TETRAHEDRA10, 1, by(Method::Auto, 1e-5))?;
    add(TETRAHEDRA10, 2, by(Method::Auto, 1e-5))?;
    for cells in [1, 2, 4] {
        add(HEXAHEDRA, cells, by(Method::Auto, 1e-5))?;
    }
    Ok(rows)
}

/// The node at `place` (m).
fn node_at(motion: &Trajectory, place: [f64; 3]) -> usize {
    let nodes = motion.body().mesh().positions().chunks(3);
    let apart = |x: &[f64]| x.iter().zip(place).map(|(x, at)| (x - at).abs()).sum::<f64>();
    let (node, _) =
        nodes.map(apart).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).expect("a mesh has nodes");
    node
}

/// Displacement (m) of a node at each sample.
fn path(motion: &Trajectory, node: usize) -> impl Iterator<Item = (f64, [f64; 3])> {
    let at = move |u: &[f64]| [u[3 * node], u[3 * node + 1], u[3 * node + 2]];
    motion.samples().iter().map(move |sample| (sample.time, at(&sample.u)))
}

/// The largest value and when it is, by the parabola through the three highest samples.
fn peak(values: &[(f64, f64)]) -> [f64; 2] {
    let largest = (0..values.len()).max_by(|&a, &b| values[a].1.total_cmp(&values[b].1));
    let k = largest.unwrap_or(0).clamp(1, values.len() - 2);
    let [(before, a), (time, b), (_, c)] = [values[k - 1], values[k], values[k + 1]];
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    let part = -slope / bend;
    [time + part * (time - before), b + 0.5 * slope * part]
}

/// The first peak of the displacement of the middle of the loaded end, and when it is back.
fn swing(motion: &Trajectory) -> String {
    let node = node_at(motion, [0.1, 0.1, 2.0]);
    let lengths: Vec<(f64, f64)> =
        path(motion, node).map(|(t, u)| (t, u.iter().map(|u| u * u).sum::<f64>().sqrt())).collect();
    let [at, length] = peak(&lengths);
    let late = lengths.iter().filter(|(t, _)| *t > 0.5).map(|&(t, u)| (t, -u));
    let [back, _] = peak(&late.collect::<Vec<_>>());
    let (_, end) = path(motion, node).last().expect("there is a last sample");
    format!("{length:.5} m at {at:.5} s, back at {back:.5} s, at the end {end:.4?}")
}

/// Turn (rad) of an edge of the free end about the axis, and length of the column, at some times and at their peaks.
fn twist(motion: &Trajectory) -> String {
    let [edge, middle] = [[6.0, 0.5, 0.5], [6.0, 0.0, 0.0]].map(|x| node_at(motion, x));
    let (mut turn, mut last) = (0.0, std::f64::consts::FRAC_PI_4);
    let turns: Vec<(f64, f64)> = path(motion, edge)
        .map(|(t, [_, y, z])| {
            let angle = (0.5 + z).atan2(0.5 + y);
            let step = angle - last;
            turn += step - std::f64::consts::TAU * (step / std::f64::consts::TAU).round();
            last = angle;
            (t, turn)
        })
        .collect();
    let lengths: Vec<(f64, f64)> = path(motion, middle).map(|(t, [x, ..])| (t, x)).collect();
    let at = |values: &[(f64, f64)], time: f64| {
        let found = values.iter().find(|(t, _)| (t - time).abs() < 1e-9);
        found.map_or(f64::NAN, |(_, value)| *value)
    };
    let [when, most] = peak(&turns);
    let times = [0.05, 0.1, 0.15, 0.2];
    let turned = times.map(|t| at(&turns, t));
    let longer = times.map(|t| at(&lengths, t));
    format!("most {most:.5} at {when:.6} s; turn {turned:.5?}; {longer:.5?} m")
}

/// Momenta that come and go after the load, angular momentum, and where an edge is.
fn flight(motion: &Trajectory) -> String {
    let node = node_at(motion, [0.0, 10.0, 0.0]);
    let after: Vec<_> = motion.samples().iter().filter(|sample| sample.time >= 5.0).collect();
    let spin = motion.angular_momentum(after[0]);
    let length = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let drift = after.iter().map(|sample| {
        let now = motion.angular_momentum(sample);
        length(&now.iter().zip(&spin).map(|(a, b)| a - b).collect::<Vec<_>>())
    });
    let drift = drift.fold(0.0, f64::max) / length(&spin);
    let pushed = motion.samples().iter().map(|sample| length(&motion.momentum(sample)));
    let pushed = pushed.fold(0.0, f64::max);
    let energies = after.iter().map(|s| s.energy.kinetic + s.energy.strain).collect::<Vec<_>>();
    let swings = energies.iter().map(|e| (e / energies[0] - 1.0).abs()).fold(0.0, f64::max);
    let places: Vec<_> = path(motion, node)
        .filter(|(t, _)| [5.0, 10.0, 20.0].contains(t))
        .map(|(_, u)| format!("{u:.4?}"))
        .collect();
    format!(
        "L = {spin:.4?} Nms, its drift {drift:.0e}, momentum {pushed:.0e} Ns, energy {:.5} J, its \
         drift {swings:.0e}; {}",
        energies[0],
        places.join(" ")
    )
}
