//! A phase at rest: forces without motion, tangents, and the saddle-point system of statics
//!
//! ```text
//! [ K   -A ] [ x  ]   [ f ]
//! [ -A^T 0 ] [ mu ] = [ -d ]
//! ```
//!
//! with K = -df/du. External actions are applied gradually. From the undeformed shape, gravity, loads, pressure and the
//! forces of actuators act by a fraction of their strength; obstacles in motion are at that fraction of their paths; tensions of
//! cables, lengths of winches, strains of growth and amounts of gas and liquids have risen by it
//! ([`Scene::loaded`](crate::Scene)). The body and its springs do not change.
//!
//! From a given start u_0, all these act fully, and the unbalanced force there is released instead: with the fraction s the
//! forces are f(u) - (1 - s) f(u_0). Where u_0 was in equilibrium under other dead loads, that is the straight path from these loads
//! to the present ones.
//!
//! The shift of K + shift M is 0 unless K is indefinite; M is the natural measure of displacements, and the
//! sum is the matrix of a time step. The Newton step is shortened until the energy falls; of forces without a
//! potential the work of their mean over the step counts, which is exact for dead loads.

#[cfg(feature = "study")]
mod dual;
#[cfg(feature = "gradient")]
pub(crate) use dual::DUAL_ERROR;
#[cfg(test)]
mod tests;

use super::System;
use super::newton_matrix::NewtonMatrix;
use crate::base::input::InputError;
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::base::vector::{dot, largest};
use crate::dynamics::linear::{EntrySource, nodal_multipliers};
use crate::dynamics::system::Energy;
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir, Step};
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, Prescribed};

/// The system of a phase at its end, without velocities.
pub(crate) struct AtRest {
    system: System,
    time: f64,
    still: Vec<f64>,
    /// Velocities of the nodes for each of the forces: those of an obstacle in motion, so that it drags
    /// nothing along and no damper acts, as if it stood still. Empty for others.
    velocities: Vec<Vec<f64>>,
    /// Start of the search (m), and, of a given start, the unbalanced forces (N) there.
    start: Vec<f64>,
    unbalanced: Option<Vec<f64>>,
    nodal: NodalForces,
    factorizations: usize,
}

/// Forces and energy at some displacements.
#[derive(Clone)]
pub(crate) struct ForceBalance {
    /// Sum of all nodal forces except those of the constraints (N).
    pub(crate) total: Vec<f64>,
    /// Those among them that have no potential.
    unbound: Vec<f64>,
    /// Potential energy of the others (J).
    potential: f64,
    /// Sum of the absolute values of the terms of `potential`: the scale of its round-off.
    terms: f64,
    /// Largest nodal force of any one kind (N): the scale of the forces in balance.
    pub(crate) scale: f64,
}

impl ForceBalance {
    pub(crate) fn zeros(dofs: usize) -> Self {
        let zeros = vec![0.0; dofs];
        Self { total: zeros.clone(), unbound: zeros, potential: 0.0, terms: 0.0, scale: 0.0 }
    }

    /// Energy (J) at `self` minus that at `from`, a step of `factor` times `x` before. The work of forces
    /// without a potential is that of their mean: exact for constant ones.
    pub(crate) fn energy_since(&self, from: &ForceBalance, factor: f64, x: &[f64]) -> f64 {
        let work = 0.5 * factor * (dot(&self.unbound, x) + dot(&from.unbound, x));
        self.potential - from.potential - work
    }

    /// Size of the round-off in differences of energy (J) at displacements near `u`; the work is known to the
    /// precision of `u`.
    pub(crate) fn round_off(&self, u: &[f64]) -> f64 {
        let work: f64 = self.unbound.iter().zip(u).map(|(f, u)| (f * u).abs()).sum();
        f64::EPSILON * (8.0 * self.terms + work)
    }

    /// Adds constant forces (N), times `share`.
    fn add_constant(&mut self, forces: &[f64], share: f64) {
        for (i, force) in forces.iter().enumerate() {
            self.total[i] += share * force;
            self.unbound[i] += share * force;
            self.scale = self.scale.max((share * force).abs());
        }
    }

    fn clear(&mut self) {
        self.total.fill(0.0);
        self.unbound.fill(0.0);
        (self.potential, self.terms, self.scale) = (0.0, 0.0, 0.0);
    }

    fn add_potential(&mut self, energy: f64) {
        self.potential += energy;
        self.terms += energy.abs();
    }

    /// Adds `share` times the forces `nodal`, of which the conservative ones have a potential if
    /// `bound`.
    fn add(&mut self, nodal: &NodalForces, share: f64, bound: bool) {
        let NodalForces { conservative, dissipative, applied, .. } = nodal;
        for (i, total) in self.total.iter_mut().enumerate() {
            let unbound = dissipative[i] + applied[i] + if bound { 0.0 } else { conservative[i] };
            let force = conservative[i] + dissipative[i] + applied[i];
            *total += share * force;
            self.unbound[i] += share * unbound;
            self.scale = self.scale.max((share * force).abs());
        }
    }
}

impl AtRest {
    /// # Errors
    /// A path of a constraint that gives no finite displacement at `time` (s).
    pub(crate) fn new(mut system: System, time: f64, phase: &str) -> Result<Self, InputError> {
        system.release_edges();
        let lost = |prescribed: Prescribed| !prescribed.displacement.is_finite();
        if let Some(row) = system.rows.iter().find(|row| lost(row.prescribed(time))) {
            return Err(InputError::new(
                format!("path of {} in phase \"{phase}\"", row.label(system.matrices.dimension)),
                format!("{} m at t = {time} s", row.prescribed(time).displacement),
                "it must give finite numbers",
            ));
        }
        let dofs = system.dofs();
        let still = vec![0.0; dofs];
        let velocities = vec![Vec::new(); system.forces.len()];
        let nodal = NodalForces::zeros(dofs);
        let start = still.clone();
        let unbalanced = None;
        Ok(Self { system, time, still, velocities, start, unbalanced, nodal, factorizations: 0 })
    }

    /// Starts from the displacements `start` (m), with all loads as they are.
    ///
    /// # Errors
    /// Displacements at which forces are undefined.
    pub(crate) fn starting_from(mut self, start: Vec<f64>) -> Result<Self, Failure> {
        let mut at = ForceBalance::zeros(start.len());
        self.unbalanced = Some(vec![0.0; start.len()]);
        self.evaluate(0.0, &start, &mut at)?;
        // forces on held components are those of the constraints
        for dof in self.system.rows.iter().filter_map(|row| row.nodal()) {
            at.total[dof.0] = 0.0;
        }
        (self.start, self.unbalanced) = (start, Some(at.total));
        Ok(self)
    }

    /// Start of the search (m).
    pub(crate) fn start(&self) -> &[f64] {
        &self.start
    }

    /// The fraction of the loads that acts at a `fraction` of the path.
    pub(crate) fn acting(&self, fraction: f64) -> f64 {
        if self.unbalanced.is_some() { 1.0 } else { fraction }
    }

    pub(crate) fn system(&self) -> &System {
        &self.system
    }

    /// The end of the phase (s).
    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    /// Whether obstacles move.
    pub(crate) fn is_driven(&self) -> bool {
        let mut contacts =
            self.system.forces.iter().filter_map(|force| force.capabilities().contact);
        contacts.any(|contact| contact.velocity(self.time).is_some())
    }

    /// M x
    pub(crate) fn weigh(&self, x: &[f64], product: &mut [f64]) {
        product.fill(0.0);
        self.system.matrices.add_momentum(1.0, x, product);
    }

    /// Number of factorizations so far.
    pub(crate) fn factorizations(&self) -> usize {
        self.factorizations
    }

    /// Whether no force but the linear elastic one depends on the displacements.
    pub(crate) fn is_linear(&self) -> bool {
        self.system.forces.iter().all(|force| !force.is_nonlinear())
    }

    /// Whether no force from outside depends on the displacements.
    pub(crate) fn is_under_dead_loads(&self) -> bool {
        let mut forces = self.system.forces.iter();
        forces.all(|force| !force.is_nonlinear() || force.reservoir() == Reservoir::Strain)
    }

    /// Potential energies with a fraction of gravity, and of the paths of obstacles.
    pub(crate) fn energy(&self, fraction: f64, u: &[f64]) -> Energy {
        let energy = self.system.energy(fraction * self.time, u, &self.still, &[]);
        Energy { gravity: self.acting(fraction) * energy.gravity, ..energy }
    }

    /// Residual of the constraints, b - A^T u, with b for a fraction of the path: a path that begins where the search starts is
    /// followed; to another one leads a straight line.
    pub(crate) fn lacking(&self, fraction: f64, u: &[f64], d: &mut [f64]) {
        for (d, row) in d.iter_mut().zip(&self.system.rows) {
            let b = |t: f64| row.prescribed(t).displacement;
            let from = row.apply(&self.start);
            let part = match b(0.0) == from {
                true => b(fraction * self.time),
                false => from + fraction * (b(self.time) - from),
            };
            *d = part - row.apply(u);
        }
    }

    /// Evaluates the forces at `u` at a fraction of the load.
    pub(crate) fn evaluate(
        &mut self,
        fraction: f64,
        u: &[f64],
        at: &mut ForceBalance,
    ) -> Result<(), Failure> {
        at.clear();
        self.stand_still(fraction);
        let acting = self.acting(fraction);
        if let Some(unbalanced) = &self.unbalanced {
            at.add_constant(unbalanced, fraction - 1.0);
        }
        if let Some(stiffness) = &self.system.matrices.stiffness {
            self.nodal.clear();
            stiffness.add_product(-1.0, u, &mut self.nodal.conservative);
            at.add(&self.nodal, 1.0, true);
            at.add_potential(-0.5 * dot(u, &self.nodal.conservative));
        }
        let is_given = self.unbalanced.is_some();
        for (force, v) in self.system.forces.iter().zip(&self.velocities) {
            let v = if v.is_empty() { &self.still } else { v };
            self.nodal.clear();
            let time = when(&**force, is_given, fraction, self.time);
            let share = if is_load(&**force) { acting } else { 1.0 };
            force.add_forces(time, u, v, &mut self.nodal)?;
            let bound = force.reservoir() != Reservoir::None;
            at.add(&self.nodal, share, bound);
            if bound {
                at.add_potential(share * force.potential(time, u));
            }
        }
        Ok(())
    }

    /// The part of the straight path from displacements `u` to `to` on which surfaces that touch come much nearer to each
    /// other than at both of its ends, if they do: they would pass through each other.
    pub(crate) fn passage(&self, u: &[f64], to: &[f64]) -> Option<f64> {
        // obstacles, which have switches, push back from any depth
        let surfaces = self.system.forces.iter().filter_map(|force| {
            let Capabilities { switches, contact, .. } = force.capabilities();
            contact.filter(|_| switches.is_none())
        });
        let mut surfaces = surfaces.peekable();
        surfaces.peek()?;
        let way: Vec<f64> = u.iter().zip(to).map(|(u, to)| to - u).collect();
        let step = Step { times: [0.0, 1.0], u: [u, to], v: [&way, &way] };
        surfaces.filter_map(|force| force.passage(&step, 0.0, &mut [])).reduce(f64::min)
    }

    /// Gives the nodes the velocity of each obstacle at a fraction of its path.
    fn stand_still(&mut self, fraction: f64) {
        let dimension = self.system.matrices.dimension;
        let is_given = self.unbalanced.is_some();
        for (force, v) in self.system.forces.iter().zip(&mut self.velocities) {
            let contact = force.capabilities().contact;
            let at = when(&**force, is_given, fraction, self.time);
            if let Some(w) = contact.and_then(|contact| contact.velocity(at)) {
                v.resize(self.still.len(), 0.0);
                v.iter_mut().enumerate().for_each(|(dof, v)| *v = w[dof % dimension]);
            }
        }
    }

    /// Updates K to `u`. In a linear phase it is constant.
    pub(crate) fn update_tangent(&mut self, fraction: f64, u: &[f64]) {
        self.stand_still(fraction);
        self.system.make_room(u);
        let acting = self.acting(fraction);
        let is_given = self.unbalanced.is_some();
        let NewtonMatrix { stiffness, damping, differences, .. } = &mut self.system.newton;
        let still = &self.still;
        let own = (stiffness.begin(&None), damping.begin(&None));
        let (Some(stiffness), Some(damping)) = own else { return };
        let mut add = |loads: bool, stiffness: &mut BlockMatrix| {
            for (force, v) in self.system.forces.iter().zip(&self.velocities) {
                if is_load(&**force) == loads {
                    let time = when(&**force, is_given, fraction, self.time);
                    let v = if v.is_empty() { still } else { v };
                    differences.add_tangents(force, time, [u, v], [stiffness, damping]);
                }
            }
        };
        add(true, stiffness);
        stiffness.values.iter_mut().for_each(|k| *k *= acting);
        add(false, stiffness);
        if let Some(constant) = &self.system.matrices.stiffness {
            stiffness.values.iter_mut().zip(&constant.values).for_each(|(k, c)| *k += c);
        }
    }

    /// K as it was last updated.
    pub(crate) fn tangent(&self) -> &BlockMatrix {
        self.system.tangents().0
    }

    /// Largest K_ii / M_ii (1/s^2) where there is mass: of the order of the square of the highest frequency.
    pub(crate) fn highest(&self) -> f64 {
        let (k, _) = self.system.tangents();
        let (m, d) = (&self.system.matrices.inertia, self.system.matrices.dimension);
        let ratio = |dof: usize| k.get(dof, dof).abs() / m.get(dof / d, dof / d);
        // a rigid body by numbers has all of it at the nodes of its frame
        (0..self.system.dofs()).map(ratio).filter(|ratio| ratio.is_finite()).fold(0.0, f64::max)
    }

    /// Factorizes the symmetric part of K + `shift` M. Returns whether it is positive definite
    /// at the free degrees of freedom.
    pub(crate) fn factorize(&mut self, shift: f64) -> bool {
        self.factorizations += 1;
        let System { matrices, newton, .. } = &mut self.system;
        let (inertia, stiffness) = (&matrices.inertia, newton.stiffness.get());
        newton.solver.factorize(|source| shifted(inertia, stiffness, shift, source)).is_ok()
    }

    /// Factorizes the symmetric part of K, definite or not. Returns whether this succeeded.
    pub(crate) fn factorize_any(&mut self) -> bool {
        self.factorize(0.0) || self.system.newton.solver.factorize_indefinite().is_ok()
    }

    /// Solves the saddle-point system above, with K shifted as in the last factorization. `mu` holds the
    /// multipliers known so far, and then those that balance `f` where the rows act: those of an equilibrium
    /// once x vanishes. Those of general rows are computed by their change, so that after iterations only the
    /// round-off of the unbalanced forces remains.
    pub(crate) fn solve(&mut self, f: &[f64], d: &[f64], x: &mut [f64], mu: &mut [f64]) {
        let System { rows, newton, .. } = &mut self.system;
        let NewtonMatrix { solver, right, mu: change, .. } = newton;
        right.copy_from_slice(f);
        let general = |(row, _): &(&ConstraintRow, _)| row.nodal().is_none();
        for (row, mu) in rows.iter().zip(&*mu).filter(general) {
            row.terms.iter().for_each(|&(dof, c)| right[dof] += c * mu);
        }
        solver.solve(rows, right, d, x, change);
        for ((_, mu), change) in
            rows.iter().zip(&mut *mu).zip(&*change).filter(|(of, _)| of.0.nodal().is_none())
        {
            *mu += change;
        }
        nodal_multipliers(rows, mu, |dof| -f[dof]);
    }

    /// Size of the round-off in nodal forces (N) at displacements of these `sizes` (m): some of the last
    /// digits of the terms of K u, which largely cancel in the forces. K is that of the last
    /// [`update_tangent`](Self::update_tangent).
    pub(crate) fn round_off(&self, sizes: &[f64]) -> f64 {
        let k = self.tangent();
        let terms = (0..sizes.len()).map(|dof| k.absolute_row_product(dof, sizes));
        8.0 * f64::EPSILON * terms.fold(0.0, f64::max)
    }

    /// Factorizes the matrix that `add` makes in the place of K. A small multiple of M holds its free motions.
    pub(crate) fn factorize_other(&mut self, add: impl FnOnce(&mut BlockMatrix)) -> bool {
        let Some(matrix) = self.system.newton.stiffness.begin(&None) else { return false };
        add(matrix);
        self.factorize(SLIGHT * self.highest())
    }

    /// The change x, which the constraints allow, by the last factorization.
    pub(crate) fn solve_other(&mut self, right: &[f64], x: &mut [f64]) {
        let System { rows, newton, .. } = &mut self.system;
        x.copy_from_slice(&newton.solver.solve_free(rows, right));
    }

    /// Largest component of f + A mu (N).
    pub(crate) fn residual(&self, f: &[f64], mu: &[f64], work: &mut [f64]) -> f64 {
        work.copy_from_slice(f);
        self.system.add_rows(1.0, mu, work);
        self.system.matrices.gather(work);
        largest(work)
    }

    /// Lowest eigenvalue (1/s^2) of K x = eigenvalue M x among the motions that the constraints allow, by
    /// inverse iteration with the last factorization, that of K + `shift` M. It converges from above, so that
    /// a value below zero is a proof. Infinite if nothing can move.
    pub(crate) fn lowest_eigenvalue(&mut self, shift: f64) -> f64 {
        let noise = |i: usize| (12.9898 * (i as f64 + 1.0)).sin().mul_add(43.758, 0.3).sin();
        let mut right: Vec<f64> = (0..self.system.dofs()).map(noise).collect();
        let mut lowest = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let System { matrices, rows, newton, .. } = &mut self.system;
            let x = newton.solver.solve_free(rows, &right);
            right = matrices.momentum(&x);
            let square = dot(&x, &right);
            if square == 0.0 {
                break;
            }
            let before = lowest;
            lowest = newton.stiffness.get().quadratic_form(&x) / square;
            if before - lowest <= 1e-8 * (lowest + shift) {
                break;
            }
            right.iter_mut().for_each(|r| *r /= square.sqrt());
        }
        lowest
    }
}

/// Entry of `shift` M + the symmetric part of K.
pub(super) fn shifted(
    inertia: &NodeMatrix,
    stiffness: &BlockMatrix,
    shift: f64,
    source: EntrySource,
) -> f64 {
    let (entry, transposed, axes) = (source.entry(), source.transposed(), source.axes());
    let mass = if axes[0] == axes[1] { inertia.values[entry] } else { 0.0 };
    shift * mass + stiffness.symmetric(entry, transposed, axes)
}

/// That multiple, as a part of the largest ratio of entries.
const SLIGHT: f64 = 1e-10;

/// Bound on inverse iterations: enough for six digits even of close pairs of eigenvalues.
const ITERATIONS: usize = 300;

/// The time (s) at which a force is evaluated for a `fraction` of the load, up to the end `time`: a load at the end, what is not
/// scaled at that fraction of its path. From a given start all but obstacles act as at the end.
fn when(force: &dyn Force, is_given: bool, fraction: f64, time: f64) -> f64 {
    let is_whole = is_given && force.reservoir() != Reservoir::Contact;
    if is_load(force) || is_whole { time } else { fraction * time }
}

/// Whether a force is applied by fractions of its strength.
fn is_load(force: &dyn Force) -> bool {
    matches!(force.reservoir(), Reservoir::Gravity | Reservoir::None)
}
