//! Curved walls of one layer of cells, which are too stiff where cells are large relative to sqrt(R t), the length over which a shell
//! of the radius R and the thickness t bends at its edges.
//!
//! A curved cell cannot bend without being stretched (membrane locking; H. Stolarski, T. Belytschko, Journal of Applied Mechanics 49
//! (1982) 172-176), by an amount that goes by l = h^2/(R t), h its length along the curve. As the rise of its arc over the chord
//! is s = h^2/(8 R), this is l = 8 s/t, computed from each cell separately.

use nalgebra::Vector3;

use super::flat_face;
use crate::base::input::{percent, short};
use crate::dynamics::report::Indicator;
use crate::elements::basis::FacePoint;
use crate::elements::body::Body;
use crate::elements::mesh::CellKind;
use crate::scene::forces::natural;

/// Largest l of cells, ...
const MOST: f64 = 1.0;
/// ... and the part by which a pinched ring of quadratic cells is too stiff, over l^2. (Measured, with rings of 10 to 1000 times their
/// thickness: 0.066 to 0.077 at l between 0.4 and 4.)
const STIFFER: f64 = 0.07;
/// Cells of a smaller one are straight.
const ROUND_OFF: f64 = 1e-6;

/// Rise of the cells of curved walls of one layer, relative to their thickness.
pub(super) fn arched(body: &Body) -> Option<Indicator> {
    let (most, across) = largest(body)?;
    let said = format!(
        "curved cells of one layer are {} times as long as sqrt(R t) of the wall, {} m thick, that they are in (limit: {})",
        short(most.sqrt()),
        short(across),
        short(MOST.sqrt())
    );
    let beyond = || {
        format!(
            "{said}: they lock, and the wall is too stiff by {} or so where it bends; take cells {:.1} times as fine along the curves",
            percent(STIFFER * most * most),
            (most / MOST).sqrt()
        )
    };
    let limits = [0.0, MOST.sqrt()];
    let value = (most.sqrt(), "1");
    Some(Indicator::trusted("arched-cells", value, limits, || said.clone(), beyond))
}

/// The largest l, and the thickness (m) there; `None` without curved cells whose corners are all on the boundary.
fn largest(body: &Body) -> Option<(f64, f64)> {
    let mesh = body.mesh();
    let kind = mesh.kind();
    if !kind.is_quadratic() || kind.dimension() != mesh.dimension() {
        return None;
    }
    let mut is_outside = vec![false; mesh.node_count()];
    mesh.boundary_nodes().iter().for_each(|&node| is_outside[node] = true);
    let at = |node: usize| Vector3::from(natural(mesh, node));
    // a cell over its boundary face: the height of a block, of a triangle or of a tetrahedron
    let heights = match kind {
        CellKind::Triangle6 | CellKind::Triangle7 => 2.0,
        CellKind::Tetrahedron10 | CellKind::Tetrahedron15 => 3.0,
        _ => 1.0,
    };
    let (volumes, cells): (Vec<f64>, Vec<&[usize]>) = (body.cell_volumes(), mesh.cells().collect());
    let corners = kind.faces().iter().map(|face| mesh.face_kind(face).corners());
    let faces = kind.faces().iter().zip(corners);
    let mut locals: Vec<usize> =
        faces.flat_map(|(face, corners)| face[..corners].to_vec()).collect();
    locals.sort_unstable();
    locals.dedup();
    let mut most: Option<(f64, f64)> = None;
    for (cell, face) in mesh.boundary_faces_of_cells() {
        if !locals.iter().all(|&local| is_outside[cells[cell][local]]) {
            continue;
        }
        let shape = mesh.face_kind(&face);
        let ends = shape.corners();
        let places: Vec<[f64; 3]> = face.iter().map(|node| natural(mesh, *node)).collect();
        let middle = flat_face::middle(shape, 0..ends);
        let [along, other] =
            FacePoint::new(shape, middle, 1.0).tangents(&places).map(Vector3::from);
        let corners: Vec<Vector3<f64>> = face[..ends].iter().map(|node| at(*node)).collect();
        let normal = match &corners[..] {
            [a, b] => Vector3::new(a.y - b.y, b.x - a.x, 0.0),
            _ => along.cross(&other),
        };
        let thickness = heights * volumes[cell] / body.section() / flat_face::area(&corners);
        let edges: &[&[usize]] = if ends == 2 { &[&[0, 1, 2]] } else { shape.edges() };
        for edge in edges {
            let &[a, b, mid] = *edge else { continue };
            let rise = at(face[mid]) - 0.5 * (at(face[a]) + at(face[b]));
            let rise = rise.dot(&normal).abs() / normal.norm();
            let own = (8.0 * rise / thickness, thickness);
            if own.0 > ROUND_OFF && most.is_none_or(|most| own.0 > most.0) {
                most = Some(own);
            }
        }
    }
    most
}
