//! Sensitivities across a jump.

use std::mem;

use faer::{MatMut, MatRef};

use super::{
    engine::Engine,
    error::Reason,
    event::{Jump, check_landed},
};
use crate::base::{input::InputError, vector::size_or_one};
use crate::integrators::sundials::Sensitivities;

/// The sensitivities dy/dp of a run with respect to some of the parameters of its equations.
pub(super) struct Carried {
    /// Their places among the parameters.
    parameters: Vec<usize>,
    /// The sensitivities, one column for each of these parameters.
    pub(super) s: Vec<f64>,
    /// The derivatives of all parameters by these, which actions may set: one column for each.
    pub(super) dp: Vec<f64>,
    /// The sensitivities of the integrals, one column for each parameter, and the same at the last start of the
    /// integrator; empty if they are not wanted.
    pub(super) q: [Vec<f64>; 2],
    /// Those of the state and of the integrals before the jump at the present time, if there was one.
    pub(super) before: Option<[Vec<f64>; 2]>,
}

/// Time and size of a jump of the solution.
pub(super) struct Crossing<'c> {
    pub(super) t: f64,
    /// The time in which the state before changes by its size.
    pub(super) unit_of_time: f64,
    /// The state before.
    pub(super) before: &'c [f64],
    /// Its time derivatives before and after.
    pub(super) slopes: [&'c [f64]; 2],
    /// The integrands before and after; none if their derivatives are not wanted.
    pub(super) integrands: [&'c [f64]; 2],
    pub(super) of_dae: bool,
    /// The parameters before.
    pub(super) p: &'c [f64],
}

/// Largest rounding error of a difference quotient of a parameter that stays as it is.
const ROUNDING: f64 = 1e-9;

/// A direction in time, in the state, and in the parameters.
type Direction<'d> = (f64, &'d [f64], &'d [f64]);

impl Crossing<'_> {
    /// Time, state and parameters at a distance from those before the jump.
    fn moved(&self, (dt, dy, dp): &Direction<'_>, distance: f64) -> (f64, Vec<f64>, Vec<f64>) {
        let along = |from: &[f64], direction: &[f64]| {
            from.iter().zip(direction).map(|(from, d)| from + distance * d).collect()
        };
        (self.t + distance * dt, along(self.before, dy), along(self.p, dp))
    }
}

impl Carried {
    /// Those of `n` unknowns and so many `integrals`, in equations with `count` parameters.
    pub(super) fn new(options: &Sensitivities, [n, integrals]: [usize; 2], count: usize) -> Self {
        let (parameters, dp) = (options.parameters().to_vec(), options.directions(count));
        let integrals = if options.has_integrals() { integrals } else { 0 };
        let q = vec![0.0; integrals * parameters.len()];
        let s = vec![0.0; n * parameters.len()];
        Self { s, dp, parameters, q: [q.clone(), q], before: None }
    }

    /// Whether those of integrals are wanted.
    pub(super) fn has_integrals(&self) -> bool {
        !self.q[1].is_empty()
    }

    /// Those of the state and of the integrals before the jump at the present time, or at that time if there was none.
    pub(super) fn before(&self) -> [&[f64]; 2] {
        self.before.as_ref().map_or([&self.s, &self.q[0]], |[s, q]| [s, q])
    }

    /// Writes those of the state and of the integrals at time `t` within the last step.
    pub(super) fn write_at(
        &self,
        engine: &mut dyn Engine,
        t: f64,
        [s, q]: [&mut [f64]; 2],
    ) -> Result<(), Reason> {
        let columns = self.parameters.len();
        let rows = [s.len() / columns, q.len() / columns];
        engine.sensitivities_at(t, MatMut::from_column_major_slice_mut(s, rows[0], columns))?;
        if self.has_integrals() {
            let out = MatMut::from_column_major_slice_mut(q, rows[1], columns);
            engine.quadrature_sensitivities_at(t, out)?;
            q.iter_mut().zip(&self.q[1]).for_each(|(q, past)| *q += *past);
        }
        Ok(())
    }

    /// Reads them at time `t` within the last step.
    pub(super) fn read(&mut self, engine: &mut dyn Engine, t: f64) -> Result<(), Reason> {
        self.before = None;
        let (mut s, mut q) = (mem::take(&mut self.s), mem::take(&mut self.q[0]));
        let outcome = self.write_at(engine, t, [&mut s, &mut q]);
        (self.s, self.q[0]) = (s, q);
        outcome
    }

    /// The derivatives tau of the time of an event with respect to the parameters, where `g` is its function:
    /// tau = -(g_y s + g_p) / (g_t + g_y f-).
    pub(super) fn of_time(
        &self,
        at: &Crossing<'_>,
        g: impl Fn(f64, &[f64], &[f64]) -> f64,
    ) -> Vec<f64> {
        let along = |direction: Direction<'_>, size: f64| {
            let distance = f64::EPSILON.cbrt() * size;
            let [ahead, behind] = [distance, -distance].map(|distance| {
                let (t, y, p) = at.moved(&direction, distance);
                g(t, &y, &p)
            });
            (ahead - behind) / (2.0 * distance)
        };
        let still = vec![0.0; at.p.len()];
        let rate = along((1.0, at.slopes[0], &still), at.unit_of_time);
        let columns = self.s.chunks(at.before.len()).zip(self.dp.chunks(at.p.len()));
        let columns = self.parameters.iter().zip(columns);
        columns.map(|(&k, (s, dp))| -along((0.0, s, dp), size_or_one(at.p[k])) / rate).collect()
    }

    /// Carries them across a jump y+ = a(t, y, p), p+ = b(t, y, p) by `act`, at a time with the derivatives
    /// `taus`.
    ///
    /// With the slopes f and the integrands h before (-) and after it (+), they are
    ///
    /// ```text
    /// s+ = a_y (s + f- tau) + a_t tau + a_p dp - f+ tau
    /// dp+ = b_y (s + f- tau) + b_t tau + b_p dp
    /// dq/dp+ = dq/dp + (h- - h+) tau
    /// ```
    ///
    /// (W. A. Rozenvasser, Automation and Remote Control 28 (1967) 1043-1049). Derivatives are central
    /// differences along these directions.
    pub(super) fn cross(
        &mut self,
        at: &Crossing<'_>,
        taus: &[f64],
        mut act: impl FnMut(&mut Jump<'_>),
    ) -> Result<(), Reason> {
        let (n, count) = (at.before.len(), at.p.len());
        let [left, right] = at.slopes;
        // an action that reads derivatives gets NaN: these differences would miss how they change
        let mut unknown = vec![f64::NAN; if at.of_dae { n } else { 0 }];
        self.note_before();
        self.cross_integrals(at, taus);
        let columns = self.s.chunks_mut(n).zip(self.dp.chunks_mut(count));
        for ((&tau, &k), (s, dp)) in taus.iter().zip(&self.parameters).zip(columns) {
            let direction: Vec<f64> = s.iter().zip(left).map(|(s, f)| s + f * tau).collect();
            let distance = f64::EPSILON.cbrt() * size_or_one(at.p[k]);
            let mut landed = |distance: f64| {
                let (t, mut y, mut p) = at.moved(&(tau, &direction, dp), distance);
                unknown.fill(f64::NAN);
                act(&mut Jump::new(t, &mut y, &mut unknown, &mut p));
                (y, p)
            };
            let (ahead, behind) = (landed(distance), landed(-distance));
            for i in 0..n {
                s[i] = (ahead.0[i] - behind.0[i]) / (2.0 * distance) - right[i] * tau;
            }
            for (i, dp) in dp.iter_mut().enumerate() {
                let slope = (ahead.1[i] - behind.1[i]) / (2.0 * distance);
                // parameters that the action does not set keep theirs to the last bit
                if (slope - *dp).abs() > ROUNDING * dp.abs().max(1.0) {
                    *dp = slope;
                }
            }
        }
        check_landed("sensitivities after the jump", &self.s, at.of_dae)?;
        Ok(check_landed("sensitivities of parameters after the jump", &self.dp, at.of_dae)?)
    }

    /// Notes those before a jump.
    pub(super) fn note_before(&mut self) {
        self.before = Some([self.s.clone(), self.q[0].clone()]);
    }

    fn cross_integrals(&mut self, at: &Crossing<'_>, taus: &[f64]) {
        let [left, right] = at.integrands;
        if !self.has_integrals() {
            return;
        }
        for (q, tau) in self.q[0].chunks_mut(left.len()).zip(taus) {
            let jumps = left.iter().zip(right).map(|(left, right)| left - right);
            q.iter_mut().zip(jumps).for_each(|(q, jump)| *q += jump * tau);
        }
    }

    /// Starts from sensitivities other than zero, and those of the parameters and of the integrals, if there are any.
    pub(super) fn start(
        &mut self,
        [s, dp, q]: [&[f64]; 3],
        engine: Option<&mut dyn Engine>,
    ) -> Result<(), Reason> {
        if dp.len() == self.dp.len() {
            self.dp.copy_from_slice(dp);
        }
        if s.len() != self.s.len() {
            let help = format!("there are {} of them, n for each parameter", self.s.len());
            let input = "length of the sensitivities at the start";
            return Err(InputError::new(input, s.len(), help).into());
        }
        if ![0, self.q[0].len()].contains(&q.len()) {
            let help = format!("there are {} of them", self.q[0].len());
            let input = "length of the sensitivities of integrals at the start";
            return Err(InputError::new(input, q.len(), help).into());
        }
        self.s.copy_from_slice(s);
        for present in &mut self.q {
            present.fill(0.0);
            present.iter_mut().zip(q).for_each(|(present, q)| *present = *q);
        }
        engine.map_or(Ok(()), |engine| self.hand_over(engine))
    }

    /// Passes them to the integrator after its restart.
    pub(super) fn hand_over(&mut self, engine: &mut dyn Engine) -> Result<(), Reason> {
        let [q, past] = &mut self.q;
        past.copy_from_slice(q);
        let columns = self.parameters.len();
        let s = MatRef::from_column_major_slice(&self.s, self.s.len() / columns, columns);
        Ok(engine.start_sensitivities(s, &self.dp)?)
    }
}
