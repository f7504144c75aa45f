//! Nested dissection by coordinates: an order of elimination that leaves less fill than minimum degree
//! on large solids.
//!
//! It is used where it leaves less fill than approximate minimum degree: on solids, and not in the plane.

use crate::base::sparse::NodePattern;

/// Number of nodes that are not divided further: few enough to be one dense block.
const LEAF: usize = 40;

/// The nodes in the order in which they should be eliminated: those of one half, those of the other,
/// and last those in between that couple the halves; within each half again in this order.
///
/// A. George, SIAM J. Numer. Anal. 10 (1973) 345-363.
pub(super) fn nested_dissection(
    pattern: &NodePattern,
    positions: &[f64],
    dimension: usize,
) -> Vec<usize> {
    let nodes = pattern.nodes();
    let mut dissection = Dissection {
        pattern,
        positions,
        dimension,
        half: vec![0; nodes],
        halves: 0,
        order: Vec::with_capacity(nodes),
    };
    dissection.divide((0..nodes).collect());
    dissection.order
}

struct Dissection<'a> {
    pattern: &'a NodePattern,
    positions: &'a [f64],
    dimension: usize,
    /// For each node the number of the last lower half that it was in.
    half: Vec<usize>,
    halves: usize,
    order: Vec<usize>,
}

impl Dissection<'_> {
    fn divide(&mut self, mut nodes: Vec<usize>) {
        if nodes.len() <= LEAF {
            nodes.sort_unstable();
            self.order.append(&mut nodes);
            return;
        }
        let (axis, middle) = (self.longest_axis(&nodes), nodes.len() / 2);
        let at = |node: usize| self.positions[node * self.dimension + axis];
        nodes.select_nth_unstable_by(middle, |&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
        let upper = nodes.split_off(middle);
        let lower = nodes;

        self.halves += 1;
        lower.iter().for_each(|&node| self.half[node] = self.halves);
        let is_in_lower = |node: usize| self.half[node] == self.halves;
        let (between, upper): (Vec<usize>, Vec<usize>) = upper
            .into_iter()
            .partition(|&node| self.pattern.row(node).any(|(_, other)| is_in_lower(other)));
        self.divide(lower);
        self.divide(upper);
        self.order.extend(between);
    }

    /// The axis along which these nodes reach farthest.
    fn longest_axis(&self, nodes: &[usize]) -> usize {
        let extent = |axis: usize| {
            let along = nodes.iter().map(|node| self.positions[node * self.dimension + axis]);
            let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            high - low
        };
        (0..self.dimension).max_by(|&a, &b| extent(a).total_cmp(&extent(b))).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh, SolidCells};

    /// Each node comes once, whatever the mesh: also where many have the same coordinates.
    #[test]
    fn an_order_of_all_nodes() {
        let solid = Mesh::cuboid([1.0, 2.0, 1.0], [6, 9, 5], SolidCells::Tetrahedra).unwrap();
        let plane = Mesh::rectangle([1.0, 1.0], [31, 17], Cells::Crossed).unwrap();
        let bar = Mesh::bar(1.0, 500).unwrap();
        for mesh in [&solid, &plane, &bar] {
            let pattern = NodePattern::new(mesh.node_count(), mesh.cells());
            let order = nested_dissection(&pattern, mesh.positions(), mesh.dimension());
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..mesh.node_count()));
            // the nodes eliminated last separate the others into two parts that are not coupled
            let cut = match mesh.dimension() {
                1 => 1,
                2 => 2 * 17,
                _ => 2 * 30,
            };
            let kept = &order[..order.len() - cut];
            let mut reached = vec![false; mesh.node_count()];
            let mut front = vec![kept[0]];
            while let Some(node) = front.pop() {
                if !std::mem::replace(&mut reached[node], true) {
                    let next = pattern.row(node).map(|(_, other)| other);
                    front.extend(next.filter(|other| kept.contains(other)));
                }
            }
            let part = reached.iter().filter(|reached| **reached).count();
            assert!(part < kept.len() * 2 / 3, "{part} of {}", kept.len());
        }
    }
}
