//! Moments on nodes, and forces and moments that turn with them.
//!
//! Nodes with the weights w_i (of sum 1: the shares of a total load) at r_i from their centre c = sum w_i x_i have the spread
//! T = sum w_i (|r_i|^2 I - r_i r_i^T). A force F and a moment M about the centre are equivalent to
//!
//! ```text
//! f_i = w_i (F + a x r_i),   T a = M,
//! ```
//!
//! whose power is F . c' + M . omega, with the mean velocity c' and the angular velocity omega = T^-1 sum w_i r_i x x_i' of the rigid
//! motion nearest to that of the nodes. So nodes are loaded, and not stiffened. A follower turns with the rotation that brings the
//! undeformed nodes nearest to the present ones.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::faces::shares;
use super::section_wrench::SectionWrench;
use super::signal::VectorSignal;
use super::wrench_kind::WrenchKind;
use crate::base::input::InputError;
use crate::base::rotation::nearest_rotation;
use crate::base::sparse::BlockMatrix;
use crate::elements::body::Body;
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;

/// A moment on nodes, or a force or a moment that follows them.
pub(crate) struct WrenchForce {
    kind: WrenchKind,
    points: Vec<Point>,
    /// The centre of their undeformed positions (m).
    centre: Vector3<f64>,
    dimension: usize,
    value: VectorSignal,
}

/// A node that is loaded.
struct Point {
    /// Its number, counted from 0.
    node: usize,
    weight: f64,
    /// Undeformed position (m).
    natural: Vector3<f64>,
}

/// The nodes in a state: positions around the centre (m), and the inverse of the spread T (m^-2).
struct Spread<'a> {
    force: &'a WrenchForce,
    u: &'a [f64],
    centre: Vector3<f64>,
    inverse: Matrix3<f64>,
}

/// The force and a = T^-1 M of a state, with the moment.
struct Acting {
    force: Vector3<f64>,
    moment: Vector3<f64>,
    a: Vector3<f64>,
}

/// Spreads of nodes whose least inertia is a smaller part of the largest are those of a point, in space of a line.
const THIN: f64 = 1e-8;

impl WrenchForce {
    /// The force of a `value` on the nodes that `selection` names.
    ///
    /// # Errors
    /// A body on a line or of revolution; nodes that do not exist, in one point or, in space, on one line; a value with another number of
    /// components.
    pub(crate) fn build(
        body: &Body,
        kind: WrenchKind,
        selection: &Selection,
        value: &VectorSignal,
    ) -> Result<Arc<dyn Force>, InputError> {
        let (what, unit) = match kind {
            WrenchKind::Moment => ("moment", "N m"),
            WrenchKind::FollowerForce => ("follower force", "N"),
            WrenchKind::FollowerMoment => ("follower moment", "N m"),
        };
        let dimension = body.dimension();
        body.refuse_around(what, "given")?;
        let refused = |help: &str| Err(InputError::new(format!("{what} nodes"), selection, help));
        if dimension == 1 {
            return refused("nodes on a line do not turn: give a load");
        }
        value.validate(what, kind.rank(dimension), unit)?;
        let nodes = body.mesh().select(selection)?;
        if let Some(sections) = body.sections_at(&nodes) {
            return Ok(SectionWrench::build(kind, sections, dimension, value));
        }
        let weighed = nodes.iter().zip(shares(body, &nodes));
        let points: Vec<Point> = weighed
            .map(|(&node, weight)| {
                let x = body.mesh().position(node);
                let natural = Vector3::from_fn(|i, _| x.get(i).copied().unwrap_or(0.0));
                Point { node, weight, natural }
            })
            .collect();
        let centre = points.iter().map(|point| point.weight * point.natural).sum();
        let wrench = Self { kind, points, centre, dimension, value: value.clone() };
        let spread = wrench.spread_matrix(&vec![0.0; body.dofs()], centre);
        let [least, most] = match dimension {
            2 => [spread.m33, body.size().powi(2)],
            _ => {
                let inertia = spread.symmetric_eigenvalues();
                [inertia.min(), inertia.max()]
            }
        };
        if least > THIN * most {
            return Ok(Arc::new(wrench));
        }
        match dimension {
            2 => refused("they lie in one point, which does not turn: name several"),
            _ => refused("they lie on one line, about which they do not turn: name more"),
        }
    }

    /// The position (m) of a node.
    fn at(&self, u: &[f64], point: &Point) -> Vector3<f64> {
        let moved = &u[point.node * self.dimension..][..self.dimension];
        point.natural + Vector3::from_fn(|i, _| moved.get(i).copied().unwrap_or(0.0))
    }

    fn spread_matrix(&self, u: &[f64], centre: Vector3<f64>) -> Matrix3<f64> {
        let mut spread = Matrix3::zeros();
        for point in &self.points {
            let r = self.at(u, point) - centre;
            spread += point.weight * (Matrix3::identity() * r.norm_squared() - r * r.transpose());
        }
        spread
    }

    fn spread<'a>(&'a self, u: &'a [f64]) -> Result<Spread<'a>, Failure> {
        let centre = self.points.iter().map(|p| p.weight * self.at(u, p)).sum();
        let matrix = self.spread_matrix(u, centre);
        let inverse = match self.dimension {
            // nothing turns out of the plane
            2 => Some(Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0 / matrix.m33))),
            _ => matrix.try_inverse(),
        };
        let inverse = inverse.filter(|inverse| inverse.iter().all(|x| x.is_finite()));
        let inverse = inverse.ok_or_else(|| {
            Failure::Recoverable(
                "nodes with a moment or a follower have come to lie on one line".into(),
            )
        })?;
        Ok(Spread { force: self, u, centre, inverse })
    }

    /// The rotation R of the nodes, and P^-1, by which it changes (see [`add_tangents`](Force::add_tangents)).
    fn turn(&self, spread: &Spread) -> (Matrix3<f64>, Matrix3<f64>) {
        let rotation = self.rotation(spread);
        let mut stretch = Matrix3::zeros();
        for point in &self.points {
            let natural = rotation * (point.natural - self.centre);
            let r = spread.around(point);
            stretch +=
                point.weight * (Matrix3::identity() * r.dot(&natural) - r * natural.transpose());
        }
        let inverse = match self.dimension {
            2 => Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0 / stretch.m33)),
            // nodes that are pressed flat turn in any way
            _ => stretch.try_inverse().unwrap_or(spread.inverse),
        };
        (rotation, inverse)
    }

    /// The rotation of the nodes from their undeformed positions.
    fn rotation(&self, spread: &Spread) -> Matrix3<f64> {
        let mut correlation = Matrix3::zeros();
        for point in &self.points {
            let natural = point.natural - self.centre;
            correlation += point.weight * spread.around(point) * natural.transpose();
        }
        if self.dimension == 2 {
            let along = correlation.m11 + correlation.m22;
            let across = correlation.m21 - correlation.m12;
            return *nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), across.atan2(along))
                .matrix();
        }
        nearest_rotation(correlation)
    }

    fn acting(&self, t: f64, spread: &Spread) -> Result<Acting, Failure> {
        let given = self.kind.at(&self.value, self.dimension, t)?;
        let [force, moment] = match self.kind.follows() {
            true => {
                let rotation = self.rotation(spread);
                given.map(|vector| rotation * vector)
            }
            false => given,
        };
        Ok(Acting { force, moment, a: spread.inverse * moment })
    }
}

impl Spread<'_> {
    /// The position of a node around the centre (m).
    fn around(&self, point: &Point) -> Vector3<f64> {
        self.force.at(self.u, point) - self.centre
    }
}

impl Force for WrenchForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let spread = self.spread(u)?;
        let Acting { force, a, .. } = self.acting(t, &spread)?;
        for point in &self.points {
            let nodal = point.weight * (force + a.cross(&spread.around(point)));
            let own = &mut forces.applied[point.node * self.dimension..][..self.dimension];
            own.iter_mut().zip(nodal.iter()).for_each(|(f, part)| *f += part);
        }
        Ok(())
    }

    /// With the matrices [x] of cross products, and da = T^-1 (dM - dT a),
    ///
    /// ```text
    /// df_i/du_j = w_i ([a] (delta_ij - w_j) + w_j [r_i] T^-1 (2 a r_j^T - (r_j . a) I - r_j a^T)),
    /// ```
    ///
    /// and of a follower, whose nodes turn by P^-1 sum w_j p_j x du_j with their undeformed places turned, p_j = R r_j(0), and
    /// P = sum w_j ((r_j . p_j) I - r_j p_j^T), -w_i w_j [F] P^-1 [p_j] for the force and w_i w_j [r_i] T^-1 [M] P^-1 [p_j] for the moment.
    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        // the forces refuse such a state
        let Ok(spread) = self.spread(u) else { return Tangents::Added };
        let Ok(Acting { force, moment, a }) = self.acting(t, &spread) else {
            return Tangents::Added;
        };
        let (d, inverse) = (self.dimension, spread.inverse);
        let turning = a.cross_matrix();
        let (force, moment) = (force.cross_matrix(), moment.cross_matrix());
        let turn = self.kind.follows().then(|| self.turn(&spread));
        for column in &self.points {
            let r = spread.around(column);
            let mut by_spread = inverse
                * (2.0 * a * r.transpose() - Matrix3::identity() * r.dot(&a) - r * a.transpose());
            let mut by_force = Matrix3::zeros();
            if let Some((rotation, inverse_stretch)) = &turn {
                let natural = rotation * (column.natural - self.centre);
                let turned = inverse_stretch * natural.cross_matrix();
                by_spread += inverse * moment * turned;
                by_force = force * turned;
            }
            for row in &self.points {
                let Some(block) = stiffness.block_mut(row.node, column.node) else { continue };
                let own = if row.node == column.node { 1.0 } else { 0.0 };
                let arm = spread.around(row).cross_matrix();
                let change =
                    turning * (own - column.weight) + column.weight * (arm * by_spread - by_force);
                for (i, line) in block.chunks_mut(d).enumerate() {
                    let along = line.iter_mut().enumerate();
                    along.for_each(|(k, x)| *x -= row.weight * change[(i, k)]);
                }
            }
        }
        Tangents::Added
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.points.iter().map(|point| point.node).collect())
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        let pairs = |(k, point): (usize, &Point)| {
            let before = self.points[..k].iter();
            before.map(|other| [other.node, point.node]).collect::<Vec<_>>()
        };
        self.points.iter().enumerate().flat_map(pairs).collect()
    }
}
