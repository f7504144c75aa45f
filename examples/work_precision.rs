//! Speed against accuracy: every method on a scene of the documents or a standard stiff problem,
//! tolerance by tolerance; or, with `clamped-beam-meshes`, every kind of cell, mesh by mesh.
//!
//! `cargo run --release --example work_precision -- square-jump`
//!
//! What to look for: a table of the fastest method for each accuracy, and a chart. No method is
//! the fastest everywhere: explicit Runge-Kutta wins where nothing is stiff, backward
//! differentiation where damping is strong; its orders above 2 are of no use where there is none.

mod common;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::finish;
use pliant::samples::{self, ClampedBeam, RingRoll};
use pliant::study::{General, Problem, Scenes, Study};
use pliant::{Cells, Error, Scene, Solver, Strain};

/// Speed against accuracy on one problem: table, chart, CSV.
#[derive(Parser)]
struct Arguments {
    /// The problem
    #[arg(value_enum, default_value = "beam-jump")]
    problem: Sample,
    /// Times that each run is repeated
    #[arg(long, default_value_t = 3)]
    repetitions: usize,
    /// Longest time that a run may take (s)
    #[arg(long, default_value_t = 120.0)]
    limit: f64,
    /// Tell processor times, for a busy machine
    #[arg(long)]
    processor: bool,
    /// Directory for table, chart and kept rows
    #[arg(long, default_value = "out/work_precision")]
    out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Sample {
    BeamJump,
    SquarePress,
    SquareJump,
    SquareJump10,
    Membrane,
    MembraneArch,
    BeamBend,
    BeamBendCauchy,
    RingRoll,
    RingSprings,
    RingJump,
    Report8,
    ClampedBeam,
    ClampedBeamDamped,
    ClampedBeamMeshes,
    Hires,
    Robertson,
    VanDerPol,
}

/// Viscosity of the damped clamped beam (Pa s): 1 % of critical damping in its lowest mode.
const LIGHT: f64 = 4000.0;

impl Sample {
    fn problem(self, name: &str) -> Result<Box<dyn Problem>, Error> {
        let scene = match self {
            Self::BeamJump => samples::beam_jump(),
            Self::SquarePress => samples::square_press(4),
            Self::SquareJump => samples::square_jump(4),
            Self::SquareJump10 => samples::square_jump(10),
            Self::Membrane => samples::membrane(),
            Self::MembraneArch => samples::membrane_arch(),
            Self::BeamBend => samples::beam_bend(Strain::Green, false),
            Self::BeamBendCauchy => samples::beam_bend(Strain::Cauchy, false),
            Self::RingRoll => RingRoll::default().scene(),
            Self::RingSprings => samples::ring_springs(1.0),
            Self::RingJump => samples::ring_jump(),
            Self::Report8 => samples::report_8(),
            Self::ClampedBeam => samples::clamped_beam([36, 3], 0.0),
            Self::ClampedBeamDamped => samples::clamped_beam([36, 3], LIGHT),
            Self::ClampedBeamMeshes => return Ok(Box::new(meshes(name)?)),
            Self::Hires => return Ok(Box::new(General::hires())),
            Self::Robertson => return Ok(Box::new(General::robertson())),
            Self::VanDerPol => return Ok(Box::new(General::van_der_pol())),
        };
        Ok(Box::new(Scenes::new(name, scene?).all_methods()))
    }
}

/// The damped clamped beam on meshes of all kinds, against a fine one of quadratic triangles.
fn meshes(name: &str) -> Result<Scenes, Error> {
    let beam = |cells, [along, across]: [usize; 2]| -> Result<Scene, Error> {
        let nodes = [along + 1, across + 1];
        ClampedBeam { nodes, cells, viscosity: LIGHT, ..ClampedBeam::default() }.scene()
    };
    // The integration is much more precise than any of these meshes.
    let solver = Solver { rtol: 1e-5, ..Solver::default() };
    let mut scenes = Scenes::new(name, beam(Cells::Triangles6, [280, 16])?)
        .checked_by(beam(Cells::Triangles6, [140, 8])?)
        .finest(1e-3);
    for cells in Cells::ALL {
        let grids = match cells {
            Cells::Triangles6 => vec![[35, 2], [70, 4]],
            _ => vec![[35, 2], [70, 4], [140, 8], [280, 16]],
        };
        let mesh = |[along, across]: [usize; 2]| {
            Ok((format!("{along} x {across}"), beam(cells, [along, across])?))
        };
        let meshes = grids.into_iter().map(mesh).collect::<Result<Vec<_>, Error>>()?;
        scenes = scenes.meshes(cells.name(), meshes, &solver);
    }
    Ok(scenes)
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let value = arguments.problem.to_possible_value();
    let name = value.as_ref().map_or("", |value| value.get_name());
    let file = |ending: &str| arguments.out.join(format!("{name}.{ending}"));
    let mut problem = arguments.problem.problem(&name.replace('-', " "))?;
    let findings = Study::new(&mut *problem)
        .repetitions(arguments.repetitions)
        .limit(arguments.limit)
        .keep(file("csv"))
        .run(&mut |stage| eprintln!("{stage}"))?;
    let findings = if arguments.processor { findings.by_processor_time() } else { findings };
    println!("{}\n", findings.fastest());
    for note in findings.notes() {
        println!("{note}");
    }
    for ending in ["svg", "png"] {
        findings.write_chart(file(ending))?;
    }
    println!("\nwritten to {}: {name}.csv, .svg, .png", arguments.out.display());
    Ok(())
}
