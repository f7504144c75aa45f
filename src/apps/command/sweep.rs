//! `pliant sweep`

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::PathBuf;
use std::process;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use clap::Args;
use indicatif::ProgressBar;
use pliant::scene_file::{Format, StudyFile, Written};
use pliant::sweep::{
    Condition, Outcome, PointRun, Results, Row, RowVerdict, Runner, Store, Sweep, Watch,
};
use pliant::{Error, Fraction, SceneFile, SceneReader};

use super::engine::{Engine, TaskArray};
use super::failure::{Failure, print};
use super::files::{Directory, place, without_older};
use super::progress::{KILLED, rows_bar};
use super::run::keep;
use super::statics;
use super::task::Tasks;

/// Run a scene, or find its equilibrium, for many values of its keys
///
/// The study file names the scene, the keys with their values (lists, ranges, a Latin hypercube, Sobol's sequence, the rows of a table), and the
/// quantities that are kept. Writes table.csv (a row for each run: keys, quantities, verdict, warnings, times), plot.svg, and
/// sweep.html, on which a click on a point shows its run. Runs that fail are rows. Rows that are there are not computed again, so that a
/// study that was ended, by Ctrl-C or a kill, goes on when the command is given again, and any number of processes may compute one study
/// side by side.
#[derive(Args)]
pub struct Arguments {
    /// Study file
    #[arg(value_name = "STUDY")]
    study: PathBuf,
    /// A value for a key of the scene that all runs have, as solver.rtol=1e-4; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Run each point with tighter and tighter tolerances, until two runs agree to this part: 1% or 0.01
    #[arg(long, value_name = "PART")]
    accuracy: Option<Fraction>,
    /// Directory for the rows [default: out/ and the name of the study file, with -sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Points that are run at once [default: one on each core, as far as they fit into memory]
    #[arg(long, value_name = "COUNT")]
    cores: Option<usize>,
    /// Compute so many rows at most, spread over the study; others can follow. An engine computes whole tasks
    #[arg(long, value_name = "ROWS")]
    limit: Option<usize>,
    /// Keep the whole output of the runs whose row fulfils this: all, com.y:max > 0.5, verdict = doubtful, warning =
    /// strain, several of them with " and "
    #[arg(long, value_name = "CONDITION")]
    keep: Option<Condition>,
    /// Who computes the rows
    #[arg(long, value_enum, value_name = "ENGINE", default_value = "local")]
    engine: Engine,
    /// Rows in one task of an engine [default: 1 for up to a thousand rows; a thousand tasks of more]
    #[arg(long, value_name = "ROWS")]
    batch: Option<usize>,
    /// Compute the rows of this task alone, from 0, and gather nothing: a number, a range as 0-9, or the number in an environment
    /// variable, as env:HQ_TASK_ID
    #[arg(long, value_name = "TASK")]
    task: Option<Tasks>,
    /// Compute nothing: gather the rows that are there
    #[arg(long, conflicts_with = "task")]
    gather: bool,
    /// Compute and write nothing: print the points as a table (CSV)
    #[arg(long, conflicts_with_all = ["task", "gather"])]
    plan: bool,
    /// Run more than a million points
    #[arg(long)]
    yes: bool,
    /// Show no progress
    #[arg(long, short)]
    quiet: bool,
}

/// Default for the largest number of tasks of an array: the usual limit of Slurm.
const MOST_TASKS: usize = 1000;

pub fn run(arguments: &Arguments, reader: SceneReader) -> Result<(), Failure> {
    let place = place(arguments.out.as_deref(), &arguments.study, "-sweep");
    let (sweep, batch, units) = match begin(arguments, reader) {
        Ok(begun) => begun,
        // these write no table
        Err(failure) if arguments.plan || arguments.task.is_some() => return Err(failure),
        Err(failure) => return without_older(&place, "table.csv", Err(failure)),
    };
    if arguments.plan {
        return tell_plan(&sweep);
    }
    Directory::new(place.clone())?; // which can be written to
    let store = Store::new(place, &sweep)?;
    let study = Study { arguments, sweep: &sweep, store: &store };
    if let Some(task) = &arguments.task {
        let rows = task
            .rows(batch, sweep.plan().len())
            .map_err(|error| Failure::bad_input(format!("--task: {error}")))?;
        let numbers: Vec<usize> = rows.collect();
        return study.compute(&numbers);
    }
    let outcome = match arguments.gather {
        true => store.create().map_err(Failure::from).map(|()| false),
        false => study.all(batch),
    };
    if let Ok(true) = outcome {
        return Ok(()); // nothing is there to be gathered yet
    }
    study.gather(&units)?;
    outcome.map(|_| ())
}

/// The study, the number of rows in a task and the units of the quantities, which a plan does without.
fn begin(
    arguments: &Arguments,
    reader: SceneReader,
) -> Result<(Sweep, usize, Vec<&'static str>), Failure> {
    let sweep = read(arguments, reader)?;
    let batch = arguments.batch.unwrap_or(sweep.plan().len().div_ceil(MOST_TASKS));
    if batch == 0 {
        return Err(Failure::bad_input("--batch = 0: a task has one row at least"));
    }
    let units = match (arguments.plan, &arguments.task) {
        (true, _) => Vec::new(),
        // what has submitted the task has checked all values
        (false, Some(_)) => sweep.check_first()?,
        (false, None) => sweep.check()?,
    };
    Ok((sweep, batch, units))
}

/// The study, with flags in place of values of the file.
fn read(arguments: &Arguments, reader: SceneReader) -> Result<Sweep, Failure> {
    let mut file = StudyFile::read(&arguments.study)?;
    let flags = arguments.set.iter();
    file.set.extend(flags.map(|set| Written { text: set.clone(), line: 0 }));
    file.accuracy = arguments.accuracy.or(file.accuracy);
    let sweep = Sweep::new(file, arguments.yes)?.read_by(reader);
    if let Some(condition) = &arguments.keep {
        condition.check(&sweep)?;
    }
    Ok(sweep)
}

/// Prints the points.
fn tell_plan(sweep: &Sweep) -> Result<(), Failure> {
    let failed = |error: csv::Error| match error.into() {
        error if io::Error::kind(&error) == io::ErrorKind::BrokenPipe => Ok(()),
        error => Err(Failure::failed(format!("cannot write to the standard output: {error}"))),
    };
    let mut table = csv::Writer::from_writer(io::stdout().lock());
    let keys = sweep.plan().keys().iter().map(String::as_str);
    if let Err(error) = table.write_record(["id"].into_iter().chain(keys)) {
        return failed(error);
    }
    for point in sweep.plan().points() {
        let cells = point.values.iter().map(|value| value.cell());
        if let Err(error) = table.write_record([point.id.clone()].into_iter().chain(cells)) {
            return failed(error);
        }
    }
    table.flush().or_else(|error| failed(error.into()))
}

struct Study<'a> {
    arguments: &'a Arguments,
    sweep: &'a Sweep,
    store: &'a Store,
}

impl Study<'_> {
    /// Computes the missing rows. Returns whether that is left to a job that has still to be started.
    fn all(&self, batch: usize) -> Result<bool, Failure> {
        let Arguments { limit, engine, .. } = self.arguments;
        let plan = self.sweep.plan();
        let again = |row: &Row| self.is_wanted_again(row);
        let mut numbers = self.store.open(plan, again);
        let most = limit.unwrap_or(usize::MAX);
        if *engine == Engine::Local {
            numbers.truncate(most);
            return self.compute(&numbers).map(|()| false);
        }
        // rows are in an order that spreads them over the study, and so are the first tasks met
        let mut tasks = BTreeSet::new();
        for number in &numbers {
            if tasks.len() < most.div_ceil(batch) {
                tasks.insert(number / batch);
            }
        }
        if tasks.is_empty() {
            return Ok(false);
        }
        numbers.retain(|number| tasks.contains(&(number / batch)));
        let tasks: Vec<usize> = tasks.into_iter().collect();
        self.store.create()?;
        let flags = self.flags();
        let (study, directory) = (&self.arguments.study, self.store.path());
        let array = TaskArray { study, directory, tasks: &tasks, batch, flags: &flags };
        if *engine == Engine::Slurm {
            return array.write_script(Runner::new(self.sweep, self.store).bytes()).map(|()| true);
        }
        let is_open = |number: &usize| self.store.is_open(&plan.point(*number), again);
        let bar = rows_bar(numbers.len(), self.arguments.quiet);
        array.submit(&mut || {
            numbers.retain(is_open);
            bar.set_position(bar.length().unwrap_or(0).saturating_sub(numbers.len() as u64));
        })?;
        bar.finish_and_clear();
        numbers.retain(is_open);
        match numbers.len() {
            0 => Ok(false),
            missing => Err(Failure::failed(format!(
                "the job has ended, and {missing} rows are not there: do its workers see {}?",
                directory.display()
            ))),
        }
    }

    /// The flags of this command that each task has, too.
    fn flags(&self) -> Vec<String> {
        let Arguments { set, accuracy, yes, .. } = self.arguments;
        let mut flags: Vec<String> =
            set.iter().flat_map(|set| ["--set".into(), set.clone()]).collect();
        flags.extend(accuracy.iter().map(|part| format!("--accuracy={}", part.0)));
        flags.extend(self.arguments.keep.iter().map(|keep| format!("--keep={keep}")));
        flags.extend(yes.then(|| "--yes".into()));
        flags
    }

    /// Whether the whole output of a run is to be kept and is not there.
    fn is_wanted_again(&self, row: &Row) -> bool {
        let keep = self.arguments.keep.as_ref();
        keep.is_some_and(|keep| keep.holds(row))
            && row.reached.is_some()
            && !self.store.is_kept(&row.id)
    }

    /// Computes these rows on the cores of this machine.
    fn compute(&self, numbers: &[usize]) -> Result<(), Failure> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let asked = interrupted.clone();
        let stop = move || {
            if asked.swap(true, Ordering::Relaxed) {
                process::exit(KILLED); // no row is lost: those under way begin anew
            }
        };
        ctrlc::set_handler(stop)
            .map_err(|error| Failure::failed(format!("cannot watch for Ctrl-C: {error}")))?;
        let runner = Runner::new(self.sweep, self.store);
        let runner = match self.arguments.cores {
            Some(cores) => runner.cores(cores),
            None if self.arguments.task.is_some() => runner.cores(1),
            None => runner,
        };
        let watch = RowsWatch {
            study: self,
            bar: rows_bar(numbers.len(), self.arguments.quiet),
            failed: AtomicUsize::new(0),
            refused: Mutex::new(None),
            interrupted,
        };
        let done = runner.run(numbers, |row| self.is_wanted_again(row), &watch);
        watch.bar.finish_and_clear();
        let refused = watch.refused.into_inner().unwrap_or_else(|lock| lock.into_inner());
        match (done, refused) {
            (_, Some(failure)) => Err(failure),
            (Err(error), None) => Err(error.into()),
            (Ok(true), None) => Ok(()),
            (Ok(false), None) => {
                Err(Failure::failed("interrupted: give the command again to continue"))
            }
        }
    }

    /// Writes the table, the plot and the page of the rows that are there.
    fn gather(&self, units: &[&'static str]) -> Result<(), Failure> {
        self.store.tidy();
        let results = Results::gather(self.sweep, self.store);
        results.write(self.sweep, self.store, units)?;
        let succeeded = results.rows.iter().any(|row| row.verdict != RowVerdict::Failed);
        if !self.arguments.quiet {
            self.summary(&results)?;
            let place = self.store.path().display();
            print(format_args!("written to {place}: table.csv, plot.svg, sweep.html"))?;
        }
        match succeeded || results.rows.is_empty() {
            true => Ok(()),
            false => Err(Failure::failed(format!(
                "no run succeeded; the first one: {}",
                results.rows[0].failure.as_deref().unwrap_or_default()
            ))),
        }
    }

    fn summary(&self, results: &Results) -> Result<(), Failure> {
        let count = |verdict| results.rows.iter().filter(|row| row.verdict == verdict).count();
        let [fine, doubtful, failed] =
            [RowVerdict::Fine, RowVerdict::Doubtful, RowVerdict::Failed].map(count);
        let Results { rows, missing } = results;
        let left =
            if *missing > 0 { format!("; {missing} are not there yet") } else { String::new() };
        print(format_args!(
            "{} rows: {fine} fine, {doubtful} doubtful, {failed} failed{left}",
            rows.len()
        ))?;
        let mut warnings: BTreeMap<&str, usize> = BTreeMap::new();
        rows.iter()
            .flat_map(|row| &row.warnings)
            .for_each(|name| *warnings.entry(name).or_default() += 1);
        let told: Vec<String> =
            warnings.iter().map(|(name, count)| format!("{name} ({count})")).collect();
        if !told.is_empty() {
            print(format_args!("warnings: {}", told.join(", ")))?;
        }
        if let Some(why) = rows.iter().find_map(|row| row.failure.as_ref()) {
            print(format_args!("the first failure: {why}"))?;
        }
        Ok(())
    }

    /// Keeps the whole output of a run.
    fn keep_output(&self, run: &PointRun) -> Result<(), Failure> {
        let (Some(file), Some(outcome)) = (&run.file, &run.outcome) else { return Ok(()) };
        let SceneFile { title, output: request, .. } = file;
        let mut request = request.clone();
        // the animation comes last: with it the output is complete
        request.formats.retain(|format| *format != Format::Html);
        request.formats.push(Format::Html);
        let values: Vec<String> =
            run.row.keys.iter().map(|(key, value)| format!("{key}={value}")).collect();
        let title = format!("{title} ({})", values.join(", "));
        let mut directory = Directory::new(self.store.run_directory(&run.row.id))?;
        directory.claim()?;
        match outcome {
            Outcome::Motion(motion) => {
                let (motion, trajectory) = (motion.as_ref(), outcome.trajectory());
                keep(motion.map_err(|failure| &**failure), &mut directory, |directory| {
                    directory.write_table(trajectory, &request)
                })?;
                // plots are of what was written
                directory.write_formats(trajectory, &title, &request)
            }
            Outcome::Equilibrium(found) => {
                let found = found.as_ref().map_err(|failure| &**failure);
                let is_curve = file.statics.options.is_curve();
                statics::keep(found, is_curve, &title, &request, &mut directory)
            }
        }
    }
}

/// Shows how many rows are there, keeps outputs, and ends the study after Ctrl-C.
struct RowsWatch<'a> {
    study: &'a Study<'a>,
    bar: ProgressBar,
    failed: AtomicUsize,
    refused: Mutex<Option<Failure>>,
    interrupted: Arc<AtomicBool>,
}

impl Watch for RowsWatch<'_> {
    fn ran(&self, run: &PointRun) -> Result<(), Error> {
        let keep = self.study.arguments.keep.as_ref();
        if keep.is_some_and(|keep| keep.holds(&run.row))
            && let Err(failure) = self.study.keep_output(run)
        {
            let message = failure.message.clone();
            *self.refused.lock().unwrap_or_else(|lock| lock.into_inner()) = Some(failure);
            let path = self.study.store.run_directory(&run.row.id);
            return Err(Error::Output { path, source: io::Error::other(message) });
        }
        Ok(())
    }

    fn has(&self, row: &Row) {
        if row.verdict == RowVerdict::Failed {
            self.failed.fetch_add(1, Ordering::Relaxed);
        }
        self.bar.inc(1);
        self.bar.set_message(format!("{} failed", self.failed.load(Ordering::Relaxed)));
    }

    fn goes_on(&self) -> bool {
        !self.interrupted.load(Ordering::Relaxed)
    }
}
