//! The finer meshes of several bodies as one.

use std::collections::BTreeMap;

use super::{Corners, Finer, NodeOrigin};
use crate::elements::mesh::Mesh;

impl Finer {
    /// `mesh` as it is.
    pub(crate) fn none(mesh: &Mesh) -> Self {
        let nodes = mesh.node_count();
        let mut is_boundary = vec![false; nodes];
        mesh.boundary_nodes().iter().for_each(|&node| is_boundary[node] = true);
        Self {
            mesh: mesh.clone(),
            first_child: (0..=mesh.cell_count()).collect(),
            olds: (0..nodes).collect(),
            places: (0..nodes).map(NodeOrigin::at).collect(),
            numbers: BTreeMap::new(),
            is_boundary,
        }
    }

    /// The meshes of several bodies as [one](Mesh::join), from those of each, with its name.
    pub(crate) fn join(bodies: Vec<(&str, Self)>) -> Self {
        let mesh = Mesh::join(bodies.iter().map(|(name, own)| (*name, &own.mesh)));
        let mut all = Self {
            mesh,
            first_child: vec![0],
            olds: Vec::new(),
            places: Vec::new(),
            numbers: BTreeMap::new(),
            is_boundary: Vec::new(),
        };
        for (_, own) in bodies {
            let (old, new) = (all.olds.len(), all.places.len());
            let cell = all.first_child[all.first_child.len() - 1];
            let moved = |corners: Corners| -> Corners {
                corners.into_iter().map(|(node, part)| (old + node, part)).collect()
            };
            all.first_child.extend(own.first_child[1..].iter().map(|first| cell + first));
            all.olds.extend(own.olds.iter().map(|node| new + node));
            all.numbers.extend(own.numbers.into_iter().map(|(at, node)| (moved(at), new + node)));
            all.places.extend(own.places.into_iter().map(|place| NodeOrigin {
                corners: moved(place.corners),
                shares: place.shares.into_iter().map(|(node, part)| (old + node, part)).collect(),
            }));
            all.is_boundary.extend(own.is_boundary);
        }
        all
    }
}
