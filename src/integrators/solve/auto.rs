//! The engine of [`Method::Auto`]: one method at a time, from step to step the one that advances farther per work.
//!
//! It begins with the explicit method, which notices where stability limits its steps; or with the implicit one where its steps cost no more, as
//! those of many unknowns with few entries, and the fastest rate at the start shows that stability would limit the others. An implicit one is then tried for some steps, if as
//! many are left that this may pay, and kept if it leads farther for its work ([`Costs`]). Where the explicit method is the better one again,
//! it is tried in turn. A trial that is lost makes the next one twice as dear. Where a method cannot go on, another one is tried.

use faer::{MatMut, MatRef};

use super::{
    choice::{Candidate, Costs},
    engine::{Engine, OdeEngine},
    method::{Method, MethodUse},
    options::Options,
    rate::{EVALUATIONS, Rate},
};
use crate::integrators::{
    common::{Cause, Error, Integrator, Reached, Statistics},
    ode::{Boxed, Failure, Ode},
    rk::{DormandPrince, REACH, REACH_UNDAMPED},
    rosenbrock::Rosenbrock,
    sundials::Cvode,
};

type System<'a> = Boxed<dyn Ode + Send + 'a>;

pub(super) struct AutoEngine<'a> {
    /// None after a method could not be started.
    current: Option<Current<'a>>,
    candidate: Candidate,
    options: Options,
    costs: Costs,
    end: f64,
    /// Where the present method began.
    t: f64,
    y: Vec<f64>,
    /// Steps of the present method.
    steps: u64,
    /// The last step, and the mean of the last ones.
    last: f64,
    step: f64,
    /// The method that the present one is tried in place of, with the mean of its last steps.
    before: Option<(Candidate, f64)>,
    /// Trials of each candidate that were lost.
    lost: [i32; 3],
    /// The number of steps of the present method at which the rates of the equations are looked at.
    next_look: u64,
    stop: Option<Stop>,
    /// Statistics of the methods before, since the last start.
    past: Statistics,
    uses: Vec<MethodUse>,
}

#[derive(Clone, Copy)]
enum Stop {
    At(f64),
    Before(f64),
}

enum Current<'a> {
    Explicit(Box<OdeEngine<DormandPrince<System<'a>>>>),
    Rosenbrock(Box<OdeEngine<Rosenbrock<System<'a>>>>),
    Bdf(OdeEngine<Cvode<System<'a>>>),
}

/// Part of a new step in the mean of the last ones.
const NEW: f64 = 0.25;
/// Steps of a method before the rates of the equations are looked at, and the most between two looks, which become rarer.
const FIRST_LOOK: u64 = 32;
const RAREST: u64 = 512;
/// Size of explicit steps, in times in which the fastest mode changes, from which on stability may limit them; it does at 1 to 3.3.
const FAST: f64 = 1.0;
/// The same for steps of BDF of order 3 and more, which fast oscillations may limit.
const OSCILLATIONS: std::ops::Range<f64> = 0.2..10.0;
/// Part of the stable steps of the explicit method that it is expected to make.
const EXPECTED: f64 = 0.7;
/// Growth of steps in a trial, beyond their mean, that makes it longer, and how many times at most.
const GROWS: f64 = 1.2;
const LONGEST: u64 = 4;
/// Changes of the method that are remembered.
const MOST: usize = 1000;

impl Candidate {
    fn method(self) -> Method {
        match self {
            Self::Explicit => Method::DormandPrince,
            Self::Rosenbrock => Method::Rosenbrock,
            Self::Bdf => Method::Bdf,
        }
    }
}

impl<'a> Current<'a> {
    fn new(
        candidate: Candidate,
        system: System<'a>,
        (t, y): (f64, &[f64]),
        options: &Options,
    ) -> Result<Self, Error> {
        Ok(match candidate {
            Candidate::Explicit => {
                let integrator = DormandPrince::new(system, t, y, &options.explicit())?;
                Self::Explicit(Box::new(OdeEngine { integrator }))
            }
            Candidate::Rosenbrock => {
                let integrator = Rosenbrock::new(system, t, y, &options.rosenbrock())?;
                Self::Rosenbrock(Box::new(OdeEngine { integrator }))
            }
            Candidate::Bdf => {
                let integrator = Cvode::new(system, t, y, &Method::Bdf.cvode(options, 1.0))?;
                Self::Bdf(OdeEngine { integrator })
            }
        })
    }

    fn engine(&self) -> &dyn Engine {
        match self {
            Self::Explicit(engine) => &**engine,
            Self::Rosenbrock(engine) => &**engine,
            Self::Bdf(engine) => engine,
        }
    }

    fn engine_mut(&mut self) -> &mut dyn Engine {
        match self {
            Self::Explicit(engine) => &mut **engine,
            Self::Rosenbrock(engine) => &mut **engine,
            Self::Bdf(engine) => engine,
        }
    }

    fn into_system(self) -> System<'a> {
        match self {
            Self::Explicit(engine) => engine.integrator.into_system(),
            Self::Rosenbrock(engine) => engine.integrator.into_system(),
            Self::Bdf(engine) => engine.integrator.into_system(),
        }
    }
}

/// The error of a run that is called again after a method could not be started.
fn gone() -> Error {
    Error::input("run", "ended", "a method could not be started: make a new run")
}

impl<'a> AutoEngine<'a> {
    /// Starts at time `t` from `y`, on the way forward to `end`.
    pub(super) fn new(
        system: System<'a>,
        (t, end): (f64, f64),
        y: &[f64],
        options: &Options,
    ) -> Result<Self, Error> {
        let costs = Costs::new(y.len(), options.linear_solver.as_ref(), options.tolerances.rtol);
        // made in any case, so that its options are refused before the first step
        let mut current = Current::new(costs.implicit, system, (t, y), options)?;
        let mut past = Statistics::default();
        let mut stable = None;
        if costs.may_begin_implicit() {
            let rate = Rate::of(current.engine_mut(), &options.tolerances, t, y);
            past.evaluations = EVALUATIONS;
            stable = rate.filter(|rate| !rate.oscillates).map(|rate| REACH / rate.size);
        }
        let limited = stable.filter(|step| costs.tries_implicit(0.0, (end - t) / step, 0));
        let (candidate, reason) = match limited {
            Some(step) => {
                let reason =
                    format!("stability limits explicit steps to {step:.1e}, which cost no less");
                (costs.implicit, reason)
            }
            None => {
                let system = current.into_system();
                current = Current::new(Candidate::Explicit, system, (t, y), options)?;
                let reason = "its steps cost least, and show whether stability limits them";
                (Candidate::Explicit, reason.into())
            }
        };
        Ok(Self {
            current: Some(current),
            candidate,
            options: options.clone(),
            costs,
            end,
            t,
            y: y.to_vec(),
            steps: 0,
            last: 0.0,
            step: 0.0,
            before: None,
            lost: [0; 3],
            next_look: FIRST_LOOK,
            stop: None,
            past,
            uses: vec![MethodUse { t, method: candidate.method(), reason }],
        })
    }

    fn current(&self) -> Result<&dyn Engine, Error> {
        self.current.as_ref().map(Current::engine).ok_or_else(gone)
    }

    fn current_mut(&mut self) -> Result<&mut dyn Engine, Error> {
        self.current.as_mut().map(Current::engine_mut).ok_or_else(gone)
    }

    /// Continues with another method from the present state.
    fn change(&mut self, to: Candidate, reason: String) -> Result<(), Error> {
        let Some(current) = self.current.take() else { return Err(gone()) };
        let engine = current.engine();
        self.past = self.past.followed_by(&engine.statistics());
        self.t = engine.t();
        self.y.copy_from_slice(engine.y());
        let options = match to {
            // BDF of order 1 estimates its own
            Candidate::Bdf => self.options.clone(),
            _ if self.step > 0.0 => self.options.clone().initial_step(self.step),
            _ => self.options.clone(),
        };
        let at = (self.t, &self.y[..]);
        let mut current = Current::new(to, current.into_system(), at, &options)?;
        match self.stop {
            Some(Stop::At(t)) => current.engine_mut().set_stop_time(t)?,
            Some(Stop::Before(t)) => current.engine_mut().set_stop_before(t)?,
            None => {}
        }
        self.current = Some(current);
        (self.candidate, self.steps) = (to, 0);
        self.next_look = FIRST_LOOK << self.lost[Candidate::Explicit as usize].clamp(0, 20);
        if self.uses.len() == MOST {
            self.uses.remove(0);
        }
        self.uses.push(MethodUse { t: self.t, method: to.method(), reason });
        Ok(())
    }

    /// Tries another method in place of the present one.
    fn try_out(&mut self, to: Candidate, reason: String) -> Result<(), Error> {
        let before = (self.candidate, self.step);
        self.change(to, format!("tried, as {reason}"))?;
        self.before = Some(before);
        Ok(())
    }

    /// Decides about the method of the next step.
    fn review(&mut self) -> Result<(), Error> {
        let (candidate, step) = (self.candidate, self.step);
        if let Some(before) = self.before {
            let least = Costs::trial(candidate);
            let grows = self.last > GROWS * step && self.steps < LONGEST * least;
            if self.steps < least || grows {
                return Ok(());
            }
            self.before = None;
            if self.costs.is_better((candidate, step), before) {
                if let Some(present) = self.uses.last_mut() {
                    let kept =
                        format!("; kept, as steps of {step:.1e} lead farther for their work");
                    present.reason.push_str(&kept);
                }
                return Ok(());
            }
            self.lost[candidate as usize] += 1;
            let name = candidate.method().name();
            let reason = format!("steps of {name} of {step:.1e} lead less far for their work");
            // a step that the method before could make
            self.step = before.1;
            return self.change(before.0, reason);
        }
        let rate = match self.steps >= self.next_look {
            true => self.look()?,
            false => None,
        };
        if let Some(Current::Explicit(engine)) = &self.current {
            let is_limited = engine.integrator.stability_limit().is_some()
                || rate.is_some_and(|rate| rate.size * step > FAST);
            let left = (self.end - engine.t()) / step;
            let lost = self.lost[self.costs.implicit as usize];
            if is_limited && self.costs.tries_implicit(self.steps as f64, left, lost) {
                let reason = format!("stability limits explicit steps to {step:.1e}");
                return self.try_out(self.costs.implicit, reason);
            }
            return Ok(());
        }
        let Some(rate) = rate else { return Ok(()) };
        let reach = if rate.oscillates { REACH_UNDAMPED } else { REACH };
        let explicit = (Candidate::Explicit, EXPECTED * reach / rate.size);
        if self.costs.is_better(explicit, (candidate, step)) {
            let reason = format!("accuracy asks for steps of {step:.1e}");
            return self.try_out(Candidate::Explicit, reason);
        }
        let is_unstable = candidate == Candidate::Bdf
            && rate.oscillates
            && OSCILLATIONS.contains(&(rate.size * step));
        if is_unstable && self.costs.has_rosenbrock {
            let reason = format!("fast oscillations may limit steps of BDF to {step:.1e}");
            return self.try_out(Candidate::Rosenbrock, reason);
        }
        Ok(())
    }

    /// The largest rate of the equations at the present state, estimated; none if there is no estimate.
    fn look(&mut self) -> Result<Option<Rate>, Error> {
        let (t, y) = (self.t(), self.y().to_vec());
        self.next_look += self.next_look.min(RAREST);
        self.past.evaluations += EVALUATIONS;
        let tolerances = &self.options.tolerances;
        let Some(current) = &mut self.current else { return Err(gone()) };
        Ok(Rate::of(current.engine_mut(), tolerances, t, &y))
    }

    /// Another method in place of one that failed by `error`, if it may get on.
    fn recover(&mut self, error: &Error) -> Result<bool, Error> {
        let other = match self.candidate {
            Candidate::Explicit => self.costs.implicit,
            Candidate::Rosenbrock => Candidate::Bdf,
            Candidate::Bdf => return Ok(false),
        };
        let Error::Integration(failure) = error else { return Ok(false) };
        if matches!(failure.cause, Cause::Fatal(_)) {
            return Ok(false);
        }
        self.before = None;
        self.change(other, failure.to_string())?;
        Ok(true)
    }
}

impl Engine for AutoEngine<'_> {
    fn t(&self) -> f64 {
        self.current().map_or(self.t, Engine::t)
    }

    fn y(&self) -> &[f64] {
        self.current().map_or(&self.y[..], Engine::y)
    }

    fn yp(&self) -> &[f64] {
        &[]
    }

    fn step(&mut self, towards: f64) -> Result<Reached, Error> {
        self.review()?;
        let from = self.t();
        let mut outcome = self.current_mut()?.step(towards);
        while let Err(error) = &outcome
            && self.t() == from
            && self.recover(error)?
        {
            outcome = self.current_mut()?.step(towards).or(outcome);
        }
        if outcome.as_ref().is_ok_and(|reached| *reached == Reached::StopTime) {
            self.stop = None;
        }
        // a step that a stop time cut short is no measure
        let h = match &outcome {
            Ok(Reached::StopTime) => self.step.max(self.t() - from),
            _ => self.t() - from,
        };
        self.last = h;
        self.step =
            if self.step > 0.0 && self.steps > 0 { self.step + NEW * (h - self.step) } else { h };
        self.steps += 1;
        outcome
    }

    fn set_stop_time(&mut self, t: f64) -> Result<(), Error> {
        self.current_mut()?.set_stop_time(t)?;
        self.stop = Some(Stop::At(t));
        Ok(())
    }

    fn set_stop_before(&mut self, t: f64) -> Result<(), Error> {
        self.current_mut()?.set_stop_before(t)?;
        self.stop = Some(Stop::Before(t));
        Ok(())
    }

    fn interpolate(&mut self, t: f64, derivative: u32, out: &mut [f64]) -> Result<(), Error> {
        self.current_mut()?.interpolate(t, derivative, out)
    }

    fn interpolant_degree(&self) -> u32 {
        self.current().map_or(1, Engine::interpolant_degree)
    }

    fn statistics(&self) -> Statistics {
        match self.current() {
            Ok(current) => self.past.followed_by(&current.statistics()),
            Err(_) => self.past.clone(),
        }
    }

    fn steps(&self) -> u64 {
        self.past.steps + self.current().map_or(0, Engine::steps)
    }

    /// What limits the steps of one method is a reason for another one.
    fn notice(&self) -> Option<String> {
        None
    }

    fn uses(&self) -> &[MethodUse] {
        &self.uses
    }

    fn restart(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
        self.stop = None;
        self.current_mut()?.restart(t, y, yp)?;
        self.past = Statistics::default();
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        self.current().map_or(&[][..], Engine::parameters)
    }

    fn set_parameters(&mut self, values: &[f64]) {
        if let Ok(current) = self.current_mut() {
            current.set_parameters(values);
        }
    }

    fn slope(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.current_mut()?.slope(t, y, out)
    }

    fn equations(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.current_mut()?.equations(t, y, yp, out)
    }

    fn sensitivities_at(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
        Ok(())
    }

    fn quadratures_at(&mut self, _: f64, _: &mut [f64]) -> Result<(), Error> {
        Ok(())
    }

    fn quadrature_sensitivities_at(&mut self, _: f64, _: MatMut<'_, f64>) -> Result<(), Error> {
        Ok(())
    }

    fn integrands(&mut self, _: f64, _: &[f64], _: &[f64], _: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    fn start_sensitivities(&mut self, _: MatRef<'_, f64>, _: &[f64]) -> Result<(), Error> {
        Ok(())
    }
}
