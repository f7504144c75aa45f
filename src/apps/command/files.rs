//! Output files of `run` and `static`, and their directory.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use clap::Args;
use pliant::output::{GrowingTable, Plot, Snapshots, Table, write_animation, write_csv, write_vtk};
use pliant::scene_file::Format;
use pliant::simulate::{Checkpoint, Simulation};
use pliant::{Error, OutputRequest, Sample, SceneFile, Selection, Trajectory};

use super::failure::{BAD_INPUT, Failure, print};

/// Flags that choose what is written.
#[derive(Args)]
pub struct OutputArguments {
    /// Directory for the results [default: out/ and the name of the scene file]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Nodes whose displacements trajectory.csv lists: a set such as "top", or numbers such as 14,15
    #[arg(long, value_name = "NODES", value_parser = selection)]
    track: Option<Selection>,
    /// Formats to write besides trajectory.csv and report.json: svg, html, vtk, plot, png
    #[arg(long, value_delimiter = ',', value_parser = format)]
    formats: Option<Vec<Format>>,
    /// Show no progress and no tables: print warnings, what --accuracy has reached, and the equilibrium that `static` has found
    #[arg(long, short)]
    pub quiet: bool,
}

fn selection(text: &str) -> Result<Selection, String> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    Ok(numbers.map_or_else(|_| Selection::from(text), Selection::from))
}

fn format(name: &str) -> Result<Format, String> {
    let known = Format::ALL.map(Format::name).join(", ");
    let found = Format::ALL.into_iter().find(|format| format.name() == name);
    found.ok_or_else(|| format!("it is one of {known}"))
}

impl OutputArguments {
    /// Overrides the values of the scene file.
    pub fn apply(&self, file: &mut SceneFile) -> Result<(), Failure> {
        if let Some(nodes) = &self.track {
            file.scene.body().mesh().select(nodes)?;
            file.output.track = Some(nodes.clone());
        }
        if let Some(formats) = &self.formats {
            file.output.formats.clone_from(formats);
        }
        Ok(())
    }

    /// The path of the directory for the results of the scene file at `path`.
    pub fn place(&self, path: &Path, suffix: &str) -> PathBuf {
        place(self.out.as_deref(), path, suffix)
    }
}

/// The path of the directory for the results of a scene or study file at `path`: `out` if it is given.
pub fn place(out: Option<&Path>, path: &Path, suffix: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    out.map_or_else(|| Path::new("out").join(format!("{stem}{suffix}")), Path::to_path_buf)
}

/// Removes the `summary` of an earlier run from a directory for results where bad input keeps a run from beginning: a script
/// would take it for that of the run that did not begin. Other results stay.
pub fn without_older(
    path: &Path,
    summary: &str,
    result: Result<(), Failure>,
) -> Result<(), Failure> {
    let Err(Failure { code: BAD_INPUT, message }) = result else { return result };
    let file = path.join(summary);
    // another run that writes there is not disturbed; file systems without locks are accepted
    let is_busy = || {
        let lock = File::open(path).map(|directory| directory.try_lock());
        matches!(lock, Ok(Err(TryLockError::WouldBlock)))
    };
    let message = match file.is_file() && !is_busy() && fs::remove_file(&file).is_ok() {
        true => format!("{message} ({} of an earlier run was removed)", file.display()),
        false => message,
    };
    Err(Failure { code: BAD_INPUT, message })
}

/// A directory for results.
pub struct Directory {
    path: PathBuf,
    /// Names of the files written.
    written: Vec<&'static str>,
    /// The directory itself, locked, once it is claimed.
    lock: Option<File>,
    /// Whether the run continues the one whose results are there.
    pub resumes: bool,
}

/// File from which a run that was ended can be continued.
const CHECKPOINT: &str = "checkpoint.json";
const TABLE: &str = "trajectory.csv";
/// How a result was obtained.
pub const REPORT: &str = "report.json";
/// File from which another scene can start.
const STATE: &str = "state.json";
/// The scene file with cells divided where it helps.
pub const REFINED: &str = "refined.toml";
/// Names of results, in addition to the frames of VTK.
const RESULTS: [&str; 10] = [
    TABLE,
    REFINED,
    CHECKPOINT,
    REPORT,
    STATE,
    "snapshots.svg",
    "animation.html",
    "body.pvd",
    "plot.svg",
    "plot.png",
];

/// Whether `run` or `static` writes files of this name.
fn is_result(name: &str) -> bool {
    let frame = name.strip_prefix("body_").and_then(|rest| rest.strip_suffix(".vtu"));
    frame.is_some_and(|number| number.bytes().all(|digit| digit.is_ascii_digit()))
        || RESULTS.contains(&name)
}

impl Directory {
    /// Checks that `path` can be written to, so that no result is lost; does not create it yet.
    pub fn new(path: PathBuf) -> Result<Self, Failure> {
        let here = Path::new(".");
        let existing = path.ancestors().find(|ancestor| ancestor.exists()).unwrap_or(here);
        match tempfile::tempfile_in(existing) {
            Ok(_) => Ok(Self { path, written: Vec::new(), lock: None, resumes: false }),
            Err(error) => {
                let path = path.display();
                Err(Failure::bad_input(format!("cannot write to {path}: {error}")))
            }
        }
    }

    /// Claims the directory for this run, once: no other run writes there until it has ended, and the results
    /// of an earlier run are deleted, so that they cannot be mixed.
    pub fn claim(&mut self) -> Result<(), Failure> {
        if self.lock.is_some() {
            return Ok(());
        }
        let place = self.path.display();
        let failed = |error| Failure::failed(format!("cannot write to {place}: {error}"));
        fs::create_dir_all(&self.path).map_err(failed)?;
        let lock = File::open(&self.path).map_err(failed)?;
        // file systems without locks are accepted
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            let help = "wait until it has ended, or name another directory by --out";
            return Err(Failure::bad_input(format!("another run writes to {place}: {help}")));
        }
        for entry in fs::read_dir(&self.path).map_err(failed)?.flatten() {
            let goes_on = |name: &str| self.resumes && [TABLE, CHECKPOINT].contains(&name);
            let is_old = |name: &str| is_result(name) && !goes_on(name);
            if entry.file_name().to_str().is_some_and(is_old) {
                fs::remove_file(entry.path()).map_err(failed)?;
            }
        }
        self.lock = Some(lock);
        Ok(())
    }

    /// The path of a file that is kept next to the results.
    pub fn beside(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// A `trajectory.csv` that grows during the run of `simulation`.
    pub fn growing_table(
        &self,
        simulation: &Simulation,
        output: &OutputRequest,
    ) -> Result<GrowingTable, Failure> {
        let (path, track) = (self.path.join(TABLE), output.track.as_ref());
        let table = GrowingTable::new(simulation.trajectory(), path, track)?;
        if !self.resumes {
            return Ok(table);
        }
        let began = simulation.time();
        // the last row of an interrupted run, at the time that it had reached, is kept only if the whole run
        // samples that time
        let kept = match output.sampling().takes(simulation.scene(), began) {
            true => began,
            false => began.next_down(),
        };
        Ok(table.going_on(simulation.trajectory(), kept)?)
    }

    /// The path of the checkpoint that an earlier run has left.
    pub fn checkpoint(&self) -> Result<PathBuf, Failure> {
        let path = self.path.join(CHECKPOINT);
        match path.exists() {
            true => Ok(path),
            false => Err(Failure::bad_input(format!(
                "--resume: there is no {}; a run writes it every ten seconds and when it is interrupted, and takes it \
                 away at its end: run without --resume, or name the directory of the run by --out",
                path.display()
            ))),
        }
    }

    /// Writes a checkpoint.
    pub fn keep(&self, checkpoint: &Checkpoint) -> Result<(), Error> {
        checkpoint.write(self.path.join(CHECKPOINT))
    }

    /// Deletes the checkpoint of a run that has come to its end.
    pub fn forget_checkpoint(&self) {
        // a failure here loses nothing
        let _ = fs::remove_file(self.path.join(CHECKPOINT));
    }

    /// Writes `trajectory.csv`.
    pub fn write_table(
        &mut self,
        trajectory: &Trajectory,
        output: &OutputRequest,
    ) -> Result<(), Failure> {
        self.write(TABLE, |path| write_csv(trajectory, path, output.track.as_ref()))
    }

    /// Writes the last state, from which another scene can start.
    pub fn write_state(&mut self, trajectory: &Trajectory) -> Result<(), Failure> {
        self.write(STATE, |path| trajectory.state(trajectory.last()).write(path))
    }

    /// Writes a file, and notes its name.
    pub fn write(
        &mut self,
        name: &'static str,
        write: impl FnOnce(&Path) -> Result<(), Error>,
    ) -> Result<(), Failure> {
        write(&self.path.join(name))?;
        if !self.written.contains(&name) {
            self.written.push(name);
        }
        Ok(())
    }

    /// Writes the requested pictures and files of a motion.
    pub fn write_formats(
        &mut self,
        trajectory: &Trajectory,
        title: &str,
        output: &OutputRequest,
    ) -> Result<(), Failure> {
        // the table includes the rows of an earlier run that is continued
        let here = self.path.clone();
        let draw = |path: &Path| Plot::new().title(title).write_table(&Table::read(&here)?, path);
        for format in &output.formats {
            match format {
                Format::Svg => self.write("snapshots.svg", |path| {
                    Snapshots::at(times(trajectory)).title(title).write(trajectory, path)
                })?,
                Format::Html => {
                    self.write("animation.html", |path| write_animation(trajectory, path, title))?
                }
                Format::Vtk => {
                    self.write("body.pvd", |_| write_vtk(trajectory, &here, "body"))?;
                }
                Format::Plot => self.write("plot.svg", draw)?,
                Format::Png => self.write("plot.png", draw)?,
                // the table is written in any case
                _ => {}
            }
        }
        Ok(())
    }

    /// Prints the names of the files written.
    pub fn tell(&self) -> Result<(), Failure> {
        print(format_args!("written to {}: {}", self.path.display(), self.written.join(", ")))
    }
}

/// Times of the snapshots (s): the ends of the phases, and some between them, about ten in all, each of another sample.
fn times(trajectory: &Trajectory) -> Vec<f64> {
    let phases = trajectory.scene().phases();
    let parts = (9 / phases.len()).max(1);
    let (mut times, mut start) = (vec![0.0], 0.0);
    for phase in phases {
        let part = (phase.end() - start) / parts as f64;
        times.extend((1..=parts).map(|k| start + k as f64 * part));
        start = phase.end();
    }
    let reached = trajectory.last().time;
    times.retain(|&time| time <= reached);
    if times.last() != Some(&reached) {
        times.push(reached);
    }
    for time in &mut times {
        let from = |sample: &Sample| (sample.time - *time).abs();
        let samples = trajectory.samples().iter();
        let nearest = samples.min_by(|a, b| from(a).total_cmp(&from(b)));
        *time = nearest.map_or(*time, |sample| sample.time);
    }
    times.dedup();
    times
}
