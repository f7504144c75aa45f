//! Cost of the features of a scene, in instructions per step: a bare body, and the same with one feature more each time.
//!
//! `cargo bench --bench pay`; it needs valgrind. Instructions are counted by callgrind, in a run and in one of twice the length,
//! and their difference is divided by that of the steps: what happens once is left out. They are counted again at every
//! run to a few in a million, whatever else the machine does.
//!
//! What to look for: the bare body spends nothing in forces from outside, constraints, contact or friction (the last
//! columns), and what is never met costs little.

use std::error::Error;
use std::ops::ControlFlow;
use std::process::Command;

use pliant::{
    Body, Cells, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings, Strain,
};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Cells along and across the body.
const CELLS: [usize; 2] = [30, 6];
/// Steps of the shorter run.
const STEPS: usize = 300;
/// Rooms of the library whose instructions are listed by themselves.
const ROOMS: [&str; 2] = ["pliant::scene::forces", "pliant::scene::constraint"];

/// Feature that is added to the bare scene.
type More = fn(Soft) -> Soft;

const SCENES: [(&str, More); 10] = [
    ("bare", |soft| soft),
    ("viscosity", |soft| Soft { viscosity: 10.0, ..soft }),
    ("Green strain", |soft| Soft { strain: Strain::Green, ..soft }),
    ("gravity", |soft| soft.scene(|scene| scene.gravity([0.0, -9.8]))),
    ("an obstacle never met", |soft| soft.scene(|scene| scene.obstacle(floor(-9.0)))),
    ("an obstacle it lies on", |soft| soft.scene(|scene| scene.obstacle(floor(0.0)))),
    ("... with friction", |soft| {
        soft.scene(|scene| scene.obstacle(floor(0.0).friction_coefficient(0.3)))
    }),
    ("a side held", |soft| soft.phase(|phase| phase.hold("left"))),
    ("a side pushed", |soft| {
        soft.phase(|phase| phase.load_with("right", |t| [(100.0 * t).sin(), 0.0]))
    }),
    ("pressure on a side", |soft| soft.phase(|phase| phase.pressure_on("right", 100.0))),
];

/// A bar of rubber that swings along itself.
struct Soft {
    viscosity: f64,
    strain: Strain,
    scene: fn(Scene) -> Scene,
    phase: fn(Phase) -> Phase,
}

impl Soft {
    fn scene(self, scene: fn(Scene) -> Scene) -> Self {
        Self { scene, ..self }
    }

    fn phase(self, phase: fn(Phase) -> Phase) -> Self {
        Self { phase, ..self }
    }

    fn build(&self) -> Result<Scene, pliant::Error> {
        let nodes = CELLS.map(|cells| cells + 1);
        let mesh = Mesh::rectangle([0.1, 0.02], nodes, Cells::Triangles)?;
        let viscosity = self.viscosity;
        let material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity };
        let body = Body::new(mesh, material).thickness(0.01).strain(self.strain).build()?;
        let scene = Scene::new(body).initial_velocity(|x| vec![x[0] - 0.05, 0.0]);
        Ok((self.scene)(scene).phase((self.phase)(Phase::until(1e3))))
    }
}

fn floor(height: f64) -> Obstacle {
    Obstacle::half_plane([0.0, height], [0.0, 1.0]).stiffness(100.0)
}

/// Takes so many steps.
fn run(number: usize, method: Method, steps: usize) -> Outcome<()> {
    let bare =
        Soft { viscosity: 0.0, strain: Strain::Cauchy, scene: |scene| scene, phase: |phase| phase };
    let scene = SCENES[number].1(bare).build()?;
    let settings = Settings { method, ..Settings::default() };
    let mut taken = 0;
    let stopped = scene.simulate_with(&settings, &Sampling::phase_ends(), |_| {
        taken += 1;
        if taken < steps { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    match stopped {
        Err(pliant::Error::Integration(failure)) if failure.is_interruption() => Ok(()),
        Err(error) => Err(error.into()),
        Ok(_) => Err("the scene has ended".into()),
    }
}

/// Instructions in all, and in each of the rooms.
fn count(number: usize, method: Method, steps: usize) -> Outcome<[f64; 3]> {
    let directory = tempfile::tempdir()?;
    let profile = directory.path().join("callgrind");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--compress-strings=no", "--compress-pos=no"])
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(std::env::current_exe()?)
        .args(["--run", &number.to_string(), method.name(), &steps.to_string()])
        .output()
        .map_err(|error| format!("valgrind: {error}: install it (scripts/setup.sh valgrind)"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let mut sums = [0.0; 3];
    let (mut function, mut is_of_callee) = (String::new(), false);
    for line in std::fs::read_to_string(&profile)?.lines() {
        if let Some(name) = line.strip_prefix("fn=") {
            function = name.into();
        } else if line.starts_with("calls=") {
            is_of_callee = true;
        } else if line.starts_with(|first: char| first.is_ascii_digit()) {
            // place and cost; what callees cost stands with them, too
            let cost: f64 = line.split_whitespace().nth(1).unwrap_or("0").parse()?;
            if !std::mem::take(&mut is_of_callee) {
                sums[0] += cost;
                let room = ROOMS.iter().position(|room| function.contains(room));
                room.into_iter().for_each(|room| sums[1 + room] += cost);
            }
        }
    }
    Ok(sums)
}

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, number, method, steps] = &arguments[..]
        && flag == "--run"
    {
        return run(number.parse()?, method.parse()?, steps.parse()?);
    }
    for method in [Method::Rk, Method::CvodeBdf] {
        println!("\n{method}: instructions per step, {} cells", 2 * CELLS[0] * CELLS[1]);
        print!("{:24} {:>10} {:>8}", "", "all", "of bare");
        ROOMS.iter().for_each(|room| print!(" {room:>20}"));
        println!();
        let mut bare = f64::NAN;
        for (number, (name, _)) in SCENES.iter().enumerate() {
            let [short, long] = [STEPS, 2 * STEPS].map(|steps| count(number, method, steps));
            let (short, long) = (short?, long?);
            let of_step: Vec<f64> =
                long.iter().zip(short).map(|(long, short)| (long - short) / STEPS as f64).collect();
            if number == 0 {
                bare = of_step[0];
            }
            print!("{name:24} {:>10.0} {:>8.3}", of_step[0], of_step[0] / bare);
            of_step[1..].iter().for_each(|room| print!(" {room:>20.0}"));
            println!();
        }
    }
    Ok(())
}
