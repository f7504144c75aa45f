//! A joint on the nodes of its sides: the rows of its constraints, its coordinate, and what its multipliers say.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::coordinate::Coordinate;
use super::coupling::Coupling;
use super::geometry::{Gear, Geometry, Ratio, across};
use super::kind::JointKind;
use super::side::{NodalVector, Side};
use crate::base::input::{InputError, not_negative, positive};
use crate::elements::body::Body;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{DeviceMultipliers, DeviceRow};

/// Distance of sides at the start, relative to their size and place, that is round-off of a file.
const APART: f64 = 1e-6;

/// A joint on the nodes of its sides.
pub(super) struct Assembly {
    rows: Vec<Row>,
    pub(super) coordinate: Option<Coordinate>,
    pub(super) couplings: Vec<Coupling>,
    /// Its place, on a side that moves, and its axis, if it has one there.
    pub(super) place: NodalVector,
    pub(super) axis: Option<NodalVector>,
    /// The size of the smaller side (m).
    pub(super) size: f64,
    dimension: usize,
}

/// A row: one component of the difference of a point, or of a vector, of both sides.
struct Row {
    /// The point or vector of the first side and of the second one.
    ends: [NodalVector; 2],
    direction: Vector3<f64>,
    is_of_vector: bool,
}

impl Row {
    /// c . u = 0.
    fn terms(&self, dimension: usize) -> DeviceRow {
        let [first, second] = &self.ends;
        let mut nodes: Vec<(usize, f64)> = first.terms.clone();
        nodes.extend(second.terms.iter().map(|&(node, c)| (node, -c)));
        let mut terms = DeviceRow::new();
        for (node, c) in nodes {
            for &axis in Axis::all(dimension) {
                let part = self.direction[axis.index()];
                if part.abs() > f64::EPSILON {
                    terms.push((node + 1, axis, c * part));
                }
            }
        }
        terms
    }

    /// How far the sides are apart along it (m).
    fn gap(&self, u: &[f64], dimension: usize) -> f64 {
        let [first, second] = self.ends.each_ref().map(|end| end.change(u, dimension));
        self.direction.dot(&(first - second))
    }
}

impl Assembly {
    /// # Errors
    /// Nodes that do not exist, sides that are the same or both of them the world, a place or an axis that a side does not have.
    pub(super) fn new(geometry: &Geometry, body: &Body) -> Result<Self, InputError> {
        body.refuse_around(&geometry.label(), "given")?;
        let dimension = body.dimension();
        let (sides, at) = geometry.sides(body)?;
        let axis = geometry.direction(dimension)?;
        let input = geometry.input("at");
        let points = [sides[0].point(at, &input)?, sides[1].point(at, &input)?];
        let size = sides[0].size.min(sides[1].size);
        let ways = || (0..dimension).map(|i| Vector3::ith(i, 1.0));
        let mut rows = Vec::new();
        let of_points =
            |direction: Vector3<f64>| Row { ends: points.clone(), direction, is_of_vector: false };
        match geometry.kind {
            JointKind::Prismatic if !sides.iter().any(Side::is_world) => {}
            JointKind::Prismatic | JointKind::Screw => {
                rows.extend(across(axis, dimension).into_iter().map(of_points));
            }
            _ => rows.extend(ways().map(of_points)),
        }
        for common in geometry.common(&sides, axis, dimension)? {
            let pair = sides.each_ref().map(|side| side.vector(common * size));
            let [Some(first), Some(second)] = pair else { continue };
            rows.extend(ways().map(|direction| Row {
                ends: [first.clone(), second.clone()],
                direction,
                is_of_vector: true,
            }));
        }
        let coordinate = match geometry.kind {
            JointKind::Spherical | JointKind::Fixed | JointKind::Universal => None,
            JointKind::Revolute | JointKind::Screw => {
                Some(geometry.angle(&sides, axis, dimension)?)
            }
            JointKind::Prismatic => Some(geometry.displacement(&sides, &points, axis, dimension)?),
        };
        let mut couplings = geometry.couplings(&sides, &points, axis, dimension)?;
        if let Some(gear) = &geometry.gear {
            couplings.push(Self::geared(geometry, gear, coordinate.as_ref(), body)?);
        }
        let moving = usize::from(sides[0].is_world());
        let has_axis = !geometry.axis.is_empty();
        Ok(Self {
            rows,
            coordinate,
            couplings,
            axis: sides[moving].vector(axis).filter(|_| has_axis),
            place: points.into_iter().nth(moving).unwrap_or_else(|| NodalVector::constant(at)),
            size,
            dimension,
        })
    }

    /// The coupling of its `coordinate` with the angle of another joint.
    fn geared(
        geometry: &Geometry,
        gear: &Gear,
        coordinate: Option<&Coordinate>,
        body: &Body,
    ) -> Result<Coupling, InputError> {
        let input = |word: &str| format!("{}: {word} of its gear", geometry.label());
        let refused =
            |word: &str, value: String, help: &str| Err(InputError::new(input(word), value, help));
        let first =
            Assembly::new(&gear.first, body)?.coordinate.filter(|_| gear.first.kind.turns());
        let (Some(first), Some(own)) = (first, coordinate) else {
            let value = format!("of {} and {}", gear.first.label(), geometry.label());
            return refused(
                "joint",
                value,
                "it couples a revolute joint with one that turns or slides",
            );
        };
        let [stiffness, damping] = gear.bearing;
        positive(&input("stiffness"), stiffness, "")?;
        not_negative(&input("damping"), damping, "")?;
        let (share, period) = match gear.ratio {
            Ratio::Teeth([a, b]) if a != 0 && b != 0 && geometry.kind.turns() => {
                (f64::from(a) / f64::from(b), TAU / f64::from(b).abs())
            }
            Ratio::Teeth(teeth) => {
                return refused(
                    "teeth",
                    format!("{teeth:?}"),
                    "both wheels need teeth, and both joints an angle: a slider has a lead",
                );
            }
            Ratio::Lead(lead) if lead.is_finite() && lead != 0.0 && !geometry.kind.turns() => {
                (-lead / TAU, lead.abs())
            }
            Ratio::Lead(lead) => {
                return refused(
                    "lead",
                    format!("{lead} m"),
                    "a slider needs the displacement for a turn, not 0: two angles are coupled by teeth",
                );
            }
        };
        let parts = vec![(own.clone(), 1.0), (first, share)];
        Ok(Coupling { parts, stiffness, damping, period: Some(period) })
    }

    /// The rows of its constraints.
    pub(super) fn rows(&self) -> Vec<DeviceRow> {
        self.rows.iter().map(|row| row.terms(self.dimension)).collect()
    }

    /// Whether the sides are together under the displacements `u` (m).
    ///
    /// # Errors
    /// Sides that are apart.
    pub(super) fn check_together(&self, geometry: &Geometry, u: &[f64]) -> Result<(), InputError> {
        let gaps = self.rows.iter().map(|row| row.gap(u, self.dimension).abs());
        let apart = gaps.fold(0.0, f64::max);
        if apart <= APART * (self.size + self.place.natural.norm()) {
            return Ok(());
        }
        let help = "the initial displacements take them apart or turn them out of the joint: move both alike";
        Err(InputError::new(
            geometry.input("between"),
            format!("{apart:.3e} m apart at the start"),
            help,
        ))
    }

    /// The force (N) on the second side, and the moment (N m) about the place of the joint, of the rows with these multipliers (N), under the
    /// displacements `u` (m).
    pub(super) fn reaction(
        &self,
        multipliers: DeviceMultipliers<'_>,
        u: &[f64],
    ) -> [Vector3<f64>; 2] {
        let [mut force, mut moment] = [Vector3::zeros(); 2];
        for (row, multiplier) in self.rows.iter().zip(multipliers.iter()) {
            let part = -multiplier * row.direction;
            match row.is_of_vector {
                true => moment += row.ends[0].at(u, self.dimension).cross(&part),
                false => force += part,
            }
        }
        [force, moment]
    }
}
