//! The walls of a chamber: their nodes, checked, in their order around.

use std::collections::{BTreeMap, BTreeSet};

use super::{Chamber, Triangle};
use crate::external::faces::{between, list};
use crate::external::surface::pieces;
use crate::input::InputError;
use crate::mesh::{Mesh, Selection};

impl Chamber {
    /// The edges of closed polygons.
    pub(super) fn edges(
        &self,
        mesh: &Mesh,
        selection: &Selection,
    ) -> Result<Vec<[usize; 2]>, InputError> {
        let nodes = mesh.select(selection)?;
        if nodes.len() < 3 {
            let mend = "a polygon needs 3 nodes at least";
            return Err(InputError::new(self.input("number of nodes"), nodes.len(), mend));
        }
        match selection {
            Selection::Numbers(_) => {
                let next = nodes.iter().cycle().skip(1);
                Ok(nodes.iter().zip(next).map(|(&node, &next)| [node, next]).collect())
            }
            Selection::Set(_) | Selection::Box { .. } => {
                let nodes = nodes.into_iter().collect();
                let edges = walls(boundary_edges(mesh), &nodes);
                let edges = edges.and_then(|edges| closed(edges, self.is_closed_by_line));
                edges.map_err(|problem| self.bad_walls(selection, &problem))
            }
        }
    }

    /// The triangles of the boundary of the body between the selected nodes, and those of lids.
    pub(super) fn faces(
        &self,
        mesh: &Mesh,
        selection: &Selection,
    ) -> Result<Vec<Triangle>, InputError> {
        let nodes = mesh.select(selection)?.into_iter().collect();
        let mut faces = mesh.boundary_faces();
        // the cells of a string are no walls
        faces.retain(|face| face.len() > 2);
        let faces = walls(faces, &nodes).map_err(|problem| self.bad_walls(selection, &problem))?;
        let is_quadratic = mesh.kind().is_quadratic();
        let outlines = faces.iter().map(|face| outline(face, is_quadratic));
        let lids = self.lids(outlines).map_err(|problem| self.bad_walls(selection, &problem))?;
        let parts = pieces(mesh.face_kind());
        let corner = |face: &[usize], part: &[usize]| [0, 1, 2].map(|corner| face[part[corner]]);
        let triangles = faces
            .iter()
            .flat_map(|face| parts.clone().map(move |(part, weight)| (corner(face, part), weight)));
        Ok(triangles.chain(lids).collect())
    }

    /// The triangles of a surface, and those of lids.
    pub(super) fn triangles(
        &self,
        mesh: &Mesh,
        triangles: &[[usize; 3]],
    ) -> Result<Vec<Triangle>, InputError> {
        for triangle in triangles {
            mesh.select(&(*triangle).into())?;
        }
        let triangles: Vec<[usize; 3]> =
            triangles.iter().map(|triangle| triangle.map(|number| number - 1)).collect();
        let lids = self.lids(triangles.iter().map(|triangle| triangle.to_vec()));
        let lids = lids.map_err(|problem| {
            InputError::new(self.input("number of triangles"), triangles.len(), problem)
        })?;
        Ok(triangles.into_iter().map(|triangle| (triangle, 1.0)).chain(lids).collect())
    }

    /// The lids on the rims of faces with these outlines. A lid goes from the mean of the nodes of its rim to each of its
    /// edges. Volumes are linear in that mean, so it is the mean of fans from each of the nodes.
    fn lids(&self, outlines: impl Iterator<Item = Vec<usize>>) -> Result<Vec<Triangle>, String> {
        let open = open_edges(outlines)?;
        let mut next = BTreeMap::new();
        for &[a, b] in &open {
            if next.insert(a, b).is_some() && self.is_closed_by_lid {
                return Err(format!(
                    "two rims meet at {}: a lid closes a rim that is by itself",
                    list(&[a])
                ));
            }
        }
        if !open.is_empty() && !self.is_closed_by_lid {
            let rim: BTreeSet<usize> = open.into_iter().flatten().collect();
            let rim: Vec<usize> = rim.into_iter().collect();
            return Err(format!(
                "the surface must be closed, but has a rim at {}: add the walls that are missing, or say \
                 closed_by_lid if a lid is to close it",
                list(&rim)
            ));
        }
        let mut triangles = Vec::new();
        while let Some((start, second)) = next.pop_first() {
            let mut rim = vec![start];
            let mut node = second;
            while node != start {
                rim.push(node);
                node = next.remove(&node).ok_or_else(|| {
                    format!("the rim ends at {}: a lid closes a rim that runs round", list(&[node]))
                })?;
            }
            let share = 1.0 / rim.len() as f64;
            for (k, &a) in rim.iter().enumerate() {
                let b = rim[(k + 1) % rim.len()];
                let apexes = rim.iter().filter(|apex| **apex != a && **apex != b);
                triangles.extend(apexes.map(|apex| ([*apex, b, a], share)));
            }
        }
        Ok(triangles)
    }

    fn bad_walls(&self, selection: &Selection, problem: &str) -> InputError {
        InputError::new(self.input("nodes"), format!("{selection:?}"), problem)
    }
}

/// The edges of the boundary of a body in the plane, two nodes each, the body to their left.
fn boundary_edges(mesh: &Mesh) -> Vec<[usize; 2]> {
    let parts = pieces(mesh.face_kind());
    let faces = mesh.boundary_faces();
    let edges =
        faces.iter().flat_map(|face| parts.clone().map(|(part, _)| [face[part[0]], face[part[1]]]));
    edges.collect()
}

/// 1 if the edges of a polygon run against the boundary of the body, -1 if along it.
pub(super) fn against_boundary(mesh: &Mesh, polygon: &[[usize; 2]]) -> Option<f64> {
    let edges: BTreeSet<[usize; 2]> = boundary_edges(mesh).into_iter().collect();
    let sense = |&[a, b]: &[usize; 2]| match [[b, a], [a, b]].map(|edge| edges.contains(&edge)) {
        [true, false] => Some(1.0),
        [false, true] => Some(-1.0),
        _ => None,
    };
    polygon.iter().find_map(sense)
}

/// The faces between `nodes`, if they touch all of them.
fn walls<F: AsRef<[usize]>>(faces: Vec<F>, nodes: &BTreeSet<usize>) -> Result<Vec<F>, String> {
    between(faces, nodes).map_err(|loose| {
        let walls = "walls are faces of the boundary of the body with all their nodes given";
        format!("{walls}, and {} are on none", list(&loose))
    })
}

/// Loops of edges as they are; one open chain with the edge that closes it, if a line may.
fn closed(mut edges: Vec<[usize; 2]>, by_line: bool) -> Result<Vec<[usize; 2]>, String> {
    // how many more edges begin at a node than end there
    let mut surplus: BTreeMap<usize, i32> = BTreeMap::new();
    for &[first, last] in &edges {
        *surplus.entry(first).or_default() += 1;
        *surplus.entry(last).or_default() -= 1;
    }
    surplus.retain(|_, surplus| *surplus != 0);
    match *surplus.iter().collect::<Vec<_>>() {
        [] => Ok(edges),
        [(&first, 1), (&last, -1)] | [(&last, -1), (&first, 1)] if by_line => {
            edges.push([last, first]);
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
            let mend = "they must be closed, but for one; and the cells of a string must all run \
                        the same way";
            Err(format!("they make open chains with ends at {}: {mend}", list(&ends)))
        }
    }
}

/// The nodes around a face, mid nodes between the corners.
fn outline(face: &[usize], is_quadratic: bool) -> Vec<usize> {
    match is_quadratic {
        false => face.to_vec(),
        true => {
            let (corners, middles) = face.split_at(face.len() / 2);
            corners.iter().zip(middles).flat_map(|(corner, middle)| [*corner, *middle]).collect()
        }
    }
}

/// The edges of faces with these outlines that no other face runs along the other way.
fn open_edges(outlines: impl Iterator<Item = Vec<usize>>) -> Result<Vec<[usize; 2]>, String> {
    let mut edges = BTreeSet::new();
    for face in outlines {
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            if !edges.insert([a, b]) {
                let mend = "turn the cells on one side of it round";
                return Err(format!(
                    "two faces run along the edge of {} the same way: {mend}",
                    list(&[a, b])
                ));
            }
        }
    }
    Ok(edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a])).copied().collect())
}
