//! Events at the edge of the domain of the equations: behind them nothing is defined, and no step leads across.

use super::{
    error::Reason,
    event::Event,
    run::{Run, Step},
    solution::Occurrence,
    watch::Root,
};
use crate::base::root::crosses;
use crate::integrators::common::{self, Cause};

impl Run<'_> {
    /// The step in place of one that failed by `error`: to the events that the solution has come to within its tolerances, as where
    /// the right-hand side is undefined behind them and steps become ever shorter; or else the error.
    pub(super) fn at_edge(&mut self, error: common::Error) -> Result<Step<'_>, Reason> {
        let met = self.events_ahead(&error);
        let t = self.t;
        let mut stops = false;
        for (i, root) in &met {
            self.count(*i);
            let event = &self.events[*i];
            stops |= event.action.is_some() || event.last == Some(self.counts[*i]);
            let y = self.y.clone();
            self.occurred.push(Occurrence { event: *i, t, sign: root.sign, y });
        }
        if !stops {
            return Err(error.into());
        }
        self.t_old = t;
        self.jump_at_events(&met)?;
        Ok(self.made_step())
    }

    /// The events whose functions cross zero where the state is moved along its slope by as much as its tolerances, each with
    /// its root, for which the present time counts.
    fn events_ahead(&mut self, error: &common::Error) -> Vec<(usize, Root)> {
        match error {
            common::Error::Integration(error) if !matches!(error.cause, Cause::Fatal(_)) => {}
            _ => return Vec::new(),
        }
        let mut slope = self.yp.clone();
        slope.resize(self.y.len(), 0.0);
        if self.engine.slope(self.t, &self.y, &mut slope).is_err() {
            return Vec::new();
        }
        let longest = (self.span.1 - self.span.0).abs();
        let time = self.sign * self.tolerances.error_reach(&self.y, &slope, longest);
        let Self { events, watches, scratch, parameters, y, t, .. } = self;
        let mut value = |event: &Event<'_>, part: f64| {
            let moved = y.iter().zip(&slope).map(|(y, slope)| y + part * time * slope);
            scratch.iter_mut().zip(moved).for_each(|(scratch, y)| *scratch = y);
            event.function.at(*t, scratch, parameters)
        };
        let mut met = Vec::new();
        for (i, event) in events.iter().enumerate().filter(|(i, _)| self.armed[*i]) {
            let [before, now, mut behind] = [-1.0, 0.0, 1.0].map(|part| value(event, part));
            // along a straight line where the function itself is undefined behind
            if behind.is_nan() {
                behind = 2.0 * now - before;
            }
            // a 0 at the end of the last step, which the next one should decide about
            let arrived = now == 0.0 && watches[i].value() != 0.0;
            let from = if arrived { watches[i].value() } else { now };
            let sign = if from < 0.0 { 1 } else { -1 };
            if (arrived || crosses(now, behind)) && event.direction.counts(sign.into()) {
                met.push((i, Root::at(*t, now, sign)));
            }
        }
        met
    }
}
