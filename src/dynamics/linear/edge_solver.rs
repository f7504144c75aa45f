//! Linear systems under the constraints of [edges](super::edges).
//!
//! The row G of an edge depends on the motion, so that it cannot be eliminated once for all steps. With Z = X^-1 E, E the
//! degrees of freedom of the frames, the multipliers are the solution of the small system
//!
//! ```text
//! (R Z G^T) multipliers = demands
//! ```
//!
//! piece by piece where pieces are not coupled through X, and with columns of Z that reach as far as X couples
//! (`edge_component.rs`). R is G itself with X = M and, with the Newton matrix of
//! a step of gamma, the derivative of the stabilized constraint,
//!
//! ```text
//! R = (1 + alpha gamma)^2 x + 2 gamma (1 + alpha gamma) x' + gamma^2 x''
//! ```
//!
//! Central differences ask for lengths at the end of a step instead, x.x = 2 halves with x = start + weight (x'' of
//! the step), which Newton's method finds piece by piece.
//!
//! Rows G rotate with the piece and are no part of the factorized matrix. Z takes 6 solves per piece for each
//! factor, 12 in space; the small matrix, 3 x 3 or 6 x 6 for each piece or for several that are coupled
//! through X, is rebuilt as pieces rotate. CVODE and ARKODE, which evaluate residuals again, take the edges
//! in R at the trial point: a matrix is kept for many steps, and iterations then converge as if the piece had
//! not turned. Rosenbrock methods, whose order rests on the Jacobian at the start of a step, take them there.
//! Forces of the multipliers rotate with the edges; their derivative is part of Kt.
//!
//! A dependent node may have drifted from its frame by round-off, on which no force acts, so that (I - gamma
//! J) x = r says x = r: a Newton step gives it its own residual (`stray`). Without that BDF, which
//! extrapolates, would let the round-off grow without bound.

use super::edge_component::{Arrival, Component, Coupled, Piece};
use super::edges::Edges;
use super::general_rows::GeneralRows;
use super::symmetric::Symmetric;

/// Solver of systems with X under the constraints of edges.
pub(crate) struct EdgeSolver {
    /// R and G of all edges, those that are implied last; the factor of x in R; whether they have been set since the last query.
    pub(super) rows: Vec<[f64; 3]>,
    pub(super) factor: f64,
    pub(super) columns: Vec<[f64; 3]>,
    pub(super) has_turned: bool,
    /// Empty where the systems are solved in [rigid motions](super::rigid_motions).
    components: Vec<Component>,
    /// Right-hand side of R x, and the multipliers that enforce it.
    pub(crate) demands: Vec<f64>,
    pub(crate) multipliers: Vec<f64>,
    /// Prescribed lengths instead, in the first half of a step of central differences.
    pub(crate) arrival: Arrival,
}

impl EdgeSolver {
    /// For edges in their first state, whose degrees of freedom are in these `components`.
    fn of(edges: &Edges, components: Vec<Component>) -> Self {
        let (count, all) = (edges.list.len(), edges.arms.len());
        Self {
            rows: vec![[0.0; 3]; all],
            columns: vec![[0.0; 3]; all],
            factor: 1.0,
            has_turned: false,
            components,
            demands: vec![0.0; count],
            multipliers: vec![0.0; count],
            arrival: Arrival {
                weight: None,
                starts: vec![[0.0; 3]; count],
                halves: vec![0.0; count],
                is_missed: false,
            },
        }
    }

    /// For systems that are solved in [rigid motions](super::rigid_motions).
    pub(super) fn without_responses(edges: &Edges) -> Self {
        Self::of(edges, Vec::new())
    }

    /// For edges between nodes whose degrees of freedom are at the given `position` among the free ones.
    pub(super) fn new(
        edges: &Edges,
        dimension: usize,
        position: impl Fn(usize) -> Option<usize>,
        coupled: Coupled<'_>,
    ) -> Self {
        // no component of a frame is fixed by itself: rows of rigid pieces are general ones
        let place = |node: usize| position(node * dimension).unwrap_or_default();
        let places: Vec<[usize; 2]> = edges.list.iter().map(|edge| edge.nodes.map(place)).collect();
        let components = Component::all(&places, dimension, coupled);
        Self::of(edges, components)
    }

    /// Finds Z for the current X; `z` is a workspace of one column.
    pub(super) fn respond(
        &mut self,
        z: &mut [f64],
        symmetric: &mut Symmetric,
        rows: &mut GeneralRows,
    ) {
        let most = self.components.iter().map(|component| component.frames.len()).max();
        // one column of each component at once, as these do not feel each other
        for column in 0..most.unwrap_or(0) {
            z.fill(0.0);
            let with_column = |component: &&mut Component| column < component.frames.len();
            for component in self.components.iter_mut().filter(with_column) {
                z[component.dofs[component.frames[column]]] = 1.0;
            }
            symmetric.solve(z);
            for component in self.components.iter_mut().filter(with_column) {
                component.inverse_diagonal[column] = z[component.dofs[component.frames[column]]];
            }
            rows.right.fill(0.0);
            rows.correct(z);
            for component in self.components.iter_mut().filter(with_column) {
                let Component { dofs, general, z: own, of_rows, .. } = component;
                let own = own.col_as_slice_mut(column).iter_mut();
                own.zip(&*dofs).for_each(|(own, &at)| *own = z[at]);
                let own = of_rows.col_as_slice_mut(column).iter_mut();
                own.zip(&*general).for_each(|(own, &row)| *own = rows.right[row]);
            }
        }
        self.components.iter_mut().for_each(Component::divide);
    }

    /// Asks for an arrival from where the edges are, instead of rates.
    pub(crate) fn aim(&mut self, edges: &Edges) {
        self.columns.copy_from_slice(&edges.arms);
        for component in &mut self.components {
            let mut pieces = std::mem::take(&mut component.pieces);
            for Piece { numbers, blocks, .. } in &mut pieces {
                let all = numbers
                    .iter()
                    .flat_map(|&row| numbers.iter().map(move |&column| (row, column)));
                blocks.iter_mut().zip(all).for_each(|(block, (row, column))| {
                    *block = component.block(row, column, &self.columns);
                });
            }
            component.pieces = pieces;
        }
    }

    /// Sets G, and R: G itself, or with the factors of x, x' and x'' in a `step`.
    pub(crate) fn turn(&mut self, edges: &Edges, step: Option<[f64; 3]>) {
        self.arrival.weight = None;
        self.columns.copy_from_slice(&edges.arms);
        match step {
            Some(factors) => edges.rows(factors, &mut self.rows),
            None => self.rows.copy_from_slice(&edges.arms),
        }
        self.factor = step.map_or(1.0, |factors| factors[0]);
        self.has_turned = true;
        for component in &mut self.components {
            let mut pieces = std::mem::take(&mut component.pieces);
            for piece in &mut pieces {
                for (i, &row) in piece.numbers.iter().enumerate() {
                    for (j, &column) in piece.numbers.iter().enumerate() {
                        piece.lu[(i, j)] = component.entry(row, column, &self.rows, &self.columns);
                    }
                }
                piece.factorize();
            }
            component.pieces = pieces;
        }
    }

    /// Which edges do not follow from the constraints of the general rows and the edges before them.
    pub(crate) fn independent(&mut self, edges: &Edges) -> Vec<bool> {
        self.columns.copy_from_slice(&edges.arms);
        let mut is_kept = vec![false; self.demands.len()];
        for component in &self.components {
            component.find_independent(&self.columns, &mut is_kept);
        }
        is_kept
    }

    /// Corrects the solution `x` = X^-1 f, and the multipliers `mu` of the general rows, the n-th of which has the `number` n, by the
    /// multipliers that the demands require.
    pub(crate) fn correct(
        &mut self,
        x: &mut [f64],
        number: impl Fn(usize) -> usize,
        mu: &mut [f64],
    ) {
        self.arrival.is_missed = false;
        let mut components = std::mem::take(&mut self.components);
        for component in &mut components {
            self.find_multipliers(component, x);
            let Component { pull, z, dofs, of_rows, general, .. } = component;
            for (column, pull) in pull.iter().enumerate().filter(|(_, pull)| **pull != 0.0) {
                let z = z.col_as_slice(column).iter();
                dofs.iter().zip(z).for_each(|(&at, z)| x[at] += pull * z);
            }
            for (row, &of_all) in general.iter().enumerate() {
                mu[number(of_all)] +=
                    pull.iter().enumerate().map(|(k, pull)| pull * of_rows[(row, k)]).sum::<f64>();
            }
        }
        self.components = components;
    }

    /// Finds the multipliers of a component, and G^T times them, for the solution `x` = X^-1 f.
    fn find_multipliers(&mut self, component: &mut Component, x: &[f64]) {
        let Self { rows, columns, demands, multipliers, arrival, .. } = self;
        let Component { dimension: d, dofs, columns: ends, rows: places, pull, pieces, .. } =
            component;
        pull.fill(0.0);
        for piece in pieces {
            match arrival.weight {
                None => {
                    let all = piece.numbers.iter().zip(&piece.edges);
                    for (right, (&number, &k)) in piece.right.iter_mut().zip(all) {
                        let ([a, b], r) = (places[number].map(|row| dofs[row]), &rows[k]);
                        let along: f64 = (0..*d).map(|i| r[i] * (x[a + i] - x[b + i])).sum();
                        *right = demands[k] - along;
                    }
                    piece.solve();
                }
                Some(weight) => {
                    for (&number, &k) in piece.numbers.iter().zip(&piece.edges) {
                        let [a, b] = places[number].map(|row| dofs[row]);
                        let start = arrival.starts[k].iter_mut().take(*d);
                        start.enumerate().for_each(|(i, s)| *s += weight * (x[a + i] - x[b + i]));
                    }
                    arrival.is_missed |= !piece.arrive(weight, arrival, columns);
                }
            }
            let all = piece.numbers.iter().zip(&piece.edges);
            for (multiplier, (&number, &k)) in piece.right.iter().zip(all) {
                multipliers[k] = *multiplier;
                let ([a, b], g) = (ends[number], &columns[k]);
                for i in 0..*d {
                    pull[a + i] += multiplier * g[i];
                    pull[b + i] -= multiplier * g[i];
                }
            }
        }
    }
}
