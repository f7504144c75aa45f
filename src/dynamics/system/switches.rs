//! Discontinuities of forces: inadmissible steps, switches, and obstacles that are passed within a step.

use std::ops::Range;
use std::sync::Arc;

use super::{System, flow_of};
use crate::dynamics::state::State;
use crate::elements::force::{Capabilities, Force, Step};
use crate::integrators::ode::Failure;

impl System {
    /// Asks the forces whether the step from displacements `before` to the state `after` makes sense.
    pub(crate) fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        let State { u, internal, .. } = self.layout.of(after);
        let all = self.forces.iter().chain(&self.flow);
        let mut all = all.filter_map(|force| force.capabilities().step_check);
        all.try_for_each(|force| force.check_step(t, before, u))?;
        let (_, amounts) = self.layout.split(internal);
        match flow_of(&self.flow) {
            Some(flow) if !amounts.is_empty() => flow.check(t, u, amounts),
            _ => Ok(()),
        }
    }

    /// Number of switches of all forces.
    pub(crate) fn switches(&self) -> usize {
        self.forces.iter().map(switches).sum()
    }

    /// Writes the values of the switches of each force for which `is_wanted` is true, by their numbers.
    pub(crate) fn switch_values(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        values: &mut [f64],
        is_wanted: impl Fn(Range<usize>) -> bool,
    ) {
        let mut start = 0;
        for force in &self.forces {
            let Some(force) = force.capabilities().switches else { continue };
            let own = start..start + force.switches();
            start = own.end;
            if is_wanted(own.clone()) {
                force.switch_values(t, u, v, &mut values[own]);
            }
        }
    }

    /// Whether switches and [`passage`](Self::passage) are to be checked after each step.
    pub(crate) fn can_be_passed(&self) -> bool {
        self.forces.iter().any(|force| {
            let Capabilities { switches, contact, .. } = force.capabilities();
            switches.is_some() || contact.is_some()
        })
    }

    /// A time (s) within a step at which a force acts that is not seen at the ends of the step, if any.
    pub(crate) fn passage(
        &self,
        step: &Step,
        tolerance: f64,
        mut clearances: &mut [f64],
    ) -> Option<f64> {
        let mut first: Option<f64> = None;
        for force in &self.forces {
            let (own, rest) = clearances.split_at_mut(switches(force));
            clearances = rest;
            let contact = force.capabilities().contact;
            if let Some(t) = contact.and_then(|contact| contact.passage(step, tolerance, own)) {
                first = Some(first.map_or(t, |first| first.min(t)));
            }
        }
        first
    }

    /// Holds each of the switches on or off, or lets all of them follow their values again.
    pub(crate) fn hold_switches(&self, on: Option<&[bool]>) {
        let mut start = 0;
        for force in &self.forces {
            let Some(force) = force.capabilities().switches else { continue };
            let end = start + force.switches();
            force.hold_switches(on.map(|on| &on[start..end]));
            start = end;
        }
    }

    /// For each force, the counterpart in friction, and [whether it
    /// slides](crate::elements::force::Switches::slides) there.
    pub(crate) fn slides(&self) -> impl Iterator<Item = Option<(&str, Option<bool>)>> {
        self.forces.iter().map(|force| force.capabilities().switches?.slides())
    }
}

/// Number of switches of a force.
fn switches(force: &Arc<dyn Force>) -> usize {
    force.capabilities().switches.map_or(0, |force| force.switches())
}
