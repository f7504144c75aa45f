//! Why a run takes so many steps, by a look at the equations where it has come to.

use super::{engine::Engine, method::Limit, run::Run};
use crate::base::vector::noise;
use crate::integrators::common::Tolerances;

/// Steps after which a run may lead nowhere, and how many times as many would then be left.
const MANY: u64 = 1000;
const HOPELESS: f64 = 1e3;
/// Part of the mean step that the last one is then, at most.
const SHRUNK: f64 = 1e-2;

/// Products with the Jacobian by which the largest rate of the equations is estimated: an even number, as they alternate between two sizes
/// where an oscillation has unknowns of two scales.
const PRODUCTS: i32 = 12;
/// Evaluations of the right-hand side that the estimate takes.
pub(super) const EVALUATIONS: u64 = PRODUCTS as u64 + 1;
/// Change of the state along which they are differences, relative to its size.
const SHIFT: f64 = 1e-7;
/// So many times in which it decays or turns, a mode is none that the solution follows.
const UNFOLLOWED: f64 = 30.0;

/// The dominant eigenvalue of df/dy.
pub(super) struct Rate {
    /// Its absolute value.
    pub(super) size: f64,
    /// Whether it lies nearer to the imaginary axis than to the real one.
    pub(super) oscillates: bool,
}

impl Run<'_> {
    /// A warning about the steps, where there are a thousand or more: that the equations switch to and fro, that stability, not accuracy,
    /// limits their size, or that they lead nowhere.
    ///
    /// It takes up to 20 evaluations of the right-hand side at states nearby; at the end of the span none, as there it is only what Dormand
    /// and Prince's method has seen on the way.
    #[must_use]
    pub fn notice(&mut self) -> Option<String> {
        let steps = self.steps();
        if steps < MANY {
            return None;
        }
        if self.end.is_some() {
            return self.watched();
        }
        self.chatter().or_else(|| self.instability()).or_else(|| self.standstill(steps))
    }

    /// Whether the equations jump to and fro across the present state, which then slides along the jump.
    ///
    /// Across a jump the right-hand side changes by as much over ten steps along the solution as over a hundred; of smooth equations it
    /// changes in proportion.
    fn chatter(&mut self) -> Option<String> {
        let here = self.slope_of(&self.y.clone())?;
        let h = self.engine.statistics().last_step.abs();
        let mut jump = |steps: f64| {
            let [ahead, behind] = [h * steps, -h * steps].map(|time| {
                let pairs = self.y.iter().zip(&here);
                let moved: Vec<f64> = pairs.map(|(y, slope)| y + time * slope).collect();
                self.slope_of(&moved)
            });
            let change: Vec<f64> =
                ahead?.iter().zip(&behind?).map(|(ahead, behind)| ahead - behind).collect();
            Some(self.norm(&change))
        };
        let (near, far) = (jump(10.0)?, jump(100.0)?);
        let is_jump = near > 0.5 * self.norm(&here) && near < 2.0 * far && far < 2.0 * near;
        is_jump.then(|| {
            format!(
                "the equations switch to and fro at this state (a sign, an if), and the solution slides along the switch in steps of \
                 {h:.1e}: smooth them, or turn the switch into an event that sets a parameter, with the sliding as a mode of its own"
            )
        })
    }

    /// Whether stability, not accuracy, bounds the steps.
    fn instability(&mut self) -> Option<String> {
        match self.limit {
            Limit::None => return None,
            Limit::Watched => return self.watched(),
            Limit::FastModes | Limit::Oscillations => {}
        }
        let statistics = self.engine.statistics();
        let (h, order) = (statistics.last_step.abs(), statistics.last_order);
        let Self { engine, tolerances, t, y, .. } = self;
        let Rate { size, oscillates } = Rate::of(engine.as_mut(), tolerances, *t, y)?;
        let slope = self.slope_of(&self.y.clone())?;
        let is_unfollowed = size * self.unit_of_time(&self.y, &slope) > UNFOLLOWED;
        let least = match self.limit {
            Limit::Oscillations if oscillates && order > 2 => 0.2,
            Limit::FastModes => 0.5,
            _ => return None,
        };
        let advice = match oscillates {
            true => {
                "use Method::Rosenbrock, or Method::RungeKutta with an implicit table; BDF of order 3 and higher is unstable for fast \
                 oscillations with little damping"
            }
            false => "use an implicit method for stiff equations, such as Method::Bdf",
        };
        (is_unfollowed && (least..10.0).contains(&(size * h))).then(|| {
            format!(
                "stability, not accuracy, limits the steps to {h:.1e}: the equations have modes of the rate {size:.1e}, which the solution \
                 does not follow; {advice}"
            )
        })
    }

    /// The notice of an integrator that watches the stability of its steps.
    fn watched(&self) -> Option<String> {
        self.engine.notice().filter(|_| self.limit == Limit::Watched)
    }

    /// Whether steps have shrunk so much that the end of the span is out of reach.
    fn standstill(&self, steps: u64) -> Option<String> {
        let h = self.engine.statistics().last_step.abs();
        let left = (self.span.1 - self.t).abs() / h;
        let usual = (self.t - self.span.0).abs() / steps as f64;
        (h < SHRUNK * usual && left > HOPELESS * steps as f64).then(|| {
            format!(
                "steps have shrunk to {h:.1e}, of which the rest of the span would take {left:.0e}: look for equations that switch to \
                 and fro at this time (a sign, an if), whose solution slides along the switch: smooth them, or turn the switch into an \
                 event; for a singularity; or for a fast oscillation"
            )
        })
    }

    /// The right-hand side of an ODE at the present time and the state `y`; none where it has no value, and of other equations.
    fn slope_of(&mut self, y: &[f64]) -> Option<Vec<f64>> {
        match self.yp.is_empty() {
            true => slope_of(self.engine.as_mut(), self.t, y),
            false => None,
        }
    }

    /// The root mean square of a change of the state, relative to the sizes of the unknowns.
    fn norm(&self, change: &[f64]) -> f64 {
        norm(&self.tolerances, &self.y, change)
    }
}

impl Rate {
    /// That at time `t` and the state `y` of an ODE, by power iteration with differences: [`EVALUATIONS`] of the right-hand side.
    pub(super) fn of(
        engine: &mut dyn Engine,
        tolerances: &Tolerances,
        t: f64,
        y: &[f64],
    ) -> Option<Self> {
        let n = y.len();
        let here = slope_of(engine, t, y)?;
        let sizes: Vec<f64> = (0..n).map(|i| tolerances.size_of(i, y[i])).collect();
        let norm = |change: &[f64]| norm(tolerances, y, change);
        let mut v: Vec<f64> = noise(n, 1).iter().zip(&sizes).map(|(v, size)| v * size).collect();
        let mut last = v.clone();
        let (mut product, mut cosine) = (0.0, 0.0);
        for k in 0..PRODUCTS {
            let length = norm(&v);
            if length == 0.0 || !length.is_finite() {
                return None;
            }
            v.iter_mut().for_each(|v| *v /= length);
            let moved: Vec<f64> = y.iter().zip(&v).map(|(y, v)| y + SHIFT * v).collect();
            let slope = slope_of(engine, t, &moved)?;
            let next: Vec<f64> = slope.iter().zip(&here).map(|(a, b)| (a - b) / SHIFT).collect();
            // half of them lead to the dominant mode
            if k >= PRODUCTS / 2 {
                product += norm(&next).ln();
            }
            let scaled = |a: &[f64], b: &[f64]| -> f64 {
                (0..n).map(|i| a[i] * b[i] / (sizes[i] * sizes[i])).sum::<f64>() / n as f64
            };
            cosine = scaled(&next, &last) / (norm(&next) * norm(&last));
            last = std::mem::replace(&mut v, next);
        }
        let size = (product / f64::from(PRODUCTS - PRODUCTS / 2)).exp();
        size.is_finite().then_some(Self { size, oscillates: cosine < 0.0 })
    }
}

/// The right-hand side of an ODE at time `t` and the state `y`; none where it has no value.
fn slope_of(engine: &mut dyn Engine, t: f64, y: &[f64]) -> Option<Vec<f64>> {
    let mut slope = vec![0.0; y.len()];
    engine.slope(t, y, &mut slope).ok()?;
    slope.iter().all(|slope| slope.is_finite()).then_some(slope)
}

/// The root mean square of a change of the state `y`, relative to the sizes of the unknowns.
fn norm(tolerances: &Tolerances, y: &[f64], change: &[f64]) -> f64 {
    let squares = change.iter().enumerate().map(|(i, x)| (x / tolerances.size_of(i, y[i])).powi(2));
    (squares.sum::<f64>() / change.len() as f64).sqrt()
}
