//! Bytes as a problem with options and what is done with it. The problem has a closed form, and may misbehave; options may be nonsense.
//!
//! What has to hold: nothing panics but the system that was asked to, and its panic comes out; nothing hangs; states are
//! finite; where all goes well, they are right.

mod bytes;
mod options;
mod system;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use pliant::{
    integrate,
    rk::DormandPrince,
    solve::{self, End, Event, Method, Problem, Run},
    sundials::{Arkode, ButcherTable, Cvode, Ida, InitialCondition, Integrator, MassForm},
};

use bytes::Bytes;
use system::{PLANNED, System};

/// How a case ended, for those who count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The integrator was refused.
    Refused,
    /// The integration ended early, or some call was refused.
    Failed,
    /// It panicked as planned.
    Panicked,
    /// All calls went well.
    Done,
}

/// Runs the case of these bytes.
///
/// # Panics
/// If something does not hold that has to.
pub fn run(bytes: &[u8]) -> Outcome {
    let outcome = catch_unwind(AssertUnwindSafe(|| case(&mut Bytes::new(bytes))));
    outcome.unwrap_or_else(|panic| match panic.downcast_ref::<&str>() {
        Some(&PLANNED) => Outcome::Panicked,
        _ => resume_unwind(panic),
    })
}

fn case(bytes: &mut Bytes<'_>) -> Outcome {
    let (system, y0) = System::read(bytes);
    let t0 = bytes.time();
    match bytes.below(7) {
        0 | 1 => {
            let options = options::cvode(bytes, y0.len());
            driven(Cvode::new(system, t0, &y0, &options), bytes)
        }
        2 => {
            let options = options::arkode(bytes, y0.len());
            driven(Arkode::new(system, t0, &y0, &options), bytes)
        }
        3 => driven(DormandPrince::new(system, t0, &y0, &options::rk(bytes, y0.len())), bytes),
        4 => {
            let (options, yp0) = (options::ida(bytes, y0.len()), system.slope(t0, &y0));
            driven(consistent(Ida::new(system, t0, &y0, &yp0, &options), bytes), bytes)
        }
        5 => {
            let (newton, yp0) = (options::newton(bytes, y0.len()), system.slope(t0, &y0));
            let options = options::ida(bytes, y0.len()).newton(newton.clone());
            match MassForm::new(system, y0.len(), &newton) {
                Ok(form) => driven(Ida::new(form, t0, &y0, &yp0, &options), bytes),
                Err(_) => Outcome::Refused,
            }
        }
        _ => solved(system, t0, &y0, bytes),
    }
}

/// A DAE, perhaps with corrected initial conditions.
fn consistent<S: pliant::ode::Dae>(
    solver: Result<Ida<S>, integrate::Error>,
    bytes: &mut Bytes<'_>,
) -> Result<Ida<S>, integrate::Error> {
    let mut solver = solver?;
    if bytes.is(4) {
        solver.consistent_start(InitialCondition::Algebraic, bytes.time())?;
    }
    Ok(solver)
}

/// What a test of closed forms has to know of a system.
trait Closed {
    fn system(&self) -> &System;
}

impl Closed for System {
    fn system(&self) -> &System {
        self
    }
}

impl Closed for MassForm<System> {
    fn system(&self) -> &System {
        self.system()
    }
}

/// Calls in random order.
fn driven<I>(solver: Result<I, integrate::Error>, bytes: &mut Bytes<'_>) -> Outcome
where
    I: Integrator,
    I::System: Closed,
{
    let Ok(mut solver) = solver else { return Outcome::Refused };
    let (mut start, mut y0) = (solver.t(), solver.y().to_vec());
    let mut outcome = Outcome::Done;
    // A root or a stop time may be reached first; a step may fail, and all goes on.
    for _ in 0..1 + bytes.below(8) {
        let result = match bytes.below(10) {
            0..=3 => solver.solve_to(bytes.time()).map(|_| ()),
            4 | 5 => solver.step(bytes.time()).map(|_| ()),
            6 => {
                let (from, to) = solver.last_step();
                let t = if bytes.is(2) { 0.5 * (from + to) } else { bytes.time() };
                let mut out = vec![0.0; if bytes.is(8) { bytes.below(9) } else { y0.len() }];
                solver.interpolate(t, bytes.below(7) as u32, &mut out)
            }
            7 => solver.set_stop_time(bytes.is(2).then(|| bytes.time())),
            8 => {
                let t = bytes.time();
                let result = solver.reinit(t, &y0);
                if result.is_ok() {
                    start = t;
                }
                result
            }
            _ => solver.resume(solver.t(), &y0).map(|resumed| {
                if resumed {
                    start = solver.t();
                }
            }),
        };
        // a step towards such a time may reach it, and IDA's differences overflow there
        let is_beyond = result.is_err() && solver.t().abs() > 1e100;
        assert!(
            is_beyond || solver.y().iter().all(|y| y.is_finite()),
            "{:?} after {result:?} of {:?}",
            solver.y(),
            solver.system().system(),
        );
        assert!(solver.t().is_finite() && solver.statistics().steps <= 10 * options::STEPS);
        let _ = (solver.roots_found(), solver.notice(), solver.last_order());
        match result {
            // between its steps ARKODE multiplies what is off the slow motion by the step and its rate
            Ok(()) if !bytes.is_loose && solver.t() == solver.last_step().1 => {
                solver.system().system().check(start, &y0, solver.t(), solver.y());
            }
            Ok(()) => {}
            Err(error) => {
                assert!(!error.to_string().is_empty());
                outcome = Outcome::Failed;
            }
        }
    }
    y0.clear();
    outcome
}

/// By one call.
fn solved(system: System, t0: f64, y0: &[f64], bytes: &mut Bytes<'_>) -> Outcome {
    let method = match bytes.below(6) {
        0 | 1 => Method::Bdf,
        2 => Method::Adams,
        3 => Method::RungeKutta(*bytes.one_of(&ButcherTable::ALL)),
        4 => Method::DormandPrince,
        _ => Method::Ida,
    };
    let (check, end) = (system.clone(), bytes.time());
    let mut problem = if method == Method::Ida && bytes.is(2) {
        let yp0 = system.slope(t0, y0);
        Problem::dae(system, y0, yp0)
    } else {
        Problem::ode(system, y0)
    };
    let mut changed = false;
    for _ in 0..bytes.below(3) {
        let (level, kind) = (bytes.number(), bytes.below(6));
        let event = Event::new(move |t, y| y.first().map_or(t, |y| y - level));
        problem = problem.event(match kind {
            0 => event.rising(),
            1 => event.falling().terminal(),
            2 => event.terminal_after(bytes.below(3) as u32),
            3 => event.touching(bytes.number()),
            4 => event.samples(bytes.below(9) as u32),
            _ => {
                changed = true;
                let factor = bytes.number();
                event.action(move |jump| jump.y.iter_mut().for_each(|y| *y *= factor))
            }
        });
    }
    if bytes.is(3) {
        problem = problem.breaks([bytes.time(), bytes.time()]);
    }
    let options = options::solve(bytes, y0.len());
    if bytes.is(3) {
        let Ok(mut run) = Run::new(problem, method, (t0, end), &options) else {
            return Outcome::Refused;
        };
        // dropped early, mostly
        for _ in 0..bytes.below(50) {
            match run.advance() {
                Ok(None) => return Outcome::Done,
                Ok(Some(step)) => assert!(step.y.iter().all(|y| y.is_finite()), "{step:?}"),
                Err(_) => return Outcome::Failed,
            }
        }
        return Outcome::Done;
    }
    match solve::solve(problem, method, (t0, end), &options) {
        Ok(solution) => {
            let (t, y) = (*solution.t().last().expect("the start at least"), solution.last());
            assert!(y.iter().all(|y| y.is_finite()), "{y:?}");
            if solution.end() == End::Span {
                assert_eq!(t, end);
            }
            if !changed && !bytes.is_loose {
                check.check(t0, y0, t, y);
            }
            let _ = solution.at(bytes.time());
            Outcome::Done
        }
        Err(solve::Error::Input(_)) => Outcome::Refused,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            Outcome::Failed
        }
    }
}
