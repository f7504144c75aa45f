//! Penalty contact (Hirai (4.3.5), (4.4.2)): obstacles push boundary nodes out of themselves.

use super::{Force, NodalForces, Reservoir};
use crate::error::{Error, finite, not_negative, positive};
use crate::mesh::Mesh;
use crate::ode::Failure;
use crate::sparse::BlockMatrix;

/// An obstacle: a signed distance d(x), negative inside, and the law of its penalty force on each
/// boundary node with d <= 0:
///
/// f = (-K_p d - B_p d') n - B_t (I - n n^T) x'
#[derive(Debug, Clone)]
pub struct Obstacle {
    name: String,
    shape: HalfPlane,
    stiffness: f64,
    damping: f64,
    friction: f64,
    adhesion: bool,
}

/// d(x) = n . (x - point)
#[derive(Debug, Clone)]
struct HalfPlane {
    point: Vec<f64>,
    normal: Vec<f64>,
}

impl HalfPlane {
    /// d at the natural position `x` displaced by `u`.
    fn distance(&self, x: &[f64], u: &[f64]) -> f64 {
        (0..x.len()).map(|i| self.normal[i] * (x[i] + u[i] - self.point[i])).sum()
    }
}

impl Obstacle {
    /// The half-plane (half-line, half-space) below the plane through `point` (m), whose `normal`
    /// points outward, to where bodies may be. Its length does not matter.
    pub fn half_plane(point: impl Into<Vec<f64>>, normal: impl Into<Vec<f64>>) -> Self {
        Self {
            name: "floor".into(),
            shape: HalfPlane { point: point.into(), normal: normal.into() },
            stiffness: 0.0,
            damping: 0.0,
            friction: 0.0,
            adhesion: true,
        }
    }

    /// Name of the obstacle (default: "floor").
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Contact stiffness K_p (N/m per node), above 0. A finer mesh has more nodes in contact:
    /// scale it by the node count to keep the floor alike.
    pub fn stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = stiffness;
        self
    }

    /// Contact damping B_p (N s/m per node; default 0).
    pub fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Tangential damping B_t (N s/m per node; default 0).
    pub fn friction(mut self, friction: f64) -> Self {
        self.friction = friction;
        self
    }

    /// Whether damping may pull a node back while it separates (default: true, the sources' law).
    /// With `false` the normal force is never negative.
    pub fn adhesion(mut self, adhesion: bool) -> Self {
        self.adhesion = adhesion;
        self
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The obstacle with a normal of length 1, if all its numbers make sense.
    pub(crate) fn validated(&self, dimension: usize) -> Result<Self, Error> {
        let input = |key: &str| format!("obstacle \"{}\" {key}", self.name);
        for (key, vector) in [("point", &self.shape.point), ("normal", &self.shape.normal)] {
            if vector.len() != dimension {
                let mend = format!("it needs {dimension} component(s)");
                return Err(Error::input(input(key), format!("{vector:?}"), mend));
            }
            finite(&input(key), vector)?;
        }
        let length = self.shape.normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length == 0.0 {
            let value = format!("{:?}", self.shape.normal);
            return Err(Error::input(input("normal"), value, "it must not be zero"));
        }
        positive(&input("stiffness"), self.stiffness, "N/m per node")?;
        not_negative(&input("damping"), self.damping, "N s/m per node")?;
        not_negative(&input("friction"), self.friction, "N s/m per node")?;
        let mut obstacle = self.clone();
        obstacle.shape.normal.iter_mut().for_each(|x| *x /= length);
        Ok(obstacle)
    }

    /// The plane as (point, outward normal), for drawing.
    pub(crate) fn plane(&self) -> (&[f64], &[f64]) {
        (&self.shape.point, &self.shape.normal)
    }
}

/// The forces of one obstacle on the boundary nodes of a body.
pub(crate) struct Contact {
    obstacle: Obstacle,
    dimension: usize,
    /// First degree of freedom and natural position of each boundary node.
    nodes: Vec<(usize, Vec<f64>)>,
}

/// One node inside an obstacle.
struct Touch {
    /// First degree of freedom of the node.
    first: usize,
    distance: f64,
    /// d' = n . x'
    rate: f64,
}

impl Contact {
    /// `obstacle` must be validated.
    pub(crate) fn new(mesh: &Mesh, obstacle: Obstacle) -> Self {
        let dimension = mesh.dimension();
        let nodes = mesh.boundary_nodes().iter();
        let nodes = nodes.map(|&node| (node * dimension, mesh.position(node).to_vec())).collect();
        Self { obstacle, dimension, nodes }
    }

    fn touches<'a>(&'a self, u: &'a [f64], v: &'a [f64]) -> impl Iterator<Item = Touch> + 'a {
        let Obstacle { shape, .. } = &self.obstacle;
        self.nodes.iter().filter_map(move |(first, x)| {
            let range = *first..first + self.dimension;
            let distance = shape.distance(x, &u[range.clone()]);
            let rate = shape.normal.iter().zip(&v[range]).map(|(n, v)| n * v).sum();
            (distance <= 0.0).then_some(Touch { first: *first, distance, rate })
        })
    }

    /// Whether the normal force is cut off at 0 because it would pull.
    fn is_cut_off(&self, touch: &Touch) -> bool {
        let Obstacle { stiffness, damping, adhesion, .. } = self.obstacle;
        !adhesion && stiffness * touch.distance + damping * touch.rate > 0.0
    }
}

impl Force for Contact {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let normal = &self.obstacle.shape.normal;
        for touch in self.touches(u, v) {
            let spring = -self.obstacle.stiffness * touch.distance;
            let cut_off = self.is_cut_off(&touch);
            let damper = if cut_off { -spring } else { -self.obstacle.damping * touch.rate };
            for (i, n) in normal.iter().enumerate() {
                let dof = touch.first + i;
                let sliding = v[dof] - touch.rate * n;
                forces.conservative[dof] += spring * n;
                forces.dissipative[dof] += damper * n - self.obstacle.friction * sliding;
            }
        }
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (d, normal) = (self.dimension, &self.obstacle.shape.normal);
        let friction = self.obstacle.friction;
        for touch in self.touches(u, v) {
            let (spring, damper) = match self.is_cut_off(&touch) {
                true => (0.0, 0.0),
                false => (self.obstacle.stiffness, self.obstacle.damping),
            };
            let node = touch.first / d;
            for (matrix, along, across) in
                [(&mut *stiffness, spring, 0.0), (&mut *damping, damper, friction)]
            {
                let Some(block) = matrix.block_mut(node, node) else { continue };
                for i in 0..d {
                    block[i * d + i] += across;
                    for j in 0..d {
                        block[i * d + j] += (along - across) * normal[i] * normal[j];
                    }
                }
            }
        }
    }

    fn is_nonlinear(&self) -> bool {
        true
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        let shape = &self.obstacle.shape;
        let energy = |(first, x): &(usize, Vec<f64>)| {
            let distance = shape.distance(x, &u[*first..first + self.dimension]).min(0.0);
            0.5 * self.obstacle.stiffness * distance * distance
        };
        self.nodes.iter().map(energy).sum()
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Contact
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::Cells;
    use crate::sparse::NodePattern;

    /// Slope 3:4 through (0, 0.1): half of a 2 x 2 grid of nodes lies inside.
    fn contact(adhesion: bool) -> Contact {
        let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
        let slope = Obstacle::half_plane([0.0, 0.1], [-3.0, 4.0]);
        let slope = slope.stiffness(50.0).damping(7.0).friction(3.0).adhesion(adhesion);
        Contact::new(&mesh, slope.validated(2).unwrap())
    }

    const U: [f64; 8] = [0.02, -0.05, -0.03, 0.04, 0.01, 0.02, 0.03, -0.01];
    const V: [f64; 8] = [0.3, -0.4, 0.7, 0.9, -0.5, 0.2, -0.1, 0.8];

    fn forces(contact: &Contact, u: &[f64], v: &[f64]) -> NodalForces {
        let mut forces = NodalForces::zeros(8);
        contact.add_forces(0.0, u, v, &mut forces).unwrap();
        forces
    }

    /// Hirai (4.4.2), written out for node 2, the one at (1, 0).
    #[test]
    fn the_law_of_the_documents() {
        let forces = forces(&contact(true), &U, &V);
        let (n, x) = ([-0.6, 0.8], [1.0 + U[2], 0.0 + U[3] - 0.1]);
        let distance = n[0] * x[0] + n[1] * x[1];
        let rate = n[0] * V[2] + n[1] * V[3];
        assert!(distance < 0.0);
        for i in 0..2 {
            let sliding = V[2 + i] - rate * n[i];
            assert!((forces.conservative[2 + i] - -50.0 * distance * n[i]).abs() < 1e-13);
            let expected = -7.0 * rate * n[i] - 3.0 * sliding;
            assert!((forces.dissipative[2 + i] - expected).abs() < 1e-13);
        }
        // node 3 at (0, 1) is outside
        assert_eq!(forces.conservative[4..6], [0.0; 2]);
        assert_eq!(forces.dissipative[4..6], [0.0; 2]);
    }

    #[test]
    fn tangents_are_derivatives_and_the_potential_has_the_force() {
        for (adhesion, speed) in [(true, 1.0), (false, 1.0), (false, 100.0)] {
            let contact = contact(adhesion);
            let v = V.map(|v| speed * v);
            let pattern = Arc::new(NodePattern::new(4, [[0, 1, 2, 3].as_slice()].into_iter()));
            let mut stiffness = BlockMatrix::zeros(&pattern, 2);
            let mut damping = BlockMatrix::zeros(&pattern, 2);
            contact.add_tangents(0.0, &U, &v, &mut stiffness, &mut damping);
            let h = 1e-6;
            for j in 0..8 {
                let moved = |x: &[f64; 8], by: f64| {
                    let mut x = *x;
                    x[j] += by;
                    x
                };
                let total =
                    |forces: NodalForces, i: usize| forces.conservative[i] + forces.dissipative[i];
                for i in 0..8 {
                    let by_u = total(forces(&contact, &moved(&U, h), &v), i)
                        - total(forces(&contact, &moved(&U, -h), &v), i);
                    let by_v = total(forces(&contact, &U, &moved(&v, h)), i)
                        - total(forces(&contact, &U, &moved(&v, -h)), i);
                    // piecewise linear: central differences are exact up to round-off
                    assert!((stiffness.get(i, j) + by_u / (2.0 * h)).abs() < 1e-7, "({i}, {j})");
                    assert!((damping.get(i, j) + by_v / (2.0 * h)).abs() < 1e-7, "({i}, {j})");
                }
                let slope =
                    contact.potential(0.0, &moved(&U, h)) - contact.potential(0.0, &moved(&U, -h));
                let force = forces(&contact, &U, &v).conservative[j];
                assert!((force + slope / (2.0 * h)).abs() < 1e-8);
            }
        }
    }

    /// A node that separates faster than the spring can push is pulled back by the damper, but
    /// not without adhesion.
    #[test]
    fn without_adhesion_the_normal_force_never_pulls() {
        let away = [0.0, 0.0, -60.0, 80.0, 0.0, 0.0, 0.0, 0.0];
        let normal_force = |adhesion| {
            let forces = forces(&contact(adhesion), &U, &away);
            let along = |f: &[f64]| -0.6 * f[2] + 0.8 * f[3];
            along(&forces.conservative) + along(&forces.dissipative)
        };
        assert!(normal_force(true) < -600.0);
        assert!(normal_force(false).abs() < 1e-12);
    }
}
