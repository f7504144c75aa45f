//! One table: what the parts of a step cost on meshes of all sizes, and what a step costs as a whole.
//!
//! The clamped beam of 35 x 2 cm, undamped and with lumped inertia for central differences. Times are the
//! least of some repetitions, in nanoseconds per state (two states per displacement component), so
//! that a row that stays the same grows in proportion to the mesh.

use std::time::Instant;

use pliant::samples::ClampedBeam;
use pliant::{Error, Inertia, InputError, Method, Sampling, Scene, Settings};

/// Cells along the beam; a seventeenth of it across.
const CELLS: [usize; 6] = [34, 68, 136, 272, 544, 1088];
const REPETITIONS: usize = 5;

fn scene(cells: usize, inertia: Inertia, until: f64) -> Result<Scene, InputError> {
    ClampedBeam { nodes: [cells + 1, cells / 17 + 1], inertia, until, ..ClampedBeam::default() }
        .scene()
}

/// Least time of a call (s), of some repetitions of as many calls as take a millisecond.
fn time(mut call: impl FnMut()) -> f64 {
    let clock = Instant::now();
    call();
    let calls = (1e-3 / clock.elapsed().as_secs_f64()).ceil().clamp(1.0, 1e4);
    let repetition = |_| {
        let clock = Instant::now();
        (0..calls as usize).for_each(|_| call());
        clock.elapsed().as_secs_f64() / calls
    };
    (0..REPETITIONS).map(repetition).fold(f64::INFINITY, f64::min)
}

/// Seconds for the parts of a step: forces, tangents, factorization, solution.
fn parts(cells: usize) -> Result<(usize, [f64; 4]), Box<dyn std::error::Error>> {
    let scene = scene(cells, Inertia::Consistent, 1.0)?;
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
    Ok((2 * n, [forces, tangents, factorization, solution]))
}

/// Seconds per step of a whole run, the start left out as far as a run of half the length tells it.
fn step(cells: usize, method: Method, rtol: f64, until: f64) -> Result<f64, Error> {
    let inertia = match method {
        Method::CentralDifference => Inertia::Lumped,
        _ => Inertia::Consistent,
    };
    // no vibration is damped: order 2 for BDF
    let max_order = (method == Method::CvodeBdf).then_some(2);
    let settings = Settings { method, rtol, max_order, ..Settings::default() };
    let run = |until: f64| -> Result<(f64, f64), Error> {
        let scene = scene(cells, inertia, until)?;
        let clock = Instant::now();
        let steps = scene.simulate(&settings, &Sampling::phase_ends())?.report().steps();
        Ok((clock.elapsed().as_secs_f64(), steps as f64))
    };
    let (half, whole) = (run(0.5 * until)?, run(until)?);
    Ok((whole.0 - half.0) / (whole.1 - half.1))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names = ["forces", "tangents", "factorization", "solution"];
    let steps = [
        (Method::Arkode, 1e-4, 0.4),
        (Method::CvodeBdf, 1e-4, 0.4),
        (Method::CentralDifference, 1e-4, 0.02),
    ];
    let mut rows: Vec<(String, Vec<f64>)> = names.map(|name| (name.to_string(), Vec::new())).into();
    rows.extend(steps.map(|(method, ..)| (format!("step, {method}"), Vec::new())));
    let mut header = String::from("| ns per state |");
    for cells in CELLS {
        let (states, parts) = parts(cells)?;
        header += &format!(" {states} states |");
        let per_state = |seconds: f64| 1e9 * seconds / states as f64;
        for (row, seconds) in rows.iter_mut().zip(parts) {
            row.1.push(per_state(seconds));
        }
        for (row, (method, rtol, until)) in rows[names.len()..].iter_mut().zip(steps) {
            row.1.push(per_state(step(cells, method, rtol, until)?));
        }
    }
    println!("{header}\n|{}", " --- |".repeat(CELLS.len() + 1));
    for (name, numbers) in rows {
        let numbers: String = numbers.iter().map(|x| format!(" {x:.1} |")).collect();
        println!("| {name} |{numbers}");
    }
    Ok(())
}
