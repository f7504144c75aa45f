//! The history of a solution, for the backward run: its smooth pieces, and the jumps between them.

use std::cell::RefCell;

use super::{
    error::Reason,
    event::{Action, Event, Jump},
    method::Method,
    options::Options,
    problem::{Break, Equations, Problem},
    run::Run,
    solution::End,
};
use crate::integrators::ode::Borrowed;

/// A time, the state there, its time derivative (of a DAE), and the parameters of the equations.
#[derive(Clone)]
pub(super) struct Snapshot {
    pub(super) t: f64,
    pub(super) y: Vec<f64>,
    pub(super) yp: Vec<f64>,
    pub(super) p: Vec<f64>,
}

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

/// The action of an event or of a break, by its number.
#[derive(Clone, Copy)]
pub(super) enum Act {
    Event(usize),
    Break(usize),
}

impl Act {
    fn is_of_event(self) -> bool {
        matches!(self, Self::Event(_))
    }
}

impl Snapshot {
    fn of(run: &Run<'_>) -> Self {
        let (y, yp) = (run.y().to_vec(), run.yp().to_vec());
        Self { t: run.t(), y, yp, p: run.parameters().to_vec() }
    }
}

/// The problem lent to a run, with actions that record where they are called.
fn lend<'b>(problem: &'b mut Problem<'_>, log: &'b RefCell<Vec<(Act, Snapshot)>>) -> Problem<'b> {
    let note = move |act: Act, jump: &Jump<'_>| {
        let (y, yp, p) = (jump.y.to_vec(), jump.yp.to_vec(), jump.p.to_vec());
        log.borrow_mut().push((act, Snapshot { t: jump.t, y, yp, p }));
    };
    let events = problem.events.iter_mut().enumerate().map(|(i, event)| {
        let Event { function, direction, last, action, samples, touching, .. } = event;
        let action = action.as_mut().map(|action| -> Action<'b> {
            Box::new(move |jump| {
                note(Act::Event(i), jump);
                action(jump);
            })
        });
        let function = Box::new(|t: f64, y: &[f64], p: &[f64]| function(t, y, p));
        let (direction, last) = (*direction, *last);
        let (samples, touching) = (*samples, *touching);
        // no backward run of a gradient can pass infinitely many jumps
        Event { function, direction, last, action, at_accumulation: None, samples, touching }
    });
    let breaks = problem.breaks.iter_mut().enumerate().map(|(i, at)| {
        let Break { t, action } = at;
        let action: Action<'b> = Box::new(move |jump| {
            note(Act::Break(i), jump);
            action.iter_mut().for_each(|action| action(jump));
        });
        Break { t: *t, action: Some(action) }
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
    let initial_sensitivities = None;
    Problem { equations, y, events, breaks, observer, cancel, saved, initial_sensitivities }
}

/// Solves `problem`. Returns its history, and where it ends.
pub(super) fn follow(
    problem: &mut Problem<'_>,
    method: Method,
    span: (f64, f64),
    options: &Options,
) -> Result<(Vec<HistoryPart>, Snapshot), Reason> {
    let log = RefCell::new(Vec::new());
    let mut run = Run::new(lend(problem, &log), method, span, options)?;
    let mut parts = Vec::new();
    let mut from = Snapshot::of(&run);
    while let Some(step) = run.advance()? {
        let touched: Vec<_> =
            step.events.iter().filter(|at| at.sign == 0).map(|at| at.event).collect();
        let noted = log.take();
        let Some((act, first)) = noted.first() else { continue };
        let to = if act.is_of_event() { first.t } else { run.just_before(first.t) };
        let here = Snapshot::of(&run);
        parts.push(HistoryPart::Smooth { from, to });
        let mut groups =
            noted.chunk_by(|(a, _), (b, _)| a.is_of_event() == b.is_of_event()).peekable();
        while let Some(group) = groups.next() {
            let after = groups.peek().map_or(&here, |next| &next[0].1).clone();
            let acts: Vec<_> = group.iter().map(|(act, _)| *act).collect();
            let timed_by = match acts[0] {
                Act::Event(i) => Some(i),
                Act::Break(_) => None,
            };
            let crosses = timed_by.is_none_or(|i| !touched.contains(&i));
            let before = group[0].1.clone();
            let ends = false;
            parts.push(HistoryPart::Jump(Passage { timed_by, crosses, acts, before, after, ends }));
        }
        from = here;
    }
    let here = Snapshot::of(&run);
    let ending = match run.end() {
        Some(End::Event(i)) => Some(i),
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
