//! Objective viscosity: Hooke's law, with viscous moduli, for the rate of Green's strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::material::deformation::Deformation;
use crate::material::hooke::{Hooke, Lame, Spread};
use crate::material::law::{Block, Blocks, ViscousLaw};
use crate::tensor::{Matrix, Real, dot, product, product_transposed, times, trace};

/// P = F S with E' = sym(F^T F'), S = lambda tr(E') I + 2 mu E'. A body that spins as a whole is not
/// braked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ObjectiveViscosity(pub(crate) Hooke);

/// With `pull` in place of lambda tr(E'), as where that takes the mean rate of dilatation over a cell.
impl ObjectiveViscosity {
    /// tr(E')
    #[inline(always)]
    pub(crate) fn rate_of_dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
    ) -> T {
        trace(&at.twice_green_rate(rate)) * 0.5
    }

    /// lambda tr(E') of its mean, and lambda.
    #[inline(always)]
    pub(crate) fn of_volume<T: Real>(&self, rate: T) -> [T; 2] {
        let [_, pull, stiff] = self.0.of_volume(rate);
        [pull, stiff]
    }

    /// P, times `weight`.
    #[inline(always)]
    pub(crate) fn stress_under<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: T,
        weight: T,
    ) -> Matrix<T, D, M> {
        let twice = at.twice_green_rate(rate);
        product(&at.gradient(), &self.0.stress_under(&twice, pull, weight))
    }

    /// dP/dF', as [`ViscousLaw::rate_tangent`], without lambda.
    #[inline(always)]
    pub(crate) fn rate_tangent_of_shear<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Spread::new(&at.gradient(), gradients, self.0.of_shear().lame, weight)
    }

    /// dP/dF, as [`ViscousLaw::tangent`]; `pull` stays as it is.
    #[inline(always)]
    pub(crate) fn tangent_under<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: T,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let shear = self.0.of_shear();
        let stress = shear.stress_under(&at.twice_green_rate(rate), pull, weight.constant(1.0));
        Tangent::new(at, rate, &stress, gradients, shear.lame, weight)
    }
}

impl ViscousLaw for ObjectiveViscosity {
    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress(&at.twice_green_rate(rate), weight))
    }

    /// The rate of strain changes with F, too, so that this is not symmetric:
    /// lambda f_a f'_b^T + mu ((g_a . g_b) F F'^T + f_b f'_a^T) + (g_a . S g_b) I, f'_a = F' g_a
    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let stress = self.0.stress(&at.twice_green_rate(rate), weight.constant(1.0));
        Tangent::new(at, rate, &stress, gradients, self.0.lame, weight)
    }

    #[inline(always)]
    fn rate_tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Spread::new(&at.gradient(), gradients, self.0.lame, weight)
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

impl<'a, T: Real, const N: usize, const M: usize, const D: usize> Tangent<'a, T, N, M, D> {
    #[inline(always)]
    fn new(
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        stress: &Matrix<T, M, M>,
        gradients: &'a [[T; M]; N],
        lame: Lame,
        weight: T,
    ) -> Self {
        let f = at.gradient();
        Self {
            gradients,
            along: product(&f, gradients),
            moving: product(rate, gradients),
            mixed: product_transposed(rate, &f),
            pulls: product(stress, gradients),
            lame,
            weight,
        }
    }
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
