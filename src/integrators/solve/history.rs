//! The history of a solution, for the backward run: its smooth pieces, and the jumps between them.

use std::mem;

use super::{
    error::Reason,
    event::{Action, Event},
    method::Method,
    options::Options,
    problem::{Break, Equations, Problem},
    run::Run,
    snapshot::{Act, Snapshot},
    solution::End,
};
use crate::integrators::ode::Borrowed;

/// One part of a solution.
pub(super) enum HistoryPart {
    /// From a state to a time, without a jump.
    Smooth {
        from: Snapshot,
        to: f64,
    },
    Jump(Passage),
}

/// A jump.
pub(super) struct Passage {
    /// The event whose function determines its time; `None` at a break.
    pub(super) timed_by: Option<usize>,
    /// Whether that function crosses zero, rather than only touching it.
    pub(super) crosses: bool,
    /// The actions, in this order.
    pub(super) acts: Vec<Act>,
    pub(super) before: Snapshot,
    pub(super) after: Snapshot,
    /// Whether the solution ends with it.
    pub(super) ends: bool,
}

/// The problem lent to a run, which keeps to the sides of its events.
fn lend<'b>(problem: &'b mut Problem<'_>) -> Problem<'b> {
    // no backward run of a gradient can pass infinitely many jumps
    let events = problem.events.iter_mut().map(Event::lend);
    let breaks = problem.breaks.iter_mut().map(|at| {
        let Break { t, number, tick, action } = at;
        let action =
            action.as_mut().map(|action| -> Action<'b> { Box::new(move |jump| action(jump)) });
        Break { t: *t, number: *number, tick: *tick, action }
    });
    let (events, breaks) = (events.collect(), breaks.collect());
    let equations = match &mut problem.equations {
        Equations::Ode(system) => Equations::Ode(Box::new(Borrowed(system.as_mut()))),
        Equations::Dae { system, yp, differential } => {
            let (yp, differential) = (yp.clone(), differential.clone());
            Equations::Dae { system: Box::new(Borrowed(system.as_mut())), yp, differential }
        }
    };
    let observer = problem.observer.take();
    let (y, cancel, saved) = (problem.y.clone(), problem.cancel.clone(), problem.saved.clone());
    let (initial_sensitivities, sides) = (None, problem.sides.clone());
    Problem { equations, y, events, breaks, observer, cancel, saved, initial_sensitivities, sides }
}

/// Solves `problem`. Returns its history, and where it ends.
pub(super) fn follow(
    problem: &mut Problem<'_>,
    method: Method,
    span: (f64, f64),
    options: &Options,
) -> Result<(Vec<HistoryPart>, Snapshot), Reason> {
    let mut run = Run::new(lend(problem), method, span, options)?;
    let mut parts = Vec::new();
    let mut from = run.snapshot();
    let mut touched = Vec::new();
    loop {
        let noted = mem::take(&mut run.log);
        let here = run.snapshot();
        if let Some((act, first)) = noted.first()
            && from.t != first.t
        {
            let to = if act.is_at_root() { first.t } else { run.just_before(first.t) };
            parts.push(HistoryPart::Smooth { from: from.clone(), to });
        }
        let jumps = !noted.is_empty();
        let mut groups =
            noted.chunk_by(|(a, _), (b, _)| a.is_at_root() == b.is_at_root()).peekable();
        while let Some(group) = groups.next() {
            let after = groups.peek().map_or(&here, |next| &next[0].1).clone();
            let acts: Vec<_> = group.iter().map(|(act, _)| *act).collect();
            let timed_by = match acts[0] {
                Act::Event(i) => Some(i),
                Act::Tick(_) | Act::Break(_) => None,
            };
            let crosses = timed_by.is_none_or(|i| !touched.contains(&i));
            let before = group[0].1.clone();
            let ends = false;
            parts.push(HistoryPart::Jump(Passage { timed_by, crosses, acts, before, after, ends }));
        }
        if jumps {
            from = here;
        }
        let Some(step) = run.advance()? else { break };
        touched = step.events.iter().filter(|at| at.sign == 0).map(|at| at.event).collect();
    }
    let here = run.snapshot();
    let ending = match run.end() {
        Some(End::Event(i)) if run.events[i].schedule.is_none() => Some(i),
        _ => None,
    };
    match (parts.last_mut(), ending) {
        (Some(HistoryPart::Jump(last)), Some(_)) if from.t == here.t => {
            last.ends = last.timed_by.is_some();
        }
        _ => {
            if from.t != here.t {
                parts.push(HistoryPart::Smooth { from, to: here.t });
            }
            if let Some(i) = ending {
                let crosses = run.occurred.iter().all(|at| at.event != i || at.sign != 0);
                let (before, after) = (here.clone(), here.clone());
                let acts = Vec::new();
                let timed_by = Some(i);
                let last = Passage { timed_by, crosses, acts, before, after, ends: true };
                parts.push(HistoryPart::Jump(last));
            }
        }
    }
    Ok((parts, here))
}
