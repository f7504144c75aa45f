//! Contact held against Hertz, Cattaneo and Mindlin: line contact of two elastic blocks, with friction, and a sphere.
//!
//! `cargo run --release --example hertz`, and for friction `-- --finest 8 --friction`
//!
//! What to look for: with linear cells forces on nodes over their lengths converge to Hertz's pressure, down to what the
//! contact distance D leaves, and so does the stress in the cells beside the contact; the stress that is extrapolated to the
//! nodes of linear cells converges more slowly, from above. Quadratic cells load their nodes unevenly: add up three in a row.

#[path = "../common/mod.rs"]
mod common;
mod line;
mod shear;
mod sphere;

use clap::Parser;
use common::finish;
use line::{ABOUT, Hertz, Pressing, Surface};
use pliant::{Cells, Error, Sample, Trajectory};

/// Tables of errors over the mesh, the contact distance, the kind of cells and the load.
#[derive(Parser)]
struct Arguments {
    /// Cells across half of the contact, at most
    #[arg(long, default_value_t = 16)]
    finest: usize,
    /// Also Cattaneo's and Mindlin's contact with friction, in some ten thousand steps
    #[arg(long)]
    friction: bool,
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let finest = arguments.finest as f64;
    let usual = Pressing {
        cells: Cells::Rectangles,
        across: 8.0,
        ratio: 0.77,
        distance: 0.1,
        approach: 1.0,
    };
    println!(
        "Line contact. D over a^2/(2 R), errors in % of the closed forms, of pressures in % of the largest"
    );
    println!(
        "{:>12} {:>7} {:>6} {:>6} {:>7} {:>6} {:>8} {:>8} {:>8} {:>8}",
        "cells", "across", "ratio", "D", "side", "a", "nodes", "threes", "cells", "at nodes"
    );
    for across in [4.0, 8.0, 16.0, 32.0].into_iter().filter(|across| *across <= finest) {
        press(&Pressing { across, ..usual })?;
    }
    for distance in [0.5, 0.2, 0.05, 0.02] {
        press(&Pressing { distance, ..usual })?;
    }
    for ratio in [1.0, 0.4] {
        press(&Pressing { ratio, ..usual })?;
    }
    for cells in [Cells::Triangles, Cells::Crossed, Cells::Triangles6, Cells::Rectangles9] {
        press(&Pressing { cells, ..usual })?;
    }

    println!("\nSphere. Errors in % of the closed forms");
    println!(
        "{:>7} {:>7} {:>6} {:>6} {:>10} {:>9} {:>9}",
        "across", "nodes", "D", "load", "F (N)", "F", "radius"
    );
    for (across, distance, part) in [
        (2.0, 0.1, 1.0),
        (4.0, 0.1, 1.0),
        (4.0, 0.1, 0.5),
        (4.0, 0.1, 2.0),
        (4.0, 0.05, 1.0),
        (2.0, 0.02, 1.0),
        (4.0, 0.02, 1.0),
    ] {
        let found = sphere::pressed(across, distance, part)?;
        let [force, radius] = [found.force, found.radius].map(|[is, exact]| percent(is, exact));
        println!(
            "{across:>7} {:>7} {distance:>6} {part:>6} {:>10.5} {force:>9.2} {radius:>9.2}",
            found.nodes, found.force[0]
        );
    }

    if arguments.friction {
        println!(
            "\nLine contact with friction of 0.5. Errors in %, of shear stresses in % of mu p0"
        );
        println!("{:>9} {:>9} {:>9} {:>9} {:>7}", "Q/(mu P)", "c/a", "off", "shear", "steps");
        for way in [3e-5, 6e-5] {
            let found = shear::drawn(&Pressing { approach: 2.0, ..usual }, 0.5, way)?;
            let [sticking, exact] = found.sticking;
            println!(
                "{:>9.3} {exact:>9.3} {:>9.2} {:>9.2} {:>7}",
                found.load,
                percent(sticking, exact),
                100.0 * found.off,
                found.steps
            );
        }
    }
    Ok(())
}

fn percent(found: f64, exact: f64) -> f64 {
    100.0 * (found / exact - 1.0)
}

/// Hertz under the force that was found, and both surfaces.
fn read(motion: &Trajectory, sample: &Sample) -> Result<(Hertz, [Surface; 2]), Error> {
    let surfaces = [Surface::new(motion, sample, false)?, Surface::new(motion, sample, true)?];
    Ok((Hertz::under(surfaces[0].presses.iter().sum()), surfaces))
}

fn press(pressing: &Pressing) -> Result<(), Error> {
    let found = pressing.pressed()?;
    let (hertz, surfaces) = read(found.trajectory(), found.sample())?;
    for (surface, side) in surfaces.iter().zip(["coarse", "fine"]) {
        let [nodes, threes, cells, at_nodes] = surface.pressures_off(&hertz).map(|x| 100.0 * x);
        println!(
            "{:>12} {:>7.1} {:>6} {:>6} {side:>7} {:>6.2} {nodes:>8.2} {threes:>8.2} {cells:>8.2} {at_nodes:>8.2}",
            pressing.cells.name(),
            pressing.across * hertz.half_width / ABOUT,
            pressing.ratio,
            pressing.distance,
            percent(surface.half_width(), hertz.half_width),
        );
    }
    Ok(())
}
