//! The forces of some cells: a weighted sample that represents all, and those of single cells.

use std::collections::BTreeMap;
use std::sync::Arc;

use faer::Mat;

use super::assembled::Body;
use super::contiguous::ContiguousCells;
use super::continuum::Continuum;
use super::elastic::Elastic;
use super::elements::{ElementsOf, side_by_side};
use super::partition::Partition;
use super::projection::modes_side_by_side;
use crate::base::sparse::NodePattern;
use crate::base::vector::distinct;
use crate::elements::basis::StrainPoint;
use crate::elements::force::{Force, NodalForces};
use crate::elements::mesh::Mesh;
use crate::integrators::ode::Failure;

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// A sample of these elements: some `cells` (ascending), each with its volumes times a weight, on the same nodes.
    /// `pattern` has the pairs of their nodes to which tangents are added, and is not widened from another; without it
    /// entries stay those of this pattern.
    ///
    /// A projected dilatation is a mean over its cell, from which a constant weight cancels; so are its modes.
    pub(super) fn sampled(
        &self,
        cells: &[usize],
        weights: &[f64],
        pattern: Option<&NodePattern>,
        node_count: usize,
    ) -> Self {
        let nodes: Vec<[usize; N]> = cells.iter().map(|&cell| self.nodes[cell]).collect();
        let mut points = Vec::with_capacity(Q * cells.len());
        for (&cell, weight) in cells.iter().zip(weights) {
            let weighted = |point: StrainPoint<f64, N, M, D>| StrainPoint {
                volume: weight * point.volume,
                ..point
            };
            points.extend(self.points(cell).map(weighted));
        }
        let products = cells.iter().zip(weights);
        let products = products.map(|(&cell, weight)| {
            self.products[cell].map(|row| row.map(|product| weight * product))
        });
        let modes: Vec<[[f64; M]; Q]> = match self.modes.is_empty() {
            true => Vec::new(),
            false => cells
                .iter()
                .map(|&cell| std::array::from_fn(|q| self.modes_of(cell, q).unwrap_or([0.0; M])))
                .collect(),
        };
        let entry = |row: usize, column: usize, own: u32| match pattern {
            None => own,
            Some(pattern) => pattern
                .find(row, column)
                .and_then(|entry| entry.try_into().ok())
                .expect("the pattern couples the nodes of the cells"),
        };
        let entries = cells.iter().zip(&nodes).map(|(&cell, nodes)| {
            std::array::from_fn(|a| {
                std::array::from_fn(|b| entry(nodes[a], nodes[b], self.entries[cell][a][b]))
            })
        });
        let entries: Vec<[[u32; N]; N]> = entries.collect();
        let revolved = self.revolved.as_ref().map(|own| {
            let entries = entries.as_flattened().as_flattened().to_vec();
            Arc::new(own.sampled(cells, weights, entries))
        });
        Self {
            entries,
            points: side_by_side::<N, M, D, Q>(&points).into(),
            values: self.values,
            extrapolation: self.extrapolation,
            products: products.collect::<Vec<_>>().into(),
            quadratic: self.quadratic,
            dilatation: self.dilatation,
            modes: modes_side_by_side(&modes).into(),
            shares: Partition::new(&nodes, node_count),
            rows: ContiguousCells::new(&nodes),
            numbers: cells.iter().map(|&cell| self.number(cell)).collect(),
            revolved,
            nodes,
        }
    }
}

impl Continuum {
    /// The same of the cells that have `weights` (by their numbers among those of all bodies), if it has any of them. They
    /// are then counted by themselves.
    fn sampled(
        &self,
        weights: &BTreeMap<usize, f64>,
        pattern: Option<&NodePattern>,
        node_count: usize,
    ) -> Option<Self> {
        let own = weights.range(self.cells.clone()).filter(|(_, weight)| **weight > 0.0);
        let (cells, weights): (Vec<usize>, Vec<f64>) =
            own.map(|(cell, weight)| (cell - self.cells.start, weight)).unzip();
        (!cells.is_empty()).then(|| Self {
            cells: 0..cells.len(),
            elements: self.elements.sampled(&cells, &weights, pattern, node_count),
            regions: Arc::new(self.regions.sampled(&cells)),
            fibres: Arc::default(),
            ..self.clone()
        })
    }
}

impl Elastic {
    /// The same by some cells (from 0 among those of all bodies), each times its weight; those of weight 0 are omitted.
    /// `pattern` couples the nodes of each of these cells (as [`Body::cell_pairs`] lists them) and is not widened from
    /// another.
    pub(crate) fn sampled(&self, weights: &BTreeMap<usize, f64>, pattern: &NodePattern) -> Self {
        self.of_cells(weights, Some(pattern), pattern.nodes())
    }

    /// The force of some cells on a mesh of `node_count` nodes, each times its weight.
    fn of_cells(
        &self,
        weights: &BTreeMap<usize, f64>,
        pattern: Option<&NodePattern>,
        node_count: usize,
    ) -> Self {
        let bodies = self
            .bodies
            .iter()
            .filter_map(|(own, terms)| Some((own.sampled(weights, pattern, node_count)?, *terms)));
        let bodies: Vec<_> = bodies.collect();
        let nodes = bodies.iter().flat_map(|(own, _)| own.elements.nodes_of_cells()).copied();
        let nodes = Some(distinct(nodes));
        Self { bodies, is_of_rigid: self.is_of_rigid, nodes }
    }

    /// The same cell by cell, on `mesh`, which is that of all its bodies.
    pub(crate) fn by_cell(&self, mesh: &Mesh) -> ByCell {
        let mut colours: Vec<Vec<Cell>> = Vec::new();
        // of the cells at each node
        let mut taken: Vec<Vec<usize>> = vec![Vec::new(); mesh.node_count()];
        for (number, cell) in mesh.cells().enumerate() {
            if !self.bodies.iter().any(|(own, _)| own.cells.contains(&number)) {
                continue;
            }
            let is_free = |colour: &usize| cell.iter().all(|node| !taken[*node].contains(colour));
            let colour = (0..colours.len()).find(is_free).unwrap_or(colours.len());
            if colour == colours.len() {
                colours.push(Vec::new());
            }
            colours[colour].push((number, cell.to_vec()));
            cell.iter().for_each(|node| taken[*node].push(colour));
        }
        let colours = colours.into_iter().map(|cells| {
            let weights = cells.iter().map(|(number, _)| (*number, 1.0)).collect();
            (self.of_cells(&weights, None, mesh.node_count()), cells)
        });
        let (colours, dimension) = (colours.collect(), mesh.dimension());
        ByCell { colours, cell_count: mesh.cell_count(), dimension }
    }
}

/// The number of a cell, and its nodes.
type Cell = (usize, Vec<usize>);

/// The elastic and viscous forces of single cells.
pub(crate) struct ByCell {
    /// Cells that share no node, with their nodes and the force of all of them: each node has the force of one cell.
    colours: Vec<(Elastic, Vec<Cell>)>,
    cell_count: usize,
    dimension: usize,
}

impl ByCell {
    /// The work Phi^T f (J) of the conservative and dissipative forces of each cell (columns, all of the mesh; 0 for those
    /// that have none) along each of the `shapes` (rows).
    ///
    /// # Errors
    /// As [`Force::add_forces`].
    pub(crate) fn work(
        &self,
        u: &[f64],
        v: &[f64],
        shapes: &[Vec<f64>],
    ) -> Result<Mat<f64>, Failure> {
        let d = self.dimension;
        let mut work = Mat::zeros(shapes.len(), self.cell_count);
        let mut forces = NodalForces::zeros(u.len());
        for (elastic, cells) in &self.colours {
            forces.clear();
            elastic.add_forces(0.0, u, v, &mut forces)?;
            for (number, nodes) in cells {
                for dof in nodes.iter().flat_map(|node| d * node..d * (node + 1)) {
                    let force = forces.conservative[dof] + forces.dissipative[dof];
                    let of_shapes = work.col_as_slice_mut(*number).iter_mut().zip(shapes);
                    of_shapes.for_each(|(work, shape)| *work += force * shape[dof]);
                }
            }
        }
        Ok(work)
    }
}

impl Body {
    /// Pairs of nodes of each of some `cells` (from 0), for a pattern.
    pub(crate) fn cell_pairs(&self, cells: impl Iterator<Item = usize>) -> Vec<[usize; 2]> {
        let all: Vec<&[usize]> = self.mesh.cells().collect();
        let mut pairs = Vec::new();
        for cell in cells.map(|cell| all[cell]) {
            for (k, &node) in cell.iter().enumerate() {
                pairs.extend(cell[..k].iter().map(|&other| [other, node]));
            }
        }
        pairs
    }
}

#[cfg(test)]
mod tests;
