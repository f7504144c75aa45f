//! Conjugate gradients for the matrices of large solids.
//!
//! The matrix is stored in full, as blocks on the pattern of nodes, so that each row of a product is summed
//! up by one thread: results are the same to the last bit on any number of threads.

use super::entry_source::{Coupling, EntrySource};
use crate::base::simd::{Formula, each};
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::base::tensor::Real;
use crate::base::vector::dot;
use crate::dynamics::matrices::Matrices;
use crate::scene::constraint::ConstraintRow;

/// A symmetric positive definite matrix X without the fixed degrees of freedom, and the iteration with it,
/// preconditioned by the diagonal.
pub(super) struct Gradients {
    matrix: Matrix,
    /// Omitted degrees of freedom.
    fixed: Vec<usize>,
    /// 1 / X_ii
    inverse: Vec<f64>,
    solution: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
}

/// X on the nodes.
enum Matrix {
    /// The same for all axes, which are not coupled: X = x (x) I.
    Alike(NodeMatrix, usize),
    Blocks(BlockMatrix),
}

/// Result of an iteration.
pub(super) struct Ended {
    pub(super) iterations: usize,
    pub(super) is_solved: bool,
}

impl Gradients {
    /// For an X on the pattern of the matrices; the nodal ones of the `rows` fix degrees of freedom.
    pub(super) fn new(matrices: &Matrices, rows: &[ConstraintRow], coupling: Coupling) -> Self {
        let (pattern, dimension) = (matrices.pattern(), matrices.dimension);
        let zeros = || vec![0.0; matrices.dofs()];
        Self {
            matrix: match coupling {
                Coupling::AllAxes => Matrix::Blocks(BlockMatrix::zeros(pattern, dimension)),
                _ => Matrix::Alike(NodeMatrix::zeros(pattern), dimension),
            },
            fixed: rows.iter().filter_map(ConstraintRow::nodal).map(|(dof, _)| dof).collect(),
            inverse: zeros(),
            solution: zeros(),
            residual: zeros(),
            direction: zeros(),
            image: zeros(),
        }
    }

    /// Stores the matrix whose entries `value` returns. Returns whether its diagonal is positive, as in a
    /// positive definite one.
    pub(super) fn take(&mut self, value: impl Fn(EntrySource) -> f64) -> bool {
        self.matrix.fill(value);
        self.matrix.diagonal(&mut self.inverse);
        self.fixed.iter().for_each(|&dof| self.inverse[dof] = 1.0);
        let is_positive = self.inverse.iter().all(|x| *x > 0.0 && x.is_finite());
        self.inverse.iter_mut().for_each(|x| *x = 1.0 / *x);
        is_positive
    }

    /// The entry of the matrix that a source names.
    pub(super) fn entry(&self, source: EntrySource) -> f64 {
        self.matrix.entry(source)
    }

    /// Replaces `x`, at the `free` degrees of freedom, by the solution of X x' = x to a residual of
    /// `accuracy` times |x|, in `most` iterations at most; if it takes more, or X turns out not to be
    /// positive definite, `x` is unchanged.
    ///
    /// M. R. Hestenes, E. Stiefel, J. Res. Nat. Bur. Standards 49 (1952) 409-436.
    pub(super) fn solve(
        &mut self,
        free: &[usize],
        x: &mut [f64],
        accuracy: f64,
        most: usize,
    ) -> Ended {
        let Self { matrix, fixed, inverse, solution, residual, direction, image } = self;
        solution.fill(0.0);
        residual.fill(0.0);
        free.iter().zip(&*x).for_each(|(&dof, x)| residual[dof] = *x);
        let enough = accuracy.powi(2) * dot(x, x);
        direction.fill(0.0);
        // X-orthogonal directions, lengths measured by the preconditioner
        let [mut size] = each(Turn { share: 0.0 }, [inverse, residual], [direction]);
        let mut is_solved = enough == 0.0;
        let mut iterations = 0;
        while !is_solved && iterations < most {
            iterations += 1;
            matrix.multiply(direction, image);
            fixed.iter().for_each(|&dof| image[dof] = 0.0);
            let curvature = dot(direction, image);
            if !(curvature > 0.0 && curvature.is_finite()) {
                break;
            }
            let advance = Advance { step: size / curvature };
            let [left, next] = each(advance, [direction, image, inverse], [solution, residual]);
            is_solved = left <= enough;
            let share = next / std::mem::replace(&mut size, next);
            each(Turn { share }, [inverse, residual], [direction]);
        }
        if is_solved {
            free.iter().zip(x).for_each(|(&dof, x)| *x = solution[dof]);
        }
        Ended { iterations, is_solved }
    }
}

/// A step along a direction to the smallest error; sums the squares of the residual, as it is and
/// preconditioned.
struct Advance {
    step: f64,
}

impl Formula<3, 2, 2> for Advance {
    #[inline(always)]
    fn at<T: Real>(&self, [p, image, inverse]: [T; 3], [x, r]: [T; 2]) -> ([T; 2], [T; 2]) {
        let r = r - image * self.step;
        ([x + p * self.step, r], [r * r, r * r * inverse])
    }
}

/// The next direction: the preconditioned residual plus a share of the direction before; sums the square of
/// that residual.
struct Turn {
    share: f64,
}

impl Formula<2, 1, 1> for Turn {
    #[inline(always)]
    fn at<T: Real>(&self, [inverse, r]: [T; 2], [p]: [T; 1]) -> ([T; 1], [T; 1]) {
        let z = inverse * r;
        ([z + p * self.share], [z * r])
    }
}

impl Matrix {
    fn fill(&mut self, value: impl Fn(EntrySource) -> f64) {
        match self {
            Self::Alike(matrix, _) => {
                let pattern = matrix.pattern().clone();
                for (entry, x) in matrix.values.iter_mut().enumerate() {
                    *x = value(EntrySource::new(entry, pattern.transposed(entry), [0, 0]));
                }
            }
            Self::Blocks(matrix) => {
                let (pattern, d) = (matrix.pattern().clone(), matrix.dimension());
                for (entry, block) in matrix.values.chunks_exact_mut(d * d).enumerate() {
                    let transposed = pattern.transposed(entry);
                    for (at, x) in block.iter_mut().enumerate() {
                        *x = value(EntrySource::new(entry, transposed, [at / d, at % d]));
                    }
                }
            }
        }
    }

    fn entry(&self, source: EntrySource) -> f64 {
        match self {
            Self::Alike(matrix, _) => matrix.values[source.entry()],
            Self::Blocks(matrix) => {
                let (d, [row, column]) = (matrix.dimension(), source.axes());
                matrix.values[(source.entry() * d + row) * d + column]
            }
        }
    }

    fn diagonal(&self, diagonal: &mut [f64]) {
        for (dof, x) in diagonal.iter_mut().enumerate() {
            *x = match self {
                Self::Alike(matrix, d) => matrix.get(dof / d, dof / d),
                Self::Blocks(matrix) => matrix.get(dof, dof),
            };
        }
    }

    fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match self {
            Self::Alike(matrix, dimension) => matrix.product(*dimension, x, y),
            Self::Blocks(matrix) => matrix.product(x, y),
        }
    }
}
