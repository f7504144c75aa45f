//! Contact action between two nearby surfaces: pressure, damping, friction.

use super::law::NormalLaw;
use super::pair::{MOST, Pair};
use crate::base::vector::{dot, norm};
use crate::scene::forces::friction::{Coulomb, Drag};

/// Contact action between a point and a feature.
pub(super) struct Action {
    /// Weight times area (m^2): the share of the energy per area.
    pub(super) share: f64,
    /// Velocity of the point relative to the feature, the rate of the distance, and the sliding velocity (m/s).
    velocity: [f64; 3],
    rate: f64,
    pub(super) sliding: [f64; 3],
    /// The part of the normal force with a potential (N), and what multiplies -rate in the other one (N s/m).
    pub(super) elastic: f64,
    pub(super) damping: f64,
    pub(super) drag: Option<Drag>,
    /// Whether damping does not pull more than the surfaces press; else no force is left.
    pub(super) presses: bool,
}

impl Action {
    /// Contact action in a `pair` with this `share`, whose point has this `velocity` (m/s) relative to the feature.
    pub(super) fn new(
        pair: &Pair,
        share: f64,
        velocity: [f64; 3],
        law: &NormalLaw,
        coulomb: Option<Coulomb>,
    ) -> Self {
        let rate = dot(&pair.normal, &velocity);
        let sliding: [f64; 3] = std::array::from_fn(|i| velocity[i] - rate * pair.normal[i]);
        let pressure = law.pressure(pair.gap);
        let damping = law.damping_time() * law.curvature(pair.gap);
        let drag = coulomb.map(|coulomb| coulomb.drag(norm(&sliding)));
        let (elastic, damping) = (share * pressure, share * damping);
        let presses = pressure * share.abs() >= damping.abs() * rate;
        Self { share, velocity, rate, sliding, elastic, damping, drag, presses }
    }

    /// The normal force (N) on the point.
    pub(super) fn pressing(&self) -> f64 {
        self.elastic - self.damping * self.rate
    }

    /// The shares of the nodes in that force: at the surfaces, or where nothing is left of the normal force as this.
    pub(super) fn braked<'a>(&self, pair: &'a Pair) -> &'a [f64; MOST] {
        if self.presses { &pair.grips } else { &pair.shares }
    }

    /// Force on the point (N) of damping and friction.
    pub(super) fn braking(&self, normal: &[f64; 3]) -> [f64; 3] {
        if !self.presses {
            return normal.map(|n| -self.elastic * n);
        }
        let along = self.drag.map_or(0.0, |drag| self.pressing() * drag.per_speed);
        std::array::from_fn(|i| -self.damping * self.rate * normal[i] - along * self.sliding[i])
    }
}

/// How damping and friction on the point change as its relative velocity changes by `velocity`, the normal by `normal`,
/// and the elastic force and the damping of a pair by themselves by `of_u`.
pub(super) fn changed(
    action: &Action,
    pair: &Pair,
    velocity: &[f64; 3],
    normal: &[f64; 3],
    [elastic, damping]: [f64; 2],
) -> [f64; 3] {
    let n = &pair.normal;
    let rate = dot(normal, &action.velocity) + dot(n, velocity);
    let braking = -damping * action.rate - action.damping * rate;
    let damped: [f64; 3] =
        std::array::from_fn(|i| braking * n[i] - action.damping * action.rate * normal[i]);
    let Some(drag) = &action.drag else { return damped };
    let sliding: [f64; 3] =
        std::array::from_fn(|i| velocity[i] - rate * n[i] - action.rate * normal[i]);
    let pressing = action.pressing();
    let along = (elastic + braking) * drag.per_speed
        + pressing * drag.slope * dot(&action.sliding, &sliding);
    std::array::from_fn(|i| {
        damped[i] - along * action.sliding[i] - pressing * drag.per_speed * sliding[i]
    })
}
