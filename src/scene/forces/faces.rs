//! Faces of the boundary between some nodes, over which loads are distributed by the shape functions.
//!
//! Tractions and totals on whole faces are integrated with the shape functions in the undeformed shape.

use std::collections::{BTreeMap, BTreeSet};

use super::surface::{natural, pieces, section};
use crate::base::tensor::determinant;
use crate::base::vector::{cross, norm};
use crate::elements::basis::{FacePoint, face_points};
use crate::elements::body::Body;
use crate::elements::mesh::{Face, FaceKind};

/// The number of a kind of face among those `seen`; what all faces of a new one share is computed by `make`.
pub(super) fn number_of<T>(
    kind: FaceKind,
    seen: &mut Vec<(FaceKind, T)>,
    make: impl FnOnce(FaceKind) -> T,
) -> usize {
    let known = seen.iter().position(|(other, _)| *other == kind);
    known.unwrap_or_else(|| {
        seen.push((kind, make(kind)));
        seen.len() - 1
    })
}

/// The contribution of a face to the area (`N` = 2) or volume (`N` = 3) within walls: (1/N!)
/// sum w det(x_a, ...) over sets of `N` of its nodes, by local numbers, with the weight w of each. Without
/// mid nodes the sets are straight pieces of the face; with them, w = (N - 1)! int det(N_a, N_a,1, ...), as
/// determinants of positions are linear in each of them and change sign when two are exchanged.
pub(super) fn volume_parts<const N: usize>(kind: FaceKind) -> Vec<([usize; N], f64)> {
    let count: usize = match kind {
        FaceKind::Segment3 => 3,
        FaceKind::Triangle6 => 6,
        FaceKind::Triangle7 => 7,
        FaceKind::Quadrilateral8 => 8,
        FaceKind::Quadrilateral9 => 9,
        _ => return straight_parts(kind),
    };
    let points = face_points(kind);
    let weight = |nodes: &[usize; N]| -> f64 {
        let at = |point: &FacePoint| {
            let row = |a: usize, k: usize| match k {
                0 => point.values[a],
                _ => point.derivatives[a][k - 1],
            };
            point.weight * determinant(&nodes.map(|a| std::array::from_fn(|k| row(a, k))))
        };
        points.iter().map(at).sum::<f64>() * (N - 1) as f64
    };
    let ascending = |nodes: &[usize; N]| nodes.windows(2).all(|pair| pair[0] < pair[1]);
    let all = (0..count.pow(N as u32))
        .map(|number| std::array::from_fn(|k| number / count.pow(k as u32) % count));
    let weighed = all.filter(ascending).map(|nodes| (nodes, weight(&nodes)));
    weighed.filter(|(_, w)| w.abs() > NO_PART).collect()
}

/// The straight [pieces] of a face, each with its weight.
pub(super) fn straight_parts<const N: usize>(kind: FaceKind) -> Vec<([usize; N], f64)> {
    pieces(kind).map(|(part, w)| (std::array::from_fn(|k| part[k]), w)).collect()
}

/// Weights of parts, which are of the order of 1, are round-off of 0 below this.
const NO_PART: f64 = 1e-12;

/// Those of `faces` all of whose nodes are among `nodes`.
///
/// # Errors
/// The nodes that are on none of these faces.
pub(super) fn between<F: AsRef<[usize]>>(
    mut faces: Vec<F>,
    nodes: &BTreeSet<usize>,
) -> Result<Vec<F>, Vec<usize>> {
    faces.retain(|face| face.as_ref().iter().all(|node| nodes.contains(node)));
    let touched: BTreeSet<usize> = faces.iter().flat_map(|face| face.as_ref()).copied().collect();
    let loose: Vec<usize> = nodes.difference(&touched).copied().collect();
    if loose.is_empty() { Ok(faces) } else { Err(loose) }
}

/// Some node numbers in words.
pub(super) fn list(nodes: &[usize]) -> String {
    let numbers: Vec<String> = nodes.iter().take(8).map(|node| (node + 1).to_string()).collect();
    let more =
        if nodes.len() > 8 { format!(" and {} more", nodes.len() - 8) } else { String::new() };
    format!("node(s) {}{more}", numbers.join(", "))
}

/// A face that a load acts on.
pub(super) struct LoadedFace {
    pub(super) nodes: Face,
    pub(super) kind: FaceKind,
    /// Factor from its lengths to areas (m^2); none for a string along its length.
    pub(super) section: Option<f64>,
}

/// The faces of the boundary between `nodes`. For a body of lower dimension than space they are its cells
/// or, where the nodes make up no whole cells, the faces of its cells on its rim.
///
/// # Errors
/// The nodes that are on none.
pub(super) fn loaded_faces(body: &Body, nodes: &[usize]) -> Result<Vec<LoadedFace>, Vec<usize>> {
    let (mesh, given) = (body.mesh(), nodes.iter().copied().collect());
    let on_skin = |nodes: Face| {
        let (kind, section) = (mesh.face_kind(&nodes), section(body, &nodes));
        LoadedFace { nodes, kind, section }
    };
    let skin = between(mesh.boundary_faces(), &given);
    if mesh.has_inside() {
        return Ok(skin?.into_iter().map(on_skin).collect());
    }
    let on_rim = |nodes: Face| {
        let section = Some(body.part_of(nodes[0]).body.section());
        LoadedFace { kind: FaceKind::of_rim(nodes.len()), nodes, section }
    };
    match skin {
        Ok(skin) => Ok(skin.into_iter().map(on_skin).collect()),
        Err(loose) => match between(mesh.outer_faces(), &given) {
            Ok(rim) => Ok(rim.into_iter().map(on_rim).collect()),
            Err(_) => Err(loose),
        },
    }
}

/// The integral of the shape function of each node of `faces` in the undeformed shape: the length (m) or area
/// (m^2; of a body of revolution, too) that the node stands for, 1 for a point.
fn integrals(faces: &[LoadedFace], body: &Body) -> BTreeMap<usize, f64> {
    let (mut integrals, mut points) = (BTreeMap::new(), Vec::new());
    for LoadedFace { nodes, kind, .. } in faces {
        let x: Vec<[f64; 3]> = nodes.iter().map(|&node| natural(body.mesh(), node)).collect();
        let number = number_of(*kind, &mut points, face_points);
        for point in &points[number].1 {
            let [along, across] = point.tangents(&x);
            let measure = match kind.dimension() {
                0 => 1.0,
                1 => norm(&along),
                _ => norm(&cross(&along, &across)),
            };
            let r = x.iter().zip(point.values).map(|(x, value)| value * x[0]).sum();
            let measure = measure * body.around(r);
            for (&node, value) in nodes.iter().zip(point.values) {
                *integrals.entry(node).or_default() += point.weight * value * measure;
            }
        }
    }
    integrals
}

/// The shares of `nodes` in a force on all of them together, which add up to 1: by the shape functions of the
/// faces between them, or equal where they make up no whole faces.
pub(crate) fn shares(body: &Body, nodes: &[usize]) -> Vec<f64> {
    let Ok(faces) = loaded_faces(body, nodes) else {
        return vec![1.0 / nodes.len() as f64; nodes.len()];
    };
    let integrals = integrals(&faces, body);
    let whole: f64 = integrals.values().sum();
    nodes.iter().map(|node| integrals[node] / whole).collect()
}

/// The undeformed area (m^2) of the boundary that each of `nodes` stands for.
///
/// # Errors
/// Invalid nodes: nodes on no whole face, a body without a surface.
pub(crate) fn areas(body: &Body, nodes: &[usize]) -> Result<Vec<f64>, String> {
    let faces = loaded_faces(body, nodes).map_err(|loose| on_no_face(&loose))?;
    let mut sections = BTreeMap::new();
    for face in &faces {
        let Some(section) = face.section else {
            return Err("a string has no surface but its ends: give the force on each node".into());
        };
        sections.extend(face.nodes.iter().map(|node| (*node, section)));
    }
    let integrals = integrals(&faces, body);
    Ok(nodes.iter().map(|node| sections[node] * integrals[node]).collect())
}

/// The message for nodes that are on no face.
pub(super) fn on_no_face(loose: &[usize]) -> String {
    format!(
        "it acts on faces of the boundary with all their nodes given, and {} are on none: name a whole side, or \
         give forces on nodes",
        list(loose)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh, SolidCells};
    use crate::scene::forces::surface::gauss_points;
    use crate::studies::samples::SQUARE_MATERIAL;

    fn plate(name: &str, thickness: f64, into_space: bool) -> Body {
        let mut mesh = Mesh::rectangle([0.2, 0.1], [3, 2], Cells::Triangles).unwrap();
        if into_space {
            mesh = mesh.mapped(|x| [x[0], x[1], 1.0]).unwrap();
        }
        Body::new(mesh, SQUARE_MATERIAL).thickness(thickness).named(name).build().unwrap()
    }

    /// A face has the thickness of its own body, on the rim of a membrane beside a solid, too.
    #[test]
    fn areas_are_those_of_the_body_of_a_face() {
        let solid = Mesh::cuboid([0.1; 3], [2; 3], SolidCells::Hexahedra).unwrap();
        let solid = Body::new(solid, SQUARE_MATERIAL).named("solid").build().unwrap();
        let in_a_plane = Body::join([plate("thin", 0.01, false), plate("thick", 0.05, false)]);
        let in_space = Body::join([solid, plate("membrane", 0.02, true)]).unwrap();
        let in_a_plane = in_a_plane.unwrap();
        for (body, nodes, area) in [
            (&in_a_plane, "thin/right", 0.1 * 0.01),
            (&in_a_plane, "thick/right", 0.1 * 0.05),
            (&in_space, "solid/right", 0.1 * 0.1),
            (&in_space, "membrane/right", 0.1 * 0.02),
        ] {
            let nodes = body.mesh().select(&nodes.into()).unwrap();
            let whole: f64 = areas(body, &nodes).unwrap().iter().sum();
            assert!((whole - area).abs() < 1e-15, "{nodes:?}: {whole} {area}");
        }
        let felt: f64 = gauss_points(&in_a_plane).unwrap().iter().map(|point| point.area).sum();
        assert!((felt - 0.6 * (0.01 + 0.05)).abs() < 1e-15, "{felt}");
    }
}
