//! Events: roots of functions along a solution, and actions at them.

use std::{
    fmt,
    sync::{Arc, Mutex, PoisonError},
};

use super::error::Reason;
use crate::base::input::InputError;
use crate::base::root::Direction;
use crate::integrators::common::check_finite;

/// g(t, y, p), whose roots are the events: equations that keep to one side of them ask it, too.
#[derive(Clone)]
pub(super) struct Function<'a>(Arc<Mutex<Closure<'a>>>);

type Closure<'a> = dyn FnMut(f64, &[f64], &[f64]) -> f64 + Send + 'a;

impl<'a> Function<'a> {
    pub(super) fn new(g: impl FnMut(f64, &[f64], &[f64]) -> f64 + Send + 'a) -> Self {
        Self(Arc::new(Mutex::new(g)))
    }

    pub(super) fn at(&self, t: f64, y: &[f64], p: &[f64]) -> f64 {
        // a lock that a panic of the function has poisoned guards nothing else
        let mut function = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        function(t, y, p)
    }
}

/// An action at an event or a break: it changes the jump.
pub(super) type Action<'a> = Box<dyn FnMut(&mut Jump<'_>) + Send + 'a>;

/// An event along the solution: a root of a function g(t, y), and the action there.
///
/// Without an action an event is only recorded in the [`Solution`](super::Solution), and the integration
/// continues with the same steps. It is located on the interpolant of the step, to rounding.
///
/// * Between the ends of each step g is evaluated at [`samples`](Self::samples) times, and minima of |g| are
///   searched, so that two roots within one step are found, too.
/// * A g that starts at zero is no event. It may become one when g returns to zero after it has left it.
/// * A g that touches zero without a change of sign is an event only with [`touching`](Self::touching).
/// * Where g is not a number, roots before that are found; without one it is an error
///   ([`Reason::Event`](super::Reason::Event)). Where the equations are not defined beyond an event that ends the run or has
///   an action, it occurs when the state has reached it within the tolerances.
/// * When an action makes g jump across zero, that is no event.
/// * Where an action lets the solution rest at g = 0, as by equations that hold it there, round-off causes no event: the
///   next one occurs after g has left zero by more than its change under the tolerances of the state.
/// * Times are events, too: [`every`](Self::every) period, or [`at`](Self::at) one time. A sine of time as
///   the function would miss ticks where steps span several periods.
/// * An action that turns the solution back, as at a floor, may be called at ever shorter intervals (Zeno's
///   paradox): such events [accumulate](Self::at_accumulation).
pub struct Event<'a> {
    pub(super) function: Function<'a>,
    pub(super) direction: Direction,
    pub(super) last: Option<u32>,
    pub(super) action: Option<Action<'a>>,
    pub(super) at_accumulation: Option<Action<'a>>,
    pub(super) samples: u32,
    pub(super) touching: Option<f64>,
    pub(super) once: bool,
    pub(super) schedule: Option<Schedule>,
}

/// The times of an event that has no function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// The first one; `None`: all multiples of the period after the start of the span.
    start: Option<f64>,
    /// `None`: there is one.
    period: Option<f64>,
}

impl Schedule {
    /// The next of its times after `t` in the direction `sign` of time; one at `t` counts if it `includes` that.
    pub(super) fn next(self, t: f64, sign: f64, includes: bool) -> Option<f64> {
        let first = self.start.unwrap_or(0.0);
        let is_ahead = |time: &f64| (time - t) * sign > 0.0 || (includes && *time == t);
        let Some(period) = self.period else { return Some(first).filter(is_ahead) };
        let passed = ((t - first) * sign / period).floor() - 1.0;
        let passed = if self.start.is_some() { passed.max(0.0) } else { passed };
        let mut times = (0..4).map(|k| first + sign * (passed + f64::from(k)) * period);
        times.find(is_ahead)
    }

    /// Whether it may tick at the start of the span.
    pub(super) fn may_start(self) -> bool {
        self.start.is_some()
    }
}

impl fmt::Debug for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Event")
            .field("direction", &self.direction)
            .field("last", &self.last)
            .field("action", &self.action.is_some())
            .finish_non_exhaustive()
    }
}

impl<'a> Event<'a> {
    /// A root of `g(t, y)`.
    pub fn new(mut g: impl FnMut(f64, &[f64]) -> f64 + Send + 'a) -> Self {
        Self::with_parameters(move |t, y, _| g(t, y))
    }

    /// A root of `g(t, y, p)`, with the parameters of the equations.
    pub fn with_parameters(g: impl FnMut(f64, &[f64], &[f64]) -> f64 + Send + 'a) -> Self {
        Self {
            function: Function::new(g),
            direction: Direction::Either,
            last: None,
            action: None,
            at_accumulation: None,
            samples: 4,
            touching: None,
            once: false,
            schedule: None,
        }
    }

    /// A clock: the event occurs at the multiples of `period` within the span, after its start.
    ///
    /// Its times are exact, k `period` to rounding, and none is lost. With an [action](Self::action) a step ends just
    /// before each, as at a [break](super::Problem::breaks), and equations may switch there; without one it is recorded.
    ///
    /// ```
    /// use pliant::{
    ///     ode::with_parameters,
    ///     solve::{Event, Method, Options, Problem, solve},
    /// };
    ///
    /// // y' = u, where a controller sets u = (1 - y) / 2 every second from the start on
    /// let plant = with_parameters(
    ///     |_t, _y, u, ydot| {
    ///         ydot[0] = u[0];
    ///         Ok(())
    ///     },
    ///     [0.0],
    /// );
    /// let control = Event::every(1.0).starting_at(0.0).action(|jump| jump.p[0] = 0.5 * (1.0 - jump.y[0]));
    /// let problem = Problem::ode(plant, [0.0]).event(control);
    /// let solution = solve(problem, Method::Bdf, (0.0, 3.0), &Options::new(1e-8, 1e-10))?;
    /// assert!((solution.last()[0] - 0.875).abs() < 1e-9);
    /// assert_eq!(solution.events().len(), 4);
    /// # Ok::<(), pliant::solve::Error>(())
    /// ```
    pub fn every(period: f64) -> Self {
        Self::scheduled(Schedule { start: None, period: Some(period) })
    }

    /// An event at the time `t`, which may be the start or the end of the span.
    pub fn at(t: f64) -> Self {
        Self::scheduled(Schedule { start: Some(t), period: None })
    }

    fn scheduled(schedule: Schedule) -> Self {
        Self { schedule: Some(schedule), ..Self::new(|_, _| 1.0) }
    }

    /// The time of the first tick of [`every`](Self::every), which may be the start of the span; the others follow in
    /// the direction of time.
    #[must_use]
    pub fn starting_at(mut self, t: f64) -> Self {
        // without a period it is refused before the run
        let period = self.schedule.map_or(Some(f64::NAN), |schedule| schedule.period);
        self.schedule = Some(Schedule { start: Some(t), period });
        self
    }

    /// The event occurs once, and not again until an action [arms](Jump::arm) it. (One that is
    /// [terminal](Self::terminal) ends the run.)
    #[must_use]
    pub fn once(mut self) -> Self {
        self.once = true;
        self
    }

    /// Counts only roots where g becomes positive.
    #[must_use]
    pub fn rising(mut self) -> Self {
        self.direction = Direction::Rising;
        self
    }

    /// Counts only roots where g becomes negative.
    #[must_use]
    pub fn falling(mut self) -> Self {
        self.direction = Direction::Falling;
        self
    }

    /// Ends the run at the first event.
    #[must_use]
    pub fn terminal(self) -> Self {
        self.terminal_after(1)
    }

    /// Ends the run at the event of this number, counted from 1.
    #[must_use]
    pub fn terminal_after(mut self, count: u32) -> Self {
        self.last = Some(count);
        self
    }

    /// Action at the event: it changes the state or the parameters, or ends the run.
    ///
    /// The integration restarts from there.
    ///
    /// In a DAE whose differential unknowns are known, the algebraic ones and the derivatives are made
    /// consistent again.
    #[must_use]
    pub fn action(mut self, action: impl FnMut(&mut Jump<'_>) + Send + 'a) -> Self {
        self.action = Some(Box::new(action));
        self
    }

    /// Action where this event accumulates.
    ///
    /// An event accumulates where its action turns the solution back at ever shorter intervals, as for a ball that
    /// loses a fraction of its speed at each bounce, until the change between two events is less than the errors of
    /// the solution. The action given here brings the solution to rest and keeps it there, by a parameter of
    /// the equations, say, or [ends](Jump::end) the run. It is called at the time of the last event, in the
    /// state after the jump.
    ///
    /// Without it the run stops there with [`Reason::Accumulation`](super::Reason::Accumulation). So it does
    /// with sensitivities, which do not exist at such a time, and where the solution passes through zero
    /// nevertheless.
    ///
    /// ```
    /// use pliant::{
    ///     ode::with_parameters,
    ///     solve::{Event, Method, Options, Problem, solve},
    /// };
    ///
    /// // a ball that falls from 1 m and keeps half of its speed at each impact; p = 0 as long as it flies, 1 on the floor
    /// let ball = with_parameters(
    ///     |_t, y, p, ydot| {
    ///         ydot.copy_from_slice(&[y[1], if p[0] == 0.0 { -8.0 } else { 0.0 }]);
    ///         Ok(())
    ///     },
    ///     [0.0],
    /// );
    /// let floor = Event::new(|_t, y| y[0]).falling().action(|jump| jump.y[1] *= -0.5).at_accumulation(|jump| {
    ///     jump.y.fill(0.0);
    ///     jump.p[0] = 1.0;
    /// });
    /// let problem = Problem::ode(ball, [1.0, 0.0]).event(floor);
    /// let solution = solve(problem, Method::Bdf, (0.0, 3.0), &Options::new(1e-8, 1e-10))?;
    /// assert_eq!(solution.last(), [0.0, 0.0]);
    /// // 0.5 s to the first impact, and then 0.5 + 0.25 + 0.125 + ... s
    /// let rest = solution.events().last().map_or(0.0, |impact| impact.t);
    /// assert!((rest - 1.5).abs() < 1e-4);
    /// # Ok::<(), pliant::solve::Error>(())
    /// ```
    #[must_use]
    pub fn at_accumulation(mut self, action: impl FnMut(&mut Jump<'_>) + Send + 'a) -> Self {
        self.at_accumulation = Some(Box::new(action));
        self
    }

    /// Also counts as an event a minimum of |g| of at most `tolerance` without a change of sign.
    #[must_use]
    pub fn touching(mut self, tolerance: f64) -> Self {
        self.touching = Some(tolerance);
        self
    }

    /// Number of times in a step at which g is evaluated. Default: 4.
    ///
    /// More are needed for a g that changes faster than the solution, such as a function of time that does
    /// not occur in the equations.
    #[must_use]
    pub fn samples(mut self, samples: u32) -> Self {
        self.samples = samples;
        self
    }
}

impl Event<'_> {
    /// Whether the run goes on from it.
    pub(super) fn may_go_on(&self) -> bool {
        self.action.is_some() || (self.schedule.is_none() && self.last != Some(1))
    }

    /// Whether it does something to the run.
    pub(super) fn acts(&self) -> bool {
        self.action.is_some() || self.last.is_some()
    }

    /// The event lent to a run, without what it does where it accumulates.
    pub(super) fn lend(&mut self) -> Event<'_> {
        let Self { direction, last, samples, touching, once, schedule, .. } = *self;
        let function = self.function.clone();
        let function = Function::new(move |t, y, p| function.at(t, y, p));
        let action =
            self.action.as_mut().map(|action| -> Action<'_> { Box::new(move |jump| action(jump)) });
        Event {
            function,
            direction,
            last,
            action,
            at_accumulation: None,
            samples,
            touching,
            once,
            schedule,
        }
    }

    /// The value of the function of this event, the one of number `i`.
    pub(super) fn value(&self, i: usize, t: f64, y: &[f64], p: &[f64]) -> Result<f64, Reason> {
        match self.function.at(t, y, p) {
            value if value.is_nan() => Err(Reason::Event { event: i, t, value }),
            value => Ok(value),
        }
    }

    /// Checks the event of number `i` of a run over `span`.
    pub(super) fn check(&self, i: usize, span: (f64, f64)) -> Result<(), InputError> {
        if !(1..=10_000).contains(&self.samples) {
            let help = "it lies between 1 and 10,000";
            return Err(InputError::new(format!("samples of event {i}"), self.samples, help));
        }
        if let Some(most) = self.touching
            && !(most >= 0.0 && most.is_finite())
        {
            let help = "it is a small number, not negative";
            return Err(InputError::new(format!("touching of event {i}"), most, help));
        }
        if self.at_accumulation.is_some() && self.action.is_none() {
            let help = "it belongs to an action, which turns the solution back";
            return Err(InputError::new(format!("at_accumulation of event {i}"), "given", help));
        }
        if let Some(Schedule { start, period }) = self.schedule {
            let longest = span.0.abs().max(span.1.abs());
            if let Some(start) = start.filter(|start| !start.is_finite()) {
                return Err(InputError::new(format!("time of event {i}"), start, "it is finite"));
            }
            let shortest = 8.0 * f64::EPSILON * longest;
            if let Some(period) = period.filter(|p| !(p.is_finite() && *p > shortest)) {
                let help = "it is positive and longer than rounding of the times of the span; starting_at belongs to Event::every";
                return Err(InputError::new(format!("period of event {i}"), period, help));
            }
            if self.direction != Direction::Either || self.touching.is_some() {
                let help =
                    "it belongs to an event with a function, and not to Event::every or Event::at";
                return Err(InputError::new(
                    format!("direction or touching of event {i}"),
                    "given",
                    help,
                ));
            }
        }
        if self.last == Some(0) {
            let help = "events are counted from 1";
            return Err(InputError::new(format!("terminal_after of event {i}"), 0, help));
        }
        Ok(())
    }
}

/// The state where the solution jumps: at an event or a break.
#[derive(Debug)]
pub struct Jump<'j> {
    /// Time.
    pub t: f64,
    /// State; the solution continues from the values written here.
    pub y: &'j mut [f64],
    /// Its time derivative for a DAE; empty otherwise.
    pub yp: &'j mut [f64],
    /// Parameters of the equations; values written here apply from now on.
    pub p: &'j mut [f64],
    pub(super) ends: bool,
    /// Events to be armed or disarmed.
    pub(super) armed: Vec<(usize, bool)>,
}

impl<'j> Jump<'j> {
    pub(super) fn new(t: f64, y: &'j mut [f64], yp: &'j mut [f64], p: &'j mut [f64]) -> Self {
        Self { t, y, yp, p, ends: false, armed: Vec::new() }
    }

    /// Arms the event of this number, in the order of [`Problem::event`](super::Problem::event),
    /// after it was [disarmed](Self::disarm) or occurred [once](Event::once).
    pub fn arm(&mut self, event: usize) {
        self.armed.push((event, true));
    }

    /// Disarms the event of this number until it is armed again: it is not recorded, and its action is not
    /// called.
    pub fn disarm(&mut self, event: usize) {
        self.armed.push((event, false));
    }

    /// Ends the run here.
    pub fn end(&mut self) {
        self.ends = true;
    }
}

/// Refuses derivatives at an event whose function only touches zero: its time, and whether it exists at all,
/// have no derivatives with respect to parameters.
pub(super) fn check_crosses(event: usize, t: f64, crosses: bool) -> Result<(), InputError> {
    if crosses {
        return Ok(());
    }
    let help = "where its function only touches zero, the solution has no derivatives";
    Err(InputError::new(format!("event {event} at t = {t:?}"), "touching", help))
}

/// Refuses derivatives that are not finite after an action. One that reads y' of a DAE was given NaN for it,
/// as differences along the state do not show how y' changes.
pub(super) fn check_landed(input: &str, slopes: &[f64], of_dae: bool) -> Result<(), InputError> {
    if of_dae && slopes.iter().any(|slope| slope.is_nan()) {
        let help = "with derivatives of a DAE an action reads y, t and p alone, not yp";
        return Err(InputError::new(input, "NaN", help));
    }
    check_finite(input, slopes)
}
