//! Visible parts of the mesh: its nodes, its faces, its outline.

use serde_json::{Value, json};

use crate::elements::body::Body;
use crate::elements::mesh::Mesh;
use crate::io::output::svg::{BAR_WIDTH, around, drawn, through_middle};
use crate::scene::forces::LinePoint;

/// The drawn part of a mesh.
pub(super) struct Geometry {
    /// The bodies: name, how the page draws it, number of its faces.
    bodies: Vec<(String, &'static str, usize)>,
    /// The drawn nodes.
    pub(super) nodes: Vec<usize>,
    /// Ends of springs and places of cables apart from nodes, drawn after those.
    anchors: Vec<LinePoint>,
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
}

impl Geometry {
    /// Drawn geometry of `body`: of a solid its surface, of other bodies all cells, and in addition what
    /// springs are joined to and the nodes `points`.
    pub(super) fn new<'j>(
        body: &Body,
        joints: impl Iterator<Item = &'j LinePoint> + Clone,
        points: &[usize],
    ) -> Self {
        let joined = joints.clone().filter_map(LinePoint::node);
        let besides = joined.chain(points.iter().copied());
        let mesh = body.mesh();
        let (mut bodies, mut faces, mut anchors) = (Vec::new(), Vec::new(), Vec::new());
        // points of rods are numbered behind the nodes
        let count = mesh.node_count();
        for part in body.parts() {
            let own = part.body.mesh();
            let first = (part.cells.start, part.nodes.start);
            if let Some(tube) = part.body.tube() {
                let look = if own.dimension() == 2 { "area" } else { "solid" };
                bodies.push((part.name.to_owned(), look, tube.faces.len()));
                let place = |point: &usize| count + anchors.len() + point;
                let moved = |(cell, face): &(usize, Vec<usize>)| {
                    (first.0 + cell, face.iter().map(place).collect())
                };
                faces.extend(tube.faces.iter().map(moved).collect::<Faces>());
                anchors.extend(tube.points.into_iter().map(|shares| {
                    let shares = shares.into_iter().map(|(node, share)| (first.1 + node, share));
                    LinePoint::carried(mesh, shares.collect())
                }));
                continue;
            }
            let (look, drawn) = match (own.kind().dimension(), own.dimension()) {
                (1, 1) => ("bar", segments(own)),
                (1, _) => ("string", segments(own)),
                (_, 2) => ("area", cells(own)),
                (2, _) if !own.has_inside() => ("membrane", cells(own)),
                _ => ("solid", surface(own)),
            };
            bodies.push((part.name.to_owned(), look, drawn.len()));
            faces.extend(drawn.into_iter().map(|(cell, mut face)| {
                face.iter_mut().for_each(|node| *node += first.1);
                (first.0 + cell, face)
            }));
        }
        for joint in joints.filter(|joint| joint.node().is_none()) {
            if !anchors.contains(joint) {
                anchors.push(joint.clone());
            }
        }
        let mut places = vec![None; count];
        let mut nodes = Vec::new();
        let drawn = faces.iter().flat_map(|(_, face)| face).copied().filter(|node| *node < count);
        for node in drawn.chain(besides).collect::<Vec<_>>() {
            places[node].get_or_insert_with(|| {
                nodes.push(node);
                nodes.len() - 1
            });
        }
        let mut geometry = Self {
            bodies,
            nodes,
            anchors,
            cells: faces.iter().map(|&(cell, _)| cell).collect(),
            faces: Vec::new(),
            outline: Vec::new(),
            places,
            width: BAR_WIDTH * mesh.size(),
        };
        geometry.faces = faces.iter().map(|(_, face)| geometry.places(face)).collect();
        if mesh.dimension() == 2 {
            // the faces of a string are its cells
            let areas = body.parts().filter(|part| part.body.mesh().kind().dimension() == 2);
            let outlines = areas.flat_map(|part| {
                let mut edges = part.body.mesh().boundary_faces();
                edges.iter_mut().flatten().for_each(|node| *node += part.nodes.start);
                edges
            });
            let edges: Vec<_> = outlines.collect();
            let edges = edges.iter().map(|edge| through_middle(edge).collect::<Vec<_>>());
            geometry.outline = edges.map(|edge| geometry.places(&edge)).collect();
        }
        geometry
    }

    /// The places of those of `nodes`, and of points behind these, that are drawn.
    pub(super) fn places(&self, nodes: &[usize]) -> Vec<usize> {
        let place = |&node: &usize| match node.checked_sub(self.places.len()) {
            None => self.places[node],
            Some(point) => Some(self.nodes.len() + point),
        };
        nodes.iter().filter_map(place).collect()
    }

    /// The nodes of a face; those on the axis of a rod.
    pub(super) fn nodes_of(&self, face: usize) -> impl Iterator<Item = usize> {
        self.faces[face].iter().map(|&place| match self.nodes.get(place) {
            Some(node) => *node,
            None => self.anchors[place - self.nodes.len()].shares[0].0,
        })
    }

    /// The positions of the ends of a spring, or of the points of a cable.
    pub(super) fn ends(&self, joints: &[LinePoint]) -> Vec<usize> {
        let place = |joint: &LinePoint| match joint.node() {
            Some(node) => self.places[node],
            None => {
                let among = self.anchors.iter().position(|anchor| anchor == joint);
                among.map(|number| self.nodes.len() + number)
            }
        };
        joints.iter().filter_map(place).collect()
    }

    /// Positions of the anchors in a space of `dimension` under the displacements `u` (m), as they are drawn.
    pub(super) fn anchors(&self, dimension: usize, u: &[f64]) -> impl Iterator<Item = f64> {
        let drawn = move |joint: &LinePoint| {
            let mut x = joint.at;
            for &(node, share) in &joint.shares {
                let own = &u[node * dimension..][..dimension];
                x.iter_mut().zip(own).for_each(|(x, u)| *x += share * u);
            }
            match dimension {
                1 | 2 => drawn(&x[..dimension]).to_vec(),
                _ => x.to_vec(),
            }
        };
        self.anchors.iter().flat_map(drawn)
    }

    /// Number of drawn nodes and anchors.
    pub(super) fn count(&self) -> usize {
        self.nodes.len() + self.anchors.len()
    }

    pub(super) fn to_json(&self) -> Value {
        let Self { bodies, nodes, faces, outline, width, .. } = self;
        let bodies = bodies
            .iter()
            .map(|(name, look, faces)| json!({ "name": name, "look": look, "faces": faces }));
        json!({
            "bodies": bodies.collect::<Vec<_>>(),
            "nodes": nodes.len(),
            "faces": faces,
            "outline": outline,
            "width": width,
        })
    }
}

type Faces = Vec<(usize, Vec<usize>)>;

fn segments(mesh: &Mesh) -> Faces {
    mesh.cells().map(<[usize]>::to_vec).enumerate().collect()
}

fn cells(mesh: &Mesh) -> Faces {
    mesh.cells().map(|cell| around(cell).collect()).enumerate().collect()
}

fn surface(mesh: &Mesh) -> Faces {
    let faces = mesh.boundary_faces_of_cells().into_iter();
    faces.map(|(cell, face)| (cell, around(&face).collect())).collect()
}

/// A vector as the page draws it: upright in one dimension.
pub(super) fn in_view(x: &[f64]) -> Vec<f64> {
    if x.len() < 3 { drawn(x).to_vec() } else { x.to_vec() }
}
