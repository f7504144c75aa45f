//! Sensitivities across a jump.

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
    /// Those before the jump at the present time, if there was one.
    pub(super) before: Option<Vec<f64>>,
}

/// Where and how a solution jumps.
pub(super) struct Crossing<'c> {
    pub(super) t: f64,
    /// The time in which the state before changes by its size.
    pub(super) unit_of_time: f64,
    /// The state before.
    pub(super) before: &'c [f64],
    /// Its time derivatives before and after.
    pub(super) slopes: [&'c [f64]; 2],
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
    /// Those of `n` unknowns, in equations with `count` parameters.
    pub(super) fn new(options: &Sensitivities, n: usize, count: usize) -> Self {
        let (parameters, dp) = (options.parameters().to_vec(), options.directions(count));
        Self { s: vec![0.0; n * parameters.len()], dp, parameters, before: None }
    }

    /// Reads them at time `t` within the last step.
    pub(super) fn read(&mut self, engine: &mut dyn Engine, t: f64) -> Result<(), Reason> {
        self.before = None;
        let columns = self.parameters.len();
        let n = self.s.len() / columns;
        let s = MatMut::from_column_major_slice_mut(&mut self.s, n, columns);
        Ok(engine.sensitivities_at(t, s)?)
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
    /// With the slopes f- before and f+ after it, they are
    ///
    /// ```text
    /// s+ = a_y (s + f- tau) + a_t tau + a_p dp - f+ tau
    /// dp+ = b_y (s + f- tau) + b_t tau + b_p dp
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
        self.before = Some(self.s.clone());
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

    /// Starts from sensitivities other than zero, and those of the parameters, if there are any.
    pub(super) fn start(
        &mut self,
        s: &[f64],
        dp: &[f64],
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
        self.s.copy_from_slice(s);
        engine.map_or(Ok(()), |engine| self.hand_over(engine))
    }

    /// Passes them to the integrator after its restart.
    pub(super) fn hand_over(&self, engine: &mut dyn Engine) -> Result<(), Reason> {
        let columns = self.parameters.len();
        let s = MatRef::from_column_major_slice(&self.s, self.s.len() / columns, columns);
        Ok(engine.start_sensitivities(s, &self.dp)?)
    }
}
