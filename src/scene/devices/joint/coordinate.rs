//! The coordinate of a joint: the angle or the displacement between its sides, with its derivatives.
//!
//! It is a function of three vectors z = (x, y, z) that move with nodes. The angle between reference vectors b of the first side and c of the
//! second, about an axis a of one of them, is
//!
//! ```text
//! q = atan2(s, t),   s = a . (b x c),   t = b . c,
//! ```
//!
//! the displacement of a point p_2 of the second side along an axis a from a point p_1 of the first is q = a . (p_2 - p_1), and the sine of what is missing
//! to a right angle between an axis a of the first and b of the second is q = a . b. A force Q on the
//! coordinate acts on nodes by Q dq/du, which does the work Q dq and, as q does not change as all turns together, has no resultant.

use std::f64::consts::{PI, TAU};

use nalgebra::{SMatrix, SVector, Vector3};

use super::side::NodalVector;
use crate::base::sparse::BlockMatrix;

/// Which coordinate it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CoordinateKind {
    /// Of the vectors a, b, c.
    Angle,
    /// Of the vectors a, p_1, p_2.
    Displacement,
    /// Of the unit vectors a and b; the third is not used.
    Slant,
}

type Nine = SVector<f64, 9>;
type Square = SMatrix<f64, 9, 9>;

/// The coordinate of a joint.
#[derive(Debug, Clone)]
pub(super) struct Coordinate {
    kind: CoordinateKind,
    vectors: [NodalVector; 3],
    /// Nodes (from 0), each with its coefficients in the three vectors.
    nodes: Vec<(usize, [f64; 3])>,
    dimension: usize,
    /// The angle of the undeformed shape (rad).
    natural: f64,
}

/// The coordinate in a state.
pub(super) struct At {
    /// q (rad or m), 0 in the undeformed shape, an angle from -pi to pi.
    pub(super) value: f64,
    /// Its rate (rad/s or m/s).
    pub(super) rate: f64,
    /// Its derivatives by the three vectors, the second ones where they were asked for.
    gradient: Nine,
    hessian: Option<Square>,
    /// The rates of the vectors.
    rates: Nine,
}

impl Coordinate {
    pub(super) fn new(kind: CoordinateKind, vectors: [NodalVector; 3], dimension: usize) -> Self {
        let mut nodes: Vec<(usize, [f64; 3])> = Vec::new();
        for (k, vector) in vectors.iter().enumerate() {
            for &(node, c) in &vector.terms {
                match nodes.iter_mut().find(|(known, _)| *known == node) {
                    Some((_, own)) => own[k] += c,
                    None => nodes.push((node, std::array::from_fn(|i| f64::from(i == k) * c))),
                }
            }
        }
        let mut coordinate = Self { kind, vectors, nodes, dimension, natural: 0.0 };
        if kind == CoordinateKind::Angle {
            let [a, b, c] = coordinate.vectors.each_ref().map(|vector| vector.natural);
            coordinate.natural = a.dot(&b.cross(&c)).atan2(b.dot(&c));
        }
        coordinate
    }

    /// Nodes (from 0) that it depends on.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + Clone {
        self.nodes.iter().map(|(node, _)| *node)
    }

    /// `difference` of two coordinates: of angles without whole turns, from -pi to pi.
    pub(super) fn wrapped(&self, difference: f64) -> f64 {
        match self.kind {
            CoordinateKind::Angle => difference - TAU * (difference / TAU).round(),
            CoordinateKind::Displacement | CoordinateKind::Slant => difference,
        }
    }

    /// The coordinate at the displacements `u` (m) and velocities `v` (m/s), with second derivatives if they are `wanted`.
    pub(super) fn at(&self, u: &[f64], v: &[f64], wanted: bool) -> At {
        let [x, y, z] = self.vectors.each_ref().map(|vector| vector.at(u, self.dimension));
        let rates = self.vectors.each_ref().map(|vector| vector.change(v, self.dimension));
        let rates = joined(rates);
        let (value, gradient, hessian) = match self.kind {
            CoordinateKind::Angle => angle([x, y, z], self.natural, wanted),
            CoordinateKind::Displacement => {
                let hessian = wanted.then(|| {
                    let mut hessian = Square::zeros();
                    for i in 0..3 {
                        (hessian[(i, 3 + i)], hessian[(3 + i, i)]) = (-1.0, -1.0);
                        (hessian[(i, 6 + i)], hessian[(6 + i, i)]) = (1.0, 1.0);
                    }
                    hessian
                });
                (x.dot(&(z - y)), joined([z - y, -x, x]), hessian)
            }
            CoordinateKind::Slant => {
                let hessian = wanted.then(|| {
                    let mut hessian = Square::zeros();
                    for i in 0..3 {
                        (hessian[(i, 3 + i)], hessian[(3 + i, i)]) = (1.0, 1.0);
                    }
                    hessian
                });
                (x.dot(&y), joined([y, x, Vector3::zeros()]), hessian)
            }
        };
        At { value, rate: gradient.dot(&rates), gradient, hessian, rates }
    }

    /// Adds the nodal forces of a force Q on it to `forces`.
    pub(super) fn add_forces(&self, at: &At, q: f64, forces: &mut [f64]) {
        let d = self.dimension;
        for (node, c) in &self.nodes {
            for (axis, force) in forces[node * d..][..d].iter_mut().enumerate() {
                let along: f64 = (0..3).map(|k| c[k] * at.gradient[3 * k + axis]).sum();
                *force += q * along;
            }
        }
    }

    /// Adds the tangents of a force `q` on it with the derivatives `[by_value, by_rate]`.
    pub(super) fn add_tangents(
        &self,
        at: &At,
        (q, [by_value, by_rate]): (f64, [f64; 2]),
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (g, hessian) = (&at.gradient, at.hessian.unwrap_or_else(Square::zeros));
        let square = g * g.transpose();
        let turned = g * (hessian * at.rates).transpose();
        self.spread(self, &-(square * by_value + turned * by_rate + hessian * q), stiffness);
        self.spread(self, &-(square * by_rate), damping);
    }

    /// Adds the tangents of a force on it by another coordinate, with the slopes -dQ/dq and -dQ/dq' of that.
    pub(super) fn add_shared_tangents(
        &self,
        at: &At,
        (other, of_other): (&Self, &At),
        [by_value, by_rate]: [f64; 2],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let square = at.gradient * of_other.gradient.transpose();
        let hessian = of_other.hessian.unwrap_or_else(Square::zeros);
        let turned = at.gradient * (hessian * of_other.rates).transpose();
        self.spread(other, &(square * by_value + turned * by_rate), stiffness);
        self.spread(other, &(square * by_rate), damping);
    }

    /// Adds a matrix over its three vectors, and those of another one or itself, to that of the nodes.
    fn spread(&self, columns: &Self, matrix: &Square, to: &mut BlockMatrix) {
        let d = self.dimension;
        for (row, of_row) in &self.nodes {
            for (column, of_column) in &columns.nodes {
                let Some(block) = to.block_mut(*row, *column) else { continue };
                for (place, entry) in block.iter_mut().enumerate() {
                    let [i, j] = [place / d, place % d];
                    for (k, a) in of_row.iter().enumerate() {
                        for (l, b) in of_column.iter().enumerate() {
                            *entry += a * b * matrix[(3 * k + i, 3 * l + j)];
                        }
                    }
                }
            }
        }
    }
}

fn joined(vectors: [Vector3<f64>; 3]) -> Nine {
    Nine::from_fn(|i, _| vectors[i / 3][i % 3])
}

/// The angle about a from b to c less the `natural` one, from -pi to pi, with its derivatives.
fn angle([a, b, c]: [Vector3<f64>; 3], natural: f64, wanted: bool) -> (f64, Nine, Option<Square>) {
    let (s, t) = (a.dot(&b.cross(&c)), b.dot(&c));
    let ds = joined([b.cross(&c), c.cross(&a), a.cross(&b)]);
    let dt = joined([Vector3::zeros(), c, b]);
    let square = s * s + t * t;
    let numerator = t * ds - s * dt;
    let mut value = s.atan2(t) - natural;
    value -= TAU * (value / TAU).round();
    debug_assert!(value.abs() <= PI + 1e-12 || value.is_nan());
    let hessian = wanted.then(|| {
        let mut numerators = ds * dt.transpose() - dt * ds.transpose();
        let crosses = [a, b, c].map(|vector| vector.cross_matrix());
        for (row, column, of, sign) in
            [(0, 1, 2, -t), (0, 2, 1, t), (1, 0, 2, t), (1, 2, 0, -t), (2, 0, 1, -t), (2, 1, 0, t)]
        {
            let mut block = numerators.fixed_view_mut::<3, 3>(3 * row, 3 * column);
            block += crosses[of] * sign;
            if row + column == 3 {
                (0..3).for_each(|i| block[(i, i)] -= s);
            }
        }
        let of_square = 2.0 * (s * ds + t * dt);
        numerators / square - numerator * of_square.transpose() / (square * square)
    });
    (value, numerator / square, hessian)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First and second derivatives of all coordinates against central differences: off by h^2 times derivatives of order 1, and round-off over h.
    #[test]
    fn derivatives_are_those_of_differences() {
        let place = [0.3, -0.2, 0.9, 0.8, 0.4, -0.1, -0.5, 0.7, 0.2];
        for kind in [CoordinateKind::Angle, CoordinateKind::Displacement, CoordinateKind::Slant] {
            let vectors = std::array::from_fn(|k| NodalVector {
                natural: Vector3::new(place[3 * k], place[3 * k + 1], place[3 * k + 2]),
                terms: vec![(k, 1.0)],
            });
            let coordinate = Coordinate::new(kind, vectors, 3);
            let h = 1e-5;
            let at = |moved: Option<(usize, f64)>| {
                let mut u = [0.0; 9];
                moved.into_iter().for_each(|(i, by)| u[i] += by);
                coordinate.at(&u, &[0.0; 9], true)
            };
            let here = at(None);
            for i in 0..9 {
                let (up, down) = (at(Some((i, h))), at(Some((i, -h))));
                let slope = (up.value - down.value) / (2.0 * h);
                assert!((slope - here.gradient[i]).abs() < 1e-9, "{kind:?} {i}: {slope}");
                let slopes = (up.gradient - down.gradient) / (2.0 * h);
                let off = (slopes - here.hessian.unwrap().column(i)).norm();
                assert!(off < 1e-8, "{kind:?} {i}: {off}");
            }
        }
    }
}
