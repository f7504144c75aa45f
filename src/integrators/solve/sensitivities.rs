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
    pub(super) p: &'c [f64],
}

/// A direction in time, in the state, and in one of the parameters.
type Direction<'d> = (f64, &'d [f64], Option<usize>);

impl Crossing<'_> {
    /// Time, state and parameters at a distance from those before the jump.
    fn moved(&self, (dt, dy, k): &Direction<'_>, distance: f64) -> (f64, Vec<f64>, Vec<f64>) {
        let mut p = self.p.to_vec();
        if let Some(k) = k {
            p[*k] += distance;
        }
        let y = self.before.iter().zip(*dy).map(|(y, d)| y + distance * d).collect();
        (self.t + distance * dt, y, p)
    }
}

impl Carried {
    pub(super) fn new(options: &Sensitivities, n: usize) -> Self {
        let parameters = options.parameters().to_vec();
        Self { s: vec![0.0; n * parameters.len()], parameters, before: None }
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
        mut g: impl FnMut(f64, &[f64], &[f64]) -> f64,
    ) -> Vec<f64> {
        let mut along = |direction: Direction<'_>, size: f64| {
            let distance = f64::EPSILON.cbrt() * size;
            let [ahead, behind] = [distance, -distance].map(|distance| {
                let (t, y, p) = at.moved(&direction, distance);
                g(t, &y, &p)
            });
            (ahead - behind) / (2.0 * distance)
        };
        let rate = along((1.0, at.slopes[0], None), at.unit_of_time);
        let columns = self.parameters.iter().zip(self.s.chunks(at.before.len()));
        columns.map(|(&k, s)| -along((0.0, s, Some(k)), size_or_one(at.p[k])) / rate).collect()
    }

    /// Carries them across a jump y+ = a(t, y, p) by `act`, at a time with the derivatives `taus`.
    ///
    /// With the slopes f- before and f+ after it, they are
    ///
    /// ```text
    /// s+ = a_y (s + f- tau) + a_t tau + a_p - f+ tau
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
        let n = at.before.len();
        let [left, right] = at.slopes;
        // an action that reads derivatives gets NaN: these differences would miss how they change
        let mut unknown = vec![f64::NAN; if at.of_dae { n } else { 0 }];
        self.before = Some(self.s.clone());
        for ((&tau, &k), s) in taus.iter().zip(&self.parameters).zip(self.s.chunks_mut(n)) {
            let direction: Vec<f64> = s.iter().zip(left).map(|(s, f)| s + f * tau).collect();
            let distance = f64::EPSILON.cbrt() * size_or_one(at.p[k]);
            let mut landed = |distance: f64| {
                let (t, mut y, mut p) = at.moved(&(tau, &direction, Some(k)), distance);
                unknown.fill(f64::NAN);
                act(&mut Jump { t, y: &mut y, yp: &mut unknown, p: &mut p, ends: false });
                y
            };
            let (ahead, behind) = (landed(distance), landed(-distance));
            for i in 0..n {
                s[i] = (ahead[i] - behind[i]) / (2.0 * distance) - right[i] * tau;
            }
        }
        Ok(check_landed("sensitivities after the jump", &self.s, at.of_dae)?)
    }

    /// Starts from sensitivities other than zero.
    pub(super) fn start(&mut self, s: &[f64], engine: &mut dyn Engine) -> Result<(), Reason> {
        if s.len() != self.s.len() {
            let help = format!("there are {} of them, n for each parameter", self.s.len());
            let input = "length of the sensitivities at the start";
            return Err(InputError::new(input, s.len(), help).into());
        }
        self.s.copy_from_slice(s);
        self.hand_over(engine)
    }

    /// Passes them to the integrator after its restart.
    pub(super) fn hand_over(&self, engine: &mut dyn Engine) -> Result<(), Reason> {
        let columns = self.parameters.len();
        let s = MatRef::from_column_major_slice(&self.s, self.s.len() / columns, columns);
        Ok(engine.start_sensitivities(s)?)
    }
}
