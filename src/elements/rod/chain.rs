//! Steps of equilibria along which cross sections turn (see `elements/body/turning.rs`).
//!
//! The edges of a rod, from node to node and from a node to its directors, form a tree: any change of theirs is one of displacements. An edge e
//! that a straight step changes by de turns by the angle of its rate, those of a section all alike: e -> exp(w) (e + de - w x e).

use std::collections::BTreeSet;

use nalgebra::{Rotation3, Vector3};

use super::elements::RodElements;
use super::end::End;
use super::strain::{Frame, Section};
use crate::base::sparse::BlockMatrix;

impl RodElements {
    /// Adds the matrix of the Poisson equation of its edges to `matrix`.
    pub(crate) fn add_gradients(&self, matrix: &mut BlockMatrix) {
        let d = self.dimension;
        self.each_edge(|[from, to], _, _| {
            for (row, column, sign) in
                [(from, from, 1.0), (to, to, 1.0), (from, to, -1.0), (to, from, -1.0)]
            {
                let Some(block) = matrix.block_mut(row, column) else { continue };
                (0..d).for_each(|i| block[i * d + i] += sign);
            }
        });
    }

    /// Adds its right-hand side for a `step` (m) from displacements `u` (m) to `right`. Returns the largest turn (rad).
    pub(crate) fn add_turned(&self, u: &[f64], step: &[f64], right: &mut [f64]) -> f64 {
        let d = self.dimension;
        let of = |field: &[f64], node: usize| {
            Vector3::from_fn(|i, _| if i < d { field[node * d + i] } else { 0.0 })
        };
        let mut most: f64 = 0.0;
        self.each_edge(|[from, to], natural, section| {
            let change = of(step, to) - of(step, from);
            let edge = natural + of(u, to) - of(u, from);
            let turn = match section {
                None => edge.cross(&change) / edge.norm_squared(),
                Some(end) => {
                    let at = |field: &[f64], natural: bool| -> Section<f64> {
                        end.section(d, natural, |v, i| field[end.nodes[v] * d + i])
                    };
                    let frame = Frame::of(at(u, true).d);
                    Vector3::from(frame.to_space(frame.spin(at(step, false).d)))
                }
            };
            let turned = Rotation3::from_scaled_axis(turn) * (edge + change - turn.cross(&edge));
            let excess = turned - edge - change;
            most = most.max(turn.norm());
            for i in 0..d {
                right[to * d + i] += excess[i];
                right[from * d + i] -= excess[i];
            }
        });
        most
    }

    /// Calls `see` with each edge, its undeformed vector (m), and its section, if it is one of a director.
    fn each_edge(&self, mut see: impl FnMut([usize; 2], Vector3<f64>, Option<&End>)) {
        let mut seen = BTreeSet::new();
        for element in &self.elements {
            let [first, second] = &element.ends;
            let span = Vector3::from(second.undeformed.x) - Vector3::from(first.undeformed.x);
            see([first.nodes[0], second.nodes[0]], span, None);
            for end in &element.ends {
                if !seen.insert(end.nodes[0]) {
                    continue;
                }
                for director in 0..self.dimension - 1 {
                    let natural = end.arms[director] * Vector3::from(end.undeformed.d[director]);
                    see([end.nodes[0], end.nodes[director + 1]], natural, Some(end));
                }
            }
        }
    }
}
