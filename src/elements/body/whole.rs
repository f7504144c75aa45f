//! The inertia of a rigid body as a whole.
//!
//! All displacements of a rigid body are affine functions of the undeformed position x, and so are the weights
//! w_a(x) = alpha_a + beta_a.(x - c) by which they follow from those of the nodes of its frame (`rigid.rs`). Its inertia
//! matrix on these nodes needs no more than the mass m, the centre c and the second moments S = int (x - c)(x - c)^T dm:
//!
//! ```text
//! int w_a w_b dm = m alpha_a alpha_b + beta_a.S beta_b
//! ```
//!
//! So all mass is that of the nodes of the frame; the others are carried along.
//!
//! S is tr(I)/2 - I in space, with the moments of inertia I (`elements/material/rigid_mass.rs`). Everything
//! that reads M (gravity, energies, momenta, the centre) finds that matrix in the place of the one of the
//! cells. Its row sums may be below 0, as those of quadratic cells may be.

use nalgebra::{DMatrix, DVector};

use super::recipe::Recipe;
use super::rigid::RigidPieces;
use crate::base::input::InputError;
use crate::base::sparse::NodeMatrix;
use crate::elements::material::RigidMass;
use crate::elements::mesh::{Enclosed, Mesh};

/// The volume of a frame over that of a cube of its size below which it is flat.
const FLAT: f64 = 1e-9;

/// Frame nodes that carry the inertia of a rigid body.
pub(super) struct Whole {
    /// The nodes of its frame.
    pub(super) frame: Vec<usize>,
    /// The first of them (m), and the inverse of the matrix of the edges from there to the others (1/m).
    origin: DVector<f64>,
    inverse: DMatrix<f64>,
}

/// Mass moments of a rigid body: mass, centre of mass and second moments about it.
pub(super) struct MassMoments {
    mass: f64,
    centre: DVector<f64>,
    second: DMatrix<f64>,
}

impl Whole {
    /// That of a body whose inertia does not follow from its cells.
    ///
    /// # Errors
    /// A body that is not one rigid piece as a whole.
    pub(super) fn of(mesh: &Mesh, recipe: &Recipe) -> Result<Option<Self>, InputError> {
        if recipe.regions.iter().any(|(_, substance)| substance.mass.is_some()) {
            let help = "mass by numbers is that of a whole body: in a region give a density";
            return Err(InputError::new("material.mass", "given in a region", help));
        }
        if mesh.is_surface() {
            return Self::on(mesh).map(Some);
        }
        let Some(given) = &recipe.material.mass else { return Ok(None) };
        if let Some((cells, _)) = recipe.regions.first() {
            let help = "mass by numbers is that of the whole body, without regions: leave them out, or give densities";
            let value = format!("{} kg beside the region {cells}", given.mass);
            return Err(InputError::new("material.mass", value, help));
        }
        if given.moments.is_none() {
            return Ok(None);
        }
        Self::on(mesh).map(Some)
    }

    /// The frame of a body that is one piece.
    fn on(mesh: &Mesh) -> Result<Self, InputError> {
        let all: Vec<usize> = (0..mesh.cell_count()).collect();
        let pieces = RigidPieces::of(mesh, &all);
        let frames = pieces.as_ref().map_or(&[][..], RigidPieces::frames);
        let [frame] = frames else {
            let help = "mass and inertia are those of one piece: make a body of each";
            return Err(InputError::new("number of pieces of the mesh", frames.len(), help));
        };
        let d = mesh.dimension();
        let origin = DVector::from_column_slice(mesh.position(frame[0]));
        let edge =
            |i: usize, a: usize| frame.get(a + 1).map_or(0.0, |&node| mesh.position(node)[i]);
        let edges = DMatrix::from_fn(d, d, |i, a| edge(i, a) - origin[i]);
        let is_flat = edges.determinant().abs() <= FLAT * mesh.size().powi(d as i32);
        match edges.try_inverse().filter(|_| !is_flat) {
            Some(inverse) => Ok(Self { frame: frame.clone(), origin, inverse }),
            None => {
                let help = "all of its nodes are on a plane or on a line, which does not determine its rotation";
                Err(InputError::new("mesh", "flat", help))
            }
        }
    }

    /// Adds the inertia of a body of these moments, times `factor`, to `matrix`.
    pub(super) fn add_inertia(&self, moments: &MassMoments, factor: f64, matrix: &mut NodeMatrix) {
        let MassMoments { mass, centre, second } = moments;
        let d = self.origin.len();
        let place = &self.inverse * (centre - &self.origin);
        let alpha = DVector::from_fn(d + 1, |a, _| match a {
            0 => 1.0 - place.sum(),
            _ => place[a - 1],
        });
        let beta = DMatrix::from_fn(d + 1, d, |a, i| match a {
            0 => -self.inverse.column(i).sum(),
            _ => self.inverse[(a - 1, i)],
        });
        let inertia = *mass * &alpha * alpha.transpose() + &beta * second * beta.transpose();
        for (a, &row) in self.frame.iter().enumerate() {
            for (b, &column) in self.frame.iter().enumerate() {
                matrix.add(row, column, factor * inertia[(a, b)]);
            }
        }
    }
}

impl MassMoments {
    /// Those of a solid of uniform `density` (kg/m^3) within the closed surface `mesh`.
    pub(super) fn of_surface(mesh: &Mesh, density: f64) -> Self {
        let Enclosed { volume, centre, second } = mesh.enclosed();
        Self {
            mass: density * volume,
            centre: DVector::from_column_slice(centre.as_slice()),
            second: DMatrix::from_column_slice(3, 3, (density * second).as_slice()),
        }
    }

    /// Those of an inertia matrix on the nodes of `mesh`.
    pub(super) fn of_matrix(mesh: &Mesh, inertia: &NodeMatrix) -> Self {
        let d = mesh.dimension();
        let place = |node: usize| DVector::from_column_slice(mesh.position(node));
        let about = |origin: &DVector<f64>| {
            let (mut mass, mut first) = (0.0, DVector::zeros(d));
            let mut second = DMatrix::zeros(d, d);
            for row in 0..inertia.pattern().nodes() {
                let arm = place(row) - origin;
                for (entry, column) in inertia.pattern().row(row) {
                    let share = inertia.values[entry];
                    mass += share;
                    first += share * &arm;
                    second += share * &arm * (place(column) - origin).transpose();
                }
            }
            (mass, first, second)
        };
        let (mass, first, _) = about(&DVector::zeros(d));
        let centre = first / mass;
        let (_, _, second) = about(&centre);
        Self { mass, centre, second }
    }

    /// The same with the prescribed values in place of its own.
    pub(super) fn replaced_by(self, given: Option<&RigidMass>) -> Result<Self, InputError> {
        let Some(given) = given else { return Ok(self) };
        let d = self.centre.len();
        Ok(Self {
            mass: given.mass,
            centre: given.centre_in(d)?.unwrap_or(self.centre),
            second: given.second_in(d)?.unwrap_or(self.second * (given.mass / self.mass)),
        })
    }
}
