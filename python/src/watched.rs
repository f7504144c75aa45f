//! A simulation that functions of Python drive, also from the actions of the events that it meets.

use std::mem::{replace, swap};
use std::ops::{ControlFlow, Deref, DerefMut};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use numpy::PyArray2;
use pliant::simulate::Direction;
use pliant::{Error, View};
use pyo3::exceptions::PyRuntimeError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::arrays::vectors;
use crate::errors::raised;

/// A simulation, or a stand-in while it advances with events: during each of their actions the simulation is back.
pub struct Slot {
    simulation: pliant::Simulation,
    is_away: bool,
    stand_in: Option<pliant::Simulation>,
}

impl Deref for Slot {
    type Target = pliant::Simulation;

    fn deref(&self) -> &Self::Target {
        &self.simulation
    }
}

impl DerefMut for Slot {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.simulation
    }
}

/// Functions of events with their actions, and the first exception of one of them.
#[derive(Default)]
struct Functions {
    pairs: Vec<[Py<PyAny>; 2]>,
    raised: Option<PyErr>,
}

/// A simulation with the events that it watches.
pub struct Watched {
    slot: Arc<Mutex<Slot>>,
    functions: Arc<Mutex<Functions>>,
}

/// Locks a mutex that may be in use for a moment. A state after a panic is accepted: the simulation reports its own
/// failures.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Watched {
    pub fn new(simulation: pliant::Simulation) -> Self {
        let slot = Slot { simulation, is_away: false, stand_in: None };
        Self { slot: Arc::new(Mutex::new(slot)), functions: Arc::default() }
    }

    pub fn lock(&self) -> PyResult<MutexGuard<'_, Slot>> {
        let slot = match self.slot.try_lock() {
            Ok(slot) => Some(slot),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        };
        slot.filter(|slot| !slot.is_away).ok_or_else(|| {
            PyRuntimeError::new_err(
                "the simulation is at work, in another thread or in the function that it calls: fork() one for each thread",
            )
        })
    }

    /// Result of `f` on the simulation, with Python detached meanwhile.
    pub fn detached<T: Send>(
        &self,
        py: Python<'_>,
        f: impl FnOnce(&mut pliant::Simulation) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let mut slot = self.lock()?;
        let simulation = &mut slot.simulation;
        py.detach(|| f(simulation)).map_err(raised)
    }

    /// Result of `f` on the simulation, which may meet events with Python functions meanwhile.
    pub fn advancing<T: Send>(
        &self,
        py: Python<'_>,
        f: impl FnOnce(&mut pliant::Simulation) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        if locked(&self.functions).pairs.is_empty() {
            return self.detached(py, f);
        }
        let mut simulation = {
            let mut slot = self.lock()?;
            let stand_in = match slot.stand_in.take() {
                Some(stand_in) => stand_in,
                None => slot.fork().map_err(raised)?,
            };
            slot.is_away = true;
            replace(&mut slot.simulation, stand_in)
        };
        // without Python, which another thread may wait for that has the lock
        let outcome = py.detach(|| {
            let outcome = f(&mut simulation);
            let mut slot = locked(&self.slot);
            slot.is_away = false;
            slot.stand_in = Some(replace(&mut slot.simulation, simulation));
            outcome
        });
        match locked(&self.functions).raised.take() {
            Some(error) => Err(error),
            None => outcome.map_err(raised),
        }
    }

    /// Calls `action()` where `event(time, positions, velocities)` changes its sign; one that returns True stops the advance.
    pub fn when(&self, event: Py<PyAny>, action: Py<PyAny>, direction: Direction) -> PyResult<()> {
        let mut slot = self.lock()?;
        let number = {
            let mut functions = locked(&self.functions);
            functions.pairs.push([event, action]);
            functions.pairs.len() - 1
        };
        // the simulation would keep itself by what it keeps alive
        let own = Arc::downgrade(&self.slot);
        let (events, actions) = (self.functions.clone(), self.functions.clone());
        let watched = move |view: &View<'_>| {
            Python::attach(|py| match function(py, &events, number, 0) {
                Some(event) => value(py, &event, view).unwrap_or_else(|error| {
                    locked(&events).raised.get_or_insert(error);
                    f64::NAN
                }),
                None => f64::NAN,
            })
        };
        slot.when(watched, direction, move |simulation| {
            let Some(own) = own.upgrade() else { return Ok(ControlFlow::Break(())) };
            let change = |simulation: &mut pliant::Simulation, is_away: bool| {
                let mut slot = locked(&own);
                swap(&mut slot.simulation, simulation);
                slot.is_away = is_away;
            };
            change(simulation, false);
            let stops = Python::attach(|py| {
                let Some(action) = function(py, &actions, number, 1) else { return true };
                match action.call0(py) {
                    Ok(returned) => returned.extract(py).unwrap_or(false),
                    Err(error) => {
                        locked(&actions).raised.get_or_insert(error);
                        true
                    }
                }
            });
            change(simulation, true);
            Ok(if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        });
        Ok(())
    }

    /// Visits the kept Python functions for the garbage collector. Locked ones are in use.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        let Ok(functions) = self.functions.try_lock() else { return Ok(()) };
        functions.pairs.iter().flatten().try_for_each(|function| visit.call(function))
    }

    /// Releases the kept Python functions.
    pub fn clear(&self) {
        let pairs = std::mem::take(&mut locked(&self.functions).pairs);
        drop(pairs);
    }
}

/// The event (0) or action (1) of this number, unless a function has raised an exception already.
fn function(
    py: Python<'_>,
    functions: &Mutex<Functions>,
    number: usize,
    which: usize,
) -> Option<Py<PyAny>> {
    let functions = locked(functions);
    let pair = functions.pairs.get(number).filter(|_| functions.raised.is_none())?;
    Some(pair[which].clone_ref(py))
}

/// The value of an event, a function of time (s), positions (m) and velocities (m/s).
pub fn value(py: Python<'_>, event: &Py<PyAny>, view: &View<'_>) -> PyResult<f64> {
    let velocities = vectors(py, view.velocities().to_vec(), view.body().dimension())?;
    event.call1(py, (view.time(), positions(py, view)?, velocities))?.extract(py)
}

/// Places of all nodes (m): [node, axis].
pub fn positions<'py>(py: Python<'py>, view: &View<'_>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let natural = view.body().mesh().positions().iter();
    let places = natural.zip(view.displacements()).map(|(x, u)| x + u).collect();
    vectors(py, places, view.body().dimension())
}
