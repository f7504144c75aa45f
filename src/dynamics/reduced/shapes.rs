//! The shapes of a reduced model as one matrix Psi: those that are free, and behind them those that constraints move. For
//! the active degrees of freedom, on which forces depend, there is a copy of their rows.

use crate::base::simd::add_multiple;
use crate::base::sparse::BlockMatrix;
use crate::base::vector::dot;
use crate::scene::reduced_model::ReducedPhase;

pub(super) struct Shapes {
    free: usize,
    count: usize,
    dofs: usize,
    /// Psi and M Phi, column by column.
    columns: Vec<f64>,
    weighted: Vec<f64>,
    active: Active,
}

/// The active degrees of freedom, whole nodes of them.
#[derive(Default)]
struct Active {
    dofs: Vec<usize>,
    /// Index of the first of a node among them, if it has any.
    places: Vec<Option<usize>>,
    /// Their rows of Psi column by column, and row by row.
    columns: Vec<f64>,
    rows: Vec<Chunk>,
    /// Chunks in a row.
    width: usize,
    /// Room for a number for each of them, twice.
    room: [Vec<f64>; 2],
    /// Room for the rows of a node of A Psi, and for Psi^T A Psi.
    of_node: Vec<Chunk>,
    product: Vec<Chunk>,
}

/// Numbers of some shapes side by side; behind the last one there are zeros.
type Chunk = [f64; CHUNK];
const CHUNK: usize = 4;

impl Shapes {
    pub(super) fn new(phase: &ReducedPhase) -> Self {
        let all: Vec<&Vec<f64>> = phase.shapes.iter().chain(&phase.lifts).collect();
        Self {
            free: phase.shapes.len(),
            count: all.len(),
            dofs: all.first().map_or(0, |column| column.len()),
            columns: all.into_iter().flatten().copied().collect(),
            weighted: Vec::new(),
            active: Active::default(),
        }
    }

    /// Sets the inertia M by its product, y += M x.
    pub(super) fn weigh(&mut self, product: impl Fn(&[f64], &mut [f64])) {
        self.weighted = vec![0.0; self.dofs * self.free];
        for (x, y) in self.columns.chunks(self.dofs).zip(self.weighted.chunks_mut(self.dofs)) {
            product(x, y);
        }
    }

    /// Sets the active degrees of freedom: the `dimension` ones of each of some `nodes`.
    pub(super) fn activate(&mut self, nodes: impl Iterator<Item = usize>, dimension: usize) {
        let Self { columns, dofs, count, .. } = &*self;
        let mut active = Active { places: vec![None; dofs / dimension], ..Active::default() };
        for node in nodes {
            active.places[node] = Some(active.dofs.len());
            active.dofs.extend(node * dimension..(node + 1) * dimension);
        }
        let own = &active.dofs;
        active.columns =
            columns.chunks(*dofs).flat_map(|column| own.iter().map(|&dof| column[dof])).collect();
        active.width = count.div_ceil(CHUNK);
        let entry = |dof: usize, k: usize| if k < *count { columns[k * dofs + dof] } else { 0.0 };
        let chunk = |dof: usize, c: usize| std::array::from_fn(|i| entry(dof, c * CHUNK + i));
        let row = |&dof: &usize| (0..active.width).map(move |c| (dof, c));
        active.rows = own.iter().flat_map(row).map(|(dof, c)| chunk(dof, c)).collect();
        active.room = [vec![0.0; own.len()], vec![0.0; own.len()]];
        active.of_node = vec![[0.0; CHUNK]; dimension * active.width];
        active.product = vec![[0.0; CHUNK]; count * active.width];
        self.active = active;
    }

    /// Whether a node is active.
    pub(super) fn sees(&self, node: usize) -> bool {
        self.active.places[node].is_some()
    }

    /// Whether all are.
    pub(super) fn sees_all(&self) -> bool {
        self.active.dofs.len() == self.dofs
    }

    /// Number of displacement components.
    pub(super) fn dofs(&self) -> usize {
        self.dofs
    }

    /// Number of those that are free.
    pub(super) fn free(&self) -> usize {
        self.free
    }

    /// Number of all.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// All of them.
    pub(super) fn all(&self) -> Vec<&[f64]> {
        self.columns.chunks(self.dofs.max(1)).collect()
    }

    /// y += factor times a column
    pub(super) fn add_column(&self, column: usize, factor: f64, y: &mut [f64]) {
        add_multiple(factor, &self.columns[column * self.dofs..][..self.dofs], y);
    }

    /// Psi^T A Psi, row by row, for y += A x.
    pub(super) fn products(&self, product: &dyn Fn(&[f64], &mut [f64])) -> Vec<f64> {
        let mut all = vec![0.0; self.count * self.count];
        for (j, x) in self.columns.chunks(self.dofs).enumerate() {
            let (mut y, mut column) = (vec![0.0; x.len()], vec![0.0; self.count]);
            product(x, &mut y);
            self.add_projected(&y, &mut column);
            (0..self.count).for_each(|i| all[i * self.count + j] = column[i]);
        }
        all
    }

    /// sum += Psi^T f
    pub(super) fn add_projected(&self, f: &[f64], sum: &mut [f64]) {
        add_products(&self.columns, f, sum);
    }

    /// sum += Psi^T f for forces f on active degrees of freedom only.
    pub(super) fn add_projected_active(&mut self, f: &[f64], sum: &mut [f64]) {
        let Active { dofs, columns, room: [own, _], .. } = &mut self.active;
        own.iter_mut().zip(&*dofs).for_each(|(own, &dof)| *own = f[dof]);
        add_products(columns, own, sum);
    }

    /// Phi^T M x
    pub(super) fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.free];
        add_products(&self.weighted, x, &mut sum);
        sum
    }

    /// Adds Psi z.
    pub(super) fn add_lifted(&self, z: &[f64], u: &mut [f64]) {
        for (z, column) in z.iter().zip(self.columns.chunks(self.dofs)) {
            add_multiple(*z, column, u);
        }
    }

    /// Writes origin + Psi z and Psi z' where it is active.
    pub(super) fn lift_active(&mut self, z: [&[f64]; 2], [u, v]: [&mut [f64]; 2], origin: &[f64]) {
        let Active { dofs, columns, room, .. } = &mut self.active;
        for (z, own) in z.into_iter().zip(&mut *room) {
            own.fill(0.0);
            for (z, column) in z.iter().zip(columns.chunks(dofs.len().max(1))) {
                add_multiple(*z, column, own);
            }
        }
        let [lifted, rates] = room;
        for ((&dof, x), rate) in dofs.iter().zip(lifted).zip(rates) {
            (u[dof], v[dof]) = (origin[dof] + *x, *rate);
        }
    }

    /// sum += Psi^T A Psi, row by row, for a matrix that has blocks of active nodes alone.
    pub(super) fn add_projected_matrix(&mut self, matrix: &BlockMatrix, sum: &mut [f64]) {
        let (d, count) = (matrix.dimension(), self.count);
        let Active { dofs, places, rows, width, of_node, product, .. } = &mut self.active;
        let width = *width;
        product.fill([0.0; CHUNK]);
        for (first, dofs) in dofs.chunks_exact(d).enumerate() {
            of_node.fill([0.0; CHUNK]);
            for (entry, other) in matrix.pattern().row(dofs[0] / d) {
                let Some(place) = places[other] else { continue };
                let block = &matrix.values[entry * d * d..][..d * d];
                for j in 0..d {
                    let row = &rows[(place + j) * width..][..width];
                    for (i, of_axis) in of_node.chunks_exact_mut(width).enumerate() {
                        add_chunks(block[i * d + j], row, of_axis);
                    }
                }
            }
            for (i, of_axis) in of_node.chunks_exact(width).enumerate() {
                let row = rows[(first * d + i) * width..][..width].as_flattened();
                for (shape, sum) in row.iter().zip(product.chunks_exact_mut(width)) {
                    add_chunks(*shape, of_axis, sum);
                }
            }
        }
        for (own, sum) in product.chunks_exact(width.max(1)).zip(sum.chunks_exact_mut(count.max(1)))
        {
            sum.iter_mut().zip(own.as_flattened()).for_each(|(sum, x)| *sum += x);
        }
    }
}

/// y += factor x
#[inline]
fn add_chunks(factor: f64, x: &[Chunk], y: &mut [Chunk]) {
    for (x, y) in x.iter().zip(y) {
        for i in 0..CHUNK {
            y[i] += factor * x[i];
        }
    }
}

/// sum += A^T x for the `columns` of A.
fn add_products(columns: &[f64], x: &[f64], sum: &mut [f64]) {
    for (sum, column) in sum.iter_mut().zip(columns.chunks(x.len().max(1))) {
        *sum += dot(column, x);
    }
}
