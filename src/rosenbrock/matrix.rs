//! The matrix I - gamma h J of a step, dense.

use std::fmt;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::integrate::Tolerances;
use crate::ode::{Failure, Ode, call};

/// J and the factors of I - gamma h J.
pub(super) struct Dense {
    jacobian: Mat<f64>,
    factors: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    memory: MemBuffer,
    /// A shifted state and f there.
    shifted: Vec<f64>,
    value: Vec<f64>,
}

impl fmt::Debug for Dense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Dense").field("jacobian", &self.jacobian).finish_non_exhaustive()
    }
}

impl Dense {
    pub(super) fn new(n: usize) -> Self {
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default())
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            jacobian: Mat::zeros(n, n),
            factors: Mat::zeros(n, n),
            forward: vec![0; n],
            inverse: vec![0; n],
            memory: MemBuffer::new(scratch),
            shifted: vec![0.0; n],
            value: vec![0.0; n],
        }
    }

    /// Asks the system for J at (t, y), where f is `slope`.
    pub(super) fn ask<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        [y, slope]: [&[f64]; 2],
    ) -> Result<(), Failure> {
        self.jacobian.fill(0.0);
        system.dense_jacobian(t, y, slope, self.jacobian.as_mut())
    }

    /// J by differences at (t, y), where f is `slope`.
    pub(super) fn difference<S: Ode>(
        &mut self,
        system: &mut S,
        t: f64,
        [y, slope]: [&[f64]; 2],
        tolerances: &Tolerances,
    ) -> Result<(), Failure> {
        self.shifted.copy_from_slice(y);
        for (j, &unshifted) in y.iter().enumerate() {
            self.shifted[j] += f64::EPSILON.sqrt() * tolerances.size_of(j, unshifted);
            call::rhs(system, t, &self.shifted, &mut self.value)?;
            let increment = self.shifted[j] - unshifted;
            let column = self.jacobian.col_as_slice_mut(j);
            for (entry, (value, base)) in column.iter_mut().zip(self.value.iter().zip(slope)) {
                *entry = (value - base) / increment;
            }
            self.shifted[j] = unshifted;
        }
        Ok(())
    }

    /// The first entry, column by column, that is not finite, with its value.
    pub(super) fn not_finite(&self) -> Option<(usize, f64)> {
        let n = self.forward.len();
        let entries = (0..n * n).map(|k| (k, self.jacobian[(k % n, k / n)]));
        entries.into_iter().find(|(_, value)| !value.is_finite())
    }

    /// Factorizes I - gamma J; `false` if it is singular.
    pub(super) fn factorize(&mut self, gamma: f64) -> bool {
        let n = self.forward.len();
        for j in 0..n {
            let column = self.factors.col_as_slice_mut(j);
            for (entry, slope) in column.iter_mut().zip(self.jacobian.col_as_slice(j)) {
                *entry = -gamma * slope;
            }
            column[j] += 1.0;
        }
        factor::lu_in_place(
            self.factors.as_mut(),
            &mut self.forward,
            &mut self.inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        (0..n).all(|i| self.factors[(i, i)] != 0.0)
    }

    /// Replaces `r` by the solution.
    pub(super) fn solve(&mut self, r: &mut [f64]) {
        let n = r.len();
        solve::solve_in_place(
            self.factors.as_ref(),
            self.factors.as_ref(),
            PermRef::new_checked(&self.forward, &self.inverse, n),
            MatMut::from_column_major_slice_mut(r, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}
