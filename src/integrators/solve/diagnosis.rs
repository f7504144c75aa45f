//! The cause of a large number of steps, from the equations at the present state.

use super::{
    method::Limit,
    rate::{Rate, norm, slope_of},
    run::Run,
};

/// Steps after which a run may lead nowhere, and how many times as many would then be left.
const MANY: u64 = 1000;
const HOPELESS: f64 = 1e3;
/// Part of the mean step that the last one is then, at most.
const SHRUNK: f64 = 1e-2;

/// So many times in which it decays or turns, a mode is none that the solution follows.
const UNFOLLOWED: f64 = 30.0;

impl Run<'_> {
    /// A warning about the steps, after a thousand or more: the equations switch to and fro, stability and not accuracy
    /// limits the step size, or the run makes no progress.
    ///
    /// It takes up to 20 evaluations of the right-hand side at states nearby; at the end of the span none, where only the detection
    /// by Dormand and Prince's method during the run is used.
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
