//! `pliant run`
//!
//! A run is a `Simulation` that goes to its end, keeps a checkpoint and the rows of the table on the way, and
//! can be restored.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;
use pliant::output::{GrowingTable, write_report};
use pliant::simulate::Simulation;
use pliant::studies::work_precision::Verification;
use pliant::{Error, Fraction, IntegrationFailure, SceneFile, Trajectory};

use super::accuracy::AccuracyArguments;
use super::failure::{Failure, print};
use super::files::{Directory, OutputArguments, REPORT, without_older};
use super::progress::RunProgress;
use super::scene::SceneArguments;
use super::settings::{SettingsArguments, ended};

/// Run a scene and write its motion
///
/// Writes trajectory.csv (one row per output time), report.json (how it was computed), state.json (the last state, for other
/// scenes to start from) and what --formats asks for. Flags override the tables [solver] and [output] of the file. Ctrl-C (or
/// SIGTERM, SIGHUP) ends the run after the present step; what was computed until then is written.
/// trajectory.csv grows every second while the scene runs, and checkpoint.json is renewed every ten seconds: --resume
/// goes on from there. Results of an earlier run in the same directory are taken away.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Time between rows of trajectory.csv (s)
    #[arg(long, value_name = "SECONDS")]
    step: Option<f64>,
    /// End the scene at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    #[command(flatten)]
    accuracy: AccuracyArguments,
    /// Run it by this reduced model, a file of `pliant reduce`, in place of that of the scene file
    #[arg(long, value_name = "FILE")]
    reduced: Option<PathBuf>,
    /// Go on with a run of the same scene that was interrupted or killed, from the checkpoint in its directory;
    /// pictures show the motion from there on
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    output: OutputArguments,
}

/// Saves the results of a run while it is running.
struct Keeper<'a> {
    directory: &'a mut Directory,
    table: GrowingTable,
    /// When the table has grown last, and when the checkpoint was written.
    grown: Instant,
    kept: Instant,
    /// Why the directory could not be claimed.
    refused: Option<Failure>,
}

/// Time between two checks for new rows: a kill loses the samples since the last one.
const GROWTH: Duration = Duration::from_secs(1);
/// Time between two checkpoints: a kill loses the steps since the last one.
const KEEPING: Duration = Duration::from_secs(10);

impl<'a> Keeper<'a> {
    fn new(directory: &'a mut Directory, table: GrowingTable) -> Self {
        let now = Instant::now();
        Self { directory, table, grown: now, kept: now, refused: None }
    }

    /// Called after each step; the first one claims the directory, as all input is known to be right by then.
    fn see(&mut self, simulation: &Simulation) -> ControlFlow<()> {
        if let Err(failure) = self.directory.claim() {
            self.refused = Some(failure);
            return ControlFlow::Break(());
        }
        // a full disk is reported at the end, when everything is written once more
        if self.grown.elapsed() > GROWTH {
            let _ = self.table.catch_up(simulation.trajectory());
            self.grown = Instant::now();
        }
        if self.kept.elapsed() > KEEPING {
            self.keep(simulation);
        }
        ControlFlow::Continue(())
    }

    fn keep(&mut self, simulation: &Simulation) {
        // rows before the checkpoint: a resumed run computes the rows after it once more
        let _ = self.table.catch_up(simulation.trajectory());
        let _ = self.directory.keep(&simulation.checkpoint());
        self.kept = Instant::now();
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let place = arguments.output.place(&arguments.scene.path, "");
    let result = run_in(arguments, &place);
    match arguments.resume {
        // the report is that of the run that was to be resumed
        true => result,
        false => without_older(&place, REPORT, result),
    }
}

fn run_in(arguments: &Arguments, place: &Path) -> Result<(), Failure> {
    let Arguments { scene, settings, step, until, accuracy, reduced, resume, output } = arguments;
    let mut file = scene.read_reduced(reduced.as_deref())?;
    settings.apply(&mut file.settings)?;
    accuracy.apply(&mut file.accuracy, settings)?;
    output.apply(&mut file)?;
    if step.is_some() {
        (file.output.step, file.output.times) = (*step, None);
    }
    file.scene = ended(file.scene, *until)?;
    if let Some(times) = &mut file.output.times {
        times.retain(|t| *t <= file.scene.end());
    }
    let directory = Directory::new(place.into())?;
    let watch = RunProgress::new(file.scene.end(), output.quiet)?;
    match file.accuracy.within {
        Some(_) if *resume => Err(Failure::bad_input(
            "--resume goes on with one run, and --accuracy takes several: leave one of them out",
        )),
        Some(within) => verified(&file, within, directory, watch, output.quiet),
        None => once(&file, *resume, directory, watch, output.quiet),
    }
}

/// One run.
fn once(
    file: &SceneFile,
    resume: bool,
    mut directory: Directory,
    mut watch: RunProgress,
    quiet: bool,
) -> Result<(), Failure> {
    let SceneFile { title, scene, settings, output: request, .. } = file;
    let mut simulation = scene.start(settings)?;
    if resume {
        directory.resumes = true;
        let checkpoint = simulation.read_checkpoint(directory.checkpoint()?)?;
        simulation.restore(&checkpoint)?;
    }
    let began = simulation.time();
    simulation.record(&request.sampling())?;
    watch.start();
    let table = directory.growing_table(&simulation, request)?;
    let mut keeper = Keeper::new(&mut directory, table);
    let mut result = simulation.finish(|simulation| {
        keeper.see(simulation)?;
        watch.see(simulation).map_break(|()| keeper.keep(simulation))
    });
    watch.finish();
    let Keeper { refused, mut table, .. } = keeper;
    refused.map_or(Ok(()), Err)?;
    match &mut result {
        Ok(trajectory) => file.explain(trajectory),
        Err(Error::Integration(failure)) => file.explain(&mut failure.trajectory),
        Err(_) => {}
    }
    let outcome = match &result {
        Ok(trajectory) => Ok(trajectory),
        Err(Error::Integration(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    let trajectory = outcome.unwrap_or_else(|failure| &failure.trajectory);
    keep(outcome, &mut directory, |directory| match resume {
        true => directory.write("trajectory.csv", |_| table.catch_up(trajectory)),
        false => directory.write_table(trajectory, request),
    })?;
    directory.write_formats(&trajectory.since(began), title, request)?;
    if outcome.is_ok() {
        directory.forget_checkpoint();
    }
    if resume && !quiet {
        print(format_args!("resumed at t = {began} s"))?;
    }
    tell(title, trajectory, &directory, quiet)?;
    result.map(|_| ()).map_err(Failure::from)
}

/// Writes the report, the table and the last state of a motion, or of the part of it that was computed.
pub fn keep(
    outcome: Result<&Trajectory, &IntegrationFailure>,
    directory: &mut Directory,
    write_table: impl FnOnce(&mut Directory) -> Result<(), Failure>,
) -> Result<(), Failure> {
    directory.claim()?;
    directory.write(REPORT, |path| write_report(outcome, path))?;
    write_table(directory)?;
    directory.write_state(outcome.unwrap_or_else(|failure| &failure.trajectory))
}

/// Prints how a motion was computed, and the names of the files written.
fn tell(
    title: &str,
    trajectory: &Trajectory,
    directory: &Directory,
    quiet: bool,
) -> Result<(), Failure> {
    let report = trajectory.report();
    if quiet {
        report.achieved.iter().try_for_each(print)?;
        let mut warnings = report.warnings().into_iter();
        return warnings.try_for_each(|warning| print(format_args!("WARNING: {warning}")));
    }
    if !title.is_empty() {
        print(title)?;
    }
    print(report)?;
    directory.tell()
}

/// Runs the scene until two runs agree. The results of each run are written as soon as it has ended.
fn verified(
    file: &SceneFile,
    within: Fraction,
    mut directory: Directory,
    mut watch: RunProgress,
    quiet: bool,
) -> Result<(), Failure> {
    let SceneFile { title, output: request, .. } = file;
    let explained = |motion: &Trajectory| {
        let mut motion = motion.clone();
        file.explain(&mut motion);
        motion
    };
    let mut verification = Verification::of_file(file, within)?;
    let mut refused = None;
    let cut_short = loop {
        let refined = verification.refine(|simulation| {
            // from the directory on a signal waits for the step under way
            watch.start();
            match directory.claim() {
                Ok(()) => watch.see(simulation),
                Err(failure) => {
                    refused = Some(failure);
                    ControlFlow::Break(())
                }
            }
        });
        refused.take().map_or(Ok(()), Err)?;
        match (refined, verification.trajectory()) {
            (Ok(goes_on), Some(trajectory)) => {
                keep(Ok(&explained(trajectory)), &mut directory, |directory| {
                    directory.write_table(trajectory, request)
                })?;
                if !goes_on {
                    break None;
                }
            }
            (Err(Error::Integration(failure)), _) => break Some(failure),
            (refined, _) => return refined.map(|_| ()).map_err(Failure::from),
        }
    };
    watch.finish();
    let trajectory = match (verification.trajectory(), &cut_short) {
        (Some(trajectory), _) => trajectory,
        (None, Some(failure)) => {
            let trajectory = &failure.trajectory;
            keep(Err(failure), &mut directory, |directory| {
                directory.write_table(trajectory, request)
            })?;
            trajectory
        }
        (None, None) => return Ok(()), // cannot happen: the loop ends after a run
    };
    directory.write_formats(trajectory, title, request)?;
    tell(title, &explained(trajectory), &directory, quiet)?;
    cut_short.map_or(Ok(()), |failure| Err(Error::Integration(failure).into()))
}
