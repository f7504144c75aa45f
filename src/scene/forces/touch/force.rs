//! The forces between surfaces.

use std::sync::{Arc, Mutex, PoisonError};

use super::crossing::Ways;
use super::law::{Kind, Law};
use super::near::{Near, NearPair};
use super::pair::{MOST, Pair};
use super::surfaces::Surfaces;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::{dot, norm};
use crate::elements::force::{Force, NodalForces, Reservoir, Step, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::friction::{Coulomb, Drag};
use crate::scene::forces::passage::Path;

/// The forces between the surfaces of some bodies.
pub(crate) struct TouchForce {
    pub(super) name: String,
    pub(super) surfaces: Surfaces,
    pub(super) law: Law,
    pub(super) coulomb: Option<Coulomb>,
    /// How much farther (m) than they act pairs are looked for, so that they need not be at each evaluation.
    margin: f64,
    /// The pairs last found: they change what a state costs, not what it gives.
    near: Mutex<Arc<Near>>,
}

/// Part of its distance to which a point may come near a facet within one step.
const ONTO: f64 = 0.02;

/// What acts between a point and a feature.
pub(super) struct Action {
    /// Weight times area (m^2): the share of the energy per area.
    share: f64,
    /// Velocity of the point relative to the feature, the rate of the distance, and the sliding velocity (m/s).
    velocity: [f64; 3],
    rate: f64,
    pub(super) sliding: [f64; 3],
    /// The part of the normal force with a potential (N), and what multiplies -rate in the other one (N s/m).
    elastic: f64,
    damping: f64,
    drag: Option<Drag>,
    /// Whether damping does not pull more than the surfaces press; else no force is left.
    pub(super) presses: bool,
}

impl Action {
    /// The normal force (N) on the point.
    pub(super) fn pressing(&self) -> f64 {
        self.elastic - self.damping * self.rate
    }

    /// Force on the point (N) of damping and friction.
    fn braking(&self, normal: &[f64; 3]) -> [f64; 3] {
        if !self.presses {
            return normal.map(|n| -self.elastic * n);
        }
        let along = self.drag.map_or(0.0, |drag| self.pressing() * drag.per_speed);
        std::array::from_fn(|i| -self.damping * self.rate * normal[i] - along * self.sliding[i])
    }
}

impl TouchForce {
    pub(super) fn new(
        name: String,
        surfaces: Surfaces,
        law: Law,
        coulomb: Option<Coulomb>,
        margin: f64,
        u: &[f64],
    ) -> Self {
        let near = Near::new(&surfaces, u, law.distance + margin);
        Self { name, surfaces, law, coulomb, margin, near: Mutex::new(Arc::new(near)) }
    }

    /// Pairs that include all that act under the displacements `u` (m), and how much nearer (m) they may
    /// have come since they were found.
    fn near(&self, u: &[f64]) -> (Arc<Near>, f64) {
        let mut known = self.near.lock().unwrap_or_else(PoisonError::into_inner);
        let moved = known.moved(&self.surfaces, u);
        if known.covers(self.law.distance, moved) {
            return (known.clone(), moved);
        }
        *known = Arc::new(Near::new(&self.surfaces, u, self.law.distance + self.margin));
        (known.clone(), 0.0)
    }

    /// Passes to `see` each pair that acts under the displacements `u` (m), and what its share of the energy per area
    /// is (m^2).
    pub(super) fn each(&self, u: &[f64], mut see: impl FnMut(Pair, f64)) {
        let (near, moved) = self.near(u);
        for near in near.pairs.iter().filter(|near| near.distance - moved < self.law.distance) {
            let x = self.surfaces.point_at(near.point, u);
            let at = self.surfaces.nodes_at(near.feature, u);
            let feature = &self.surfaces.features[near.feature];
            if self.surfaces.is_beyond(near.feature, &at, &x, self.law.distance) {
                continue;
            }
            let place = feature.nearest(&at, &x);
            if norm(&Pair::offset(&x, &place, &at)) < self.law.distance {
                let point = self.surfaces.points[near.point].on.nodes();
                see(Pair::new((&x, point), (feature.nodes(), &at), &place), self.share(near));
            }
        }
    }

    /// Half of the area that a point stands for, as the other surface has the other half, times the weight of the
    /// feature.
    fn share(&self, near: &NearPair) -> f64 {
        0.5 * self.surfaces.points[near.point].on.area * near.weight
    }

    /// What acts in a pair with the velocities `v` (m/s).
    pub(super) fn action(&self, pair: &Pair, share: f64, v: &[f64]) -> Action {
        let velocity = pair.velocity(&pair.shares, v, self.surfaces.dimension);
        let rate = dot(&pair.normal, &velocity);
        let sliding: [f64; 3] = std::array::from_fn(|i| velocity[i] - rate * pair.normal[i]);
        let pressure = self.law.pressure(pair.distance);
        let damping = self.law.damping_time() * self.law.curvature(pair.distance);
        let drag = self.coulomb.map(|coulomb| coulomb.drag(norm(&sliding)));
        let (elastic, damping) = (share * pressure, share * damping);
        let presses = pressure * share.abs() >= damping.abs() * rate;
        Action { share, velocity, rate, sliding, elastic, damping, drag, presses }
    }

    /// Why a state is refused in which surfaces lie on each other.
    pub(super) fn passed(&self) -> Failure {
        let name = &self.name;
        Failure::Recoverable(format!(
            "surfaces of \"{name}\" lie on each other (a stiffer contact keeps them apart)"
        ))
    }

    /// The least distance (m) of the surfaces, up to that from which on nothing acts.
    pub(crate) fn gap(&self, u: &[f64]) -> f64 {
        self.nearest(u).map_or(self.law.distance, |(gap, _)| gap)
    }

    /// The force (N) on the nodes that `is_read` names together, or on all.
    pub(crate) fn force(&self, u: &[f64], v: &[f64], is_read: Option<&[bool]>) -> [f64; 3] {
        let mut total = [0.0; 3];
        self.each(u, |pair, share| {
            let action = self.action(&pair, share, v);
            let braking = action.braking(&pair.normal);
            for m in (0..pair.count).filter(|&m| is_read.is_none_or(|of| of[pair.nodes[m]])) {
                for (i, total) in total.iter_mut().enumerate() {
                    *total += pair.shares[m] * (action.elastic * pair.normal[i] + braking[i]);
                }
            }
        });
        total
    }

    /// The least distance (m) of any point from a feature that it feels, if one acts, and the nodes of both.
    pub(super) fn nearest(&self, u: &[f64]) -> Option<(f64, [usize; 2])> {
        let mut nearest: Option<(f64, [usize; 2])> = None;
        self.each(u, |pair, _| {
            if nearest.is_none_or(|(least, _)| pair.distance < least) {
                nearest = Some((pair.distance, [pair.nodes[0], pair.nodes[pair.count - 1]]));
            }
        });
        nearest
    }

    /// The ways of a point relative to the nodes of a facet in a step.
    fn ways(&self, near: &NearPair, step: &Step) -> Ways<'_> {
        let d = self.surfaces.dimension;
        let duration = step.times[1] - step.times[0];
        let on = &self.surfaces.points[near.point].on;
        let facet = &self.surfaces.features[near.feature];
        let of = facet.nodes();
        let points = step.u.map(|u| self.surfaces.point_at(near.point, u));
        let nodes = step.u.map(|u| self.surfaces.nodes_at(near.feature, u));
        let velocities = step.v.map(|v| on.at(v, d));
        let paths = std::array::from_fn(|k| {
            let node = of.get(k).copied().unwrap_or(of[0]);
            let k = k.min(of.len() - 1);
            let x = [0, 1].map(|end| std::array::from_fn(|i| points[end][i] - nodes[end][k][i]));
            let v = [0, 1].map(|end| {
                let of_node = &step.v[end][node * d..][..d];
                std::array::from_fn(|i| velocities[end][i] - of_node.get(i).copied().unwrap_or(0.0))
            });
            Path::new(x, v, duration)
        });
        Ways::new(facet, paths, self.surfaces.reach)
    }

    /// The distance (m) below which a step must not lead unseen, for these distances at its ends. A step that ends on
    /// the surface itself is none that can be continued.
    fn limit(&self, [before, after]: [f64; 2]) -> Option<f64> {
        let (least, acts_from) = (before.min(after), self.law.distance);
        match self.law.kind {
            Kind::Barrier if after < ONTO * before.min(acts_from) => {
                Some(0.5 * before.min(acts_from))
            }
            // the force where it is entered is still small
            _ if least >= acts_from => Some(0.9 * acts_from),
            // a soft spring may be passed through where it has acted
            Kind::Spring if least < 0.5 * acts_from => None,
            _ => Some(0.5 * least),
        }
    }
}

impl Force for TouchForce {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let (d, mut is_passed) = (self.surfaces.dimension, false);
        self.each(u, |pair, share| {
            is_passed |= pair.distance == 0.0;
            let action = self.action(&pair, share, v);
            let braking = action.braking(&pair.normal);
            let brakes = braking != [0.0; 3];
            for m in 0..pair.count {
                let at = pair.nodes[m] * d;
                for (i, (normal, braking)) in pair.normal.iter().zip(braking).enumerate().take(d) {
                    forces.conservative[at + i] += pair.shares[m] * action.elastic * normal;
                    if brakes {
                        forces.dissipative[at + i] += pair.shares[m] * braking;
                    }
                }
            }
        });
        if is_passed { Err(self.passed()) } else { Ok(()) }
    }

    /// The second derivative of the energy, and the derivatives of damping and friction F on the point,
    /// -d(c_m F)/dz_n = -(dc_m F + c_m dF), component by component.
    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let (d, law) = (self.surfaces.dimension, &self.law);
        self.each(u, |pair, share| {
            let action = self.action(&pair, share, v);
            if !action.presses {
                return;
            }
            let curvature = law.curvature(pair.distance);
            let slopes = [-action.elastic, share * curvature];
            let stiffening = share * law.damping_time() * law.third(pair.distance);
            let braking = action.braking(&pair.normal);
            let brakes = action.damping != 0.0 || action.drag.is_some();
            let moving = pair.moving();
            for n in 0..pair.count {
                for j in 0..d {
                    let (mut by_u, mut by_v) = ([[0.0; 3]; MOST], [[0.0; 3]; MOST]);
                    for (m, by_u) in by_u.iter_mut().enumerate().take(pair.count) {
                        *by_u = std::array::from_fn(|i| moving.second(slopes, [m, i], [n, j]));
                    }
                    if brakes {
                        let change = moving.change([n, j]);
                        let carried = pair.velocity(&change.shares, v, d);
                        let elastic = -action.share * curvature * change.distance;
                        let of_u = [elastic, stiffening * change.distance];
                        let by_place = changed(&action, &pair, &carried, &change.normal, of_u);
                        let along =
                            std::array::from_fn(|i| if i == j { pair.shares[n] } else { 0.0 });
                        let by_speed = changed(&action, &pair, &along, &[0.0; 3], [0.0; 2]);
                        for m in 0..pair.count {
                            for i in 0..d {
                                by_u[m][i] -=
                                    change.shares[m] * braking[i] + pair.shares[m] * by_place[i];
                                by_v[m][i] -= pair.shares[m] * by_speed[i];
                            }
                        }
                    }
                    for m in 0..pair.count {
                        add_column(stiffness, [pair.nodes[m], pair.nodes[n]], j, &by_u[m]);
                        if brakes {
                            add_column(damping, [pair.nodes[m], pair.nodes[n]], j, &by_v[m]);
                        }
                    }
                }
            }
        });
        Tangents::Added
    }

    /// Pairs that do not act yet, as if their distance were where they do.
    fn add_reserves(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) {
        let (near, moved) = self.near(u);
        for near in near.pairs.iter().filter(|near| near.distance + moved >= self.law.distance) {
            let hard = self.share(near).max(0.0) * self.law.reserve();
            let feature = self.surfaces.features[near.feature].nodes().iter();
            let point = self.surfaces.points[near.point].on.nodes();
            for (node, share) in point.chain(feature.map(|&node| (node, 1.0))) {
                stiffness[node] += 2.0 * share.abs() * hard;
                damping[node] += 2.0 * share.abs() * hard * self.law.damping_time();
            }
        }
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let mut energy = 0.0;
        self.each(u, |pair, share| energy += share * self.law.energy(pair.distance));
        energy
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Contact
    }

    fn can_be_passed(&self) -> bool {
        true
    }

    fn passage(&self, step: &Step, _tolerance: f64, _clearances: &mut [f64]) -> Option<f64> {
        let ([start, end], acts_from) = (step.times, self.law.distance);
        let (mut near, mut moved) = self.near(step.u[0]);
        let nearer = 2.0 * self.surfaces.reach * step.reach(self.surfaces.dimension);
        if !near.covers(acts_from, moved + nearer) {
            near = Arc::new(Near::new(&self.surfaces, step.u[0], acts_from + nearer));
            moved = 0.0;
        }
        let mut first = None;
        for near in &near.pairs {
            let is_far = near.distance - moved - nearer >= acts_from;
            if is_far || !self.surfaces.is_facet(near.feature) {
                continue;
            }
            let ways = self.ways(near, step);
            let found =
                self.limit(ways.ends()).and_then(|limit| ways.meets(limit, first.unwrap_or(1.0)));
            first = found.or(first);
        }
        first.map(|part| start + part * (end - start))
    }

    fn couplings_near(&self, u: &[f64], pattern: &NodePattern) -> Vec<[usize; 2]> {
        let mut has_room = true;
        self.each(u, |pair, _| {
            let nodes = &pair.nodes[..pair.count];
            let has = |&a: &usize| nodes.iter().all(|&b| pattern.find(a, b).is_some());
            has_room &= nodes.iter().all(has);
        });
        if has_room {
            return Vec::new();
        }
        let mut all = Vec::new();
        for near in &self.near(u).0.pairs {
            for (a, _) in self.surfaces.points[near.point].on.nodes() {
                let feature = self.surfaces.features[near.feature].nodes();
                all.extend(feature.iter().flat_map(|&b| [[a, b], [b, a]]));
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// How damping and friction on the point change as its relative velocity changes by `velocity`, the normal by `normal`,
/// and the elastic force and the damping of a pair by themselves by `of_u`.
fn changed(
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

/// Adds to column `j` of a block.
fn add_column(matrix: &mut BlockMatrix, [row, column]: [usize; 2], j: usize, values: &[f64; 3]) {
    let d = matrix.dimension();
    let Some(block) = matrix.block_mut(row, column) else { return };
    for (i, value) in values.iter().enumerate().take(d) {
        block[i * d + j] += value;
    }
}
