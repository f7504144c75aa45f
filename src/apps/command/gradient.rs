//! `pliant gradient`

use std::path::{Path, PathBuf};

use clap::Args;
use pliant::SceneFile;
use pliant::fit::{Measured, MeasuredAtRest};
use pliant::gradient::{Method, Objective, SceneGradient};

use super::failure::{Failure, print};
use super::files::{Directory, place, without_older};
use super::progress::spinner;
use super::scene::SceneArguments;

/// Derivatives of what a scene does by numbers of its file, each with its estimated error
///
/// Runs the scene and takes its steps back, or runs it again with the same steps and slightly other numbers, or, where neither can be done,
/// makes whole runs at a tight tolerance; equilibria in any case. Prints the derivatives, and writes them to gradient.json, to out/NAME-gradient for the scene
/// file NAME.toml if --out does not say otherwise. Warns of a derivative that means little: after bounces or in chaos.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// The quantity whose derivatives are wanted: a sensor or node set and a component, as tip.y, which is its value at the end, or, after a colon,
    /// another number of it, as tip.y:max, min, mean, frequency, damping
    #[arg(long, value_name = "QUANTITY", required_unless_present = "data")]
    of: Option<String>,
    /// In place of a quantity the sum of the squares of what sensors read less what was measured: a table (CSV) as `pliant fit` takes it
    #[arg(long, value_name = "FILE", conflicts_with = "of")]
    data: Option<PathBuf>,
    /// Keys of the numbers, separated by commas, as body.material.young,phase.push.load.force.2
    #[arg(long, value_name = "KEYS", required = true, value_delimiter = ',')]
    by: Vec<String>,
    /// Of the equilibrium that `pliant static` finds, or of those in the rows of the table
    #[arg(long = "static")]
    at_rest: bool,
    /// How they are found: adjoint, same-steps or differences [default: adjoint for several numbers of a reading at the end, same-steps where steps
    /// cannot be taken back, differences where runs cannot take the same steps]
    #[arg(long, value_name = "METHOD")]
    method: Option<Method>,
    /// Put the differences of whole runs beside them
    #[arg(long)]
    check: bool,
    /// Directory for gradient.json [default: out/ and the name of the scene file, with -gradient]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

/// The file that is written.
const GRADIENT: &str = "gradient.json";

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let place = place(arguments.out.as_deref(), &arguments.scene.path, "-gradient");
    without_older(&place, GRADIENT, run_in(arguments, &place))
}

fn run_in(arguments: &Arguments, place: &Path) -> Result<(), Failure> {
    let Arguments { scene, of, data, by, at_rest, method, check, quiet, .. } = arguments;
    let objective = match (of, data, at_rest) {
        (Some(of), _, false) => Objective::Quantity(of.clone()),
        (Some(of), _, true) => Objective::QuantityAtRest(of.clone()),
        (None, Some(data), false) => Objective::LeastSquares(Measured::read(data)?),
        (None, Some(data), true) => Objective::LeastSquaresAtRest(MeasuredAtRest::read(data)?),
        (None, None, _) => return Err(Failure::bad_input("say of what: --of tip.y")),
    };
    let text = SceneFile::text_with(&scene.path, &[])?;
    let mut gradient =
        SceneGradient::of_text(&scene.reader, text, &scene.path, &scene.set, objective, by)?;
    if let Some(method) = method {
        gradient = gradient.by_method(*method)?;
    }
    if *check {
        gradient = gradient.checked();
    }
    let mut directory = Directory::new(place.into())?;
    let progress = spinner(*quiet);
    let found =
        gradient.value_and_gradient(&mut |runs| progress.set_message(format!("{runs} runs")));
    progress.finish_and_clear();
    let found = found?;
    print(&found)?;
    directory.write(GRADIENT, |path| found.write_json(path))?;
    if !quiet {
        directory.tell()?;
    }
    Ok(())
}
