//! Equations that keep to one side of their switches.
//!
//! A right-hand side that asks `if y < 0.3` jumps where the solution comes to 0.3, and differences next to that
//! surface have the jump, divided by their increment, in them. Where derivatives are computed, each event is
//! taken for such a switch: up to it the equations are those before it, and from there on those behind it. Next
//! to the surface, on its wrong side, they are continued along a line from points on the right side.

use faer::MatMut;

use super::{
    event::{Event, Function},
    problem::Equations,
    snapshot::{SharedSides, Sides},
};
use crate::integrators::{
    common::Tolerances,
    ode::{BandMut, Dae, Failure, MassKind, Ode, call, delegate::delegate},
};

/// The surfaces of all events.
#[derive(Clone)]
pub(super) struct Surfaces<'a> {
    functions: Vec<Function<'a>>,
    sides: SharedSides,
    tolerances: Tolerances,
    /// Length of the span.
    longest: f64,
    /// The state moved along the flow.
    place: Vec<f64>,
}

/// Continuation of the equations behind a surface, relative to the time in which the state changes by its
/// size, in parts of sqrt(rtol): increments of differences are 1 such part, and the error of the continuation is
/// its square.
const REACH: f64 = 5.0;

/// The shortest distance from a surface, relative to that time: rounding cannot put a point on the other side.
const CLEARANCE: f64 = 1e-12;

/// The second point of the line by which equations are continued is so many times as far away as the first, so
/// that their rounding errors grow little.
pub(super) const FAR: f64 = 5.0;

/// The value continued from those at the two points.
pub(super) fn continued(near: f64, far: f64) -> f64 {
    near + (near - far) / (FAR - 1.0)
}

impl<'a> Surfaces<'a> {
    /// Those of `events`, for a span of the length `longest`. No side is known yet.
    pub(super) fn of(events: &[Event<'a>], tolerances: &Tolerances, longest: f64) -> Self {
        let functions: Vec<_> = events.iter().map(|event| event.function.clone()).collect();
        let signs = vec![0.0; functions.len()];
        let sides = Sides { signs, flows: Vec::new(), p: Vec::new() };
        let (sides, tolerances) = (SharedSides::new(sides), tolerances.clone());
        Self { functions, sides, tolerances, longest, place: Vec::new() }
    }

    /// The equations, which keep to their sides.
    pub(super) fn keep(&self, equations: Equations<'a>) -> Equations<'a> {
        let (surfaces, far) = (self.clone(), Vec::new());
        match equations {
            Equations::Ode(system) => Equations::Ode(Box::new(Sided { system, surfaces, far })),
            Equations::Dae { system, yp, differential } => Equations::Dae {
                system: Box::new(Sided { system, surfaces, far }),
                yp,
                differential,
            },
        }
    }

    pub(super) fn sides(&self) -> &SharedSides {
        &self.sides
    }

    /// The time by which a point on a surface or on its wrong side has to be moved along the flow to come to the
    /// right side; 0 if it is there, or far from it.
    pub(super) fn shift(&mut self, t: f64, y: &[f64], p: &[f64]) -> f64 {
        let Self { functions, sides, tolerances, longest, place } = self;
        let Sides { signs, flows, p: own } = &*sides.lock();
        let off = |(g, sign): (&Function<'_>, &f64)| *sign != 0.0 && g.at(t, y, p) * sign <= 0.0;
        let Some(i) = functions.iter().zip(signs).position(off) else { return 0.0 };
        let Some(flow) = nearest(flows, t) else { return 0.0 };
        let mut value = |i: usize, time: f64| {
            place.clear();
            place.extend(y.iter().zip(flow).map(|(y, slope)| y + time * slope));
            functions[i].at(t + time, place, p)
        };
        // the time in which the state changes by its size, in the mean over the unknowns
        let rates = flow.iter().enumerate().map(|(i, f)| f / tolerances.size_of(i, y[i]));
        let squares: f64 = rates.map(|rate| rate * rate).sum();
        let unit = (y.len() as f64 / squares).sqrt().min(*longest);
        let probe = f64::EPSILON.cbrt() * unit;
        let rate = (value(i, probe) - value(i, -probe)) / (2.0 * probe);
        let ahead = (signs[i] * rate).signum();
        let clearance = CLEARANCE * unit + 8.0 * f64::EPSILON * t.abs();
        let reach = REACH * tolerances.rtol.sqrt();
        let mut distance = 1.001 * (value(i, 0.0) / rate).abs() + clearance;
        // a surface that other parameters have moved may be as far as the state changes in a long time
        let farthest = match -signs[i] * functions[i].at(t, y, own) / rate.abs() <= reach * unit {
            true => reach * *longest,
            false => 0.0,
        };
        while distance <= farthest {
            let shift = ahead * distance;
            let mut is_clear = |shift: f64| {
                let mut pairs = signs.iter().enumerate();
                pairs.all(|(i, sign)| *sign == 0.0 || value(i, shift) * sign > 0.0)
            };
            if is_clear(shift) && is_clear(FAR * shift) {
                return shift;
            }
            distance *= 4.0;
        }
        0.0
    }

    /// The state moved by a time along the flow.
    pub(super) fn moved(&mut self, t: f64, y: &[f64], time: f64) -> &[f64] {
        self.place.clear();
        self.place.extend_from_slice(y);
        let flows = &self.sides.lock().flows;
        if let Some(flow) = nearest(flows, t).filter(|_| time != 0.0) {
            self.place.iter_mut().zip(flow).for_each(|(y, slope)| *y += time * slope);
        }
        &self.place
    }
}

/// The flow at the time nearest to `t`.
fn nearest(flows: &[(f64, Vec<f64>)], t: f64) -> Option<&Vec<f64>> {
    let nearest = flows.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs()));
    nearest.map(|(_, flow)| flow)
}

/// Equations on the sides of their switches that the solution is on.
struct Sided<'a, S: ?Sized> {
    system: Box<S>,
    surfaces: Surfaces<'a>,
    far: Vec<f64>,
}

impl<S: ?Sized> Sided<'_, S> {
    /// Writes what `evaluate` writes at a time and a state, continued along a line from the right side, which is
    /// `shift` from there.
    fn continued(
        &mut self,
        (t, y): (f64, &[f64]),
        shift: f64,
        out: &mut [f64],
        mut evaluate: impl FnMut(&mut S, f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Self { system, surfaces, far } = self;
        if shift == 0.0 {
            return evaluate(system, t, y, out);
        }
        evaluate(system, t + shift, surfaces.moved(t, y, shift), out)?;
        far.resize(out.len(), 0.0);
        evaluate(system, t + FAR * shift, surfaces.moved(t, y, FAR * shift), far)?;
        out.iter_mut().zip(far).for_each(|(out, far)| *out = continued(*out, *far));
        Ok(())
    }
}

/// Methods that are called at the point moved to the right side: derivatives, which need not be continued.
macro_rules! moved {
    ($(fn $name:ident($($cj:ident,)? [$y:ident $(, $yp:ident)?] $(, $argument:ident: $type:ty)*) $(-> $result:ty)?;)+) => {
        $(
            #[allow(clippy::too_many_arguments)] // those of the method
            fn $name(&mut self, t: f64, $($cj: f64,)? $y: &[f64], $($yp: &[f64],)? $($argument: $type),*) -> moved!(@result $($result)?) {
                let shift = self.surfaces.shift(t, $y, self.system.parameters());
                let place = self.surfaces.moved(t, $y, shift);
                self.system.$name(t + shift, $($cj,)? place, $($yp,)? $($argument),*)
            }
        )+
    };
    (@result) => { Result<(), Failure> };
    (@result $result:ty) => { $result };
}

impl<'a> Ode for Sided<'a, dyn Ode + Send + 'a> {
    delegate!(Ode in system: explicit_part, mass);
    delegate! { @methods [system]
        fn project(t: f64, y: &[f64], correction: &mut [f64], error: &mut [f64]);
        fn root_count() -> usize;
        fn roots(t: f64, y: &[f64], g: &mut [f64]);
        fn quadrature_count() -> usize;
        fn parameters() -> &[f64];
        fn set_parameters(values: &[f64]) -> ();
        fn newton_solve(gamma: f64, r: &mut [f64]);
        fn integrals() -> usize;
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let shift = self.surfaces.shift(t, y, self.system.parameters());
        self.continued((t, y), shift, ydot, call::rhs)
    }

    fn newton_rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let shift = self.surfaces.shift(t, y, self.system.parameters());
        self.continued((t, y), shift, ydot, call::newton_rhs)
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        let shift = self.surfaces.shift(t, y, self.system.parameters());
        self.continued((t, y), shift, qdot, |system, t, y, out| {
            call::quadratures(system, t, y, out)
        })
    }

    moved! {
        fn dense_jacobian([y], ydot: &[f64], jacobian: MatMut<'_, f64>);
        fn banded_jacobian([y], ydot: &[f64], jacobian: BandMut<'_>);
        fn sparse_jacobian([y], ydot: &[f64], values: &mut [f64]);
        fn jacobian_times([y], ydot: &[f64], v: &[f64], jv: &mut [f64]);
        fn newton_setup([y], ydot: &[f64], gamma: f64, reuse: bool) -> Result<bool, Failure>;
        fn sensitivity_rhs([y], ydot: &[f64], parameter: usize, s: &[f64], out: &mut [f64]);
        fn adjoint_rhs([y], lambda: &[f64], out: &mut [f64]);
        fn adjoint_parameters([y], lambda: &[f64], out: &mut [f64]);
    }
}

impl<'a> Dae for Sided<'a, dyn Dae + Send + 'a> {
    delegate! { @methods [system]
        fn root_count() -> usize;
        fn roots(t: f64, y: &[f64], yp: &[f64], g: &mut [f64]);
        fn quadrature_count() -> usize;
        fn parameters() -> &[f64];
        fn set_parameters(values: &[f64]) -> ();
        fn newton_solve(r: &mut [f64]);
    }

    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        let shift = self.surfaces.shift(t, y, self.system.parameters());
        self.continued((t, y), shift, residual, |system, t, y, out| {
            call::residual(system, t, y, yp, out)
        })
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        let shift = self.surfaces.shift(t, y, self.system.parameters());
        self.continued((t, y), shift, qdot, |system, t, y, out| {
            call::dae_quadratures(system, t, y, yp, out)
        })
    }

    moved! {
        fn dense_jacobian(cj, [y, yp], jacobian: MatMut<'_, f64>);
        fn banded_jacobian(cj, [y, yp], jacobian: BandMut<'_>);
        fn sparse_jacobian(cj, [y, yp], values: &mut [f64]);
        fn jacobian_times(cj, [y, yp], v: &[f64], jv: &mut [f64]);
        fn newton_setup(cj, [y, yp]);
        fn sensitivity_residual([y, yp], parameter: usize, s: &[f64], sp: &[f64], out: &mut [f64]);
        fn adjoint_residual([y, yp], lambda: &[f64], mu: &[f64], out: &mut [f64]);
        fn adjoint_parameters([y, yp], lambda: &[f64], out: &mut [f64]);
    }
}
