//! What a tick of a controller costs: a command every millisecond, against the same motion run freely.
//!
//! `cargo bench --bench ticks` prints for each body and method median, 99 % and worst wall time of a tick
//! (the command and the millisecond after it), and the time of all ticks as a multiple of a run under a
//! smooth signal that takes the same values. A body is faster than real time where a tick takes less than
//! 1,000 us. Then, for each body, what it costs to come back to a checkpoint and to start anew.

use std::error::Error;
use std::time::{Duration, Instant};

use pliant::samples::{SQUARE_MATERIAL, bending_actuator, ring_springs};
use pliant::{
    Body, Cells, Material, Mesh, Method, Phase, Scene, Settings, Signal, Simulation, SolidCells,
    Strain,
};

const TICKS: u32 = 400;
const PERIOD: f64 = 1e-3;

/// A scene, from when on it is driven (s), and by what.
struct Case {
    name: &'static str,
    scene: Scene,
    start: f64,
    drive: Drive,
}

/// What is driven, and how much at most (Pa, N).
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
    let rubber = Material { density: 1100.0, young: 5e5, poisson: 0.4, viscosity: 50.0 };
    let finger = Mesh::cuboid([0.12, 0.02, 0.02], [56, 6, 6], SolidCells::Hexahedra)?;
    let finger = Scene::new(Body::new(finger, rubber).strain(Strain::Green).build()?);
    Ok([
        Case {
            name: "square, 100 nodes",
            scene: square.phase(Phase::until(1.0).hold("bottom")),
            start: 0.0,
            drive: Drive::Load("top", 1.0),
        },
        Case {
            name: "ring, 8 springs",
            scene: ring_springs(0.0)?,
            start: 0.2,
            drive: Drive::Spring("A2", -1.0),
        },
        Case {
            name: "bending actuator",
            scene: bending_actuator(Mesh::read_gmsh(mesh)?)?,
            start: 0.0,
            drive: Drive::Pressure("air", 5e3),
        },
        Case {
            name: "finger, 2,016 nodes",
            scene: finger.phase(Phase::until(1.0).hold("left")),
            start: 0.0,
            drive: Drive::Load("right", 0.005),
        },
    ])
}

/// Wall time of each tick, and of a free run.
fn measure(case: &Case, method: Method) -> Result<(Vec<Duration>, Duration), Box<dyn Error>> {
    let settings = Settings { method, rtol: 1e-3, ..Settings::default() };
    let Case { scene, start, drive, .. } = case;
    let mut ticking = scene.start(&settings)?;
    ticking.advance_to(*start)?;
    let mut free = ticking.fork()?;
    let mut ticks = Vec::new();
    for tick in 1..=TICKS {
        let clock = Instant::now();
        drive.tick(&mut ticking)?;
        ticking.advance_to(start + f64::from(tick) * PERIOD)?;
        ticks.push(clock.elapsed());
    }
    let clock = Instant::now();
    drive.whole(&mut free)?;
    free.advance_to(start + f64::from(TICKS) * PERIOD)?;
    Ok((ticks, clock.elapsed()))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "{:20} {:20} {:>11} {:>9} {:>10} {:>13}",
        "body", "method", "median (us)", "99 % (us)", "worst (us)", "to a free run"
    );
    for case in cases()? {
        for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
            let (mut ticks, free) = measure(&case, method)?;
            let whole: Duration = ticks.iter().sum();
            ticks.sort();
            let [median, most, worst] = [ticks.len() / 2, ticks.len() * 99 / 100, ticks.len() - 1]
                .map(|k| 1e6 * ticks[k].as_secs_f64());
            println!(
                "{:20} {:20} {median:11.0} {most:9.0} {worst:10.0} {:13.2}",
                case.name,
                method.name(),
                whole.as_secs_f64() / free.as_secs_f64()
            );
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
