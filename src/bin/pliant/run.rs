//! `pliant run`

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use pliant::output::{GrowingTable, write_report};
use pliant::simulate::Progress;
use pliant::{Error, OutputRequest, Scene, SceneFile};

use crate::failure::{Failure, print};
use crate::files::{Directory, OutputArguments};
use crate::progress::Watch;
use crate::settings::{SettingsArguments, ended};

/// Run a scene and write its motion
///
/// Writes trajectory.csv (one row per output time), report.json (how it was computed) and what
/// --formats asks for. Flags override the tables [solver] and [output] of the file. Ctrl-C (or
/// SIGTERM, SIGHUP) ends the run after the present step; what was computed until then is written.
/// trajectory.csv grows every second while the scene runs. Results of an earlier run in the same
/// directory are taken away.
#[derive(Args)]
pub struct Arguments {
    /// Scene file
    #[arg(value_name = "FILE")]
    scene: PathBuf,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Time between rows of trajectory.csv (s)
    #[arg(long, value_name = "SECONDS")]
    step: Option<f64>,
    /// End the scene at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    #[command(flatten)]
    output: OutputArguments,
}

/// Keeps what a run has sampled, while it runs.
struct Keeper<'a> {
    directory: &'a mut Directory,
    table: GrowingTable,
    /// When the table has grown last.
    grown: Instant,
    /// Why the directory could not be claimed.
    refused: Option<Failure>,
}

/// Time between two looks for new rows: a kill loses what was sampled in it.
const PERIOD: Duration = Duration::from_secs(1);

impl<'a> Keeper<'a> {
    fn new(
        directory: &'a mut Directory,
        scene: &Scene,
        request: &OutputRequest,
    ) -> Result<Self, Failure> {
        let table = directory.growing_table(scene, request)?;
        Ok(Self { directory, table, grown: Instant::now(), refused: None })
    }

    /// Called after each step; the first one claims the directory, as all input is known to be right by then.
    fn see(&mut self, progress: &Progress) -> ControlFlow<()> {
        if let Err(failure) = self.directory.claim() {
            self.refused = Some(failure);
            return ControlFlow::Break(());
        }
        if self.grown.elapsed() > PERIOD {
            // a full disk is told at the end, when all is written once more
            let _ = self.table.catch_up(progress.trajectory);
            self.grown = Instant::now();
        }
        ControlFlow::Continue(())
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene: path, settings, step, until, output } = arguments;
    let mut file = SceneFile::read(path)?;
    settings.apply(&mut file.settings)?;
    output.apply(&mut file)?;
    file.output.step = step.or(file.output.step);
    file.scene = ended(file.scene, *until)?;
    let SceneFile { title, scene, settings, output: request, .. } = &file;
    let mut directory = output.directory(path, "")?;

    let mut watch = Watch::new(scene.end(), output.quiet)?;
    let mut keeper = Keeper::new(&mut directory, scene, request)?;
    let result = scene.simulate_with(settings, &request.sampling(), |progress| {
        keeper.see(progress)?;
        watch.see(progress)
    });
    watch.finish();
    keeper.refused.map_or(Ok(()), Err)?;
    let outcome = match &result {
        Ok(trajectory) => Ok(trajectory),
        Err(Error::Integration(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    let trajectory = outcome.unwrap_or_else(|failure| &failure.trajectory);
    directory.claim()?;
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
