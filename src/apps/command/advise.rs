//! `pliant advise`

use std::fs::File;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use indicatif::ProgressBar;
use pliant::studies::{
    advise::{Advice, Adviser, Candidate},
    work_precision::Quantity,
};
use pliant::{Fraction, Sampling, SceneFile};

use super::failure::{Failure, print};
use super::files::Directory;
use super::progress::spinner;
use super::scene::SceneArguments;
use super::settings::{SettingsArguments, ended};
use super::shell::quoted;

/// Longest command (bytes) that is printed: one with lists of cells is not.
const LONGEST: usize = 2000;
/// Samples of each motion on the page.
const FRAMES: f64 = 400.0;

/// Find out what model of a scene is enough
///
/// Runs the scene with the other measure of strain, with finer and quadratic cells, with lumped inertia, without gravity,
/// viscosity, friction or an obstacle, by several methods and tolerances, and tells what is enough for a quantity to be
/// right, what each step up would change, and what it costs.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Quantity that has to be right: motion, a sensor or node set and a component such as tip.y, com.x, rotation; with :end,
    /// :max, :min, :mean, :frequency or :damping that alone
    #[arg(long, value_name = "QUANTITY", default_value = "motion")]
    quantity: String,
    /// How right: 1% or 0.01
    #[arg(long, value_name = "PART", default_value = "1%")]
    within: Fraction,
    /// Time that all runs may take together (s)
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    budget: f64,
    /// End the scene at this time (s)
    #[arg(long, value_name = "SECONDS")]
    until: Option<f64>,
    /// Directory for advice.html (a page with the motions), advice.json (all that was found), candidates.csv, and runs.jsonl,
    /// which keeps all runs: another search with the same directory, after Ctrl-C or with a larger budget, goes on from
    /// there [default: none]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write the scene file with what is enough, and why, to this new file
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, settings, quantity, within, budget, until, out, write, quiet } =
        arguments;
    let mut file = scene.read()?;
    let mut directory = out.clone().map(Directory::new).transpose()?;
    if let Some(path) = write.as_ref().filter(|path| path.exists()) {
        let path = path.display();
        return Err(Failure::bad_input(format!("{path} is there already: write to another file")));
    }
    settings.apply(&mut file.settings)?;
    file.scene = ended(file.scene, *until)?;
    let quantity = Quantity::named(quantity, &file.scene, &file.output.sensors)?;
    let mut adviser = Adviser::new(&file.scene, within.0)
        .settings(file.settings.clone())
        .quantity(quantity)
        .budget(*budget);
    if let Some(directory) = &directory {
        adviser = adviser.keep(directory.beside("runs.jsonl"));
    }
    let interrupted = Arc::new(AtomicBool::new(false));
    let asked = interrupted.clone();
    ctrlc::set_handler(move || asked.store(true, Ordering::Relaxed))
        .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
    let progress = spinner(*quiet);
    let advice = adviser.run(&mut |what| watch(&progress, &interrupted, what));
    progress.finish_and_clear();
    let advice = advice?;
    print(&advice)?;
    let set = set_for(scene, &file, &advice)?;
    if let Some(enough) = &advice.enough {
        let command = command_of(scene, enough, &set);
        match command.len() > LONGEST {
            true => print(
                "\nTo run what is enough, have it written by --write FILE: it lists the cells that are halved.",
            )?,
            false => print(format_args!("\nTo run what is enough:\n{command}"))?,
        }
    }
    if let Some(directory) = &mut directory {
        let title = match &file.title[..] {
            "" => scene.path.display().to_string(),
            title => scene.title(title),
        };
        let progress = spinner(*quiet);
        let mut observer = |what: &str| watch(&progress, &interrupted, what);
        let scene = &file.scene;
        let samples = Sampling::every(scene.end() / FRAMES);
        let sensors = file.output.sensors.iter().cloned();
        let sampling = sensors.fold(samples, |all, (name, reading)| all.read(name, reading));
        directory.write("advice.html", |path| {
            advice.write_page(scene, &sampling, path, &title, &mut observer)
        })?;
        progress.finish_and_clear();
        directory.write("advice.json", |path| advice.write_json(path))?;
        directory.write("candidates.csv", |path| advice.write_csv(path))?;
        directory.tell()?;
    }
    match (write, &advice.enough) {
        (Some(path), Some(_)) => write_scene(scene, &advice, &set, path),
        (Some(_), None) => {
            Err(Failure::failed("no model is known to be enough: no scene file is written"))
        }
        (None, _) => Ok(()),
    }
}

/// Overrides for the recommended model, as a simplified one if the scene of the file can be run by it: with all sensors of the
/// file, and together with the simplified models that it names.
fn set_for(
    scene: &SceneArguments,
    file: &SceneFile,
    advice: &Advice,
) -> Result<Vec<String>, Failure> {
    let (set, Some(enough)) = (advice.set(), &advice.enough) else { return Ok(Vec::new()) };
    let Some(smaller) = advice.smaller_enough() else { return Ok(set) };
    let mut kinds = file.smaller.clone();
    kinds.push(smaller.kind);
    let why = match scene.read_with(&set) {
        Ok(own) if own.smaller == kinds => return Ok(set),
        Ok(_) => "it has another one already".into(),
        Err(error) => error.to_string(),
    };
    let kind = smaller.kind;
    print(format_args!("\nThe smaller model ({kind}) is not for all of the file: {why}"))?;
    Ok(enough.set.clone())
}

/// The shell command that runs the recommended model.
fn command_of(scene: &SceneArguments, enough: &Candidate, set: &[String]) -> String {
    let command = if enough.choice.is_static { "static" } else { "run" };
    let path = quoted(&scene.path.to_string_lossy());
    let sets = scene.set.iter().chain(set);
    let sets = sets.map(|set| format!(" --set {}", quoted(set)));
    sets.fold(format!("  pliant {command} {path}"), |line, set| line + &set)
}

/// Writes the scene file with the recommended settings, below the reasons as comments.
fn write_scene(
    scene: &SceneArguments,
    advice: &Advice,
    set: &[String],
    path: &Path,
) -> Result<(), Failure> {
    let comment = |line: &str| format!("# {line}").trim_end().to_owned() + "\n";
    let reasons: String = advice.to_string().lines().map(comment).collect();
    let mut set = set.to_vec();
    set.extend(scene.mesh_for(path)?);
    let text = scene.text(&set)?;
    // a schema must stay on the first line
    let (first, rest) = match text.starts_with("#:schema") {
        true => text.split_at(text.find('\n').map_or(text.len(), |end| end + 1)),
        false => ("", &text[..]),
    };
    let failed = |error| Failure::failed(format!("cannot write to {}: {error}", path.display()));
    let mut new = File::create_new(path).map_err(failed)?;
    new.write_all(format!("{first}{reasons}\n{rest}").as_bytes()).map_err(failed)?;
    print(format_args!("written: {}", path.display()))
}

/// Shows the present run, and ends the search after Ctrl-C.
fn watch(bar: &ProgressBar, interrupted: &AtomicBool, what: &str) -> ControlFlow<()> {
    bar.set_message(what.to_owned());
    match interrupted.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}
