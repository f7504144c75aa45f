//! Speed against accuracy: every method on a scene of the documents, tolerance by tolerance.
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
use pliant::samples::{self, RingRoll};
use pliant::study::{Scenes, Study};
use pliant::{Error, Scene, Strain};

/// Speed against accuracy of all methods on one scene: table, chart, CSV.
#[derive(Parser)]
struct Arguments {
    /// The scene
    #[arg(value_enum, default_value = "beam-jump")]
    scene: Sample,
    /// Relative tolerances
    #[arg(long, value_delimiter = ',', default_value = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7,1e-8")]
    rtol: Vec<f64>,
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
}

impl Sample {
    fn scene(self) -> Result<Scene, Error> {
        match self {
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
            Self::ClampedBeamDamped => samples::clamped_beam([36, 3], 4000.0),
        }
    }
}

fn main() {
    finish(run(&Arguments::parse()));
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    let name = arguments.scene.to_possible_value().map_or(String::new(), |v| v.get_name().into());
    let file = |ending: &str| arguments.out.join(format!("{name}.{ending}"));
    let mut scenes = Scenes::new(name.replace('-', " "), arguments.scene.scene()?)
        .tolerances(arguments.rtol.clone())
        .all_methods();
    let findings = Study::new(&mut scenes)
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
