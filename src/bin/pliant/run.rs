//! `pliant run`

use std::path::PathBuf;

use clap::Args;
use pliant::output::write_report;
use pliant::{Error, SceneFile};

use crate::failure::{Failure, print};
use crate::files::OutputArguments;
use crate::progress::Watch;
use crate::settings::SettingsArguments;

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

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene: path, settings, step, until, output } = arguments;
    let mut file = SceneFile::read(path)?;
    settings.apply(&mut file.settings)?;
    output.apply(&mut file)?;
    file.output.step = step.or(file.output.step);
    if let Some(end) = *until {
        file.scene = file.scene.ended_at(end);
    }
    let SceneFile { title, scene, settings, output: request } = &file;
    let mut directory = output.directory(path, "")?;

    let mut watch = Watch::new(scene.end(), output.quiet)?;
    let result = scene.simulate_with(settings, &request.sampling(), |progress| watch.see(progress));
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
