//! Pressure on faces of the boundary: a force along the normal of the deformed face.
//!
//! It is integrated with the shape functions of the faces, so that quadratic faces under it have a uniform
//! stress. The tangent is exact, and symmetric only over closed surfaces and those with held rims.

use super::faces::{loaded_faces, on_no_face};
use super::followed::{FollowedFaces, add_block, cross_with};
use super::signal::{Signal, finite_at};
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::cross;
use crate::elements::body::Body;
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;

/// Pressure p on faces: f_a = -sum w p N_a n over their quadrature points, with n = x,1 x x,2, the outward
/// normal of the deformed face times its area per reference area. In the plane the thickness along z stands
/// for x,2, in a body of revolution the present length 2 pi r of a circle.
///
/// Hibbitt, *Some follower forces and load stiffness*, Int. J. Numer. Meth. Engng. 14 (1979).
pub(crate) struct FacePressure {
    faces: FollowedFaces,
    pressure: Signal,
}

impl FacePressure {
    /// `pressure` (Pa) on the faces between the nodes that `selection` names.
    ///
    /// # Errors
    /// Nodes that are on no whole face; faces without a normal.
    pub(crate) fn new(
        body: &Body,
        selection: &Selection,
        pressure: Signal,
    ) -> Result<Self, InputError> {
        let mesh = body.mesh();
        let bad = |problem: String| InputError::new("pressure nodes", selection, problem);
        pressure.validate("pressure")?;
        let nodes = mesh.select(selection)?;
        let loaded = loaded_faces(body, &nodes).map_err(|loose| bad(on_no_face(&loose)))?;
        let faces = FollowedFaces::new(mesh, loaded);
        let faces = faces.map_err(|help| bad(format!("{help}: give a traction or forces")))?;
        Ok(Self { faces: faces.of(body), pressure })
    }
}

impl Force for FacePressure {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let pressure = finite_at(t, format_args!("the pressure on faces"), self.pressure.at(t))?;
        let (d, applied) = (self.faces.dimension, &mut forces.applied[..]);
        self.faces.each_point(u, |at| {
            let [first, second] = at.tangents;
            let normal = cross(&first, &second);
            for (node, value) in at.nodes.iter().zip(at.point.values) {
                let factor = pressure * at.point.weight * value;
                for (f, n) in applied[node * d..][..d].iter_mut().zip(normal) {
                    *f -= factor * n;
                }
            }
        });
        Ok(())
    }

    /// -df_a/du_b = sum w p N_a (N_b,2 [x,1 x] - N_b,1 [x,2 x]), where [c x] is the matrix of the cross
    /// product with c. It is not symmetric by itself; over a closed surface, or one whose rim is held, the
    /// sum is.
    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        let pressure = self.pressure.at(t);
        self.faces.each_point(u, |at| {
            for ((column, c), share) in at.nodes.iter().zip(at.turning()).zip(at.point.values) {
                let mut times = cross_with(c);
                for (i, by_r) in at.by_r.iter().flatten().enumerate() {
                    times[i][0] += share * by_r;
                }
                for (row, value) in at.nodes.iter().zip(at.point.values) {
                    add_block(
                        stiffness,
                        [*row, *column],
                        pressure * at.point.weight * value,
                        &times,
                    );
                }
            }
        });
        Tangents::Added
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.faces.nodes())
    }
}
