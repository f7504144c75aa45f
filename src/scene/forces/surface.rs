//! Points of the boundary of a body, at which contact is felt.

use std::collections::BTreeMap;

use crate::base::vector::{cross, difference, dot, norm, padded};
use crate::elements::basis::{FacePoint, MOST_NODES, reference_node};
use crate::elements::body::Body;
use crate::elements::mesh::{FaceKind, Mesh};

/// A point that moves with some nodes.
pub(crate) struct SurfacePoint {
    /// How many of the entries below are used.
    count: usize,
    nodes: [usize; MOST_NODES],
    shares: [f64; MOST_NODES],
    /// Area (m^2) of the boundary for which it stands; 1 for a node (1/2 on a plane of symmetry), 0 for a point of an edge or the middle
    /// of a face.
    pub(super) area: f64,
}

impl SurfacePoint {
    /// A point between some nodes, with their `shares` in it and the area (m^2) for which it stands.
    pub(super) fn between(nodes: &[usize], shares: &[f64], area: f64) -> Self {
        point(nodes, shares, area)
    }

    /// The nodes that it moves with (counted from 0), and their shares in it, which add up to 1.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = (usize, f64)> + Clone {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.shares[..self.count].iter().copied())
    }

    /// Its position or velocity in a field of `dimension` components per node; 0 beyond them.
    pub(crate) fn at(&self, field: &[f64], dimension: usize) -> [f64; 3] {
        weighted(self.nodes(), field, dimension)
    }
}

/// The sum of a `field` of `dimension` components per node over nodes with their shares; 0 beyond the dimension.
pub(crate) fn weighted(
    shares: impl Iterator<Item = (usize, f64)>,
    field: &[f64],
    dimension: usize,
) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (node, share) in shares {
        let of_node = &field[node * dimension..][..dimension];
        sum.iter_mut().zip(of_node).for_each(|(sum, x)| *sum += share * x);
    }
    sum
}

/// Whether all nodes of a `face` are among those (ascending) of one of the `planes`.
pub(super) fn is_within(face: &[usize], planes: &[Vec<usize>]) -> bool {
    planes.iter().any(|plane| face.iter().all(|node| plane.binary_search(node).is_ok()))
}

/// Each boundary node by itself, and the points around the cross sections of rods; on a plane of symmetry at which the mesh was cut, half of it, but not on the axis of a body of revolution.
pub(crate) fn boundary_nodes(body: &Body) -> Vec<SurfacePoint> {
    let mesh = body.mesh();
    let mut parts = vec![1.0; mesh.node_count()];
    if !body.is_axisymmetric() {
        mesh.plane_of_symmetry().iter().for_each(|&node| parts[node] = 0.5);
    }
    let nodes = mesh.boundary_nodes().iter().filter(|node| !body.is_of_rod(**node));
    let nodes = nodes.map(|&node| point(&[node], &[1.0], parts[node]));
    // those of sections and those between them are as many
    nodes.chain(body.around_rods().map(|(at, _)| point_of(at, 0.5))).collect()
}

/// Points along an edge of the boundary, between its nodes: two ends, and the middle of a quadratic one. They
/// divide it into `parts` of the same length.
pub(crate) fn edge_points(edge: &[usize], parts: usize) -> impl Iterator<Item = SurfacePoint> {
    (1..parts).filter_map(move |part| {
        let s = part as f64 / parts as f64;
        match *edge {
            [a, b] => Some(point(&[a, b], &[1.0 - s, s], 0.0)),
            [a, b, middle] if 2 * part != parts => {
                let (from, to) = (1.0 - 2.0 * s, 2.0 * s - 1.0);
                let shares = [(1.0 - s) * from, s * to, 4.0 * s * (1.0 - s)];
                Some(point(&[a, b, middle], &shares, 0.0))
            }
            _ => None,
        }
    })
}

/// A point in the middle of a face of a body in space; none for others.
pub(crate) fn face_centre(kind: FaceKind, face: &[usize]) -> Option<SurfacePoint> {
    let locals: &[usize] = match kind {
        FaceKind::Point | FaceKind::Segment | FaceKind::Segment3 => return None,
        FaceKind::Triangle => &[0, 1, 2],
        FaceKind::Triangle6 => &[3, 4, 5],
        FaceKind::Triangle7 => &[6],
        FaceKind::Quadrilateral => &[0, 2],
        FaceKind::Quadrilateral8 => &[4, 6],
        FaceKind::Quadrilateral9 => &[8],
    };
    let nodes: Vec<usize> = locals.iter().map(|&local| face[local]).collect();
    Some(point(&nodes, &vec![1.0 / nodes.len() as f64; nodes.len()], 0.0))
}

/// Gauss points of the faces of the boundary, which are cut into segments or triangles for this. A membrane
/// in space is boundary all over, and rods have points around their cross sections; a string has no area: `None` if there is one.
///
/// Points inside faces, not nodes: a node at a corner would count the area of faces that do not
/// touch.
pub(super) fn gauss_points(body: &Body) -> Option<Vec<SurfacePoint>> {
    let rule = |corners: usize| -> Rule {
        match corners {
            1 => &[(&[1.0], 1.0)],
            2 => &GAUSS_SEGMENT,
            _ => &GAUSS_TRIANGLE,
        }
    };
    let mut points = Vec::new();
    for face in body.mesh().boundary_faces().into_iter().filter(|face| !body.is_of_rod(face[0])) {
        let measured = measured_points(body, &face, rule)?;
        points.extend(measured.into_iter().map(|point| point_of(point.at, point.area)));
    }
    points.extend(body.around_rods().map(|(at, area)| point_of(at, area)));
    Some(points)
}

/// Thickness (m) of a single body, 2 V/A of a band, a plate or the wall of a ring, the least diameter of a round rod; strings and membranes
/// have none here.
pub(crate) fn thickness(body: &Body) -> Option<f64> {
    let d = body.dimension();
    if let Some(pieces) = body.tube_pieces(&(0..body.mesh().node_count())) {
        let radii = pieces?.into_iter().flat_map(|piece| piece.radii);
        return Some(2.0 * radii.fold(f64::INFINITY, f64::min));
    }
    let points = gauss_points(body).filter(|_| d > 1 && body.mesh().kind().dimension() == d)?;
    let area: f64 = points.iter().map(|point| point.area).sum();
    Some(2.0 * body.volume() / area)
}

/// Quadrature points of some `faces` that lie at the nodes and between them, so that nothing sticks out beyond all of
/// them: Simpson's rule on both halves of segments, a rule of degree 3 on triangles. Points in the same place are one.
/// A string has no area: `None`.
///
/// Each stands for the areas of all faces around it. The second number is the part of them (m^2) that is seen along their normals, in the mean: a block
/// that lies on one side presses at the edges of that side with about its area alone.
pub(super) fn closed_points(body: &Body, faces: &[Vec<usize>]) -> Option<Vec<(SurfacePoint, f64)>> {
    /// By the nodes and the bits of their shares.
    type Place = Vec<(usize, u64)>;
    /// Of faces: the area (m^2) of the part for which a point stands, and the unit normal there.
    type Sides = Vec<(f64, [f64; 3])>;
    let rule = |corners: usize| -> Rule {
        match corners {
            1 => &[(&[1.0], 1.0)],
            2 => &HALVED_SIMPSON,
            _ => &CLOSED_TRIANGLE,
        }
    };
    let mut around: BTreeMap<Place, Sides> = BTreeMap::new();
    for face in faces {
        for FaceShare { at, area, normal } in measured_points(body, face, rule)? {
            let mut place: Place =
                at.into_iter().map(|(node, share)| (node, share.to_bits())).collect();
            place.sort_unstable();
            around.entry(place).or_default().push((area, normal));
        }
    }
    let point = |(place, faces): (Place, Sides)| {
        let whole: f64 = faces.iter().map(|(area, _)| area).sum();
        let seen = |normal: &[f64; 3]| -> f64 {
            faces.iter().map(|(area, other)| area * dot(normal, other).abs()).sum()
        };
        // nothing around a point on the axis of revolution
        let mean = faces.iter().map(|(area, normal)| area * seen(normal)).sum::<f64>()
            / whole.max(f64::MIN_POSITIVE);
        let at = place.into_iter().map(|(node, bits)| (node, f64::from_bits(bits))).collect();
        (point_of(at, whole), mean)
    };
    Some(around.into_iter().map(point).collect())
}

/// The shares of the corners of a piece in its quadrature points, and the weights of these.
type Rule = &'static [(&'static [f64], f64)];

/// The nodes of a point and their shares in it.
type At = Vec<(usize, f64)>;

/// A quadrature point of a face.
struct FaceShare {
    at: At,
    /// The undeformed area (m^2) for which it stands.
    area: f64,
    /// The unit normal of the face there, of either sign; that of a segment turned by a right angle.
    normal: [f64; 3],
}

/// Quadrature points of the [pieces] of a face: places on the curved face, which move with its nodes by their shape functions. `None` if the face
/// belongs to a string.
fn measured_points(
    body: &Body,
    face: &[usize],
    rule: impl Fn(usize) -> Rule,
) -> Option<Vec<FaceShare>> {
    let (section, kind) = (section(body, face)?, body.mesh().face_kind(face));
    let at: Vec<[f64; 3]> = face.iter().map(|&node| natural(body.mesh(), node)).collect();
    let mut points = Vec::new();
    for (part, weight) in pieces(kind) {
        let corners: Vec<[f64; 2]> = part.iter().map(|&node| reference_node(kind, node)).collect();
        for (shares, of_piece) in rule(part.len()) {
            let xi = std::array::from_fn(|k| {
                corners.iter().zip(*shares).map(|(corner, share)| share * corner[k]).sum()
            });
            let place = FacePoint::new(kind, xi, 0.0);
            let [along, across] = place.tangents(&at);
            let (normal, reference) = match kind.dimension() {
                0 => ([1.0, 0.0, 0.0], 1.0),
                1 => (along, (corners[1][0] - corners[0][0]).abs()),
                _ => (cross(&along, &across), reference_area(&corners)),
            };
            let size = norm(&normal);
            let stretch = size * reference;
            let r = at.iter().zip(place.values).map(|(x, share)| share * x[0]).sum();
            let stretch = stretch * body.around(r);
            let nodes = face.iter().copied().zip(place.values);
            points.push(FaceShare {
                at: nodes.filter(|(_, share)| *share != 0.0).collect(),
                area: of_piece * (weight * section * stretch),
                normal: normal.map(|n| n / size),
            });
        }
    }
    Some(points)
}

/// Area of a triangle with these reference coordinates.
fn reference_area(corners: &[[f64; 2]]) -> f64 {
    let from = |k: usize| [corners[k][0] - corners[0][0], corners[k][1] - corners[0][1]];
    let (ab, ac) = (from(1), from(2));
    0.5 * (ab[0] * ac[1] - ab[1] * ac[0]).abs()
}

/// The [pieces] of a face by their nodes, with the area (m^2) of each; `None` if it belongs to a string.
pub(super) fn measured_pieces<'a>(
    body: &'a Body,
    face: &'a [usize],
) -> Option<impl Iterator<Item = (Vec<usize>, f64)> + 'a> {
    let section = section(body, face)?;
    Some(pieces(body.mesh().face_kind(face)).map(move |(part, weight)| {
        let corners: Vec<usize> = part.iter().map(|&local| face[local]).collect();
        let r = corners.iter().map(|&node| natural(body.mesh(), node)[0]).sum::<f64>();
        let around = body.around(r / corners.len() as f64);
        let area = weight * section * measure(body, &corners) * around;
        (corners, area)
    }))
}

/// Factor from lengths of a face of the boundary to areas (m^2): the thickness of a body in the plane, the
/// cross-section of a bar; 1 in space, and of a body of revolution, beside what is [around](Body::around). A string has no surface: `None`.
pub(super) fn section(body: &Body, face: &[usize]) -> Option<f64> {
    let of_face = body.part_of(face[0]).body;
    match (of_face.mesh().kind().dimension(), body.dimension()) {
        _ if of_face.is_axisymmetric() => Some(1.0),
        (cell, space) if cell == space => Some(of_face.section()),
        (2, 3) => Some(1.0),
        _ => None,
    }
}

/// (1 +- 1/sqrt 3)/2
const NEAR: f64 = 0.788_675_134_594_812_9;
const FAR: f64 = 0.211_324_865_405_187_1;
const GAUSS_SEGMENT: [(&[f64], f64); 2] = [(&[NEAR, FAR], 0.5), (&[FAR, NEAR], 0.5)];
const THIRD: f64 = 1.0 / 3.0;
const GAUSS_TRIANGLE: [(&[f64], f64); 3] = [
    (&[2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0], THIRD),
    (&[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0], THIRD),
    (&[1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0], THIRD),
];
pub(super) const HALVED_SIMPSON: [(&[f64], f64); 5] = [
    (&[1.0, 0.0], 1.0 / 12.0),
    (&[0.75, 0.25], 1.0 / 3.0),
    (&[0.5, 0.5], 1.0 / 6.0),
    (&[0.25, 0.75], 1.0 / 3.0),
    (&[0.0, 1.0], 1.0 / 12.0),
];
const CLOSED_TRIANGLE: [(&[f64], f64); 7] = [
    (&[1.0, 0.0, 0.0], 1.0 / 20.0),
    (&[0.0, 1.0, 0.0], 1.0 / 20.0),
    (&[0.0, 0.0, 1.0], 1.0 / 20.0),
    (&[0.5, 0.5, 0.0], 2.0 / 15.0),
    (&[0.0, 0.5, 0.5], 2.0 / 15.0),
    (&[0.5, 0.0, 0.5], 2.0 / 15.0),
    (&[THIRD, THIRD, THIRD], 9.0 / 20.0),
];

fn point_of(at: At, area: f64) -> SurfacePoint {
    let (nodes, shares): (Vec<usize>, Vec<f64>) = at.into_iter().unzip();
    point(&nodes, &shares, area)
}

fn point(nodes: &[usize], shares: &[f64], area: f64) -> SurfacePoint {
    let (count, none) = (nodes.len(), [0.0; MOST_NODES]);
    let mut point = SurfacePoint { count, nodes: [0; MOST_NODES], shares: none, area };
    point.nodes[..nodes.len()].copy_from_slice(nodes);
    point.shares[..nodes.len()].copy_from_slice(shares);
    point
}

/// A face, cut into points, segments or triangles by their local nodes, and the weight of each: a
/// quadrilateral is cut along both diagonals, and so is the middle of one with mid nodes.
pub(crate) fn pieces(face: FaceKind) -> impl Iterator<Item = (&'static [usize], f64)> + Clone {
    let (whole, halves) = cuts(face);
    whole.iter().map(|&part| (part, 1.0)).chain(halves.iter().map(|&part| (part, 0.5)))
}

type Cuts = &'static [&'static [usize]];

/// Pieces of a face that are there once, and those of a quadrilateral by one diagonal, then by the other.
fn cuts(face: FaceKind) -> (Cuts, Cuts) {
    match face {
        FaceKind::Point => (&[&[0]], &[]),
        FaceKind::Segment => (&[&[0, 1]], &[]),
        FaceKind::Segment3 => (&[&[0, 2], &[2, 1]], &[]),
        FaceKind::Triangle => (&[&[0, 1, 2]], &[]),
        FaceKind::Quadrilateral => (&[], &[&[0, 1, 2], &[0, 2, 3], &[1, 2, 3], &[1, 3, 0]]),
        FaceKind::Triangle6 => (&[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]], &[]),
        FaceKind::Triangle7 => {
            (&[&[0, 3, 6], &[3, 1, 6], &[1, 4, 6], &[4, 2, 6], &[2, 5, 6], &[5, 0, 6]], &[])
        }
        FaceKind::Quadrilateral8 => (
            &[&[0, 4, 7], &[4, 1, 5], &[5, 2, 6], &[6, 3, 7]],
            &[&[4, 5, 6], &[4, 6, 7], &[5, 6, 7], &[5, 7, 4]],
        ),
        FaceKind::Quadrilateral9 => (
            &[
                &[0, 4, 8],
                &[4, 1, 8],
                &[1, 5, 8],
                &[5, 2, 8],
                &[2, 6, 8],
                &[6, 3, 8],
                &[3, 7, 8],
                &[7, 0, 8],
            ],
            &[],
        ),
    }
}

/// Length of a segment, area of a triangle, 1 of a point.
fn measure(body: &Body, corners: &[usize]) -> f64 {
    let edge = |a: usize, b: usize| difference(&natural(body.mesh(), b), &natural(body.mesh(), a));
    match *corners {
        [a, b] => norm(&edge(a, b)),
        [a, b, c] => 0.5 * norm(&cross(&edge(a, b), &edge(a, c))),
        _ => 1.0,
    }
}

/// Undeformed position of a node (m); components beyond the dimension are 0.
pub(crate) fn natural(mesh: &Mesh, node: usize) -> [f64; 3] {
    padded(mesh.position(node))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::body::Strain;
    use crate::elements::mesh::{Cells, Mesh, SolidCells};
    use crate::studies::samples::SQUARE_MATERIAL;

    fn assert_total(body: &Body, expected: f64) {
        let points = gauss_points(body).unwrap();
        let total: f64 = points.iter().map(|point| point.area).sum();
        assert!((total - expected).abs() < 1e-14, "{total} {expected}");
        for point in points {
            assert!(point.area > 0.0);
            let shares: f64 = point.nodes().map(|(_, share)| share).sum();
            assert!((shares - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn areas_add_up_to_the_boundary() {
        for cells in [Cells::Triangles, Cells::Rectangles, Cells::Triangles6] {
            let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], cells).unwrap();
            let body = Body::new(mesh, SQUARE_MATERIAL)
                .strain(Strain::Cauchy)
                .thickness(0.01)
                .build()
                .unwrap();
            assert_total(&body, 0.01);
        }
        for cells in SolidCells::ALL {
            let mesh = Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 2], cells).unwrap();
            assert_total(
                &Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).build().unwrap(),
                0.22,
            );
        }
        let bar = Body::new(Mesh::bar(0.1, 5).unwrap(), SQUARE_MATERIAL)
            .strain(Strain::Cauchy)
            .area(2e-4);
        assert_total(&bar.build().unwrap(), 4e-4);
    }
}
