//! Checks of a body before a run: its cells and its pieces.

use std::collections::BTreeMap;

use super::each::named;
use crate::dynamics::report::Indicator;
use crate::elements::body::{Body, Dilatation, Part};
use crate::elements::material::NEARLY_INCOMPRESSIBLE;
use crate::elements::mesh::CellKind;
use crate::scene::constraint::PhaseStart;
use crate::scene::timeline::Scene;

/// Largest Poisson's ratio for quadratic cells that can lock; for linear ones it is [`NEARLY_INCOMPRESSIBLE`].
const MOST_POISSON_QUADRATIC: f64 = 0.48;

/// Nearly incompressible material in cells that cannot bend without changing their volume: linear ones get several times too stiff,
/// quadratic ones by a tenth or two where one cell is across a wall.
pub(super) fn locking(body: &Body) -> Option<Indicator> {
    if !body.can_lock() {
        return None;
    }
    let most = body.materials().map(|material| material.poisson).fold(-1.0, f64::max);
    locking_linear(body, most).or_else(|| locking_quadratic(body, most))
}

/// Residual locking of quadratic cells: with pointwise dilatation they are too stiff, with a cell mean some are too
/// soft.
fn locking_quadratic(body: &Body, most: f64) -> Option<Indicator> {
    let mesh = body.mesh();
    let help = match mesh.kind() {
        CellKind::Triangle6 | CellKind::Tetrahedron10 => {
            "`bubbles = true` in `mesh` (Mesh::with_bubbles) with dilatation = \"linear\""
        }
        CellKind::Hexahedron20 => "dilatation = \"linear\", and hexahedra27 where pressures count",
        kind if kind.is_quadratic() => "dilatation = \"linear\"",
        _ => return None,
    };
    let off = match (body.dilatation(), mesh.kind()) {
        (Dilatation::AtPoints, _) => "some 10 to 20 % too stiff",
        (Dilatation::Mean, CellKind::Triangle6 | CellKind::Tetrahedron10) => return None,
        (Dilatation::Mean, _) => "twice too soft",
        (Dilatation::Linear, _) => return None,
    };
    let cells = mesh.kind().name();
    let told = format!("Poisson's ratio {most} in {cells} (limit: {MOST_POISSON_QUADRATIC})");
    let beyond =
        || format!("{told}: with one cell across it a wall is {off} in bending; take {help}");
    let limits = [-1.0, MOST_POISSON_QUADRATIC];
    Some(Indicator::trusted("poisson", (most, "1"), limits, || told.clone(), beyond))
}

fn locking_linear(body: &Body, most: f64) -> Option<Indicator> {
    let other = match body.mesh().kind() {
        CellKind::Triangle if is_crossed(body) => return None,
        CellKind::Triangle => " or \"crossed\" ones",
        CellKind::Quadrilateral | CellKind::Hexahedron if body.dilatation() == Dilatation::Mean => {
            return None;
        }
        CellKind::Quadrilateral => ", \"crossed\" triangles or dilatation = \"mean\"",
        CellKind::Hexahedron => " or dilatation = \"mean\"",
        _ => "",
    };
    let help = quadratic_cells(body.mesh().kind())?;
    let cells = body.mesh().kind().name();
    let told = format!("Poisson's ratio {most} in linear {cells} (limit: {NEARLY_INCOMPRESSIBLE})");
    let beyond = || {
        format!(
            "{told}: they lock, and may be several times too stiff in bending; take {help}{other}, or a smaller ratio"
        )
    };
    let limits = [-1.0, NEARLY_INCOMPRESSIBLE];
    Some(Indicator::trusted("poisson", (most, "1"), limits, || told.clone(), beyond))
}

/// Quadratic cells to take for linear ones that fill a plane or space.
pub(super) fn quadratic_cells(kind: CellKind) -> Option<&'static str> {
    match kind {
        CellKind::Triangle => {
            Some("quadratic cells (\"triangles6\"; in Gmsh: Mesh.ElementOrder = 2)")
        }
        CellKind::Quadrilateral => Some("quadratic cells (\"triangles6\")"),
        CellKind::Tetrahedron => {
            Some("quadratic cells (\"tetrahedra10\"; in Gmsh: Mesh.ElementOrder = 2)")
        }
        CellKind::Hexahedron => Some(
            "quadratic cells (\"hexahedra20\" or \"tetrahedra10\"; in Gmsh: Mesh.ElementOrder = 2 and, for hexahedra, \
             Mesh.SecondOrderIncomplete = 1)",
        ),
        CellKind::Segment
        | CellKind::Triangle6
        | CellKind::Triangle7
        | CellKind::Tetrahedron10
        | CellKind::Tetrahedron15
        | CellKind::Quadrilateral9
        | CellKind::Hexahedron20
        | CellKind::Hexahedron27 => None,
    }
}

/// Whether each triangle has a corner at which exactly four triangles meet (on the boundary, two or one), as
/// in a quadrilateral divided by both its diagonals. There one of the volume constraints of the four follows
/// from the others.
fn is_crossed(body: &Body) -> bool {
    let mesh = body.mesh();
    let mut cells_at = vec![0; mesh.node_count()];
    mesh.cells().flatten().for_each(|&node| cells_at[node] += 1);
    // as if the mesh went on beyond the boundary
    mesh.boundary_nodes().iter().for_each(|&node| cells_at[node] = 2 * cells_at[node].max(2));
    mesh.cells().all(|cell| cell.iter().any(|&node| cells_at[node] == 4))
}

/// Pieces of each body that neither cells nor springs, other forces or constraints of several nodes join.
pub(super) fn pieces(scene: &Scene) -> Vec<Indicator> {
    let body = scene.body();
    let mut pieces = body.inertia().pattern().pieces();
    if pieces.iter().max() >= Some(&body.parts().count()) {
        pieces = body.inertia().pattern().with_pairs(&joints(scene)).pieces();
    }
    let of_body = |part: Part| {
        named(part.name, body, pieces_of(&pieces[part.nodes.clone()], part.nodes.start).into_iter())
    };
    body.parts().flat_map(of_body).collect()
}

/// Those of a body whose nodes are in these `pieces`; `first_node` is the first of them.
fn pieces_of(pieces: &[usize], first_node: usize) -> Option<Indicator> {
    let whole = || "the body is of one piece (limit: 1 piece)".to_owned();
    let mut sizes = BTreeMap::new();
    pieces.iter().for_each(|&piece| *sizes.entry(piece).or_insert(0) += 1);
    let count = sizes.len();
    if count == 1 {
        return Some(Indicator::trusted("pieces", (1.0, ""), [1.0, 1.0], whole, String::new));
    }
    // point masses come after all other nodes, so that the smallest piece is identified by its first node
    let (smallest, nodes) = sizes.into_iter().min_by_key(|(_, nodes)| *nodes)?;
    let first = first_node + pieces.iter().position(|&piece| piece == smallest)?;
    let beyond = || {
        format!(
            "the body consists of {count} pieces that nothing joins and that pass through each other (limit: \
             1 piece); the smallest, with node {}, has {nodes} of {} nodes: merge nodes in the same place (in \
             Gmsh: Coherence), or join the pieces by springs",
            first + 1,
            pieces.len()
        )
    };
    Some(Indicator::trusted("pieces", (count as f64, ""), [1.0, 1.0], whole, beyond))
}

/// Pairs of nodes that are joined, but not by cells.
fn joints(scene: &Scene) -> Vec<[usize; 2]> {
    let body = scene.body();
    let mut joints = Vec::new();
    for line in scene.actuators().iter().filter_map(|own| own.line(body).ok()) {
        let nodes = line.iter().flat_map(|point| &point.shares).map(|share| share.0);
        joints.extend(nodes.clone().zip(nodes.skip(1)).map(|(one, other)| [one, other]));
    }
    joints.extend(scene.other_forces().iter().flat_map(|force| force.couplings()));
    let start = PhaseStart { time: 0.0, u: scene.initial_displacements() };
    let rows = scene.phases().iter().filter_map(|phase| scene.rows(phase, &start).ok());
    for row in rows.flatten() {
        let nodes: Vec<usize> = row.terms.iter().map(|(dof, _)| dof / body.dimension()).collect();
        joints.extend(nodes.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    joints
}
