//! Runs that ended early: the reason, and the solution until then.

use std::{error, fmt, time::Duration};

use thiserror::Error;

use super::solution::Solution;
use crate::base::input::{InputError, debug_in_words};
use crate::integrators::common;

debug_in_words!(Error, Stopped, Reason);

/// An error of [`solve`](super::solve) or of a member of an [`ensemble`](super::ensemble). It is shown in words, also by [`Debug`](std::fmt::Debug).
#[derive(Error)]
#[non_exhaustive]
pub enum Error {
    /// An input that cannot be used; nothing was computed.
    #[error(transparent)]
    Input(#[from] InputError),

    /// The run stopped before the end of the span; the solution until then is included.
    #[error(transparent)]
    Stopped(Box<Stopped>),

    /// A member of an [`ensemble`](super::ensemble) panicked; its message.
    #[error("the member panicked: {0}")]
    Panicked(String),
}

/// A run that stopped: the reason, and the solution until then.
pub struct Stopped {
    /// Why.
    pub reason: Reason,
    /// The solution so far.
    pub solution: Solution,
}

/// The reason why a run stopped, or did not start.
#[non_exhaustive]
pub enum Reason {
    /// A value that was handed in cannot be used.
    Input(InputError),
    /// The integrator failed.
    Failed(common::Error),
    /// [`Options::max_steps`](super::Options::max_steps) steps were taken.
    Steps(u64),
    /// [`Options::max_evaluations`](super::Options::max_evaluations) is reached, after this number of
    /// evaluations.
    Evaluations(u64),
    /// [`Options::max_wall_time`](super::Options::max_wall_time) has passed.
    WallTime(Duration),
    /// It was cancelled by [`Problem::cancelled_by`](super::Problem::cancelled_by) or the observer.
    Cancelled,
    /// An event function is not a number.
    Event {
        /// Which event, in the order of [`Problem::event`](super::Problem::event).
        event: usize,
        /// Time.
        t: f64,
        /// Its value.
        value: f64,
    },
    /// The equations switch where no event is, and derivatives across that are wrong.
    Switch {
        /// Time.
        t: f64,
        /// Which equation jumps.
        equation: usize,
        /// Its right-hand side, or its residual, before.
        before: f64,
        /// And after.
        after: f64,
    },
    /// An event accumulates: its action turns the solution back ever faster.
    Accumulation {
        /// Which event, in the order of [`Problem::event`](super::Problem::event).
        event: usize,
        /// Time of the last one.
        t: f64,
        /// How many there were.
        count: u32,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) => error.fmt(f),
            Self::Failed(error) => error.fmt(f),
            Self::Steps(steps) => {
                write!(f, "{steps} steps taken; raise max_steps if the step size is reasonable")
            }
            Self::Evaluations(count) => {
                write!(f, "{count} evaluations made; raise max_evaluations")
            }
            Self::WallTime(time) => write!(f, "it took {time:.1?}; raise max_wall_time"),
            Self::Cancelled => f.write_str("it was cancelled"),
            Self::Event { event, t, value } => {
                write!(
                    f,
                    "the function of event {event} is {value} at t = {t:?}; it has to be a number"
                )
            }
            Self::Switch { t, equation, before, after } => write!(
                f,
                "equation {equation} jumps at t = {t:?} from {before:.4e} to {after:.4e} where no event is, at a time that \
                 depends on unknowns or parameters: derivatives need the condition that it switches by as the \
                 function of an Event"
            ),
            Self::Accumulation { event, t, count } => write!(
                f,
                "event {event} accumulates at t = {t:?}: it was met {count} times, ever faster, until errors hide how \
                 its action turns the solution back; bring the solution to rest there and keep it so, or end \
                 the run, by Event::at_accumulation"
            ),
        }
    }
}

impl error::Error for Reason {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        match self {
            Self::Failed(error) => error.source(),
            _ => None,
        }
    }
}

impl From<InputError> for Reason {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<common::Error> for Reason {
    fn from(error: common::Error) -> Self {
        match error {
            common::Error::Input(error) => Self::Input(error),
            error => Self::Failed(error),
        }
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let t = self.solution.t().last().copied().unwrap_or(f64::NAN);
        match (&self.reason, self.solution.notice()) {
            (Reason::Failed(error), _) => error.fmt(f),
            (Reason::Steps(steps), Some(notice)) => {
                write!(f, "the run stopped at t = {t:?}: {steps} steps taken; {notice}")
            }
            (reason, Some(notice)) => write!(f, "the run stopped at t = {t:?}: {reason}; {notice}"),
            (reason, None) => write!(f, "the run stopped at t = {t:?}: {reason}"),
        }
    }
}

impl error::Error for Stopped {
    fn source(&self) -> Option<&(dyn error::Error + 'static)> {
        Some(&self.reason)
    }
}

impl Error {
    /// The solution up to the time at which the run stopped; none for invalid input and a panic.
    #[must_use]
    pub fn solution(&self) -> Option<&Solution> {
        match self {
            Self::Stopped(stopped) => Some(&stopped.solution),
            Self::Input(_) | Self::Panicked(_) => None,
        }
    }
}
