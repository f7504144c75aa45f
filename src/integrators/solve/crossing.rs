//! Discontinuities of a run: events, breaks, and the jumps at both.
//!
//! Where an action changes something, the step ends there and the integrator restarts. A break ends a step
//! at the last floating-point number before it, so that equations which test `t < break` are on the left side
//! up to there, and on the right side from the new start on.

use std::mem;

use super::{
    engine::{Engine, Start},
    error::Reason,
    event::{Jump, check_crosses},
    run::Run,
    sensitivities::{Carried, Crossing},
    snapshot::{Act, Snapshot},
    solution::{End, Occurrence},
    watch::{Root, Seen, Sight, Turn},
};
use crate::base::input::InputError;
use crate::integrators::{
    common::{Error, check_finite, time_tolerance},
    ode::Failure,
};

/// Events within a step.
pub(super) enum StepEvents {
    /// Events that stop it, all at one time; or none.
    Jumps(Vec<(usize, Root)>),
    /// The event of this number accumulates where the step began.
    Accumulation(usize, Turn),
}

impl<'a> Run<'a> {
    /// Finds the events of the step that has just been made, up to `t`, and records them. Returns those that
    /// stop the step, which are recorded last. `is_last` says that the next step, if any, does not continue
    /// from there, but starts at a break.
    pub(super) fn look_for_events(&mut self, t: f64, is_last: bool) -> Result<StepEvents, Reason> {
        let mut seen = mem::take(&mut self.seen);
        seen.fill(Seen::default());
        let found = self.look_for_roots((t, is_last), &mut seen);
        self.seen = seen;
        found
    }

    fn look_for_roots(
        &mut self,
        up_to: (f64, bool),
        seen: &mut [Seen],
    ) -> Result<StepEvents, Reason> {
        let tolerance = time_tolerance(up_to.0 - self.span.0, up_to.0 - self.t);
        for (i, seen) in seen.iter_mut().enumerate() {
            self.watches[i].begin_step(self.t, self.sign);
            let sight = self.search(i, up_to, tolerance, &mut seen.undefined)?;
            if let Sight::Passage(turn) = sight {
                return Ok(StepEvents::Accumulation(i, turn));
            }
            seen.root = sight.root();
        }
        loop {
            let times = seen.iter().filter_map(|seen| seen.root).map(|root| root.t * self.sign);
            let first = times.fold(f64::INFINITY, f64::min);
            for (event, seen) in seen.iter().enumerate() {
                if let Some(t) = seen.undefined
                    && first >= t * self.sign
                {
                    return Err(Reason::Event { event, t, value: f64::NAN });
                }
            }
            if first == f64::INFINITY {
                return Ok(StepEvents::Jumps(Vec::new()));
            }
            let mut met: Vec<(usize, Root)> = Vec::new();
            for (i, seen) in seen.iter().enumerate() {
                if let Some(root) = seen.root
                    && root.t * self.sign <= first + 2.0 * tolerance
                {
                    met.push((i, root));
                }
            }
            // all of them are placed at the last of their times, where every one has crossed zero
            let at =
                met.iter().map(|(_, root)| root.t * self.sign).fold(first, f64::max) * self.sign;
            let mut y = vec![0.0; self.y.len()];
            write_state(self.engine.as_mut(), (self.t, &self.y), at, &mut y)?;
            let mut stops = false;
            for (i, root) in &mut met {
                root.t = at;
                root.counts &= self.armed[*i];
                if !root.counts {
                    continue;
                }
                self.count(*i);
                let event = &self.events[*i];
                stops |= event.action.is_some() || event.last == Some(self.counts[*i]);
                let occurrence = Occurrence { event: *i, t: at, sign: root.sign, y: y.clone() };
                self.occurred.push(occurrence);
            }
            if stops || self.switches(&met, at, &y)? {
                return Ok(StepEvents::Jumps(met));
            }
            for (i, _) in met {
                let Seen { root, undefined } = &mut seen[i];
                *root = self.search(i, up_to, tolerance, undefined)?.root();
            }
        }
    }

    /// The next root that the tracker of event `i` finds, up to a time in the step that has just been made; and when its function was
    /// first `undefined`.
    fn search(
        &mut self,
        i: usize,
        up_to: (f64, bool),
        tolerance: f64,
        undefined: &mut Option<f64>,
    ) -> Result<Sight, Reason> {
        let Self { engine, events, watches, scratch, parameters, sign, t, y, .. } = self;
        let event = &mut events[i];
        let is_short = (up_to.0 - *t).abs() <= tolerance;
        let mut value = |at: f64| {
            write_state(engine.as_mut(), (*t, y), at, scratch)?;
            let value = event.function.at(at, scratch, parameters);
            if value.is_nan() && undefined.is_none_or(|first| at * *sign < first * *sign) {
                *undefined = Some(at);
            }
            Ok::<f64, Reason>(value)
        };
        match is_short {
            true => watches[i].leap(up_to, &mut value),
            false => watches[i].next_root(up_to, tolerance, &mut value),
        }
    }

    /// Whether the slope at the present time leads the function of event `i` back to the side that it came
    /// from.
    ///
    /// That is judged over the shortest time in which the function changes by more than noise.
    fn leads_back(&mut self, i: usize, turn: Turn) -> Result<bool, Reason> {
        let slope = self.slope_here()?;
        let unit = self.sign * self.unit_of_time(&self.y, &slope);
        let Self { events, scratch, parameters, y, t, .. } = self;
        let mut value = |time: f64| {
            let moved = y.iter().zip(&slope).map(|(y, slope)| y + time * slope);
            scratch.iter_mut().zip(moved).for_each(|(scratch, y)| *scratch = y);
            events[i].function.at(*t + time, scratch, parameters)
        };
        let mut part = f64::EPSILON.cbrt();
        while part < 1.0 {
            if let Some(back) = turn.leads_back(value(part * unit) - value(-part * unit)) {
                return Ok(back);
            }
            part *= 8.0;
        }
        Ok(false)
    }

    /// The time derivative of the present state; 0 for algebraic unknowns.
    pub(super) fn slope_here(&mut self) -> Result<Vec<f64>, Reason> {
        // the present y' of a DAE is that of the step's polynomial, or accurate only for a step as short as
        // the last: consistent values are sought again from zero, on the scale of the span
        let (mut y, mut slope) = (self.y.clone(), vec![0.0; self.yp.len()]);
        let start = Start { t: self.t, y: &mut y, yp: &mut slope, s: None };
        if self.engine.correct(start, self.span.1).is_err() || !self.engine.can_be_consistent() {
            slope.copy_from_slice(&self.yp);
        }
        self.slope_at(self.t, &self.y.clone(), slope)
    }

    /// The time derivative of the state `y`: `yp` of a DAE.
    pub(super) fn slope_at(&mut self, t: f64, y: &[f64], yp: Vec<f64>) -> Result<Vec<f64>, Reason> {
        let mut slope = yp;
        slope.resize(y.len(), 0.0);
        self.engine.slope(t, y, &mut slope).map_err(|failure| {
            let help = "it is needed on both sides of an event and of a jump";
            InputError::new("right-hand side at a jump", failure.into_error(), help)
        })?;
        Ok(slope)
    }

    /// The integrands on one side of a jump at the present time.
    fn integrands_at(&mut self, side: &Snapshot, out: &mut [f64]) -> Result<(), Reason> {
        let outcome = self.engine.integrands(self.t, &side.y, &side.yp, out);
        let failed = |failure: Failure| {
            let help = "they are needed on both sides of an event and of a jump";
            InputError::new("integrands at a jump", failure.into_error(), help)
        };
        Ok(outcome.map_err(failed)?)
    }

    /// Handles the accumulation of event `i` at the present time.
    pub(super) fn accumulate(&mut self, i: usize, turn: Turn) -> Result<(), Reason> {
        let before = self.snapshot();
        let action = self.events[i].at_accumulation.as_mut();
        let Some(action) = action.filter(|_| self.carried.is_none() && !turn.at_rest) else {
            return Err(Reason::Accumulation { event: i, t: self.t, count: self.counts[i] });
        };
        let (y, yp, p) = (&mut self.y, &mut self.yp, &mut self.parameters);
        let mut jump = Jump::new(self.t, y, yp, p);
        action(&mut jump);
        let Jump { ends, armed, .. } = jump;
        if ends {
            self.end = Some(End::Event(i));
        }
        self.arm(armed)?;
        self.land(&before, &[])?;
        self.watches[i].expect_rest(turn);
        Ok(())
    }

    /// Performs the actions of the events at the present time.
    pub(super) fn jump_at_events(&mut self, met: &[(usize, Root)]) -> Result<(), Reason> {
        for (i, root) in met.iter().filter(|(_, root)| root.sign != 0 && root.counts) {
            // the function crossed zero by less than the error of the solution, whose slope leads the other
            // way
            let turn = Turn::at(root);
            let hurries = self.events[*i].action.is_some() && self.watches[*i].hurries(self.t);
            if hurries && self.leads_back(*i, turn)? {
                self.counts[*i] -= 1;
                self.occurred.retain(|at| at.event != *i || at.t != self.t);
                return self.accumulate(*i, turn);
            }
        }
        let (mut acting, mut arming) = (Vec::new(), Vec::new());
        self.sharpen_derivative()?;
        let before = self.snapshot();
        for (i, root) in met.iter().filter(|(_, root)| root.counts) {
            let acts = self.events[*i].action.is_some();
            if self.carried.is_some() && acts {
                check_crosses(*i, self.t, root.sign != 0)?;
            }
            if acts {
                self.note(Act::Event(*i));
            }
            let event = &mut self.events[*i];
            let mut ends = event.last == Some(self.counts[*i]);
            if let Some(action) = &mut event.action {
                acting.push(*i);
                let (y, yp, p) = (&mut self.y, &mut self.yp, &mut self.parameters);
                let mut jump = Jump::new(self.t, y, yp, p);
                action(&mut jump);
                ends |= jump.ends;
                arming.extend(jump.armed);
            }
            if ends && self.end.is_none() {
                self.end = Some(End::Event(*i));
            }
        }
        self.arm(arming)?;
        let crossed = met.iter().filter(|(_, root)| root.sign != 0).map(|(i, _)| *i).next();
        let timed_by = acting.first().copied().or(crossed);
        let Some(timed_by) = timed_by.filter(|_| !acting.is_empty() || self.passes_sides()) else {
            return Ok(());
        };
        if acting.is_empty() {
            self.note(Act::Event(timed_by));
        }
        self.land(&before, met)?;
        self.carry_across_event(&before, timed_by, &acting)
    }

    /// Whether the solution goes on with the equations behind an event without an action.
    fn passes_sides(&self) -> bool {
        self.sides.is_some() && self.end.is_none()
    }

    /// Notes an action, or a passage, with the state before it.
    pub(super) fn note(&mut self, act: Act) {
        if self.sides.is_some() {
            self.log.push((act, self.snapshot()));
        }
    }

    /// Carries the sensitivities across the actions of these events at the time that the event `timed_by`
    /// determines, from the state `before` to the present one.
    fn carry_across_event(
        &mut self,
        before: &Snapshot,
        timed_by: usize,
        acting: &[usize],
    ) -> Result<(), Reason> {
        let mut events = mem::take(&mut self.events);
        let outcome = self.carry(before, |carried, at| {
            let function = &events[timed_by].function;
            let taus = carried.of_time(at, |t, y, p| function.at(t, y, p));
            carried.cross(at, &taus, |jump| {
                for &i in acting {
                    events[i].action.iter_mut().for_each(|action| action(jump));
                }
            })
        });
        self.events = events;
        outcome
    }

    /// Carries them by `cross` from the state `before` to the present one.
    pub(super) fn carry(
        &mut self,
        before: &Snapshot,
        cross: impl FnOnce(&mut Carried, &Crossing<'_>) -> Result<(), Reason>,
    ) -> Result<(), Reason> {
        let Some(mut carried) = self.carried.take() else { return Ok(()) };
        let (of_dae, here) = (!self.yp.is_empty(), self.snapshot());
        let count = if carried.has_integrals() { self.quadratures().len() } else { 0 };
        let (mut slopes, mut integrands) = (Vec::new(), [vec![0.0; count], vec![0.0; count]]);
        for (side, integrands) in [before, &here].into_iter().zip(&mut integrands) {
            self.engine.set_parameters(&side.p);
            self.set_signs(&side.sides);
            slopes.push(self.slope_at(self.t, &side.y, side.yp.clone())?);
            if count > 0 {
                self.integrands_at(side, integrands)?;
            }
        }
        let [left, right] = [&slopes[0][..], &slopes[1]];
        let (t, slopes, p) = (self.t, [left, right], &before.p);
        let unit_of_time = self.unit_of_time(&before.y, left);
        let integrands = [&integrands[0][..], &integrands[1]];
        let at = Crossing { t, unit_of_time, before: &before.y, slopes, integrands, of_dae, p };
        cross(&mut carried, &at)?;
        self.correct(Some((&mut carried.s, &carried.dp)))?;
        self.carried = Some(carried);
        Ok(())
    }

    /// Makes the present state of a DAE, and sensitivities, satisfy the equations.
    fn correct(&mut self, s: Option<(&mut [f64], &[f64])>) -> Result<(), Reason> {
        // a step that became short next to a switch is no measure
        let last = (self.t - self.t_old).abs().max(self.caution.until);
        let scale = if last > 0.0 { last } else { (self.span.1 - self.t).abs() };
        let (t, y, yp) = (self.t, &mut self.y[..], &mut self.yp[..]);
        let carries = s.is_some();
        match self.engine.correct(Start { t, y, yp, s }, t + self.sign * scale) {
            Err(error) if self.end.is_some() || carries => Err(error.into()),
            // otherwise the next start reports the error
            _ => Ok(()),
        }
    }

    /// Takes over the state, which was `before`, and the parameters as actions have left them.
    pub(super) fn land(&mut self, before: &Snapshot, met: &[(usize, Root)]) -> Result<(), Reason> {
        self.stale = true;
        self.before.get_or_insert_with(|| before.y.clone());
        check_finite("state after the jump", &self.y)?;
        check_finite("parameters after the jump", &self.parameters)?;
        self.engine.set_parameters(&self.parameters);
        self.choose_sides(met)?;
        self.correct(None)?;
        for (i, watch) in self.watches.iter_mut().enumerate() {
            let g = self.events[i].value(i, self.t, &self.y, &self.parameters)?;
            let noise =
                met.iter().find(|(event, _)| *event == i).map_or(0.0, |(_, root)| root.noise);
            watch.restart(self.t, g, noise);
        }
        let acts = |(i, root): &(usize, Root)| root.counts && self.events[*i].action.is_some();
        let jumps = met.iter().any(acts);
        for (i, root) in met {
            if root.sign == 0 {
                continue;
            }
            let (turn, acts) = (Turn::at(root), root.counts && self.events[*i].action.is_some());
            let turns = (acts || self.sides.is_some()) && self.leads_back(*i, turn)?;
            if acts {
                self.watches[*i].acted(root.t, turns.then_some(turn));
                let band = self.band(*i);
                self.watches[*i].hold(band, f64::from(root.sign));
            }
            if jumps {
                self.turn_side(*i, turns);
            } else if turns {
                let help = "the equations behind it lead back to it: derivatives do not exist where a solution slides along a switch";
                return Err(InputError::new(
                    format!("event {i} at t = {:?}", self.t),
                    "left to where it came from",
                    help,
                )
                .into());
            }
        }
        self.note_flow()
    }
}

/// Writes the state at a time within the step from `start`, where it was `first`. At neighbouring numbers, between which an integrator makes
/// many steps, it knows the last of these alone: states at the ends are those that the run has had.
pub(super) fn write_state(
    engine: &mut dyn Engine,
    (start, first): (f64, &[f64]),
    at: f64,
    out: &mut [f64],
) -> Result<(), Error> {
    if at == engine.t() {
        out.copy_from_slice(engine.y());
    } else if at == start {
        out.copy_from_slice(first);
    } else {
        engine.interpolate(at, 0, out)?;
    }
    Ok(())
}
