//! Rigid and soft balls that fall into a box, in space.
//!
//! `cargo run --release --example pile -- --most 8`
//!
//! What to look for: no ball passes through another one, and a rigid ball costs far fewer unknowns than a soft one of the same
//! mesh, but not fewer contacts. `out/pile` has pictures.

mod common;

use std::time::Instant;

use clap::Parser;
use common::{finish, patterns_and_overlaps};
use pliant::output::Snapshots;
use pliant::{
    Body, ContactEvents, Error, Law, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings,
    SolidCells, Substance, Touch,
};

/// A table of piles of balls: unknowns, steps, time, energy balance.
#[derive(Parser)]
struct Arguments {
    /// Balls of the largest pile
    #[arg(long, default_value_t = 4)]
    most: usize,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: std::path::PathBuf,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    println!(
        "{:>6} {:>6} {:>12} {:>7} {:>9} {:>9} {:>14} {:>9}",
        "balls", "", "independent", "steps", "patterns", "time (s)", "per step (ms)", "overlaps"
    );
    // so many points come to the walls that locating each would take longer than smaller steps do
    let contact_events = ContactEvents::StepOver;
    let settings = Settings { rtol: 1e-3, contact_events, ..Settings::default() };
    let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 30.0 };
    let kinds = [("rigid", Material::rigid(1000.0)), ("soft", soft.law(Law::NeoHookean))];
    for balls in [4, 8, 16].into_iter().filter(|&balls| balls <= arguments.most) {
        for (kind, substance) in &kinds {
            let scene = pile(balls, substance)?;
            let independent = scene.body().independent_dofs();
            let clock = Instant::now();
            let motion = scene.simulate(&settings, &Sampling::every(0.05))?;
            let seconds = clock.elapsed().as_secs_f64();
            let report = motion.report();
            let (changes, overlaps) = patterns_and_overlaps(&motion);
            println!(
                "{balls:>6} {kind:>6} {independent:>12} {:>7} {changes:>9} {seconds:>9.2} {:>14.2} {:>9}",
                report.steps(),
                1e3 * seconds / report.steps() as f64,
                overlaps,
            );
            let file = arguments.out.join("pile").join(format!("{balls}-{kind}.svg"));
            let title = format!("{balls} {kind} balls");
            Snapshots::at([0.0, 0.2, 0.4]).title(title).write(&motion, file)?;
        }
    }
    println!("written to {}", arguments.out.join("pile").display());
    Ok(())
}

/// Balls of 4 cm, two to a layer, above a box that is a little wider.
fn pile(balls: usize, substance: &Substance) -> Result<Scene, Error> {
    let ball = |number: usize| {
        let (place, layer) = (number % 2, number / 2);
        let aside = if layer % 2 == 0 { 0.0 } else { 0.004 };
        let centre = [
            0.024 + 0.044 * place as f64 + aside,
            0.024 + 0.5 * aside,
            0.024 + 0.045 * layer as f64,
        ];
        // a cube whose points move along their rays, so that its faces become a sphere
        let cube = Mesh::cuboid([2.0; 3], [4; 3], SolidCells::Hexahedra)?;
        let round = |x: &[f64]| {
            let ray = [x[0] - 1.0, x[1] - 1.0, x[2] - 1.0];
            let length = ray.iter().map(|x| x * x).sum::<f64>().sqrt();
            let outermost = ray.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let scale = if length > 0.0 { 0.02 * outermost / length } else { 0.0 };
            [0, 1, 2].map(|i| centre[i] + scale * ray[i])
        };
        Body::new(cube.mapped(round)?, substance.clone()).named(format!("{number}")).build()
    };
    let bodies = (0..balls).map(ball).collect::<Result<Vec<_>, _>>()?;
    let mut scene = Scene::new(Body::join(bodies)?);
    for (name, point, normal) in [
        ("floor", [0.0; 3], [0.0, 0.0, 1.0]),
        ("left", [0.0; 3], [1.0, 0.0, 0.0]),
        ("right", [0.1, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ("front", [0.0; 3], [0.0, 1.0, 0.0]),
        ("back", [0.0, 0.06, 0.0], [0.0, -1.0, 0.0]),
    ] {
        let wall = Obstacle::half_plane(point, normal).named(name);
        scene = scene.obstacle(wall.stiffness_density(1e7).damping(1e4));
    }
    let touch = Touch::all().distance(1e-3).stiffness_density(1e9).friction_coefficient(0.3);
    Ok(scene
        .touch(touch.damping_density(1e4).sticking_speed(0.01))
        .gravity([0.0, 0.0, -9.8])
        .phase(Phase::until(0.4)))
}
