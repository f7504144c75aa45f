//! Maps of a mesh to a smaller equivalent one: one side of a plane of symmetry, the section of a prism.
//!
//! Each node has an image in the mesh itself: across the plane, or the first node of its line along the axis. What is the same in
//! an image has its sign along the axis changed, or vanishes there. Faces between nodes of a plane of symmetry are no boundary of the
//! smaller mesh, so that nothing touches the cut.

use super::Mesh;
use crate::base::vector::{axes_across, distinct};

/// The map of the nodes and cells of a mesh to those of a smaller one.
#[derive(Debug, Clone)]
pub(crate) struct NodeMap {
    /// The smaller mesh of each body, without point masses; none of a body on the omitted side.
    pub(crate) meshes: Vec<Option<Mesh>>,
    /// The number of the axis across which it is.
    pub(crate) axis: usize,
    /// Ends of the prism on the axis (m); twice the position of a plane of symmetry.
    pub(crate) ends: [f64; 2],
    /// Whether a half is that above the plane.
    pub(crate) is_upper: bool,
    /// Factor of the component along the axis in the image of a vector: -1 of a mirror image, 0 in a section.
    pub(super) across: f64,
    /// The image of each node.
    pub(crate) images: Vec<usize>,
    /// The image of each cell, of those that have one.
    pub(crate) cell_images: Vec<Option<usize>>,
    /// The node of the smaller mesh (from 0) that represents each node; none on the omitted side.
    pub(crate) numbers: Vec<Option<usize>>,
    /// The same of the cells.
    pub(crate) cells: Vec<Option<usize>>,
    /// Nodes of the smaller mesh that represent none: each with its neighbours, and their weights.
    pub(super) middles: Vec<(usize, Vec<(usize, f64)>)>,
}

impl NodeMap {
    /// Whether a position (m) on the axis belongs to the half.
    pub(crate) fn is_kept(&self, x: f64) -> bool {
        (x > self.ends[0]) == self.is_upper
    }

    pub(crate) fn is_section(&self) -> bool {
        self.across == 0.0
    }

    /// Whether a node is on the plane of symmetry.
    pub(crate) fn is_on_plane(&self, node: usize) -> bool {
        !self.is_section() && self.images[node] == node
    }

    /// The node of the smaller mesh that represents a node or its image.
    pub(crate) fn number(&self, node: usize) -> usize {
        let [own, image] = [node, self.images[node]].map(|node| self.numbers[node]);
        own.or(image).unwrap_or_default()
    }

    /// Share of a node in the smaller mesh: half on the plane of symmetry.
    pub(crate) fn share(&self, node: usize) -> f64 {
        if self.is_on_plane(node) { 0.5 } else { 1.0 }
    }

    /// The number of axes of the smaller meshes.
    fn dimension(&self) -> usize {
        self.meshes.iter().flatten().next().map_or(0, Mesh::dimension)
    }

    /// The axes of the smaller mesh, by their numbers here.
    pub(crate) fn axes(&self) -> Vec<usize> {
        match self.is_section() {
            true => axes_across(self.axis).into(),
            false => (0..self.dimension()).collect(),
        }
    }

    /// A vector along them.
    pub(crate) fn vector(&self, x: &[f64]) -> Vec<f64> {
        self.axes().iter().map(|&i| x[i]).collect()
    }

    /// The image of a component of a node, and the factor of its value there.
    pub(crate) fn image(&self, dof: usize, dimension: usize) -> (usize, f64) {
        let (node, i) = (dof / dimension, dof % dimension);
        let factor = if i == self.axis { self.across } else { 1.0 };
        (self.images[node] * dimension + i, factor)
    }

    /// The images of some nodes (from 0), ascending; of lines along the axis themselves. `None` of parts of such lines.
    pub(crate) fn images_of(&self, nodes: &[usize]) -> Option<Vec<usize>> {
        match self.is_section() {
            true => self.whole(nodes).map(|_| distinct(nodes.iter().copied())),
            false => Some(distinct(nodes.iter().map(|&node| self.images[node]))),
        }
    }

    /// The nodes of the smaller mesh that represent some nodes (from 0) and no others; `None` if one of them represents others, too.
    pub(crate) fn whole(&self, nodes: &[usize]) -> Option<Vec<usize>> {
        let touched = distinct(nodes.iter().filter_map(|&node| self.numbers[node])).len();
        let first_middle = self.middles.first().map_or(usize::MAX, |(middle, _)| *middle);
        let own = self.within(nodes);
        (own.iter().filter(|node| **node < first_middle).count() == touched).then_some(own)
    }

    pub(super) fn within(&self, nodes: &[usize]) -> Vec<usize> {
        let mut own = within(&self.numbers, nodes);
        if let Some((last, _)) = self.middles.last() {
            let mut is_there = vec![false; last + 1];
            own.iter().for_each(|&node| is_there[node] = true);
            let within = self.middles.iter().filter(|(_, all)| all.iter().all(|x| is_there[x.0]));
            own.extend(within.map(|(middle, _)| middle));
        }
        own
    }

    /// A field of vectors at all nodes at those of the smaller mesh.
    pub(crate) fn field(&self, x: &[f64]) -> Vec<f64> {
        let (d, axes) = (x.len() / self.numbers.len(), self.axes());
        let count = self.numbers.iter().flatten().max().map_or(0, |last| last + 1);
        let mut own = vec![0.0; (count + self.middles.len()) * axes.len()];
        for (node, number) in self.numbers.iter().enumerate().rev() {
            let Some(number) = number else { continue };
            for (k, i) in axes.iter().enumerate() {
                own[number * axes.len() + k] = x[node * d + i];
            }
        }
        for (middle, around) in &self.middles {
            for k in 0..axes.len() {
                let parts = around.iter().map(|(node, weight)| weight * own[node * axes.len() + k]);
                own[middle * axes.len() + k] = parts.sum();
            }
        }
        own
    }
}

/// The numbers all of whose places are among those that are `chosen`.
pub(super) fn within(numbers: &[Option<usize>], chosen: &[usize]) -> Vec<usize> {
    let count = numbers.iter().flatten().max().map_or(0, |last| last + 1);
    let mut left = vec![0_usize; count];
    numbers.iter().flatten().for_each(|&number| left[number] += 1);
    let mut is_last = |number: &usize| {
        left[*number] -= 1;
        left[*number] == 0
    };
    chosen.iter().filter_map(|&place| numbers[place]).filter(|number| is_last(number)).collect()
}

impl Mesh {
    /// Transfers the names of nodes and cells of the mesh `of` to those that represent them, by `nodes` and `cells`, and its
    /// cuts together with a `plane` of its nodes.
    pub(super) fn take_names(
        &mut self,
        of: &Self,
        plane: Vec<usize>,
        nodes: impl Fn(&[usize]) -> Vec<usize>,
        cells: &[Option<usize>],
    ) {
        let count = self.node_count();
        let nodes = |all: &[usize]| -> Vec<usize> {
            nodes(all).into_iter().filter(|&node| node < count).collect()
        };
        let plane = distinct(nodes(&plane).into_iter().chain(nodes(&of.plane)));
        if !plane.is_empty() {
            self.cut_at(plane);
        }
        for (name, all) in &of.sets {
            let own = nodes(all);
            if !own.is_empty() && !["all", "boundary"].contains(&&name[..]) {
                self.set_nodes(name, own);
            }
        }
        for (name, group) in &of.cell_groups {
            let own = within(cells, group);
            if !own.is_empty() {
                self.set_cells(name, own);
            }
        }
    }
}
