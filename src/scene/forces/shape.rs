//! Shapes of obstacles: signed distances, negative inside.

use std::fmt;
use std::sync::Arc;

use super::turned::{Turned, corners};
use crate::base::input::{InputError, finite, positive};
use crate::base::vector::{axes_across, dot, norm, padded};

/// Components of a normal below this part of its length are round-off.
const ROUND_OFF: f64 = 1e-12;

type Distance = dyn Fn(&[f64], &mut [f64]) -> f64 + Send + Sync;

/// A signed distance d(x) (m), negative inside, in a space of any dimension.
#[derive(Clone)]
pub struct Shape(Kind);

#[derive(Clone)]
pub(crate) enum Kind {
    HalfPlane { point: Vec<f64>, normal: Vec<f64> },
    Ball { centre: Vec<f64>, radius: f64, cavity: bool },
    Box { min: Vec<f64>, max: Vec<f64>, turned: Option<Turned> },
    Capsule { from: Vec<f64>, to: Vec<f64>, radius: f64 },
    Union(Vec<Shape>),
    Custom(Arc<Distance>),
}

impl fmt::Debug for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Kind::HalfPlane { point, normal } => write!(f, "half-plane at {point:?} {normal:?}"),
            Kind::Ball { centre, radius, cavity: false } => write!(f, "disc {centre:?} {radius}"),
            Kind::Ball { centre, radius, cavity: true } => write!(f, "cavity {centre:?} {radius}"),
            Kind::Box { min, max, turned: None } => write!(f, "box {min:?} {max:?}"),
            Kind::Box { min, max, turned: Some(turned) } => {
                write!(f, "box {min:?} {max:?} turned {:?}", turned.by)
            }
            Kind::Capsule { from, to, radius } => write!(f, "capsule {from:?} {to:?} {radius}"),
            Kind::Union(parts) => f.debug_tuple("union").field(parts).finish(),
            Kind::Custom(_) => f.write_str("custom"),
        }
    }
}

/// The distance from a shape to a point and its derivatives; components beyond the dimension are 0.
pub(crate) struct Nearest {
    /// d
    pub(crate) distance: f64,
    /// n, the gradient of d, of length 1.
    pub(crate) normal: [f64; 3],
    /// kappa and a, a unit vector or 0: the Hessian of d is kappa (I - n n^T - a a^T).
    pub(crate) curvature: f64,
    pub(crate) axis: [f64; 3],
}

impl Nearest {
    fn flat(distance: f64, normal: [f64; 3]) -> Self {
        Self { distance, normal, curvature: 0.0, axis: [0.0; 3] }
    }

    /// At a point `away` from its nearest point on a core (a centre, a line along `axis`).
    /// In the core itself, where all directions are alike, the first axis is taken for n.
    fn around(away: [f64; 3], axis: [f64; 3]) -> Self {
        let distance = norm(&away);
        if distance == 0.0 {
            return Self::flat(0.0, [1.0, 0.0, 0.0]);
        }
        let normal = away.map(|x| x / distance);
        Self { distance, normal, curvature: distance.recip(), axis }
    }

    /// The Hessian of d times a vector.
    pub(crate) fn bend(&self, x: &[f64; 3]) -> [f64; 3] {
        let (along, on_axis) = (dot(&self.normal, x), dot(&self.axis, x));
        std::array::from_fn(|i| {
            self.curvature * (x[i] - along * self.normal[i] - on_axis * self.axis[i])
        })
    }
}

impl Shape {
    /// The half-plane (half-line, half-space) below the plane through `point` (m), whose `normal`
    /// points outward, to where bodies may be. Its length does not matter.
    pub fn half_plane(point: impl Into<Vec<f64>>, normal: impl Into<Vec<f64>>) -> Self {
        Self(Kind::HalfPlane { point: point.into(), normal: normal.into() })
    }

    /// The disc (in space, the sphere) around `centre` (m) with `radius` (m).
    pub fn disc(centre: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self(Kind::Ball { centre: centre.into(), radius, cavity: false })
    }

    /// Everything but a disc (in space, a sphere): bodies may be inside.
    pub fn cavity(centre: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self(Kind::Ball { centre: centre.into(), radius, cavity: true })
    }

    /// The box between the corners `min` and `max` (m), its edges parallel to the axes.
    pub fn box_between(min: impl Into<Vec<f64>>, max: impl Into<Vec<f64>>) -> Self {
        Self(Kind::Box { min: min.into(), max: max.into(), turned: None })
    }

    /// The box between `min` and `max` (m), turned about its middle by `turn` (rad): one angle in the plane, counter-clockwise; in space
    /// three numbers, the axis times the angle.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings};
    ///
    /// let mesh = Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Rectangles)?.translated(&[0.0, 0.005])?;
    /// let body = Body::new(mesh, Material::rigid(1000.0)).thickness(0.02).build()?;
    /// // a slope of 30 degrees, with its upper face through the origin nearly
    /// let slope = Obstacle::turned_box([-0.5, -0.01], [0.5, 0.0], [-30_f64.to_radians()]);
    /// let scene = Scene::new(body)
    ///     .gravity([0.0, -9.8])
    ///     .obstacle(slope.stiffness(2e3).damping(2.0))
    ///     .phase(Phase::until(0.2));
    /// let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    /// let moved = &motion.last().u[..2];
    /// assert!(moved[0] > 0.05 && moved[1] < -0.03); // it slides down to the right
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn turned_box(
        min: impl Into<Vec<f64>>,
        max: impl Into<Vec<f64>>,
        turn: impl Into<Vec<f64>>,
    ) -> Self {
        let turned = Some(Turned::new(turn.into()));
        Self(Kind::Box { min: min.into(), max: max.into(), turned })
    }

    /// All points nearer than `radius` (m) to the straight line between `from` and `to` (m), in the
    /// plane or in space.
    pub fn capsule(from: impl Into<Vec<f64>>, to: impl Into<Vec<f64>>, radius: f64) -> Self {
        Self(Kind::Capsule { from: from.into(), to: to.into(), radius })
    }

    /// Several shapes as one: d is the smallest of theirs.
    pub fn union(parts: impl IntoIterator<Item = Shape>) -> Self {
        Self(Kind::Union(parts.into_iter().collect()))
    }

    /// A shape given by its signed distance.
    ///
    /// `distance` returns d at a point (m) and writes its gradient, a vector of length 1. (Where
    /// d is above 0, only its sign matters for the force. But it should not be larger than the true distance
    /// there, as it is used to detect steps that pass through the shape.)
    ///
    /// The curvature of the shape is omitted from the Newton matrix: results are the same, but the
    /// iteration converges more slowly where the shape is strongly curved.
    pub fn custom(distance: impl Fn(&[f64], &mut [f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self(Kind::Custom(Arc::new(distance)))
    }

    /// Whether it is known to be its own mirror image in the plane at a place (m) on an axis, to within `tolerance` (m).
    pub(crate) fn is_symmetric(&self, (axis, at): (usize, f64), tolerance: f64) -> bool {
        let is_same = |a: f64, b: f64| a == b || (a - b).abs() <= tolerance;
        match &self.0 {
            Kind::HalfPlane { normal, .. } => normal[axis].abs() <= ROUND_OFF * norm(normal),
            Kind::Ball { centre, .. } => is_same(centre[axis], at),
            Kind::Box { min, max, turned: None } => is_same(at - min[axis], max[axis] - at),
            Kind::Box { min, max, turned } => {
                let corners = corners(min, max, turned.as_ref());
                let image = |i: usize, x: f64| if i == axis { 2.0 * at - x } else { x };
                let is_image = |one: &[f64], other: &[f64]| {
                    one.iter().zip(other).enumerate().all(|(i, (a, b))| is_same(image(i, *a), *b))
                };
                corners.iter().all(|one| corners.iter().any(|other| is_image(one, other)))
            }
            Kind::Capsule { from, to, .. } => {
                let image = |i: usize| if i == axis { 2.0 * at - from[i] } else { from[i] };
                let is_across = (0..to.len()).all(|i| is_same(image(i), to[i]));
                is_across || [from, to].iter().all(|end| is_same(end[axis], at))
            }
            Kind::Union(parts) => parts.iter().all(|part| part.is_symmetric((axis, at), tolerance)),
            Kind::Custom(_) => false,
        }
    }

    /// Its section across an `axis`, in the plane of the other two: `None` if it is not known to be the same all along there for
    /// bodies between two `ends` (m) on it, to within `tolerance` (m).
    pub(super) fn section(&self, axis: usize, ends: [f64; 2], tolerance: f64) -> Option<Self> {
        let axes = axes_across(axis);
        let own = |x: &[f64]| axes.map(|i| x[i]).to_vec();
        // beyond the ends by so much that what is inside is nowhere nearer to an end
        let covers = |[low, high]: [f64; 2], beyond: f64| {
            low <= ends[0] - beyond + tolerance && high >= ends[1] + beyond - tolerance
        };
        match &self.0 {
            Kind::HalfPlane { point, normal } => (normal[axis].abs() <= ROUND_OFF * norm(normal))
                .then(|| Self::half_plane(own(point), own(normal))),
            Kind::Box { min, max, turned: None } => {
                let [a, b] = axes.map(|i| 0.5 * (max[i] - min[i]));
                covers([min[axis], max[axis]], a.min(b))
                    .then(|| Self::box_between(own(min), own(max)))
            }
            Kind::Capsule { from, to, radius } => {
                let is_along = axes.iter().all(|&i| (from[i] - to[i]).abs() <= tolerance);
                let span = [from[axis].min(to[axis]), from[axis].max(to[axis])];
                (is_along && covers(span, 0.0)).then(|| Self::disc(own(from), *radius))
            }
            Kind::Union(parts) => {
                let parts = parts.iter().map(|part| part.section(axis, ends, tolerance));
                parts.collect::<Option<Vec<_>>>().map(Self::union)
            }
            Kind::Ball { .. } | Kind::Box { .. } | Kind::Custom(_) => None,
        }
    }

    /// A point that says where a shape is that has been displaced (m): the centre of a ball, the first corner of a box, the first end
    /// of a capsule, the point of a half-plane nearest to the origin, that of the first part of a union; none of a custom shape.
    pub(crate) fn reference(&self, displacement: &[f64; 3]) -> Option<Vec<f64>> {
        let moved = |point: &[f64]| {
            point.iter().zip(displacement).map(|(x, d)| x + d).collect::<Vec<f64>>()
        };
        match &self.0 {
            Kind::HalfPlane { point, normal } => {
                let along = dot(normal, &moved(point)) / dot(normal, normal);
                Some(normal.iter().map(|n| along * n).collect())
            }
            Kind::Ball { centre: point, .. } | Kind::Capsule { from: point, .. } => {
                Some(moved(point))
            }
            Kind::Box { min, max, turned } => {
                corners(min, max, turned.as_ref()).first().map(|corner| moved(corner))
            }
            Kind::Union(parts) => parts.first()?.reference(displacement),
            Kind::Custom(_) => None,
        }
    }

    pub(crate) fn kind(&self) -> &Kind {
        &self.0
    }

    /// d and its derivatives at `x`.
    pub(crate) fn nearest(&self, x: &[f64]) -> Nearest {
        match &self.0 {
            Kind::HalfPlane { point, normal } => {
                let height = (0..x.len()).map(|i| normal[i] * (x[i] - point[i])).sum();
                Nearest::flat(height, padded(normal))
            }
            Kind::Ball { centre, radius, cavity } => {
                let around = Nearest::around(from_to(centre, x), [0.0; 3]);
                let outward = if *cavity { -1.0 } else { 1.0 };
                Nearest {
                    distance: outward * (around.distance - radius),
                    normal: around.normal.map(|n| outward * n),
                    curvature: outward * around.curvature,
                    axis: around.axis,
                }
            }
            Kind::Box { min, max, turned: None } => nearest_of_box(min, max, x),
            Kind::Box { min, max, turned: Some(turned) } => {
                let own = turned.back(min, max, x);
                let nearest = nearest_of_box(min, max, &own[..x.len()]);
                Nearest {
                    normal: turned.direction(nearest.normal),
                    axis: turned.direction(nearest.axis),
                    ..nearest
                }
            }
            Kind::Capsule { from, to, radius } => {
                let (along, away) = (from_to(from, to), from_to(from, x));
                let square = dot(&along, &along);
                let share = dot(&along, &away) / square;
                let clamped = share.clamp(0.0, 1.0);
                let away = std::array::from_fn(|i| away[i] - clamped * along[i]);
                let axis = if share == clamped { along } else { [0.0; 3] };
                let around = Nearest::around(away, axis.map(|a| a / square.sqrt()));
                Nearest { distance: around.distance - radius, ..around }
            }
            Kind::Union(parts) => {
                let mut nearest = Nearest::flat(f64::INFINITY, [1.0, 0.0, 0.0]);
                for part in parts {
                    let other = part.nearest(x);
                    if other.distance < nearest.distance {
                        nearest = other;
                    }
                }
                nearest
            }
            Kind::Custom(distance) => {
                let mut normal = [0.0; 3];
                let distance = distance(x, &mut normal[..x.len()]);
                Nearest::flat(distance, normal)
            }
        }
    }

    /// Half of its least thickness (m) at `x`: that of the nearest part. Infinite where that is not bounded, or not known.
    pub(super) fn half_thickness(&self, x: &[f64]) -> f64 {
        match &self.0 {
            Kind::HalfPlane { .. } | Kind::Ball { cavity: true, .. } | Kind::Custom(_) => {
                f64::INFINITY
            }
            Kind::Ball { radius, .. } | Kind::Capsule { radius, .. } => *radius,
            Kind::Box { min, max, .. } => {
                let halves = min.iter().zip(max).map(|(min, max)| 0.5 * (max - min));
                halves.fold(f64::INFINITY, f64::min)
            }
            Kind::Union(parts) => {
                let distance = |part: &&Self| part.nearest(x).distance;
                let nearest = parts.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                nearest.map_or(f64::INFINITY, |part| part.half_thickness(x))
            }
        }
    }

    /// Whether a user's function is part of it.
    pub(super) fn is_custom(&self) -> bool {
        match &self.0 {
            Kind::Union(parts) => parts.iter().any(Self::is_custom),
            kind => matches!(kind, Kind::Custom(_)),
        }
    }

    /// The shape with a normal of length 1, if all its numbers make sense. `input` completes the
    /// name of a number.
    pub(crate) fn validated(
        &self,
        dimension: usize,
        input: &dyn Fn(&str) -> String,
    ) -> Result<Self, InputError> {
        let vector = |key: &str, vector: &[f64]| {
            if vector.len() != dimension {
                let help = format!("it needs {dimension} component(s)");
                return Err(InputError::new(input(key), format!("{vector:?}"), help));
            }
            finite(&input(key), vector)
        };
        let mut shape = self.clone();
        match &mut shape.0 {
            Kind::HalfPlane { point, normal } => {
                vector("point", point)?;
                vector("normal", normal)?;
                let length = norm(normal);
                if length == 0.0 {
                    let value = format!("{normal:?}");
                    return Err(InputError::new(input("normal"), value, "it must not be zero"));
                }
                normal.iter_mut().for_each(|x| *x /= length);
            }
            Kind::Ball { centre, radius, .. } => {
                vector("centre", centre)?;
                positive(&input("radius"), *radius, "m")?;
            }
            Kind::Box { min, max, turned } => {
                vector("min", min)?;
                vector("max", max)?;
                if let Some(turned) = turned {
                    turned.validate(dimension, &input("turn"))?;
                }
                if min.iter().zip(&*max).any(|(min, max)| min >= max) {
                    let help = format!("it must lie above min, {min:?}, in all components");
                    return Err(InputError::new(input("max"), format!("{max:?}"), help));
                }
            }
            Kind::Capsule { from, to, radius } => {
                vector("from", from)?;
                vector("to", to)?;
                positive(&input("radius"), *radius, "m")?;
                if dimension == 1 {
                    let help = "in one dimension use a box";
                    return Err(InputError::new(input("kind"), "capsule", help));
                }
                if from == to {
                    let help = "it must not be where the capsule begins: use a disc";
                    return Err(InputError::new(input("to"), format!("{to:?}"), help));
                }
            }
            Kind::Union(parts) => {
                if parts.is_empty() {
                    let help = "it needs one part at least";
                    return Err(InputError::new(input("number of parts"), 0, help));
                }
                for (k, part) in parts.iter_mut().enumerate() {
                    *part =
                        part.validated(dimension, &|key| input(&format!("part {} {key}", k + 1)))?;
                }
            }
            Kind::Custom(_) => {}
        }
        Ok(shape)
    }
}

fn from_to(a: &[f64], b: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| if i < a.len() { b[i] - a[i] } else { 0.0 })
}

/// Inside, the nearest face counts; outside, the nearest face, edge or corner.
fn nearest_of_box(min: &[f64], max: &[f64], x: &[f64]) -> Nearest {
    // how far x is beyond the nearer face of each axis, and to which side
    let beyond = |i: usize| {
        let (below, above) = (min[i] - x[i], x[i] - max[i]);
        if below > above { (below, -1.0) } else { (above, 1.0) }
    };
    let mut outside = [0.0; 3];
    let mut nearest = Nearest::flat(f64::NEG_INFINITY, [0.0; 3]);
    let mut axes_outside = 0;
    for i in 0..x.len() {
        let (depth, side) = beyond(i);
        if depth > 0.0 {
            outside[i] = side * depth;
            axes_outside += 1;
        }
        if depth > nearest.distance {
            let mut normal = [0.0; 3];
            normal[i] = side;
            nearest = Nearest::flat(depth, normal);
        }
    }
    if axes_outside < 2 {
        return nearest;
    }
    let edge = (0..x.len()).find(|&i| outside[i] == 0.0);
    let axis = std::array::from_fn(|i| f64::from(edge == Some(i)));
    Nearest::around(outside, axis)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(dimension: usize) -> Vec<Shape> {
        let cut = |x: [f64; 3]| x[..dimension].to_vec();
        let mut shapes = vec![
            Shape::half_plane(cut([0.1, 0.2, 0.3]), cut([-3.0, 4.0, 1.0])),
            Shape::disc(cut([0.1, 0.2, 0.3]), 0.8),
            Shape::cavity(cut([0.1, 0.2, 0.3]), 0.8),
            Shape::box_between(cut([-0.5, -0.4, -0.3]), cut([0.6, 0.5, 0.4])),
        ];
        if dimension > 1 {
            let turn = if dimension == 2 { vec![0.7] } else { vec![0.3, -0.8, 0.5] };
            let (min, max) = (cut([-0.5, -0.4, -0.3]), cut([0.6, 0.5, 0.4]));
            shapes.push(Shape::turned_box(min, max, turn));
            shapes.push(Shape::capsule(cut([-0.5, 0.1, 0.2]), cut([0.6, -0.3, 0.4]), 0.3));
        }
        shapes.push(Shape::union([shapes[1].clone(), shapes[3].clone()]));
        let validated = |shape: &Shape| shape.validated(dimension, &|key| key.into()).unwrap();
        shapes.iter().map(validated).collect()
    }

    /// Points in and around the shapes.
    fn points(dimension: usize) -> impl Iterator<Item = Vec<f64>> {
        let noise = |k: usize| (12.9898 * (k as f64 + 1.0)).sin().mul_add(43.758, 0.3).sin();
        (0..60).map(move |k| (0..dimension).map(|i| noise(dimension * k + i)).collect())
    }

    #[test]
    fn gradients_have_length_one_and_are_derivatives_as_hessians_are() {
        for dimension in 1..=3 {
            for (shape, x) in
                shapes(dimension).iter().flat_map(|s| points(dimension).map(move |x| (s, x)))
            {
                let at = shape.nearest(&x);
                assert!((dot(&at.normal, &at.normal) - 1.0).abs() < 1e-14, "{shape:?}");
                let h = 1e-6;
                let shifted = |j: usize, by: f64| {
                    let mut x = x.clone();
                    x[j] += by;
                    shape.nearest(&x)
                };
                for j in 0..dimension {
                    let (ahead, behind) = (shifted(j, h), shifted(j, -h));
                    // there are no derivatives on a ridge, where two parts are equally near
                    let jump = (0..3).map(|i| (ahead.normal[i] - behind.normal[i]).abs());
                    if jump.sum::<f64>() > 1e-3 {
                        continue;
                    }
                    let slope = (ahead.distance - behind.distance) / (2.0 * h);
                    assert!((slope - at.normal[j]).abs() < 1e-8, "{shape:?} at {x:?}");
                    let mut unit = [0.0; 3];
                    unit[j] = 1.0;
                    let column = at.bend(&unit);
                    for (i, entry) in column.into_iter().enumerate() {
                        let slope = (ahead.normal[i] - behind.normal[i]) / (2.0 * h);
                        assert!((slope - entry).abs() < 1e-6, "{shape:?} at {x:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn distances_as_a_ruler_finds_them() {
        let distance = |shape: &Shape, x: &[f64]| shape.nearest(x).distance;
        let disc = Shape::disc([1.0, 0.0], 0.5);
        assert_eq!(distance(&disc, &[1.0, 2.0]), 1.5);
        assert_eq!(distance(&disc, &[1.0, 0.0]), -0.5);
        assert_eq!(distance(&Shape::cavity([1.0, 0.0], 0.5), &[1.0, 0.2]), 0.3);
        let unit = Shape::box_between([0.0, 0.0], [1.0, 1.0]);
        assert_eq!(distance(&unit, &[4.0, 5.0]), 5.0);
        assert_eq!(distance(&unit, &[0.5, 0.75]), -0.25);
        assert_eq!(distance(&unit, &[-2.0, 0.5]), 2.0);
        let pill = Shape::capsule([0.0, 0.0], [2.0, 0.0], 0.25);
        assert_eq!(distance(&pill, &[1.0, 1.0]), 0.75);
        assert_eq!(distance(&pill, &[5.0, 4.0]), 4.75);
        assert_eq!(distance(&pill, &[2.0, 0.0]), -0.25);
        let both = Shape::union([disc, pill]);
        assert_eq!(distance(&both, &[1.0, 0.0]), -0.5);
        assert_eq!(distance(&both, &[2.0, 0.0]), -0.25);
    }
}
