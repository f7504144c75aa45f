//! The equations of one phase of a scene.
//!
//! With displacements u, velocities v, forces f(t, u, v) and the rows A of the constraints
//! (Hirai (4.3.4)):
//!
//! ```text
//! u' = v
//! [ M   -A ] [ v'     ]   [ f ]
//! [ -A^T 0 ] [ lambda ] = [ C ],   C = -b'' + 2 alpha (A^T v - b') + alpha^2 (A^T u - b)
//! ```
//!
//! [`System`] is the ODE form, in which v' and lambda are solved for; [`DaeForm`] the differential-algebraic
//! forms, in which lambda is an unknown, and [`SecondOrderForm`] the form in which the constraints are known
//! motion. The first two solve their Newton systems with the one symmetric matrix of [`newton`], half as
//! large as the state.
//!
//! Maxwell branches, gas that flows and actuators that lag have unknowns beside u and v: internal strains and amounts, in this order.
//!
//! Two more unknowns are integrated: the energy dissipated and the energy supplied since t = 0. They cost two
//! dot products, nothing depends on them, and the error control leaves them out; they make the energy balance
//! as accurate as the integration itself.
//!
//! `dynamics/state.rs` owns the order of the unknowns, y = (u, v, strains, amounts, E_d, E_s), behind which differential-algebraic
//! forms have multipliers. Forces add up in three vectors (conservative, dissipative, applied), so that both powers are one dot
//! product each and no force has an account of its own. Quadrature after the run would cost more evaluations
//! of forces than the integration. Tolerances of the energies are loose (energies at strains of order 1) and
//! not infinite: unknowns that Newton's iteration does not control grow without bound, as BDF extrapolates
//! their errors. To Rosenbrock methods and the internal Runge-Kutta method they are integrals.
//!
//! A row of the constraints that goes on into the next phase starts where the phase before prescribed it, so
//! that the error of the stabilization is not passed on. Multipliers follow from the constrained rows of M
//! a - f; in the ODE form they are output.

mod at_rest;
mod cholesky;
mod constrained_solver;
mod dae;
mod dae_jacobian;
mod differences;
mod edge_solver;
mod edges;
mod ends;
mod expected;
mod flow_matrix;
mod form;
mod gas;
mod general_rows;
mod gradients;
mod guide;
mod imbalance;
mod mobility;
mod newton;
mod newton_matrix;
mod ode;
mod rates;
mod reduced_branches;
mod reduced_dae;
mod reduced_flow;
mod reduced_form;
mod reduction;
pub(crate) mod rigid;
mod scene;
mod schur;
mod second_order;
mod settled;
mod shape;
mod shapes;
mod source;
mod spectrum;
mod summary;
mod symmetric;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::sync::Arc;

pub(crate) use at_rest::{AtRest, ForceBalance};
use constrained_solver::{ConstrainedSolver, EXACT, nodal_multipliers};
pub(crate) use dae::{DaeForm, Index};
use edges::Edges;
use ends::Ends;
pub(crate) use expected::Vibrations;
pub(crate) use form::Form;
pub(crate) use imbalance::{MissingDisplacement, ResidualSnapshot};
use newton_matrix::NewtonMatrix;
pub(crate) use reduced_dae::ReducedDae;
pub(crate) use reduced_form::{Lift, ReducedForm};
use reduction::Reduction;
pub(crate) use second_order::SecondOrderForm;
use source::Coupling;
pub use spectrum::Spectrum;
pub use summary::PhaseSummary;

use crate::base::input::InputError;
use crate::base::sparse::NodeMatrix;
use crate::base::vector::dot;
use crate::dynamics::matrices::Matrices;
use crate::dynamics::state::{Layout, State};
use crate::elements::body::Branches;
use crate::elements::force::{Capabilities, Flow, Force, Forces, NodalForces, Reservoir, Step};
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, Prescribed};

/// Equations of one phase, with everything that evaluating and solving them needs.
pub(crate) struct System {
    /// The matrices of the scene, and those with room for what is near now.
    base: Arc<Matrices>,
    matrices: Arc<Matrices>,
    forces: Forces,
    /// Those that keep rigid pieces in their shape, which their edges do here.
    of_rigid: Forces,
    /// That whose amounts are unknowns, if there is one.
    flow: Option<Arc<dyn Force>>,
    layout: Layout,
    rows: Vec<ConstraintRow>,
    /// Stabilization rate alpha (1/s).
    alpha: f64,
    inertia: ConstrainedSolver,
    /// Edges that keep the shape of rigid pieces.
    edges: Edges,
    /// All edges, including those that constraints keep already.
    all_edges: Edges,
    /// The edges at the state of the tangents.
    linear_edges: Edges,
    newton: NewtonMatrix,
    at: Evaluation,
    /// Why a force was undefined, the last time that one was.
    refusal: String,
    /// Pressures of liquids at the ends of the last step.
    ends: Ends,
    /// The reduced model, where the phase is run by one.
    reduction: Option<Box<Reduction>>,
}

/// Results of the last evaluation of the equations.
struct Evaluation {
    nodal: NodalForces,
    /// f, the sum of all nodal forces.
    total: Vec<f64>,
    /// v'
    acceleration: Vec<f64>,
    /// lambda, one per row.
    multipliers: Vec<f64>,
    /// A^T v, one per row.
    rates: Vec<f64>,
    /// A^T v' as the stabilization requires it, one per row.
    demands: Vec<f64>,
    /// Rates (1/s) of the internal strains, and the power (W) that they dissipate.
    relaxing: Vec<f64>,
    relaxed: f64,
    /// Rates of the amounts of gas (kg/s) and of the flows of pipes, room for as many numbers, and the power (W) supplied with them.
    flowing: [Vec<f64>; 2],
    brought: f64,
}

/// Energies of a state (J).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energy {
    /// (1/2) v.M v, and that of liquids in pipes.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Potential of gravity, 0 at height 0.
    pub gravity: f64,
    /// Stored in the penalty springs of contacts.
    pub contact: f64,
    /// Stored in springs between nodes, and in gas in chambers and the air around them; of liquids that of their compression and
    /// their weight.
    pub springs: f64,
    /// Turned into heat since t = 0 by viscosity, damping and friction of contacts and pipes.
    pub dissipated: f64,
    /// Supplied since t = 0 by loads and constraints, and with gas and liquids that flow in.
    pub supplied: f64,
}

impl Energy {
    /// Kinetic + potential + dissipated - supplied: constant along an exact motion.
    pub fn balance(&self) -> f64 {
        let stored = self.strain + self.gravity + self.contact + self.springs;
        self.kinetic + stored + self.dissipated - self.supplied
    }

    /// Sum of all but gravity, whose zero is arbitrary, as the scale of the balance; potentials may be below 0.
    pub(crate) fn size(&self) -> f64 {
        let stored = self.strain.abs() + self.contact.abs() + self.springs.abs();
        self.kinetic + stored + self.dissipated.abs() + self.supplied.abs()
    }
}

impl System {
    /// # Errors
    /// General constraint rows that follow from others.
    pub(crate) fn new(
        matrices: Arc<Matrices>,
        forces: Forces,
        rows: Vec<ConstraintRow>,
        alpha: f64,
        phase: &str,
    ) -> Result<Self, InputError> {
        let (dimension, dofs) = (matrices.dimension, matrices.dofs());
        let coupling = match matrices.inertia.is_diagonal() && matrices.rigid.is_none() {
            true => Coupling::Diagonal,
            false => Coupling::SameAxis,
        };
        let mut edges = Edges::new(matrices.rigid.as_deref(), &matrices.positions, dimension);
        let all_edges = edges.clone();
        let mut inertia = ConstrainedSolver::new(&matrices, &rows, &edges.list, coupling);
        let values = &matrices.inertia.values;
        let mut begun = inertia.begin(EXACT, |source| values[source.entry()]);
        if let (Some(solver), Ok(())) = (&mut inertia.edges, &begun) {
            let is_kept = solver.independent(&edges);
            if is_kept.contains(&false) {
                edges = edges.retained(&is_kept);
                inertia = ConstrainedSolver::new(&matrices, &rows, &edges.list, coupling);
                begun = inertia.begin(EXACT, |source| values[source.entry()]);
            }
        }
        if begun.is_err() {
            return Err(match inertia.dependent_row() {
                Some(row) => InputError::new(
                    format!("constraints of phase \"{phase}\""),
                    format!("row {}", rows[row].label(dimension)),
                    "it follows from the other constraints: leave it out",
                ),
                None => InputError::new(
                    "material.density",
                    format!("giving {:e} kg on node 1", matrices.inertia.get(0, 0)),
                    "with this mesh the masses are beyond the range of double precision",
                ),
            });
        }
        let newton = NewtonMatrix::new(&matrices, &rows, &edges.list, follows(&matrices, &forces));
        let (of_rigid, flow, forces) = parted(forces);
        let amounts = flow_of(&flow).map_or(0, |flow| flow.start().len());
        let strains = matrices.branches.as_ref().map_or(0, Branches::unknowns);
        let layout = Layout { dofs, strains, amounts };
        let at = Evaluation {
            nodal: NodalForces::zeros(dofs),
            total: vec![0.0; dofs],
            acceleration: vec![0.0; dofs],
            multipliers: vec![0.0; rows.len()],
            rates: vec![0.0; rows.len()],
            demands: vec![0.0; rows.len()],
            relaxing: vec![0.0; strains],
            relaxed: 0.0,
            flowing: [vec![0.0; amounts], vec![0.0; amounts]],
            brought: 0.0,
        };
        let mut newton = newton;
        let rooms = flow_of(&flow).map_or(0, |flow| flow.reservoirs());
        newton.hold_amounts([rooms, amounts], dofs);
        let (base, refusal) = (matrices.clone(), String::new());
        let linear_edges = edges.clone();
        Ok(Self {
            base,
            matrices,
            forces,
            of_rigid,
            flow,
            layout,
            rows,
            alpha,
            inertia,
            edges,
            all_edges,
            linear_edges,
            newton,
            at,
            refusal,
            ends: Ends::default(),
            reduction: None,
        })
    }

    /// Positions of the unknowns.
    pub(crate) fn layout(&self) -> Layout {
        self.layout
    }

    /// Number of displacement components.
    pub(crate) fn dofs(&self) -> usize {
        self.matrices.dofs()
    }

    /// Dimension of space.
    pub(crate) fn dimension(&self) -> usize {
        self.matrices.dimension
    }

    /// Replaces the forces, if the Newton matrix has room for their tangents; all else is unchanged. Returns
    /// whether it has.
    pub(crate) fn change_forces(&mut self, forces: Forces) -> bool {
        if follows(&self.matrices, &forces) != self.newton.follows {
            return false;
        }
        if let Some(reduction) = &mut self.reduction {
            if !reduction.has_room(&forces) {
                return false;
            }
            reduction.take(&forces);
        }
        (self.of_rigid, self.flow, self.forces) = parted(forces);
        self.forget_tangents();
        true
    }

    /// Marks the tangents as out of date.
    pub(crate) fn forget_tangents(&mut self) {
        self.newton.is_set = false;
        self.reduction.iter_mut().for_each(|reduction| reduction.forget_tangents());
    }

    /// The inertia matrix.
    pub(crate) fn inertia(&self) -> &NodeMatrix {
        &self.matrices.inertia
    }

    /// The constraints, row by row.
    pub(crate) fn rows(&self) -> &[ConstraintRow] {
        &self.rows
    }

    /// Starts the counts below from 0.
    pub(crate) fn forget_counts(&mut self) {
        self.newton.forget_counts();
    }

    /// Number of evaluations of the tangents so far; 0 where they are constant.
    pub(crate) fn tangent_evaluations(&self) -> usize {
        self.newton.tangent_evaluations()
    }

    /// Counts so far: Newton matrices that were never factorized, iterations for them and others, and Newton
    /// matrices found not to be positive definite.
    pub(crate) fn newton_counts(&self) -> [usize; 3] {
        self.newton.solver.counts()
    }

    /// Number of patterns of the Newton matrix after the first.
    pub(crate) fn pattern_changes(&self) -> usize {
        self.newton.patterns
    }

    /// Number of evaluations for the tangents of forces that do not compute them.
    pub(crate) fn difference_evaluations(&self) -> usize {
        self.newton.difference_evaluations() + self.reduced_differences()
    }

    /// The constraint forces lambda (N) at (t, u, v) and the internal strains, row by row.
    pub(crate) fn multipliers(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        internal: &[f64],
    ) -> Result<&[f64], Failure> {
        match self.is_reduced() {
            true => self.evaluate_reduced(t, [u, v, internal])?,
            false => self.evaluate(t, u, v, internal)?,
        }
        Ok(&self.at.multipliers)
    }

    /// The accelerations (m/s^2) where [`multipliers`](Self::multipliers) were computed last.
    pub(crate) fn computed_accelerations(&self) -> &[f64] {
        &self.at.acceleration
    }

    /// The velocities nearest to `v`, in the sense of kinetic energy, that the constraints allow
    /// at time `t` and the displacements `u`.
    pub(crate) fn project(&mut self, t: f64, u: &[f64], v: &mut [f64]) {
        self.edges.move_to(self.alpha, u, v);
        self.turn_inertia(false);
        self.at.total.fill(0.0);
        let Matrices { inertia, dimension, .. } = &*self.matrices;
        inertia.add_product(*dimension, 1.0, v, &mut self.at.total);
        for (demand, row) in self.at.demands.iter_mut().zip(&self.rows) {
            *demand = row.prescribed(t).velocity;
        }
        let Evaluation { total, demands, multipliers, .. } = &mut self.at;
        self.inertia.solve(&self.rows, total, demands, v, multipliers);
    }

    /// Why a force was undefined at a trial point, the last time that one was; empty if none ever was.
    pub(crate) fn refusal(&self) -> &str {
        &self.refusal
    }

    /// Asks the forces whether the step from displacements `before` to the state `after` makes sense.
    pub(crate) fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        let State { u, internal, .. } = self.layout.of(after);
        let all = self.forces.iter().chain(&self.flow);
        let mut all = all.filter_map(|force| force.capabilities().step_check);
        all.try_for_each(|force| force.check_step(t, before, u))?;
        let (_, amounts) = self.layout.split(internal);
        match flow_of(&self.flow) {
            Some(flow) if !amounts.is_empty() => flow.check(t, u, amounts),
            _ => Ok(()),
        }
    }

    /// Number of switches of all forces.
    pub(crate) fn switches(&self) -> usize {
        self.forces.iter().map(switches).sum()
    }

    /// Writes the values of the switches of each force of which `is_wanted` says so by their numbers.
    pub(crate) fn switch_values(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        values: &mut [f64],
        is_wanted: impl Fn(Range<usize>) -> bool,
    ) {
        let mut start = 0;
        for force in &self.forces {
            let Some(force) = force.capabilities().switches else { continue };
            let own = start..start + force.switches();
            start = own.end;
            if is_wanted(own.clone()) {
                force.switch_values(t, u, v, &mut values[own]);
            }
        }
    }

    /// Whether switches and [`passage`](Self::passage) are to be asked after each step.
    pub(crate) fn can_be_passed(&self) -> bool {
        self.forces.iter().any(|force| {
            let Capabilities { switches, contact, .. } = force.capabilities();
            switches.is_some() || contact.is_some()
        })
    }

    /// A time (s) within a step at which a force acts that is not seen at the ends of the step, if any.
    pub(crate) fn passage(
        &self,
        step: &Step,
        tolerance: f64,
        mut clearances: &mut [f64],
    ) -> Option<f64> {
        let mut first: Option<f64> = None;
        for force in &self.forces {
            let (own, rest) = clearances.split_at_mut(switches(force));
            clearances = rest;
            let contact = force.capabilities().contact;
            if let Some(t) = contact.and_then(|contact| contact.passage(step, tolerance, own)) {
                first = Some(first.map_or(t, |first| first.min(t)));
            }
        }
        first
    }

    /// Holds each of the switches on or off, or lets all of them follow their values again.
    pub(crate) fn hold_switches(&self, on: Option<&[bool]>) {
        let mut start = 0;
        for force in &self.forces {
            let Some(force) = force.capabilities().switches else { continue };
            let end = start + force.switches();
            force.hold_switches(on.map(|on| &on[start..end]));
            start = end;
        }
    }

    /// For each force, what the body rubs against, and [whether it
    /// slides](crate::elements::force::Switches::slides) there.
    pub(crate) fn slides(&self) -> impl Iterator<Item = Option<(&str, Option<bool>)>> {
        self.forces.iter().map(|force| force.capabilities().switches?.slides())
    }

    /// Largest |A^T u - b| (m).
    pub(crate) fn drift(&self, t: f64, u: &[f64]) -> f64 {
        let drift = |row: &ConstraintRow| (row.apply(u) - row.prescribed(t).displacement).abs();
        self.rows.iter().map(drift).fold(self.all_edges.drift(u), f64::max)
    }

    /// Kinetic and potential energies of a state; dissipated and supplied are left at 0. Without `internal` unknowns
    /// Maxwell branches have relaxed, and there is no gas that flows.
    pub(crate) fn energy(&self, t: f64, u: &[f64], v: &[f64], internal: &[f64]) -> Energy {
        let Matrices { inertia, stiffness, linear_by_cells, dimension, branches, .. } =
            &*self.matrices;
        let mut energy = Energy {
            kinetic: 0.5 * inertia.quadratic_form(*dimension, v),
            strain: match linear_by_cells {
                Some(cells) => cells.energy(u),
                None => stiffness.as_ref().map_or(0.0, |k| 0.5 * k.quadratic_form(u)),
            },
            ..Energy::default()
        };
        let (strains, amounts) = self.layout.split(internal);
        self.set_lagging(t, internal);
        if let (Some(branches), [_, ..]) = (branches, strains) {
            energy.strain += branches.energy(u, strains);
        }
        if let (Some(flow), [_, ..]) = (flow_of(&self.flow), amounts) {
            energy.springs += flow.potential_of(u, amounts);
            energy.kinetic += flow.kinetic_of(amounts);
        }
        let sampled = self.reduction.as_ref().map(|reduction| &reduction.forces);
        for force in sampled.unwrap_or(&self.forces) {
            let potential = force.potential(t, u);
            match force.reservoir() {
                Reservoir::Strain => energy.strain += potential,
                Reservoir::Gravity => energy.gravity += potential,
                Reservoir::Contact => energy.contact += potential,
                Reservoir::Springs => energy.springs += potential,
                Reservoir::None => {}
            }
        }
        energy
    }

    /// Evaluates forces, accelerations and multipliers. Without `internal` unknowns Maxwell branches have relaxed, and
    /// there is no gas that flows.
    fn evaluate(&mut self, t: f64, u: &[f64], v: &[f64], internal: &[f64]) -> Result<(), Failure> {
        self.evaluate_forces(t, u, v, internal)?;
        self.evaluate_rows(t, u, v)?;
        self.turn_inertia(true);
        let Evaluation { total, demands, acceleration, multipliers, .. } = &mut self.at;
        self.inertia.solve(&self.rows, total, demands, acceleration, multipliers);
        let Matrices { inertia, dimension, .. } = &*self.matrices;
        nodal_multipliers(&self.rows, multipliers, |dof| {
            inertia.row_product(*dimension, dof, acceleration) - total[dof]
        });
        if let Some(solver) = &self.inertia.edges {
            self.edges.multipliers.copy_from_slice(&solver.multipliers);
            self.edges.accelerate(&self.at.acceleration);
        }
        Ok(())
    }

    fn evaluate_forces(
        &mut self,
        t: f64,
        u: &[f64],
        v: &[f64],
        internal: &[f64],
    ) -> Result<(), Failure> {
        self.set_lagging(t, internal);
        self.collect_forces(t, u, v)?;
        self.add_branch_forces(u, internal);
        self.add_flow_forces(t, u, self.layout.split(internal).1)?;
        self.at.nodal.add_up(&mut self.at.total);
        Ok(())
    }

    /// Adds the forces of Maxwell branches, and sets the rates of their strains.
    fn add_branch_forces(&mut self, u: &[f64], internal: &[f64]) {
        let (strains, _) = self.layout.split(internal);
        let Evaluation { nodal, relaxing, relaxed, .. } = &mut self.at;
        if let (Some(branches), [_, ..]) = (&self.matrices.branches, strains) {
            *relaxed = branches.add_forces(u, strains, &mut nodal.conservative, relaxing);
        }
    }

    fn collect_forces(&mut self, t: f64, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        self.at.nodal.clear();
        self.add_forces_of_matrices(u, v)?;
        self.add_forces_where(|_| true, t, u, v)
    }

    /// Adds -K u and -B v.
    fn add_forces_of_matrices(&mut self, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        let nodal = &mut self.at.nodal;
        let matrices = &*self.matrices;
        match (&matrices.linear_by_cells, &matrices.stiffness) {
            (Some(cells), _) => cells.add_forces(u, v, nodal)?,
            (None, Some(k)) => k.add_product(-1.0, u, &mut nodal.conservative),
            (None, None) => {}
        }
        match (&matrices.damping, &matrices.mass_damping) {
            (Some(b), _) if matrices.damps_by_matrix => {
                b.add_product(-1.0, v, &mut nodal.dissipative)
            }
            (_, Some(m)) => m.add_product(matrices.dimension, -1.0, v, &mut nodal.dissipative),
            (_, None) => {}
        }
        Ok(())
    }

    /// Adds the forces that have no constant matrix, if they are `among` those that are asked for.
    fn add_forces_where(
        &mut self,
        among: impl Fn(&dyn Force) -> bool,
        t: f64,
        u: &[f64],
        v: &[f64],
    ) -> Result<(), Failure> {
        for force in self.forces.iter().filter(|force| among(&***force)) {
            let added = force.add_forces(t, u, v, &mut self.at.nodal);
            if let Err(Failure::Recoverable(reason)) = &added {
                self.refusal.clone_from(reason);
            }
            added?;
        }
        Ok(())
    }

    fn evaluate_rows(&mut self, t: f64, u: &[f64], v: &[f64]) -> Result<(), Failure> {
        let alpha = self.alpha;
        for (k, row) in self.rows.iter().enumerate() {
            let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
            let (position, rate) = (row.apply(u), row.apply(v));
            if !(displacement + velocity + acceleration).is_finite() {
                return Err(self.not_finite(row, t));
            }
            self.at.rates[k] = rate;
            self.at.demands[k] = acceleration
                - 2.0 * alpha * (rate - velocity)
                - alpha * alpha * (position - displacement);
        }
        self.edges.move_to(alpha, u, v);
        Ok(())
    }

    /// Power dissipated and power supplied (W) at the last evaluation.
    fn powers(&self, v: &[f64], multipliers: &[f64]) -> (f64, f64) {
        let (dissipated, applied) = self.at.nodal.powers(v);
        let supplied = applied + dot(multipliers, &self.at.rates);
        (dissipated + self.at.relaxed, supplied + self.at.brought)
    }

    /// Number of unknowns of the ODE form.
    pub(crate) fn unknowns(&self) -> usize {
        self.layout.unknowns()
    }

    /// Number of internal unknowns: strains of Maxwell branches, and behind them amounts of gas and states of actuators that lag.
    pub(crate) fn internal(&self) -> usize {
        self.layout.internal().len()
    }

    /// Absolute tolerances of the amounts and flows, where those of strains (1) and velocities (m/s) are these.
    pub(crate) fn flow_tolerances(&self, strain: f64, velocity: f64) -> Vec<f64> {
        flow_of(&self.flow).map_or_else(Vec::new, |flow| flow.tolerances(strain, velocity))
    }

    /// The amounts of gas (kg) the states of actuators that lag and the flows of pipes (m^3/s) at the start of the scene; none without any.
    pub(crate) fn amounts(&self) -> &[f64] {
        flow_of(&self.flow).map_or(&[], |flow| flow.start())
    }

    /// The internal unknowns of a start: strains with which Maxwell branches are free of stress at the displacements
    /// `u`, and the first amounts of gas.
    pub(crate) fn relaxed(&self, u: &[f64]) -> Vec<f64> {
        let mut internal = vec![0.0; self.at.relaxing.len()];
        if let Some(branches) = &self.matrices.branches {
            branches.relax(u, &mut internal);
        }
        internal.extend(self.amounts());
        internal
    }

    /// Largest rate (1/s) at which Maxwell branches relax; 0 without any.
    pub(crate) fn relaxation_rate(&self) -> f64 {
        self.matrices.branches.as_ref().map_or(0.0, Branches::fastest)
    }

    /// The longest time (s) that the viscosity of a soft material is over its modulus; infinite without soft materials.
    pub(crate) fn retardation_time(&self) -> f64 {
        self.matrices.retardation_time
    }

    fn not_finite(&self, row: &ConstraintRow, t: f64) -> Failure {
        let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
        let label = row.label(self.matrices.dimension);
        Failure::Fatal(
            format!(
                "the path of {label} gives b = {displacement}, b' = {velocity}, \
                 b'' = {acceleration} at t = {t} s: it must give finite numbers"
            )
            .into(),
        )
    }
}

/// The forces that only keep rigid pieces in their shape, that of gas that flows, and all others.
fn parted(forces: Forces) -> (Forces, Option<Arc<dyn Force>>, Forces) {
    let (of_rigid, others): (Forces, Forces) =
        forces.into_iter().partition(|force| force.capabilities().keeps_rigid);
    let (flows, others): (Forces, Forces) =
        others.into_iter().partition(|force| force.capabilities().flow.is_some());
    (of_rigid, flows.into_iter().next(), others)
}

/// Number of switches of a force.
fn switches(force: &Arc<dyn Force>) -> usize {
    force.capabilities().switches.map_or(0, |force| force.switches())
}

/// Flow of a force, if it has one.
fn flow_of(force: &Option<Arc<dyn Force>>) -> Option<&dyn Flow> {
    force.as_ref().and_then(|force| force.capabilities().flow)
}

/// Whether the Newton matrix depends on more than M, K and B: on the state, or on the step in another way.
fn follows(matrices: &Matrices, forces: &Forces) -> bool {
    matrices.branches.is_some()
        || matrices.rigid.is_some()
        || forces.iter().any(|force| force.is_nonlinear())
}
