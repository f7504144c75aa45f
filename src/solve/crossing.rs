//! What happens along a run: events, breaks, and the jumps at both.

use super::{
    error::Reason,
    event::{Action, Jump},
    problem::Break,
    run::Run,
    sensitivities::Crossing,
    solution::{End, Occurrence},
    watch::Root,
};
use crate::{input::InputError, integrate::check_finite};

impl<'a> Run<'a> {
    /// Finds the events of the step that has just been made, up to `t`, and notes them. Those that stop the step are returned, the last ones noted.
    /// `is_last` tells that the next step does not go on from there, but from a break, if at all.
    pub(super) fn look_for_events(
        &mut self,
        t: f64,
        is_last: bool,
    ) -> Result<Vec<(usize, Root)>, Reason> {
        // as SUNDIALS has it
        let tolerance = 100.0 * f64::EPSILON * (t.abs() + (t - self.t).abs());
        let Self { engine, events, watches, scratch, parameters, .. } = self;
        let mut search = |i: usize| {
            let event = &mut events[i];
            watches[i].next_root((t, is_last), tolerance, &mut |at| {
                engine.interpolate(at, 0, scratch)?;
                event.value(i, at, scratch, parameters)
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
                    event.value(i, at, scratch, parameters)
                })?;
            }
        }
    }

    /// Does what the events at the present time ask for.
    pub(super) fn jump_at_events(&mut self, met: &[(usize, Root)]) -> Result<(), Reason> {
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

    pub(super) fn jump_at_break(&mut self) -> Result<(), Reason> {
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
            let g = self.events[i].value(i, self.t, &self.y, &self.parameters)?;
            let noise =
                met.iter().find(|(event, _)| *event == i).map_or(0.0, |(_, root)| root.noise);
            watch.restart(self.t, g, noise);
        }
        Ok(())
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
