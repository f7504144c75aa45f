//! Objective viscosity: Hooke's law, with viscous moduli, for the rate of Green's strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::base::tensor::{Matrix, Real, dot, product, product_transposed, times, trace};
use crate::elements::material::deformation::Deformation;
use crate::elements::material::hooke::{Hooke, Lame, Spread};
use crate::elements::material::law::{Block, Blocks};

/// P = F S with E' = sym(F^T F'), S = lambda tr(E') I + 2 mu E'. A body that spins as a whole is not
/// braked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ObjectiveViscosity(pub(crate) Hooke);

/// A `pull` is lambda times a projected rate of dilatation, where that takes the place of lambda tr(E').
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

    /// lambda times a projected `rate` tr(E'), and lambda.
    #[inline(always)]
    pub(crate) fn of_volume<T: Real>(&self, rate: T) -> [T; 2] {
        let [_, pull, stiff] = self.0.of_volume(rate);
        [pull, stiff]
    }

    /// First Piola stress P (Pa), times `weight`, the volume of the point.
    #[inline(always)]
    pub(crate) fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress(&at.twice_green_rate(rate), pull, weight))
    }

    /// dP/dF, as [`ElasticLaw::tangent`](crate::elements::material::ElasticLaw::tangent).
    ///
    /// The rate of strain changes with F, too, so that this is not symmetric:
    /// lambda f_a f'_b^T + mu ((g_a . g_b) F F'^T + f_b f'_a^T) + (g_a . S g_b) I, f'_a = F' g_a
    #[inline(always)]
    pub(crate) fn tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
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

    /// dP/dF', likewise, and symmetric; `is_projected` leaves out the part of a projected dilatation.
    #[inline(always)]
    pub(crate) fn rate_tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        is_projected: bool,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, T, N, M, D> {
        Spread::new(&at.gradient(), gradients, self.moduli_at_points(is_projected), weight)
    }

    #[inline(always)]
    fn moduli_at_points(&self, is_projected: bool) -> Lame {
        match is_projected {
            true => self.0.of_shear().lame,
            false => self.0.lame,
        }
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
