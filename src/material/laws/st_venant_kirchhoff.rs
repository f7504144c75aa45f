//! St. Venant-Kirchhoff material: Hooke's law for Green's strain.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use crate::material::deformation::Deformation;
use crate::material::hooke::{Hooke, Spread};
use crate::material::law::{Block, Blocks, DilatationalLaw, ElasticLaw};
use crate::tensor::{Matrix, Real, dot, product, times, trace};

/// W = lambda tr(E)^2 / 2 + mu E : E, P = F S with E = (F^T F - I) / 2, S = lambda tr(E) I + 2 mu E.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StVenantKirchhoff(pub(super) Hooke);

impl ElasticLaw for StVenantKirchhoff {
    #[inline(always)]
    fn energy<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        self.0.energy(&at.twice_green())
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress(&at.twice_green(), weight))
    }

    /// lambda f_a f_b^T + mu ((g_a . g_b) F F^T + f_b f_a^T) + (g_a . S g_b) I, f_a = F g_a
    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let spread = Spread::new(&at.gradient(), gradients, self.0.lame, weight);
        let stress = self.0.stress(&at.twice_green(), weight.constant(1.0));
        Tangent { spread, pulls: product(&stress, gradients) }
    }

    #[inline(always)]
    fn across<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> [T; 2] {
        self.0.across(&at.twice_green())
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        at.stretch()
    }

    fn outside(&self, domain: f64) -> String {
        format!(
            "is inverted, det F = {domain:.3}: St. Venant-Kirchhoff material collapses under strong \
             compression; load it less or refine the mesh there"
        )
    }
}

/// g = tr E
impl DilatationalLaw for StVenantKirchhoff {
    #[inline(always)]
    fn dilatation<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        trace(&at.twice_green()) * 0.5
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        self.0.of_volume(dilatation)
    }

    #[inline(always)]
    fn energy_of_rest<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T {
        self.0.of_shear().energy(&at.twice_green())
    }

    #[inline(always)]
    fn stress_under<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress_under(&at.twice_green(), pull, weight))
    }

    #[inline(always)]
    fn tangent_under<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let shear = self.0.of_shear();
        let spread = Spread::new(&at.gradient(), gradients, shear.lame, weight);
        let stress = shear.stress_under(&at.twice_green(), pull, weight.constant(1.0));
        Tangent { spread, pulls: product(&stress, gradients) }
    }

    /// No shear there, and no strain.
    #[inline(always)]
    fn across_under<T: Real, const M: usize, const D: usize>(
        &self,
        _at: &Deformation<T, M, D>,
        pull: T,
    ) -> [T; 2] {
        [pull.constant(0.0), pull]
    }

    #[inline(always)]
    fn swelling_by_nodes<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> [[T; D]; N] {
        times(product(&at.gradient(), gradients), weight)
    }
}

struct Tangent<'a, T, const N: usize, const M: usize, const D: usize> {
    spread: Spread<'a, T, N, M, D>,
    /// S g_a
    pulls: [[T; M]; N],
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Tangent<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let mut block = self.spread.material(a, b);
        let geometric = dot(&self.spread.gradients[a], &self.pulls[b]);
        for i in 0..D {
            block[i][i] += geometric;
        }
        times(block, self.spread.weight)
    }
}
