//! Mass, centre and moments of inertia of a rigid body, by numbers.

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::base::input::{InputError, finite, positive};

/// Moments of inertia about an axis (in space about all axes) through the centre of mass, for a [`RigidMass`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Moments {
    /// The moment about the normal of the plane (kg m^2), above 0.
    Plane(f64),
    /// The moments about x, y and z (kg m^2), which are principal axes of the undeformed body. Each is less than the sum of
    /// the others.
    Principal([f64; 3]),
    /// The matrix of the moments about x, y and z of the undeformed body (kg m^2): symmetric, with the moments
    /// int (y^2 + z^2) dm on its diagonal and the products -int x y dm off it.
    Matrix([[f64; 3]; 3]),
}

/// Mass and, where they are not those of a uniform density, centre and moments of inertia of a rigid body: the values in
/// a data sheet or from CAD for a part that is not a uniform solid.
///
/// ```
/// use pliant::{Body, Material, Mesh, Moments, RigidMass, SolidCells};
///
/// let mesh = Mesh::cuboid([0.04, 0.03, 0.02], [2; 3], SolidCells::Hexahedra)?;
/// let motor = RigidMass::new(0.12).moments(Moments::Principal([2.1e-5, 2.8e-5, 3.6e-5]));
/// let body = Body::new(mesh, Material::rigid_of(motor.centre([0.022, 0.015, 0.01]))).build()?;
/// assert!((body.mass() - 0.12).abs() < 1e-12); // kg
/// assert!((body.centre_of_mass(&[0.0; 24])[0] - 0.022).abs() < 1e-12); // m
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RigidMass {
    /// Mass (kg), above 0.
    pub mass: f64,
    /// Undeformed position of the centre of mass (m); `None`: that of a uniform density.
    pub centre: Option<Vec<f64>>,
    /// Moments of inertia about the centre of mass; `None`: those of a uniform density.
    pub moments: Option<Moments>,
}

/// The smallest second moment over the sum of all that is more than round-off.
const FLAT: f64 = 1e-9;

impl RigidMass {
    /// The `mass` (kg) of a body of uniform density.
    pub fn new(mass: f64) -> Self {
        Self { mass, centre: None, moments: None }
    }

    /// The same with its centre of mass at `centre` (m), a point inside or outside of the undeformed body; it needs
    /// [`moments`](Self::moments), too.
    pub fn centre(self, centre: impl Into<Vec<f64>>) -> Self {
        Self { centre: Some(centre.into()), ..self }
    }

    /// The same with these moments of inertia about its centre of mass.
    pub fn moments(self, moments: Moments) -> Self {
        Self { moments: Some(moments), ..self }
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("material.mass", self.mass, "kg")?;
        if let Some(centre) = &self.centre {
            finite("material.centre", centre)?;
            if self.moments.is_none() {
                let help = "the moments of inertia about another centre than that of the shape do not follow from the \
                            shape: give inertia, too";
                return Err(InputError::new("material.centre", format!("{centre:?}"), help));
            }
        }
        match self.moments {
            None => Ok(()),
            Some(Moments::Plane(moment)) => {
                positive("material.inertia", moment, "kg m^2").map(drop)
            }
            Some(Moments::Principal(moments)) => {
                in_space(format!("{moments:?}"), Matrix3::from_diagonal(&moments.into()))
            }
            Some(Moments::Matrix(rows)) => {
                in_space(format!("{rows:?}"), Matrix3::from_fn(|i, j| rows[i][j]))
            }
        }
    }

    /// Its centre (m) in a space of `dimension`, if one is given.
    pub(crate) fn centre_in(&self, dimension: usize) -> Result<Option<DVector<f64>>, InputError> {
        let Some(centre) = &self.centre else { return Ok(None) };
        if centre.len() != dimension {
            let help = format!("it needs {dimension} coordinates (m)");
            return Err(InputError::new("material.centre", format!("{centre:?}"), help));
        }
        Ok(Some(DVector::from_column_slice(centre)))
    }

    /// The second moments int x x^T dm about the centre (kg m^2) in a space of `dimension`, if moments of inertia are given.
    ///
    /// In the plane the motion depends on their sum alone, of which each axis gets a half.
    pub(crate) fn second_in(&self, dimension: usize) -> Result<Option<DMatrix<f64>>, InputError> {
        let second = match (self.moments, dimension) {
            (None, _) => return Ok(None),
            (Some(Moments::Plane(moment)), 2) => DMatrix::identity(2, 2) * (moment / 2.0),
            (Some(Moments::Principal(moments)), 3) => {
                of_inertia(&Matrix3::from_diagonal(&moments.into()))
            }
            (Some(Moments::Matrix(rows)), 3) => of_inertia(&Matrix3::from_fn(|i, j| rows[i][j])),
            (Some(moments), _) => {
                let help = match dimension {
                    2 => {
                        "a body in the plane has one moment (kg m^2), about the normal of the plane"
                    }
                    3 => {
                        "a body in space has three principal moments (kg m^2) or a matrix of 3 x 3"
                    }
                    _ => "a body on a line does not turn: leave the moments out",
                };
                return Err(InputError::new("material.inertia", format!("{moments:?}"), help));
            }
        };
        Ok(Some(second))
    }
}

/// The second moments that go with the matrix of inertia I: tr(I)/2 - I.
fn of_inertia(inertia: &Matrix3<f64>) -> DMatrix<f64> {
    let half = 0.5 * inertia.trace();
    DMatrix::from_fn(3, 3, |i, j| if i == j { half - inertia[(i, i)] } else { -inertia[(i, j)] })
}

/// Refuses a matrix of inertia that no body in space has; `value` is how it was given.
fn in_space(value: String, inertia: Matrix3<f64>) -> Result<(), InputError> {
    finite("material.inertia", inertia.as_slice())?;
    let bad = |help: String| Err(InputError::new("material.inertia", value.clone(), help));
    let skew = (inertia - inertia.transpose()).abs().max();
    if skew > FLAT * inertia.abs().max() {
        return bad("a matrix of inertia is symmetric: its entries ij and ji are the same".into());
    }
    let mut principal = inertia.symmetric_eigenvalues();
    principal.as_mut_slice().sort_unstable_by(f64::total_cmp);
    let [least, middle, most] = principal.into();
    let told = format!("its principal moments are {least:.4e}, {middle:.4e} and {most:.4e} kg m^2");
    if least <= 0.0 {
        return bad(format!("{told}: all of them are above 0"));
    }
    if least + middle - most <= FLAT * most {
        return bad(format!(
            "{told}: each has to be less than the sum of the others, as (y^2 + z^2) + (z^2 + x^2) is more than x^2 + y^2; of a \
             flat plate give the small part of its thickness, too"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_body_has_is_refused() {
        let of = |moments| RigidMass::new(2.0).moments(moments);
        let skew = [[1.0, 0.2, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]];
        // principal moments 1.9, 0.1 and 1: the first is more than the others together
        let long = [[1.0, 0.9, 0.0], [0.9, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let cases = [
            (RigidMass::new(0.0), "material.mass = 0"),
            (RigidMass::new(f64::NAN), "material.mass = NaN"),
            (RigidMass::new(1.0).centre([0.0, 1.0]), "give inertia, too"),
            (of(Moments::Plane(-1.0)), "material.inertia = -1"),
            (of(Moments::Principal([1.0, 1.0, 2.0])), "less than the sum of the others"),
            (of(Moments::Principal([1.0, -1.0, 1.0])), "all of them are above 0"),
            (of(Moments::Matrix(skew)), "symmetric"),
            (of(Moments::Matrix(long)), "1.0000e-1, 1.0000e0 and 1.9000e0"),
        ];
        for (given, told) in cases {
            let error = given.validate().unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
        of(Moments::Principal([1.0, 1.0, 1.99])).validate().unwrap();
        let error = of(Moments::Plane(1.0)).second_in(3).unwrap_err().to_string();
        assert!(error.contains("three principal moments"), "{error}");
    }
}
