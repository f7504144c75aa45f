//! The state of a run at a time, the actions that it performed there, and the sides of its events.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A time, the state there, its time derivative (of a DAE), the parameters of the equations, and the sides of
/// the events that the solution is on.
#[derive(Clone)]
pub(super) struct Snapshot {
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    pub(super) yp: Vec<f64>,
    pub(super) p: Vec<f64>,
    pub(super) sides: Vec<f64>,
}

/// The action of an event, at a root or at a tick of its clock, or of a break, by its number among those that were
/// given.
#[derive(Clone, Copy)]
pub(super) enum Act {
    Event(usize),
    Tick(usize),
    Break(usize),
}

impl Act {
    /// Whether the state tells its time.
    pub(super) fn is_at_root(self) -> bool {
        matches!(self, Self::Event(_))
    }
}

/// Changes of the state along the run, for the way back: each action, or each passage from one side of an event to the
/// other, with the state before it.
pub(super) type Log = Vec<(Act, Snapshot)>;

/// The sides that the solution is on, as a run or its way back tells them to the equations.
pub(super) struct Sides {
    /// The signs of the functions of all events there; 0 where the equations are used as they are.
    pub(super) signs: Vec<f64>,
    /// Slopes of the state at times nearby: surfaces are crossed along them.
    pub(super) flows: Vec<(f64, Vec<f64>)>,
    /// The parameters; the equations are also asked for others nearby, for differences.
    pub(super) p: Vec<f64>,
}

/// Sides that a run, or its way back, shares with its equations.
#[derive(Clone)]
pub(super) struct SharedSides(Arc<Mutex<Sides>>);

impl SharedSides {
    pub(super) fn new(sides: Sides) -> Self {
        Self(Arc::new(Mutex::new(sides)))
    }

    /// The sides; whoever holds them calls no equations meanwhile.
    pub(super) fn lock(&self) -> MutexGuard<'_, Sides> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
