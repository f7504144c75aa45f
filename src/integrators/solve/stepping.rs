//! A run at work: one step after the other.

use std::{
    mem,
    ops::ControlFlow,
    sync::{Arc, atomic::Ordering::Relaxed},
};

use super::{
    crossing::StepEvents,
    error::Reason,
    problem::Progress,
    run::{Run, Step},
    solution::End,
};
use crate::integrators::common::is_fine;

impl Run<'_> {
    /// Makes one step; `None` at the end of the run.
    ///
    /// A step ends where the state may change: at a break, or at an event that has an action or
    /// ends the run.
    ///
    /// # Errors
    /// The reason why the run cannot continue. The state that was reached remains: [`t`](Self::t), [`y`](Self::y). If it is the number of
    /// steps, [`notice`](Self::notice) may have the cause.
    pub fn advance(&mut self) -> Result<Option<Step<'_>>, Reason> {
        if self.end.is_some() {
            return Ok(None);
        }
        self.check_limits()?;
        self.restart_if_changed()?;
        // those of the start are shown with the first step
        self.occurred.drain(..mem::take(&mut self.shown));
        self.log.clear();
        self.before = None;
        let (t_old, end) = (self.t, self.span.1);
        // no step from one number to the next among fine ones, where a break directly follows another one, an event
        // or the start
        if !(is_fine(t_old) && self.is_before_break(t_old))
            && let Err(error) = self.engine.step(end)
        {
            return self.at_edge(error).map(Some);
        }
        let mut t = self.engine.t();
        let at_break = self.is_before_break(t);
        self.note_step()?;
        let jumps = match self.look_for_events(t, at_break || t == end)? {
            StepEvents::Jumps(jumps) => jumps,
            // the step passes through zero, where the action should have turned the solution back: a jump
            // replaces it
            StepEvents::Accumulation(event, turn) => {
                self.accumulate(event, turn)?;
                self.t_old = self.t;
                return Ok(Some(self.made_step()));
            }
        };
        let stops_at = jumps.first().map(|(_, root)| root.t);
        self.check_step(stops_at.unwrap_or(t))?;
        match stops_at.unwrap_or(t) {
            end if end == t => {
                self.y.copy_from_slice(self.engine.y());
                self.yp.copy_from_slice(self.engine.yp());
            }
            // its state is the present one
            start if start == t_old => t = start,
            at => {
                t = at;
                let y = &mut self.scratch;
                self.engine.interpolate(t, 0, y)?;
                self.y.copy_from_slice(y);
                if !self.yp.is_empty() {
                    self.engine.interpolate(t, 1, y)?;
                    self.yp.copy_from_slice(y);
                }
            }
        }
        (self.t_old, self.t) = (t_old, t);
        if let Some(carried) = &mut self.carried {
            carried.read(self.engine.as_mut(), t)?;
        }
        let [q, past] = &mut self.quadratures;
        self.engine.quadratures_at(t, q)?;
        q.iter_mut().zip(past).for_each(|(q, past)| *q += *past);
        let at_break = at_break && stops_at.is_none_or(|at| at == self.engine.t());
        let reached = self.breaks.last().filter(|_| at_break).map_or(t, |next| next.t);
        self.record_ticks(reached)?;
        if stops_at.is_some() {
            self.jump_at_events(&jumps)?;
        }
        if at_break {
            self.jump_at_break()?;
        }
        if self.t == end && self.end.is_none() {
            self.end = Some(End::Span);
        }
        Ok(Some(self.made_step()))
    }

    /// Shows the step to the observer, and to the caller.
    pub(super) fn made_step(&mut self) -> Step<'_> {
        self.report();
        self.shown = self.occurred.len();
        Step {
            t_old: self.t_old,
            t: self.t,
            y: &self.y,
            before: self.before.as_deref(),
            events: &self.occurred,
        }
    }

    /// Restarts the integrator after a change.
    pub(super) fn restart_if_changed(&mut self) -> Result<(), Reason> {
        if !self.stale {
            return Ok(());
        }
        self.past = self.statistics();
        self.stale = false;
        let [q, past] = &mut self.quadratures;
        past.copy_from_slice(q);
        self.engine.restart(self.t, &self.y, &self.yp)?;
        if let Some(carried) = &mut self.carried {
            carried.hand_over(self.engine.as_mut())?;
        }
        self.engine.make_consistent(self.span.1)?;
        Ok(self.set_stop_time()?)
    }

    fn check_limits(&mut self) -> Result<(), Reason> {
        if self.cancel.as_ref().is_some_and(|flag| flag.load(Relaxed)) {
            return Err(Reason::Cancelled);
        }
        let steps = self.steps();
        if steps >= self.limits.steps {
            self.engine.diagnose()?;
            return Err(Reason::Steps(steps));
        }
        if let Some(most) = self.limits.evaluations {
            let statistics = self.statistics();
            let evaluations = statistics.evaluations + statistics.difference_quotient_evaluations;
            if evaluations >= most {
                return Err(Reason::Evaluations(evaluations));
            }
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
        let steps = self.steps();
        let goes_on = observer(Progress { t: self.t, y: &self.y, steps, part });
        self.observer = Some(observer);
        if goes_on == ControlFlow::Break(()) {
            // the next step reports it
            self.cancel = Some(Arc::new(true.into()));
        }
    }
}
