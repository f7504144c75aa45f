//! Cost of cells and of the parts of a step, in three tables.
//!
//! First forces and tangents of each kind of cell, in nanoseconds per cell, on meshes too small for threads. Then a step of each kind of method
//! by its parts. Then the same parts on meshes of all sizes, in nanoseconds per state (two states per displacement component), so
//! that a row that stays the same grows in proportion to the mesh.
//!
//! Steps are those of the clamped beam of 35 x 2 cm, undamped and with lumped inertia for central differences. Times are those of the processor, the
//! least of some repetitions. What has changed, the counts of `benches/counts` tell better.

use pliant::samples::ClampedBeam;
use pliant::{
    Body, Cells, Dilatation, Error, Inertia, InputError, Law, Material, Mesh, Method, Phase,
    Report, Sampling, Scene, Settings, SolidCells, Strain, Substance,
};
use rustix::time::{ClockId, clock_gettime};

/// Cells along the beam; a seventeenth of it across.
const CELLS: [usize; 6] = [34, 68, 136, 272, 544, 1088];
const REPETITIONS: usize = 5;

fn scene(cells: usize, inertia: Inertia, until: f64) -> Result<Scene, InputError> {
    ClampedBeam { nodes: [cells + 1, cells / 17 + 1], inertia, until, ..ClampedBeam::default() }
        .scene()
}

/// Processor time (s) of all threads so far: other programs are left out.
fn seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Least time of a call (s), of some repetitions of as many calls as take a millisecond.
fn time(mut call: impl FnMut()) -> f64 {
    let start = seconds();
    call();
    let calls = (1e-3 / (seconds() - start)).ceil().clamp(1.0, 1e4);
    let repetition = |_| {
        let start = seconds();
        (0..calls as usize).for_each(|_| call());
        (seconds() - start) / calls
    };
    (0..REPETITIONS).map(repetition).fold(f64::INFINITY, f64::min)
}

/// Seconds for what a step consists of.
struct Parts {
    forces: f64,
    tangents: f64,
    factorization: f64,
    solution: f64,
}

impl Parts {
    fn of(scene: &Scene) -> Result<Self, InputError> {
        let n = scene.body().dofs();
        let small = |scale: f64| -> Vec<f64> { (0..n).map(|i| scale * (i as f64).sin()).collect() };
        let (u, v, mut f) = (small(1e-7), small(1e-3), vec![0.0; n]);
        let mut equations = scene.equations(0, &vec![0.0; n])?;
        let forces = time(|| drop(equations.forces(0.0, &u, &v, &mut f)));
        let tangents = time(|| {
            equations.tangents(0.0, &u, &v);
        });
        let factorization = time(|| drop(equations.factorize(1e-3)));
        let (mut ru, mut rv) = (u.clone(), v.clone());
        let solution = time(|| {
            ru.copy_from_slice(&u);
            rv.copy_from_slice(&v);
            equations.solve(&mut ru, &mut rv);
        });
        Ok(Self { forces, tangents, factorization, solution })
    }
}

/// A run: seconds per step, evaluations, tangents and factorizations per step, the start left out as far as a run of half
/// the length tells it.
fn run(cells: usize, method: Method, until: f64) -> Result<[f64; 4], Error> {
    // no vibration is damped: order 2 for BDF
    let max_order = (method == Method::CvodeBdf).then_some(2);
    let settings = Settings { method, rtol: 1e-4, max_order, ..Settings::default() };
    let run = |until: f64| -> Result<(f64, Report), Error> {
        let scene = scene(cells, inertia(method), until)?;
        let start = seconds();
        let trajectory = scene.simulate(&settings, &Sampling::phase_ends())?;
        Ok((seconds() - start, trajectory.report().clone()))
    };
    let (half, whole) = (run(0.5 * until)?, run(until)?);
    let more = |count: fn(&Report) -> usize| (count(&whole.1) - count(&half.1)) as f64;
    let steps = more(Report::steps);
    let counts = [Report::evaluations, Report::jacobian_evaluations, Report::factorizations];
    let [evaluations, tangents, factorizations] = counts.map(|count| more(count) / steps);
    Ok([(whole.0 - half.0) / steps, evaluations, tangents, factorizations])
}

fn inertia(method: Method) -> Inertia {
    match method {
        Method::CentralDifference => Inertia::Lumped,
        _ => Inertia::Consistent,
    }
}

/// A mesh of each kind of cells.
fn meshes() -> Result<Vec<(String, Mesh)>, InputError> {
    let mut meshes = vec![("segments".into(), Mesh::bar(0.1, 1025)?)];
    for cells in Cells::ALL {
        meshes.push((cells.name().into(), Mesh::rectangle([0.2, 0.1], [33, 17], cells)?));
    }
    for cells in SolidCells::ALL {
        meshes.push((cells.name().into(), Mesh::cuboid([0.1; 3], [8; 3], cells)?));
    }
    let triangles = Mesh::rectangle([0.2, 0.1], [33, 17], Cells::Triangles6)?;
    let tetrahedra = Mesh::cuboid([0.1; 3], [8; 3], SolidCells::Tetrahedra10)?;
    for mesh in [triangles.with_bubbles()?, tetrahedra.with_bubbles()?] {
        meshes.push((mesh.kind().word().into(), mesh));
    }
    Ok(meshes)
}

/// Forces and tangents, kind by kind: of linear bodies, and of rubber, at points and with what keeps it from locking.
fn kinds() -> Result<(), Error> {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    let rubber = Material { poisson: 0.49, ..soft }.law(Law::NeoHookean);
    let bodies = [
        ("linear", Strain::Cauchy, Dilatation::AtPoints, Substance::from(soft)),
        ("rubber, at points", Strain::Green, Dilatation::AtPoints, rubber.clone()),
        ("rubber, mean", Strain::Green, Dilatation::Mean, rubber.clone()),
        ("rubber, linear", Strain::Green, Dilatation::Linear, rubber),
    ];
    println!(
        "| ns per cell: forces, tangents | cells |{}",
        bodies.clone().map(|body| format!(" {} |", body.0)).concat()
    );
    println!("|{}", " --- |".repeat(2 + bodies.len()));
    for (name, mesh) in meshes()? {
        let cells = mesh.cells().count();
        print!("| {name} | {cells} |");
        for (_, strain, dilatation, substance) in bodies.clone() {
            let body = Body::new(mesh.clone(), substance).strain(strain).dilatation(dilatation);
            let body = match mesh.dimension() {
                1 => body.area(1e-4),
                2 => body.thickness(0.01),
                _ => body,
            };
            // not all cells have all dilatations
            let Ok(body) = body.build() else {
                print!(" |");
                continue;
            };
            let scene = Scene::new(body).phase(Phase::until(1.0));
            let Parts { forces, tangents, .. } = Parts::of(&scene)?;
            let [forces, tangents] = [forces, tangents].map(|seconds| 1e9 * seconds / cells as f64);
            print!(" {forces:.0}, {tangents:.0} |");
        }
        println!();
    }
    println!();
    Ok(())
}

/// A step by its parts: their times, times their numbers. What is left over is the integrator's own, with
/// the energies.
fn steps() -> Result<(), Error> {
    const CELLS: usize = 68;
    println!(
        "| us per step, {CELLS} x {} cells | forces | tangents | factorizations | solutions | the rest | all | a sample |\n|{}",
        CELLS / 17,
        " --- |".repeat(8)
    );
    for (method, until) in METHODS {
        let scene = scene(CELLS, inertia(method), until)?;
        let parts = Parts::of(&scene)?;
        let mut simulation = scene.start(&Settings { method, ..Settings::default() })?;
        simulation.step()?;
        let sample = time(|| drop(simulation.sample()));
        let [all, evaluations, tangents, factorizations] = run(CELLS, method, until)?;
        // Newton's method solves once per evaluation
        let solutions = if factorizations > 0.0 { evaluations } else { 0.0 };
        let parts = [
            parts.forces * evaluations,
            parts.tangents * tangents,
            parts.factorization * factorizations,
            parts.solution * solutions,
        ];
        let rest = all - parts.iter().sum::<f64>();
        let numbers = parts.into_iter().chain([rest, all, sample]);
        let numbers: String = numbers.map(|x| format!(" {:.1} |", 1e6 * x)).collect();
        println!("| {method} |{numbers}");
    }
    println!();
    Ok(())
}

/// Methods, and how long (s) they are looked at.
const METHODS: [(Method, f64); 3] =
    [(Method::Arkode, 0.4), (Method::CvodeBdf, 0.4), (Method::CentralDifference, 0.02)];

/// Parts and steps on meshes of all sizes.
fn sizes() -> Result<(), Error> {
    let names = ["forces", "tangents", "factorization", "solution"];
    let mut rows: Vec<(String, Vec<f64>)> = names.map(|name| (name.to_string(), Vec::new())).into();
    rows.extend(METHODS.map(|(method, ..)| (format!("step, {method}"), Vec::new())));
    let mut header = String::from("| ns per state |");
    for cells in CELLS {
        let scene = scene(cells, Inertia::Consistent, 1.0)?;
        let states = 2 * scene.body().dofs();
        header += &format!(" {states} states |");
        let Parts { forces, tangents, factorization, solution } = Parts::of(&scene)?;
        let mut seconds = vec![forces, tangents, factorization, solution];
        for (method, until) in METHODS {
            seconds.push(run(cells, method, until)?[0]);
        }
        for (row, seconds) in rows.iter_mut().zip(seconds) {
            row.1.push(1e9 * seconds / states as f64);
        }
    }
    println!("{header}\n|{}", " --- |".repeat(CELLS.len() + 1));
    for (name, numbers) in rows {
        let numbers: String = numbers.iter().map(|x| format!(" {x:.1} |")).collect();
        println!("| {name} |{numbers}");
    }
    println!();
    Ok(())
}

fn main() -> Result<(), Error> {
    kinds()?;
    steps()?;
    sizes()
}
