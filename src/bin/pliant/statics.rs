//! `pliant static`

use clap::Args;
use pliant::output::write_static_report;
use pliant::{Error, SceneFile, Statics};

use crate::failure::{Failure, print};
use crate::files::OutputArguments;
use crate::scene::SceneArguments;

/// Find the equilibrium of the first phase of a scene
///
/// Its constraints, gravity, loads, obstacles and springs are taken as they are at its end; there is
/// no motion. Writes trajectory.csv with one row, report.json, and what --formats asks for, to
/// out/NAME-static for the scene file NAME.toml if --out does not say otherwise.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    #[command(flatten)]
    output: OutputArguments,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, output } = arguments;
    let mut file = scene.read()?;
    output.apply(&mut file)?;
    let SceneFile { title, scene, output: request, .. } = &file;
    let mut directory = output.directory(&arguments.scene.path, "-static")?;

    let result = scene.equilibrium(&Statics::default());
    let outcome = match &result {
        Ok(equilibrium) => Ok(equilibrium),
        Err(Error::Statics(failure)) => Err(&**failure),
        Err(_) => return result.map(|_| ()).map_err(Failure::from),
    };
    let trajectory = match outcome {
        Ok(equilibrium) => equilibrium.trajectory(),
        Err(failure) => &failure.trajectory,
    };
    directory.claim()?;
    directory.write("report.json", |path| write_static_report(outcome, path))?;
    directory.write_table(&trajectory.at_end(), request)?;
    directory.write_formats(trajectory, title, request)?;

    if !output.quiet && !title.is_empty() {
        print(title)?;
    }
    if let Ok(equilibrium) = outcome {
        print(equilibrium)?;
    }
    if !output.quiet {
        directory.tell()?;
    }
    result.map(|_| ()).map_err(Failure::from)
}
