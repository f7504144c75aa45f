//! Tangents of forces that do not compute them, by finite differences, many columns at a time.
//!
//! A column of -df/du is the change of the force when one displacement is shifted. Nodes that never act on the
//! same node are shifted together: they have one colour, and dimension times colours evaluations give the whole
//! matrix (A. R. Curtis, M. J. D. Powell, J. K. Reid, J. Inst. Maths Applics 13 (1974) 117-119). A force
//! that acts on each node by itself has one colour; one that couples the nodes of cells has 9 on triangles and
//! rectangles, 27 on hexahedra.
//!
//! Before that, all components are shifted at once, each by a different amount. If that does not change the
//! force, the tangent is 0 (by v, for most forces). Otherwise the columns have to explain the change: first
//! those of single nodes and of the pairs that [`Force::couplings`] names, which are the fewest, then those
//! of all pairs of the Newton matrix. So no force is treated as simpler than it is, in any state.
//!
//! Differences are one-sided: each Newton iteration reduces the error by about the relative error of its
//! matrix, and anything below a hundredth is as good as exact. The shift is sqrt(epsilon) times a hundredth
//! of the body's size, or of the speed of waves: 1.5e-10 of these. Forces that change over a length l of 1e-4
//! of the size (a layer at a contact) are then off by h/l = 1e-6; round-off of positions by epsilon size/h =
//! 1e-6, too. Two-sided differences would cost twice as much for nothing; the other side is for forces that
//! are undefined on the first. A column that is undefined on both is left 0.

use std::sync::Arc;

use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::{largest, noise};
use crate::elements::force::{Force, NodalForces, Tangents};

/// Tangents by differences, for the forces of a phase that need them.
pub(crate) struct Differences {
    /// Shifts of displacements (m) and of velocities (m/s).
    shifts: [f64; 2],
    forces: Vec<Own>,
    /// None before the first use.
    room: Option<Room>,
}

/// One of the forces.
struct Own {
    force: Arc<dyn Force>,
    named: Columns,
    /// With all pairs of the Newton matrix, if those named did not suffice.
    all: Option<Columns>,
    /// Whether these explain the differences that the named ones do not.
    is_wide: bool,
}

/// -df/du or -df/dv on some pattern, and the nodes by colours.
struct Columns {
    matrix: BlockMatrix,
    colours: Vec<Vec<usize>>,
}

struct Room {
    /// u and v, as they are shifted.
    state: [Vec<f64>; 2],
    nodal: NodalForces,
    /// The force where the tangents are wanted, and at the shifted state.
    force: Vec<f64>,
    shifted: Vec<f64>,
    /// The direction of a shift, component by component, and the slope of the force along it.
    direction: Vec<f64>,
    slope: Vec<f64>,
    /// The same for a shift of everything.
    noise: Vec<f64>,
    noise_slope: Vec<f64>,
    unexplained: Vec<f64>,
    evaluations: usize,
}

/// Part of the change of a force that columns may leave unexplained: more than the error of differences, less
/// than the effect of a coupling that matters.
const UNEXPLAINED: f64 = 1e-3;

impl Differences {
    /// For displacements and velocities of these `scales` (m, m/s).
    pub(crate) fn new(scales: [f64; 2]) -> Self {
        let shifts = scales.map(|scale| f64::EPSILON.sqrt() * scale);
        Self { shifts, forces: Vec::new(), room: None }
    }

    /// Adds the tangents of `force` at (t, u, v) to `stiffness` and `damping`: its own, or else differences.
    pub(crate) fn add_tangents(
        &mut self,
        force: &Arc<dyn Force>,
        t: f64,
        [u, v]: [&[f64]; 2],
        [stiffness, damping]: [&mut BlockMatrix; 2],
    ) {
        let is_done = force.add_tangents(t, u, v, stiffness, damping) == Tangents::Added;
        if is_done || !force.is_nonlinear() {
            return;
        }
        let Self { shifts, forces, room } = self;
        let known = forces.iter().position(|own| Arc::ptr_eq(&own.force, force));
        let known = known.unwrap_or_else(|| {
            forces.push(Own::new(force, stiffness));
            forces.len() - 1
        });
        let room = room.get_or_insert_with(|| Room::new(u.len()));
        if !room.begin(force, t, [u, v]) {
            return;
        }
        for (kind, (at, matrix)) in [(u, stiffness), (v, damping)].into_iter().enumerate() {
            let shift = Shift { force, t, kind, at, by: shifts[kind] };
            forces[known].add(&shift, room, matrix);
        }
    }

    /// Restarts the search for the columns of forces, on a matrix of another pattern.
    pub(crate) fn forget_patterns(&mut self) {
        self.forces.clear();
    }

    /// Evaluations of forces so far.
    pub(crate) fn evaluations(&self) -> usize {
        self.room.as_ref().map_or(0, |room| room.evaluations)
    }

    /// Starts the count from 0.
    pub(crate) fn forget_counts(&mut self) {
        self.room.iter_mut().for_each(|room| room.evaluations = 0);
    }
}

/// Perturbation for a finite difference: the force, and the size of the change of u or v.
struct Shift<'a> {
    force: &'a Arc<dyn Force>,
    t: f64,
    /// 0 for u, 1 for v.
    kind: usize,
    at: &'a [f64],
    by: f64,
}

impl Own {
    /// A force whose tangents are wanted in matrices like `matrix`.
    fn new(force: &Arc<dyn Force>, matrix: &BlockMatrix) -> Self {
        let pairs = force.couplings();
        let pattern =
            NodePattern::new(matrix.pattern().nodes(), pairs.iter().map(|pair| pair.as_slice()));
        let named = Columns::new(&Arc::new(pattern), matrix.dimension());
        Self { force: force.clone(), named, all: None, is_wide: false }
    }

    /// Adds its tangent to `matrix`.
    fn add(&mut self, shift: &Shift, room: &mut Room, matrix: &mut BlockMatrix) {
        room.direction.copy_from_slice(&room.noise);
        let is_known = room.change(shift);
        if is_known && room.slope.iter().all(|&slope| slope == 0.0) {
            return;
        }
        room.noise_slope.copy_from_slice(&room.slope);
        if !self.is_wide {
            let is_complete = self.named.fill(shift, room);
            if !is_known || !is_complete || room.is_explained(&self.named, shift) {
                return self.named.add_to(matrix);
            }
        }
        let new = || Columns::new(matrix.pattern(), matrix.dimension());
        let all = self.all.get_or_insert_with(new);
        all.fill(shift, room);
        // at a kink of the force no columns explain its change
        self.is_wide = self.is_wide || room.is_explained(all, shift);
        all.add_to(matrix);
    }
}

impl Columns {
    fn new(pattern: &Arc<NodePattern>, dimension: usize) -> Self {
        let nodes = pattern.nodes();
        let mut colour_of = vec![usize::MAX; nodes];
        let mut colours: Vec<Vec<usize>> = Vec::new();
        // for each colour, the last node that may not have it
        let mut refused: Vec<usize> = Vec::new();
        for node in 0..nodes {
            for (_, touched) in pattern.row(node) {
                for (_, other) in pattern.row(touched) {
                    if let Some(refused) = refused.get_mut(colour_of[other]) {
                        *refused = node;
                    }
                }
            }
            let free = refused.iter().position(|&refused| refused != node);
            let colour = free.unwrap_or(colours.len());
            if free.is_none() {
                refused.push(usize::MAX);
                colours.push(Vec::new());
            }
            colour_of[node] = colour;
            colours[colour].push(node);
        }
        Self { matrix: BlockMatrix::zeros(pattern, dimension), colours }
    }

    /// Fills the columns, undefined ones with 0; returns whether all are defined.
    fn fill(&mut self, shift: &Shift, room: &mut Room) -> bool {
        let Self { matrix, colours } = self;
        let (d, pattern) = (matrix.dimension(), matrix.pattern().clone());
        matrix.values.fill(0.0);
        let mut is_complete = true;
        for (nodes, axis) in colours.iter().flat_map(|nodes| (0..d).map(move |axis| (nodes, axis)))
        {
            room.direction.fill(0.0);
            nodes.iter().for_each(|node| room.direction[node * d + axis] = 1.0);
            if !room.change(shift) {
                is_complete = false;
                continue;
            }
            for (entry, row) in nodes.iter().flat_map(|&node| pattern.row(node)) {
                let block = &mut matrix.values[pattern.transposed(entry) * d * d..][..d * d];
                (0..d).for_each(|i| block[i * d + axis] = -room.slope[row * d + i]);
            }
        }
        is_complete
    }

    fn add_to(&self, matrix: &mut BlockMatrix) {
        let pattern = self.matrix.pattern();
        let size = self.matrix.dimension().pow(2);
        for row in 0..pattern.nodes() {
            for (entry, column) in pattern.row(row) {
                let Some(block) = matrix.block_mut(row, column) else { continue };
                let own = &self.matrix.values[entry * size..][..size];
                block.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        }
    }
}

impl Room {
    fn new(dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            state: [zeros(), zeros()],
            nodal: NodalForces::zeros(dofs),
            force: zeros(),
            shifted: zeros(),
            direction: zeros(),
            slope: zeros(),
            noise: noise(dofs, 0),
            noise_slope: zeros(),
            unexplained: zeros(),
            evaluations: 0,
        }
    }

    /// Evaluates `force` where its tangents are wanted; returns whether it is defined there.
    fn begin(&mut self, force: &Arc<dyn Force>, t: f64, at: [&[f64]; 2]) -> bool {
        self.state.iter_mut().zip(at).for_each(|(state, at)| state.copy_from_slice(at));
        let has_meaning = self.evaluate(force, t);
        std::mem::swap(&mut self.force, &mut self.shifted);
        has_meaning
    }

    fn evaluate(&mut self, force: &Arc<dyn Force>, t: f64) -> bool {
        self.evaluations += 1;
        self.nodal.clear();
        let [u, v] = &self.state;
        let evaluated = force.add_forces(t, u, v, &mut self.nodal);
        self.nodal.add_up(&mut self.shifted);
        evaluated.is_ok() && self.shifted.iter().all(|f| f.is_finite())
    }

    /// Writes the slope of the force along the direction; returns whether the force is defined on one side.
    fn change(&mut self, shift: &Shift) -> bool {
        let &Shift { force, t, kind, at, by } = shift;
        let mut has_meaning = false;
        for by in [by, -by] {
            let state = self.state[kind].iter_mut().zip(at).zip(&self.direction);
            state.for_each(|((x, at), part)| *x = at + by * part);
            has_meaning = self.evaluate(force, t);
            if has_meaning {
                let forces = self.shifted.iter().zip(&self.force);
                self.slope
                    .iter_mut()
                    .zip(forces)
                    .for_each(|(slope, (f, at))| *slope = (f - at) / by);
                break;
            }
        }
        self.state[kind].copy_from_slice(at);
        has_meaning
    }

    /// Whether `columns` explain how the force changes when everything is shifted.
    fn is_explained(&mut self, columns: &Columns, shift: &Shift) -> bool {
        self.unexplained.copy_from_slice(&self.noise_slope);
        columns.matrix.add_product(1.0, &self.noise, &mut self.unexplained);
        let round_off = 64.0 * f64::EPSILON * largest(&self.force) / shift.by;
        largest(&self.unexplained) <= UNEXPLAINED * largest(&self.noise_slope) + round_off
    }
}
