//! The forces between surfaces.

use std::sync::{Arc, Mutex, PoisonError};

use super::action::{Action, changed};
use super::edge_pairs::Edges;
use super::law::{Kind, NormalLaw};
use super::near::{Near, NearPair};
use super::pair::Pair;
use super::surfaces::Surfaces;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::norm;
use crate::elements::force::{
    Capabilities, ContactForce, Force, NodalForces, Reservoir, Step, Tangents,
};
use crate::integrators::ode::Failure;
use crate::scene::forces::friction::Coulomb;

/// The forces between the surfaces of some bodies.
pub(crate) struct TouchForce {
    pub(crate) name: String,
    pub(super) surfaces: Surfaces,
    pub(super) edges: Edges,
    pub(super) law: NormalLaw,
    pub(super) coulomb: Option<Coulomb>,
    /// Search distance for pairs beyond the contact range (m), so that not each evaluation needs a search.
    margin: f64,
    /// The pairs last found: they change the cost of an evaluation, not its result.
    near: Mutex<Arc<Near>>,
}

impl TouchForce {
    pub(super) fn new(
        name: String,
        (surfaces, edges): (Surfaces, Edges),
        law: NormalLaw,
        coulomb: Option<Coulomb>,
        margin: f64,
        u: &[f64],
    ) -> Self {
        let near = Near::new(&surfaces, &edges, u, law.distance + margin);
        Self { name, surfaces, edges, law, coulomb, margin, near: Mutex::new(Arc::new(near)) }
    }

    /// Pairs that include all that act under the displacements `u` (m), and how much nearer (m) they may
    /// have come since they were found.
    pub(super) fn near(&self, u: &[f64]) -> (Arc<Near>, f64) {
        let mut known = self.near.lock().unwrap_or_else(PoisonError::into_inner);
        let moved = known.moved(&self.surfaces, u);
        if known.covers(self.law.distance, moved) {
            return (known.clone(), moved);
        }
        *known = Arc::new(self.search(u, self.law.distance + self.margin));
        (known.clone(), 0.0)
    }

    pub(super) fn search(&self, u: &[f64], within: f64) -> Near {
        Near::new(&self.surfaces, &self.edges, u, within)
    }

    /// Passes to `see` each pair that acts under the displacements `u` (m), and what its share of the energy per area
    /// is (m^2).
    pub(super) fn each(&self, u: &[f64], mut see: impl FnMut(&Pair, f64)) {
        let (near, moved) = self.near(u);
        for near in near.pairs.iter().filter(|near| near.distance - moved < self.law.distance) {
            let x = self.surfaces.point_at(near.point, u);
            let at = self.surfaces.nodes_at(near.feature, u);
            let feature = &self.surfaces.features[near.feature];
            let within = self.law.distance + self.surfaces.radii(near.point, near.feature);
            if self.surfaces.is_beyond(near.feature, &at, &x, within) {
                continue;
            }
            let place = feature.nearest(&at, &x);
            let shape = place.shape();
            let offset = place.offset(&shape, &at, &x);
            let on = &self.surfaces.points[near.point];
            let radii = on.radius + feature.radius;
            if norm(&offset) < self.law.distance + radii {
                let point = (offset, on.on.nodes(), on.on.area * near.weight);
                let mut pair = Pair::new(point, (feature.nodes(), &at), (&place, &shape), radii);
                self.add_levers(&mut pair, [on.radius, feature.radius], u);
                see(&pair, self.share(near));
            }
        }
        let acts_from = self.edges.law.distance;
        for near in near.edges.iter().filter(|near| near.distance - moved < acts_from) {
            let pair = self.edges.pair(&self.surfaces, near, u);
            if let Some(mut pair) = pair.filter(|pair| pair.gap < acts_from) {
                self.add_levers(&mut pair, self.edges.radii(near), u);
                let share = pair.window.as_ref().map_or(0.0, |window| window.value);
                see(&pair, share);
            }
        }
    }

    /// Has what acts between tubes act at their surface, where something acts along it.
    fn add_levers(&self, pair: &mut Pair, radii: [f64; 2], u: &[f64]) {
        if self.coulomb.is_some() && radii != [0.0; 2] {
            self.surfaces.add_levers(pair, radii, u);
        }
    }

    /// The area on which a point bears, times the weight of the feature.
    fn share(&self, near: &NearPair) -> f64 {
        self.surfaces.points[near.point].bears * near.weight
    }

    /// Contact action in a pair at the nodal velocities `v` (m/s).
    pub(super) fn action(&self, pair: &Pair, share: f64, v: &[f64]) -> Action {
        let velocity = pair.velocity(&pair.grips, v, self.surfaces.dimension);
        Action::new(pair, share, velocity, self.law(pair), self.coulomb)
    }

    /// The law of a pair.
    fn law(&self, pair: &Pair) -> &NormalLaw {
        if pair.window.is_some() { &self.edges.law } else { &self.law }
    }

    /// Whether the surfaces of a pair lie on each other; those of tubes know when one is inside the other one.
    pub(super) fn is_passed(&self, pair: &Pair) -> bool {
        pair.gap == 0.0 || self.law.kind == Kind::Barrier && pair.gap < 0.0
    }

    /// Why a state is refused in which surfaces lie on each other.
    pub(super) fn passed(&self) -> Failure {
        let name = &self.name;
        Failure::Recoverable(format!(
            "surfaces of \"{name}\" lie on each other (a stiffer contact keeps them apart)"
        ))
    }

    pub(crate) fn has_friction(&self) -> bool {
        self.coulomb.is_some()
    }

    /// The distance (m) from which on nothing acts.
    pub(crate) fn distance(&self) -> f64 {
        self.law.distance
    }

    /// The least distance (m) of the surfaces, up to that from which on nothing acts.
    pub(crate) fn gap(&self, u: &[f64]) -> f64 {
        self.nearest(u).map_or(self.law.distance, |(gap, _)| gap)
    }

    /// The force (N) on the nodes that `is_read` names together, or on all.
    pub(crate) fn force(&self, u: &[f64], v: &[f64], is_read: Option<&[bool]>) -> [f64; 3] {
        let mut total = [0.0; 3];
        self.each(u, |pair, share| {
            let action = self.action(pair, share, v);
            let braking = action.braking(&pair.normal);
            let drift = pair.drift(self.law(pair).energy(pair.gap));
            for m in (0..pair.count).filter(|&m| is_read.is_none_or(|of| of[pair.nodes[m]])) {
                for (i, total) in total.iter_mut().enumerate() {
                    *total += pair.shares[m] * action.elastic * pair.normal[i];
                    *total += action.braked(pair)[m] * braking[i];
                    *total += drift.map_or(0.0, |drift| drift[m][i]);
                }
            }
        });
        total
    }

    /// The least distance (m) of any point from a feature that it feels, or of two edges, below that from which on nothing
    /// acts, and a node of each.
    pub(crate) fn nearest(&self, u: &[f64]) -> Option<(f64, [usize; 2])> {
        let mut nearest: Option<(f64, [usize; 2])> = None;
        self.each(u, |pair, _| {
            if nearest.is_none_or(|(least, _)| pair.gap < least) {
                nearest = Some((pair.gap, pair.ends()));
            }
        });
        for near in &self.near(u).0.edges {
            let distance = self.edges.apart(&self.surfaces, near, u);
            if distance < nearest.map_or(self.law.distance, |(least, _)| least) {
                nearest = Some((distance, self.edges.nodes(near).map(|[node, _]| node)));
            }
        }
        nearest
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
            is_passed |= self.is_passed(pair);
            let action = self.action(pair, share, v);
            let braking = action.braking(&pair.normal);
            let brakes = braking != [0.0; 3];
            let drift = pair.drift(self.law(pair).energy(pair.gap));
            for m in 0..pair.count {
                let at = pair.nodes[m] * d;
                if let Some(drift) = &drift {
                    (0..d).for_each(|i| forces.conservative[at + i] += drift[m][i]);
                }
                for (i, (normal, braking)) in pair.normal.iter().zip(braking).enumerate().take(d) {
                    forces.conservative[at + i] += pair.shares[m] * action.elastic * normal;
                    if brakes {
                        forces.dissipative[at + i] += action.braked(pair)[m] * braking;
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
        let d = self.surfaces.dimension;
        self.each(u, |pair, share| {
            let (action, law) = (self.action(pair, share, v), self.law(pair));
            if pair.window.is_some() {
                self.add_drift_tangents(pair, &action, stiffness);
            }
            if !action.presses {
                return;
            }
            let curvature = law.curvature(pair.gap);
            let slopes = [-action.elastic, share * curvature];
            let stiffening = share * law.damping_time() * law.third(pair.gap);
            let braking = action.braking(&pair.normal);
            let brakes = action.damping != 0.0 || action.drag.is_some();
            let moving = pair.moving();
            for n in 0..pair.count {
                for j in 0..d {
                    let braked = brakes.then(|| {
                        let change = moving.change([n, j]);
                        let carried = pair.velocity(&change.grips, v, d);
                        let elastic = -action.share * curvature * change.distance;
                        let mut of_u = [elastic, stiffening * change.distance];
                        if pair.window.is_some() {
                            let sharing = moving.sharing([n, j]);
                            of_u[0] += sharing * law.pressure(pair.gap);
                            of_u[1] += sharing * law.damping_time() * curvature;
                        }
                        let by_place = changed(&action, pair, &carried, &change.normal, of_u);
                        let along =
                            std::array::from_fn(|i| if i == j { pair.grips[n] } else { 0.0 });
                        let by_speed = changed(&action, pair, &along, &[0.0; 3], [0.0; 2]);
                        (change.grips, by_place, by_speed)
                    });
                    for m in 0..pair.count {
                        let at = [pair.nodes[m], pair.nodes[n]];
                        let mut by_u = [0.0; 3];
                        for (i, by_u) in by_u.iter_mut().enumerate().take(d) {
                            *by_u = moving.second(slopes, [m, i], [n, j]);
                        }
                        if let Some((grips, by_place, by_speed)) = &braked {
                            for i in 0..d {
                                by_u[i] -= grips[m] * braking[i] + pair.grips[m] * by_place[i];
                            }
                            add_column(damping, at, j, &by_speed.map(|f| -pair.grips[m] * f));
                        }
                        add_column(stiffness, at, j, &by_u);
                    }
                }
            }
        });
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let mut energy = 0.0;
        self.each(u, |pair, share| {
            energy += match self.is_passed(pair) {
                true => f64::INFINITY,
                false => share * self.law(pair).energy(pair.gap),
            };
        });
        energy
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Contact
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { contact: Some(self), ..Capabilities::default() }
    }
}

impl ContactForce for TouchForce {
    fn passage(&self, step: &Step, _tolerance: f64, _clearances: &mut [f64]) -> Option<f64> {
        self.first_passage(step)
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
        let mut add = |node: usize, hard: f64| {
            stiffness[node] += 2.0 * hard;
            damping[node] += 2.0 * hard * self.law.damping_time();
        };
        let may_be_apart = |near: &&NearPair| {
            near.distance + moved >= self.law.distance
                || self.surfaces.apart(near.point, near.feature, u) >= self.law.distance
        };
        for near in near.pairs.iter().filter(may_be_apart) {
            let hard = self.share(near).max(0.0) * self.law.reserve();
            let feature = self.surfaces.features[near.feature].nodes().iter();
            let point = self.surfaces.points[near.point].on.nodes();
            for (node, share) in point.chain(feature.map(|&node| (node, 1.0))) {
                add(node, share.abs() * hard);
            }
        }
        let of_edges = self.edges.law;
        for near in near.edges.iter().filter(|near| near.distance + moved >= of_edges.distance) {
            // what they share is taken as it is now
            let Some(pair) = self.edges.pair(&self.surfaces, near, u) else { continue };
            let Some(window) = &pair.window else { continue };
            for (&node, share) in pair.nodes[..pair.count].iter().zip(&pair.shares) {
                add(node, share.abs() * window.value * of_edges.reserve());
            }
        }
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
        let (near, _) = self.near(u);
        // the hulls of curved features are nearer than these
        let within = self.law.distance + self.margin;
        let is_near = |near: &&NearPair| self.surfaces.apart(near.point, near.feature, u) <= within;
        for near in near.pairs.iter().filter(is_near) {
            let point = self.surfaces.points[near.point].on.nodes().map(|(node, _)| node);
            self.couple(point, self.surfaces.features[near.feature].nodes(), &mut all);
        }
        for near in &near.edges {
            let [first, second] = self.edges.nodes(near);
            self.couple(first.into_iter(), &second, &mut all);
        }
        all.sort_unstable();
        all.dedup();
        all
    }
}

impl TouchForce {
    /// Adds the couplings of some nodes with others, and with friction those of the directors of tubes.
    fn couple(
        &self,
        first: impl Iterator<Item = usize>,
        second: &[usize],
        all: &mut Vec<[usize; 2]>,
    ) {
        let with_directors = |node: usize| {
            let directors = self.surfaces.directors(node).iter().copied();
            std::iter::once(node).chain(directors.filter(|_| self.coulomb.is_some()))
        };
        for a in first.flat_map(with_directors) {
            let second = second.iter().copied().flat_map(with_directors);
            all.extend(second.flat_map(|b| [[a, b], [b, a]]));
        }
    }

    /// The derivatives of what two edges do because they share less of the energy elsewhere, -d(-phi dF/dz_m)/dz_n, and
    /// of their elastic force as they share more, where they press.
    fn add_drift_tangents(&self, pair: &Pair, action: &Action, stiffness: &mut BlockMatrix) {
        let law = self.law(pair);
        let [energy, slope] = [law.energy(pair.gap), -law.pressure(pair.gap)];
        let moving = pair.moving();
        let of_distance = |[m, i]: [usize; 2]| slope * pair.shares[m] * pair.normal[i];
        for n in 0..pair.count {
            for j in 0..3 {
                for m in 0..pair.count {
                    let values = [0, 1, 2].map(|i| {
                        let drifts = energy * moving.sharing_bends([m, i], [n, j])
                            + of_distance([n, j]) * moving.sharing([m, i]);
                        let pressed = of_distance([m, i]) * moving.sharing([n, j]);
                        if action.presses { drifts + pressed } else { drifts }
                    });
                    add_column(stiffness, [pair.nodes[m], pair.nodes[n]], j, &values);
                }
            }
        }
    }
}

/// Adds to column `j` of a block.
fn add_column(matrix: &mut BlockMatrix, [row, column]: [usize; 2], j: usize, values: &[f64; 3]) {
    let d = matrix.dimension();
    let Some(block) = matrix.block_mut(row, column) else { return };
    for (i, value) in values.iter().enumerate().take(d) {
        block[i * d + j] += value;
    }
}
