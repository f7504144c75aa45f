//! A run under the caller's control, step by step.

use std::{
    fmt,
    sync::{Arc, atomic::AtomicBool},
    time::{Duration, Instant},
};

use faer::MatRef;

use super::{
    caution::Caution,
    engine::Engine,
    error::Reason,
    event::Event,
    method::{Limit, Method, MethodUse},
    options::Options,
    problem::{Break, Equations, Observer, Problem},
    saved::Saved,
    sensitivities::Carried,
    sides::Surfaces,
    snapshot::{Log, SharedSides, Snapshot},
    solution::{End, Occurrence, SavedPoint},
    watch::{EventTracker, Seen},
};
use crate::base::input::InputError;
use crate::integrators::common::{
    self, SHORTEST, Statistics, Tolerances, check_start_time, check_time, is_fine,
};

/// A problem that is solved step by step, by [`advance`](Self::advance).
///
/// ```
/// use pliant::solve::{Method, Options, Problem, Run};
///
/// let decay = |_t: f64, y: &[f64], ydot: &mut [f64]| {
///     ydot[0] = -y[0];
///     Ok(())
/// };
/// let mut run = Run::new(Problem::ode(decay, [1.0]), Method::Bdf, (0.0, 9.0), &Options::new(1e-6, 1e-9))?;
/// while let Some(step) = run.advance()? {
///     if step.y[0] < 0.5 {
///         break;
///     }
/// }
/// assert!((run.y()[0] - (-run.t()).exp()).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Run<'a> {
    pub(super) engine: Box<dyn Engine + 'a>,
    /// The method, unless the engine changes between several.
    pub(super) method: MethodUse,
    pub(super) events: Vec<Event<'a>>,
    pub(super) watches: Vec<EventTracker>,
    pub(super) counts: Vec<u32>,
    /// Whether each event may take place.
    pub(super) armed: Vec<bool>,
    /// The next times of the clocks of events.
    pub(super) ticks: Vec<Option<f64>>,
    /// The breaks ahead, the next one last.
    pub(super) breaks: Vec<Break<'a>>,
    /// Those behind, for a run that goes back.
    pub(super) passed: Vec<Break<'a>>,
    /// A time at which a step is to end.
    pub(super) target: Option<f64>,
    pub(super) observer: Option<Observer<'a>>,
    pub(super) cancel: Option<Arc<AtomicBool>>,
    pub(super) limits: Limits,
    /// The limit of the steps, besides accuracy.
    pub(super) limit: Limit,
    pub(super) tolerances: Tolerances,
    pub(super) span: (f64, f64),
    /// +1 forward in time, -1 backward.
    pub(super) sign: f64,
    pub(super) t_old: f64,
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    pub(super) yp: Vec<f64>,
    pub(super) parameters: Vec<f64>,
    /// State before the jump at `t`, if there was one.
    pub(super) before: Option<Vec<f64>>,
    /// Whether the integrator has to restart at `t`.
    pub(super) stale: bool,
    pub(super) carried: Option<Carried>,
    /// The sides of the events that the equations keep to, where derivatives are computed.
    pub(super) sides: Option<SharedSides>,
    /// Steps that may have passed a switch that is no event.
    pub(super) caution: Caution,
    pub(super) log: Log,
    /// Integrals since the start of the span, and up to the last start of the integrator.
    pub(super) quadratures: [Vec<f64>; 2],
    /// The search for events in the last step, one for each.
    pub(super) seen: Vec<Seen>,
    pub(super) occurred: Vec<Occurrence>,
    /// How many of them the last step has shown.
    pub(super) shown: usize,
    pub(super) scratch: Vec<f64>,
    /// Statistics before the last start of the integrator.
    pub(super) past: Statistics,
    pub(super) started: Instant,
    pub(super) end: Option<End>,
}

/// Limits of the whole run.
pub(super) struct Limits {
    pub(super) steps: u64,
    pub(super) evaluations: Option<u64>,
    pub(super) wall_time: Option<Duration>,
}

/// One step of a [`Run`].
#[derive(Debug)]
pub struct Step<'r> {
    /// Time at its start.
    pub t_old: f64,
    /// Time at its end.
    pub t: f64,
    /// State at its end, after any jump.
    pub y: &'r [f64],
    /// State at its end before the jump, if there is one.
    pub before: Option<&'r [f64]>,
    /// Events within the step and at its end.
    pub events: &'r [Occurrence],
}

impl fmt::Debug for Run<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Run").field("t", &self.t).field("y", &self.y).finish_non_exhaustive()
    }
}

impl<'a> Run<'a> {
    /// Starts a run of `problem` by `method` from the start to the end of `span`.
    ///
    /// The end may lie before the start, for methods that can go backward in time.
    ///
    /// # Errors
    /// [`Reason::Input`] for anything that cannot be used, including options that the method does not have;
    /// [`Reason::Failed`] if the start of a DAE cannot be made to satisfy its equations.
    pub fn new(
        problem: Problem<'a>,
        method: Method,
        span: (f64, f64),
        options: &Options,
    ) -> Result<Self, Reason> {
        let (start, end) = span;
        check_start_time("start of the span", start)?;
        check_time("end of the span", end)?;
        if start == end {
            let spacing = start.abs().next_up() - start.abs();
            let help = format!(
                "it differs from the start; at this time numbers are {spacing:.1e} apart: count shorter times from the start of the span"
            );
            return Err(InputError::new("end of the span", format!("{end:?}"), help).into());
        }
        if (end - start).abs() < SHORTEST {
            let help = format!("it lies at least {SHORTEST:e} from the start, {start:?}");
            return Err(InputError::new("end of the span", format!("{end:e}"), help).into());
        }
        let sign = (end - start).signum();
        options.check(span)?;
        let Problem { mut equations, mut y, events, mut breaks, .. } = problem;
        let Problem { observer, cancel, saved, initial_sensitivities, mut sides, .. } = problem;
        for (i, event) in events.iter().enumerate() {
            event.check(i, span)?;
        }
        if let Some(saved) = &saved {
            let derivatives = match &mut equations {
                Equations::Dae { yp, .. } => {
                    yp.clone_from(&saved.yp);
                    y.len()
                }
                Equations::Ode(_) => 0,
            };
            saved.check([y.len(), derivatives, events.len(), equations.quadrature_count()])?;
            if start != saved.t {
                let help = format!("the saved run stands at {:?}", saved.t);
                return Err(InputError::new("start of the span", start, help).into());
            }
            equations.check_parameters(&saved.parameters)?;
            equations.set_parameters(&saved.parameters);
            y.clone_from(&saved.y);
            breaks.retain(|Break { t, .. }| (t - start) * sign > 0.0);
        }
        for Break { t, .. } in &breaks {
            check_time("break", *t)?;
            if (t - start) * sign <= 0.0 || (end - t) * sign <= 0.0 {
                let help =
                    format!("it has to lie within the span from {start} to {end}, not at its ends");
                return Err(InputError::new("break", t, help).into());
            }
        }
        breaks.sort_by(|a, b| ((b.t - a.t) * sign).total_cmp(&0.0));
        let quadrature_count = equations.quadrature_count();
        let (method, reason) = method.resolve(&equations, options, sign);
        let options = &*options.with_linear_solver(method, &mut equations, start, &y)?;
        if options.sensitivities.is_some() {
            equations = method.take(equations, start, y.len(), options)?;
            let (tolerances, length) = (&options.tolerances, (end - start).abs());
            let surfaces = Surfaces::of(&events, tolerances, length);
            equations = surfaces.keep(equations);
            sides = Some(surfaces.sides().clone());
        }
        let limit = if equations.has_mass() { Limit::None } else { method.information().limit };
        let mut engine = method.engine(equations, span, &y, options)?;
        let jumps = events.iter().any(Event::may_go_on) || !breaks.is_empty();
        if options.sensitivities.is_some() && jumps && !engine.can_be_consistent() {
            let help = "to go on across events and breaks, Problem::differential says which unknowns are differential";
            return Err(InputError::new("sensitivities", "given for a DAE", help).into());
        }
        let count = engine.parameters().len();
        let sizes = [y.len(), quadrature_count];
        let mut carried = options.sensitivities.as_ref().map(|s| Carried::new(s, sizes, count));
        let saved_sensitivities = saved.as_ref().map(|saved| &saved.sensitivities);
        let [dp, q] = saved.as_ref().map_or([&[][..]; 2], |saved| {
            [&saved.parameter_sensitivities[..], &saved.quadrature_sensitivities]
        });
        match (&mut carried, saved_sensitivities.or(initial_sensitivities.as_ref())) {
            (Some(carried), Some(s)) => carried.start([s, dp, q], Some(engine.as_mut()))?,
            (None, Some(_)) if initial_sensitivities.is_some() => {
                let help = "Options::sensitivities says which parameters they belong to";
                return Err(InputError::new("initial_sensitivities", "given", help).into());
            }
            _ => {}
        }
        engine.make_consistent(end)?;
        let (y, yp) = (engine.y().to_vec(), engine.yp().to_vec());
        if let Some(carried) = &mut carried {
            carried.read(engine.as_mut(), start)?;
        }
        let parameters = engine.parameters().to_vec();
        let mut watches = Vec::new();
        for (i, event) in events.iter().enumerate() {
            let g = match &saved {
                Some(saved) => saved.event_values[i],
                None => event.value(i, start, &y, &parameters)?,
            };
            watches.push(EventTracker::new(event, (start, g), sides.is_some()));
        }
        let mut quadratures = vec![0.0; quadrature_count];
        if let Some(saved) = &saved {
            quadratures.clone_from(&saved.quadratures);
        }
        let limits = Limits {
            steps: options.max_steps,
            evaluations: options.max_evaluations,
            wall_time: options.max_wall_time,
        };
        let mut run = Self {
            engine,
            method: MethodUse { t: start, method, reason: reason.into() },
            armed: saved.as_ref().map_or(vec![true; events.len()], |saved| armed(saved, &events)),
            ticks: vec![None; events.len()],
            seen: vec![Seen::default(); events.len()],
            counts: saved.as_ref().map_or(vec![0; events.len()], |saved| saved.counts.clone()),
            events,
            watches,
            breaks,
            passed: Vec::new(),
            target: None,
            observer,
            cancel,
            limits,
            limit,
            tolerances: options.tolerances.clone(),
            span,
            sign,
            t_old: start,
            t: start,
            scratch: vec![0.0; y.len()],
            y,
            yp,
            parameters,
            before: None,
            stale: false,
            carried,
            sides,
            caution: Caution::default(),
            log: Log::new(),
            quadratures: [quadratures.clone(), quadratures],
            occurred: Vec::new(),
            shown: 0,
            past: Statistics::default(),
            started: Instant::now(),
            end: None,
        };
        run.follow_events(saved.is_some());
        run.choose_sides(&[])?;
        run.note_flow()?;
        run.record_ticks(start)?;
        if run.breaks.last().is_some_and(|next| next.t == start) {
            run.jump_at_break()?;
        }
        run.set_stop_time()?;
        Ok(run)
    }

    /// Makes the next steps end just before the next break, or at the end of the span; there may be no room
    /// for a step.
    pub(super) fn set_stop_time(&mut self) -> Result<(), common::Error> {
        let end = self.target.unwrap_or(self.span.1);
        let before_break = self.breaks.last().map(|next| (next.t, self.just_before(next.t)));
        match before_break.filter(|(_, stop)| (end - stop) * self.sign > 0.0) {
            Some((next, stop)) if stop != self.t || !is_fine(stop) => {
                self.engine.set_stop_before(next)
            }
            None if end != self.t => self.engine.set_stop_time(end),
            _ => Ok(()),
        }
    }

    /// Whether time `t` is the last number before the next break.
    pub(super) fn is_before_break(&self, t: f64) -> bool {
        self.breaks.last().is_some_and(|next| t == self.just_before(next.t))
    }

    /// The last number before time `t`.
    pub(super) fn just_before(&self, t: f64) -> f64 {
        if self.sign > 0.0 { t.next_down() } else { t.next_up() }
    }

    /// Time reached.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// State there, after any jump.
    #[must_use]
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// Its time derivative for a DAE; empty otherwise.
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        &self.yp
    }

    /// The parameters of the equations.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Why the run has ended; `None` before.
    #[must_use]
    pub fn end(&self) -> Option<End> {
        self.end
    }

    /// Where the run stands.
    pub(super) fn snapshot(&self) -> Snapshot {
        let (y, yp, p) = (self.y.clone(), self.yp.clone(), self.parameters.clone());
        Snapshot { t: self.t, y, yp, p, sides: self.signs() }
    }

    /// The present state of the run, to be continued later or by another program: [`Problem::resume`].
    #[must_use]
    pub fn save(&self) -> Saved {
        Saved {
            t: self.t,
            y: self.y.clone(),
            yp: self.yp.clone(),
            parameters: self.parameters.clone(),
            counts: self.counts.clone(),
            armed: self.armed.clone(),
            sensitivities: self.carried.as_ref().map_or(Vec::new(), |carried| carried.s.clone()),
            parameter_sensitivities: self.carried.as_ref().map_or(Vec::new(), |c| c.dp.clone()),
            quadratures: self.quadratures().to_vec(),
            quadrature_sensitivities: self.carried.as_ref().map_or(Vec::new(), |c| c.q[0].clone()),
            event_values: self.watches.iter().map(EventTracker::value).collect(),
        }
    }

    /// The sensitivities at the present time, after any jump: entry (i, j) is the derivative of unknown i
    /// with respect to the j-th parameter of [`Options::sensitivities`].
    #[must_use]
    pub fn sensitivities(&self) -> MatRef<'_, f64> {
        let s = self.carried.as_ref().map_or(&[][..], |carried| &carried.s);
        MatRef::from_column_major_slice(s, self.y.len(), s.len() / self.y.len())
    }

    /// The integrals of [`Ode::quadratures`](crate::integrators::ode::Ode::quadratures) from the start of the
    /// span to the present time; none if the equations have none.
    #[must_use]
    pub fn quadratures(&self) -> &[f64] {
        &self.quadratures[0]
    }

    /// The sensitivities of the integrals at the present time, after any jump, if they are
    /// [wanted](crate::integrators::sundials::Sensitivities::integrals): entry (i, j) is the derivative of integral i with
    /// respect to the j-th parameter of [`Options::sensitivities`].
    #[must_use]
    pub fn quadrature_sensitivities(&self) -> MatRef<'_, f64> {
        let q = self.carried.as_ref().map_or(&[][..], |carried| &carried.q[0]);
        let rows = self.quadratures().len();
        MatRef::from_column_major_slice(q, rows, q.len() / rows.max(1))
    }

    /// State, sensitivities and integrals at the present time, after any jump.
    pub(super) fn row(&self) -> SavedPoint<'_> {
        let [s, sq] = self.carried.as_ref().map_or([&[][..]; 2], |c| [&c.s[..], &c.q[0]]);
        SavedPoint { y: &self.y, s, q: self.quadratures(), sq }
    }

    /// The sensitivities, of states and of integrals, that belong to the states of the last step: before its jump, or at its
    /// end if there was none.
    pub(super) fn sensitivities_before(&self) -> [&[f64]; 2] {
        self.carried.as_ref().map_or([&[][..]; 2], Carried::before)
    }

    /// The sensitivities of states and of integrals at time `t` within the last step, one column after the other.
    pub(super) fn sensitivities_at(&mut self, t: f64) -> Result<[Vec<f64>; 2], Reason> {
        let Some(carried) = &self.carried else { return Ok([Vec::new(), Vec::new()]) };
        let [mut s, mut q] = [vec![0.0; carried.s.len()], vec![0.0; carried.q[0].len()]];
        carried.write_at(self.engine.as_mut(), t, [&mut s, &mut q])?;
        Ok([s, q])
    }

    /// The integrals at time `t` within the last step.
    pub(super) fn quadratures_at(&mut self, t: f64) -> Result<Vec<f64>, common::Error> {
        let [_, past] = &self.quadratures;
        let mut q = past.clone();
        self.engine.quadratures_at(t, &mut q)?;
        q.iter_mut().zip(past).for_each(|(q, past)| *q += past);
        Ok(q)
    }

    /// Writes the state at time `t` within the last step, before any jump at its end, into `out`.
    ///
    /// # Errors
    /// If `t` lies outside the last step, or `out` has another length than the state.
    pub fn interpolate(&mut self, t: f64, out: &mut [f64]) -> Result<(), common::Error> {
        let [low, high] = if self.sign > 0.0 { [self.t_old, self.t] } else { [self.t, self.t_old] };
        if !(low <= t && t <= high) {
            let help = format!("the last step is [{low}, {high}]");
            return Err(InputError::new("t", t, help).into());
        }
        // the integrator went only as far as the number before a break
        let reached = self.engine.t();
        let t = if (t - reached) * self.sign > 0.0 { reached } else { t };
        self.engine.interpolate(t, 0, out)
    }

    /// The time in which the state `y` changes by its size along `slope`.
    pub(super) fn unit_of_time(&self, y: &[f64], slope: &[f64]) -> f64 {
        self.tolerances.reach(y, slope, (self.span.1 - self.span.0).abs())
    }

    /// +1 forward in time, -1 backward.
    pub(super) fn direction(&self) -> f64 {
        self.sign
    }

    /// Degree of the polynomial of the last step.
    pub(super) fn interpolant_degree(&self) -> u32 {
        self.engine.interpolant_degree().max(1)
    }

    /// The methods of the run so far, each with its first time and why it is used: [`Method::Auto`] changes between several.
    #[must_use]
    pub fn methods(&self) -> &[MethodUse] {
        match self.engine.uses() {
            [] => std::slice::from_ref(&self.method),
            uses => uses,
        }
    }

    /// Cost counters of the run so far.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.past.followed_by(&self.engine.statistics())
    }

    /// Steps of the run so far.
    pub(super) fn steps(&self) -> u64 {
        self.past.steps + self.engine.steps()
    }
}

/// Whether each event may take place, by what was saved.
pub(super) fn armed(saved: &Saved, events: &[Event<'_>]) -> Vec<bool> {
    match saved.armed.is_empty() {
        true => events.iter().zip(&saved.counts).map(|(e, n)| !e.once || *n == 0).collect(),
        false => saved.armed.clone(),
    }
}
