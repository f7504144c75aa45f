//! A run in the hands of the caller, step by step.

use std::{
    fmt,
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
    time::{Duration, Instant},
};

use faer::{MatMut, MatRef};

use super::{
    engine::Engine,
    error::Reason,
    event::{Action, Event, Jump},
    method::Method,
    options::Options,
    problem::{Break, Equations, Observer, Problem, Progress},
    saved::Saved,
    sensitivities::{Carried, Crossing},
    solution::{End, Occurrence},
    watch::{Root, Watch},
};
use crate::{
    input::InputError,
    integrate::{self, Statistics, check_finite, check_time},
};

/// A problem on its way: [`advance`](Self::advance) by a step, look, go on.
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
    engine: Box<dyn Engine + 'a>,
    events: Vec<Event<'a>>,
    watches: Vec<Watch>,
    counts: Vec<u32>,
    /// Those ahead, the next one last.
    breaks: Vec<Break<'a>>,
    observer: Option<Observer<'a>>,
    cancel: Option<Arc<AtomicBool>>,
    limits: Limits,
    span: (f64, f64),
    /// +1 forward in time, -1 backward.
    sign: f64,
    t_old: f64,
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    parameters: Vec<f64>,
    /// State before the jump at `t`, if there was one.
    before: Option<Vec<f64>>,
    /// Whether the integrator has to start anew at `t`.
    stale: bool,
    carried: Option<Carried>,
    occurred: Vec<Occurrence>,
    scratch: Vec<f64>,
    /// Of the starts before the last one.
    past: Statistics,
    started: Instant,
    end: Option<End>,
}

/// Limits of the whole run.
struct Limits {
    steps: u64,
    evaluations: Option<u64>,
    wall_time: Option<Duration>,
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
    /// `problem` by `method` from the start to the end of `span`; the end may lie before the start, for methods that can go backward in time.
    ///
    /// # Errors
    /// [`Reason::Input`] for anything that cannot be used: options that the method does not have, too;
    /// [`Reason::Failed`] if the start of a DAE cannot be made to satisfy its equations.
    pub fn new(
        problem: Problem<'a>,
        method: Method,
        span: (f64, f64),
        options: &Options,
    ) -> Result<Self, Reason> {
        let (start, end) = span;
        check_time("start of the span", start)?;
        check_time("end of the span", end)?;
        if start == end {
            return Err(InputError::new("end of the span", end, "it differs from the start").into());
        }
        let sign = (end - start).signum();
        options.check(span)?;
        let Problem { mut equations, mut y, mut events, mut breaks, observer, cancel, saved } =
            problem;
        for (i, event) in events.iter().enumerate() {
            event.check(i)?;
        }
        if let Some(saved) = &saved {
            let derivatives = match &mut equations {
                Equations::Dae { yp, .. } => {
                    yp.clone_from(&saved.yp);
                    y.len()
                }
                Equations::Ode(_) => 0,
            };
            saved.check([y.len(), derivatives, events.len()])?;
            if start != saved.t {
                let mend = format!("the saved run stands at {:?}", saved.t);
                return Err(InputError::new("start of the span", start, mend).into());
            }
            equations.check_parameters(&saved.parameters)?;
            equations.set_parameters(&saved.parameters);
            y.clone_from(&saved.y);
            breaks.retain(|Break { t, .. }| (t - start) * sign > 0.0);
        }
        for Break { t, .. } in &breaks {
            check_time("break", *t)?;
            if (t - start) * sign <= 0.0 || (end - t) * sign <= 0.0 {
                let mend = format!("it lies between {start} and {end}");
                return Err(InputError::new("break", t, mend).into());
            }
        }
        let jumps = events.iter().any(|event| event.action.is_some()) || !breaks.is_empty();
        if options.sensitivities.is_some() && jumps && method == Method::Ida {
            let mend = "sensitivities of a DAE do not go on across actions and breaks";
            return Err(InputError::new("sensitivities", "given", mend).into());
        }
        breaks.sort_by(|a, b| ((b.t - a.t) * sign).total_cmp(&0.0));
        let mut engine = method.engine(equations, (start, sign), &y, options)?;
        engine.make_consistent(end)?;
        let (y, yp) = (engine.y().to_vec(), engine.yp().to_vec());
        let mut carried = options.sensitivities.as_ref().map(|s| Carried::new(s, y.len()));
        if let (Some(carried), Some(saved)) = (&mut carried, &saved) {
            carried.resume(&saved.sensitivities, engine.as_mut())?;
        }
        let parameters = engine.parameters().to_vec();
        let mut watches = Vec::new();
        for (i, event) in events.iter_mut().enumerate() {
            let g = match &saved {
                Some(saved) => saved.event_values[i],
                None => value(event, i, start, &y, &parameters)?,
            };
            watches.push(Watch::new(event, start, g));
        }
        let limits = Limits {
            steps: options.max_steps,
            evaluations: options.max_evaluations,
            wall_time: options.max_wall_time,
        };
        let mut run = Self {
            engine,
            counts: saved.map_or(vec![0; events.len()], |saved| saved.counts),
            events,
            watches,
            breaks,
            observer,
            cancel,
            limits,
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
            occurred: Vec::new(),
            past: Statistics::default(),
            started: Instant::now(),
            end: None,
        };
        run.set_stop_time()?;
        Ok(run)
    }

    /// Makes one step, which ends where something happens to the state: at a break, or an event with an action or that ends the run.
    /// None at the end of the run.
    ///
    /// # Errors
    /// Why the run cannot go on. What was reached stays: [`t`](Self::t), [`y`](Self::y).
    pub fn advance(&mut self) -> Result<Option<Step<'_>>, Reason> {
        if self.end.is_some() {
            return Ok(None);
        }
        self.check_limits()?;
        self.start_anew()?;
        self.occurred.clear();
        self.before = None;
        let (t_old, end) = (self.t, self.span.1);
        self.engine.step(end)?;
        let mut t = self.engine.t();
        let at_break = self.breaks.last().is_some_and(|next| t == self.just_before(next.t));
        let jumps = self.look_for_events(t, at_break || t == end)?;
        let stops_at = jumps.first().map(|(_, root)| root.t);
        if let Some(at) = stops_at {
            t = at;
            let y = &mut self.scratch;
            self.engine.interpolate(t, 0, y)?;
            self.y.copy_from_slice(y);
            if !self.yp.is_empty() {
                self.engine.interpolate(t, 1, y)?;
                self.yp.copy_from_slice(y);
            }
        } else {
            self.y.copy_from_slice(self.engine.y());
            self.yp.copy_from_slice(self.engine.yp());
        }
        (self.t_old, self.t) = (t_old, t);
        if let Some(carried) = &mut self.carried {
            carried.read(self.engine.as_mut(), t)?;
        }
        let at_break = at_break && stops_at.is_none_or(|at| at == self.engine.t());
        if stops_at.is_some() {
            self.jump_at_events(&jumps)?;
        }
        if at_break {
            self.jump_at_break()?;
        }
        if t == end && self.end.is_none() {
            self.end = Some(End::Span);
        }
        self.report();
        Ok(Some(Step {
            t_old,
            t: self.t,
            y: &self.y,
            before: self.before.as_deref(),
            events: &self.occurred,
        }))
    }

    /// Finds the events of the step that has just been made, up to `t`, and notes them. Those that stop the step are returned, the last ones noted.
    /// `is_last` tells that the next step does not go on from there, but from a break, if at all.
    fn look_for_events(&mut self, t: f64, is_last: bool) -> Result<Vec<(usize, Root)>, Reason> {
        // as SUNDIALS has it
        let tolerance = 100.0 * f64::EPSILON * (t.abs() + (t - self.t).abs());
        let Self { engine, events, watches, scratch, parameters, .. } = self;
        let mut search = |i: usize| {
            let event = &mut events[i];
            watches[i].next_root((t, is_last), tolerance, &mut |at| {
                engine.interpolate(at, 0, scratch)?;
                value(event, i, at, scratch, parameters)
            })
        };
        let count = self.counts.len();
        let mut roots = Vec::with_capacity(count);
        for i in 0..count {
            roots.push(search(i)?);
        }
        loop {
            let times = roots.iter().flatten().map(|root| root.t * self.sign);
            let first = times.fold(f64::INFINITY, f64::min);
            if first == f64::INFINITY {
                return Ok(Vec::new());
            }
            let mut met: Vec<(usize, Root)> = Vec::new();
            for (i, root) in roots.iter().enumerate() {
                if let Some(root) = root
                    && root.t * self.sign <= first + 2.0 * tolerance
                {
                    met.push((i, *root));
                }
            }
            // all of them at the last of their times, where every one has crossed zero
            let at =
                met.iter().map(|(_, root)| root.t * self.sign).fold(first, f64::max) * self.sign;
            let mut y = vec![0.0; self.y.len()];
            self.engine.interpolate(at, 0, &mut y)?;
            let mut stops = false;
            for (i, root) in &mut met {
                root.t = at;
                self.counts[*i] += 1;
                let event = &self.events[*i];
                stops |= event.action.is_some() || event.last == Some(self.counts[*i]);
                let occurrence = Occurrence { event: *i, t: at, sign: root.sign, y: y.clone() };
                self.occurred.push(occurrence);
            }
            if stops {
                return Ok(met);
            }
            for (i, _) in met {
                let event = &mut self.events[i];
                let (engine, scratch, parameters) =
                    (&mut self.engine, &mut self.scratch, &self.parameters);
                roots[i] = self.watches[i].next_root((t, is_last), tolerance, &mut |at| {
                    engine.interpolate(at, 0, scratch)?;
                    value(event, i, at, scratch, parameters)
                })?;
            }
        }
    }

    /// Does what the events at the present time ask for.
    fn jump_at_events(&mut self, met: &[(usize, Root)]) -> Result<(), Reason> {
        let mut acting = Vec::new();
        let y = self.y.clone();
        for (i, _) in met {
            let event = &mut self.events[*i];
            let mut ends = event.last == Some(self.counts[*i]);
            if let Some(action) = &mut event.action {
                acting.push(*i);
                let (y, yp, p) = (&mut self.y, &mut self.yp, &mut self.parameters);
                let mut jump = Jump { t: self.t, y, yp, p, ends };
                action(&mut jump);
                ends = jump.ends;
            }
            if ends && self.end.is_none() {
                self.end = Some(End::Event(*i));
            }
        }
        if !acting.is_empty() {
            self.carry_across_event(&y, &acting)?;
            self.land(y, met)?;
        }
        Ok(())
    }

    /// Carries the sensitivities across the actions of these events, from the state `before` to the present one.
    fn carry_across_event(&mut self, before: &[f64], acting: &[usize]) -> Result<(), Reason> {
        let Some(carried) = &mut self.carried else { return Ok(()) };
        let p = self.engine.parameters().to_vec();
        check_unchanged(&p, &self.parameters)?;
        let (h, t) = (self.t - self.t_old, self.t);
        let at = Crossing { t, h, before, after: &self.y, p: &p };
        let (engine, events) = (self.engine.as_mut(), &mut self.events);
        let function = &mut events[acting[0]].function;
        let taus = carried.of_time(engine, &at, |t, y, p| function(t, y, p))?;
        carried.cross(engine, &at, &taus, |jump| {
            for &i in acting {
                events[i].action.iter_mut().for_each(|action| action(jump));
            }
        })
    }

    /// Carries them across the actions of breaks, whose time depends on nothing.
    fn carry_across_break(
        &mut self,
        before: &[f64],
        actions: &mut [Action<'a>],
    ) -> Result<(), Reason> {
        let Some(carried) = &mut self.carried else { return Ok(()) };
        let p = self.engine.parameters().to_vec();
        check_unchanged(&p, &self.parameters)?;
        let (h, t) = (self.t - self.t_old, self.t);
        let at = Crossing { t, h, before, after: &self.y, p: &p };
        let taus = vec![0.0; p.len()];
        carried.cross(self.engine.as_mut(), &at, &taus, |jump| {
            actions.iter_mut().for_each(|action| action(jump));
        })
    }

    fn jump_at_break(&mut self) -> Result<(), Reason> {
        let Some(Break { t, .. }) = self.breaks.last() else { return Ok(()) };
        self.t = *t;
        self.stale = true;
        let y = self.y.clone();
        let mut actions = Vec::new();
        while let Some(mut next) = self.breaks.pop_if(|next| next.t == self.t) {
            if let Some(action) = &mut next.action {
                let (y, yp, p) = (&mut self.y, &mut self.yp, &mut self.parameters);
                let mut jump = Jump { t: self.t, y, yp, p, ends: false };
                action(&mut jump);
                if jump.ends {
                    self.end = Some(End::Break);
                }
            }
            actions.extend(next.action);
        }
        if actions.is_empty() {
            return Ok(());
        }
        self.carry_across_break(&y, &mut actions)?;
        self.land(y, &[])
    }

    /// Takes over what actions have made of the state, which was `before`, and of the parameters.
    fn land(&mut self, before: Vec<f64>, met: &[(usize, Root)]) -> Result<(), Reason> {
        self.stale = true;
        self.before.get_or_insert(before);
        check_finite("state after the jump", &self.y)?;
        check_finite("parameters after the jump", &self.parameters)?;

        self.engine.set_parameters(&self.parameters);
        for (i, watch) in self.watches.iter_mut().enumerate() {
            let g = value(&mut self.events[i], i, self.t, &self.y, &self.parameters)?;
            let noise =
                met.iter().find(|(event, _)| *event == i).map_or(0.0, |(_, root)| root.noise);
            watch.restart(self.t, g, noise);
        }
        Ok(())
    }

    /// Starts the integrator anew where something has changed.
    fn start_anew(&mut self) -> Result<(), Reason> {
        if !self.stale {
            return Ok(());
        }
        self.past = self.statistics();
        self.stale = false;
        self.engine.restart(self.t, &self.y, &self.yp, self.span.1)?;
        if let Some(carried) = &self.carried {
            carried.hand_over(self.engine.as_mut())?;
        }
        Ok(self.set_stop_time()?)
    }

    fn set_stop_time(&mut self) -> Result<(), integrate::Error> {
        let stop = self.breaks.last().map_or(self.span.1, |next| self.just_before(next.t));
        self.engine.set_stop_time(stop)
    }

    /// The last number before time `t`.
    fn just_before(&self, t: f64) -> f64 {
        if self.sign > 0.0 { t.next_down() } else { t.next_up() }
    }

    fn check_limits(&mut self) -> Result<(), Reason> {
        if self.cancel.as_ref().is_some_and(|flag| flag.load(Relaxed)) {
            return Err(Reason::Cancelled);
        }
        let statistics = self.statistics();
        let evaluations = statistics.evaluations + statistics.difference_quotient_evaluations;
        if statistics.steps >= self.limits.steps {
            return Err(Reason::Steps(statistics.steps));
        }
        if self.limits.evaluations.is_some_and(|most| evaluations >= most) {
            return Err(Reason::Evaluations(evaluations));
        }
        match self.limits.wall_time {
            Some(most) if self.started.elapsed() >= most => {
                Err(Reason::WallTime(self.started.elapsed()))
            }
            _ => Ok(()),
        }
    }

    /// Shows the step to the observer.
    fn report(&mut self) {
        let Some(mut observer) = self.observer.take() else { return };
        let (start, end) = self.span;
        let part = (self.t - start) / (end - start);
        let steps = self.statistics().steps;
        let goes_on = observer(Progress { t: self.t, y: &self.y, steps, part });
        self.observer = Some(observer);
        if goes_on == ControlFlow::Break(()) {
            // the next step tells
            self.cancel = Some(Arc::new(true.into()));
        }
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

    /// Its time derivative, of a DAE; empty otherwise.
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        &self.yp
    }

    /// The parameters of the equations.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Why the run is at its end; none before.
    #[must_use]
    pub fn end(&self) -> Option<End> {
        self.end
    }

    /// Where the run stands, to be taken up later or by another program: [`Problem::resume`].
    #[must_use]
    pub fn save(&self) -> Saved {
        Saved {
            t: self.t,
            y: self.y.clone(),
            yp: self.yp.clone(),
            parameters: self.parameters.clone(),
            counts: self.counts.clone(),
            sensitivities: self.carried.as_ref().map_or(Vec::new(), |carried| carried.s.clone()),
            event_values: self.watches.iter().map(Watch::value).collect(),
        }
    }

    /// The sensitivities at the present time, after any jump: entry (i, j) is the derivative of unknown i to the j-th parameter of
    /// [`Options::sensitivities`].
    #[must_use]
    pub fn sensitivities(&self) -> MatRef<'_, f64> {
        let s = self.carried.as_ref().map_or(&[][..], |carried| &carried.s);
        MatRef::from_column_major_slice(s, self.y.len(), s.len() / self.y.len())
    }

    /// The sensitivities at the present time, one column after the other.
    pub(super) fn sensitivities_after(&self) -> &[f64] {
        self.carried.as_ref().map_or(&[][..], |carried| &carried.s)
    }

    /// The sensitivities that belong to the states of the last step: before its jump, or at its end if there was none.
    pub(super) fn sensitivities_before(&self) -> &[f64] {
        let Some(carried) = &self.carried else { return &[] };
        carried.before.as_ref().unwrap_or(&carried.s)
    }

    /// The sensitivities at time `t` within the last step, one column after the other.
    pub(super) fn sensitivities_at(&mut self, t: f64) -> Result<Vec<f64>, Reason> {
        let Some(carried) = &self.carried else { return Ok(Vec::new()) };
        let (n, mut s) = (self.y.len(), vec![0.0; carried.s.len()]);
        let columns = s.len() / n;
        let out = MatMut::from_column_major_slice_mut(&mut s, n, columns);
        self.engine.interpolate_sensitivities(t, out)?;
        Ok(s)
    }

    /// Writes the state at time `t` within the last step, before any jump at its end, into `out`.
    ///
    /// # Errors
    /// If `t` lies outside the last step, or `out` has another length than the state.
    pub fn interpolate(&mut self, t: f64, out: &mut [f64]) -> Result<(), integrate::Error> {
        let [low, high] = if self.sign > 0.0 { [self.t_old, self.t] } else { [self.t, self.t_old] };
        if !(low <= t && t <= high) {
            let mend = format!("the last step is [{low}, {high}]");
            return Err(InputError::new("t", t, mend).into());
        }
        // the number before a break is as far as the integrator went
        let reached = self.engine.t();
        let t = if (t - reached) * self.sign > 0.0 { reached } else { t };
        self.engine.interpolate(t, 0, out)
    }

    /// +1 forward in time, -1 backward.
    pub(super) fn direction(&self) -> f64 {
        self.sign
    }

    /// Degree of the polynomial of the last step.
    pub(super) fn interpolant_degree(&self) -> u32 {
        self.engine.interpolant_degree().max(1)
    }

    /// What the run has cost so far.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.past.followed_by(&self.engine.statistics())
    }
}

/// The value of the function of event `i`.
fn value(event: &mut Event<'_>, i: usize, t: f64, y: &[f64], p: &[f64]) -> Result<f64, Reason> {
    match (event.function)(t, y, p) {
        value if value.is_nan() => Err(Reason::Event { event: i, t, value }),
        value => Ok(value),
    }
}

/// Stops what sensitivities cannot follow.
fn check_unchanged(before: &[f64], after: &[f64]) -> Result<(), InputError> {
    match before.iter().zip(after).position(|(before, after)| before != after) {
        None => Ok(()),
        Some(i) => {
            let mend = "with sensitivities an action changes the state alone";
            Err(InputError::new(format!("parameter {i} after the jump"), after[i], mend))
        }
    }
}
