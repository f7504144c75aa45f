//! St. Venant-Kirchhoff material: Hooke's law for Green's strain.

use crate::material::deformation::Deformation;
use crate::material::hooke::{Hooke, Spread};
use crate::material::law::{Block, ElasticLaw};
use crate::tensor::{Matrix, Real, dot, product, times};

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
    ) -> impl Fn(usize, usize) -> Block<T, D> {
        let spread = Spread::new(&at.gradient(), gradients);
        let stress = self.0.stress(&at.twice_green(), weight.constant(1.0));
        let pulls = product(&stress, gradients);
        move |a, b| {
            let mut block = spread.material(self.0.lame, a, b);
            let geometric = dot(&gradients[a], &pulls[b]);
            (0..D).for_each(|i| block[i][i] += geometric);
            times(block, weight)
        }
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
