//! Reduced models of all sizes, with few cells and with as many as do the work of all, beside coarser meshes: error over the time of a run.
//!
//! What to look for: models to the left of a coarser mesh of the same error are the faster way. All have quadratic cells.
//!
//! ```text
//! cargo run --release --example model_sizes [-- DIRECTORY]
//! ```
//!
//! prints the tables, and writes a chart for each body to the directory (`target/model_sizes`).

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use pliant::output::Chart;
use pliant::reduce::{Training, Tried, reduce};
use pliant::{
    Body, Cells, Error, Law, Material, Mesh, Method, Phase, Sampling, Scene, Settings, SolidCells,
    Strain, Trajectory,
};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 100.0 };

/// Errors (parts of the largest displacement) that models are asked for, and one that no model has.
const WITHIN: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];
const NEVER: f64 = 1e-9;

/// A body in the plane and one in space, each with its cells along the shortest side from the coarsest to the finest.
const BODIES: [(&str, [usize; 3]); 3] =
    [("strip", [2, 4, 8]), ("strip-green", [2, 4, 8]), ("block", [1, 2, 4])];

/// A finger of 100 x 20 mm that is bent from the side at its tip, and let go; in space 20 mm wide.
fn scene(body: &str, cells: usize) -> Result<Scene, Error> {
    let along = 5 * cells + 1;
    let (law, green) = (RUBBER.law(Law::NeoHookean), Strain::Green);
    let across = cells + 1;
    let built = match body {
        "strip" => Body::new(plane(along, across)?, law).thickness(0.02).build()?,
        "strip-green" => {
            Body::new(plane(along, across)?, RUBBER).thickness(0.02).strain(green).build()?
        }
        _ => {
            let size = [0.1, 0.02, 0.02];
            Body::new(
                Mesh::cuboid(size, [along, across, across], SolidCells::Hexahedra)?.quadratic()?,
                law,
            )
            .build()?
        }
    };
    let force = if built.dimension() == 2 { vec![0.0, 0.06] } else { vec![0.0, 0.06, 0.02] };
    let let_go = Phase::until(0.8).named("let go").hold("left");
    let bent = Phase::until(0.4).named("bent").hold("left").load_total("right", force);
    Ok(Scene::new(built).phase(bent).phase(let_go))
}

fn plane(along: usize, across: usize) -> Result<Mesh, Error> {
    Ok(Mesh::rectangle([0.1, 0.02], [along, across], Cells::Rectangles)?.quadratic()?)
}

fn main() -> Result<(), Error> {
    let directory = std::env::args().nth(1).unwrap_or_else(|| "target/model_sizes".into());
    let directory = PathBuf::from(directory);
    std::fs::create_dir_all(&directory).ok();
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-5, ..Settings::default() };
    for (body, cells) in BODIES {
        let finest = scene(body, cells[2])?;
        let (full, seconds) = timed(&finest, &settings)?;
        println!(
            "\n{body}: {} unknowns, {} cells, {seconds:.3} s",
            finest.body().dofs(),
            finest.body().mesh().cell_count()
        );

        let mut coarser = Vec::new();
        for count in &cells[..2] {
            let coarse = scene(body, *count)?;
            let (run, seconds) = timed(&coarse, &settings)?;
            let off = apart(&full, &run);
            println!(
                "{:8} unknowns of a coarser mesh: {:.2} %, {seconds:.3} s",
                coarse.body().dofs(),
                100.0 * off
            );
            coarser.push((seconds, off));
        }
        let with_all: Vec<Tried> = tried(&finest, &settings, NEVER)?;
        let mut with_few: Vec<Tried> = Vec::new();
        for within in WITHIN {
            with_few.extend(tried(&finest, &settings, within)?.last());
        }
        with_few.dedup_by_key(|tried| [tried.unknowns, tried.cells]);
        for (words, tried) in [("as good as all", &with_all), ("few cells", &with_few)] {
            for Tried { unknowns, cells, error, seconds, .. } in tried {
                println!(
                    "{unknowns:8} unknowns, {cells} cells ({words}): {:.3} %, {seconds:.3} s",
                    100.0 * error
                );
            }
        }
        let points = |tried: &[Tried]| -> Vec<(f64, f64)> {
            tried
                .iter()
                .filter(|tried| tried.error.is_finite())
                .map(|tried| (tried.seconds, tried.error))
                .collect()
        };
        let errors = points(&with_all).into_iter().chain(points(&with_few)).map(|(_, error)| error);
        let [least, most] =
            errors.fold([1.0_f64, 0.0_f64], |[low, high], error| [low.min(error), high.max(error)]);
        Chart::new(format!("{body}: {} unknowns", finest.body().dofs()))
            .axes("time of a run (s)", "largest error of a displacement")
            .logarithmic(true, true)
            .marked("reduced, cells as good as all", points(&with_all))
            .marked("reduced, few cells", points(&with_few))
            .marked("coarser meshes", coarser)
            .reference("all unknowns", [(seconds, least), (seconds, most)])
            .write(directory.join(format!("{body}.svg")))?;
    }
    Ok(())
}

/// All models that are tried for an error.
fn tried(scene: &Scene, settings: &Settings, within: f64) -> Result<Vec<Tried>, Error> {
    let training = Training {
        scenes: vec![scene.clone()],
        held_out: Vec::new(),
        settings: settings.clone(),
        within,
        most_unknowns: 100,
    };
    let mut tried = reduce(&training, &mut |_| ControlFlow::Continue(()))?.tried;
    tried.dedup_by_key(|tried| [tried.unknowns, tried.cells]);
    Ok(tried)
}

fn timed(scene: &Scene, settings: &Settings) -> Result<(Trajectory, f64), Error> {
    let clock = Instant::now();
    let run = scene.simulate(settings, &Sampling::every(scene.end() / 200.0))?;
    Ok((run, clock.elapsed().as_secs_f64()))
}

/// The largest distance of the nodes of `coarse` from where these are in `fine`, relative to the largest displacement.
fn apart(fine: &Trajectory, coarse: &Trajectory) -> f64 {
    let d = fine.scene().body().dimension();
    let [of_fine, of_coarse] = [fine, coarse].map(|run| run.scene().body().mesh().positions());
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
    let place = |at: &[f64]| of_fine.chunks_exact(d).position(|other| near(at, other));
    let places: Vec<Option<usize>> = of_coarse.chunks_exact(d).map(place).collect();
    let (mut off, mut far) = (0.0_f64, 0.0_f64);
    for (a, b) in fine.samples().iter().zip(coarse.samples()) {
        far = a.u.chunks_exact(d).map(|u| length(u, &[0.0; 3])).fold(far, f64::max);
        for (place, u) in places.iter().zip(b.u.chunks_exact(d)) {
            let Some(place) = place else { continue };
            off = off.max(length(u, &a.u[place * d..][..d]));
        }
    }
    off / far
}

fn length(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
