//! Obstacles: a shape, how it moves, and the law of its force.

use super::shape::{Nearest, Shape};
use crate::input::{InputError, finite, not_negative, positive};

/// An obstacle: a signed distance d(x), negative inside, and the law of its penalty force on each
/// boundary node of a body with d <= 0 (or point of a face, see
/// [`stiffness_density`](Self::stiffness_density)):
///
/// f = (-K_p d - B_p d') n - B_t (I - n n^T) (x' - w)
///
/// with the gradient n of d, the velocity w of the obstacle, and d' = n . (x' - w). Point masses
/// belong to no boundary and pass through obstacles.
#[derive(Debug, Clone)]
pub struct Obstacle {
    name: String,
    shape: Shape,
    stiffness: Stiffness,
    damping: f64,
    friction: f64,
    adhesion: bool,
    velocity: Option<Vec<f64>>,
    /// How far from where it was said to be it would have been at t = 0 (m).
    offset: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
enum Stiffness {
    PerNode(f64),
    Density(f64),
}

/// The numbers of the law, for one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    /// K_p (N/m)
    pub(super) stiffness: f64,
    /// B_p (N s/m)
    pub(super) damping: f64,
    /// B_t (N s/m)
    pub(super) friction: f64,
}

impl Law {
    /// K_p d + B_p d': the normal force (N), above 0 where it pulls.
    pub(super) fn pull(&self, distance: f64, rate: f64) -> f64 {
        self.stiffness * distance + self.damping * rate
    }
}

impl Obstacle {
    /// An obstacle of any shape.
    pub fn new(shape: Shape) -> Self {
        Self {
            name: "floor".into(),
            shape,
            stiffness: Stiffness::PerNode(0.0),
            damping: 0.0,
            friction: 0.0,
            adhesion: true,
            velocity: None,
            offset: [0.0; 3],
        }
    }

    /// As [`Shape::half_plane`].
    pub fn half_plane(point: impl Into<Vec<f64>>, normal: impl Into<Vec<f64>>) -> Self {
        Self::new(Shape::half_plane(point, normal))
    }

    /// As [`Shape::disc`].
    pub fn disc(centre: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self::new(Shape::disc(centre, radius))
    }

    /// As [`Shape::cavity`].
    pub fn cavity(centre: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self::new(Shape::cavity(centre, radius))
    }

    /// As [`Shape::box_between`].
    pub fn box_between(min: impl Into<Vec<f64>>, max: impl Into<Vec<f64>>) -> Self {
        Self::new(Shape::box_between(min, max))
    }

    /// As [`Shape::capsule`].
    pub fn capsule(from: impl Into<Vec<f64>>, to: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self::new(Shape::capsule(from, to, radius))
    }

    /// As [`Shape::union`].
    pub fn union(parts: impl IntoIterator<Item = Shape>) -> Self {
        Self::new(Shape::union(parts))
    }

    /// As [`Shape::custom`].
    pub fn custom(distance: impl Fn(&[f64], &mut [f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self::new(Shape::custom(distance))
    }

    /// Name of the obstacle (default: "floor").
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Contact stiffness K_p (N/m per node), above 0. A finer mesh has more nodes in contact:
    /// scale it by the node count to keep the floor alike, or give a
    /// [`stiffness_density`](Self::stiffness_density).
    pub fn stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = Stiffness::PerNode(stiffness);
        self
    }

    /// Contact stiffness per area of the boundary of the body (N/m^3), above 0: pressure over
    /// depth, the same for all meshes. Damping and friction are per area then, too (N s/m^3). The
    /// area is that of the faces in the natural shape: edge length times thickness in the plane,
    /// the cross section in one dimension.
    ///
    /// Contact is felt at Gauss points of the faces instead of at the nodes: a corner that goes
    /// ahead is felt once the points next to it, a fifth of an edge away, are inside.
    pub fn stiffness_density(mut self, stiffness: f64) -> Self {
        self.stiffness = Stiffness::Density(stiffness);
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

    /// Whether damping may pull a node back while it separates (default: true, Hirai's law).
    /// With `false` the normal force is never negative.
    pub fn adhesion(mut self, adhesion: bool) -> Self {
        self.adhesion = adhesion;
        self
    }

    /// Constant velocity w of the obstacle (m/s), which is where it was said to be at t = 0.
    /// Default: at rest. The power f . w that keeps it moving is supplied to the body.
    pub fn velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.velocity = Some(velocity.into());
        self
    }

    /// Name of the obstacle.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The obstacle with a normal of length 1, if all its numbers make sense.
    pub(crate) fn validated(&self, dimension: usize) -> Result<Self, InputError> {
        let input = |key: &str| format!("obstacle \"{}\" {key}", self.name);
        let shape = self.shape.validated(dimension, &input)?;
        let (rate, area) = match self.stiffness {
            Stiffness::PerNode(stiffness) => {
                positive(&input("stiffness"), stiffness, "N/m per node")?;
                ("N s/m per node", "")
            }
            Stiffness::Density(stiffness) => {
                positive(&input("stiffness_density"), stiffness, "N/m^3")?;
                ("N s/m^3", " per area")
            }
        };
        not_negative(&input(&format!("damping{area}")), self.damping, rate)?;
        not_negative(&input(&format!("friction{area}")), self.friction, rate)?;
        if let Some(velocity) = &self.velocity {
            if velocity.len() != dimension {
                let mend = format!("it needs {dimension} component(s) (m/s)");
                return Err(InputError::new(input("velocity"), format!("{velocity:?}"), mend));
            }
            finite(&input("velocity"), velocity)?;
        }
        Ok(Self { shape, ..self.clone() })
    }

    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The same obstacle, but with this [`displacement`](Self::displacement) (m) at time `t` (s).
    pub(crate) fn placed(mut self, t: f64, displacement: [f64; 3]) -> Self {
        let drift = self.drift();
        self.offset = std::array::from_fn(|i| displacement[i] - drift[i] * t);
        self
    }

    /// Where it is at time `t` (s), from where it was said to be (m); 0 beyond the dimension.
    pub(crate) fn displacement(&self, t: f64) -> [f64; 3] {
        let drift = self.drift();
        std::array::from_fn(|i| self.offset[i] + drift[i] * t)
    }

    /// w; 0 beyond the dimension.
    pub(crate) fn drift(&self) -> [f64; 3] {
        let velocity = self.velocity.as_deref().unwrap_or_default();
        std::array::from_fn(|i| velocity.get(i).copied().unwrap_or(0.0))
    }

    pub(super) fn is_per_area(&self) -> bool {
        matches!(self.stiffness, Stiffness::Density(_))
    }

    /// Whether normal forces may pull.
    pub(super) fn has_adhesion(&self) -> bool {
        self.adhesion
    }

    /// The law for a point that stands for `area` (m^2; 1 for a node).
    pub(super) fn law(&self, area: f64) -> Law {
        let (Stiffness::PerNode(stiffness) | Stiffness::Density(stiffness)) = self.stiffness;
        Law {
            stiffness: area * stiffness,
            damping: area * self.damping,
            friction: area * self.friction,
        }
    }

    /// d and its derivatives at time `t`.
    pub(super) fn nearest(&self, t: f64, mut x: [f64; 3], dimension: usize) -> Nearest {
        x.iter_mut().zip(self.displacement(t)).for_each(|(x, moved)| *x -= moved);
        self.shape.nearest(&x[..dimension])
    }
}
