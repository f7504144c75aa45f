//! A beam of 10 x 2 x 1 cm, one end fixed, the middle of the other bent down by 5 cm in
//! equilibrium: the shapes of Hirai's Figs 4.9 (Cauchy strain) and 4.10 (Green strain).
//!
//! `cargo run --release --example beam_static -- --nodes 41`
//!
//! What to look for: Cauchy strain takes rotation for swelling. Where the beam turns most, at its
//! tip, its cells grow; those of Green strain keep their area. The force on the tip is read off
//! the constraint that moves it; applied as a load, it must bend the beam just as far.

use std::path::PathBuf;

use clap::Parser;
use pliant::output::Snapshots;
use pliant::{
    Axis, Body, Cells, Equilibrium, Error, InputError, Material, Mesh, Phase, Scene, Statics,
    Strain,
};

/// The bent beam: force, tip and the area of its last cells, for both measures of strain.
#[derive(Parser)]
struct Arguments {
    /// Nodes along the beam; a fifth of the cells lie across, an even number
    #[arg(long, default_value_t = 11)]
    nodes: usize,
    /// Deflection of the tip (m)
    #[arg(long, default_value_t = 0.05)]
    deflection: f64,
    /// Directory for the pictures
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

fn main() {
    if let Err(error) = run(&Arguments::parse()) {
        eprintln!("beam_static: {error}");
        std::process::exit(1);
    }
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let columns = arguments.nodes;
    let rows = columns.saturating_sub(1) / 10 * 2 + 1;
    let tip = columns * (rows / 2 + 1);
    println!("Bent beam, {columns} x {rows} nodes, tip node {tip}");
    for strain in [Strain::Cauchy, Strain::Green] {
        let beam = || -> Result<Body, InputError> {
            let mesh = Mesh::rectangle([0.10, 0.02], [columns, rows], Cells::Triangles)?;
            let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.48, viscosity: 4.0 };
            Body::new(mesh, rubber).thickness(0.01).strain(strain).build()
        };
        let fixed = || Phase::until(1.0).hold("left");
        let bend = fixed().named("bent").move_axis([tip], Axis::Y, -arguments.deflection);
        let bent = Scene::new(beam()?).phase(bend).equilibrium(&Statics::default())?;
        let force = bent.trajectory().constraint_force(bent.sample(), [tip])?[1];
        let load = Scene::new(beam()?).phase(fixed().load([tip], [0.0, force]));
        let loaded = load.equilibrium(&Statics { load_steps: 4, ..Statics::default() })?;

        let at = |equilibrium: &Equilibrium, axis: usize| {
            100.0 * equilibrium.displacements()[2 * (tip - 1) + axis]
        };
        println!("\n{strain:?} strain: {bent}");
        println!("  force on the tip            {:10.5} N", -force);
        println!("  tip moves (cm)              ({:.5}, {:.5})", at(&bent, 0), at(&bent, 1));
        println!("  the same force as a load    ({:.5}, {:.5})", at(&loaded, 0), at(&loaded, 1));
        println!("  area of the last cells      {:+10.2} %", 100.0 * growth(&bent, columns));
        println!("  area of the whole beam      {:+10.2} %", 100.0 * growth(&bent, usize::MAX));

        let path = arguments.out.join(format!("beam_static/{strain:?}.svg").to_lowercase());
        let title = format!("Beam bent by its tip, {strain:?} strain");
        Snapshots::at([0.0, 1.0]).title(title).columns(2).write(bent.trajectory(), &path)?;
        println!("  written to {}", path.display());
    }
    Ok(())
}

/// Relative growth of area: of the cells at the tip, behind the last but one of `columns` nodes,
/// or of all cells if there are fewer columns.
fn growth(equilibrium: &Equilibrium, columns: usize) -> f64 {
    let mesh = equilibrium.trajectory().body().mesh();
    let u = equilibrium.displacements();
    let is_last = |node: &usize| node % columns + 2 >= columns;
    let (mut natural, mut deformed) = (0.0, 0.0);
    for cell in mesh.cells().filter(|cell| columns == usize::MAX || cell.iter().all(is_last)) {
        let area = |share: f64| {
            let at = |k: usize, i: usize| mesh.position(cell[k])[i] + share * u[2 * cell[k] + i];
            let edge = |k: usize, i: usize| at(k, i) - at(0, i);
            0.5 * (edge(1, 0) * edge(2, 1) - edge(1, 1) * edge(2, 0))
        };
        natural += area(0.0);
        deformed += area(1.0);
    }
    deformed / natural - 1.0
}
