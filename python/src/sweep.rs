//! Studies of many runs, as `pliant sweep` computes them.

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use pliant::Error;
use pliant::scene_file::StudyFile;
use pliant::sweep::{PointRun, Results, Row, Runner, Store};
use pyo3::prelude::*;

use crate::errors::raised;

/// A study and the directory of its rows.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Sweep {
    sweep: pliant::sweep::Sweep,
    store: Store,
}

/// Counts rows, and hears Ctrl-C.
struct Watch {
    done: AtomicUsize,
    ended: AtomicBool,
    progress: Option<Py<PyAny>>,
    raised: Mutex<Option<PyErr>>,
}

impl pliant::sweep::Watch for Watch {
    fn ran(&self, _: &PointRun) -> Result<(), Error> {
        Ok(())
    }

    fn has(&self, _: &Row) {
        let done = 1 + self.done.fetch_add(1, Ordering::Relaxed);
        if let Some(progress) = &self.progress
            && let Err(error) = Python::attach(|py| progress.call1(py, (done,)).map(|_| ()))
        {
            self.raised.lock().unwrap_or_else(|lock| lock.into_inner()).get_or_insert(error);
            self.ended.store(true, Ordering::Relaxed);
        }
    }

    fn goes_on(&self) -> bool {
        !self.ended.load(Ordering::Relaxed)
    }
}

#[pymethods]
impl Sweep {
    /// The study of a file, with the directory of its rows; one of more than a million runs only if that `is_meant`.
    #[new]
    fn new(study: PathBuf, directory: PathBuf, is_meant: bool) -> PyResult<Self> {
        let opened = StudyFile::read(study).and_then(|file| {
            let sweep = pliant::sweep::Sweep::new(file, is_meant)?;
            let store = Store::new(directory, &sweep)?;
            Ok(Self { sweep, store })
        });
        opened.map_err(raised)
    }

    /// Checks values of all keys.
    fn check(&self) -> PyResult<()> {
        self.sweep.check().map(|_| ()).map_err(raised)
    }

    fn __len__(&self) -> usize {
        self.sweep.plan().len()
    }

    /// A point: its id and its overrides, as `body.material.young=2e5`.
    fn point(&self, number: usize) -> (String, Vec<String>) {
        let point = self.sweep.plan().point(number);
        let set = point.set();
        (point.id, set)
    }

    /// Numbers of the points that have no row yet; any first part of them is spread over the study.
    fn open(&self) -> Vec<usize> {
        self.store.open(self.sweep.plan(), |_| false)
    }

    /// Computes rows, so many at once (by default one on each core); `progress` is called with how many are done.
    #[pyo3(signature = (numbers, cores = None, progress = None))]
    fn compute(
        &self,
        py: Python<'_>,
        numbers: Vec<usize>,
        cores: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<bool> {
        let (done, ended) = (AtomicUsize::new(0), AtomicBool::new(false));
        let watch = Watch { done, ended, progress, raised: Mutex::new(None) };
        let runner = Runner::new(&self.sweep, &self.store);
        let runner = cores.into_iter().fold(runner, Runner::cores);
        let all = py.detach(|| runner.run(&numbers, |_| false, &watch)).map_err(raised)?;
        match watch.raised.into_inner().unwrap_or_else(|lock| lock.into_inner()) {
            Some(error) => Err(error),
            None => Ok(all),
        }
    }

    /// Writes table.csv, plot.svg and sweep.html of the rows that are there; how many these are, and how many are not.
    fn gather(&self) -> PyResult<(usize, usize)> {
        let gathered = || {
            let units = self.sweep.check_first()?;
            self.store.create()?;
            self.store.tidy();
            let results = Results::gather(&self.sweep, &self.store);
            results.write(&self.sweep, &self.store, &units)?;
            Ok::<_, Error>((results.rows.len(), results.missing))
        };
        gathered().map_err(raised)
    }
}
