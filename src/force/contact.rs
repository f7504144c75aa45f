//! Penalty contact (Hirai (4.3.5), (4.4.2)): obstacles push boundary nodes out of themselves.

use super::{Force, NodalForces, Reservoir};
use crate::error::{Error, finite, not_negative, positive};
use crate::mesh::Mesh;
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
    fn add_forces(&self, _t: f64, u: &[f64], v: &[f64], forces: &mut NodalForces) {
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
