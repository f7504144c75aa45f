//! Meshes of files whose straight edges and flat faces approximate curved ones.
//!
//! Facets, of faces that lie in one plane, with the angle theta from one to the next represent an arc of the radius h/theta,
//! h their width. The area between arc and facet is theta^2/6 of the sector, from sin(theta)/theta of a polygon. Halving such cells keeps
//! the polygon, so that no finer mesh shows this error.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::flat_face;
use crate::base::input::percent;
use crate::dynamics::report::Indicator;
use crate::elements::basis::FacePoint;
use crate::elements::body::Body;
use crate::elements::mesh::Mesh;
use crate::scene::forces::natural;

/// Largest fraction of the area within curved faces that may lie between them and facets.
const MOST_LACKING: f64 = 0.02;
/// Angles (rad) between facets from which they are separate, and from which they represent no arc: those of an octagon.
const FLAT: f64 = 0.01;
const SHARP: f64 = 0.7;
/// Facets of an arc turn by angles that differ by this factor at most.
const ALIKE: f64 = 2.0;

/// An edge between two faces of the surface; in the plane, a node between two edges.
struct Ridge {
    faces: [usize; 2],
    /// The angle (rad) between the faces.
    turn: f64,
    /// Its length (m); 1 in the plane.
    length: f64,
    /// Width of the faces (m), at right angles to it.
    widths: [f64; 2],
}

/// Fraction of the volume within curved surfaces that their facets miss.
pub(super) fn faceted(body: &Body) -> Option<Indicator> {
    let mesh = body.mesh();
    if !mesh.is_from_file() || mesh.is_surface() || mesh.dimension() < 2 {
        return None;
    }
    let (part, turn) = lacking(mesh)?;
    let said = format!(
        "straight cells approximate curves: facets with angles of {:.0} degrees between them lack about {} of the area or volume within \
         such curves (limit: {})",
        turn.to_degrees(),
        percent(part),
        percent(MOST_LACKING)
    );
    let beyond = || {
        let finer = (part / MOST_LACKING).sqrt();
        format!(
            "{said}; halving cells does not reduce it: make the file with cells {finer:.1} times as fine along the curves, or quadratic \
             ones (in Gmsh: Mesh.ElementOrder = 2)"
        )
    };
    let limits = [0.0, MOST_LACKING];
    Some(Indicator::trusted("facets", (part, "1"), limits, || said.clone(), beyond))
}

/// The fraction of the area within arcs that lies between them and their facets, and the angle (rad) between facets; `None` without arcs.
fn lacking(mesh: &Mesh) -> Option<(f64, f64)> {
    let faces = mesh.boundary_faces();
    let ridges = ridges(mesh, &faces);
    let facets = facets(faces.len(), &ridges);
    // for each facet the angles to others, by their facet
    let mut turns: BTreeMap<usize, BTreeMap<usize, f64>> = BTreeMap::new();
    let bent = || ridges.iter().filter(|ridge| ridge.turn > FLAT && ridge.turn < SHARP);
    for ridge in bent() {
        let [a, b] = ridge.faces.map(|face| facets[face]);
        turns.entry(a).or_default().insert(b, ridge.turn);
        turns.entry(b).or_default().insert(a, ridge.turn);
    }
    let goes_on = |ridge: &Ridge, from: usize, to: usize| {
        let is_alike = |turn: &f64| turn.max(ridge.turn) <= ALIKE * turn.min(ridge.turn);
        turns
            .get(&from)
            .is_some_and(|turns| turns.iter().any(|(facet, turn)| *facet != to && is_alike(turn)))
    };
    let is_of_arc = |ridge: &&Ridge| {
        let [a, b] = ridge.faces.map(|face| facets[face]);
        a != b && (goes_on(ridge, a, b) || goes_on(ridge, b, a))
    };
    let (mut lacks, mut encloses, mut turning, mut length) = (0.0, 0.0, 0.0, 0.0);
    for ridge in bent().filter(is_of_arc) {
        for width in ridge.widths {
            // half of the area between, and half of the sector
            lacks += ridge.length * ridge.turn * width * width / 24.0;
            encloses += ridge.length * width * width / ridge.turn / 4.0;
        }
        turning += ridge.turn * ridge.length;
        length += ridge.length;
    }
    (length > 0.0).then_some((lacks / encloses, turning / length))
}

/// The facet that each face belongs to, by the number of one of its faces: faces in one plane are one facet.
fn facets(faces: usize, ridges: &[Ridge]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..faces).collect();
    fn root(first: &mut [usize], mut face: usize) -> usize {
        while first[face] != face {
            first[face] = first[first[face]];
            face = first[face];
        }
        face
    }
    for ridge in ridges.iter().filter(|ridge| ridge.turn <= FLAT) {
        let [a, b] = ridge.faces.map(|face| root(&mut first, face));
        first[a.max(b)] = a.min(b);
    }
    (0..faces).map(|face| root(&mut first, face)).collect()
}

/// A face at one of its sides: its number, the direction into it, and how wide (m) it is from there.
type Side = (usize, Vector3<f64>, f64);

/// An edge where exactly two faces meet.
fn ridges(mesh: &Mesh, faces: &[Vec<usize>]) -> Vec<Ridge> {
    let mut sides = BTreeMap::<[usize; 2], Vec<Side>>::new();
    let at = |node: usize| Vector3::from(natural(mesh, node));
    for (number, face) in faces.iter().enumerate() {
        let kind = mesh.face_kind(face);
        let corners = &face[..kind.corners()];
        let places: Vec<[f64; 3]> = face.iter().map(|node| natural(mesh, *node)).collect();
        let centre = flat_face::middle(kind, 0..corners.len());
        let area = flat_face::area(&corners.iter().map(|node| at(*node)).collect::<Vec<_>>());
        // where the face ends: at a corner of an edge, along an edge of a face
        let ends = (0..corners.len()).map(|k| match corners.len() {
            2 => [k, k],
            count => [k, (k + 1) % count],
        });
        for [a, b] in ends {
            let end = flat_face::middle(kind, [a, b].into_iter());
            let [t1, t2] = FacePoint::new(kind, end, 1.0).tangents(&places).map(Vector3::from);
            let along = at(corners[b]) - at(corners[a]);
            let inward = t1 * (centre[0] - end[0]) + t2 * (centre[1] - end[1]);
            let length = along.norm();
            let (inward, width) = match corners.len() {
                2 => (inward, area),
                count => {
                    let across = inward - along * (along.dot(&inward) / (length * length));
                    (across, area / length * if count == 3 { 2.0 } else { 1.0 })
                }
            };
            let mut key = [corners[a], corners[b]];
            key.sort_unstable();
            sides.entry(key).or_default().push((number, inward, width));
        }
    }
    let ridge = |(ends, sides): (&[usize; 2], &Vec<Side>)| {
        let [(first, p, wide), (second, q, other)] = &sides[..] else { return None };
        let length = if ends[0] == ends[1] { 1.0 } else { (at(ends[1]) - at(ends[0])).norm() };
        let turn = p.angle(&-q);
        turn.is_finite().then_some(Ridge {
            faces: [*first, *second],
            turn,
            length,
            widths: [*wide, *other],
        })
    };
    sides.iter().filter_map(ridge).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::elements::mesh::{Cells, SolidCells};

    /// Polygons, whose area is sin(theta)/theta of that of the sector, prisms of them, and shapes without arcs.
    #[test]
    fn polygons_lack_what_their_angles_say() {
        for around in [12, 24] {
            let theta = TAU / around as f64;
            let exact = 1.0 - theta.sin() / theta;
            let ring = Mesh::ring(0.03, 0.036, [around, 2], Cells::Triangles).unwrap();
            let (part, turn) = lacking(&ring).unwrap();
            assert!((turn - theta).abs() < 1e-12);
            assert!((part / exact - 1.0).abs() < theta * theta, "{part} {exact}");
            // a quarter of a tube, of bricks and of tetrahedra
            for cells in [SolidCells::Hexahedra, SolidCells::Tetrahedra] {
                let nodes = [around / 4 + 1, 2, 3];
                let block = Mesh::cuboid([TAU / 4.0, 0.3, 2.0], nodes, cells).unwrap();
                let tube = block.mapped(|x| {
                    let r = 1.0 + x[1];
                    [r * x[0].sin(), r * x[0].cos(), x[2]]
                });
                let (part, turn) = lacking(&tube.unwrap()).unwrap();
                assert!((turn - theta).abs() < 1e-9, "{turn} {theta}");
                assert!((part / exact - 1.0).abs() < theta * theta, "{part} {exact}");
            }
            // mid nodes on the circle leave next to nothing
            let curved = Mesh::ring(0.03, 0.036, [around, 2], Cells::Triangles6).unwrap();
            assert!(lacking(&curved).is_none_or(|(part, _)| part < 0.01 * exact));
        }
        let cube = Mesh::cuboid([1.0, 1.0, 1.0], [3, 3, 3], SolidCells::Tetrahedra).unwrap();
        assert!(lacking(&cube).is_none());
        // a beam with a kink is no arc
        let beam = Mesh::rectangle([1.0, 0.1], [11, 3], Cells::Triangles).unwrap();
        let kinked = beam.mapped(|x| [x[0], x[1] + 0.2 * (x[0] - 0.5).max(0.0)]).unwrap();
        assert!(lacking(&kinked).is_none());
    }
}
