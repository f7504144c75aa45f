//! Cost of a tick of a controller: a command every millisecond, against the same motion run freely.
//!
//! `cargo bench --bench ticks` prints for each body and method median, 99 % and worst wall time of a tick
//! (the command and the millisecond after it), and the time of all ticks as a multiple of a run under a
//! smooth signal that takes the same values. A body is faster than real time where a tick takes less than
//! 1,000 us. Two bodies are run by a reduced model, too, learned from three other signals within 2 %; rows of it have its
//! unknowns and cells, the largest distance of a component of the displacements from the full run by the same method, over all ticks and
//! relative to the largest component there, and the error that the run itself told. Then, for each body, what it costs to come back to
//! a checkpoint and to start anew.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use pliant::reduce::{Training, reduce};
use pliant::samples::{SQUARE_MATERIAL, bending_actuator, ring_springs};
use pliant::{
    Body, Cells, Chamber, Material, Mesh, Method, Phase, ReducedModel, Scene, Settings, Signal,
    Simulation, SolidCells, Strain,
};

const TICKS: u32 = 400;
const PERIOD: f64 = 1e-3;

/// A scene, from when on it is driven (s), and by what; scenes that a reduced model is learned from, or none.
struct Case {
    name: &'static str,
    scene: Scene,
    start: f64,
    drive: Drive,
    training: Vec<Scene>,
}

/// Parts of the largest value that reduced models are learned from: slower than those of the ticks, jumps, faster.
const LEARNED: [fn(f64) -> f64; 3] = [
    |t| 0.5 * (1.0 - (9.0 * t).cos()),
    |t| (t / 0.02).min(1.0) * if t < 0.2 { 1.0 } else { 0.3 },
    |t| 0.6 * (1.0 - (33.0 * t).cos()),
];

/// Driven part of the scene, and the largest value of its command (Pa, N).
#[derive(Clone, Copy)]
enum Drive {
    Pressure(&'static str, f64),
    Spring(&'static str, f64),
    /// On each of these nodes, across.
    Load(&'static str, f64),
}

/// Part of the largest value at time `t` (s).
fn part(t: f64) -> f64 {
    0.5 * (1.0 - (20.0 * t).cos())
}

/// A force across.
fn across(force: f64, dimension: usize) -> Vec<f64> {
    (0..dimension).map(|axis| if axis == 1 { force } else { 0.0 }).collect()
}

impl Drive {
    /// Commands the present value.
    fn tick(self, simulation: &mut Simulation) -> Result<(), pliant::Error> {
        let part = part(simulation.time());
        match self {
            Self::Pressure(chamber, most) => simulation.pressure(chamber, most * part),
            Self::Spring(spring, most) => simulation.actuate(spring, most * part),
            Self::Load(nodes, most) => {
                let dimension = simulation.scene().body().dimension();
                simulation.load(nodes, across(most * part, dimension))
            }
        }
    }

    /// Commands all values at once, as a function of time.
    fn whole(self, simulation: &mut Simulation) -> Result<(), pliant::Error> {
        match self {
            Self::Pressure(chamber, most) => {
                simulation.pressure(chamber, Signal::function(move |t| most * part(t)))
            }
            Self::Spring(spring, most) => {
                simulation.actuate(spring, Signal::function(move |t| most * part(t)))
            }
            Self::Load(nodes, most) => match simulation.scene().body().dimension() {
                2 => simulation.load_with(nodes, move |t| [0.0, most * part(t)]),
                _ => simulation.load_with(nodes, move |t| [0.0, most * part(t), 0.0]),
            },
        }
    }
}

fn cases() -> Result<[Case; 4], Box<dyn Error>> {
    let square = Mesh::rectangle([0.3, 0.3], [10, 10], Cells::Triangles)?;
    let square = Scene::new(
        Body::new(square, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()?,
    );
    let mesh = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/meshes/bending-actuator.msh");
    let actuator = Scene::new(bending_actuator(Mesh::read_gmsh(mesh)?)?.body().clone())
        .chamber(Chamber::within("air", "chamber"));
    let clamped = || Phase::until(f64::from(TICKS) * PERIOD).hold("clamp");
    let blown = |part: fn(f64) -> f64| clamped().pressure_with("air", move |t| 5e3 * part(t));
    let rubber = Material { density: 1100.0, young: 5e5, poisson: 0.4, viscosity: 50.0 };
    let finger = Mesh::cuboid([0.12, 0.02, 0.02], [56, 6, 6], SolidCells::Hexahedra)?;
    let finger = Scene::new(Body::new(finger, rubber).strain(Strain::Green).build()?);
    let held = || Phase::until(f64::from(TICKS) * PERIOD).hold("left");
    let loaded =
        |part: fn(f64) -> f64| held().load_with("right", move |t| [0.0, 0.005 * part(t), 0.0]);
    Ok([
        Case {
            name: "square, 100 nodes",
            scene: square.phase(Phase::until(1.0).hold("bottom")),
            start: 0.0,
            drive: Drive::Load("top", 1.0),
            training: Vec::new(),
        },
        Case {
            name: "ring, 8 springs",
            scene: ring_springs(0.0)?,
            start: 0.2,
            drive: Drive::Spring("A2", -1.0),
            training: Vec::new(),
        },
        Case {
            name: "bending actuator",
            scene: actuator.clone().phase(clamped()),
            start: 0.0,
            drive: Drive::Pressure("air", 5e3),
            training: LEARNED.map(|part| actuator.clone().phase(blown(part))).into(),
        },
        Case {
            name: "finger, 2,016 nodes",
            scene: finger.clone().phase(held()),
            start: 0.0,
            drive: Drive::Load("right", 0.005),
            training: LEARNED.map(|part| finger.clone().phase(loaded(part))).into(),
        },
    ])
}

/// Measurements of the ticks of a scene.
struct Ticks {
    /// Wall time of each, in ascending order, and of a free run.
    each: Vec<Duration>,
    free: Duration,
    /// Displacements (m) after each.
    path: Vec<Vec<f64>>,
    /// The error that a reduced model told.
    told: Option<f64>,
}

/// The ticks of `scene`, which is that of `case` or its reduced model.
fn measure(scene: &Scene, case: &Case, method: Method) -> Result<Ticks, Box<dyn Error>> {
    let settings = Settings { method, rtol: 1e-3, ..Settings::default() };
    let Case { start, drive, .. } = case;
    let mut ticking = scene.start(&settings)?;
    ticking.advance_to(*start)?;
    let mut free = ticking.fork()?;
    let (mut each, mut path) = (Vec::new(), Vec::new());
    for tick in 1..=TICKS {
        let clock = Instant::now();
        drive.tick(&mut ticking)?;
        ticking.advance_to(start + f64::from(tick) * PERIOD)?;
        each.push(clock.elapsed());
        path.push(ticking.view().displacements().to_vec());
    }
    each.sort();
    let told = ticking.report().reduced.map(|reduced| reduced.estimated_error);
    let clock = Instant::now();
    drive.whole(&mut free)?;
    free.advance_to(start + f64::from(TICKS) * PERIOD)?;
    Ok(Ticks { each, free: clock.elapsed(), path, told })
}

/// A reduced model of the scene, learned from those to learn from.
fn learned(case: &Case) -> Result<ReducedModel, Box<dyn Error>> {
    let training = Training {
        scenes: case.training.clone(),
        held_out: Vec::new(),
        settings: Settings { rtol: 1e-4, ..Settings::default() },
        within: 0.02,
        most_unknowns: 64,
    };
    Ok(reduce(&training, &mut |_| ControlFlow::Continue(()))?.model)
}

/// The largest difference of a component of two paths, relative to the largest component of `full`.
fn difference(full: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let most = full.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let pairs = full.iter().flatten().zip(other.iter().flatten());
    pairs.fold(0.0, |most: f64, (x, other)| most.max((x - other).abs())) / most
}

/// A line of the table: of all unknowns, or of so many unknowns and cells and with the error that they make.
fn print(name: &str, method: Method, ticks: &Ticks, reduced: Option<([usize; 2], f64)>) {
    let last = ticks.each.len() - 1;
    let [median, most, worst] = [ticks.each.len() / 2, ticks.each.len() * 99 / 100, last]
        .map(|k| 1e6 * ticks.each[k].as_secs_f64());
    let whole: Duration = ticks.each.iter().sum();
    let ratio = whole.as_secs_f64() / ticks.free.as_secs_f64();
    let method = method.name();
    print!("{name:20} {method:20} {median:11.0} {most:9.0} {worst:10.0} {ratio:13.2}");
    if let (Some(([unknowns, cells], error)), Some(told)) = (reduced, ticks.told) {
        print!(" {unknowns:8} {cells:6} {:9.2} {:8.2}", 100.0 * error, 100.0 * told);
    }
    println!();
}

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:20} {:20} {:>11} {:>9} {:>10} {:>13} {:>8} {:>6} {:>9} {:>8}",
        "body",
        "method",
        "median (us)",
        "99 % (us)",
        "worst (us)",
        "to a free run",
        "unknowns",
        "cells",
        "error (%)",
        "told (%)"
    );
    for case in cases()? {
        let model = if case.training.is_empty() { None } else { Some(learned(&case)?) };
        for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
            let full = measure(&case.scene, &case, method)?;
            print(case.name, method, &full, None);
            if let Some(model) = &model {
                let counts = [model.unknowns(), model.cells()];
                let ticks = measure(&case.scene.clone().reduced(model.clone())?, &case, method)?;
                let error = difference(&full.path, &ticks.path);
                print("  by a reduced model", method, &ticks, Some((counts, error)));
            }
        }
    }
    for Case { name, scene, .. } in cases()? {
        let (start, restore) = back(&scene)?;
        println!("{name:20} to go back {restore:.1} us, to start anew {start:.0} us");
    }
    Ok(())
}

/// Least wall times (us) of a start of the scene, and of coming back to a checkpoint after a command and a step.
fn back(scene: &Scene) -> Result<(f64, f64), Box<dyn Error>> {
    let settings = Settings { method: Method::Arkode, rtol: 1e-3, ..Settings::default() };
    let (mut start, mut restore) = (f64::INFINITY, f64::INFINITY);
    let mut simulation = scene.start(&settings)?;
    simulation.advance_to(PERIOD)?;
    let kept = simulation.checkpoint();
    for _ in 0..5 {
        let clock = Instant::now();
        drop(scene.start(&settings)?);
        start = start.min(1e6 * clock.elapsed().as_secs_f64());
    }
    for _ in 0..20 {
        simulation.step()?;
        let clock = Instant::now();
        simulation.restore(&kept)?;
        restore = restore.min(1e6 * clock.elapsed().as_secs_f64());
    }
    Ok((start, restore))
}
