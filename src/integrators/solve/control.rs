//! A run under the caller's control: it goes to a time, jumps there, and goes back.

use super::{
    error::Reason,
    event::Jump,
    problem::Break,
    run::{Run, armed},
    saved::Saved,
    solution::{End, Occurrence},
    watch::EventTracker,
};
use crate::base::input::InputError;
use crate::integrators::common::check_time;

impl Run<'_> {
    /// Integrates to time `t`, or to the end of the run if that comes first, and returns the events up to there.
    ///
    /// A step ends there, and the next one continues from it without a new start of the integrator.
    ///
    /// # Errors
    /// [`Reason::Input`] if `t` lies behind the time reached or outside the span; otherwise as for
    /// [`advance`](Self::advance).
    pub fn advance_to(&mut self, t: f64) -> Result<Vec<Occurrence>, Reason> {
        check_time("time to advance to", t)?;
        let (sign, end) = (self.direction(), self.span.1);
        if (t - self.t) * sign < 0.0 || (end - t) * sign < 0.0 {
            let help = format!("the run has reached {:?} and goes to {end:?}", self.t);
            return Err(InputError::new("time to advance to", t, help).into());
        }
        let mut events = Vec::new();
        self.target = Some(t);
        let mut outcome =
            if self.stale { Ok(()) } else { self.set_stop_time().map_err(Reason::from) };
        while outcome.is_ok() && (t - self.t) * sign > 0.0 && self.end.is_none() {
            outcome = self.advance().map(|step| {
                events.extend(step.into_iter().flat_map(|step| step.events).cloned());
            });
        }
        self.target = None;
        outcome?;
        if !self.stale {
            self.set_stop_time()?;
        }
        Ok(events)
    }

    /// Changes the state, the parameters, or which events are armed at the present time, as the action of a break
    /// does. The integrator restarts from there.
    ///
    /// With sensitivities `change` is called some more times, at states nearby.
    ///
    /// ```
    /// use pliant::{
    ///     ode::with_parameters,
    ///     solve::{Method, Options, Problem, Run},
    /// };
    ///
    /// // y' = u: half a second of u = 1, and then what another program says; a second try from the middle
    /// let plant = with_parameters(
    ///     |_t, _y, u, ydot| {
    ///         ydot[0] = u[0];
    ///         Ok(())
    ///     },
    ///     [1.0],
    /// );
    /// let mut run = Run::new(Problem::ode(plant, [0.0]), Method::Bdf, (0.0, 2.0), &Options::new(1e-8, 1e-10))?;
    /// run.advance_to(0.5)?;
    /// let middle = run.save();
    /// run.jump(|jump| jump.p[0] = -3.0)?;
    /// run.advance_to(1.0)?;
    /// assert!((run.y()[0] + 1.0).abs() < 1e-8);
    /// run.restore(&middle)?;
    /// run.advance_to(1.0)?;
    /// assert!((run.y()[0] - 1.0).abs() < 1e-8);
    /// # Ok::<(), pliant::solve::Reason>(())
    /// ```
    ///
    /// # Errors
    /// [`Reason::Input`] if the run has ended, or a number is not finite afterwards.
    pub fn jump(&mut self, mut change: impl FnMut(&mut Jump<'_>)) -> Result<(), Reason> {
        if let Some(end) = self.end {
            let help = "it has ended: restore an earlier state, or make a longer one";
            return Err(InputError::new("run", format!("{end:?}"), help).into());
        }
        if self.carried.is_some() && !self.engine.can_be_consistent() {
            let help = "Problem::differential says which unknowns are differential";
            return Err(InputError::new("jump of a DAE with sensitivities", "made", help).into());
        }
        let before = self.snapshot();
        let mut jump = Jump::new(self.t, &mut self.y, &mut self.yp, &mut self.parameters);
        change(&mut jump);
        let Jump { ends, armed, .. } = jump;
        if ends {
            self.end = Some(End::Break);
        }
        self.arm(armed)?;
        self.land(&before, &[])?;
        self.carry(&before, |carried, at| {
            let taus = vec![0.0; at.p.len()];
            carried.cross(at, &taus, change)
        })
    }

    /// Returns to the time at which the run was [saved](Self::save), which may lie behind or ahead, with its state, parameters, events and
    /// breaks. Statistics and limits continue to count.
    ///
    /// # Errors
    /// [`Reason::Input`] if it was saved from another problem, or lies outside the span.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), Reason> {
        let lengths = [self.y.len(), self.yp.len(), self.events.len(), self.quadratures[0].len()];
        saved.check(lengths)?;
        let ((start, end), sign) = (self.span, self.direction());
        if (saved.t - start) * sign < 0.0 || (end - saved.t) * sign < 0.0 {
            let help = format!("the run goes from {start:?} to {end:?}");
            return Err(InputError::new("time of the saved run", saved.t, help).into());
        }
        let count = self.parameters.len();
        if saved.parameters.len() != count {
            let help = format!("the equations have {count}");
            let input = "length of parameters in the saved run";
            return Err(InputError::new(input, saved.parameters.len(), help).into());
        }
        (self.t_old, self.t, self.end) = (saved.t, saved.t, None);
        self.y.clone_from(&saved.y);
        self.yp.clone_from(&saved.yp);
        self.parameters.clone_from(&saved.parameters);
        self.counts.clone_from(&saved.counts);
        self.armed = armed(saved, &self.events);
        self.quadratures = [saved.quadratures.clone(), saved.quadratures.clone()];
        self.occurred.clear();
        (self.before, self.shown, self.stale) = (None, 0, true);
        self.engine.set_parameters(&self.parameters);
        if let Some(carried) = &mut self.carried {
            let Saved { sensitivities: s, parameter_sensitivities: dp, .. } = saved;
            carried.start([s, dp, &saved.quadrature_sensitivities], None)?;
        }
        self.breaks.append(&mut self.passed);
        self.breaks.retain(|at| at.tick.is_none());
        self.breaks.sort_by(|a, b| ((b.t - a.t) * sign).total_cmp(&0.0));
        let ahead = self.breaks.partition_point(|Break { t, .. }| (t - saved.t) * sign > 0.0);
        self.passed = self.breaks.split_off(ahead);
        for (i, event) in self.events.iter().enumerate() {
            let point = (saved.t, saved.event_values[i]);
            self.watches[i] = EventTracker::new(event, point, self.sides.is_some());
        }
        self.follow_events(true);
        self.choose_sides(&[])?;
        self.restart_if_changed()?;
        self.note_flow()
    }
}
