//! `pliant reduce`

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use pliant::reduce::{Training, VariedKey, reduce, reduce_by_modes, verify, words};
use pliant::{Fraction, ReducedModel};

use super::failure::{Failure, print};
use super::files::Directory;
use super::progress::spinner;
use super::scene::SceneArguments;
use super::settings::SettingsArguments;

/// Learn a reduced model of a scene, with a few unknowns
///
/// Runs the scene with all its unknowns, learns from these runs the shapes in which the body moves and the cells that stand for
/// all, tries models of growing size, and keeps the smallest one that is within the error that is wanted. With --vary it is
/// learned over ranges of keys, as pressures, loads and signals: from all combinations of the ends of up to three ranges and 3
/// points inside (of more keys, from 4 points inside for each), and checked with points that it has not seen. Writes
/// NAME.reduced, NAME-reduced.svg and .png (error over time of all models that were tried) and NAME-reduced.json. `pliant run
/// --reduced NAME.reduced`, or reduced = "NAME.reduced" in [solver], runs the scene by it. Ends with code 1 if no model is
/// within the error; the best one is written all the same.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    #[command(flatten)]
    settings: SettingsArguments,
    /// Largest error of a displacement that is wanted, relative to the largest one: 2% or 0.02
    #[arg(long, value_name = "PART", default_value = "2%")]
    within: Fraction,
    /// A key and the range that the model is for, with the number of its values that are learned (2, the ends, unless said), as
    /// phase.1.pressure.1.value=0..5e3 or phase.1.pressure.1.value=0..5e3:4; may be given several times
    #[arg(long, value_name = "KEY=LEAST..MOST[:COUNT]", value_parser = varied)]
    vary: Vec<VariedKey>,
    /// Points of the ranges that models are checked with, and not learned from
    #[arg(long, value_name = "COUNT", default_value_t = 2)]
    hold_out: usize,
    /// Most unknowns of a model
    #[arg(long, value_name = "UNKNOWNS", default_value_t = 64)]
    most: usize,
    /// Run nothing with all unknowns: begin with free vibrations, what the loads would do and their derivatives, and go on with what runs
    /// by the model leave over. The error is what these runs tell
    #[arg(long, conflicts_with = "verify")]
    modes: bool,
    /// Learn nothing: run the scene, or the held-out points of --vary, with all unknowns and by this model, and print its errors
    #[arg(long, value_name = "MODEL")]
    verify: Option<PathBuf>,
    /// Directory for the files, or the name of the model, NAME.reduced [default: beside the scene file]
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// Show no progress and no table
    #[arg(long, short)]
    quiet: bool,
}

fn varied(text: &str) -> Result<VariedKey, String> {
    let help = || {
        "write KEY=LEAST..MOST, as phase.1.pressure.1.value=0..5e3, and :COUNT if it is to have more values than its \
                   ends"
        .to_owned()
    };
    let (key, range) = text.split_once('=').ok_or_else(help)?;
    let (range, count) = match range.split_once(':') {
        Some((range, count)) => (range, Some(count.trim().parse().map_err(|_| help())?)),
        None => (range, None),
    };
    let (least, most) = range.split_once("..").ok_or_else(help)?;
    let [least, most] = [least, most].map(|end| end.trim().parse().map_err(|_| help()));
    let key = VariedKey::new(key.trim(), least?, most?);
    Ok(count.map_or(key.clone(), |count| key.count(count)))
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { scene, settings, within, vary, hold_out, most, modes, verify, quiet, .. } =
        arguments;
    let read = |set: &[String]| scene.read_with(set);
    let mut training = Training {
        within: within.0,
        most_unknowns: *most,
        ..Training::varied(&read, vary, *hold_out)?
    };
    settings.apply(&mut training.settings)?;
    if let Some(path) = verify {
        return verified(&training, path, *quiet);
    }
    let path = arguments.path();
    let directory = path.parent().unwrap_or(Path::new("")).to_path_buf();
    Directory::new(directory)?; // which can be written to
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let title = scene.read()?.title;
    let title = scene.title(if title.is_empty() { &stem } else { &title });

    let progress = spinner(*quiet);
    let mut observer = |what: &str| {
        progress.set_message(what.to_owned());
        ControlFlow::Continue(())
    };
    let reduced = match modes {
        true => reduce_by_modes(&training, &mut observer),
        false => reduce(&training, &mut observer),
    };
    progress.finish_and_clear();
    let mut reduced = reduced?;
    if !vary.is_empty() {
        reduced.model = reduced.model.learned_over(&words(vary));
    }
    reduced.model.write(&path, &training.scenes[0])?;
    let beside = |ending: &str| path.with_file_name(format!("{stem}-reduced.{ending}"));
    reduced.write_json(beside("json"))?;
    for ending in ["svg", "png"] {
        reduced.write_chart(beside(ending), &title, within.0)?;
    }
    if !quiet {
        print(&reduced)?;
        let path = path.display();
        print(format_args!("written: {path}, {stem}-reduced.svg, .png and .json beside it"))?;
    }
    match reduced.is_within {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "no model of {most} unknowns at most is within {within}: the best one has {}; it is written all the same. Learn from more \
             runs (--vary KEY=LEAST..MOST:COUNT) or over narrower ranges, or take more unknowns (--most {})",
            reduced.model,
            2 * most
        ))),
    }
}

impl Arguments {
    /// Where the model is written.
    fn path(&self) -> PathBuf {
        let own = self.scene.path.with_extension("reduced");
        match &self.out {
            None => own,
            Some(out) if out.extension().is_some_and(|ending| ending == "reduced") => out.clone(),
            Some(directory) => directory.join(own.file_name().unwrap_or_default()),
        }
    }
}

/// Holds a model against full runs.
fn verified(training: &Training, path: &Path, quiet: bool) -> Result<(), Failure> {
    let scenes = if training.held_out.is_empty() { &training.scenes } else { &training.held_out };
    let model = ReducedModel::read(path, &scenes[0])?;
    print(format_args!("{}: {model}, learned from {}", path.display(), model.learned_from()))?;
    let mut most = 0.0_f64;
    let progress = spinner(quiet);
    for (number, scene) in (1..).zip(scenes) {
        progress.set_message(format!("run {number} of {}", scenes.len()));
        let found = verify(scene, &model, &training.settings)?;
        progress.suspend(|| print(format_args!("run {number}: {found}")))?;
        most = most.max(found.reduced.error);
    }
    progress.finish_and_clear();
    match most <= training.within {
        true => Ok(()),
        false => Err(Failure::failed(format!(
            "the model is not within {}: learn it again, with runs such as these",
            Fraction(training.within)
        ))),
    }
}
