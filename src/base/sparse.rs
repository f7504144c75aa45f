//! Sparse matrices over the nodes of a mesh.
//!
//! All matrices of a body share one [`NodePattern`]: which nodes share a cell (or a spring). On it
//! live [`NodeMatrix`], one number per pair of nodes (inertia, which acts alike on each axis), and
//! [`BlockMatrix`], one small dense block per pair (stiffness, damping, tangents).

mod pattern;

use std::sync::Arc;

use faer::Mat;
pub use pattern::NodePattern;
use rayon::prelude::*;

/// Calls a function that is generic over the dimension of space with the given dimension.
macro_rules! with_dimension {
    ($dimension:expr, $function:ident ( $($argument:expr),* $(,)? )) => {
        match $dimension {
            1 => $function::<1>($($argument),*),
            2 => $function::<2>($($argument),*),
            _ => $function::<3>($($argument),*),
        }
    };
}

/// Nodes whose rows one thread multiplies at a time.
const SHARE: usize = 512;

/// One number per coupled pair of nodes: the matrix m of M = m (x) I.
#[derive(Debug, Clone)]
pub struct NodeMatrix {
    pattern: Arc<NodePattern>,
    pub(crate) values: Vec<f64>,
}

impl NodeMatrix {
    pub(crate) fn zeros(pattern: &Arc<NodePattern>) -> Self {
        Self { pattern: pattern.clone(), values: vec![0.0; pattern.entries()] }
    }

    /// A diagonal matrix of zeros for `nodes` nodes.
    pub(crate) fn diagonal(nodes: usize) -> Self {
        Self::zeros(&Arc::new(NodePattern::new(nodes, std::iter::empty())))
    }

    /// Entry for two nodes; 0 where they are not coupled.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        self.pattern.find(row, column).map_or(0.0, |entry| self.values[entry])
    }

    /// The shared pattern.
    pub fn pattern(&self) -> &Arc<NodePattern> {
        &self.pattern
    }

    /// The entries, in the order of the pattern.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same matrix on a pattern with more entries.
    pub(crate) fn moved_to(&self, pattern: &Arc<NodePattern>) -> Self {
        let mut moved = Self::zeros(pattern);
        for row in 0..self.pattern.nodes() {
            for (entry, column) in self.pattern.row(row) {
                moved.add(row, column, self.values[entry]);
            }
        }
        moved
    }

    /// The matrices of several bodies as one.
    pub(crate) fn join<'a>(bodies: impl Iterator<Item = &'a Self> + Clone) -> Self {
        let pattern = NodePattern::join(bodies.clone().map(|body| &*body.pattern));
        let values = bodies.flat_map(|body| &body.values).copied().collect();
        Self { pattern: pattern.into(), values }
    }

    /// Whether no entry couples two different nodes.
    pub(crate) fn is_diagonal(&self) -> bool {
        let row_is = |row| {
            self.pattern.row(row).all(|(entry, column)| column == row || self.values[entry] == 0.0)
        };
        (0..self.pattern.nodes()).all(row_is)
    }

    /// Adds to the entry of two coupled nodes.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        if let Some(entry) = self.pattern.find(row, column) {
            self.values[entry] += value;
        }
    }

    /// y += factor (m (x) I) x for vectors with `dimension` components per node.
    pub(crate) fn add_product(&self, dimension: usize, factor: f64, x: &[f64], y: &mut [f64]) {
        with_dimension!(dimension, node_product(&self.pattern, &self.values, 0, factor, x, y));
    }

    /// y = (m (x) I) x for vectors with `dimension` components per node, each row by one thread.
    pub(crate) fn product(&self, dimension: usize, x: &[f64], y: &mut [f64]) {
        y.par_chunks_mut(SHARE * dimension).enumerate().for_each(|(share, y)| {
            y.fill(0.0);
            let first = share * SHARE;
            with_dimension!(dimension, node_product(&self.pattern, &self.values, first, 1.0, x, y));
        });
    }

    /// (m (x) I) x at one degree of freedom.
    pub(crate) fn row_product(&self, dimension: usize, dof: usize, x: &[f64]) -> f64 {
        let (node, axis) = (dof / dimension, dof % dimension);
        let products =
            self.pattern.row(node).map(|(e, b)| self.values[e] * x[b * dimension + axis]);
        products.sum()
    }

    /// x . (m (x) I) x
    pub(crate) fn quadratic_form(&self, dimension: usize, x: &[f64]) -> f64 {
        with_dimension!(dimension, node_form(&self.pattern, &self.values, x))
    }
}

/// One `dimension` x `dimension` block per coupled pair of nodes.
#[derive(Debug, Clone)]
pub struct BlockMatrix {
    pattern: Arc<NodePattern>,
    dimension: usize,
    /// Blocks in the order of the pattern, each row by row.
    pub(crate) values: Vec<f64>,
}

impl BlockMatrix {
    pub(crate) fn zeros(pattern: &Arc<NodePattern>, dimension: usize) -> Self {
        let values = vec![0.0; pattern.entries() * dimension * dimension];
        Self { pattern: pattern.clone(), dimension, values }
    }

    /// The matrices of several bodies as one on the `pattern` that joins theirs; 0 for a body without a matrix,
    /// of which the pattern is given.
    pub(crate) fn join<'a>(
        pattern: &Arc<NodePattern>,
        dimension: usize,
        bodies: impl Iterator<Item = Result<&'a Self, &'a NodePattern>>,
    ) -> Self {
        let mut values = Vec::with_capacity(pattern.entries() * dimension * dimension);
        for body in bodies {
            match body {
                Ok(matrix) => values.extend_from_slice(&matrix.values),
                Err(none) => {
                    values.resize(values.len() + none.entries() * dimension * dimension, 0.0);
                }
            }
        }
        Self { pattern: pattern.clone(), dimension, values }
    }

    /// Components per node.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The shared pattern.
    pub fn pattern(&self) -> &Arc<NodePattern> {
        &self.pattern
    }

    /// Entry for two degrees of freedom; 0 where their nodes are not coupled.
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let d = self.dimension;
        let entry = self.pattern.find(row / d, column / d);
        entry.map_or(0.0, |entry| self.values[(entry * d + row % d) * d + column % d])
    }

    /// The blocks in the order of the pattern, each row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The whole matrix as a dense one, for small bodies and tests.
    pub fn to_dense(&self) -> Mat<f64> {
        let n = self.pattern.nodes() * self.dimension;
        Mat::from_fn(n, n, |row, column| self.get(row, column))
    }

    /// The same matrix on a pattern with more entries.
    pub(crate) fn moved_to(&self, pattern: &Arc<NodePattern>) -> Self {
        let mut moved = Self::zeros(pattern, self.dimension);
        let size = self.dimension * self.dimension;
        for row in 0..self.pattern.nodes() {
            for (entry, column) in self.pattern.row(row) {
                if let Some(block) = moved.block_mut(row, column) {
                    block.copy_from_slice(&self.values[entry * size..][..size]);
                }
            }
        }
        moved
    }

    /// The block of two coupled nodes, row by row.
    pub fn block_mut(&mut self, row: usize, column: usize) -> Option<&mut [f64]> {
        let size = self.dimension * self.dimension;
        let entry = self.pattern.find(row, column)?;
        Some(&mut self.values[entry * size..][..size])
    }

    /// Adds m (x) I, for a matrix `m` that couples no further nodes.
    pub(crate) fn add_on_all_axes(&mut self, m: &NodeMatrix) {
        let d = self.dimension;
        for row in 0..m.pattern.nodes() {
            for (entry, column) in m.pattern.row(row) {
                if let Some(block) = self.block_mut(row, column) {
                    block.iter_mut().step_by(d + 1).for_each(|value| *value += m.values[entry]);
                }
            }
        }
    }

    /// All rows, to be divided among threads, if the matrix has `D` components per node.
    pub(crate) fn rows_mut<const D: usize>(&mut self) -> Rows<'_, D> {
        debug_assert_eq!(self.dimension, D);
        let blocks = self.values.as_chunks_mut::<D>().0.as_chunks_mut::<D>().0;
        Rows { pattern: &self.pattern, first: 0, blocks }
    }

    /// Number at the axes `[row, column]` of the block `entry` in the symmetric part of the matrix,
    /// `transposed` being the entry of the same nodes the other way round.
    pub(crate) fn symmetric(
        &self,
        entry: usize,
        transposed: usize,
        [row, column]: [usize; 2],
    ) -> f64 {
        let d = self.dimension;
        let (at, across) = ((entry * d + row) * d + column, (transposed * d + column) * d + row);
        0.5 * (self.values[at] + self.values[across])
    }

    /// A x at one degree of freedom.
    pub(crate) fn row_product(&self, dof: usize, x: &[f64]) -> f64 {
        let d = self.dimension;
        let (node, axis) = (dof / d, dof % d);
        let products = self.pattern.row(node).map(|(entry, column)| {
            crate::base::vector::dot(
                &self.values[(entry * d + axis) * d..][..d],
                &x[column * d..][..d],
            )
        });
        products.sum()
    }

    /// y += factor A x
    pub(crate) fn add_product(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        with_dimension!(
            self.dimension,
            block_product(&self.pattern, &self.values, 0, factor, x, y)
        );
    }

    /// y = A x, each row by one thread.
    pub(crate) fn product(&self, x: &[f64], y: &mut [f64]) {
        let (pattern, values) = (&self.pattern, &self.values);
        y.par_chunks_mut(SHARE * self.dimension).enumerate().for_each(|(share, y)| {
            y.fill(0.0);
            let first = share * SHARE;
            with_dimension!(self.dimension, block_product(pattern, values, first, 1.0, x, y));
        });
    }

    /// y += factor A^T x
    #[cfg(any(feature = "gradient", feature = "study"))]
    pub(crate) fn add_transposed_product(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let d = self.dimension;
        for (dof, x) in x.iter().enumerate() {
            let (node, axis) = (dof / d, dof % d);
            for (entry, column) in self.pattern.row(node) {
                let row = &self.values[(entry * d + axis) * d..][..d];
                let y = y[column * d..][..d].iter_mut();
                y.zip(row).for_each(|(y, a)| *y += factor * a * x);
            }
        }
    }

    /// |A| x, with the absolute values of all entries, at one degree of freedom.
    pub(crate) fn absolute_row_product(&self, dof: usize, x: &[f64]) -> f64 {
        let d = self.dimension;
        let (node, axis) = (dof / d, dof % d);
        let products = self.pattern.row(node).map(|(entry, column)| {
            let row = &self.values[(entry * d + axis) * d..][..d];
            row.iter().zip(&x[column * d..][..d]).map(|(a, x)| a.abs() * x).sum::<f64>()
        });
        products.sum()
    }

    /// x . A x
    pub(crate) fn quadratic_form(&self, x: &[f64]) -> f64 {
        (0..x.len()).map(|dof| x[dof] * self.row_product(dof, x)).sum()
    }
}

/// The rows of some nodes of a [`BlockMatrix`].
pub(crate) struct Rows<'a, const D: usize> {
    pattern: &'a NodePattern,
    /// Entry of the first block.
    first: usize,
    blocks: &'a mut [[[f64; D]; D]],
}

impl<'a, const D: usize> Rows<'a, D> {
    /// The rows before those of `node`, and the others.
    pub(crate) fn split_at(self, node: usize) -> (Self, Self) {
        let Self { pattern, first, blocks } = self;
        let middle = pattern.offsets[node];
        let (before, after) = blocks.split_at_mut(middle - first);
        (Self { pattern, first, blocks: before }, Self { pattern, first: middle, blocks: after })
    }

    /// The block of a pair of nodes, if its row is among them. `entry` is its index in the pattern before
    /// that was widened: the index that cells know, whatever pairs were added.
    #[inline(always)]
    pub(crate) fn block_mut(&mut self, entry: u32) -> Option<&mut [[f64; D]; D]> {
        let entry = match &self.pattern.widened {
            Some(widened) => widened[entry as usize],
            None => entry as usize,
        };
        self.blocks.get_mut(entry.wrapping_sub(self.first))
    }
}

/// The product in the rows of `y`, which are those of the nodes from `first` on.
fn node_product<const D: usize>(
    pattern: &NodePattern,
    values: &[f64],
    first: usize,
    factor: f64,
    x: &[f64],
    y: &mut [f64],
) {
    let (x, y) = (x.as_chunks::<D>().0, y.as_chunks_mut::<D>().0);
    for (node, y) in y.iter_mut().enumerate() {
        let sum = node_row(pattern, values, first + node, x);
        for axis in 0..D {
            y[axis] += factor * sum[axis];
        }
    }
}

fn node_form<const D: usize>(pattern: &NodePattern, values: &[f64], x: &[f64]) -> f64 {
    let x = x.as_chunks::<D>().0;
    let mut form = 0.0;
    for (node, at) in x.iter().enumerate() {
        let product = node_row(pattern, values, node, x);
        for axis in 0..D {
            form += at[axis] * product[axis];
        }
    }
    form
}

/// (m (x) I) x at one node.
fn node_row<const D: usize>(
    pattern: &NodePattern,
    values: &[f64],
    node: usize,
    x: &[[f64; D]],
) -> [f64; D] {
    let mut sum = [0.0; D];
    for (entry, column) in pattern.row(node) {
        for axis in 0..D {
            sum[axis] += values[entry] * x[column][axis];
        }
    }
    sum
}

/// The product in the rows of `y`, which are those of the nodes from `first` on.
fn block_product<const D: usize>(
    pattern: &NodePattern,
    values: &[f64],
    first: usize,
    factor: f64,
    x: &[f64],
    y: &mut [f64],
) {
    let (x, y) = (x.as_chunks::<D>().0, y.as_chunks_mut::<D>().0);
    let rows = values.as_chunks::<D>().0;
    for (node, y) in y.iter_mut().enumerate() {
        let mut sum = [0.0; D];
        for (entry, column) in pattern.row(first + node) {
            let (block, x) = (&rows[entry * D..][..D], x[column]);
            for axis in 0..D {
                for other in 0..D {
                    sum[axis] += block[axis][other] * x[other];
                }
            }
        }
        for axis in 0..D {
            y[axis] += factor * sum[axis];
        }
    }
}
