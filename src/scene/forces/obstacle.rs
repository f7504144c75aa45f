//! Obstacles: a shape, how it moves, and the law of its force.

use std::sync::Arc;

use super::friction::{Backward, Bristles, Coulomb, Friction};
use super::shape::{Nearest, Shape};
use super::travel::{Cubics, Travel, Waypoints};
use crate::base::formula::Formula;
use crate::base::input::{InputError, not_negative, positive};
use crate::base::vector::axes_across;
use crate::elements::mesh::NodeMap;
use crate::scene::constraint::Spline;

/// An obstacle: a signed distance d(x), negative inside, and the law of its penalty force.
///
/// On each boundary node of a body with d <= 0 (or point of a face, see
/// [`stiffness_density`](Self::stiffness_density)) the force is
///
/// f = N n - B_t s - mu(|s|) N s/|s|,   N = -K_p d - B_p d'
///
/// with the gradient n of d, the velocity w of the obstacle, d' = n . (x' - w), and the sliding
/// velocity s = (I - n n^T) (x' - w). Coulomb's friction, the last term, acts where N presses (is above 0).
/// Point masses belong to no boundary and pass through obstacles.
///
/// # Friction
///
/// [`friction_coefficients`](Self::friction_coefficients) mu_s (static) and mu_k (kinetic) give
///
/// ```text
/// mu(w) = mu_s (3 w/v0 - (w/v0)^3)/2                  up to v0, the sticking speed
///         mu_s - (mu_s - mu_k) (3 y^2 - 2 y^3)        up to 3 v0, with y = (w/v0 - 1)/2
///         mu_k                                        from there on
/// ```
///
/// This force is smooth in the speed, in place of one that jumps at rest: sticking surfaces creep, slower than v0.
/// On a slope of angle a, for tan(a) below mu_s, a block creeps at
///
/// ```text
/// w = 2 v0 sin(asin(tan(a)/mu_s)/3),
/// ```
///
/// which is about 2/3 v0 tan(a)/mu_s; on a steeper one it slides with the acceleration
/// g (sin(a) - mu_k cos(a)). Where contact events are located
/// ([`Settings::contact_events`](crate::Settings::contact_events)), so are the times at which points pass
/// v0, and the report has the times at which the body slips and sticks
/// ([`PhaseReport::slips`](crate::PhaseReport::slips)). The work of friction, with the velocity relative
/// to the obstacle, is dissipated. In statics ([`Scene::equilibrium`](crate::Scene::equilibrium)) nothing
/// slides, and there is no friction.
///
/// Near rest friction acts as a damper of 3 mu_s N/(2 v0). It does not limit the steps of implicit methods,
/// but speeds are only as accurate as their tolerances, so the default of `atol_velocity` stays well below
/// v0. Explicit steps are bounded by it (with central differences, on a node of mass m, to
/// 2 m v0/(3 mu_s N)): give them a larger [`sticking_speed`](Self::sticking_speed).
#[derive(Debug, Clone)]
pub struct Obstacle {
    name: String,
    shape: Shape,
    stiffness: Stiffness,
    damping: f64,
    tangential_damping: f64,
    friction: Friction,
    bristles: Option<Bristles>,
    adhesion: bool,
    travel: Travel,
    /// Offset (m) from the position that results from its travel alone.
    offset: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
enum Stiffness {
    PerNode(f64),
    Density(f64),
}

/// The numbers of the law, for one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct PenaltyLaw {
    /// K_p (N/m)
    pub(super) stiffness: f64,
    /// B_p (N s/m)
    pub(super) damping: f64,
    /// B_t (N s/m)
    pub(super) tangential_damping: f64,
}

impl PenaltyLaw {
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
            tangential_damping: 0.0,
            friction: Friction::default(),
            bristles: None,
            adhesion: false,
            travel: Travel::Uniform(Vec::new()),
            offset: [0.0; 3],
        }
    }

    /// The same obstacle with `share` of its stiffness and damping at each node, where they are given per
    /// node: for a mesh with more nodes, which share them.
    pub(crate) fn shared_out(mut self, share: f64) -> Self {
        if let Stiffness::PerNode(stiffness) = &mut self.stiffness {
            *stiffness *= share;
            self.damping *= share;
            self.tangential_damping *= share;
        }
        self
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

    /// As [`Shape::turned_box`].
    pub fn turned_box(
        min: impl Into<Vec<f64>>,
        max: impl Into<Vec<f64>>,
        turn: impl Into<Vec<f64>>,
    ) -> Self {
        Self::new(Shape::turned_box(min, max, turn))
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

    /// Contact stiffness K_p (N/m per node), above 0. A finer mesh has more nodes in contact: reduce it in
    /// proportion to keep the floor equally stiff, or give a [`stiffness_density`](Self::stiffness_density).
    pub fn stiffness(mut self, stiffness: f64) -> Self {
        self.stiffness = Stiffness::PerNode(stiffness);
        self
    }

    /// Contact stiffness per area of the boundary of the body (N/m^3), above 0: pressure over depth, the same
    /// for all meshes.
    ///
    /// Damping, also the tangential one, is then per area (N s/m^3). The area is that of the faces in the
    /// undeformed shape: edge length times thickness in the plane, the cross section in one dimension.
    ///
    /// Contact acts at Gauss points of the faces instead of at the nodes: a corner that enters first has
    /// contact only once the points next to it, a fifth of an edge away, are inside.
    pub fn stiffness_density(mut self, stiffness: f64) -> Self {
        self.stiffness = Stiffness::Density(stiffness);
        self
    }

    /// Contact damping B_p (N s/m per node; default 0).
    pub fn damping(mut self, damping: f64) -> Self {
        self.damping = damping;
        self
    }

    /// Tangential damping B_t (N s/m per node; default 0): a force in proportion to the sliding speed,
    /// whatever the normal force. A block on a slope never comes to rest by it.
    pub fn tangential_damping(mut self, damping: f64) -> Self {
        self.tangential_damping = damping;
        self
    }

    /// Coefficient mu of Coulomb's friction, static and kinetic, 0 or above (default: no friction). It
    /// multiplies the normal force where that acts, so it is the same for all meshes.
    pub fn friction_coefficient(self, coefficient: f64) -> Self {
        self.friction_coefficients(coefficient, coefficient)
    }

    /// Coefficients of Coulomb's friction: `at_rest` (mu_s, static) while it sticks, `sliding` (mu_k,
    /// kinetic), not above it, once it slides. See [Friction](Self#friction).
    pub fn friction_coefficients(mut self, at_rest: f64, sliding: f64) -> Self {
        self.friction.coefficients = Some([at_rest, sliding]);
        self
    }

    /// The static `coefficient` of friction against sliding along `direction`, one component per dimension, of any
    /// length above 0: bristles, scales or claws that resist backward sliding (default: isotropic friction).
    ///
    /// It is not below the static one of the [friction coefficients](Self::friction_coefficients), with r its ratio to
    /// that; mu_k is r times as large, too. Sliding at the angle a to the direction has
    /// 1 + (r - 1) (3 q^2 - 2 q^3) times their friction, with q = cos(a) where that is above 0; backward speeds far
    /// below v0 have less, which leaves the force smooth. (Snakes: D. L. Hu, J. Nirody, T. Scott, M. J. Shelley, *The
    /// mechanics of slithering locomotion*, PNAS 106, 2009, take different coefficients forward and backward.) The
    /// direction is one of space: it does not turn with the obstacle or the body.
    pub fn backward_friction(mut self, direction: impl Into<Vec<f64>>, coefficient: f64) -> Self {
        self.bristles = Some(Bristles { direction: direction.into(), coefficient });
        self
    }

    /// The sliding speed v0 (m/s) below which friction sticks, above 0; with
    /// [friction coefficients](Self::friction_coefficients) only.
    ///
    /// Default: a thousandth of the size of the body per second. Sticking points may creep nearly that fast, so
    /// it should be small against the motions of interest.
    pub fn sticking_speed(mut self, speed: f64) -> Self {
        self.friction.sticking_speed = Some(speed);
        self
    }

    /// Whether damping may pull a node back while it separates (default: no). Hirai's law is `true`.
    /// With `false` the normal force is never negative.
    pub fn adhesion(mut self, adhesion: bool) -> Self {
        self.adhesion = adhesion;
        self
    }

    /// Constant velocity w of the obstacle (m/s); at t = 0 it is where its shape was given. Default: at rest.
    /// The power f . w that keeps it moving is supplied to the body.
    pub fn velocity(mut self, velocity: impl Into<Vec<f64>>) -> Self {
        self.travel = Travel::Uniform(velocity.into());
        self
    }

    /// A smooth path in place of a constant velocity.
    ///
    /// At the `times` (s, ascending, two at least) the obstacle has the `displacements` (m, one component per
    /// dimension) from the position of its shape. It may stop and come back.
    ///
    /// The path is a cubic spline, as that of [`Phase::path`](crate::Phase::path): it starts and ends with
    /// velocity 0, and the obstacle rests before the first time and after the last.
    pub fn path(
        mut self,
        times: impl Into<Vec<f64>>,
        displacements: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        let displacements = displacements.into_iter().map(Into::into).collect();
        self.travel = Travel::Path(Arc::new(Waypoints::new(&times.into(), displacements)));
        self
    }

    /// A path by smooth formulas of time in place of a velocity, one per component: the displacement (m) from
    /// where the shape was given.
    #[cfg(feature = "scene-file")]
    pub(crate) fn follow_formulas(mut self, formulas: Vec<Formula>) -> Self {
        self.travel = Travel::Formulas(formulas.into());
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
        let tangential = input(&format!("tangential_damping{area}"));
        not_negative(&tangential, self.tangential_damping, rate)?;
        self.friction.validate(&input)?;
        let bristles = self.bristles.as_ref();
        bristles.map_or(Ok(()), |of| of.validate(&self.friction, dimension, &input))?;
        self.travel.validate(dimension, &input)?;
        Ok(Self { shape, ..self.clone() })
    }

    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The same obstacle, but with this [`displacement`](Self::displacement) (m) at time `t` (s).
    pub(crate) fn placed(mut self, t: f64, displacement: [f64; 3]) -> Self {
        let travelled = self.travel.displacement(t);
        self.offset = std::array::from_fn(|i| displacement[i] - travelled[i]);
        self
    }

    /// Its displacement (m) at time `t` (s) from where its shape was given; 0 beyond the dimension.
    pub(crate) fn displacement(&self, t: f64) -> [f64; 3] {
        let travelled = self.travel.displacement(t);
        std::array::from_fn(|i| self.offset[i] + travelled[i])
    }

    /// Position (m) of its [reference point](Shape::reference) at time `t` (s); none of a custom shape.
    pub(crate) fn place_at(&self, t: f64) -> Option<Vec<f64>> {
        self.shape.reference(&self.displacement(t))
    }

    /// w at time `t` (s); 0 beyond the dimension.
    pub(crate) fn velocity_at(&self, t: f64) -> [f64; 3] {
        self.travel.velocity(t)
    }

    /// A bound on its speed (m/s) at all times, 0 if it rests; there is none if it follows formulas.
    pub(super) fn fastest(&self) -> Option<f64> {
        self.travel.fastest()
    }

    /// The cubics along which it moves between two times (s), to within `tolerance` (m), and a bound on its
    /// speed.
    pub(crate) fn cubics(&self, times: [f64; 2], tolerance: f64) -> Cubics {
        self.travel.cubics(times, tolerance)
    }

    /// Its velocity (m/s) if that is constant; 0 beyond the dimension.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn constant_velocity(&self) -> Option<[f64; 3]> {
        self.travel.is_uniform().then(|| self.velocity_at(0.0))
    }

    /// Times (s) between which its path is a cubic, up to a time `end` and to within `tolerance` (m); none if
    /// its velocity is constant.
    #[cfg(feature = "output")]
    pub(crate) fn knots(&self, end: f64, tolerance: f64) -> Vec<f64> {
        match self.travel {
            Travel::Uniform(_) => Vec::new(),
            Travel::Path(_) => self.breaks().into(),
            Travel::Formulas(_) => {
                let Cubics { parts, .. } = self.cubics([0.0, end], tolerance);
                (0..=parts).map(|k| k as f64 / parts as f64 * end).collect()
            }
        }
    }

    /// Displacement (m) by its velocity or path alone until time `t`.
    #[cfg(feature = "output")]
    pub(crate) fn travelled(&self, t: f64) -> [f64; 3] {
        self.travel.displacement(t)
    }

    /// Offset (m) from the position that results from its velocity or path alone.
    #[cfg(any(feature = "checkpoint", feature = "output"))]
    pub(crate) fn offset(&self) -> [f64; 3] {
        self.offset
    }

    /// Times (s) between which it moves by one law.
    pub(crate) fn breaks(&self) -> &[f64] {
        self.travel.splines().first().map_or(&[], Spline::times)
    }

    /// The formulas that it follows, one per component.
    pub(crate) fn formulas(&self) -> &[Formula] {
        match &self.travel {
            Travel::Formulas(formulas) => formulas,
            Travel::Uniform(_) | Travel::Path(_) => &[],
        }
    }

    /// The same obstacle with this [`offset`](Self::offset).
    #[cfg(feature = "checkpoint")]
    pub(crate) fn with_offset(mut self, offset: [f64; 3]) -> Self {
        self.offset = offset;
        self
    }

    /// Whether what slides on it is held back in proportion to its speed.
    pub(crate) fn has_tangential_damping(&self) -> bool {
        self.tangential_damping > 0.0
    }

    /// The same obstacle without friction and tangential damping.
    pub(crate) fn without_friction(self) -> Self {
        let friction = Friction::default();
        Self { friction, bristles: None, tangential_damping: 0.0, ..self }
    }

    /// Whether what slides on it is held back by Coulomb's friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.friction.acts()
    }

    /// Equivalent obstacle in a smaller scene: itself if it is known to be its own mirror image at some `times` (s), or its section if it is known
    /// to be the same all along the axis beside the body then, to within `tolerance` (m); `None` otherwise. A stiffness per node stays what it is.
    pub(crate) fn by_map(&self, map: &NodeMap, times: &[f64], tolerance: f64) -> Option<Self> {
        let axis = map.axis;
        let is_along = |of: &Bristles| of.direction.get(axis).is_some_and(|x| *x != 0.0);
        let leaves = |t: &f64| self.displacement(*t)[axis].abs() > tolerance;
        if times.iter().any(leaves) || self.bristles.as_ref().is_some_and(is_along) {
            return None;
        }
        if !map.is_section() {
            let is_same = self.shape.is_symmetric((axis, map.ends[0]), tolerance);
            return is_same.then(|| self.clone());
        }
        let (axes, own) = (axes_across(axis), self.validated(3).ok()?);
        let bristles = own.bristles.as_ref().map(|of| Bristles {
            direction: map.vector(&of.direction),
            coefficient: of.coefficient,
        });
        Some(Self {
            shape: own.shape.section(axis, map.ends, tolerance)?,
            travel: own.travel.part(axes),
            offset: [own.offset[axes[0]], own.offset[axes[1]], 0.0],
            bristles,
            ..own
        })
    }

    /// Whether its friction is larger one way.
    pub(crate) fn has_bristles(&self) -> bool {
        self.bristles.is_some()
    }

    /// The sliding speed (m/s) below which a body of `size` (m) sticks to it; `None` without friction.
    pub(crate) fn sticks_below(&self, size: f64) -> Option<f64> {
        self.coulomb(size).filter(|_| self.has_friction()).map(|coulomb| coulomb.sticking_speed)
    }

    /// Whether its stiffness is per area of the body, and not per node.
    pub(crate) fn is_per_area(&self) -> bool {
        matches!(self.stiffness, Stiffness::Density(_))
    }

    /// Its stiffness as it was given, and the unit of that.
    pub(crate) fn given_stiffness(&self) -> (f64, &'static str) {
        match self.stiffness {
            Stiffness::PerNode(stiffness) => (stiffness, "N/m per node"),
            Stiffness::Density(stiffness) => (stiffness, "N/m^3"),
        }
    }

    /// Whether normal forces may pull.
    pub(super) fn has_adhesion(&self) -> bool {
        self.adhesion
    }

    /// The law for a point that stands for `area` (m^2; 1 for a node).
    pub(super) fn law(&self, area: f64) -> PenaltyLaw {
        let (stiffness, _) = self.given_stiffness();
        PenaltyLaw {
            stiffness: area * stiffness,
            damping: area * self.damping,
            tangential_damping: area * self.tangential_damping,
        }
    }

    /// Its friction with a body of `size` (m).
    pub(super) fn coulomb(&self, size: f64) -> Option<Coulomb> {
        self.friction.coulomb(size)
    }

    /// Law of its larger friction in one direction.
    pub(super) fn backward(&self) -> Option<Backward> {
        self.bristles.as_ref()?.law(&self.friction)
    }

    /// d and its derivatives, with this [`displacement`](Self::displacement).
    pub(super) fn nearest(&self, moved: &[f64; 3], mut x: [f64; 3], dimension: usize) -> Nearest {
        x.iter_mut().zip(moved).for_each(|(x, moved)| *x -= moved);
        self.shape.nearest(&x[..dimension])
    }
}
