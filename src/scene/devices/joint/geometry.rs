//! A joint as it is given: its sides, its place and its axes, and what follows from these: directions in common, coordinates, couplings.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::coordinate::{Coordinate, CoordinateKind};
use super::coupling::Coupling;
use super::kind::JointKind;
use super::side::{NodalVector, Side};
use crate::base::input::{InputError, finite, not_negative, positive};
use crate::base::vector::padded;
use crate::elements::body::Body;
use crate::elements::mesh::Selection;

/// Cosine below which an angle is a right one.
const RIGHT: f64 = 1e-6;

/// A joint as it is given.
#[derive(Debug, Clone)]
pub(super) struct Geometry {
    pub(super) name: String,
    pub(super) kind: JointKind,
    pub(super) between: [Selection; 2],
    pub(super) at: Vec<f64>,
    pub(super) axis: Vec<f64>,
    /// Of the second side of a universal joint.
    pub(super) second_axis: Vec<f64>,
    /// Of a screw (m).
    pub(super) lead: Option<f64>,
    /// Stiffness and damping of what holds by these.
    pub(super) bearing: Option<[f64; 2]>,
    pub(super) gear: Option<Gear>,
}

/// The coupling of the coordinate of a joint with the angle of another one.
#[derive(Debug, Clone)]
pub(super) struct Gear {
    pub(super) first: Box<Geometry>,
    pub(super) ratio: Ratio,
    /// Stiffness and damping.
    pub(super) bearing: [f64; 2],
}

/// How a gear transmits.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ratio {
    /// Teeth of the wheels of the other and of this joint; those of a ring are negative.
    Teeth([i32; 2]),
    /// Displacement (m) of this joint for a turn of the other one.
    Lead(f64),
}

impl Geometry {
    pub(super) fn label(&self) -> String {
        format!("joint \"{}\"", self.name)
    }

    /// The name of an input of it.
    pub(super) fn input(&self, word: &str) -> String {
        format!("{word} of {}", self.label())
    }

    pub(super) fn sides_in_words(&self) -> String {
        format!("{} and {}", self.between[0], self.between[1])
    }

    /// The unit vector of the axis: of a pin in the plane that out of it.
    pub(super) fn direction(&self, dimension: usize) -> Result<Vector3<f64>, InputError> {
        let (input, value) = (self.input("axis"), format!("{:?}", self.axis));
        let is_pin = dimension == 2 && self.kind == JointKind::Revolute;
        if dimension == 2 && matches!(self.kind, JointKind::Universal | JointKind::Screw) {
            let help = "it turns in space alone: in the plane a revolute joint is a pin";
            return Err(InputError::new(self.input("kind"), format!("{:?}", self.kind), help));
        }
        if is_pin || !self.kind.moves() && self.kind != JointKind::Universal {
            return match self.axis.is_empty() {
                true => Ok(Vector3::z()),
                false => Err(InputError::new(input, value, "it has none: leave it out")),
            };
        }
        unit(&input, &self.axis, dimension)
    }

    /// The stiffness and the damping of what holds by them, `of` what.
    pub(super) fn held(&self, of: &str) -> Result<[f64; 2], InputError> {
        let input = self.input("bearing_stiffness");
        let Some([stiffness, damping]) = self.bearing else {
            let help = format!(
                "{of} holds by a stiffness, as no linear row keeps it: give one that gives way by little under the loads"
            );
            return Err(InputError::new(input, "missing", help));
        };
        positive(&input, stiffness, "")?;
        not_negative(&self.input("bearing_damping"), damping, "")?;
        Ok([stiffness, damping])
    }

    /// # Errors
    /// A lead, a second axis or a stiffness that its kind does not have.
    pub(super) fn check_own(&self, sides: &[Side; 2]) -> Result<(), InputError> {
        let is = |kind: JointKind| self.kind == kind;
        let is_guide = is(JointKind::Prismatic) && !sides.iter().any(Side::is_world);
        let holds = is_guide || is(JointKind::Screw) || is(JointKind::Universal);
        for (word, is_given, has) in [
            ("lead", self.lead.is_some(), is(JointKind::Screw)),
            ("second_axis", !self.second_axis.is_empty(), is(JointKind::Universal)),
            ("bearing_stiffness", self.bearing.is_some(), holds),
        ] {
            if is_given && !has {
                let help = format!("{:?} joints have none here: leave it out", self.kind);
                return Err(InputError::new(self.input(word), "given", help));
            }
        }
        Ok(())
    }

    /// Both sides, and the place.
    pub(super) fn sides(&self, body: &Body) -> Result<([Side; 2], Vector3<f64>), InputError> {
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
        if self.kind == JointKind::Screw && !sides.iter().any(Side::is_world) {
            return refused("one side of a screw must be the \"world\"");
        }
        self.check_own(&sides)?;
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
    pub(super) fn common(
        &self,
        sides: &[Side; 2],
        axis: Vector3<f64>,
        dimension: usize,
    ) -> Result<Vec<Vector3<f64>>, InputError> {
        match self.kind {
            JointKind::Spherical | JointKind::Universal => Ok(Vec::new()),
            JointKind::Revolute if dimension == 2 => Ok(Vec::new()),
            JointKind::Revolute | JointKind::Screw => {
                match sides.iter().all(|side| side.vector(axis).is_some()) {
                    true => Ok(vec![axis]),
                    false => Err(self.lacks_direction("along it")),
                }
            }
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

    pub(super) fn lacks_direction(&self, which: &str) -> InputError {
        let help = format!(
            "a side has no direction {which}: a section of a rod has those of its plane, a face of a solid those along it"
        );
        InputError::new(self.input("axis"), format!("{:?}", self.axis), help)
    }

    /// The displacement of the second point from the first along an `axis` of the first side.
    pub(super) fn displacement(
        &self,
        sides: &[Side; 2],
        points: &[NodalVector; 2],
        axis: Vector3<f64>,
        dimension: usize,
    ) -> Result<Coordinate, InputError> {
        let [first, second] = points.clone();
        // directions of the world do not move, nor do those of the other side there
        let along = match sides.iter().any(Side::is_world) {
            true => Some(NodalVector::constant(axis)),
            false => sides[0].vector(axis),
        };
        let along = along.ok_or_else(|| self.lacks_direction("along the guide or across it"))?;
        Ok(Coordinate::new(CoordinateKind::Displacement, [along, first, second], dimension))
    }

    /// The couplings by which it holds.
    pub(super) fn couplings(
        &self,
        sides: &[Side; 2],
        points: &[NodalVector; 2],
        axis: Vector3<f64>,
        dimension: usize,
    ) -> Result<Vec<Coupling>, InputError> {
        let of = |parts, [stiffness, damping]: [f64; 2], period| Coupling {
            parts,
            stiffness,
            damping,
            period,
        };
        match self.kind {
            JointKind::Prismatic if !sides.iter().any(Side::is_world) => {
                let bearing = self.held("a guide on a body that moves")?;
                let across = across(axis, dimension).into_iter();
                let held = across.map(|across| {
                    let off = self.displacement(sides, points, across, dimension)?;
                    Ok(of(vec![(off, 1.0)], bearing, None))
                });
                held.collect()
            }
            JointKind::Screw => {
                let bearing = self.held("a thread")?;
                let input = self.input("lead");
                let Some(lead) = self.lead.filter(|lead| lead.is_finite() && *lead != 0.0) else {
                    let help = "a screw needs the displacement for a whole turn, above 0, below 0 of a left-handed thread";
                    return Err(InputError::new(input, format!("{:?}", self.lead), help));
                };
                let along = self.displacement(sides, points, axis, dimension)?;
                let angle = self.angle(sides, axis, dimension)?;
                let parts = vec![(along, 1.0), (angle, -lead / TAU)];
                Ok(vec![of(parts, bearing, Some(lead.abs()))])
            }
            JointKind::Universal => {
                let bearing = self.held("the cross of a universal joint")?;
                let input = self.input("second_axis");
                let second = unit(&input, &self.second_axis, dimension)?;
                if axis.dot(&second).abs() > RIGHT {
                    let value = format!("{:?}", self.second_axis);
                    let help = "both axes of a cross are at a right angle in the undeformed shape";
                    return Err(InputError::new(input, value, help));
                }
                let vectors = (sides[0].vector(axis), sides[1].vector(second));
                let (Some(first), Some(second)) = vectors else {
                    return Err(self.lacks_direction("along its own"));
                };
                let unused = NodalVector::constant(Vector3::zeros());
                let slant =
                    Coordinate::new(CoordinateKind::Slant, [first, second, unused], dimension);
                Ok(vec![of(vec![(slant, 1.0)], bearing, None)])
            }
            _ => Ok(Vec::new()),
        }
    }

    /// The angle from the first to the second side, about the axis.
    pub(super) fn angle(
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

/// The unit vector along `given` components.
///
/// # Errors
/// Another number of components than the `dimension`, none that has a direction.
fn unit(input: &str, given: &[f64], dimension: usize) -> Result<Vector3<f64>, InputError> {
    let value = format!("{given:?}");
    finite(input, given)?;
    if given.len() != dimension {
        return Err(InputError::new(input, value, format!("it needs {dimension} components")));
    }
    let unit = Vector3::from(padded(given)).try_normalize(0.0);
    unit.ok_or_else(|| InputError::new(input, value, "it must have a direction"))
}

/// The directions across an axis: one in the plane, two in space.
pub(super) fn across(axis: Vector3<f64>, dimension: usize) -> Vec<Vector3<f64>> {
    if dimension == 2 {
        return vec![Vector3::new(-axis.y, axis.x, 0.0)];
    }
    let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    vec![first, axis.cross(&first)]
}
