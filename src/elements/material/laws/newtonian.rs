//! A Newtonian fluid beside the elasticity: viscosity by the rate of deformation of the present shape.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::invariants::{invariants_of, inverse_of};
use super::viscous::ViscousLaw;
use crate::base::tensor::{Matrix, Real, dot, product, product_transposed, symmetric, times};
use crate::elements::material::deformation::Deformation;
use crate::elements::material::hooke::{Hooke, Lame};
use crate::elements::material::law::{Block, Blocks};

/// The Kirchhoff stress J sigma = lambda tr(d) I + 2 mu d with the rate of deformation d = sym(F' F^-1), whose trace is J'/J: a
/// motion that keeps the volume is independent of lambda, for any size of it and of the strain. The heat lambda tr(d)^2 + 2 mu d : d is
/// never below 0 while lambda + 2 mu / 3 is not (C. Truesdell, W. Noll, *The Non-Linear Field Theories of Mechanics*, section 119).
///
/// In the coordinates of a cell, which need not fill space, with A = C^-1: P = F S, S = lambda tr(A E') A + 2 mu A E' A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NewtonianViscosity(pub(crate) Hooke);

/// Values that the formulas at a point share.
struct Moving<T, const M: usize, const D: usize> {
    f: Matrix<T, D, M>,
    /// A
    inverse: Matrix<T, M, M>,
    /// 2 E' A
    mixed: Matrix<T, M, M>,
    /// tr(A E')
    dilatation: T,
}

impl<T: Real, const M: usize, const D: usize> Moving<T, M, D> {
    #[inline(always)]
    fn new(at: &Deformation<T, M, D>, rate: &Matrix<T, D, M>) -> Self {
        let inverse = inverse(at);
        let mixed = product(&at.twice_green_rate(rate), &inverse);
        let mut twice = mixed[0][0];
        for j in 1..M {
            twice += mixed[j][j];
        }
        Self { f: at.gradient(), inverse, mixed, dilatation: twice * 0.5 }
    }

    /// 2 A E' A
    #[inline(always)]
    fn raised(&self) -> Matrix<T, M, M> {
        let both = product(&self.inverse, &self.mixed);
        symmetric!(self.dilatation; j, k => both[j][k])
    }

    /// m_a = F' A g_a - F Q g_a; F Q is `pushed`.
    #[inline(always)]
    fn moving<const N: usize>(
        &self,
        rate: &Matrix<T, D, M>,
        pushed: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
    ) -> [[T; D]; N] {
        let mut moving = product(&product(rate, &self.inverse), gradients);
        let pulls = product(pushed, gradients);
        for a in 0..N {
            for i in 0..D {
                moving[a][i] = moving[a][i] - pulls[a][i];
            }
        }
        moving
    }
}

/// A = C^-1
#[inline(always)]
fn inverse<T: Real, const M: usize, const D: usize>(at: &Deformation<T, M, D>) -> Matrix<T, M, M> {
    let twice = at.twice_green();
    let [trace, minors, determinant] = invariants_of(&twice);
    inverse_of(&twice, trace + minors + determinant + 1.0)
}

impl ViscousLaw for NewtonianViscosity {
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
        Moving::new(at, rate).dilatation
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, D, M> {
        let Lame { lambda, mu } = self.0.lame;
        let at = Moving::new(at, rate);
        let mean = pull.unwrap_or(at.dilatation * lambda) * weight;
        let (raised, shear) = (at.raised(), weight * mu);
        let stress = symmetric!(mean; j, k => at.inverse[j][k] * mean + raised[j][k] * shear);
        product(&at.f, &stress)
    }

    /// With f_a = F A g_a, Q = 2 A E' A, w_a = F Q g_a, m_a = F' A g_a - w_a and p = lambda tr(A E'):
    ///
    /// ```text
    /// lambda f_a m_b^T - p f_b f_a^T + mu ((f_a . f_b) (F A F'^T - F Q F^T) + f_b m_a^T - w_b f_a^T)
    ///   + (p (f_a . f_b) + mu (g_a . Q g_b)) (I - F A F^T)
    /// ```
    #[inline(always)]
    fn tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, T, N, M, D> {
        let at = Moving::new(at, rate);
        let (raised, lame) = (at.raised(), self.moduli_at_points(pull.is_some()));
        let spatial = product(&at.f, &at.inverse);
        let pushed = product(&at.f, &raised);
        let mut turning = product_transposed(&spatial, rate);
        let minus = product_transposed(&pushed, &at.f);
        for i in 0..D {
            for k in 0..D {
                turning[k][i] = turning[k][i] - minus[k][i];
            }
        }
        Tangent {
            gradients,
            along: product(&spatial, gradients),
            moving: at.moving(rate, &pushed, gradients),
            pulls: product(&pushed, gradients),
            turning,
            raised: product(&raised, gradients),
            outside: outside(&spatial, &at.f),
            mean: pull.unwrap_or(at.dilatation * lame.lambda),
            lame,
            weight,
        }
    }

    /// lambda f_a f_b^T + mu ((f_a . f_b) F A F^T + f_b f_a^T)
    #[inline(always)]
    fn rate_tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        is_projected: bool,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, T, N, M, D> {
        let f = at.gradient();
        let spatial = product(&f, &inverse(at));
        RateTangent {
            along: product(&spatial, gradients),
            outside: outside(&spatial, &f),
            lame: self.moduli_at_points(is_projected),
            weight,
        }
    }

    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
    ) -> [[[T; D]; N]; 2] {
        let at = Moving::new(at, rate);
        let spatial = product(&at.f, &at.inverse);
        let pushed = product(&at.f, &at.raised());
        [product(&spatial, gradients), at.moving(rate, &pushed, gradients)]
    }
}

/// I - F A F^T, which is 0 where the cell fills space; F A is `spatial`.
#[inline(always)]
fn outside<T: Real, const M: usize, const D: usize>(
    spatial: &Matrix<T, D, M>,
    f: &Matrix<T, D, M>,
) -> Matrix<T, D, D> {
    let zero = f[0][0].constant(0.0);
    if const { M == D } {
        return [[zero; D]; D];
    }
    let mut outside = product_transposed(spatial, f);
    for i in 0..D {
        for k in 0..D {
            let own = zero.constant(if i == k { 1.0 } else { 0.0 });
            outside[k][i] = own - outside[k][i];
        }
    }
    outside
}

struct Tangent<'a, T, const N: usize, const M: usize, const D: usize> {
    gradients: &'a [[T; M]; N],
    /// f_a
    along: [[T; D]; N],
    /// m_a
    moving: [[T; D]; N],
    /// w_a
    pulls: [[T; D]; N],
    /// F A F'^T - F Q F^T
    turning: Matrix<T, D, D>,
    /// Q g_a
    raised: [[T; M]; N],
    /// I - F A F^T
    outside: Matrix<T, D, D>,
    /// p
    mean: T,
    lame: Lame,
    weight: T,
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Tangent<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let Self { along, moving, pulls, turning, outside, mean, .. } = self;
        let Lame { lambda, mu } = self.lame;
        let stretch = dot(&along[a], &along[b]);
        let mut across = stretch;
        if const { M != D } {
            let shear = dot(&self.gradients[a], &self.raised[b]) * mu;
            across = *mean * stretch + shear;
        }
        let mut block = [[stretch; D]; D];
        for i in 0..D {
            for k in 0..D {
                let shear = turning[k][i] * stretch + along[b][i] * moving[a][k]
                    - pulls[b][i] * along[a][k];
                block[i][k] = along[a][i] * moving[b][k] * lambda + shear * mu
                    - *mean * along[b][i] * along[a][k];
                if const { M != D } {
                    block[i][k] += across * outside[i][k];
                }
            }
        }
        times(block, self.weight)
    }
}

struct RateTangent<T, const N: usize, const D: usize> {
    /// f_a
    along: [[T; D]; N],
    /// I - F A F^T
    outside: Matrix<T, D, D>,
    lame: Lame,
    weight: T,
}

impl<T: Real, const N: usize, const D: usize> Blocks<T, D> for RateTangent<T, N, D> {
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let (fa, fb) = (&self.along[a], &self.along[b]);
        let Lame { lambda, mu } = self.lame;
        let stretch = dot(fa, fb);
        let mut block = [[stretch; D]; D];
        for i in 0..D {
            for k in 0..D {
                let own = stretch.constant(if i == k { 1.0 } else { 0.0 });
                let shear = (own - self.outside[i][k]) * stretch + fb[i] * fa[k];
                block[i][k] = fa[i] * fb[k] * lambda + shear * mu;
            }
        }
        times(block, self.weight)
    }
}
