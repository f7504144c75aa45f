//! Deformation at one point of a cell.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::base::tensor::{Matrix, Real, determinant, dot, symmetric};

/// The deformation gradient F = F_0 + H of a cell of dimension `M` in a space of dimension `D`, by its
/// difference H: strains computed from H lose no digits, however small they are.
///
/// F_0 is the frame of the cell: the identity where the cell fills space (`M == D`), else an orthonormal
/// frame of its tangent space.
pub(crate) struct Deformation<T, const M: usize, const D: usize> {
    frame: Matrix<T, D, M>,
    /// Displacement gradient H, sum u_a g_a^T.
    pub(crate) h: Matrix<T, D, M>,
}

impl<T: Real, const M: usize, const D: usize> Deformation<T, M, D> {
    #[inline(always)]
    pub(crate) fn new(frame: Matrix<T, D, M>, h: Matrix<T, D, M>) -> Self {
        Self { frame, h }
    }

    /// F_0
    #[inline(always)]
    pub(crate) fn frame(&self) -> Matrix<T, D, M> {
        self.frame
    }

    /// The direction with which the frame begins, in the coordinates of the cell. Where the cell fills space, its coordinates are those of space, and
    /// a frame is stored for this direction alone.
    #[inline(always)]
    pub(crate) fn first_axis(&self) -> [T; M] {
        let zero = self.h[0][0].constant(0.0);
        let mut axis = [zero; M];
        for j in 0..M {
            let own = if j == 0 { 1.0 } else { 0.0 };
            axis[j] = if M < D { zero.constant(own) } else { self.frame[0][j] };
        }
        axis
    }

    /// F = F_0 + H
    #[inline(always)]
    pub(crate) fn gradient(&self) -> Matrix<T, D, M> {
        let mut f = self.h;
        for j in 0..M {
            // a frame that is the identity need not be looked up
            if M == D {
                f[j][j] = f[j][j] + 1.0;
                continue;
            }
            for i in 0..D {
                f[j][i] += self.frame[j][i];
            }
        }
        f
    }

    /// Twice Cauchy's strain, F_0^T H + H^T F_0.
    #[inline(always)]
    pub(crate) fn twice_cauchy(&self) -> Matrix<T, M, M> {
        symmetric!(self.h[0][0]; j, k => self.along(j, k) + self.along(k, j))
    }

    /// Twice Green's strain, F_0^T H + H^T F_0 + H^T H.
    #[inline(always)]
    pub(crate) fn twice_green(&self) -> Matrix<T, M, M> {
        symmetric!(self.h[0][0]; j, k => self.along(j, k) + self.along(k, j) + dot(&self.h[j], &self.h[k]))
    }

    /// Twice the rate of Green's strain, F^T F' + F'^T F, with the `rate` F' of F.
    #[inline(always)]
    pub(crate) fn twice_green_rate(&self, rate: &Matrix<T, D, M>) -> Matrix<T, M, M> {
        let f = self.gradient();
        symmetric!(f[0][0]; j, k => dot(&f[j], &rate[k]) + dot(&f[k], &rate[j]))
    }

    /// Factor by which F stretches a volume: det F, or sqrt(det(F^T F)) where the cell does not fill space.
    #[inline(always)]
    pub(crate) fn stretch(&self) -> T {
        let f = self.gradient();
        match M == D {
            true => {
                let mut square = [[f[0][0]; M]; M];
                for j in 0..M {
                    for i in 0..M {
                        square[j][i] = f[j][i];
                    }
                }
                determinant(&square)
            }
            false => determinant::<T, M>(&symmetric!(f[0][0]; j, k => dot(&f[j], &f[k]))).sqrt(),
        }
    }

    /// F_0^T H
    #[inline(always)]
    fn along(&self, j: usize, k: usize) -> T {
        match M == D {
            true => self.h[k][j],
            false => dot(&self.frame[j], &self.h[k]),
        }
    }
}
