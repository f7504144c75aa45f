//! Gradients of a functional of the solution, across events and breaks, by runs backward in time.

use super::{
    error::Reason,
    event::{Jump, check_crosses, check_landed},
    history::{HistoryPart, Passage, follow},
    method::Method,
    options::Options,
    problem::{Equations, Problem},
    sides::{FAR, Surfaces, continued},
    snapshot::{Act, Snapshot},
};
use crate::base::{
    input::InputError,
    vector::{dot, size_or_one},
};
use crate::integrators::{
    ode::{Borrowed, Failure, Functional, Slopes, call},
    sundials::{Adjoint, AdjointOptions, DaeAdjoint, Gradient},
};

/// Value and gradient of a functional of the solution of `problem` over `span`, with respect to the
/// parameters of its equations and to its initial state.
///
/// It takes one forward run and, for each piece between two jumps, one more forward run and one backward run
/// with these [options](AdjointOptions) (CVODES by [`Method::Bdf`] and [`Method::Adams`], IDAS by
/// [`Method::Ida`]).
///
/// Where events act, the times of the jumps depend on the parameters, too, and so does the end of a run that
/// an event ends; all of that is in the gradient. Discontinuous equations and functionals need
/// events there, as [sensitivities](Options::sensitivities) do.
///
/// With the slopes f- before and f+ after a jump y+ = a(t, y, p) at a root of e(t, y, p),
///
/// ```text
/// lambda- = a_y^T lambda+ - J e_y / (e_t + e_y f-),   J = lambda+^T (a_t + a_y f- - f+) + h- - h+
/// ```
///
/// (W. A. Rozenvasser, Automation and Remote Control 28 (1967) 1043-1049, transposed), and likewise for the
/// parameters, which actions may change. These derivatives are central differences: event functions and
/// actions are called at states nearby, two times for each unknown and each parameter. Values that an
/// action of a DAE writes to `yp` do not count, as `yp` is corrected afterwards.
///
/// Limits of evaluations and time, and the observer, apply to the first forward run.
///
/// ```
/// use pliant::{
///     ode::{Failure, Functional, Slopes, with_parameters},
///     solve::{Event, Method, Options, Problem, gradient},
///     sundials::AdjointOptions,
/// };
///
/// /// The height at the end.
/// struct Height;
///
/// impl Functional for Height {
///     fn terminal(&mut self, _t: f64, y: &[f64], _p: &[f64], slopes: Option<Slopes<'_>>) -> Result<f64, Failure> {
///         if let Some(slopes) = slopes {
///             slopes.y[0] = 1.0;
///         }
///         Ok(y[0])
///     }
/// }
///
/// // a ball that falls from 1 m and keeps the part p of its speed; height as a function of p after the impact at t = 1/2
/// let fall = with_parameters(
///     |_t, y, _p, ydot| {
///         ydot.copy_from_slice(&[y[1], -8.0]);
///         Ok(())
///     },
///     [0.5],
/// );
/// let floor = Event::new(|_, y| y[0]).falling().action(|jump| jump.y[1] *= -jump.p[0]);
/// let problem = Problem::ode(fall, [1.0, 0.0]).event(floor);
/// let (options, back) = (Options::new(1e-10, 1e-12), AdjointOptions::new(1e-10, 1e-12));
/// let found = gradient(problem, Height, Method::Bdf, (0.0, 0.75), &options, &back)?;
/// assert!((found.value - (0.5 * 4.0 * 0.25 - 4.0 * 0.25 * 0.25)).abs() < 1e-8);
/// assert!((found.parameters[0] - 4.0 * 0.25).abs() < 1e-8);
/// # Ok::<(), pliant::solve::Reason>(())
/// ```
///
/// # Errors
/// [`Reason::Input`] for unsupported input: other methods, systems that are neither dense, of band form nor
/// sparse, and events that only touch zero; otherwise the reason why a forward or backward run ended early.
///
/// # Panics
/// A panic of the equations, the functional, the events or the actions passes through.
pub fn gradient(
    problem: Problem<'_>,
    functional: impl Functional,
    method: Method,
    span: (f64, f64),
    options: &Options,
    back: &AdjointOptions,
) -> Result<Gradient, Reason> {
    let method = match method {
        Method::Auto if problem.equations.is_dae() => Method::Ida,
        Method::Auto => Method::Bdf,
        method => method,
    };
    if !matches!(method, Method::Bdf | Method::Adams | Method::Ida) {
        let help = "a gradient takes Bdf or Adams, or Ida for a DAE";
        return Err(InputError::new("method", format!("{method:?}"), help).into());
    }
    if options.sensitivities.is_some() || problem.initial_sensitivities.is_some() {
        let help = "the run forward of a gradient needs none; what the start depends on adds (dy0/dp)^T dG/dy0";
        return Err(InputError::new("sensitivities", "given", help).into());
    }
    let mut problem = problem;
    let (start, n) = (span.0, problem.y.len());
    let options =
        &*options.with_linear_solver(method, &mut problem.equations, start, &problem.y)?;
    problem.equations = method.take(problem.equations, start, n, options)?;
    let length = (span.1 - start).abs();
    let surfaces = Surfaces::of(&problem.events, &options.tolerances, length);
    problem.equations = surfaces.keep(problem.equations);
    problem.sides = Some(surfaces.sides().clone());
    let original = problem.equations.parameters().to_vec();
    let (parts, end) = follow(&mut problem, method, span, options)?;
    let mut back = BackwardRun { problem, surfaces, functional, method, span, options, back };
    let outcome = back.gradient(&parts, &end);
    back.problem.equations.set_parameters(&original);
    outcome
}

/// Problem and options of the backward run.
struct BackwardRun<'a, 'o, F> {
    problem: Problem<'a>,
    /// The surfaces of its events, whose sides the equations keep to.
    surfaces: Surfaces<'a>,
    functional: F,
    method: Method,
    span: (f64, f64),
    options: &'o Options,
    back: &'o AdjointOptions,
}

/// The functional of one piece: the same integral, and at the end the adjoint of the later pieces.
struct Piece<'f, 'a, F> {
    surfaces: &'f mut Surfaces<'a>,
    functional: &'f mut F,
    lambda: &'f [f64],
    /// The state at the end, where the adjoint of the later pieces takes over.
    end: Vec<f64>,
}

impl<F: Functional> Functional for Piece<'_, '_, F> {
    fn running(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let (shift, has_slopes) = (self.surfaces.shift(t, y, p), slopes.is_some());
        let near =
            self.functional.running(t + shift, self.surfaces.moved(t, y, shift), p, slopes)?;
        if shift == 0.0 || has_slopes {
            return Ok(near);
        }
        let far = self.surfaces.moved(t, y, FAR * shift);
        Ok(continued(near, self.functional.running(t + FAR * shift, far, p, None)?))
    }

    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y.copy_from_slice(self.lambda);
            self.end = y.to_vec();
        }
        let moved = y.iter().zip(&self.end).zip(self.lambda);
        Ok(moved.map(|((y, end), lambda)| lambda * (y - end)).sum())
    }
}

impl<F: Functional> BackwardRun<'_, '_, F> {
    /// From the end to the start.
    fn gradient(&mut self, parts: &[HistoryPart], end: &Snapshot) -> Result<Gradient, Reason> {
        let start = Gradient::at_end(
            &mut self.functional,
            end.t,
            [&end.y, &end.p],
            &self.options.tolerances,
        );
        let start = start.map_err(|failure| unknown("terminal functional", failure))?;
        let mut gradient = start.check()?;
        for part in parts.iter().rev() {
            match part {
                HistoryPart::Smooth { from, to } => self.integrate(from, *to, &mut gradient)?,
                HistoryPart::Jump(passage) => self.cross(passage, &mut gradient)?,
            }
        }
        Ok(gradient)
    }

    /// Integrates backward from the time `to` to the state `from`.
    fn integrate(
        &mut self,
        from: &Snapshot,
        to: f64,
        gradient: &mut Gradient,
    ) -> Result<(), Reason> {
        if from.t == to {
            return Ok(());
        }
        let slope = self.slope(from)?;
        self.surfaces.sides().lock().flows.push((from.t, slope));
        let Self { problem, surfaces, functional, method, span, options, back, .. } = self;
        let lambda = &gradient.initial_state;
        let piece = Piece { surfaces, functional, lambda, end: Vec::new() };
        let sign = (span.1 - span.0).signum();
        let Snapshot { t, y, yp, .. } = from;
        let max_steps = u32::try_from(options.max_steps).unwrap_or(u32::MAX);
        let part = match &mut problem.equations {
            Equations::Ode(system) => {
                let forward = method.cvode(options, sign).max_steps(max_steps);
                let system = Borrowed(system.as_mut());
                Adjoint::new(system, piece, *t, y, &forward, back)?.gradient(to)?
            }
            Equations::Dae { system, differential, .. } => {
                let forward = method.ida(options, sign, differential.clone());
                let (forward, system) = (forward.max_steps(max_steps), Borrowed(system.as_mut()));
                DaeAdjoint::new(system, piece, *t, y, yp, &forward, back)?.gradient(to)?
            }
        };
        gradient.value += part.value;
        let slopes = gradient.parameters.iter_mut().zip(&part.parameters);
        slopes.for_each(|(slope, part)| *slope += part);
        gradient.initial_state = part.initial_state;
        Ok(())
    }

    /// Goes backward across a jump.
    fn cross(&mut self, passage: &Passage, gradient: &mut Gradient) -> Result<(), Reason> {
        let at = &passage.before;
        let left = self.slope(at)?;
        self.surfaces.sides().lock().flows = vec![(at.t, left.clone())];
        // derivatives of what follows by the state and the parameters after the jump, and by e, which shifts
        // the time of the jump: -J / rate
        let mut weights = [&gradient.initial_state[..], &gradient.parameters, &[0.0]].concat();
        if let Some(event) = passage.timed_by {
            check_crosses(event, at.t, passage.crosses)?;
            let along = self.derivative(passage, self.unit_of_time(at, &left), |place, d| {
                place.t += d;
                place.y.iter_mut().zip(&left).for_each(|(y, slope)| *y += d * slope);
            });
            let gain = dot(&weights, &along) + self.gain_of_time(passage, gradient)?;
            let rate = along[along.len() - 1];
            check_crosses(event, at.t, rate != 0.0)?;
            weights[along.len() - 1] = -gain / rate;
        }
        for i in 0..at.y.len() {
            let size = self.options.tolerances.size_of(i, at.y[i]);
            let slope = self.derivative(passage, size, |place, d| place.y[i] += d);
            gradient.initial_state[i] = dot(&weights, &slope);
        }
        for k in 0..at.p.len() {
            let slope = self.derivative(passage, size_or_one(at.p[k]), |place, d| place.p[k] += d);
            gradient.parameters[k] = dot(&weights, &slope);
        }
        let of_dae = !at.yp.is_empty();
        check_landed("gradient by y at a jump", &gradient.initial_state, of_dae)?;
        check_landed("gradient by p at a jump", &gradient.parameters, of_dae)?;
        Ok(())
    }

    /// Derivative of the functional with respect to the time of the jump, at fixed state and parameters after
    /// the jump.
    fn gain_of_time(&mut self, passage: &Passage, gradient: &Gradient) -> Result<f64, Reason> {
        let Passage { before, after, ends, .. } = passage;
        let before_it = self.running(before)?;
        if !ends {
            let behind = self.running(after)?;
            let right = self.slope(after)?;
            return Ok(before_it - behind - dot(&gradient.initial_state, &right));
        }
        let left = self.slope(before)?;
        let distance = f64::EPSILON.cbrt() * self.unit_of_time(before, &left);
        let mut terminal = |t: f64| {
            let g = self.functional.terminal(t, &after.y, &after.p, None);
            g.map_err(|failure| unknown("terminal functional", failure))
        };
        let (ahead, behind) = (terminal(after.t + distance)?, terminal(after.t - distance)?);
        Ok(before_it + (ahead - behind) / (2.0 * distance))
    }

    /// The integrand of the functional on the sides of a state.
    fn running(&mut self, at: &Snapshot) -> Result<f64, Reason> {
        self.enter(at);
        let Self { surfaces, functional, .. } = self;
        let h = Piece { surfaces, functional, lambda: &[], end: Vec::new() }
            .running(at.t, &at.y, &at.p, None);
        Ok(h.map_err(|failure| unknown("functional at a jump", failure))?)
    }

    /// Gives the equations the parameters and the sides of a state.
    fn enter(&mut self, at: &Snapshot) {
        self.problem.equations.set_parameters(&at.p);
        let mut sides = self.surfaces.sides().lock();
        sides.signs.copy_from_slice(&at.sides);
        sides.p.clone_from(&at.p);
    }

    /// The time derivative of the state.
    fn slope(&mut self, at: &Snapshot) -> Result<Vec<f64>, Reason> {
        self.enter(at);
        let mut slope = at.yp.clone();
        if let Equations::Ode(system) = &mut self.problem.equations {
            slope.resize(at.y.len(), 0.0);
            let outcome = call::rhs(system.as_mut(), at.t, &at.y, &mut slope);
            outcome.map_err(|failure| unknown("right-hand side at a jump", failure))?;
        }
        Ok(slope)
    }

    /// The derivatives of state and parameters after a jump, and of the function of its event, along a
    /// direction before the jump.
    fn derivative(
        &mut self,
        passage: &Passage,
        size: f64,
        shift: impl Fn(&mut Snapshot, f64),
    ) -> Vec<f64> {
        let distance = f64::EPSILON.cbrt() * size;
        let mut landed = |distance: f64| {
            let mut place = passage.before.clone();
            shift(&mut place, distance);
            let Problem { events, breaks, .. } = &mut self.problem;
            let function = passage.timed_by.map(|i| &events[i].function);
            let g = function.map_or(0.0, |g| g.at(place.t, &place.y, &place.p));
            // an action that reads these gets NaN: the differences would miss how they change
            place.yp.fill(f64::NAN);
            let Snapshot { t, mut y, mut yp, mut p, .. } = place;
            let mut jump = Jump::new(t, &mut y, &mut yp, &mut p);
            for act in &passage.acts {
                let action = match *act {
                    Act::Event(i) | Act::Tick(i) => &mut events[i].action,
                    Act::Break(i) => &mut breaks[i].action,
                };
                action.iter_mut().for_each(|action| action(&mut jump));
            }
            [&y[..], &p, &[g]].concat()
        };
        let (mut ahead, behind) = (landed(distance), landed(-distance));
        let pairs = ahead.iter_mut().zip(behind);
        pairs.for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * distance));
        ahead
    }

    /// The time in which the state changes by its size.
    fn unit_of_time(&self, at: &Snapshot, slope: &[f64]) -> f64 {
        self.options.tolerances.reach(&at.y, slope, (self.span.1 - self.span.0).abs())
    }
}

/// The error for a quantity that has no value.
fn unknown(input: &str, failure: Failure) -> InputError {
    InputError::new(input, failure.into_error(), "the gradient needs its value there")
}
