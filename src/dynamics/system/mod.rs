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
//! dot products, nothing depends on them, and the error control excludes them; they make the energy balance
//! as accurate as the integration itself.
//!
//! `dynamics/state.rs` owns the order of the unknowns, y = (u, v, strains, amounts, E_d, E_s), behind which differential-algebraic
//! forms have multipliers. Forces add up in three vectors (conservative, dissipative, applied), so that both powers are one dot
//! product each and no force has an account of its own. Quadrature after the run would cost more evaluations
//! of forces than the integration. Tolerances of the energies are loose (energies at strains of order 1) and
//! not infinite: unknowns that Newton's iteration does not control grow without bound, as BDF extrapolates
//! their errors. To Rosenbrock methods and the internal Runge-Kutta method they are integrals.
//!
//! A row of the constraints that continues into the next phase starts from its prescribed value in the phase before, so
//! that the error of the stabilization is not passed on. Multipliers follow from the constrained rows of M
//! a - f; in the ODE form they are output.

#[cfg(feature = "gradient")]
mod adjoint;
mod at_rest;
mod dae;
#[cfg(test)]
mod dae_jacobian;
mod differences;
mod ends;
mod energy;
mod evaluation;
mod expected;
mod form;
mod gas;
mod guide;
mod mobility;
mod newton;
mod newton_matrix;
mod ode;
mod phase_system;
mod rates;
mod residual;
pub(crate) mod rigid;
mod scene;
mod second_order;
mod settled;
mod shape;
mod spectrum;
mod switches;
#[cfg(test)]
mod tests;

use std::sync::Arc;

#[cfg(feature = "gradient")]
pub(crate) use at_rest::DUAL_ERROR;
pub(crate) use at_rest::{AtRest, ForceBalance};
pub(crate) use dae::{DaeForm, Index};
pub(crate) use differences::Differences;
use ends::Ends;
pub use energy::Energy;
pub(crate) use expected::Vibrations;
pub(crate) use form::Form;
use newton_matrix::NewtonMatrix;
pub(crate) use phase_system::PhaseSystem;
pub(crate) use residual::{MissingDisplacement, ResidualSnapshot};
pub(crate) use second_order::SecondOrderForm;
pub use spectrum::Spectrum;

use crate::base::input::InputError;
use crate::dynamics::linear::{ConstrainedSolver, Coupling, EXACT, Edges, FlowMatrix};
use crate::dynamics::matrices::Matrices;
use crate::dynamics::state::Layout;
use crate::elements::body::Branches;
use crate::elements::force::{Flow, Force, Forces, NodalForces};
use crate::scene::constraint::ConstraintRow;

/// Equations of one phase, with everything that evaluating and solving them needs.
pub(crate) struct System {
    /// The matrices of the scene, and those with entries for pairs that are near now.
    base: Arc<Matrices>,
    matrices: Arc<Matrices>,
    forces: Forces,
    /// Forces that keep rigid pieces in shape, as their edges do here.
    of_rigid: Forces,
    /// The force whose amounts are unknowns, if there is one.
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
    /// Reason of the last undefined force.
    refusal: String,
    /// Pressures of liquids at the ends of the last step.
    ends: Ends,
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
    /// Rates of the amounts of gas (kg/s) and of the flows of pipes, a workspace of the same size, and the power (W) supplied with them.
    flowing: [Vec<f64>; 2],
    brought: f64,
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
        let mut inertia = ConstrainedSolver::new(&matrices, &rows, &edges, coupling);
        let values = &matrices.inertia.values;
        let mut begun = inertia.begin(EXACT, |source| values[source.entry()]);
        if let (Some(solver), Ok(())) = (&mut inertia.edges, &begun) {
            let is_kept = solver.independent(&edges);
            if is_kept.contains(&false) {
                edges = edges.retained(&is_kept);
                inertia = ConstrainedSolver::new(&matrices, &rows, &edges, coupling);
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
        let mut newton = NewtonMatrix::new(&matrices, &rows, &edges, follows(&matrices, &forces));
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
        let rooms = flow_of(&flow).map_or(0, |flow| flow.reservoirs());
        newton.flow = (rooms > 0).then(|| FlowMatrix::new([rooms, amounts], dofs));
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

    /// Replaces the forces, if the Newton matrix has entries for their tangents; all else is unchanged. Returns
    /// whether it has.
    pub(crate) fn change_forces(&mut self, forces: Forces) -> bool {
        if follows(&self.matrices, &forces) != self.newton.follows {
            return false;
        }
        (self.of_rigid, self.flow, self.forces) = parted(forces);
        self.forget_tangents();
        true
    }

    /// All forces but those that keep rigid pieces in their shape.
    pub(crate) fn all_forces(&self) -> Forces {
        self.forces.iter().chain(&self.flow).cloned().collect()
    }

    /// Marks the tangents as out of date.
    pub(crate) fn forget_tangents(&mut self) {
        self.newton.is_set = false;
    }

    /// The matrices, with entries for pairs that are near now.
    pub(crate) fn matrices(&self) -> &Matrices {
        &self.matrices
    }

    /// The constraints, row by row.
    pub(crate) fn rows(&self) -> &[ConstraintRow] {
        &self.rows
    }

    /// Adds `factor` A m, m being multipliers of the rows.
    pub(crate) fn add_rows(&self, factor: f64, of_rows: &[f64], out: &mut [f64]) {
        for (row, m) in self.rows.iter().zip(of_rows) {
            row.terms.iter().for_each(|&(dof, c)| out[dof] += factor * c * m);
        }
    }

    /// Starts the counts below from 0.
    pub(crate) fn forget_counts(&mut self) {
        self.newton.forget_counts();
    }

    /// Number of evaluations of the tangents so far; 0 where they are constant.
    pub(crate) fn tangent_evaluations(&self) -> usize {
        self.newton.tangent_evaluations
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
        self.newton.differences.evaluations()
    }

    /// The constraint forces lambda (N) at the last [evaluation](Self::evaluate), row by row.
    pub(crate) fn computed_multipliers(&self) -> &[f64] {
        &self.at.multipliers
    }

    /// The accelerations (m/s^2) there.
    pub(crate) fn computed_accelerations(&self) -> &[f64] {
        &self.at.acceleration
    }

    /// The velocities nearest to `v`, in the sense of kinetic energy, that the constraints allow
    /// at time `t` and the displacements `u`.
    pub(crate) fn project(&mut self, t: f64, u: &[f64], v: &mut [f64]) {
        self.edges.move_to(self.alpha, u, v);
        self.turn_inertia(false);
        let momentum = self.matrices.momentum(v);
        let demands: Vec<f64> = self.rows.iter().map(|row| row.prescribed(t).velocity).collect();
        self.inertia.solve(&self.rows, &momentum, &demands, v, &mut vec![0.0; demands.len()]);
    }

    /// Reason of the last undefined force at a trial point; empty if there was none.
    pub(crate) fn refusal(&self) -> &str {
        &self.refusal
    }

    /// Largest |A^T u - b| (m).
    pub(crate) fn drift(&self, t: f64, u: &[f64]) -> f64 {
        let drift = |row: &ConstraintRow| (row.apply(u) - row.prescribed(t).displacement).abs();
        self.rows.iter().map(drift).fold(self.all_edges.drift(u), f64::max)
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
}

/// The forces that only keep rigid pieces in their shape, that of gas that flows, and all others.
fn parted(forces: Forces) -> (Forces, Option<Arc<dyn Force>>, Forces) {
    let (of_rigid, others): (Forces, Forces) =
        forces.into_iter().partition(|force| force.capabilities().keeps_rigid);
    let (flows, others): (Forces, Forces) =
        others.into_iter().partition(|force| force.capabilities().flow.is_some());
    (of_rigid, flows.into_iter().next(), others)
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
