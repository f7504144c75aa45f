//! `pliant optimize`

use std::path::{Path, PathBuf};

use clap::Args;
use pliant::SceneFile;
use pliant::fit::Unknown;
use pliant::gradient::Objective;
use pliant::optimize::{Aim, EvaluationTable, SceneOptimizer};

use super::failure::{Failure, print};
use super::files::{Directory, place, without_older};
use super::fit::unknown;
use super::progress::spinner;
use super::scene::SceneArguments;

/// Find the numbers of a scene file, within ranges, with which a quantity is least
///
/// Or largest, or with which quantities reach goals. Goes downhill by the derivatives that `pliant gradient` finds, from the numbers of the file on, and
/// stops where these are below their own errors. Writes evaluations.csv (a row for each evaluation, at once) and optimum.toml (the scene file with the
/// best numbers so far, at once), and at the end optimum.json. For the least squares against a table of measurements there is `pliant fit`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// The quantity: a sensor or node set and a component, as tip.y, which is its value at the end, or, after a colon, another number of it, as tip.y:max,
    /// min, mean, frequency, damping; several times with as many goals
    #[arg(long, value_name = "QUANTITY", required = true)]
    of: Vec<String>,
    /// Keys of the numbers with the ranges in which they lie, separated by commas, as body.material.young=1e5..5e5,phase.push.load.force.2=-1..0
    #[arg(long, value_name = "KEY=LEAST..MOST", required = true, value_delimiter = ',', value_parser = unknown)]
    by: Vec<Unknown>,
    /// As large as it can be, in place of as small
    #[arg(long, conflicts_with = "goal")]
    maximize: bool,
    /// As near to this value as it can be; one for each quantity, in their order
    #[arg(long, value_name = "VALUE")]
    goal: Vec<f64>,
    /// Of the equilibrium that `pliant static` finds
    #[arg(long = "static")]
    at_rest: bool,
    /// Draw the quantity over the evaluations to this file (SVG)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Directory for the results [default: out/ and the name of the scene file, with -optimum]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

/// The files that are written.
const OPTIMUM: &str = "optimum.json";
const SCENE: &str = "optimum.toml";
const EVALUATIONS: &str = "evaluations.csv";

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let place = place(arguments.out.as_deref(), &arguments.scene.path, "-optimum");
    without_older(&place, OPTIMUM, run_in(arguments, &place))
}

fn run_in(arguments: &Arguments, place: &Path) -> Result<(), Failure> {
    let Arguments { scene, of, by, maximize, goal, at_rest, plot, quiet, .. } = arguments;
    let aim = match (maximize, &goal[..]) {
        (true, _) => Aim::Largest,
        (false, []) => Aim::Least,
        (false, goals) => Aim::Goals(goals.into()),
    };
    let objective = match at_rest {
        true => Objective::QuantityAtRest,
        false => Objective::Quantity,
    };
    let objectives: Vec<Objective> = of.iter().cloned().map(objective).collect();
    let text = SceneFile::text_with(&scene.path, &[])?;
    let optimizer =
        SceneOptimizer::of_text(&scene.reader, text, &scene.path, &scene.set, objectives, aim, by)?;
    let mut directory = Directory::new(place.into())?;
    let mut table = EvaluationTable::new(directory.beside(EVALUATIONS), by);
    let progress = spinner(*quiet);
    progress.set_message("evaluation 1");
    let mut count = 1;
    let optimum = optimizer.optimize(&mut |evaluation| {
        table.add(evaluation)?;
        if evaluation.is_best {
            optimizer.write_scene(evaluation, directory.beside(SCENE))?;
        }
        count += 1;
        let told = evaluation.quantities().iter();
        let told: Vec<String> = told
            .map(|gradient| format!("{} = {:.4e} {}", gradient.of, gradient.value, gradient.unit))
            .collect();
        progress.set_message(format!("{}; evaluation {count}", told.join(", ")));
        Ok(())
    });
    progress.finish_and_clear();
    let optimum = optimum?;
    print(&optimum)?;
    directory.write(OPTIMUM, |path| optimum.write_json(path))?;
    if let Some(path) = plot {
        optimum.write_chart(path)?;
        print(format_args!("written: {}", path.display()))?;
    }
    directory.write(SCENE, |path| optimizer.write_scene(optimum.best(), path))?;
    if !quiet {
        directory.tell()?;
        print(format_args!("with all evaluations: {EVALUATIONS}"))?;
    }
    Ok(())
}
