//! What of the mesh is drawn: its nodes, its faces, its outline.

use serde_json::{Value, json};

use crate::mesh::Mesh;
use crate::output::svg::{BAR_WIDTH, around, through_middle};

/// The drawn part of a mesh.
pub(super) struct Geometry {
    /// How the page draws it.
    look: &'static str,
    /// The drawn nodes.
    pub(super) nodes: Vec<usize>,
    /// The cell of each face.
    pub(super) cells: Vec<usize>,
    /// The nodes of each face in their order around it, as places among the drawn nodes.
    faces: Vec<Vec<usize>>,
    /// The nodes of each edge of the outline in the plane, likewise.
    outline: Vec<Vec<usize>>,
    /// Place of each node of the mesh among the drawn ones.
    places: Vec<Option<usize>>,
    /// Width of a bar as drawn (m).
    width: f64,
    quadratic: bool,
}

impl Geometry {
    /// What is drawn of `mesh`: of a solid its surface, of other bodies all cells, and the nodes
    /// `besides` (springs end there, say).
    pub(super) fn new(mesh: &Mesh, besides: impl IntoIterator<Item = usize>) -> Self {
        let kind = mesh.kind();
        let (look, faces) = match (kind.dimension(), mesh.dimension()) {
            (1, 1) => ("bar", segments(mesh)),
            (1, _) => ("string", segments(mesh)),
            (_, 2) => ("area", cells(mesh)),
            (2, _) => ("membrane", cells(mesh)),
            _ => ("solid", surface(mesh)),
        };
        let mut places = vec![None; mesh.node_count()];
        let mut nodes = Vec::new();
        let drawn = faces.iter().flat_map(|(_, face)| face).copied();
        for node in drawn.chain(besides).collect::<Vec<_>>() {
            places[node].get_or_insert_with(|| {
                nodes.push(node);
                nodes.len() - 1
            });
        }
        let mut geometry = Self {
            look,
            nodes,
            cells: faces.iter().map(|&(cell, _)| cell).collect(),
            faces: Vec::new(),
            outline: Vec::new(),
            places,
            width: BAR_WIDTH * mesh.size(),
            quadratic: kind.is_quadratic(),
        };
        geometry.faces = faces.iter().map(|(_, face)| geometry.places(face)).collect();
        if look == "area" {
            let edges = mesh.boundary_faces();
            let edges = edges.iter().map(|edge| through_middle(edge).collect::<Vec<_>>());
            geometry.outline = edges.map(|edge| geometry.places(&edge)).collect();
        }
        geometry
    }

    /// The places of those of `nodes` that are drawn.
    pub(super) fn places(&self, nodes: &[usize]) -> Vec<usize> {
        nodes.iter().filter_map(|&node| self.places[node]).collect()
    }

    pub(super) fn to_json(&self) -> Value {
        let Self { look, faces, outline, width, quadratic, .. } = self;
        json!({
            "look": look,
            "faces": faces,
            "outline": outline,
            "width": width,
            "quadratic": quadratic,
        })
    }
}

type Faces = Vec<(usize, Vec<usize>)>;

fn segments(mesh: &Mesh) -> Faces {
    mesh.cells().map(<[usize]>::to_vec).enumerate().collect()
}

fn cells(mesh: &Mesh) -> Faces {
    mesh.cells().map(|cell| around(mesh.kind(), cell).collect()).enumerate().collect()
}

fn surface(mesh: &Mesh) -> Faces {
    let faces = mesh.boundary_faces_of_cells().into_iter();
    faces.map(|(cell, face)| (cell, around(mesh.kind(), &face).collect())).collect()
}
