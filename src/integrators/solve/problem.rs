//! Initial value problems: equations, initial values, events and breaks.
//!
//! The equations are behind a pointer, so that a [`Problem`] is one type: a virtual call costs some
//! nanoseconds, while a type parameter would stand in every signature of a user.

use std::{
    fmt,
    ops::ControlFlow,
    sync::{Arc, atomic::AtomicBool},
};

use super::{
    event::{Action, Event, Jump},
    saved::Saved,
    snapshot::SharedSides,
};
use crate::base::input::InputError;
use crate::integrators::ode::{Dae, MassKind, Ode};

/// The equations of a problem.
pub(super) enum Equations<'a> {
    Ode(Box<dyn Ode + Send + 'a>),
    Dae { system: Box<dyn Dae + Send + 'a>, yp: Vec<f64>, differential: Option<Vec<bool>> },
}

impl Equations<'_> {
    pub(super) fn parameters(&self) -> &[f64] {
        match self {
            Self::Ode(system) => system.parameters(),
            Self::Dae { system, .. } => system.parameters(),
        }
    }

    /// Whether they are a DAE, or have a mass matrix.
    pub(super) fn is_dae(&self) -> bool {
        matches!(self, Self::Dae { .. }) || self.has_mass()
    }

    /// Whether they have a mass matrix.
    pub(super) fn has_mass(&self) -> bool {
        matches!(self, Self::Ode(system) if system.mass_kind() != MassKind::Identity)
    }

    pub(super) fn quadrature_count(&self) -> usize {
        match self {
            Self::Ode(system) => system.quadrature_count(),
            Self::Dae { system, .. } => system.quadrature_count(),
        }
    }

    /// Checks that the equations have as many parameters as `values`.
    pub(super) fn check_parameters(&self, values: &[f64]) -> Result<(), InputError> {
        let count = self.parameters().len();
        if count == values.len() {
            return Ok(());
        }
        let help = format!("the equations have {count} parameters");
        Err(InputError::new("length of parameters in the saved run", values.len(), help))
    }

    pub(super) fn set_parameters(&mut self, values: &[f64]) {
        match self {
            Self::Ode(system) => system.set_parameters(values),
            Self::Dae { system, .. } => system.set_parameters(values),
        }
    }
}

/// A time at which the equations change, and the action then.
pub(super) struct Break<'a> {
    pub(super) t: f64,
    /// Its number among those that were given.
    pub(super) number: usize,
    /// The event whose clock ticks, in place of a break.
    pub(super) tick: Option<usize>,
    pub(super) action: Option<Action<'a>>,
}

/// Progress of a run, for [`Problem::observed_by`].
#[derive(Clone, Copy, Debug)]
pub struct Progress<'p> {
    /// Time reached.
    pub t: f64,
    /// State there.
    pub y: &'p [f64],
    /// Steps taken.
    pub steps: u64,
    /// Part of the span that is done, from 0 to 1.
    pub part: f64,
}

/// Called after each step; may end the run.
pub(super) type Observer<'a> = Box<dyn FnMut(Progress<'_>) -> ControlFlow<()> + Send + 'a>;

/// Equations, initial values, events and breaks.
///
/// Equations are a closure or a struct, see [`crate::integrators::ode`]. They may borrow: the problem lives
/// no longer than the data that they use.
#[must_use]
pub struct Problem<'a> {
    pub(super) equations: Equations<'a>,
    pub(super) y: Vec<f64>,
    pub(super) events: Vec<Event<'a>>,
    pub(super) breaks: Vec<Break<'a>>,
    pub(super) observer: Option<Observer<'a>>,
    pub(super) cancel: Option<Arc<AtomicBool>>,
    pub(super) saved: Option<Saved>,
    pub(super) initial_sensitivities: Option<Vec<f64>>,
    /// The sides of the events, if the equations keep to them already.
    pub(super) sides: Option<SharedSides>,
}

impl fmt::Debug for Problem<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Problem")
            .field("y", &self.y)
            .field("events", &self.events)
            .finish_non_exhaustive()
    }
}

impl<'a> Problem<'a> {
    /// y' = f(t, y), starting from `y`.
    pub fn ode(system: impl Ode + Send + 'a, y: impl Into<Vec<f64>>) -> Self {
        Self::new(Equations::Ode(Box::new(system)), y.into())
    }

    /// F(t, y, y') = 0, starting from `y` and its time derivative `yp`, which have to satisfy the equations
    /// unless [`differential`](Self::differential) allows their correction.
    pub fn dae(
        system: impl Dae + Send + 'a,
        y: impl Into<Vec<f64>>,
        yp: impl Into<Vec<f64>>,
    ) -> Self {
        let system = Box::new(system);
        Self::new(Equations::Dae { system, yp: yp.into(), differential: None }, y.into())
    }

    fn new(equations: Equations<'a>, y: Vec<f64>) -> Self {
        let (events, breaks) = (Vec::new(), Vec::new());
        let (observer, cancel, saved, initial_sensitivities, sides) =
            (None, None, None, None, None);
        Self { equations, y, events, breaks, observer, cancel, saved, initial_sensitivities, sides }
    }

    /// For each unknown of a DAE, whether its derivative occurs in the equations (`true`) or it is algebraic
    /// (`false`). The algebraic unknowns and the derivatives of the others are then corrected at the start
    /// and after each jump, so that they satisfy the equations. An ODE has only differential unknowns, and
    /// ignores it.
    pub fn differential(mut self, differential_unknowns: impl Into<Vec<bool>>) -> Self {
        if let Equations::Dae { differential, .. } = &mut self.equations {
            *differential = Some(differential_unknowns.into());
        }
        self
    }

    /// The sensitivities at the start, where the initial state depends on the parameters of
    /// [`Options::sensitivities`](super::Options::sensitivities): dy/dp, one column after the other. Default:
    /// zero. For a DAE those of the algebraic unknowns are corrected along with the unknowns.
    pub fn initial_sensitivities(mut self, s: impl Into<Vec<f64>>) -> Self {
        self.initial_sensitivities = Some(s.into());
        self
    }

    /// Looks for an event. Events are numbered in the order in which they are given, from 0.
    pub fn event(mut self, event: Event<'a>) -> Self {
        self.events.push(event);
        self
    }

    /// Times at which the right-hand side has a jump or a kink.
    ///
    /// A step ends just before each, at the last floating-point number before it, and the integration
    /// restarts there. Equations that test `t < break` see the side that they are on.
    ///
    /// Derivatives take these times as fixed; a time that is a parameter is an [`Event`] of `t - p`.
    pub fn breaks(mut self, times: impl IntoIterator<Item = f64>) -> Self {
        for t in times {
            self.push_break(t, None);
        }
        self
    }

    /// A [break](Self::breaks) at which the state or the parameters change.
    pub fn break_with(mut self, t: f64, action: impl FnMut(&mut Jump<'_>) + Send + 'a) -> Self {
        self.push_break(t, Some(Box::new(action)));
        self
    }

    fn push_break(&mut self, t: f64, action: Option<Action<'a>>) {
        self.breaks.push(Break { t, number: self.breaks.len(), tick: None, action });
    }

    /// Shows each step to `observer`, which may end the run by [`ControlFlow::Break`].
    pub fn observed_by(
        mut self,
        observer: impl FnMut(Progress<'_>) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.observer = Some(Box::new(observer));
        self
    }

    /// Ends the run after the step in which another thread sets `flag`.
    pub fn cancelled_by(mut self, flag: Arc<AtomicBool>) -> Self {
        self.cancel = Some(flag);
        self
    }

    /// Continues where a run of the same problem was [saved](super::Run::save), or
    /// [ended](super::Solution::saved).
    ///
    /// The run has the state, the parameters and the counts of events that were saved. The span starts at the
    /// saved time; breaks up to then are omitted.
    pub fn resume(mut self, saved: Saved) -> Self {
        self.saved = Some(saved);
        self
    }
}
