//! Pressure on faces of the boundary: a force along the normal of the deformed face.

use super::faces::{LoadedFace, loaded_faces, number_of, on_no_face};
use super::signal::{Signal, finite_at};
use super::surface::natural;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::cross;
use crate::elements::basis::{FacePoint, MOST_NODES, face_points};
use crate::elements::body::Body;
use crate::elements::force::{Force, NodalForces, Tangents};
use crate::elements::mesh::{FaceKind, Selection};
use crate::integrators::ode::Failure;

/// Pressure p on faces: f_a = -sum w p N_a n over their quadrature points, with n = x,1 x x,2, the outward
/// normal of the deformed face times its area per reference area. In the plane the thickness along z stands
/// for x,2.
///
/// Hibbitt, *Some follower forces and load stiffness*, Int. J. Numer. Meth. Engng. 14 (1979).
pub(crate) struct FacePressure {
    dimension: usize,
    faces: Vec<PressedFace>,
    /// The quadrature points of each kind of face.
    points: Vec<(FaceKind, Vec<FacePoint>)>,
    pressure: Signal,
}

struct PressedFace {
    nodes: Vec<usize>,
    /// Their undeformed positions; components beyond the dimension are 0.
    natural: Vec<[f64; 3]>,
    /// The number of its kind.
    kind: usize,
    /// x,2 in the plane.
    across: Option<[f64; 3]>,
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
        let (mut faces, mut points) = (Vec::with_capacity(loaded.len()), Vec::new());
        for LoadedFace { nodes, kind, section } in loaded {
            let across = match (mesh.dimension(), kind.dimension(), section) {
                (2, 1, Some(thickness)) => Some([0.0, 0.0, thickness]),
                (3, 2, _) => None,
                _ => {
                    let help =
                        "there is no face with a normal between them: give a traction or forces";
                    return Err(bad(help.into()));
                }
            };
            let kind = number_of(kind, &mut points, face_points);
            let natural = nodes.iter().map(|&node| natural(mesh, node)).collect();
            faces.push(PressedFace { nodes, natural, kind, across });
        }
        Ok(Self { dimension: mesh.dimension(), faces, points, pressure })
    }

    /// Each quadrature point with its face and the derivatives x,1 and x,2 of the deformed face.
    fn each_point(&self, u: &[f64], mut see: impl FnMut(&[usize], &FacePoint, [[f64; 3]; 2])) {
        for PressedFace { nodes, natural, kind, across } in &self.faces {
            let mut x = [[0.0; 3]; MOST_NODES];
            for ((x, natural), node) in x.iter_mut().zip(natural).zip(nodes) {
                *x = *natural;
                let moved = &u[node * self.dimension..][..self.dimension];
                x.iter_mut().zip(moved).for_each(|(x, u)| *x += u);
            }
            for point in &self.points[*kind].1 {
                let [first, second] = point.tangents(&x[..nodes.len()]);
                see(nodes, point, [first, across.unwrap_or(second)]);
            }
        }
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
        let (d, applied) = (self.dimension, &mut forces.applied[..]);
        self.each_point(u, |nodes, point, [first, second]| {
            let normal = cross(&first, &second);
            for (node, value) in nodes.iter().zip(point.values) {
                let factor = pressure * point.weight * value;
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
        let (d, pressure) = (self.dimension, self.pressure.at(t));
        self.each_point(u, |nodes, point, [first, second]| {
            for (column, [by_first, by_second]) in nodes.iter().zip(point.derivatives) {
                let c: [f64; 3] =
                    std::array::from_fn(|i| by_second * first[i] - by_first * second[i]);
                let times = [[0.0, -c[2], c[1]], [c[2], 0.0, -c[0]], [-c[1], c[0], 0.0]];
                for (row, value) in nodes.iter().zip(point.values) {
                    let factor = pressure * point.weight * value;
                    let Some(block) = stiffness.block_mut(*row, *column) else { continue };
                    for (k, x) in block.iter_mut().enumerate() {
                        *x += factor * times[k / d][k % d];
                    }
                }
            }
        });
        Tangents::Added
    }
}
