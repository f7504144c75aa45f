//! The whole Jacobian of the differential-algebraic form of index 1, with which tests compare the structured solver.
//!
//! It is a sum of parts, since a force on a dependent node is in the rows of a whole frame.

mod tests;

use super::System;
use super::dae::DaeForm;

impl DaeForm {
    /// Visits all parts of the entries of dF/dy + cj dF/dy' as (row, column, value); the same ones at every call. An entry
    /// is the sum of its parts.
    pub(super) fn visit_jacobian(&self, cj: f64, mut visit: impl FnMut(usize, usize, f64)) {
        let System { matrices, rows, edges, alpha, .. } = &self.system;
        let (n, d) = (self.system.dofs(), matrices.dimension);
        let (stiffness, damping) = self.system.tangents();
        let (inertia, pattern) = (&matrices.inertia, matrices.pattern());
        let energies = self.system.layout.energies();
        let lambda = energies.end;
        let of_edges = lambda + rows.len();
        // entry (column, row) of the pattern; the one that is wanted is (row, column)
        let block = |matrix: &[f64], entry: usize, row_axis: usize, column_axis: usize| {
            matrix[(pattern.transposed(entry) * d + row_axis) * d + column_axis]
        };
        let rigid = matrices.rigid.as_deref();
        let is_dependent = |node: usize| rigid.is_some_and(|rigid| rigid.is_dependent(node));
        // the nodes at which a force on a node acts
        let bearers = |node: usize| {
            let itself = rigid.is_none().then_some((node, 1.0));
            itself.into_iter().chain(rigid.into_iter().flat_map(move |rigid| rigid.shares(node)))
        };
        for dof in 0..n {
            visit(dof, dof, if is_dependent(dof / d) { 1.0 } else { cj });
            for (entry, node) in pattern.row(dof / d) {
                for axis in 0..d {
                    let kt = block(&stiffness.values, entry, axis, dof % d);
                    for (bearer, share) in bearers(node) {
                        visit(n + bearer * d + axis, dof, share * kt);
                    }
                }
            }
        }
        for dof in 0..n {
            let strays = is_dependent(dof / d);
            if strays {
                visit(n + dof, n + dof, 1.0);
            } else {
                visit(dof, n + dof, -1.0);
            }
            for (entry, node) in pattern.row(dof / d) {
                for axis in 0..d {
                    let mass = if axis == dof % d { cj * inertia.values[entry] } else { 0.0 };
                    let damped = block(&damping.values, entry, axis, dof % d);
                    for (bearer, share) in bearers(node) {
                        visit(n + bearer * d + axis, n + dof, share * (mass + damped));
                    }
                }
            }
        }
        energies.for_each(|energy| visit(energy, energy, cj));
        for (k, row) in rows.iter().enumerate() {
            for &(dof, c) in &row.terms {
                visit(lambda + k, dof, alpha * alpha * c);
                visit(lambda + k, n + dof, (cj + 2.0 * alpha) * c);
                for (bearer, share) in bearers(dof / d) {
                    visit(n + bearer * d + dof % d, lambda + k, -share * c);
                }
            }
            visit(lambda + k, lambda + k, 0.0);
        }
        for (node, shares) in rigid.iter().flat_map(|rigid| rigid.dependents()) {
            for &(of_frame, share) in shares {
                for axis in 0..d {
                    let [row, column] = [node, of_frame].map(|node| node * d + axis);
                    visit(row, column, -share);
                    visit(n + row, n + column, -share);
                }
            }
        }
        for (k, edge) in edges.list.iter().enumerate() {
            let [by_place, by_rate] = edges.slopes(k, *alpha, cj);
            for (node, sign) in edge.nodes.into_iter().zip([1.0, -1.0]) {
                for axis in 0..d {
                    let dof = node * d + axis;
                    visit(of_edges + k, dof, sign * by_place[axis]);
                    visit(of_edges + k, n + dof, sign * by_rate[axis]);
                    visit(n + dof, of_edges + k, -sign * edges.arms[k][axis]);
                }
            }
            visit(of_edges + k, of_edges + k, 0.0);
        }
    }
}
