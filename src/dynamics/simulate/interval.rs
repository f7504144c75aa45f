//! Intervals: the parts of a phase that are integrated without a restart, and the events that may end them.
//!
//! They end at the end of the phase, at kinks of prescribed signals (so that no pulse is skipped), at located
//! contact events, at points of the path of an obstacle (so that in its frame the motion within a step is one
//! cubic), and where `Method::Auto` changes the method. Each has an integrator of its own, started from the
//! state; the equations are handed on.

use super::angles::Angles;
use super::auto::Plan;
use super::events::Events;
use super::sampling::Schedule;
use crate::dynamics::trajectory::Penetration;

/// A state to go back to.
#[derive(Clone, Default)]
pub(super) struct RollbackPoint {
    pub(super) time: f64,
    pub(super) state: Vec<f64>,
    /// Sampling times of the phase, and samples of the run, that have been taken.
    pub(super) taken: usize,
    pub(super) samples: usize,
    /// Error, rise and scale of the energy balance (J).
    pub(super) energies: [f64; 3],
    /// The angles of sensors then.
    pub(super) angles: Angles,
    /// The least and the largest reading of each sensor until then.
    pub(super) peaks: Vec<[f64; 2]>,
    /// How deep the surface had got into obstacles by then.
    pub(super) penetrations: Vec<Penetration>,
}

/// How an interval ended.
pub(super) enum Ending {
    /// At its end.
    Reached,
    /// At a contact event.
    Event,
    /// Before a step that would have passed through an obstacle, which it met at this time (s).
    Passage(f64),
    /// The energy balance shows that the method cannot be trusted.
    Doubtful { instead: Plan },
    /// Another method is better.
    Better(Plan),
}

/// The result of a step.
pub(super) enum Outcome {
    /// Its size (s).
    Taken(f64),
    /// Its size (s), up to a contact event.
    CutOff(f64),
    /// It was not taken, as it would have passed through an obstacle at this time (s).
    Refused(f64),
}

/// The interval of a phase that is being integrated.
pub(super) struct Interval {
    /// Sampling times of the phase, and the number of those that have been taken.
    pub(super) times: Schedule,
    pub(super) taken: usize,
    /// End of the interval (s): of the phase, or where a force has a break.
    pub(super) stop: f64,
    /// Time (s) at which a step that was not taken would have been inside an obstacle: the interval pauses
    /// there.
    pub(super) inside: Option<f64>,
    /// Steps that the phase may still take.
    pub(super) steps: usize,
    pub(super) events: Events,
}

impl Interval {
    /// The next sampling time (s).
    pub(super) fn next_sample(&self) -> Option<f64> {
        self.times.get(self.taken)
    }

    /// Where it ends, or pauses (s).
    pub(super) fn end(&self) -> f64 {
        self.inside.unwrap_or(self.stop)
    }
}
