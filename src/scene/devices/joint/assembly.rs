//! A joint on the nodes of its sides: the rows of its constraints, its coordinate, and what its multipliers say.

use nalgebra::Vector3;

use super::coordinate::{Coordinate, CoordinateKind};
use super::kind::JointKind;
use super::side::{NodalVector, Side};
use crate::base::input::{InputError, finite};
use crate::base::vector::padded;
use crate::elements::body::Body;
use crate::elements::mesh::Selection;
use crate::scene::constraint::Axis;
use crate::scene::timeline::{DeviceMultipliers, DeviceRow};

/// Distance of sides at the start, relative to their size and place, that is round-off of a file.
const APART: f64 = 1e-6;

/// A joint as it is given.
#[derive(Debug, Clone)]
pub(super) struct Geometry {
    pub(super) name: String,
    pub(super) kind: JointKind,
    pub(super) between: [Selection; 2],
    pub(super) at: Vec<f64>,
    pub(super) axis: Vec<f64>,
}

/// A joint on the nodes of its sides.
pub(super) struct Assembly {
    rows: Vec<Row>,
    pub(super) coordinate: Option<Coordinate>,
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

impl Geometry {
    fn label(&self) -> String {
        format!("joint \"{}\"", self.name)
    }

    /// The name of an input of it.
    fn input(&self, word: &str) -> String {
        format!("{word} of {}", self.label())
    }

    fn sides_in_words(&self) -> String {
        format!("{} and {}", self.between[0], self.between[1])
    }

    /// The unit vector of the axis: of a pin in the plane that out of it.
    fn direction(&self, dimension: usize) -> Result<Vector3<f64>, InputError> {
        let (input, value) = (self.input("axis"), format!("{:?}", self.axis));
        let is_pin = dimension == 2 && self.kind == JointKind::Revolute;
        if is_pin || !self.kind.moves() {
            return match self.axis.is_empty() {
                true => Ok(Vector3::z()),
                false => Err(InputError::new(input, value, "it has none: leave it out")),
            };
        }
        finite(&input, &self.axis)?;
        if self.axis.len() != dimension {
            let help = format!("it needs {dimension} components");
            return Err(InputError::new(input, value, help));
        }
        let axis = Vector3::from(padded(&self.axis)).try_normalize(0.0);
        axis.ok_or_else(|| InputError::new(input, value, "it must have a direction"))
    }

    /// Both sides, and the place.
    fn sides(&self, body: &Body) -> Result<([Side; 2], Vector3<f64>), InputError> {
        let (input, dimension) = (self.input("between"), body.dimension());
        let side = |k: usize| Side::new(body, &self.between[k], &input);
        let sides = [side(0)?, side(1)?];
        let refused = |help: &str| Err(InputError::new(&*input, self.sides_in_words(), help));
        if sides.iter().all(Side::is_world) {
            return refused("one of them must be a body: nothing moves");
        }
        if sides[0].meets(&sides[1]) {
            return refused(
                "they are of one rigid piece, or have nodes in common: join different ones",
            );
        }
        if self.kind == JointKind::Prismatic && !sides.iter().any(Side::is_world) {
            return refused("one side of a prismatic joint must be the \"world\"");
        }
        let (input, value) = (self.input("at"), format!("{:?}", self.at));
        if dimension == 1 {
            return Err(InputError::new(input, value, "nothing turns on a line: use a tie"));
        }
        if self.at.len() != dimension {
            return Err(InputError::new(
                input,
                value,
                format!("it needs {dimension} components (m)"),
            ));
        }
        finite(&input, &self.at)?;
        Ok((sides, padded(&self.at).into()))
    }

    /// The directions that the sides keep in common.
    fn common(
        &self,
        sides: &[Side; 2],
        axis: Vector3<f64>,
        dimension: usize,
    ) -> Result<Vec<Vector3<f64>>, InputError> {
        match self.kind {
            JointKind::Spherical => Ok(Vec::new()),
            JointKind::Revolute if dimension == 2 => Ok(Vec::new()),
            JointKind::Revolute => match sides.iter().all(|side| side.vector(axis).is_some()) {
                true => Ok(vec![axis]),
                false => Err(self.lacks_direction("along it")),
            },
            JointKind::Prismatic | JointKind::Fixed => {
                let is_first = sides[0].span.len() <= sides[1].span.len();
                let [few, many] = if is_first { [0, 1] } else { [1, 0] };
                let span = sides[few].span.iter().copied();
                let common: Vec<Vector3<f64>> =
                    span.filter(|way| sides[many].vector(*way).is_some()).collect();
                if common.len() + 1 >= dimension {
                    return Ok(common);
                }
                let help = "their nodes lie on a line, or in planes that differ, and do not say how they are turned: name others";
                Err(InputError::new(self.input("between"), self.sides_in_words(), help))
            }
        }
    }

    fn lacks_direction(&self, which: &str) -> InputError {
        let help = format!(
            "a side has no direction {which}: a section of a rod has those of its plane, a face of a solid those along it"
        );
        InputError::new(self.input("axis"), format!("{:?}", self.axis), help)
    }

    /// The angle from the first to the second side, about the axis.
    fn angle(
        &self,
        sides: &[Side; 2],
        axis: Vector3<f64>,
        dimension: usize,
    ) -> Result<Coordinate, InputError> {
        let of_side = |side: &Side| side.vector(axis).filter(|_| dimension == 3);
        let along = of_side(&sides[0]).or_else(|| of_side(&sides[1]));
        let along = along.unwrap_or_else(|| NodalVector::constant(axis));
        match sides.each_ref().map(|side| side.across(axis)) {
            [Some(first), Some(second)] => {
                Ok(Coordinate::new(CoordinateKind::Angle, [along, first, second], dimension))
            }
            _ => Err(self.lacks_direction("across it")),
        }
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
            JointKind::Prismatic => rows.extend(across(axis, dimension).into_iter().map(of_points)),
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
            JointKind::Spherical | JointKind::Fixed => None,
            JointKind::Revolute => Some(geometry.angle(&sides, axis, dimension)?),
            JointKind::Prismatic => {
                let [first, second] = points.clone();
                let vectors = [NodalVector::constant(axis), first, second];
                Some(Coordinate::new(CoordinateKind::Displacement, vectors, dimension))
            }
        };
        let moving = usize::from(sides[0].is_world());
        let has_axis = geometry.kind.moves() && !geometry.axis.is_empty();
        Ok(Self {
            rows,
            coordinate,
            axis: sides[moving].vector(axis).filter(|_| has_axis),
            place: points.into_iter().nth(moving).unwrap_or_else(|| NodalVector::constant(at)),
            size,
            dimension,
        })
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

/// The directions across an axis: one in the plane, two in space.
fn across(axis: Vector3<f64>, dimension: usize) -> Vec<Vector3<f64>> {
    if dimension == 2 {
        return vec![Vector3::new(-axis.y, axis.x, 0.0)];
    }
    let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    vec![first, axis.cross(&first)]
}
