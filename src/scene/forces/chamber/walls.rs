//! The walls of a chamber: their nodes, checked, and in their order around it.

use std::collections::{BTreeMap, BTreeSet};

use super::Chamber;
use super::enclosure::Part;
use crate::base::input::InputError;
use crate::elements::body::Body;
use crate::elements::mesh::{CellKind, Face, FaceKind, Mesh, Selection};
use crate::scene::forces::faces::{between, list, number_of, straight_parts, volume_parts};

/// Geometry assumed for walls with mid nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Curved, by the shape functions.
    Curved,
    /// Straight pieces between the nodes.
    Straight,
}

impl Shape {
    fn parts<const N: usize>(self, kind: FaceKind) -> Vec<([usize; N], f64)> {
        match self {
            Self::Curved => volume_parts(kind),
            Self::Straight => straight_parts(kind),
        }
    }
}

impl Chamber {
    /// The edges of closed polygons: their ends and, of curved ones, the node in their middle.
    pub(super) fn edges(
        &self,
        body: &Body,
        selection: &Selection,
    ) -> Result<Vec<Face>, InputError> {
        let mesh = body.mesh();
        let nodes = mesh.select(selection)?;
        if nodes.len() < 3 {
            let help = "a polygon needs 3 nodes at least";
            return Err(InputError::new(self.input("number of nodes"), nodes.len(), help));
        }
        match selection {
            Selection::Numbers(_) => Ok(polygon(mesh, &nodes)),
            Selection::Set(_) | Selection::Box { .. } => {
                let nodes = nodes.into_iter().collect();
                let edges = walls(mesh.boundary_faces(), &nodes);
                let axis = body.is_axisymmetric().then(|| body.nodes_on_axis());
                let edges =
                    edges.and_then(|edges| closed(edges, self.is_closed_by_line, axis.as_deref()));
                edges.map_err(|problem| self.bad_walls(selection, &problem))
            }
        }
    }

    /// The faces of the boundary of the body in space between the selected nodes.
    pub(super) fn boundary(
        &self,
        mesh: &Mesh,
        selection: &Selection,
    ) -> Result<Vec<Face>, InputError> {
        let nodes = mesh.select(selection)?.into_iter().collect();
        let mut faces = mesh.boundary_faces();
        // the cells of a string are no walls
        faces.retain(|face| face.len() > 2);
        walls(faces, &nodes).map_err(|problem| self.bad_walls(selection, &problem))
    }

    /// The triangles of the boundary of the body between the selected nodes, and those of lids.
    pub(super) fn faces(
        &self,
        mesh: &Mesh,
        selection: &Selection,
        shape: Shape,
    ) -> Result<Vec<Part<3>>, InputError> {
        let faces = self.boundary(mesh, selection)?;
        let outlines = faces.iter().map(|face| outline(face, face.len() > 4));
        let lids =
            self.lids(outlines, shape).map_err(|problem| self.bad_walls(selection, &problem))?;
        let (mut all, mut by_kind) = (Vec::new(), Vec::new());
        for face in &faces {
            let kind = number_of(mesh.face_kind(face), &mut by_kind, |kind| shape.parts::<3>(kind));
            let part = |&(part, weight): &Part<3>| (part.map(|local| face[local]), weight);
            all.extend(by_kind[kind].1.iter().map(part));
        }
        all.extend(lids);
        Ok(all)
    }

    /// The triangles of a surface, and those of lids.
    pub(super) fn triangles(
        &self,
        mesh: &Mesh,
        triangles: &[[usize; 3]],
    ) -> Result<Vec<Part<3>>, InputError> {
        for triangle in triangles {
            mesh.select(&(*triangle).into())?;
        }
        let triangles: Vec<[usize; 3]> =
            triangles.iter().map(|triangle| triangle.map(|number| number - 1)).collect();
        let outlines = triangles.iter().map(|triangle| outline(triangle, false));
        let lids = self.lids(outlines, Shape::Straight);
        let lids = lids.map_err(|problem| {
            InputError::new(self.input("number of triangles"), triangles.len(), problem)
        })?;
        Ok(triangles.into_iter().map(|triangle| (triangle, 1.0)).chain(lids).collect())
    }

    /// The lids on the rims of faces with these outlines. A lid goes from the mean of the nodes of its rim to
    /// each of its edges, curved or not. Volumes are linear in that mean, so that of a lid is the mean of
    /// those of fans from each of the nodes.
    fn lids(
        &self,
        outlines: impl Iterator<Item = Vec<Face>>,
        shape: Shape,
    ) -> Result<Vec<Part<3>>, String> {
        let open = open_edges(outlines)?;
        if !open.is_empty() && !self.is_closed_by_lid {
            let rim: BTreeSet<usize> = open.into_iter().flatten().collect();
            let rim: Vec<usize> = rim.into_iter().collect();
            return Err(format!(
                "the surface must be closed, but has a rim at {}: add the walls that are missing, or say \
                 closed_by_lid if a lid is to close it",
                list(&rim)
            ));
        }
        // by their first nodes
        let mut next = BTreeMap::new();
        for edge in open {
            let start = edge[0];
            if next.insert(start, edge).is_some() {
                return Err(format!(
                    "two rims meet at {}: a lid closes a rim that is by itself",
                    list(&[start])
                ));
            }
        }
        let mut triangles = Vec::new();
        while let Some((start, first)) = next.pop_first() {
            let mut rim = vec![first];
            let mut node = rim[0][1];
            while node != start {
                let edge = next.remove(&node).ok_or_else(|| {
                    format!("the rim ends at {}: a lid closes a rim that runs round", list(&[node]))
                })?;
                node = edge[1];
                rim.push(edge);
            }
            let on_it = |edge: &Face| [&edge[..1], &edge[2..]].concat();
            let apexes: Vec<usize> = rim.iter().flat_map(on_it).collect();
            let share = 1.0 / apexes.len() as f64;
            for ([a, b], part) in edge_parts(&rim, shape) {
                let others = apexes.iter().filter(|apex| **apex != a && **apex != b);
                triangles.extend(others.map(|apex| ([*apex, b, a], share * part)));
            }
        }
        Ok(triangles)
    }

    fn bad_walls(&self, selection: &Selection, problem: &str) -> InputError {
        InputError::new(self.input("nodes"), format!("{selection:?}"), problem)
    }
}

/// The edges of the polygon through `nodes`: curved where it runs along edges of cells with mid nodes.
fn polygon(mesh: &Mesh, nodes: &[usize]) -> Vec<Face> {
    let middles = |(kind, cell): (CellKind, &'_ [usize])| {
        let curved = kind.edges().iter().filter(|edge| edge.len() == 3);
        let ends = curved.map(|edge| (cell[edge[2]], [cell[edge[0]], cell[edge[1]]]));
        ends.collect::<Vec<_>>()
    };
    let ends_of_middles: BTreeMap<usize, [usize; 2]> =
        mesh.cells_with_kinds().flat_map(middles).collect();
    let count = nodes.len();
    let at = |k: usize| nodes[k % count];
    let is_middle = |k: usize| {
        let [before, after] = [at(k + count - 1), at(k + 1)];
        let ends = ends_of_middles.get(&at(k));
        ends.is_some_and(|ends| *ends == [before, after] || *ends == [after, before])
    };
    let edge = |k: usize| match (is_middle(k), is_middle(k + 1)) {
        (true, _) => None,
        (_, true) => Some(vec![at(k), at(k + 2), at(k + 1)]),
        _ => Some(vec![at(k), at(k + 1)]),
    };
    (0..count).filter_map(edge).collect()
}

/// The parts of edges in the area that they enclose.
pub(super) fn edge_parts(edges: &[Face], shape: Shape) -> Vec<Part<2>> {
    let [straight, curved] =
        [FaceKind::Segment, FaceKind::Segment3].map(|kind| shape.parts::<2>(kind));
    let of_edge = |edge: &Face| {
        let parts = if edge.len() == 2 { &straight } else { &curved };
        let part = |&(part, weight): &Part<2>| (part.map(|local| edge[local]), weight);
        parts.iter().map(part).collect::<Vec<_>>()
    };
    edges.iter().flat_map(of_edge).collect()
}

/// 1 if the edges of a polygon run against the boundary of the body, -1 if along it.
pub(super) fn against_boundary(mesh: &Mesh, polygon: &[Face]) -> Option<f64> {
    let faces = mesh.boundary_faces();
    let boundary: BTreeSet<&[usize]> = faces.iter().map(|face| &face[..2]).collect();
    let sense = |edge: &Face| {
        let [a, b] = [edge[0], edge[1]];
        match [[b, a], [a, b]].map(|ends| boundary.contains(&ends[..])) {
            [true, false] => Some(1.0),
            [false, true] => Some(-1.0),
            _ => None,
        }
    };
    polygon.iter().find_map(sense)
}

/// The faces between `nodes`, if they touch all of them.
fn walls(faces: Vec<Face>, nodes: &BTreeSet<usize>) -> Result<Vec<Face>, String> {
    between(faces, nodes).map_err(|loose| {
        let walls = "walls are faces of the boundary of the body with all their nodes given";
        format!("{walls}, and {} are on none", list(&loose))
    })
}

/// Loops of edges as they are; one open chain with the edge that closes it added, if `by_line`. In a body of revolution chains are closed
/// where they end at nodes on the `axis`, and the disc that closes one at its other end has no edge: it encloses nothing more.
fn closed(
    mut edges: Vec<Face>,
    by_line: bool,
    axis: Option<&[usize]>,
) -> Result<Vec<Face>, String> {
    // how many more edges begin at a node than end there
    let mut surplus: BTreeMap<usize, i32> = BTreeMap::new();
    for edge in &edges {
        *surplus.entry(edge[0]).or_default() += 1;
        *surplus.entry(edge[1]).or_default() -= 1;
    }
    let is_on_axis = |node: &usize| axis.is_some_and(|axis| axis.contains(node));
    surplus.retain(|node, surplus| *surplus != 0 && !is_on_axis(node));
    match *surplus.iter().collect::<Vec<_>>() {
        [] => Ok(edges),
        [(end, 1 | -1)] if axis.is_some() => match by_line {
            true => Ok(edges),
            false => Err(format!(
                "they are open between node {} and the axis: add the walls that are missing, or say closed_by_line if a level disc there is to \
                 close the chamber",
                end + 1
            )),
        },
        [(&first, 1), (&last, -1)] | [(&last, -1), (&first, 1)] if by_line => {
            edges.push(vec![last, first]);
            Ok(edges)
        }
        [(first, 1 | -1), (last, 1 | -1)] => Err(format!(
            "they are open between the nodes {} and {}: add the walls that are missing, or say closed_by_line if \
             the straight line between them is to close the chamber",
            first + 1,
            last + 1
        )),
        _ => {
            let ends: Vec<usize> = surplus.into_keys().collect();
            let help = "they must be closed, but for one; and the cells of a string must all run \
                        the same way";
            Err(format!("they make open chains with ends at {}: {help}", list(&ends)))
        }
    }
}

/// The edges around a face: two ends each, and the node between them if it is quadratic.
fn outline(face: &[usize], is_quadratic: bool) -> Vec<Face> {
    let count = if is_quadratic { face.len() / 2 } else { face.len() };
    let (corners, middles) = face.split_at(count);
    let ends = |k: usize| [corners[k], corners[(k + 1) % count]];
    (0..count).map(|k| ends(k).iter().chain(middles.get(k)).copied().collect()).collect()
}

/// The edges, of faces with these outlines, along which no other face runs in the opposite direction.
fn open_edges(outlines: impl Iterator<Item = Vec<Face>>) -> Result<Vec<Face>, String> {
    let mut edges: BTreeMap<[usize; 2], Face> = BTreeMap::new();
    for edge in outlines.flatten() {
        let ends = [edge[0], edge[1]];
        if edges.insert(ends, edge).is_some() {
            let help = "turn the cells on one side of it round";
            let nodes = list(&ends);
            return Err(format!("two faces run along the edge of {nodes} the same way: {help}"));
        }
    }
    let is_open = |[a, b]: &[usize; 2]| !edges.contains_key(&[*b, *a]);
    Ok(edges.iter().filter(|(ends, _)| is_open(ends)).map(|(_, edge)| edge.clone()).collect())
}
