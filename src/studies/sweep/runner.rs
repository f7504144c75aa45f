//! Runs many points of a study, one on each core.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use rayon::ThreadPoolBuilder;

use super::row::Row;
use super::run::{PointRun, Sweep};
use super::store::Store;
use crate::base::input::{InputError, check_memory, free_memory};
use crate::dynamics::error::Error;
use crate::elements::mesh::BYTES_PER_NODE;

/// Runs points of a study and keeps their rows.
#[derive(Debug)]
pub struct Runner<'a> {
    sweep: &'a Sweep,
    store: &'a Store,
    cores: usize,
}

/// Callbacks of a program while points are run, on the threads that run them.
pub trait Watch: Sync {
    /// Called when a point was run, before its row is written: to keep its whole output.
    ///
    /// # Errors
    /// An error that ends the study.
    fn ran(&self, run: &PointRun) -> Result<(), Error>;

    /// Called when a row is available, from any process.
    fn has(&self, row: &Row);

    /// Whether to continue; called after each step.
    fn goes_on(&self) -> bool {
        true
    }
}

/// Bytes that a sample takes for each displacement component.
const SAMPLE_BYTES: f64 = 16.0;
/// Time between two looks at rows that other processes compute.
const PATIENCE: Duration = Duration::from_millis(100);

impl<'a> Runner<'a> {
    /// Runs points of `sweep` whose rows are kept in `store`, one on each of all cores.
    pub fn new(sweep: &'a Sweep, store: &'a Store) -> Self {
        Self { sweep, store, cores: thread::available_parallelism().map_or(1, Into::into) }
    }

    /// Number of points that are run at once. Default: the number of cores.
    #[must_use]
    pub fn cores(mut self, count: usize) -> Self {
        self.cores = count;
        self
    }

    /// Number of points that are run at once: no more than fit into memory, as estimated beforehand from
    /// the first and the last point.
    ///
    /// # Errors
    /// Not even one fits; no core.
    pub fn at_once(&self) -> Result<usize, Error> {
        if self.cores == 0 {
            return Err(InputError::new("cores", 0, "one point is run at once at least").into());
        }
        let bytes = self.bytes();
        check_memory(
            "scene of the study",
            "one run".into(),
            bytes,
            "take a coarser mesh, or sample less often",
        )?;
        let fit = (free_memory() / bytes.max(1.0)) as usize;
        Ok(self.cores.min(fit).max(1))
    }

    /// Memory (bytes) that a run takes at least, as far as that is known beforehand.
    pub fn bytes(&self) -> f64 {
        let plan = self.sweep.plan();
        let ends = [0, plan.len() - 1].map(|number| self.sweep.scene(&plan.point(number)));
        let bytes = ends.into_iter().flatten().map(|file| {
            let body = file.scene.body();
            let every = file.output.step.map_or(0.0, |step| file.scene.end() / step);
            let times = file.output.times.as_ref().map_or(every, |times| times.len() as f64);
            let samples = if self.sweep.file().is_static { 0.0 } else { times };
            BYTES_PER_NODE * body.mesh().node_count() as f64
                + SAMPLE_BYTES * samples * body.dofs() as f64
        });
        bytes.fold(0.0, f64::max)
    }

    /// Runs the points with these numbers, whose rows are not there yet, and waits for those that other processes are
    /// running. Points for which `again` is true are run although their row is there, which stays as it is.
    ///
    /// Returns whether all rows are there; they are not if the watch has ended it.
    ///
    /// # Errors
    /// [`Error::Output`] if a row cannot be written; errors of the watch. Runs that fail are rows, not errors.
    pub fn run(
        &self,
        numbers: &[usize],
        again: impl Fn(&Row) -> bool + Sync,
        watch: &dyn Watch,
    ) -> Result<bool, Error> {
        self.store.create()?;
        let (next, stops) = (AtomicUsize::new(0), AtomicBool::new(false));
        let (others, failure) = (Mutex::new(Vec::new()), Mutex::new(None));
        let goes_on = || watch.goes_on() && !stops.load(Ordering::Relaxed);
        let work = || {
            let one = ThreadPoolBuilder::new().num_threads(1).build();
            while goes_on() {
                let Some(&number) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                let point = || self.point(number, &again, watch, &goes_on);
                // a run that would use several cores uses one
                let done = one.as_ref().map_or_else(|_| point(), |one| one.install(point));
                match done {
                    Ok(true) => {}
                    Ok(false) => push(&others, number),
                    Err(error) => {
                        stops.store(true, Ordering::Relaxed);
                        *failure.lock().unwrap_or_else(|lock| lock.into_inner()) = Some(error);
                    }
                }
            }
        };
        let at_once = self.at_once()?.min(numbers.len());
        thread::scope(|scope| (0..at_once).for_each(|_| _ = scope.spawn(work)));
        let failure = failure.into_inner().unwrap_or_else(|lock| lock.into_inner());
        failure.map_or(Ok(()), Err)?;
        let others = others.into_inner().unwrap_or_else(|lock| lock.into_inner());
        self.wait_for(others, &again, watch)?;
        Ok(watch.goes_on())
    }

    /// Waits for rows that other processes are computing, and computes those that they leave.
    fn wait_for(
        &self,
        mut numbers: Vec<usize>,
        again: &(impl Fn(&Row) -> bool + Sync),
        watch: &dyn Watch,
    ) -> Result<(), Error> {
        while !numbers.is_empty() && watch.goes_on() {
            let mut left = Vec::new();
            for number in numbers {
                if !self.point(number, again, watch, &|| watch.goes_on())? {
                    left.push(number);
                }
            }
            numbers = left;
            if !numbers.is_empty() {
                thread::sleep(PATIENCE);
            }
        }
        Ok(())
    }

    /// Runs a point if its row is not there. Returns false if another process is at it, or the run was ended.
    fn point(
        &self,
        number: usize,
        again: &(impl Fn(&Row) -> bool + Sync),
        watch: &dyn Watch,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<bool, Error> {
        let point = self.sweep.plan().point(number);
        let there = |row: Row| {
            watch.has(&row);
            Ok(true)
        };
        if let Some(row) = self.store.row(&point.id).filter(|row| !again(row)) {
            return there(row);
        }
        let Some(_claim) = self.store.claim(&point.id)? else { return Ok(false) };
        // another process may have been faster
        let known = self.store.row(&point.id);
        if let Some(row) = known.clone().filter(|row| !again(row)) {
            return there(row);
        }
        let mut observer = |_: &crate::Simulation| match goes_on() {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        let Some(run) = self.sweep.run(&point, &mut observer) else { return Ok(false) };
        watch.ran(&run)?;
        match known {
            Some(row) => there(row),
            None => {
                self.store.write(&run.row)?;
                there(run.row)
            }
        }
    }
}

fn push(list: &Mutex<Vec<usize>>, number: usize) {
    list.lock().unwrap_or_else(|lock| lock.into_inner()).push(number);
}
