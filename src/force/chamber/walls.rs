//! The walls of a chamber: their nodes, checked, in their order around.

use std::collections::{BTreeMap, BTreeSet};

use super::Chamber;
use crate::error::Error;
use crate::mesh::{Mesh, Selection};

impl Chamber {
    /// The nodes of a polygon in their order around, and their natural positions.
    pub(super) fn polygon_nodes(
        &self,
        mesh: &Mesh,
        selection: &Selection,
    ) -> Result<(Vec<usize>, Vec<[f64; 2]>), Error> {
        let selected = mesh.select(selection)?;
        if selected.len() < 3 {
            let mend = "a polygon needs 3 nodes at least";
            return Err(Error::input(self.input("number of nodes"), selected.len(), mend));
        }
        let nodes = match selection {
            Selection::Numbers(_) => selected,
            Selection::Set(_) | Selection::Box { .. } => along_boundary(mesh, &selected)
                .ok_or_else(|| {
                    let mend = "they do not follow each other along the boundary of the body: name \
                                them by number, in their order around";
                    Error::input(self.input("nodes"), format!("{selection:?}"), mend)
                })?,
        };
        let corner = |&node: &usize| [mesh.position(node)[0], mesh.position(node)[1]];
        let corners = nodes.iter().map(corner).collect();
        Ok((nodes, corners))
    }

    /// The nodes of the triangles of a surface, and their natural positions.
    #[allow(clippy::type_complexity)]
    pub(super) fn surface_nodes(
        &self,
        mesh: &Mesh,
        triangles: &[[usize; 3]],
    ) -> Result<(Vec<[usize; 3]>, Vec<[[f64; 3]; 3]>), Error> {
        let mut edges = BTreeSet::new();
        for (k, triangle) in triangles.iter().enumerate() {
            mesh.select(&(*triangle).into())?;
            for i in 0..3 {
                let edge = [triangle[i], triangle[(i + 1) % 3]];
                if !edges.insert(edge) {
                    let mend = format!(
                        "another triangle has the edge {edge:?}, too, running the same way: turn \
                         one of them round, or leave it out"
                    );
                    let input = self.input(&format!("triangle {}", k + 1));
                    return Err(Error::input(input, format!("{triangle:?}"), mend));
                }
            }
        }
        if let Some([a, b]) = edges.iter().find(|[a, b]| !edges.contains(&[*b, *a])) {
            let mend = "no triangle has it the other way round: the surface must be closed";
            return Err(Error::input(self.input("edge"), format!("{:?}", [a, b]), mend));
        }
        let triangles: Vec<[usize; 3]> =
            triangles.iter().map(|triangle| triangle.map(|number| number - 1)).collect();
        let corner = |node: usize| std::array::from_fn(|i| mesh.position(node)[i]);
        let corners = triangles.iter().map(|nodes| nodes.map(corner)).collect();
        Ok((triangles, corners))
    }
}

/// The edges of the boundary of a body in the plane, two nodes each, the body to their left.
fn boundary_edges(mesh: &Mesh) -> Vec<[usize; 2]> {
    let mut edges = Vec::new();
    for face in mesh.boundary_faces() {
        match face[..] {
            [first, last] => edges.push([first, last]),
            // corners first, then the node in the middle
            [first, last, middle] => edges.extend([[first, middle], [middle, last]]),
            _ => {}
        }
    }
    edges
}

/// 1 if the edges of a polygon run against the boundary of the body, -1 if along it.
pub(super) fn against_boundary(
    mesh: &Mesh,
    mut polygon: impl Iterator<Item = [usize; 2]>,
) -> Option<f64> {
    let edges: BTreeSet<[usize; 2]> = boundary_edges(mesh).into_iter().collect();
    let sense = |[a, b]: [usize; 2]| match [[b, a], [a, b]].map(|edge| edges.contains(&edge)) {
        [true, false] => Some(1.0),
        [false, true] => Some(-1.0),
        _ => None,
    };
    polygon.find_map(sense)
}

/// `selected` in their order along the boundary of the body, if its edges make one chain or one
/// loop of them.
fn along_boundary(mesh: &Mesh, selected: &[usize]) -> Option<Vec<usize>> {
    let chosen: BTreeSet<usize> = selected.iter().copied().collect();
    let edges = boundary_edges(mesh).into_iter();
    let after: BTreeMap<usize, usize> = edges
        .filter(|edge| edge.iter().all(|node| chosen.contains(node)))
        .map(|[a, b]| (a, b))
        .collect();
    let reached: BTreeSet<usize> = after.values().copied().collect();
    let mut starts = selected.iter().filter(|node| !reached.contains(node));
    let first = *starts.next().unwrap_or(&selected[0]);
    let rest = std::iter::successors(after.get(&first), |node| after.get(node));
    let order: Vec<usize> = std::iter::once(&first)
        .chain(rest.take_while(|&&node| node != first))
        .take(selected.len())
        .copied()
        .collect();
    (order.len() == selected.len()).then_some(order)
}
