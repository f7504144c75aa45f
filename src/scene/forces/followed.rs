//! Faces of the boundary with their quadrature points, where they are in the deformed shape: for loads that follow their normals.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::faces::{LoadedFace, number_of};
use super::surface::natural;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{cross, distinct, dot, norm};
use crate::elements::basis::{FacePoint, MOST_NODES, face_points};
use crate::elements::body::Body;
use crate::elements::mesh::{FaceKind, Mesh};

/// Round-off tolerance for the rim of a closed surface, relative to the magnitudes of the terms that cancel.
const NO_RIM: f64 = 1e-9;

/// Faces with a normal.
pub(super) struct FollowedFaces {
    pub(super) dimension: usize,
    faces: Vec<FollowedFace>,
    /// The quadrature points of each kind of face.
    points: Vec<(FaceKind, Vec<FacePoint>)>,
    /// Whether they are turned about the axis, so that the present length 2 pi r of circles stands for the thickness.
    is_turned: bool,
}

struct FollowedFace {
    nodes: Vec<usize>,
    /// Their undeformed positions; components beyond the dimension are 0.
    natural: Vec<[f64; 3]>,
    /// The number of its kind.
    kind: usize,
    /// x,2 in the plane.
    across: Option<[f64; 3]>,
}

/// A quadrature point of a deformed face.
pub(super) struct Followed<'a> {
    /// The nodes of the face, and where they are (m).
    pub(super) nodes: &'a [usize],
    pub(super) places: &'a [[f64; 3]],
    pub(super) point: &'a FacePoint,
    /// The derivatives x,1 and x,2 of the position: x,1 x x,2 is the outward normal times the area per reference area. In
    /// the plane the thickness along z stands for x,2.
    pub(super) tangents: [[f64; 3]; 2],
    /// The derivative of that normal by the radius r of the point, at the same x,1, in a body of revolution.
    pub(super) by_r: Option<[f64; 3]>,
}

impl FollowedFaces {
    /// # Errors
    /// Faces without a normal, in words.
    pub(super) fn new(mesh: &Mesh, loaded: Vec<LoadedFace>) -> Result<Self, &'static str> {
        let (mut faces, mut points) = (Vec::with_capacity(loaded.len()), Vec::new());
        for LoadedFace { nodes, kind, section } in loaded {
            let across = match (mesh.dimension(), kind.dimension(), section) {
                (2, 1, Some(thickness)) => Some([0.0, 0.0, thickness]),
                (3, 2, _) => None,
                _ => return Err("there is no face with a normal between them"),
            };
            let kind = number_of(kind, &mut points, face_points);
            let natural = nodes.iter().map(|&node| natural(mesh, node)).collect();
            faces.push(FollowedFace { nodes, natural, kind, across });
        }
        Ok(Self { dimension: mesh.dimension(), faces, points, is_turned: false })
    }

    /// The same faces of a `body`, which may be one of revolution.
    pub(super) fn of(self, body: &Body) -> Self {
        Self { is_turned: body.is_axisymmetric(), ..self }
    }

    /// Their nodes, ascending.
    pub(super) fn nodes(&self) -> Vec<usize> {
        distinct(self.faces.iter().flat_map(|face| face.nodes.iter().copied()))
    }

    /// Each quadrature point under the displacements `u` (m).
    pub(super) fn each_point(&self, u: &[f64], mut see: impl FnMut(&Followed)) {
        for FollowedFace { nodes, natural, kind, across } in &self.faces {
            let mut x = [[0.0; 3]; MOST_NODES];
            for ((x, natural), node) in x.iter_mut().zip(natural).zip(nodes) {
                *x = *natural;
                let moved = &u[node * self.dimension..][..self.dimension];
                x.iter_mut().zip(moved).for_each(|(x, u)| *x += u);
            }
            let places = &x[..nodes.len()];
            for point in &self.points[*kind].1 {
                let [first, second] = point.tangents(places);
                let mut tangents = [first, across.unwrap_or(second)];
                if self.is_turned {
                    let r = places.iter().zip(point.values).map(|(x, value)| value * x[0]);
                    tangents[1] = [0.0, 0.0, TAU * r.sum::<f64>()];
                }
                let by_r = self.is_turned.then(|| cross(&first, &[0.0, 0.0, TAU]));
                see(&Followed { nodes, places, point, tangents, by_r });
            }
        }
    }

    /// Whether they are a closed surface, where `rest` are displacements of 0: its vector area stays 0 whichever node moves, so the derivatives of the
    /// normals by the place of a node add up to 0 over the faces around it. A plane of symmetry closes those that end at nodes of it (`plane`).
    pub(super) fn is_closed(&self, rest: &[f64], plane: &[usize]) -> bool {
        let mut rims = BTreeMap::new();
        self.each_point(rest, |at| {
            for (&node, c) in at.nodes.iter().zip(at.turning()) {
                let (sum, size) = rims.entry(node).or_insert(([0.0; 3], 0.0));
                sum.iter_mut().zip(c).for_each(|(sum, c)| *sum += at.point.weight * c);
                *size += at.point.weight.abs() * norm(&c);
            }
        });
        let is_rim = |(_, (sum, size)): &(&usize, &([f64; 3], f64))| norm(sum) > NO_RIM * size;
        rims.iter().filter(is_rim).all(|(node, _)| plane.contains(node))
    }
}

impl Followed<'_> {
    /// The normal of its face times the area per reference area.
    pub(super) fn facing(&self) -> [f64; 3] {
        cross(&self.tangents[0], &self.tangents[1])
    }

    /// Its position (m).
    pub(super) fn place(&self) -> [f64; 3] {
        let mut x = [0.0; 3];
        for (place, share) in self.places.iter().zip(self.point.values) {
            x.iter_mut().zip(place).for_each(|(x, place)| *x += share * place);
        }
        x
    }

    /// The second derivative of d^2 (e . n)/2, with the `depth` d along e (m), by the positions of two nodes of its face, given with their
    /// numbers in it and the c of [`turning`](Self::turning):
    ///
    /// ```text
    /// N_a N_b (e . n) e e^T + d (N_a e m_b^T + N_b m_a e^T) - (1/2) d^2 (N_a,1 N_b,2 - N_b,1 N_a,2) [e x],   m_b = e x c_b
    /// ```
    pub(super) fn bending(
        &self,
        e: &[f64; 3],
        depth: f64,
        facing: &[f64; 3],
        [(a, from), (b, to)]: [(usize, [f64; 3]); 2],
    ) -> [[f64; 3]; 3] {
        let [of_a, of_b] = [cross(e, &from), cross(e, &to)];
        let (values, [da, db]) =
            (&self.point.values, [self.point.derivatives[a], self.point.derivatives[b]]);
        let straight = values[a] * values[b] * dot(e, facing);
        let bent = 0.5 * depth * depth * (da[0] * db[1] - db[0] * da[1]);
        let spin = cross_with(*e);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                straight * e[i] * e[j]
                    + depth * (values[a] * e[i] * of_b[j] + values[b] * of_a[i] * e[j])
                    - bent * spin[i][j]
            })
        })
    }

    /// The vectors c_b of its nodes with which the derivative of the normal by u_b is [c_b x]: N_b,2 x,1 - N_b,1 x,2.
    pub(super) fn turning(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let [first, second] = self.tangents;
        let of_node = move |[by_first, by_second]: &[f64; 2]| {
            std::array::from_fn(|i| by_second * first[i] - by_first * second[i])
        };
        self.point.derivatives[..self.nodes.len()].iter().map(of_node)
    }
}

/// The matrix [c x] of the cross product with c.
pub(super) fn cross_with(c: [f64; 3]) -> [[f64; 3]; 3] {
    [[0.0, -c[2], c[1]], [c[2], 0.0, -c[0]], [-c[1], c[0], 0.0]]
}

/// Adds `factor` times a matrix to the block of two nodes.
pub(super) fn add_block(
    matrix: &mut BlockMatrix,
    [row, column]: [usize; 2],
    factor: f64,
    block: &[[f64; 3]; 3],
) {
    let d = matrix.dimension();
    let Some(own) = matrix.block_mut(row, column) else { return };
    for (k, x) in own.iter_mut().enumerate() {
        *x += factor * block[k / d][k % d];
    }
}
