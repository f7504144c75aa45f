//! `pliant fit`

use std::path::PathBuf;

use clap::Args;
use pliant::SceneFile;
use pliant::fit::{Measured, MeasuredAtRest, SceneFit, Unknown};

use super::failure::{Failure, print};
use super::progress::spinner;
use super::scene::SceneArguments;

/// Fit keys of a scene file to measurements
///
/// Runs the scene again and again, or seeks its equilibria, and finds the values that bring its sensors nearest to what was measured, by least
/// squares. Prints them with intervals of 95 % confidence (right if what is left over is noise, too narrow if the model is
/// off), what was and is left over, and the values as --set flags. Derivatives are central differences by the root of
/// solver.rtol, or of statics.rtol, in parts of the ranges; the runs for them go on all cores.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Table (CSV) of what was measured: a column t or time (s), the others with names of sensors of the scene, as tip.y
    #[arg(long, value_name = "FILE")]
    data: PathBuf,
    /// The rows of the table are equilibria, as `pliant static` finds them: its columns are keys of the scene with their values there, as
    /// phase.blow.pressure.value, and sensors
    #[arg(long = "static")]
    at_rest: bool,
    /// A key to be found, and the range in which it lies, as body.material.young=1e5..5e5; may be given several times
    #[arg(long, value_name = "KEY=LEAST..MOST", required = true, value_parser = unknown)]
    unknown: Vec<Unknown>,
    /// Draw what is left over, over time or over the first key of equilibria, to this file (SVG)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

/// A key and its range.
pub fn unknown(text: &str) -> Result<Unknown, String> {
    let help = || "write KEY=LEAST..MOST, as body.material.young=1e5..5e5".to_owned();
    let (key, range) = text.split_once('=').ok_or_else(help)?;
    let (least, most) = range.split_once("..").ok_or_else(help)?;
    let [least, most] = [least, most].map(|end| end.trim().parse().map_err(|_| help()));
    Ok(Unknown::new(key.trim(), least?, most?))
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, data, at_rest, unknown, plot, quiet } = arguments;
    let fit = match at_rest {
        true => {
            let measured = MeasuredAtRest::read(data)?;
            let text = SceneFile::text_with(&scene.path, &[])?;
            SceneFit::at_rest_of_text(&scene.reader, text, &scene.path, &scene.set, &measured)?
        }
        false => {
            let measured = Measured::read(data)?;
            let text = SceneFile::text_with(&scene.path, &[])?;
            SceneFit::of_text(&scene.reader, text, &scene.path, &scene.set, &measured)?
        }
    };
    let progress = spinner(*quiet);
    let fitted = fit.fit(unknown, &mut |runs, rms| {
        progress.set_message(format!("{runs} runs, {rms:.4e} left over"));
    });
    progress.finish_and_clear();
    let fitted = fitted?;
    print(&fitted)?;
    if let Some(path) = plot {
        fitted.write_chart(path)?;
        print(format_args!("written: {}", path.display()))?;
    }
    Ok(())
}
