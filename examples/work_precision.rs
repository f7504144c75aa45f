//! Speed against accuracy: every method on a scene of the documents, tolerance by tolerance.
//!
//! `cargo run --release --example work_precision -- square-jump`
use clap::Parser;
use pliant::{Error, Method, Sampling, Scene, Solver, samples};
use std::time::Instant;

#[derive(Parser)]
struct Arguments {
    #[arg(default_value = "beam-jump")]
    scene: String,
    #[arg(long, default_value_t = 3)]
    repeats: usize,
    /// most steps of a run
    #[arg(long, default_value_t = 300_000)]
    max_steps: usize,
    /// tightest tolerance 10^-N
    #[arg(long, default_value_t = 8)]
    tightest: i32,
    /// tolerance of the references
    #[arg(long, default_value_t = 1e-10)]
    reference: f64,
}

fn scene(name: &str) -> Result<Scene, Error> {
    use samples::*;
    match name {
        "beam-jump" => beam_jump(),
        "square-press" => square_press(4),
        "square-jump" => square_jump(4),
        "square-jump-10" => square_jump(10),
        "membrane" => membrane(),
        "membrane-arch" => membrane_arch(),
        "beam-bend" => beam_bend(pliant::Strain::Green, false),
        "beam-bend-cauchy" => beam_bend(pliant::Strain::Cauchy, false),
        "ring-roll" => RingRoll::default().scene(),
        "ring-springs" => ring_springs(1.0),
        "ring-jump" => ring_jump(),
        "report-8" => report_8(),
        "clamped-beam" => clamped_beam([36, 3], 0.0),
        "clamped-beam-damped" => clamped_beam([36, 3], 4000.0),
        _ => panic!("unknown scene {name}"),
    }
}

fn rms(x: impl Iterator<Item = f64>) -> f64 {
    let (s, n) = x.fold((0.0, 0), |(s, n), x| (s + x * x, n + 1));
    (s / n as f64).sqrt()
}

fn main() -> Result<(), Error> {
    let a = Arguments::parse();
    let scene = scene(&a.scene)?;
    let sampling = Sampling::every(scene.end() / 100.0);
    let run = |solver: &Solver| {
        scene
            .simulate(solver, &sampling)
            .map(|t| t.samples().iter().flat_map(|s| s.u.clone()).collect::<Vec<f64>>())
    };
    let mut references = Vec::new();
    for method in [Method::CvodeAdams, Method::Rk, Method::CvodeBdf] {
        if references.len() == 2 {
            break;
        }
        let clock = Instant::now();
        let solver =
            Solver { method, rtol: a.reference, max_steps: 2_000_000, ..Solver::default() };
        match run(&solver) {
            Ok(u) => {
                println!("reference {method}: {:.1} s", clock.elapsed().as_secs_f64());
                references.push(u)
            }
            Err(error) => println!("reference {method}: {error}"),
        }
    }
    let reference = &references[0];
    let scale = rms(reference.iter().copied());
    let error = |u: &[f64]| rms(u.iter().zip(reference).map(|(a, b)| a - b)) / scale;
    println!("references agree to {:.1e} of {scale:.3e} m", error(&references[1]));
    println!(
        "{:14} {:>5} {:>6} {:>9} {:>9} {:>8} {:>9} {:>8} {:>9}",
        "method", "order", "rtol", "error", "time (s)", "steps", "evals", "facts", "energy"
    );
    for exponent in 2..=a.tightest {
        let rtol = 10f64.powi(-exponent);
        for method in Method::ALL {
            let caps: &[Option<u32>] =
                if method == Method::CvodeBdf { &[Some(2), None] } else { &[None] };
            for &max_order in caps {
                let solver =
                    Solver { method, rtol, max_order, max_steps: a.max_steps, ..Solver::default() };
                let order = max_order.map_or("-".to_owned(), |o| o.to_string());
                print!("{:14} {order:>5} {rtol:6.0e} ", method);
                match scene.simulate(&solver, &sampling) {
                    Err(e) => println!("{}", e.to_string().chars().take(150).collect::<String>()),
                    Ok(t) => {
                        let u: Vec<f64> = t.samples().iter().flat_map(|s| s.u.clone()).collect();
                        let mut times: Vec<f64> = (0..a.repeats)
                            .map(|_| {
                                scene
                                    .simulate(&solver, &Sampling::phase_ends())
                                    .unwrap()
                                    .report()
                                    .wall_seconds()
                            })
                            .collect();
                        times.sort_by(f64::total_cmp);
                        let r = t.report();
                        println!(
                            "{:9.1e} {:9.4} {:8} {:9} {:8} {:9.1e}",
                            error(&u),
                            times[times.len() / 2],
                            r.steps(),
                            r.evaluations(),
                            r.factorizations(),
                            r.energy_error / r.energy_scale
                        );
                    }
                }
            }
        }
    }
    Ok(())
}
