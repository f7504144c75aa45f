//! `pliant run`

use std::path::PathBuf;

use clap::Args;
use pliant::ContactEvents;
use pliant::output::write_report;
use pliant::{Error, InputError, Method, SceneFile, Settings};

use crate::failure::{Failure, print};
use crate::files::OutputArguments;
use crate::progress::Watch;

/// Run a scene and write its motion
///
/// Writes trajectory.csv (one row per output time), report.json (how it was computed) and what
/// --formats asks for. Flags override the tables [solver] and [output] of the file. Ctrl-C ends
/// the run after the present step; what was computed until then is written.
#[derive(Args)]
pub struct Arguments {
    /// Scene file
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    #[command(flatten)]
    solver: SolverArguments,
    /// Time between rows of trajectory.csv (s)
    #[arg(long, value_name = "SECONDS")]
    step: Option<f64>,
    /// End the scene at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    #[command(flatten)]
    output: OutputArguments,
}

/// Flags that override `[solver]`.
#[derive(Args)]
struct SolverArguments {
    /// Integration method: see "pliant methods"
    #[arg(long)]
    method: Option<Method>,
    /// Relative tolerance
    #[arg(long)]
    rtol: Option<f64>,
    /// Absolute tolerance of displacements (m)
    #[arg(long, value_name = "METRES")]
    atol_position: Option<f64>,
    /// Absolute tolerance of velocities (m/s)
    #[arg(long, value_name = "METRES/SECOND")]
    atol_velocity: Option<f64>,
    /// Rate at which errors of constraints decay (1/s)
    #[arg(long, value_name = "1/SECONDS")]
    alpha: Option<f64>,
    /// Highest order of a multistep method
    #[arg(long, value_name = "ORDER")]
    max_order: Option<u32>,
    /// How contact events are met: step-over or locate
    #[arg(long, value_name = "WAY")]
    contact_events: Option<ContactEvents>,
    /// Longest step (s)
    #[arg(long, value_name = "SECONDS")]
    max_step: Option<f64>,
    /// Steps that a phase may take
    #[arg(long, value_name = "STEPS")]
    max_steps: Option<usize>,
}

impl SolverArguments {
    fn apply(&self, solver: &mut Settings) -> Result<(), InputError> {
        solver.method = self.method.unwrap_or(solver.method);
        solver.rtol = self.rtol.unwrap_or(solver.rtol);
        solver.atol_position = self.atol_position.or(solver.atol_position);
        solver.atol_velocity = self.atol_velocity.or(solver.atol_velocity);
        solver.alpha = self.alpha.unwrap_or(solver.alpha);
        solver.max_order = self.max_order.or(solver.max_order);
        solver.contact_events = self.contact_events.unwrap_or(solver.contact_events);
        solver.max_step = self.max_step.or(solver.max_step);
        solver.max_steps = self.max_steps.unwrap_or(solver.max_steps);
        solver.validate()
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene: path, solver, step, until, output } = arguments;
    let mut file = SceneFile::read(path)?;
    solver.apply(&mut file.solver)?;
    output.apply(&mut file)?;
    file.output.step = step.or(file.output.step);
    if let Some(end) = *until {
        file.scene = file.scene.ended_at(end);
    }
    let SceneFile { title, scene, solver, output: request } = &file;
    let mut directory = output.directory(path, "")?;

    let mut watch = Watch::new(scene.end(), output.quiet)?;
    let result = scene.simulate_with(solver, &request.sampling(), |progress| watch.see(progress));
    watch.finish();
    let outcome = match &result {
        Ok(trajectory) => Ok(trajectory),
        Err(Error::Integration(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    let trajectory = outcome.unwrap_or_else(|failure| &failure.trajectory);
    directory.write("report.json", |path| write_report(outcome, path))?;
    directory.write_table(trajectory, request)?;
    directory.write_formats(trajectory, title, request)?;

    if !output.quiet && !title.is_empty() {
        print(title)?;
    }
    print(trajectory.report())?;
    if !output.quiet {
        directory.tell()?;
    }
    result.map(|_| ()).map_err(Failure::from)
}
