//! Solves with the structured Newton matrix.
//!
//! An implicit method of step parameter gamma needs x with (I - gamma J) x = r, J the Jacobian of
//! the ODE form. J holds M^-1 and is dense; it is never formed. With Kt = -df/du, D = -df/dv and
//! x = (xu, xv), r = (ru, rv), the same x follows from
//!
//! ```text
//! (M + gamma D + gamma^2 Kt) xv - A mu = M rv - gamma Kt ru
//! A^T xv = (A^T rv - gamma alpha^2 A^T ru) / (1 + alpha gamma)^2
//! xu = ru + gamma xv
//! ```
//!
//! This needs one sparse matrix N of half the size; alpha costs nothing, however large. Its symmetric part is factorized. The skew part
//! follows by an iteration for methods that solve once (`linear/skew.rs`); Newton's iteration omits it.
//!
//! Maxwell branches are eliminated point by point (`elements/body/branches.rs`), so that Kt includes their
//! effect in a step of gamma. Amounts of gas are eliminated as well; their contribution to Kt has the rank of their number,
//! and stays apart (`flow_matrix.rs`).
//!
//! Of r = c + gamma (v, M^-1 (f + A lambda)) the integrators are given only c + gamma (v, 0): then
//! M rv is M cv + gamma f, and no iteration solves a system with M.
//!
//! CVODE reaches this solve as a user-supplied linear solver (`Ode::newton_setup`, `newton_solve`), IDA's
//! form of index 1 with gamma = 1/cj; the form of index 2 decouples into a system with M and one with N
//! (`dae.rs`). KLU on the sparse Jacobian of the whole system exists to check it. Symbolic analysis is done
//! once a phase. A phase without forces that depend on u or v shares the constant K and B. The product Kt ru
//! is skipped where ru is round-off: from the second round of an iteration on, as u' = v is linear.
//! `docs/decisions/0001-half-size-newton-matrix.md` has the reasons.

use std::sync::Arc;

use super::System;
use super::newton_matrix::{ITERATED, NewtonMatrix, SKEW, SOLVED_ONCE};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::{dot, largest};
use crate::dynamics::linear::{EntrySource, Indefinite, Skew, nodal_multipliers, stabilized};
use crate::dynamics::matrices::Matrices;
use crate::dynamics::state::State;
use crate::integrators::ode::Failure;

/// Ratio of pairs in the Newton matrix that are no longer near to those that are.
const MOST_KEPT: usize = 3;

impl System {
    /// Whether all forces are linear in u and v, so that Kt and D never change.
    pub(crate) fn is_linear(&self) -> bool {
        !self.newton.follows
    }

    /// Sets whether residuals of the Newton systems are evaluated again and solutions corrected, as in
    /// Newton's method.
    pub(crate) fn expect_iteration(&mut self, iterates: bool) {
        self.newton.accuracy = if iterates { ITERATED } else { SOLVED_ONCE };
    }

    /// Step parameter of the last factorization.
    pub(super) fn gamma(&self) -> f64 {
        self.newton.gamma
    }

    /// Kt and D in force.
    pub(crate) fn tangents(&self) -> (&BlockMatrix, &BlockMatrix) {
        (self.newton.stiffness.get(), self.newton.damping.get())
    }

    /// Updates the tangents to the state `y` at time `t`, unless `reuse` allows older ones, and sets N for steps of the
    /// parameter `gamma`. Returns whether the tangents are current.
    pub(super) fn linearize(
        &mut self,
        t: f64,
        y: &[f64],
        gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        let State { u, v, internal, .. } = self.layout.of(y);
        let (strains, amounts) = self.layout.split(internal);
        self.set_lagging(t, internal);
        // the contribution of Maxwell branches depends on gamma
        let current = self.update_tangents(t, u, v, reuse && strains.is_empty());
        self.add_branch_tangents(gamma, u, strains);
        if current {
            self.add_flow_tangents(t, [u, v, amounts]);
        }
        self.factorize_newton(gamma)?;
        Ok(current)
    }

    /// Updates Kt and D to (t, u, v), unless `reuse` allows older ones. Returns whether they are current.
    pub(crate) fn update_tangents(&mut self, t: f64, u: &[f64], v: &[f64], reuse: bool) -> bool {
        if !self.newton.follows {
            return true;
        }
        if reuse && self.newton.is_set {
            return false;
        }
        self.make_room(u);
        let NewtonMatrix {
            stiffness,
            damping,
            differences,
            is_set,
            is_damped,
            tangent_evaluations,
            ..
        } = &mut self.newton;
        let Matrices { stiffness: k, damping: b, .. } = &*self.matrices;
        if let (Some(stiffness), Some(damping)) = (stiffness.begin(k), damping.begin(b)) {
            for force in &self.forces {
                differences.add_tangents(force, t, [u, v], [stiffness, damping]);
            }
        }
        if let Some(stiffness) = stiffness.own() {
            self.linear_edges.add_tangents(stiffness);
        }
        *is_set = true;
        *is_damped = damping.get().values.iter().any(|&value| value != 0.0);
        *tangent_evaluations += 1;
        true
    }

    /// Adds entries to the Newton matrix for pairs of nodes that have come near each other. Those that were near before
    /// keep theirs, unless there are many more of them than are near now.
    pub(super) fn make_room(&mut self, u: &[f64]) {
        let pattern = self.matrices.pattern();
        let contacts = self.forces.iter().filter_map(|force| force.capabilities().contact);
        let near = contacts.flat_map(|contact| contact.couplings_near(u, pattern));
        let mut pairs: Vec<[usize; 2]> = near.collect();
        if pairs.is_empty() {
            return;
        }
        let [of_scene, now] = [&self.base, &self.matrices].map(|of| of.pattern().entries());
        let matrices = match now - of_scene > MOST_KEPT * pairs.len() {
            true => &self.base,
            false => &self.matrices,
        };
        pairs.retain(|&[a, b]| matrices.pattern().find(a, b).is_none());
        self.matrices = Arc::new(matrices.with_pairs(&pairs));
        self.newton.move_to(&self.matrices, &self.rows, &self.edges);
    }

    /// Adds to Kt, just updated, the tangent of Maxwell branches in a step of the parameter `gamma`: the
    /// instantaneous one if that is 0, and that without stress if there are no `internal` strains.
    pub(crate) fn add_branch_tangents(&mut self, gamma: f64, u: &[f64], internal: &[f64]) {
        let Some(branches) = &self.matrices.branches else { return };
        let NewtonMatrix { stiffness, place, .. } = &mut self.newton;
        if let Some(stiffness) = stiffness.own() {
            branches.add_tangents(gamma, u, internal, stiffness);
        }
        for (place, now) in place.iter_mut().zip([u, internal]) {
            place.clear();
            place.extend_from_slice(now);
        }
    }

    /// Sets N = M + gamma D + gamma^2 Kt, for the solves from now on.
    pub(crate) fn factorize_newton(&mut self, gamma: f64) -> Result<(), Failure> {
        let factorized =
            self.begin_newton(gamma).or_else(|_| self.newton.solver.factorize_indefinite());
        factorized.map_err(|_| {
            Failure::Recoverable(
                "the Newton matrix is singular (a body that is about to buckle or to collapse)"
                    .into(),
            )
        })?;
        self.complete_newton();
        Ok(())
    }

    /// As [`factorize_newton`](Self::factorize_newton), if N is positive definite; returns whether it is.
    pub(super) fn factorize_definite_newton(&mut self, gamma: f64) -> bool {
        let is_definite = self.begin_newton(gamma).is_ok();
        if is_definite {
            self.complete_newton();
        }
        is_definite
    }

    /// Sets N, positive definite.
    fn begin_newton(&mut self, gamma: f64) -> Result<(), Indefinite> {
        self.newton.gamma = gamma;
        let NewtonMatrix { solver, skew, stiffness, damping, is_damped, accuracy, follows, .. } =
            &mut self.newton;
        let (stiffness, damping) = (stiffness.get(), damping.get());
        let inertia = &self.matrices.inertia;
        skew.clear();
        if *follows && *accuracy == SOLVED_ONCE {
            let block = (&**stiffness.pattern(), stiffness.dimension());
            let size = block.1 * block.1;
            skew.set(block, &self.rows, |entry, at| {
                let at = entry * size + at;
                gamma * (damping.values[at] + gamma * stiffness.values[at])
            });
        }
        solver.begin(*accuracy, |source: EntrySource| {
            let (entry, transposed, axes) = (source.entry(), source.transposed(), source.axes());
            let mass = if axes[0] == axes[1] { inertia.values[entry] } else { 0.0 };
            let part = |matrix: &BlockMatrix| matrix.symmetric(entry, transposed, axes);
            let damped = if *is_damped { part(damping) } else { 0.0 };
            mass + gamma * (damped + gamma * part(stiffness))
        })
    }

    /// Prepares edges and flows for the current N.
    fn complete_newton(&mut self) {
        if let Some(solver) = &mut self.newton.solver.edges {
            solver.turn(&self.linear_edges, Some(stabilized(self.newton.gamma, self.alpha)));
        }
        self.condense_flow();
    }

    /// Solves the system above. `ru` holds ru and becomes xu; `self.newton.right` holds M rv - gamma Kt ru
    /// and `self.newton.demands` the required A^T xv. Leaves xv and mu there, the latter including those of
    /// nodal rows.
    fn solve_newton(&mut self, ru: &mut [f64]) {
        let gamma = self.newton.gamma;
        self.solve_resisted();
        let NewtonMatrix { stiffness, damping, right, xv, mu, stray, .. } = &mut self.newton;
        let (stiffness, damping) = (stiffness.get(), damping.get());
        nodal_multipliers(&self.rows, mu, |dof| {
            let damped = damping.row_product(dof, xv) + gamma * stiffness.row_product(dof, xv);
            self.matrices.momentum_of(dof, xv) + gamma * damped - right[dof]
        });
        xv.iter_mut().zip(stray).for_each(|(x, stray)| *x += *stray);
        ru.iter_mut().zip(&*xv).for_each(|(x, xv)| *x += gamma * xv);
    }

    /// Sets xv, and mu of general rows, for the right-hand side and the demands, under the resistance of amounts.
    pub(super) fn solve_resisted(&mut self) {
        let mut skew = std::mem::take(&mut self.newton.skew);
        if !skew.is_zero() {
            self.newton.keep(&mut skew.kept);
        }
        self.solve_symmetric();
        if !skew.is_zero() {
            self.add_skew(&mut skew);
        }
        self.newton.skew = skew;
    }

    /// Corrects the solution by the symmetric part of N where the other part matters.
    fn add_skew(&mut self, skew: &mut Skew) {
        let enough = SKEW * skew.size(&skew.kept[0]);
        let mut left = skew.begin(&self.newton.xv);
        if left <= enough {
            return;
        }
        self.newton.demand_nothing();
        for number in 0..skew.most() {
            skew.write(number, &mut self.newton.right);
            self.solve_symmetric();
            left = skew.extend(number, &self.newton.xv);
            if left <= enough {
                break;
            }
        }
        skew.finish();
        self.newton.restore(&skew.kept);
        skew.add(1.0, &mut self.newton.right);
        self.solve_symmetric();
        skew.add(-1.0, &mut self.newton.right);
    }

    /// As [`solve_resisted`](Self::solve_resisted), by the symmetric part of N.
    fn solve_symmetric(&mut self) {
        let NewtonMatrix { solver, right, xv, demands, mu, flow, .. } = &mut self.newton;
        solver.solve(&self.rows, right, demands, xv, mu);
        if let Some(flow) = flow {
            flow.resist(xv, right);
            solver.solve(&self.rows, right, demands, xv, mu);
        }
    }

    /// Turns A^T rv in `self.newton.demands` into A^T xv.
    fn stabilize_demands(&mut self, ru: &[f64]) {
        let (gamma, alpha) = (self.newton.gamma, self.alpha);
        let decay = 1.0 + alpha * gamma;
        for (demand, row) in self.newton.demands.iter_mut().zip(&self.rows) {
            *demand = (*demand - gamma * alpha * alpha * row.apply(ru)) / (decay * decay);
        }
    }

    /// The Newton system of the ODE form: `ru`, `rv` become xu, xv. First, `share` times the accelerations
    /// that follow from the forces and demands last evaluated is added to `rv`. Leaves in mu gamma times the
    /// change of lambda or, with those accelerations, `share` times the whole lambda. `internal` are the
    /// residuals of the internal unknowns.
    pub(crate) fn solve_newton_ode(
        &mut self,
        share: f64,
        ru: &mut [f64],
        rv: &mut [f64],
        internal: &[f64],
    ) {
        let right = self.newton.right.iter_mut();
        right.zip(&self.at.total).for_each(|(right, f)| *right = share * f);
        self.add_internal_residuals(ru, internal);
        let NewtonMatrix { stiffness, right, demands, gamma, .. } = &mut self.newton;
        self.matrices.add_momentum(1.0, rv, right);
        for ((demand, row), of_forces) in demands.iter_mut().zip(&self.rows).zip(&self.at.demands) {
            *demand = row.apply(rv) + share * of_forces;
        }
        // u' = v is linear: from the second iteration on, ru holds only round-off
        if largest(ru) > 1e-12 * *gamma * largest(rv) {
            stiffness.get().add_product(-*gamma, ru, right);
        }
        self.stabilize_demands(ru);
        let is_fixed = self.has_fixed_edges();
        let NewtonMatrix { solver, stray, gamma, .. } = &mut self.newton;
        if let Some(solver) = &mut solver.edges {
            // iterations converge faster, and to the same, with edges as they are at the trial point
            let edges = if is_fixed { &self.linear_edges } else { &self.edges };
            let factors = [*gamma, self.alpha, share];
            edges.newton_demands(factors, [ru, rv], &mut solver.demands);
            if !is_fixed {
                solver.turn(edges, Some(stabilized(*gamma, self.alpha)));
            }
        }
        if let Some(rigid) = &self.matrices.rigid {
            rigid.stray(rv, stray);
        }
        self.solve_newton(ru);
        rv.copy_from_slice(&self.newton.xv);
    }

    /// Adds to the right-hand side the effect of the residuals of the `internal` unknowns, and of those of the displacements, `ru`, on
    /// the forces.
    fn add_internal_residuals(&mut self, ru: &[f64], internal: &[f64]) {
        let NewtonMatrix { right, gamma, place, flow, .. } = &mut self.newton;
        let (strains, amounts) = self.layout.split(internal);
        if let (Some(branches), [_, ..]) = (&self.matrices.branches, strains) {
            branches.add_residuals(*gamma, place.each_ref().map(|at| &at[..]), strains, right);
        }
        if let Some(flow) = flow {
            flow.add_residuals(*gamma, ru, amounts, right);
        }
    }

    /// Turns the residuals `x` of the internal unknowns into their changes, by those of the displacements, `xu`. Returns the
    /// changes of the powers (W) dissipated and supplied along the whole of the last solution.
    pub(super) fn solve_internal(&mut self, xu: &[f64], x: &mut [f64]) -> [f64; 2] {
        let (dissipated, supplied) = self.power_changes();
        let (strains, amounts) = self.layout.split_mut(x);
        let NewtonMatrix { place, gamma, flow, .. } = &mut self.newton;
        let place = place.each_ref().map(|at| &at[..]);
        let relaxed =
            self.matrices.branches.as_ref().map_or(0.0, |branches| {
                branches.solve(*gamma, place, &self.at.relaxing, xu, strains)
            });
        let [heated, brought] = flow.as_mut().map_or([0.0; 2], |flow| flow.solve(xu, amounts));
        [dissipated + relaxed + heated, supplied + brought]
    }

    /// The Newton system of the index-1 form, cj dF/dy' + dF/dy with cj = 1/gamma: the residuals
    /// `r1`, `r2`, `r3` become xu, xv and the changes of lambda and of the multipliers of edges. `internal` are gamma times
    /// those of the internal unknowns.
    pub(super) fn solve_newton_index_one(
        &mut self,
        r1: &mut [f64],
        r2: &mut [f64],
        internal: &[f64],
        r3: &mut [f64],
    ) {
        let gamma = self.newton.gamma;
        self.take_strays([r1, r2]);
        r1.iter_mut().for_each(|r| *r *= gamma);
        self.matrices.rigid.iter().for_each(|rigid| rigid.carry(r1));
        self.add_strays(r1);
        let NewtonMatrix { stiffness, right, .. } = &mut self.newton;
        right.iter_mut().zip(&*r2).for_each(|(f, r)| *f = gamma * r);
        stiffness.get().add_product(-gamma, r1, right);
        self.add_internal_residuals(r1, internal);
        let NewtonMatrix { demands, solver, .. } = &mut self.newton;
        demands.iter_mut().zip(&*r3).for_each(|(d, r)| *d = gamma * r);
        if let Some(solver) = &mut solver.edges {
            let of_edges = &r3[self.rows.len()..];
            self.edges.index_one_demands([gamma, self.alpha], r1, of_edges, &mut solver.demands);
            solver.turn(&self.edges, Some(stabilized(gamma, self.alpha)));
        }
        self.stabilize_demands(r1);
        self.solve_newton(r1);
        r2.copy_from_slice(&self.newton.xv);
        self.changes(r3);
    }

    /// The Newton system of the form of index 2 likewise; `r4` becomes the changes of eta and zeta. With xu = s + gamma
    /// xv it splits into
    ///
    /// ```text
    /// M s - gamma A xeta = gamma r1,   A^T s = r4 - gamma r3
    /// (M + gamma D + gamma^2 Kt) xv - A mu = gamma r2 - gamma Kt s,   A^T xv = r3
    /// ```
    ///
    /// For edges G stands with A^T in the first row, G + gamma x' in the second, whose demands are r3 - x'.s; those of the
    /// first lack gamma x'.xu, which is not known yet: iterations converge by the angle of a piece in a time gamma.
    pub(super) fn solve_newton_index_two(
        &mut self,
        r1: &mut [f64],
        r2: &mut [f64],
        internal: &[f64],
        [r3, r4]: [&mut [f64]; 2],
    ) {
        let gamma = self.newton.gamma;
        self.take_strays([r1, r2]);
        let NewtonMatrix { right, demands, .. } = &mut self.newton;
        right.iter_mut().zip(&*r1).for_each(|(f, r)| *f = gamma * r);
        let of_slip = r4.iter().zip(&*r3).map(|(r4, r3)| r4 - gamma * r3);
        demands.iter_mut().zip(of_slip.clone()).for_each(|(d, of_slip)| *d = of_slip);
        let rows = self.rows.len();
        if let Some(solver) = &mut self.inertia.edges {
            let of_edges = solver.demands.iter_mut().zip(of_slip.skip(rows));
            of_edges.for_each(|(d, of_slip)| *d = of_slip);
            solver.turn(&self.edges, None);
        }
        let of = |dof: usize, x: &[f64]| self.matrices.momentum_of(dof, x);
        self.inertia.solve_whole(&self.rows, right, demands, r1, &mut r4[..rows], of);
        if let Some(solver) = &self.inertia.edges {
            r4[rows..].copy_from_slice(&solver.multipliers);
        }
        self.add_strays(r1);
        let NewtonMatrix { stiffness, right, .. } = &mut self.newton;
        right.iter_mut().zip(&*r2).for_each(|(f, r)| *f = gamma * r);
        stiffness.get().add_product(-gamma, r1, right);
        self.add_internal_residuals(r1, internal);
        let NewtonMatrix { demands, solver, .. } = &mut self.newton;
        demands.copy_from_slice(&r3[..rows]);
        if let Some(solver) = &mut solver.edges {
            let turned = r3[rows..].iter().zip(self.edges.turned(r1));
            let of_edges = solver.demands.iter_mut().zip(turned);
            of_edges.for_each(|(d, (r3, turned))| *d = r3 - turned);
            solver.turn(&self.edges, Some([1.0, gamma, 0.0]));
        }
        self.solve_newton(r1);
        r2.copy_from_slice(&self.newton.xv);
        self.changes(r3);
        r4.iter_mut().for_each(|x| *x /= gamma);
    }

    /// Takes from the residuals `r1` and `r2` of a DAE form by how much dependent nodes of rigid pieces have strayed, on
    /// which no force acts.
    fn take_strays(&mut self, [r1, r2]: [&mut [f64]; 2]) {
        let Some(rigid) = &self.matrices.rigid else { return };
        let (d, NewtonMatrix { stray, xv, gamma, .. }) =
            (self.matrices.dimension, &mut self.newton);
        for at in rigid.dependents().flat_map(|(node, _)| node * d..(node + 1) * d) {
            stray[at] = std::mem::take(&mut r2[at]);
            // xv, with its error, adds to xu
            xv[at] = std::mem::take(&mut r1[at]) - *gamma * stray[at];
        }
    }

    /// Adds to `xu`, in which dependent nodes move as their frames do, what the last call of
    /// [`take_strays`](Self::take_strays) has taken from `r1`.
    fn add_strays(&self, xu: &mut [f64]) {
        let (Some(rigid), d) = (&self.matrices.rigid, self.matrices.dimension) else { return };
        for at in rigid.dependents().flat_map(|(node, _)| node * d..(node + 1) * d) {
            xu[at] += self.newton.xv[at];
        }
    }

    /// Writes the changes of lambda and of the multipliers of edges that the last solution has found.
    fn changes(&self, changes: &mut [f64]) {
        let NewtonMatrix { mu, solver, gamma, .. } = &self.newton;
        let of_edges = solver.edges.iter().flat_map(|solver| &solver.multipliers);
        let all = mu.iter().chain(of_edges);
        changes.iter_mut().zip(all).for_each(|(x, mu)| *x = mu / gamma);
    }

    /// Changes of the powers dissipated and supplied along the last solution of the Newton system: exact
    /// where forces are linear, as powers are quadratic then. So one iteration is enough for the energies,
    /// too. Multipliers that the evaluation left at 0 are entirely in mu.
    pub(super) fn power_changes(&mut self) -> (f64, f64) {
        let NewtonMatrix { damping, is_damped, right, xv, mu, gamma, .. } = &mut self.newton;
        let (mut dissipated, mut supplied) = self.at.nodal.work(xv);
        if *is_damped {
            right.fill(0.0);
            damping.get().add_product(1.0, xv, right);
            // damping forces are proportional to velocity
            dissipated = 2.0 * dissipated + dot(right, xv);
        }
        for ((row, mu), (multiplier, rate)) in
            self.rows.iter().zip(mu).zip(self.at.multipliers.iter().zip(&self.at.rates))
        {
            let change = row.apply(xv);
            supplied += multiplier * change + *mu / *gamma * (rate + change);
        }
        (dissipated, supplied)
    }
}
