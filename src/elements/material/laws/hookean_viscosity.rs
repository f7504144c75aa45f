//! Hooke's law, with viscous moduli, for the rate of Green's strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::viscous::ViscousLaw;
use crate::base::tensor::{Matrix, Real, dot, product, product_transposed, times, trace};
use crate::elements::material::deformation::Deformation;
use crate::elements::material::hooke::{Hooke, Lame, Spread};
use crate::elements::material::law::{Block, Blocks};

/// P = F S with E' = sym(F^T F'), S = lambda tr(E') I + 2 mu E'.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HookeanViscosity(pub(crate) Hooke);

impl ViscousLaw for HookeanViscosity {
    #[inline(always)]
    fn hooke(&self) -> &Hooke {
        &self.0
    }

    #[inline(always)]
    fn rate_of_dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
    ) -> T {
        trace(&at.twice_green_rate(rate)) * 0.5
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress(&at.twice_green_rate(rate), pull, weight))
    }

    /// lambda f_a f'_b^T + mu ((g_a . g_b) F F'^T + f_b f'_a^T) + (g_a . S g_b) I, f_a = F g_a, f'_a = F' g_a
    #[inline(always)]
    fn tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, T, N, M, D> {
        let f = at.gradient();
        let stress = self.0.stress(&at.twice_green_rate(rate), pull, weight.constant(1.0));
        Tangent {
            gradients,
            along: product(&f, gradients),
            moving: product(rate, gradients),
            mixed: product_transposed(rate, &f),
            pulls: product(&stress, gradients),
            lame: self.moduli_at_points(pull.is_some()),
            weight,
        }
    }

    #[inline(always)]
    fn rate_tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        is_projected: bool,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, T, N, M, D> {
        Spread::new(&at.gradient(), gradients, self.moduli_at_points(is_projected), weight)
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
    ) -> [[[T; D]; N]; 2] {
        [product(&at.gradient(), gradients), product(rate, gradients)]
    }
}

struct Tangent<'a, T, const N: usize, const M: usize, const D: usize> {
    gradients: &'a [[T; M]; N],
    /// F g_a
    along: [[T; D]; N],
    /// F' g_a
    moving: [[T; D]; N],
    /// F F'^T
    mixed: Matrix<T, D, D>,
    /// S g_a
    pulls: [[T; M]; N],
    lame: Lame,
    weight: T,
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Tangent<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let Self { gradients, along, moving, mixed, pulls, lame: Lame { lambda, mu }, weight } =
            self;
        let stretch = dot(&gradients[a], &gradients[b]);
        let mut block = [[stretch; D]; D];
        for i in 0..D {
            for k in 0..D {
                let shear = mixed[i][k] * stretch + along[b][i] * moving[a][k];
                block[i][k] = along[a][i] * moving[b][k] * *lambda + shear * *mu;
            }
            block[i][i] += dot(&gradients[a], &pulls[b]);
        }
        times(block, *weight)
    }
}
