//! The equations of a phase along the shapes of a reduced model (`scene/reduced_model.rs`): lifting of its unknowns to
//! displacements of all nodes, projection of forces onto its shapes, and the small matrices of Newton's method.
//!
//! With Psi = [Phi E], z = (q, b - b_0) and the forces f, the equations are
//!
//! ```text
//! q'' = Phi^T f(t, u_0 + Psi z, Psi z') - Phi^T M E b''
//! ```
//!
//! Forces of constant matrices and steady ones are projected once, and some others are [`GeneralizedForce`]s of z. Each other
//! force depends and acts on some nodes only, the active ones: displacements of no others are computed for it.
//!
//! Exact along the shapes are, beside these, forces of St. Venant-Kirchhoff's law
//! (`elements/body/strain_modes.rs`), with exact tangents and objective viscosity for N^2 multiplications, N
//! = 1 + s + s (s + 1)/2, used where that is at most an eighth of the work of the loop over all cells (a
//! sample takes about as much and has an error), and of chambers, whose area is a quadratic and whose volume
//! a cubic function of z (`scene/forces/chamber/generalized.rs`: derivatives by differences, exact for
//! polynomials). Other elastic forces give a sample of cells with weights (`elements/body/sample.rs`), which
//! has a potential: the energy balance checks a reduced run as any other. All others name the nodes on which they
//! depend (`Force::nodes`); a force that does not makes all nodes active, which costs time, not accuracy.
//! Cells that grow are active, all of them. The Newton matrix is dense, I + gamma D + gamma^2 K along the
//! shapes.
//!
//! Shapes of a body that nothing holds contain all linear displacements, among them all rotations, and in the
//! plane each shape rotated by a quarter turn: shapes at any angle are sums of these, and no moving frame is
//! needed, which would make M depend on q. In space that would be nine shapes for each one, so only the
//! linear ones are added.

mod evaluation;
mod newton;

use std::collections::BTreeSet;
use std::sync::Arc;

use super::branches::ReducedBranches;
use super::factors::{Factors, Tangents};
use super::flow::ReducedFlow;
use super::shapes::Shapes;
use crate::base::input::InputError;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::largest;
use crate::dynamics::matrices::Matrices;
use crate::dynamics::system::Differences;
use crate::elements::body::Body;
use crate::elements::force::{Capabilities, Force, Forces, GeneralizedForce, NodalForces};
use crate::scene::constraint::{ConstraintRow, Prescribed};
use crate::scene::reduced_model::{ReducedModel, ReducedPhase};

/// The equations of a phase, projected onto the shapes of a reduced model.
pub(super) struct Projection {
    pub(super) model: Arc<ReducedModel>,
    /// Number of the phase in the model.
    phase: usize,
    pub(super) shapes: Shapes,
    /// The rows that move, with b where the equations begin.
    moved: Vec<(usize, f64)>,
    /// u_0 (m), and whether a motion has begun there.
    origin: Vec<f64>,
    pub(super) has_begun: bool,
    /// All forces, with a sample in place of those of all cells.
    pub(super) forces: Forces,
    /// Those of them that are functions of z, those of cells apart from others, and those that act on nodes: all but the steady
    /// ones.
    generalized: [Vec<Box<dyn GeneralizedForce>>; 2],
    acting: Forces,
    /// Those whose strains are unknowns, and that whose amounts are, if there are any.
    pub(super) branches: Option<ReducedBranches>,
    flow: Option<ReducedFlow>,
    pattern: Arc<NodePattern>,
    constant: Constant,
    at: LastEvaluation,
    pub(super) tangents: Tangents,
    factors: Factors,
}

/// Constant terms of the equations, along Psi.
struct Constant {
    /// M, K and B, each row by row.
    inertia: Vec<f64>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// -Psi^T K u_0, and the steady forces: those with a potential, and those from outside.
    rest: Vec<f64>,
    steady: [Vec<f64>; 2],
}

/// The last state that was evaluated, and the forces there.
struct LastEvaluation {
    /// z, z' and b''.
    z: [Vec<f64>; 2],
    pushed: Vec<f64>,
    /// u and v at the active degrees of freedom; elsewhere u_0 and 0.
    u: Vec<f64>,
    v: Vec<f64>,
    nodal: NodalForces,
    generalized: NodalForces,
    /// Psi^T f, and the parts of it that dissipate and supply.
    force: Vec<f64>,
    dissipative: Vec<f64>,
    applied: Vec<f64>,
    /// q''
    acceleration: Vec<f64>,
    /// Power (W) of obstacles, dissipated and supplied.
    carried: [f64; 2],
    /// Forces (N) that move the constraints.
    reactions: Vec<f64>,
}

/// Part by which Phi^T M Phi may differ from the unit matrix: round-off.
const ORTHONORMAL: f64 = 1e-6;

/// Part of a shape that a constraint may see: round-off.
const HELD: f64 = 1e-8;

impl Projection {
    /// The phase `name` by a `model`, under `forces`, that of amounts among them, and `rows`.
    pub(super) fn new(
        body: &Body,
        matrices: &Matrices,
        forces: &Forces,
        rows: &[ConstraintRow],
        model: &Arc<ReducedModel>,
        name: &str,
    ) -> Result<Self, InputError> {
        let known = model.phases.iter().position(|phase| phase.name == name);
        let Some(phase) = known else {
            let value = format!("without a phase \"{name}\"");
            return Err(InputError::new("reduced model", value, "reduce this scene"));
        };
        let moved = moved(&model.phases[phase], rows, name)?;
        let (dofs, dimension) = (matrices.dofs(), matrices.dimension);
        let mut shapes = Shapes::new(&model.phases[phase]);
        shapes.weigh(|x, y| matrices.add_momentum(1.0, x, y));
        let s = shapes.count();

        // couplings of the forces
        let mut seen = BTreeSet::new();
        let mut pairs = body.cell_pairs(model.cells.keys().copied());
        let mut is_anywhere = false;
        for force in on_nodes(forces, s) {
            pairs.extend(force.couplings());
            match force.nodes() {
                Some(nodes) => seen.extend(nodes),
                None => is_anywhere = true,
            }
        }
        if is_anywhere {
            seen.extend(0..matrices.pattern().nodes());
        }
        for &node in &seen {
            let neighbours = matrices.pattern().row(node).map(|(_, other)| other);
            pairs
                .extend(neighbours.filter(|other| seen.contains(other)).map(|other| [node, other]));
        }
        let groups = pairs.iter().map(|pair| &pair[..]);
        let pattern = Arc::new(NodePattern::new(matrices.pattern().nodes(), groups));
        seen.extend(pairs.iter().flatten());
        let branches = ReducedBranches::new(matrices, s);
        if branches.as_ref().is_some_and(ReducedBranches::see_all) {
            seen.extend(0..matrices.pattern().nodes());
        }
        shapes.activate(seen.into_iter(), dimension);
        let product = |matrix: &dyn Fn(&[f64], &mut [f64])| shapes.products(matrix);
        let inertia = product(&|x, y| matrices.add_momentum(1.0, x, y));
        let off = |(at, mass): (usize, &f64)| {
            let (row, column) = (at / s, at % s);
            let exact = if row == column { 1.0 } else { 0.0 };
            if row.max(column) < shapes.free() { (mass - exact).abs() } else { 0.0 }
        };
        if inertia.iter().enumerate().map(off).any(|off| off > ORTHONORMAL) {
            let help = "it is of a body of another inertia: reduce this scene";
            return Err(InputError::new("reduced model", "with shapes of another mass", help));
        }
        let of_blocks = |matrix: &Option<Arc<BlockMatrix>>| match matrix {
            Some(matrix) => product(&|x, y| matrix.add_product(1.0, x, y)),
            None => vec![0.0; s * s],
        };
        let tangent = || BlockMatrix::zeros(&pattern, dimension);
        let mut projection = Self {
            phase,
            moved,
            origin: vec![0.0; dofs],
            has_begun: false,
            forces: Forces::new(),
            generalized: [Vec::new(), Vec::new()],
            acting: Forces::new(),
            branches,
            flow: None,
            constant: Constant {
                inertia,
                stiffness: of_blocks(&matrices.stiffness),
                damping: of_blocks(&matrices.damping),
                rest: vec![0.0; s],
                steady: [vec![0.0; s], vec![0.0; s]],
            },
            at: LastEvaluation {
                z: [vec![0.0; s], vec![0.0; s]],
                pushed: vec![0.0; s - shapes.free()],
                u: vec![0.0; dofs],
                v: vec![0.0; dofs],
                nodal: NodalForces::zeros(dofs),
                generalized: NodalForces::zeros(s),
                force: vec![0.0; s],
                dissipative: vec![0.0; s],
                applied: vec![0.0; s],
                acceleration: vec![0.0; shapes.free()],
                carried: [0.0; 2],
                reactions: vec![0.0; s - shapes.free()],
            },
            tangents: Tangents {
                nodal: [tangent(), tangent()],
                projected: [vec![0.0; s * s], vec![0.0; s * s]],
                differences: Differences::new(matrices.scales),
                is_set: false,
            },
            factors: Factors::new(shapes.free(), s),
            model: model.clone(),
            pattern,
            shapes,
        };
        projection.take(forces);
        Ok(projection)
    }

    /// Whether forces see only nodes that are active.
    pub(super) fn has_room(&self, forces: &Forces) -> bool {
        on_nodes(forces, self.shapes.count()).all(|force| {
            let couples = |[a, b]: [usize; 2]| self.pattern.find(a, b).is_some();
            let sees = match force.nodes() {
                Some(nodes) => nodes.iter().all(|&node| self.shapes.sees(node)),
                None => self.shapes.sees_all(),
            };
            sees && force.couplings().into_iter().all(couples)
        })
    }

    /// Continues with other forces, which it [has room](Self::has_room) for.
    pub(super) fn take(&mut self, forces: &Forces) {
        let (weights, count) = (&self.model.cells, self.shapes.count());
        let sample = |force: &Arc<dyn Force>| {
            let cells = force.capabilities().by_cells?;
            let is_whole = weights.is_empty() || is_exact_along(force, count);
            (!is_whole).then(|| cells.sample(weights, &self.pattern))
        };
        let (flows, others): (Vec<_>, Vec<_>) =
            forces.iter().partition(|force| force.capabilities().flow.is_some());
        self.forces =
            others.iter().map(|force| sample(force).unwrap_or_else(|| (*force).clone())).collect();
        self.flow = flows.first().map(|flow| ReducedFlow::new(flow, &self.shapes));
        let mut steady = NodalForces::zeros(self.origin.len());
        self.acting.clear();
        for force in &self.forces {
            if force.capabilities().is_steady {
                // it has no meaning nowhere
                force.add_forces(0.0, &self.origin, &self.origin, &mut steady).unwrap_or(());
            } else if !is_exact_along(force, count) {
                self.acting.push(force.clone());
            }
        }
        // cells are unchanged
        self.generalize(false);
        let parts = [&steady.conservative, &steady.applied];
        for (sum, force) in self.constant.steady.iter_mut().zip(parts) {
            sum.fill(0.0);
            self.shapes.add_projected(force, sum);
        }
        self.tangents.is_set = false;
    }

    /// Sets the forces that are functions of z, from u_0 on: those of cells, or all others.
    fn generalize(&mut self, are_by_cells: bool) {
        let (shapes, origin) = (self.shapes.all(), &self.origin);
        let generalized = |force: &Arc<dyn Force>| {
            let Capabilities { by_cells, along_shapes, .. } = force.capabilities();
            let along = along_shapes.filter(|_| by_cells.is_some() == are_by_cells)?;
            along.generalized(origin, &shapes)
        };
        self.generalized[usize::from(are_by_cells)] =
            self.forces.iter().filter_map(generalized).collect();
    }

    /// Marks the tangents as out of date.
    pub(super) fn forget_tangents(&mut self) {
        self.tangents.is_set = false;
    }

    /// Begins at (u, v, internal strains), which becomes u_0, and returns q' of it and the unknowns of branches; q is 0.
    pub(super) fn begin(
        &mut self,
        matrices: &Matrices,
        rows: &[ConstraintRow],
        t: f64,
        [u, v, strains]: [&[f64]; 3],
    ) -> [Vec<f64>; 2] {
        self.has_begun = true;
        self.origin.copy_from_slice(u);
        self.at.u.copy_from_slice(u);
        self.at.v.fill(0.0);
        for (row, start) in &mut self.moved {
            *start = rows[*row].apply(u);
        }
        let rest = &mut self.constant.rest;
        rest.fill(0.0);
        if let Some(stiffness) = &matrices.stiffness {
            let mut force = vec![0.0; u.len()];
            stiffness.add_product(-1.0, u, &mut force);
            self.shapes.add_projected(&force, rest);
        }
        self.generalize(true);
        self.generalize(false);
        self.tangents.is_set = false;
        let [_, p] = self.coordinates(rows, t, [u, v]);
        let begun = self.branches.as_mut().map(|own| own.begin(u, strains, &self.shapes));
        [p, begun.unwrap_or_default()]
    }

    /// q and q' of a state (u, v) at time t.
    pub(super) fn coordinates(
        &self,
        rows: &[ConstraintRow],
        t: f64,
        [u, v]: [&[f64]; 2],
    ) -> [Vec<f64>; 2] {
        let mut own =
            [u.iter().zip(&self.origin).map(|(u, start)| u - start).collect(), v.to_vec()];
        for (&(row, start), column) in self.moved.iter().zip(self.shapes.free()..) {
            let Prescribed { displacement, velocity, .. } = rows[row].prescribed(t);
            self.shapes.add_column(column, start - displacement, &mut own[0]);
            self.shapes.add_column(column, -velocity, &mut own[1]);
        }
        own.map(|x| self.shapes.coordinates(&x))
    }

    /// Writes u and v of all nodes, and all internal unknowns, for (q, q', internal unknowns) at time t.
    pub(super) fn lift(
        &mut self,
        rows: &[ConstraintRow],
        t: f64,
        [q, p, internal]: [&[f64]; 3],
        [u, v, all]: [&mut [f64]; 3],
    ) {
        let (of_branches, amounts) = internal.split_at(self.branch_unknowns());
        let (strains, own_amounts) = all.split_at_mut(all.len() - amounts.len());
        own_amounts.copy_from_slice(amounts);
        if let Some(branches) = &mut self.branches {
            branches.lift(of_branches, strains);
        }
        self.place(rows, t, [q, p]);
        let [z, rates] = &self.at.z;
        u.copy_from_slice(&self.origin);
        v.fill(0.0);
        self.shapes.add_lifted(z, u);
        self.shapes.add_lifted(rates, v);
    }

    /// Sets z, z' and b''.
    fn place(&mut self, rows: &[ConstraintRow], t: f64, [q, p]: [&[f64]; 2]) {
        let [z, rates] = &mut self.at.z;
        let free = q.len();
        z[..free].copy_from_slice(q);
        rates[..free].copy_from_slice(p);
        for (k, &(row, start)) in self.moved.iter().enumerate() {
            let Prescribed { displacement, velocity, acceleration } = rows[row].prescribed(t);
            (z[free + k], rates[free + k]) = (displacement - start, velocity);
            self.at.pushed[k] = acceleration;
        }
    }

    /// Number of unknowns of branches, which come first among the internal ones.
    fn branch_unknowns(&self) -> usize {
        self.branches.as_ref().map_or(0, ReducedBranches::unknowns)
    }

    /// Extrapolation: distance of the displacements `u` (m) outside the training range, relative to the largest modal
    /// range.
    pub(super) fn outside(&self, u: &[f64]) -> f64 {
        let range = &self.model.phases[self.phase].range;
        let all = self.model.phases.iter().flat_map(|phase| &phase.range);
        let widest = all.map(|[low, high]| high - low).fold(0.0, f64::max);
        let beyond = |(x, [low, high]): (&f64, &[f64; 2])| (low - x).max(x - high).max(0.0);
        let most = self.shapes.coordinates(u).iter().zip(range).map(beyond).fold(0.0, f64::max);
        if widest > 0.0 { most / widest } else { 0.0 }
    }
}

/// Whether a force has a generalized form along so many shapes that is exact, and less work.
fn is_exact_along(force: &Arc<dyn Force>, shapes: usize) -> bool {
    force.capabilities().along_shapes.is_some_and(|along| along.is_exact_along(shapes))
}

/// The forces on nodes other than those of sampled cells: neither steady nor functions of the coordinates of so many shapes.
fn on_nodes(forces: &Forces, shapes: usize) -> impl Iterator<Item = &Arc<dyn Force>> {
    let are_on_nodes = move |force: &&Arc<dyn Force>| {
        let Capabilities { is_steady, by_cells, .. } = force.capabilities();
        !is_steady && !is_exact_along(force, shapes) && by_cells.is_none()
    };
    forces.iter().filter(are_on_nodes)
}

/// The rows that move.
///
/// # Errors
/// Constraints other than those that the model was learned with.
fn moved(
    phase: &ReducedPhase,
    rows: &[ConstraintRow],
    name: &str,
) -> Result<Vec<(usize, f64)>, InputError> {
    let moved: Vec<usize> = (0..rows.len()).filter(|&row| rows[row].moves()).collect();
    let is_held = |row: &ConstraintRow| {
        phase.shapes.iter().all(|shape| {
            row.apply(shape).abs() <= HELD * largest(shape) * (row.terms.len() as f64).sqrt()
        })
    };
    let is_same = rows.len() == phase.rows && moved.len() == phase.lifts.len();
    let follows = |(row, lift): (&usize, &Vec<f64>)| (rows[*row].apply(lift) - 1.0).abs() < 1e-6;
    if is_same && rows.iter().all(is_held) && moved.iter().zip(&phase.lifts).all(follows) {
        return Ok(moved.into_iter().map(|row| (row, 0.0)).collect());
    }
    Err(InputError::new(
        format!("constraints of phase \"{name}\""),
        format!("{} rows, {} of them in motion", rows.len(), moved.len()),
        format!(
            "the reduced model has learned others ({} rows, {} in motion): reduce the scene with these, or run it \
             unreduced",
            phase.rows,
            phase.lifts.len()
        ),
    ))
}
