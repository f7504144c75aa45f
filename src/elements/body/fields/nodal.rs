//! Fields at nodes: means of the values of adjacent cells, each extrapolated from its strain points, in the
//! mean weighted by the volumes of the cells (Hinton and Campbell 1974; Hughes, *The Finite Element Method*,
//! section 4.10).
//!
//! In quadratic cells that is exact for fields that are linear in space. A sensor looks up its cells and
//! weights once and visits no others.

use super::{Tensors, von_mises};
use crate::elements::mesh::Mesh;

/// Strain and stress at a node, as [`CellField`](crate::CellField) has them for cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodalField {
    /// Cauchy's or Green's strain, as the body measures it.
    pub strain: [[f64; 3]; 3],
    /// Stress (Pa).
    pub stress: [[f64; 3]; 3],
}

impl NodalField {
    /// The von Mises stress (Pa): sqrt(3/2) times the norm of the stress without its mean pressure.
    pub fn von_mises(&self) -> f64 {
        von_mises(&self.stress)
    }

    /// The same with another stress (Pa) added.
    pub(crate) fn with_stress(mut self, more: &[[f64; 3]; 3]) -> Self {
        let sum = self.stress.as_flattened_mut().iter_mut().zip(more.as_flattened());
        sum.for_each(|(sum, more)| *sum += more);
        self
    }

    fn new(sum: &Tensors, weight: f64) -> Self {
        let [strain, stress] = sum.over(weight);
        Self { strain, stress }
    }
}

/// The fields at all of `count` nodes, of cells with these `volumes`; `each_node` reports the values of a cell at
/// each of its nodes.
pub(in crate::elements::body) fn nodal_fields(
    count: usize,
    volumes: &[f64],
    each_node: impl Fn(usize, &mut dyn FnMut(usize, usize, &Tensors)),
) -> Vec<NodalField> {
    let mut sums = vec![(0.0, Tensors::default()); count];
    for (cell, volume) in volumes.iter().enumerate() {
        each_node(cell, &mut |node, _, tensors| {
            let (total, sum) = &mut sums[node];
            *total += volume;
            sum.add(tensors, *volume);
        });
    }
    // a node of no cell has none
    let field = |(total, sum)| NodalField::new(&sum, if total == 0.0 { 1.0 } else { total });
    sums.into_iter().map(field).collect()
}

/// Reads the sum of the fields at some nodes, each times a weight.
#[derive(Debug, Clone)]
pub(crate) struct Probe {
    /// Cells, with the weights of the fields at their nodes.
    cells: Vec<(usize, Vec<f64>)>,
}

impl Probe {
    pub(in crate::elements::body) fn new(
        mesh: &Mesh,
        volumes: &[f64],
        weights: &[(usize, f64)],
    ) -> Self {
        let mut of_nodes = vec![(0.0, 0.0); mesh.node_count()];
        for &(node, weight) in weights {
            of_nodes[node].0 += weight;
        }
        for (cell, volume) in mesh.cells().zip(volumes) {
            cell.iter().for_each(|&node| of_nodes[node].1 += volume);
        }
        let share = |node: &usize, volume: f64| of_nodes[*node].0 * volume / of_nodes[*node].1;
        let cells = mesh.cells().zip(volumes).enumerate();
        let cells = cells.filter(|(_, (cell, _))| cell.iter().any(|&node| of_nodes[node].0 != 0.0));
        let shares = cells.map(|(number, (cell, &volume))| {
            (number, cell.iter().map(|node| share(node, volume)).collect())
        });
        Self { cells: shares.collect() }
    }

    /// The weights of the nodal values of a cell, if it is read.
    pub(in crate::elements::body) fn shares(&self, cell: usize) -> Option<&[f64]> {
        let number = self.cells.binary_search_by_key(&cell, |(cell, _)| *cell).ok()?;
        Some(&self.cells[number].1)
    }

    pub(in crate::elements::body) fn read(
        &self,
        each_node: impl Fn(usize, &mut dyn FnMut(usize, usize, &Tensors)),
    ) -> NodalField {
        let mut sum = Tensors::default();
        for (cell, shares) in &self.cells {
            each_node(*cell, &mut |_, a, tensors| sum.add(tensors, shares[a]));
        }
        NodalField::new(&sum, 1.0)
    }
}
