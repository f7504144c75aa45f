//! Newton's method along the shapes.

use super::{LastEvaluation, Projection};
use crate::base::simd::add;
use crate::base::vector::dot;
use crate::dynamics::reduced::branches::ReducedBranches;
use crate::dynamics::reduced::factors::{Factors, Tangents};

impl Projection {
    /// Updates the tangents to the state last evaluated.
    pub(crate) fn update_tangents(&mut self, t: f64) {
        let Self { at, shapes, generalized, acting, branches, flow, constant, tangents, .. } = self;
        let Tangents { nodal: [stiffness, damping], projected, differences, is_set } = tangents;
        stiffness.values.fill(0.0);
        damping.values.fill(0.0);
        for force in &*acting {
            differences.add_tangents(force, t, [&at.u, &at.v], [stiffness, damping]);
        }
        if let Some(flow) = flow {
            flow.linearize(t, [&at.u, &at.v], stiffness, shapes);
        }
        let constants = [&constant.stiffness, &constant.damping];
        for ((projected, constant), matrix) in
            projected.iter_mut().zip(constants).zip([&*stiffness, &*damping])
        {
            projected.copy_from_slice(constant);
            if matrix.values.iter().any(|&value| value != 0.0) {
                shapes.add_projected_matrix(matrix, projected);
            }
        }
        let [z, rates] = &at.z;
        let [stiffness, damping] = projected;
        for force in generalized.iter_mut().flatten() {
            force.add_tangents(t, [z, rates], stiffness, damping);
        }
        if let Some(branches) = branches {
            branches.update_tangents();
        }
        *is_set = true;
    }

    /// Whether tangents that were evaluated since the forces changed serve for another step: those of branches do not.
    pub(crate) fn keeps_tangents(&self) -> bool {
        self.tangents.is_set && self.branches.as_ref().is_none_or(ReducedBranches::keep_tangents)
    }

    /// Factorizes the Newton matrix for steps of the parameter `gamma`.
    pub(crate) fn factorize(&mut self, gamma: f64) {
        let (s, free) = (self.shapes.count(), self.shapes.free());
        let Self { tangents, factors, branches, flow, shapes, at, .. } = self;
        let [stiffness, damping] = &tangents.projected;
        factors.gamma = gamma;
        factors.stiffness.copy_from_slice(stiffness);
        if let Some(branches) = branches {
            branches.add_stiffness(gamma, &at.u, shapes, &mut factors.stiffness);
        }
        let stiffness = &factors.stiffness;
        for j in 0..free {
            for i in 0..free {
                let entry = gamma * (damping[i * s + j] + gamma * stiffness[i * s + j]);
                factors.matrix[(i, j)] = entry + if i == j { 1.0 } else { 0.0 };
            }
        }
        if let Some(flow) = flow {
            flow.add_stiffness(gamma, &mut factors.matrix);
        }
        factors.factorize();
    }

    /// Solves (I - gamma J) x = r for the residuals `ru`, `rv` and those of `internal` unknowns, which become x. Returns the
    /// changes of the powers dissipated and supplied (W) along x.
    pub(crate) fn solve(&mut self, [ru, rv, internal]: [&mut [f64]; 3]) -> [f64; 2] {
        let (s, free) = (self.shapes.count(), self.shapes.free());
        let (strains, amounts) = internal.split_at_mut(self.branch_unknowns());
        let [_, damping] = &self.tangents.projected;
        let gamma = self.factors.gamma;
        let Factors { stiffness, xv, .. } = &mut self.factors;
        for i in 0..free {
            xv[i] = rv[i] - gamma * dot(&stiffness[i * s..][..free], ru);
        }
        // gamma times the forces on the shapes that constraints move
        let mut on_moved: &[f64] = &[];
        if let Some(branches) = &mut self.branches {
            let along = branches.of_residuals(strains, &mut self.shapes);
            add(&along[..free], xv);
            on_moved = &along[free..];
        }
        if let Some(flow) = &mut self.flow {
            flow.add_residuals(gamma, ru, amounts, xv);
        }
        self.factors.solve();
        let Factors { stiffness, right, xv, .. } = &mut self.factors;
        ru.iter_mut().zip(&*xv).for_each(|(x, xv)| *x += gamma * xv);
        let LastEvaluation { z: [_, rates], dissipative, applied, .. } = &self.at;
        // damping forces are proportional to velocity
        let mut dissipated = -2.0 * dot(&dissipative[..free], xv);
        for i in 0..free {
            dissipated += xv[i] * dot(&damping[i * s..][..free], xv);
        }
        // the change of q'', by the motion of the constraints
        let change = rv.iter().zip(&*xv).map(|(r, x)| (x - r) / gamma);
        right.iter_mut().zip(change).for_each(|(right, change)| *right = change);
        let mut supplied = dot(&applied[..free], xv);
        for row in free..s {
            let of = |matrix: &[f64], x: &[f64]| dot(&matrix[row * s..][..free], x);
            let change = of(&self.constant.inertia, right) + of(damping, xv) + of(stiffness, ru);
            let passed = on_moved.get(row - free).map_or(0.0, |force| force / gamma);
            supplied += rates[row] * (change - passed);
        }
        if let Some(branches) = &mut self.branches {
            dissipated += branches.solve(ru, strains, &self.shapes);
        }
        if let Some(flow) = &mut self.flow {
            let [heated, brought] = flow.solve(ru, amounts, &rates[free..]);
            dissipated += heated;
            supplied += brought;
        }
        rv.copy_from_slice(xv);
        [dissipated, supplied]
    }
}
