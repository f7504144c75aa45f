//! The scene around a touch: what its surfaces are there, and the numbers that it has by default.

use super::law::Kind;
use super::surfaces::Surfaces;
use crate::base::vector::norm;
use crate::elements::body::Body;
use crate::scene::forces::thickness;

/// The surroundings of a touch in its scene.
pub(crate) struct TouchSite<'a> {
    /// The bodies, joined into one.
    pub(crate) body: &'a Body,
    /// Pairs of numbers of bodies that are glued to each other: they do not touch where they are near each other undeformed.
    pub(crate) glued: &'a [[usize; 2]],
    /// The nodes (from 0, ascending) of planes of symmetry: faces between them are inside of a whole of which the body is a half.
    pub(crate) planes: &'a [Vec<usize>],
    /// Displacements (m) and velocities (m/s) at the start.
    pub(crate) u: &'a [f64],
    pub(crate) v: &'a [f64],
    /// The largest acceleration of gravity (m/s^2) of all phases.
    pub(crate) gravity: f64,
}

/// The bodies that touch.
pub(super) struct Parts {
    /// Their numbers, ascending.
    pub(super) numbers: Vec<usize>,
    /// Whether each of them touches itself, too.
    pub(super) itself: bool,
}

/// Default of D, over the mean side of facets and the thickness of the thinnest body, and over the size of bodies in one dimension.
const DISTANCE: f64 = 0.1;
const DISTANCE_OF_BARS: f64 = 0.01;
/// Default of k D over Young's modulus.
const BARRIER: f64 = 0.1;
const SPRING: f64 = 1.0;
/// Upper bound of the default of k D between rigid bodies, relative to the pressure of their weight on a quarter of their surface.
///
/// At 40 times the pressure a barrier yields by 0.15 D.
const WEIGHTS: f64 = 40.0;
/// Energy of a barrier that has yielded by two thirds of D, over k D^2.
const STOPPED: f64 = 8.0 / 27.0;

impl TouchSite<'_> {
    /// Whether bodies with these numbers are one, or glued to each other.
    pub(super) fn is_joined(&self, [a, b]: [usize; 2]) -> bool {
        a == b || self.glued.contains(&[a, b]) || self.glued.contains(&[b, a])
    }

    /// The default of D (m) where undeformed bodies are apart by more than that.
    pub(super) fn usual_distance(&self, surfaces: &Surfaces, parts: &Parts) -> f64 {
        let own =
            self.body.parts().enumerate().filter(|(number, _)| parts.numbers.contains(number));
        let bodies: Vec<&Body> = own.map(|(_, part)| part.body).collect();
        match surfaces.mean_side() {
            0.0 => DISTANCE_OF_BARS * bodies.iter().map(|body| body.size()).fold(0.0, f64::max),
            side => {
                bodies.iter().filter_map(|body| thickness(body)).fold(side, f64::min) * DISTANCE
            }
        }
    }

    /// The default of k (N/m^3) for a `distance` D (m).
    pub(super) fn usual_stiffness(
        &self,
        surfaces: &Surfaces,
        parts: &Parts,
        kind: Kind,
        distance: f64,
    ) -> f64 {
        let hard = match kind {
            Kind::Barrier => BARRIER,
            Kind::Spring => SPRING,
        };
        let speed = largest_difference(self.v, self.body.dimension());
        let mut young = f64::INFINITY;
        let (mut pressure, mut are_rigid) = (0.0_f64, true);
        for (number, part) in self.body.parts().enumerate() {
            if parts.numbers.contains(&number) {
                young = young.min(part.body.material().young);
                are_rigid &= part.body.is_rigid();
                let mass = part.body.mass() / (0.25 * surfaces.area(number));
                let energy = 0.5 * mass * speed.powi(2);
                pressure =
                    pressure.max(WEIGHTS * mass * self.gravity).max(energy / (STOPPED * distance));
            }
        }
        // without weight and speed nothing is known of what presses
        let most = if are_rigid && pressure > 0.0 { pressure } else { f64::INFINITY };
        (hard * young).min(most) / distance
    }
}

/// The distance (m) per second of which the default of the sticking speed is a thousandth: the size of the bodies, or the largest
/// difference of their initial velocities `v` (m/s).
pub(crate) fn way(body: &Body, v: &[f64]) -> f64 {
    largest_difference(v, body.dimension()).max(body.size())
}

/// A bound of the differences of vectors with so many components: the diagonal of the box around them.
fn largest_difference(vectors: &[f64], dimension: usize) -> f64 {
    let range = |i: usize| {
        let own = vectors.iter().skip(i).step_by(dimension);
        let ends = own
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &x| [x.min(low), x.max(high)]);
        (ends[1] - ends[0]).max(0.0)
    };
    norm(&(0..dimension).map(range).collect::<Vec<_>>())
}
