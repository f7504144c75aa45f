//! Penalty contact (Hirai (4.3.5), (4.4.2)): obstacles push boundary nodes out of themselves.
//!
//! Contact is at boundary nodes, or with a stiffness per area at Gauss points of boundary faces. It couples
//! nodes that share a cell, so that the pattern never changes. An obstacle is a signed distance with gradient
//! and Hessian, exact but at the ridges of boxes and unions, where it jumps, and left out for functions of
//! users. Moving obstacles add their power f . w as two numbers beside the nodal forces, so that heat counts
//! relative velocities only. The force has a kink at d = 0 (a jump, with damping), over which methods step
//! with a loss of order that step size control mostly repairs.

mod nodal;
mod switches;
#[cfg(test)]
mod tests;

use switches::SwitchStates;

use super::friction::{Backward, Coulomb, Drag};
use super::obstacle::{Obstacle, PenaltyLaw};
use super::passage::{Path, deepest, is_passed};
use super::shape::Nearest;
use super::signal::finite_at;
use super::surface::{SurfacePoint, boundary_nodes, gauss_points};
use super::travel::Cubics;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{difference, distinct, dot, norm};
use crate::elements::body::Body;
use crate::elements::force::{
    Capabilities, ContactForce, Force, NodalForces, Reservoir, Step, Switches, Tangents,
};
use crate::integrators::ode::Failure;

/// The forces of one obstacle on the boundary of a body.
pub(crate) struct Contact {
    obstacle: Obstacle,
    dimension: usize,
    /// A bound on |w| (m/s), if there is one for all times.
    fastest: Option<f64>,
    is_custom: bool,
    coulomb: Option<Coulomb>,
    backward: Option<Backward>,
    points: Vec<ContactPoint>,
    switches: SwitchStates,
}

struct ContactPoint {
    on: SurfacePoint,
    /// Natural position; components beyond the dimension are 0.
    natural: [f64; 3],
    law: PenaltyLaw,
}

/// One point inside an obstacle.
struct Touch<'a> {
    /// Its number.
    k: usize,
    point: &'a ContactPoint,
    nearest: Nearest,
    /// x' - w
    velocity: [f64; 3],
    /// d' = n . (x' - w)
    rate: f64,
    /// Whether the normal force is cut off at 0 because it would pull.
    is_cut_off: bool,
    /// Coulomb's friction, where the normal force presses.
    slip: Option<Slip>,
}

/// Coulomb's friction of one point: -N `drag.per_speed` s.
struct Slip {
    /// s = r - (n . r) n with r = x' - w
    sliding: [f64; 3],
    /// N (N)
    pressing: f64,
    drag: Drag,
    /// mu(w)/w times the gradient of the [factor](Backward::factor) by which friction is larger backward
    /// (s^2/m^2).
    turning: Option<[f64; 3]>,
}

impl Slip {
    fn new(
        coulomb: Coulomb,
        backward: Option<&Backward>,
        sliding: [f64; 3],
        pressing: f64,
    ) -> Self {
        let w = norm(&sliding);
        let mut drag = coulomb.drag(w);
        let turning = backward.map(|backward| {
            let (factor, gradient) = backward.factor(coulomb, &sliding, w);
            let turning = gradient.map(|x| drag.per_speed * x);
            let Drag { per_speed, slope, along } = &mut drag;
            [per_speed, slope, along].into_iter().for_each(|x| *x *= factor);
            turning
        });
        Self { sliding, pressing, drag, turning }
    }
}

impl Touch<'_> {
    /// Tangential force per sliding velocity (N s/m): tangential damping plus friction over the sliding speed.
    fn drag(&self) -> f64 {
        let friction = |slip: &Slip| slip.pressing * slip.drag.per_speed;
        self.point.law.tangential_damping + self.slip.as_ref().map_or(0.0, friction)
    }

    /// The force along an axis (N), with the `drag` of sliding: the part of the spring, and that of dampers
    /// and friction.
    #[inline]
    fn force(&self, drag: f64, axis: usize) -> [f64; 2] {
        let Self { point, ref nearest, velocity, rate, is_cut_off, .. } = *self;
        let spring = -point.law.stiffness * nearest.distance;
        let damper = if is_cut_off { -spring } else { -point.law.damping * rate };
        let n = nearest.normal[axis];
        let sliding = velocity[axis] - rate * n;
        [spring * n, damper * n - drag * sliding]
    }
}

impl Contact {
    /// # Errors
    /// Numbers out of range; a stiffness per area for a body whose boundary has no area.
    pub(crate) fn new(body: &Body, obstacle: &Obstacle) -> Result<Self, InputError> {
        let dimension = body.dimension();
        let obstacle = obstacle.validated(dimension)?;
        let points = match obstacle.is_per_area() {
            false => boundary_nodes(body),
            true => gauss_points(body).ok_or_else(|| {
                let input = format!("obstacle \"{}\" stiffness_density", obstacle.name());
                let help = "a string has no surface: give a stiffness per node";
                InputError::new(input, "given", help)
            })?,
        };
        let positions = body.mesh().positions();
        let points = points.into_iter().map(|on| ContactPoint {
            natural: on.at(positions, dimension),
            law: obstacle.law(on.area),
            on,
        });
        let (points, fastest): (Vec<_>, _) = (points.collect(), obstacle.fastest());
        let is_custom = obstacle.shape().is_custom();
        let coulomb = obstacle.coulomb(body.size());
        let backward = obstacle.backward();
        let pressing = coulomb.is_some() || !obstacle.has_adhesion();
        let switches = SwitchStates::new(points.len(), pressing, obstacle.has_friction());
        Ok(Self { obstacle, dimension, fastest, is_custom, coulomb, backward, points, switches })
    }

    pub(crate) fn obstacle(&self) -> &Obstacle {
        &self.obstacle
    }

    pub(crate) fn dimension(&self) -> usize {
        self.dimension
    }

    /// The distance (m) of a position (m) at time `t` (s).
    pub(crate) fn distance_of(&self, t: f64, x: [f64; 3]) -> f64 {
        self.obstacle.nearest(&self.obstacle.displacement(t), x, self.dimension).distance
    }

    /// Half of the least thickness (m) of the obstacle at a position (m); infinite if that is not bounded or not known.
    pub(crate) fn half_thickness(&self, t: f64, x: [f64; 3]) -> f64 {
        let x = difference(&x, &self.obstacle.displacement(t));
        self.obstacle.shape().half_thickness(&x[..self.dimension])
    }

    /// Whether a point that moves between two positions (m) passes the middle of the obstacle; of one of unknown thickness,
    /// deeper than `depth` (m).
    pub(crate) fn is_passed(&self, times: [f64; 2], x: [[f64; 3]; 2], depth: f64) -> bool {
        let x = [0, 1].map(|k| difference(&x[k], &self.obstacle.displacement(times[k])));
        is_passed(self.obstacle.shape(), [&x[0][..self.dimension], &x[1][..self.dimension]], depth)
    }

    /// Passes to `see` the distance (m) of each point and the first of its nodes (counted from 0).
    pub(crate) fn each_distance(&self, t: f64, u: &[f64], mut see: impl FnMut(f64, usize)) {
        let moved = self.obstacle.displacement(t);
        for point in &self.points {
            let distance = self.nearest(&moved, point, u).distance;
            point.on.nodes().take(1).for_each(|(node, _)| see(distance, node));
        }
    }

    #[inline]
    fn nearest(&self, moved: &[f64; 3], point: &ContactPoint, u: &[f64]) -> Nearest {
        let mut x = point.on.at(u, self.dimension);
        x.iter_mut().zip(&point.natural).for_each(|(x, natural)| *x += natural);
        self.obstacle.nearest(moved, x, self.dimension)
    }

    /// The path of a point relative to the obstacle, within part `number` of a step that is divided into
    /// equal `parts`, and the times (s) of its ends.
    fn path(
        &self,
        point: &ContactPoint,
        step: &Step,
        number: usize,
        parts: usize,
    ) -> ([f64; 2], Path) {
        let ([start, end], d) = (step.times, self.dimension);
        let x = step.u.map(|u| {
            let u = point.on.at(u, d);
            std::array::from_fn(|i| point.natural[i] + u[i])
        });
        let v = step.v.map(|v| point.on.at(v, d));
        let ends = [number, number + 1].map(|k| {
            let (t, [x, v]) = match k {
                0 => (start, [x[0], v[0]]),
                k if k == parts => (end, [x[1], v[1]]),
                k => {
                    let part = k as f64 / parts as f64;
                    let [x, slope] = Path::new(x, v, end - start).at(part);
                    (start + part * (end - start), [x, slope.map(|x| x / (end - start))])
                }
            };
            let (moved, w) = (self.obstacle.displacement(t), self.obstacle.velocity_at(t));
            (t, difference(&x, &moved), difference(&v, &w))
        });
        let times = ends.map(|(t, ..)| t);
        (times, Path::new(ends.map(|(_, x, _)| x), ends.map(|(.., v)| v), times[1] - times[0]))
    }

    fn touches<'a>(
        &'a self,
        t: f64,
        u: &'a [f64],
        v: &'a [f64],
    ) -> impl Iterator<Item = Touch<'a>> + 'a {
        let (moved, w) = (self.obstacle.displacement(t), self.obstacle.velocity_at(t));
        self.points.iter().enumerate().filter_map(move |(k, point)| {
            let nearest = self.nearest(&moved, point, u);
            if !self.switches.touches(k, nearest.distance) {
                return None;
            }
            let mut velocity = point.on.at(v, self.dimension);
            velocity.iter_mut().zip(&w).for_each(|(x, w)| *x -= w);
            let rate = dot(&nearest.normal, &velocity);
            let pull = point.law.pull(nearest.distance, rate);
            let presses = self.switches.presses(k, pull);
            let is_cut_off = !presses && !self.obstacle.has_adhesion();
            let slip = self.coulomb.filter(|_| presses).map(|coulomb| {
                let sliding = std::array::from_fn(|i| velocity[i] - rate * nearest.normal[i]);
                Slip::new(coulomb, self.backward.as_ref(), sliding, -pull)
            });
            Some(Touch { k, point, nearest, velocity, rate, is_cut_off, slip })
        })
    }

    /// Force on the body as a whole (N), or its part on the nodes that `is_read` names; 0 beyond the
    /// dimension.
    ///
    /// # Errors
    /// A user's distance function that returns an invalid distance or gradient.
    pub(crate) fn force(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        is_read: Option<&[bool]>,
    ) -> Result<[f64; 3], Failure> {
        let mut total = [0.0; 3];
        for touch in self.touches(t, u, v) {
            self.check(t, &touch)?;
            let part = is_read.map_or(1.0, |is_read| {
                let read = touch.point.on.nodes().filter(|(node, _)| is_read[*node]);
                read.map(|(_, share)| share).sum()
            });
            let drag = touch.drag();
            for (i, total) in total.iter_mut().enumerate().take(self.dimension) {
                let [elastic, braking] = touch.force(drag, i);
                *total += part * (elastic + braking);
            }
        }
        Ok(total)
    }

    /// Checks what a user's function has returned.
    fn check(&self, t: f64, touch: &Touch) -> Result<(), Failure> {
        let Nearest { distance, normal, .. } = &touch.nearest;
        let length = norm(normal);
        if !self.is_custom || distance.is_finite() && (length - 1.0).abs() < 1e-3 {
            return Ok(());
        }
        let nodes: Vec<usize> = touch.point.on.nodes().map(|(node, _)| node + 1).collect();
        Err(Failure::Fatal(
            format!(
                "obstacle \"{}\" gives the distance {distance} m with a gradient of length {length} \
                 at node {nodes:?} at t = {t} s: it must be a finite number with a gradient of length 1",
                self.obstacle.name()
            )
            .into(),
        ))
    }
}

impl Force for Contact {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let w = self.obstacle.velocity_at(t);
        if self.fastest.is_none() {
            for x in self.obstacle.displacement(t).into_iter().chain(w) {
                finite_at(t, format_args!("path of obstacle \"{}\"", self.obstacle.name()), x)?;
            }
        }
        for touch in self.touches(t, u, v) {
            self.check(t, &touch)?;
            let drag = touch.drag();
            for (i, w) in w.into_iter().take(self.dimension).enumerate() {
                let [elastic, braking] = touch.force(drag, i);
                for (node, share) in touch.point.on.nodes() {
                    forces.conservative[node * self.dimension + i] += share * elastic;
                    forces.dissipative[node * self.dimension + i] += share * braking;
                }
                // heat is counted by the velocity relative to the obstacle; the rest is work of its drive
                forces.carried_heat += braking * w;
                forces.carried_power += (elastic + braking) * w;
            }
        }
        Ok(())
    }

    /// With N the normal force, H the Hessian of d, r = x' - w and B the drag that multiplies the sliding
    /// velocity s, B_t + N c with c = mu(w)/w: -df/du is K_p n n^T + (B_p - B) n (H r)^T - (N + B d') H,
    /// and -df/dv is B_p n n^T + B (I - n n^T), at a fixed B. As B changes, further terms are, with
    /// g = c'/w, -c s (K_p n + B_p H r)^T - N g d' s (H s)^T and -c B_p s n^T + N g s s^T. Where friction is larger
    /// backward, by a factor with the gradient a, there are -N c s (d' H a + (a . n) H r)^T and
    /// N c s (a - (a . n) n)^T besides.
    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        for touch in self.touches(t, u, v) {
            let drag = touch.drag();
            let Touch { point, ref nearest, velocity, rate, is_cut_off, .. } = touch;
            let (spring, damper) = match is_cut_off {
                true => (0.0, 0.0),
                false => (point.law.stiffness, point.law.damping),
            };
            let n = &nearest.normal;
            let normal_force = -spring * nearest.distance - damper * rate;
            let turning = nearest.bend(&velocity);
            let unit = |j: usize| std::array::from_fn(|i| f64::from(i == j));
            let bent: [[f64; 3]; 3] = std::array::from_fn(|j| nearest.bend(&unit(j)));
            let by_u = |i: usize, j: usize| {
                spring * n[i] * n[j] + (damper - drag) * n[i] * turning[j]
                    - (normal_force + drag * rate) * bent[i][j]
            };
            let by_v =
                |i: usize, j: usize| drag * f64::from(i == j) + (damper - drag) * n[i] * n[j];
            spread(&point.on, by_u, stiffness);
            spread(&point.on, by_v, damping);
            if let Some(Slip {
                sliding: s,
                pressing,
                drag: Drag { per_speed, slope, .. },
                turning: turns,
            }) = touch.slip
            {
                let (bent, change) = (nearest.bend(&s), pressing * slope);
                let by_u = |i: usize, j: usize| {
                    let normal = per_speed * (spring * n[j] + damper * turning[j]);
                    -s[i] * (normal + change * rate * bent[j])
                };
                let by_v = |i: usize, j: usize| s[i] * (change * s[j] - per_speed * damper * n[j]);
                spread(&point.on, by_u, stiffness);
                spread(&point.on, by_v, damping);
                let Some(turns) = turns else { continue };
                let (bent, on_normal) = (nearest.bend(&turns), dot(&turns, n));
                let by_u = |i: usize, j: usize| {
                    -pressing * s[i] * (rate * bent[j] + on_normal * turning[j])
                };
                let by_v = |i: usize, j: usize| pressing * s[i] * (turns[j] - on_normal * n[j]);
                spread(&point.on, by_u, stiffness);
                spread(&point.on, by_v, damping);
            }
        }
        Tangents::Added
    }

    fn potential(&self, t: f64, u: &[f64]) -> f64 {
        let moved = self.obstacle.displacement(t);
        let energy = |(k, point): (usize, &ContactPoint)| {
            let distance = self.nearest(&moved, point, u).distance;
            let is_on = self.switches.touches(k, distance);
            if is_on { 0.5 * point.law.stiffness * distance * distance } else { 0.0 }
        };
        self.points.iter().enumerate().map(energy).sum()
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(distinct(self.points.iter().flat_map(|point| point.on.nodes().map(|(node, _)| node))))
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Contact
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { switches: Some(self), contact: Some(self), ..Capabilities::default() }
    }
}

impl Switches for Contact {
    /// The distances of all points, then the pulls of all normal forces (if their sign matters), then how
    /// much faster than v0 all points under friction slide. Pulls of points that do not touch, and excess
    /// speeds of points that do not press, stay off.
    fn switches(&self) -> usize {
        self.switches.count()
    }

    fn switch_values(&self, t: f64, u: &[f64], v: &[f64], values: &mut [f64]) {
        let [distances, pulls, excesses] = self.switches.parts(values);
        let moved = self.obstacle.displacement(t);
        for (distance, point) in distances.iter_mut().zip(&self.points) {
            *distance = self.nearest(&moved, point, u).distance;
        }
        pulls.fill(f64::INFINITY);
        excesses.fill(f64::INFINITY);
        if pulls.is_empty() {
            return;
        }
        for Touch { k, point, nearest, rate, slip, .. } in self.touches(t, u, v) {
            pulls[k] = point.law.pull(nearest.distance, rate);
            if let (Some(excess), Some(slip), Some(coulomb)) =
                (excesses.get_mut(k), slip, self.coulomb)
            {
                *excess = norm(&slip.sliding) - coulomb.sticking_speed;
            }
        }
    }

    fn hold_switches(&self, on: Option<&[bool]>) {
        self.switches.hold(on);
    }

    fn slides(&self) -> Option<(&str, Option<bool>)> {
        self.switches.all_slide().map(|slides| (self.obstacle.name(), slides))
    }
}

impl ContactForce for Contact {
    fn passage(&self, step: &Step, tolerance: f64, clearances: &mut [f64]) -> Option<f64> {
        let (d, [start, end]) = (self.dimension, step.times);
        let Cubics { parts, fastest } = match self.fastest {
            Some(fastest) => Cubics { parts: 1, fastest },
            None => self.obstacle.cubics(step.times, 0.5 * tolerance),
        };
        let reach = step.reach(d) + (end - start) * fastest;
        let mut first: Option<f64> = None;
        for (point, clearance) in self.points.iter().zip(clearances) {
            *clearance -= reach;
            if *clearance > 0.0 {
                continue;
            }
            let shape = self.obstacle.shape();
            let path = |number: usize| self.path(point, step, number, parts);
            let distance = |x: &[f64; 3]| shape.nearest(&x[..d]).distance;
            let [before, after] = [distance(path(0).1.start()), distance(path(parts - 1).1.end())];
            *clearance = after.abs();
            // the force at an end of the step that is half as deep is enough
            let depth = 2.0 * f64::max(0.0, -before.min(after)) + tolerance;
            let found = (0..parts).map(path).find_map(|([from, to], path)| {
                let part = deepest(shape, &path, d, depth)?;
                Some(from + part * (to - from))
            });
            if let Some(t) = found {
                first = Some(first.map_or(t, |first| first.min(t)));
            }
        }
        first
    }

    /// A point distributes K_p n n^T among its nodes by shares that add up to 1, so that no row sum is larger
    /// than its node's share.
    fn add_reserves(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) {
        let moved = self.obstacle.displacement(t);
        let apart = |point: &&ContactPoint| self.nearest(&moved, point, u).distance > 0.0;
        for point in self.points.iter().filter(apart) {
            for (node, share) in point.on.nodes() {
                stiffness[node] += share * point.law.stiffness;
                damping[node] += share * f64::max(point.law.damping, point.law.tangential_damping);
            }
        }
        let Some(coulomb) = &self.coulomb else { return };
        for touch in self.touches(t, u, v) {
            let Some(Slip { pressing, drag, .. }) = touch.slip else { continue };
            let steepest = coulomb.steepest() * self.backward.map_or(1.0, |b| b.steepest());
            let lacking = pressing.max(0.0) * (steepest - drag.along.max(0.0));
            for (node, share) in touch.point.on.nodes() {
                damping[node] += share * lacking;
            }
        }
    }

    fn velocity(&self, t: f64) -> Option<[f64; 3]> {
        (self.fastest != Some(0.0)).then(|| self.obstacle.velocity_at(t))
    }
}

/// Adds the tangent `entry` at a point to the blocks of its nodes, which share a cell.
fn spread(point: &SurfacePoint, entry: impl Fn(usize, usize) -> f64, matrix: &mut BlockMatrix) {
    let d = matrix.dimension();
    for (row, row_share) in point.nodes() {
        for (column, column_share) in point.nodes() {
            let Some(block) = matrix.block_mut(row, column) else { continue };
            for (k, x) in block.iter_mut().enumerate() {
                *x += row_share * column_share * entry(k / d, k % d);
            }
        }
    }
}
