//! Nodal contact quantities of a surface, for output.
//!
//! They are gathered on request, from obstacles and touches alike: normal forces, the areas of the points
//! where they act, and the fraction of the forces under which the surface slides. A point passes them to its
//! nodes by its weights, so that pressure times area adds up to the force, and both surfaces of a touch have
//! the same area. At an edge the area of a point is that seen along the normal, as the side of a block does
//! not lie on its floor. An even pressure loads the nodes of quadratic faces unevenly (corners of triangles
//! not at all), so mid nodes hand theirs to their corners first.

use std::sync::Arc;
use std::{iter, mem};

use super::surface::{is_within, measured_pieces};
use crate::base::vector::{cross, difference, dot, norm};
use crate::elements::body::Body;
use crate::elements::mesh::FaceKind;

/// Contact at a node, by obstacles and by touching bodies.
///
/// Where contact acts at points between the nodes, each node has its shares of their areas and of their
/// forces. So the sum of pressure times area over the nodes is the sum of the normal forces.
///
/// On a face with mid nodes a uniform pressure loads these far more than the corners (of an edge, with 4/6 and 1/6 each).
/// So the pressure there is first that of the corners, to which mid nodes add what they have, and then the mean of these
/// in between.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NodalContact {
    normal_force: f64,
    area: f64,
    /// The part of the normal force under which the surface slides (N).
    sliding: f64,
    /// Sum of the sizes of what `area` is the sum of (m^2).
    gross: f64,
}

/// Whether a surface sticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactStatus {
    /// Nothing touches.
    Open,
    /// It is held by friction: it slides slower than the [sticking speed](crate::Obstacle::sticking_speed).
    Sticking,
    /// It slides, or there is no friction.
    Sliding,
}

/// Round-off tolerance for areas that cancel, relative to the sum of their magnitudes.
const ROUNDING: f64 = 1e-9;

impl NodalContact {
    /// The normal force (N), above 0 where it presses.
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Area (m^2) of the undeformed surface through which the force acts: length times thickness in the plane.
    ///
    /// With a stiffness per area, and of bodies that touch, it is that of the points in contact, and may be a
    /// part of the area around the node. A stiffness per node acts through the whole of it. Where faces meet at an
    /// edge, their areas are projected along the contact normal. Strings have none, nor have edges of bodies that
    /// cross edges, whose forces count all the same.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The mean pressure (Pa) on the [area](Self::area); 0 without contact.
    pub fn pressure(&self) -> f64 {
        if self.area > 0.0 { self.normal_force / self.area } else { 0.0 }
    }

    /// Whether it sticks; where some points around the node slide, the larger part of the normal force counts.
    pub fn status(&self) -> ContactStatus {
        match self.normal_force {
            0.0 => ContactStatus::Open,
            whole if self.sliding / whole > 0.5 => ContactStatus::Sliding,
            _ => ContactStatus::Sticking,
        }
    }

    /// Adds a normal force (N) that acts through an `area` (m^2) which slides or not.
    pub(super) fn add(&mut self, normal_force: f64, area: f64, slides: bool) {
        self.normal_force += normal_force;
        self.area += area;
        self.gross += area.abs();
        if slides {
            self.sliding += normal_force;
        }
    }
}

impl NodalContact {
    /// Adds a part of another one.
    fn take_up(&mut self, other: &Self, part: f64) {
        self.normal_force += part * other.normal_force;
        self.area += part * other.area;
        self.sliding += part * other.sliding;
    }

    /// Exchanges the forces for those of the mean pressure of others.
    fn press_as<'a>(&mut self, others: impl ExactSizeIterator<Item = &'a Self>) {
        let part = self.area / others.len() as f64;
        (self.normal_force, self.sliding) = (0.0, 0.0);
        for other in others.filter(|other| other.area > 0.0) {
            self.normal_force += part * other.normal_force / other.area;
            self.sliding += part * other.sliding / other.area;
        }
    }
}

impl ContactStatus {
    /// 0 without contact, 1 for sticking, 2 for sliding contact.
    pub fn number(self) -> u8 {
        match self {
            Self::Open => 0,
            Self::Sticking => 1,
            Self::Sliding => 2,
        }
    }
}

/// The parts of a surface for which its nodes stand.
pub(crate) struct Tributary {
    dimension: usize,
    /// Undeformed positions of all nodes (m).
    natural: Vec<f64>,
    pieces: Vec<Piece>,
    /// The pieces around each node.
    around: Vec<Vec<usize>>,
    /// The mid nodes of faces, and the corners between which they lie.
    mids: Vec<(usize, Vec<usize>)>,
}

/// A point, segment or triangle of the surface.
struct Piece {
    corners: Vec<usize>,
    /// The nodes of the face that it is a piece of.
    face: Arc<[usize]>,
    /// Its undeformed area (m^2), an equal part of which belongs to each corner.
    area: f64,
    /// Whether both of its sides are outside.
    is_membrane: bool,
}

impl Tributary {
    /// Of all faces but those [within](is_within) planes of symmetry, by the nodes of each plane.
    pub(crate) fn new(body: &Body, planes: &[Vec<usize>]) -> Self {
        let (mesh, dimension) = (body.mesh(), body.dimension());
        let (mut pieces, mut mids) = (Vec::new(), Vec::new());
        for face in mesh.boundary_faces() {
            if is_within(&face, planes) {
                continue;
            }
            let is_membrane = !body.part_of(face[0]).body.mesh().has_inside();
            let measured = measured_pieces(body, &face).into_iter().flatten();
            let nodes: Arc<[usize]> = Arc::from(&face[..]);
            let piece = |(corners, area)| Piece { corners, face: nodes.clone(), area, is_membrane };
            pieces.extend(measured.map(piece));
            mids.extend(between_corners(mesh.face_kind(&face), &face));
        }
        mids.sort_unstable();
        mids.dedup_by_key(|(mid, _)| *mid);
        let mut around = vec![Vec::new(); mesh.node_count()];
        for (number, piece) in pieces.iter().enumerate() {
            piece.corners.iter().for_each(|&node| around[node].push(number));
        }
        Self { dimension, natural: mesh.positions().to_vec(), pieces, around, mids }
    }

    pub(crate) fn node_count(&self) -> usize {
        self.around.len()
    }

    /// Drops what rounding has left of forces and areas that cancel each other, and evens out the pressure of faces with
    /// mid nodes: areas stay, and so does the sum of the forces.
    pub(crate) fn even_out(&self, nodal: &mut [NodalContact]) {
        for node in nodal.iter_mut() {
            if node.area.abs() < ROUNDING * node.gross {
                *node = NodalContact::default();
            }
        }
        if self.mids.is_empty() {
            return;
        }
        let mut gathered = nodal.to_vec();
        for (mid, corners) in &self.mids {
            let part = 1.0 / corners.len() as f64;
            let given = mem::take(&mut gathered[*mid]);
            corners.iter().for_each(|&corner| gathered[corner].take_up(&given, part));
        }
        // strings have no area
        let with_area = nodal.iter_mut().zip(&gathered).filter(|(_, known)| known.area > 0.0);
        with_area.for_each(|(node, known)| node.press_as(iter::once(known)));
        for (mid, corners) in &self.mids {
            nodal[*mid].press_as(corners.iter().map(|&corner| &gathered[corner]));
        }
    }

    /// The area (m^2) of what belongs to a node under the displacements `u` (m), as seen along the unit `normal` of what
    /// presses on it: of a corner on a floor that of the bottom alone.
    pub(super) fn facing(&self, node: usize, u: &[f64], normal: &[f64; 3]) -> f64 {
        let pieces = self.around[node].iter().map(|&number| &self.pieces[number]);
        let seen = pieces
            .map(|piece| piece.area / piece.corners.len() as f64 * self.seen(piece, u, normal));
        seen.sum()
    }

    /// The part, from 0 to 1, of the area around a point between some nodes that is [seen](Self::facing).
    pub(super) fn facing_part(&self, between: &[usize], u: &[f64], normal: &[f64; 3]) -> f64 {
        let (mut seen, mut whole) = (0.0, 0.0);
        for &number in between.iter().take(1).flat_map(|&node| &self.around[node]) {
            let piece = &self.pieces[number];
            if between.iter().all(|node| piece.face.contains(node)) {
                seen += piece.area * self.seen(piece, u, normal);
                whole += piece.area;
            }
        }
        if whole > 0.0 { seen / whole } else { 1.0 }
    }

    /// The cosine of the angle between the inward normal of a piece and `normal`; 0 where it is turned away.
    fn seen(&self, piece: &Piece, u: &[f64], normal: &[f64; 3]) -> f64 {
        let d = self.dimension;
        let at = |node: usize| -> [f64; 3] {
            let place = |i| self.natural[node * d + i] + u[node * d + i];
            std::array::from_fn(|i| if i < d { place(i) } else { 0.0 })
        };
        // the outside is to the right of a segment, and where a triangle runs counter-clockwise
        let cosine = match *piece.corners {
            [a, b] => {
                let along = difference(&at(b), &at(a));
                cross(&along, normal)[2] / norm(&along)
            }
            [a, b, c] => {
                let outward = cross(&difference(&at(b), &at(a)), &difference(&at(c), &at(a)));
                -dot(&outward, normal) / norm(&outward)
            }
            _ => 1.0,
        };
        if piece.is_membrane { cosine.abs() } else { cosine.max(0.0) }
    }
}

/// The nodes of a face that are no corners, each with the corners between which it lies.
fn between_corners(kind: FaceKind, face: &[usize]) -> Vec<(usize, Vec<usize>)> {
    let corners = kind.corners();
    let sides = if corners == 2 { 1 } else { corners };
    let of_mid = |(k, &mid): (usize, &usize)| match k < sides {
        true => (mid, vec![face[k], face[(k + 1) % corners]]),
        false => (mid, face[..corners].to_vec()),
    };
    face[corners..].iter().enumerate().map(of_mid).collect()
}
