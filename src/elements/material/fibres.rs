//! Fibres in a material, and their directions.
//!
//! Fibres take tension alone. The constant K contains them as if they were in tension, which is the stiffer
//! case.

use crate::base::input::{InputError, finite, not_negative, positive};
use crate::base::vector::{dot, norm};

/// A family of fibres that stiffens the material in its direction.
///
/// With the stretch l of a fibre and E = (l^2 - 1) / 2 it adds the strain energy per natural volume
///
/// ```text
/// W = (young / (8 k2)) (exp(4 k2 E^2) - 1) if l > 1, else 0
/// ```
///
/// k2 is `stiffening`; if that is 0, W is young E^2 / 2. Fibres take tension, and buckle under compression
/// (G. A. Holzapfel, T. C. Gasser, R. W. Ogden, Journal of Elasticity 61 (2000) 1-48, with k1 = young / 4).
/// In its undeformed shape a body is as stiff as with stretched fibres. The stress of fields is that of the
/// material between fibres.
///
/// ```
/// use pliant::{Body, Fibres, Law, Material, Mesh, SolidCells};
///
/// // a finger wound with threads around its axis: under pressure it grows longer, not thicker
/// let silicone = Material { density: 1070.0, young: 2.6e5, poisson: 0.49, viscosity: 200.0 };
/// let threads = Fibres::around([0.0, 0.015, 0.015], [1.0, 0.0, 0.0], 2e7).pitch(0.05);
/// let mesh = Mesh::cuboid([0.1, 0.03, 0.03], [5, 3, 3], SolidCells::Hexahedra20)?;
/// let body = Body::new(mesh, silicone.law(Law::NeoHookean).fibres(threads)).build()?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Fibres {
    /// Their direction.
    pub course: FibreDirection,
    /// Young's modulus (Pa, above 0) that they add in their direction when they are slightly stretched: that
    /// of a fibre, times its share of the section.
    pub young: f64,
    /// k2 (1, 0 or above): how fast they stiffen.
    pub stiffening: f64,
}

/// Direction of fibres in the undeformed shape.
#[derive(Debug, Clone, PartialEq)]
pub enum FibreDirection {
    /// Along this vector, of any length above 0. In membranes only its component along them counts.
    Along(Vec<f64>),
    /// Around an axis.
    Around {
        /// A point of the axis (m).
        centre: Vec<f64>,
        /// Its direction, of any length above 0; empty in the plane, where it is normal to it.
        axis: Vec<f64>,
        /// Angle (rad) by which they climb along the axis: 0 are rings, others helices.
        pitch: f64,
    },
}

impl Fibres {
    /// Fibres along a `direction` with Young's modulus `young` (Pa).
    pub fn along(direction: impl Into<Vec<f64>>, young: f64) -> Self {
        Self { course: FibreDirection::Along(direction.into()), young, stiffening: 0.0 }
    }

    /// Rings around the axis through `centre` (m), in the direction of `axis`, with Young's modulus `young`
    /// (Pa).
    pub fn around(centre: impl Into<Vec<f64>>, axis: impl Into<Vec<f64>>, young: f64) -> Self {
        let course = FibreDirection::around(centre.into(), axis.into());
        Self { course, young, stiffening: 0.0 }
    }

    /// The same as helices, which climb along the axis by the angle `pitch` (rad); fibres along a vector do
    /// not change.
    pub fn pitch(self, angle: f64) -> Self {
        Self { course: self.course.with_pitch(angle), ..self }
    }

    /// The same, stiffening as they stretch with k2 = `stiffening` (1).
    pub fn stiffening(self, stiffening: f64) -> Self {
        Self { stiffening, ..self }
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("fibres.young", self.young, "Pa")?;
        not_negative("fibres.stiffening", self.stiffening, "")?;
        self.course.validate()
    }
}

impl FibreDirection {
    /// Checks that need no body.
    pub(crate) fn validate(&self) -> Result<(), InputError> {
        match self {
            Self::Along(direction) => has_length("fibres.along", direction),
            Self::Around { centre, axis, pitch } => {
                finite("fibres.centre", centre)?;
                finite("fibres.pitch", &[*pitch])?;
                match axis.is_empty() {
                    true => Ok(()),
                    false => has_length("fibres.axis", axis),
                }
            }
        }
    }

    /// Rings around the axis through `centre` (m), in the direction of `axis`.
    pub(crate) fn around(centre: Vec<f64>, axis: Vec<f64>) -> Self {
        Self::Around { centre, axis, pitch: 0.0 }
    }

    /// Its mirror image in the plane at a place (m) on an axis.
    pub(crate) fn mirrored(&self, axis: usize, at: f64) -> Self {
        let turned = |vector: &[f64], twice: f64| {
            let image = |(i, x): (usize, &f64)| if i == axis { twice - x } else { *x };
            vector.iter().enumerate().map(image).collect::<Vec<f64>>()
        };
        match self {
            Self::Along(direction) => Self::Along(turned(direction, 0.0)),
            Self::Around { centre, axis, pitch } => Self::Around {
                centre: turned(centre, 2.0 * at),
                axis: turned(axis, 0.0),
                pitch: -pitch,
            },
        }
    }

    /// Numbers that two courses have in common if they are the same: fibres have no sense of direction.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let (direction, mut numbers) = match self {
            Self::Along(direction) => (direction, Vec::new()),
            Self::Around { centre, axis, pitch } => {
                // every point of the axis will do
                let along = dot(centre, axis) / dot(axis, axis).max(f64::MIN_POSITIVE);
                let beside = |(i, x): (usize, &f64)| x - along * axis.get(i).unwrap_or(&0.0);
                (axis, centre.iter().enumerate().map(beside).chain([*pitch]).collect())
            }
        };
        let square = dot(direction, direction);
        let products = |a: &f64| direction.iter().map(move |b| a * b / square).collect::<Vec<_>>();
        numbers.extend(direction.iter().flat_map(products));
        numbers
    }

    /// The same as helices, which climb along the axis by an `angle` (rad); fibres along a vector do not change.
    pub(crate) fn with_pitch(mut self, angle: f64) -> Self {
        if let Self::Around { pitch, .. } = &mut self {
            *pitch = angle;
        }
        self
    }

    /// Checks that its vectors are those of a space of `dimension`.
    pub(crate) fn validate_in(&self, dimension: usize) -> Result<(), InputError> {
        let is = |name: &str, vector: &[f64], expected: usize| match vector.len() == expected {
            true => Ok(()),
            false => {
                let help =
                    format!("it needs {expected} numbers in a body of {dimension} dimensions");
                Err(InputError::new(name, format!("{vector:?}"), help))
            }
        };
        match self {
            Self::Along(direction) => is("fibres.along", direction, dimension),
            Self::Around { centre, .. } if dimension == 1 => Err(InputError::new(
                "fibres.centre",
                format!("{centre:?}"),
                "a line has no way around",
            )),
            Self::Around { centre, axis, pitch } => {
                is("fibres.centre", centre, dimension)?;
                is("fibres.axis", axis, if dimension == 3 { 3 } else { 0 })?;
                match dimension == 2 && *pitch != 0.0 {
                    true => Err(InputError::new(
                        "fibres.pitch",
                        pitch,
                        "a plane body has rings alone: leave it out",
                    )),
                    false => Ok(()),
                }
            }
        }
    }

    /// The vector along them at a `position` (m), of some length; 0 on their axis.
    pub(crate) fn at(&self, position: &[f64]) -> Vec<f64> {
        match self {
            Self::Along(direction) => {
                let length = norm(direction);
                direction.iter().map(|x| x / length).collect()
            }
            Self::Around { centre, axis, pitch } => {
                let arm: Vec<f64> = position.iter().zip(centre).map(|(x, c)| x - c).collect();
                let [[x, y, z], [a, b, c]] = [&arm, axis].map(|v| match v[..] {
                    [x, y, z] => [x, y, z],
                    [x, y] => [x, y, 0.0],
                    _ => [0.0, 0.0, 1.0],
                });
                let length = norm(&[a, b, c]);
                let around = [b * z - c * y, c * x - a * z, a * y - b * x];
                let radius = norm(&around);
                if radius == 0.0 {
                    return vec![0.0; position.len()];
                }
                let (sin, cos) = pitch.sin_cos();
                let climb = |around: f64, along: f64| cos * around / radius + sin * along / length;
                let course = [climb(around[0], a), climb(around[1], b), climb(around[2], c)];
                course[..position.len()].to_vec()
            }
        }
    }
}

fn has_length(name: &str, vector: &[f64]) -> Result<(), InputError> {
    finite(name, vector)?;
    match norm(vector) > 0.0 {
        true => Ok(()),
        false => {
            let help = "a direction needs a length above 0: give a vector along the fibres";
            Err(InputError::new(name, format!("{vector:?}"), help))
        }
    }
}
