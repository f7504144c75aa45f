//! Hooke's law for a strain of the cell: linear elasticity for Cauchy's, St. Venant-Kirchhoff material for
//! Green's.
//!
//! Linear elasticity is P = F_0 S of Cauchy's strain sym(F_0^T H), St. Venant-Kirchhoff material P = F S of
//! Green's strain sym(F_0^T H) + H^T H / 2, with one formula S = lambda tr(E) I + 2 mu E (`hooke.rs`). The
//! tangent of the second one is
//!
//! ```text
//! K_ab = sum w (lambda f_a f_b^T + mu ((g_a.g_b) F F^T + f_b f_a^T) + (g_a.S g_b) I),   f_a = F g_a
//! ```
//!
//! and that of the first the same with F_0 for F and without S; Hirai's matrices a, b, H_lambda, H_mu,
//! J_lambda, J_mu of the triangle are this formula written out. E is written by H and not by F, so that small
//! strains keep their digits.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::base::tensor::{Matrix, Real, dot, product, symmetric, times, trace};
use crate::elements::material::hooke::{Hooke, Lame, Spread};
use crate::elements::material::law::{Block, Blocks, ElasticLaw};
use crate::elements::material::response::{Elasticity, Response, axes};

/// W = lambda tr(E)^2 / 2 + mu E : E and S = lambda tr(E) I + 2 mu E, with g = tr(E): P = F_0 S and
/// E = sym(F_0^T H) for `SMALL` strain, else P = F S and E = (F^T F - I) / 2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hookean<const SMALL: bool>(pub(crate) Hooke);

pub(crate) type Linear = Hookean<true>;
pub(crate) type StVenantKirchhoff = Hookean<false>;

impl StVenantKirchhoff {
    /// S and dS/dE
    #[inline(always)]
    pub(super) fn response<T: Real, const M: usize>(
        &self,
        twice: &Matrix<T, M, M>,
        pull: Option<T>,
    ) -> Response<T, M> {
        let Lame { mut lambda, mu } = self.0.lame;
        if pull.is_some() {
            lambda = 0.0;
        }
        let zero = twice[0][0].constant(0.0);
        let mut elasticity: Elasticity<T> = [[zero; 6]; 6];
        for v in 0..M * (M + 1) / 2 {
            let (j, l) = axes::<M>(v);
            for w in 0..M * (M + 1) / 2 {
                let (k, n) = axes::<M>(w);
                let volume = if j == l && k == n { lambda } else { 0.0 };
                let shear = match (v == w, j == l) {
                    (false, _) => 0.0,
                    (true, true) => 2.0 * mu,
                    (true, false) => mu,
                };
                elasticity[v][w] = zero.constant(volume + shear);
            }
        }
        Response { stress: self.0.stress(twice, pull, zero.constant(1.0)), elasticity }
    }
}

impl<const SMALL: bool> ElasticLaw for Hookean<SMALL> {
    const SMALL_STRAIN: bool = SMALL;

    /// 2 E
    type Point<T: Real, const M: usize> = Matrix<T, M, M>;

    #[inline(always)]
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Matrix<T, M, M> {
        twice
    }

    #[inline(always)]
    fn energy<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        self.0.energy(twice)
    }

    #[inline(always)]
    fn energy_of_shape<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        self.0.of_shear().energy(twice)
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        trace(twice) * 0.5
    }

    #[inline(always)]
    fn swelling<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> Matrix<T, M, M> {
        let zero = twice[0][0].constant(0.0);
        symmetric!(zero; j, k => if j == k { zero + 1.0 } else { zero })
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        self.0.of_volume(dilatation)
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize>(
        &self,
        twice: &Matrix<T, M, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M> {
        self.0.stress(twice, pull, weight)
    }

    /// lambda f_a f_b^T + mu ((g_a . g_b) F F^T + f_b f_a^T) + (g_a . S g_b) I, f_a = F g_a; for small strain
    /// without the term of S
    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        f: Matrix<T, D, M>,
        twice: Matrix<T, M, M>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let hooke = match pull {
            None => self.0,
            Some(_) => self.0.of_shear(),
        };
        let stress = self.0.stress(&twice, pull, weight.constant(1.0));
        Tangent::<T, SMALL, N, M, D> {
            spread: Spread::new(&f, gradients, hooke.lame, weight),
            pulls: product(&stress, gradients),
        }
    }

    #[inline(always)]
    fn across<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>, pull: Option<T>) -> [T; 2] {
        match pull {
            None => self.0.across(twice),
            // no shear there, and no strain
            Some(pull) => [pull.constant(0.0), pull],
        }
    }

    /// It counts as undeformed: by Hooke's law sections would shrink to nothing at large strains.
    #[inline(always)]
    fn thickness<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        twice[0][0].constant(1.0)
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize>(&self, stretch: T, _: &Matrix<T, M, M>) -> T {
        match SMALL {
            true => stretch.constant(1.0),
            false => stretch,
        }
    }

    fn outside(&self, domain: f64) -> String {
        format!(
            "is inverted, det F = {domain:.3}: St. Venant-Kirchhoff material collapses under strong \
             compression; load it less, refine the mesh there, or take a law of rubber"
        )
    }
}

struct Tangent<'a, T, const SMALL: bool, const N: usize, const M: usize, const D: usize> {
    spread: Spread<'a, T, N, M, D>,
    /// S g_a
    pulls: [[T; M]; N],
}

impl<T: Real, const SMALL: bool, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Tangent<'_, T, SMALL, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let mut block = self.spread.material(a, b);
        if !SMALL {
            let geometric = dot(&self.spread.gradients[a], &self.pulls[b]);
            for i in 0..D {
                block[i][i] += geometric;
            }
        }
        times(block, self.spread.weight)
    }
}
