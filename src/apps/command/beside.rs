//! `pliant beside`

use std::path::{Path, PathBuf};

use clap::Args;
use pliant::output::join_animations;

use super::failure::{Failure, print};

/// Put the animations of several runs side by side in one page
///
/// Takes the animation.html of each run (format html of `run` and `static`), and computes nothing again. One clock plays
/// all of them, in the same part of space, as large, and with the same colours for the same values; charts have the lines of all.
#[derive(Args)]
pub struct Arguments {
    /// Directories of the results, or animations
    #[arg(value_name = "OUT", required = true, num_args = 2..)]
    results: Vec<PathBuf>,
    /// Captions, one for each [default: the names of the directories]
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    names: Option<Vec<String>>,
    /// Title of the page [default: the names]
    #[arg(long, default_value = "", hide_default_value = true)]
    title: String,
    /// The page that is written
    #[arg(long, value_name = "FILE", default_value = "out/beside.html")]
    out: PathBuf,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { results, names, title, out } = arguments;
    let pages = results.iter().map(|path| match path.is_dir() {
        true => path.join("animation.html"),
        false => path.clone(),
    });
    let pages: Vec<PathBuf> = pages.collect();
    let names = names.clone().unwrap_or_else(|| pages.iter().map(|page| name(page)).collect());
    if names.len() != pages.len() {
        return Err(Failure::bad_input(format!(
            "--names: {} names for {} animations: give one for each, with commas between them",
            names.len(),
            pages.len()
        )));
    }
    if let Some(page) = pages.iter().find(|page| !page.exists()) {
        return Err(Failure::bad_input(format!(
            "there is no {}: run its scene with --formats html first",
            page.display()
        )));
    }
    let named: Vec<(&str, &PathBuf)> = names.iter().map(String::as_str).zip(&pages).collect();
    join_animations(&named, out, title)?;
    print(format_args!("written to {}", out.display()))
}

/// The name of an animation: that of its directory, if it has none of its own.
fn name(page: &Path) -> String {
    let directory = page.parent().and_then(Path::file_name);
    let own = page.file_stem().filter(|stem| *stem != "animation");
    own.or(directory).map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
