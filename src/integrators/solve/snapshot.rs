//! Where a run stood, and the actions that it performed there.

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

/// What happened to the state, for the way back: each action, or each passage from one side of an event to the
/// other, with the state before it.
pub(super) type Log = Vec<(Act, Snapshot)>;
