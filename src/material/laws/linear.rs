//! Linear elasticity: Hooke's law for Cauchy's small strain.

use crate::material::deformation::Deformation;
use crate::material::hooke::{Hooke, Spread};
use crate::material::law::{Blocks, DilatationalLaw, ElasticLaw};
use crate::tensor::{Matrix, Real, product, times, trace};

/// W = lambda tr(E)^2 / 2 + mu E : E, P = F_0 S with E = sym(F_0^T H), S = lambda tr(E) I + 2 mu E.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Linear(pub(crate) Hooke);

impl ElasticLaw for Linear {
    const SMALL_STRAIN: bool = true;

    #[inline(always)]
    fn energy<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        self.0.energy(&at.twice_cauchy())
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.frame(), &self.0.stress(&at.twice_cauchy(), weight))
    }

    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Spread::new(&at.frame(), gradients, self.0.lame, weight)
    }

    #[inline(always)]
    fn across<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> [T; 2] {
        self.0.across(&at.twice_cauchy())
    }
}

/// g = tr E
impl DilatationalLaw for Linear {
    #[inline(always)]
    fn dilatation<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        trace(&at.twice_cauchy()) * 0.5
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
        self.0.of_shear().energy(&at.twice_cauchy())
    }

    #[inline(always)]
    fn stress_under<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.frame(), &self.0.stress_under(&at.twice_cauchy(), pull, weight))
    }

    #[inline(always)]
    fn tangent_under<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _pull: T,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Spread::new(&at.frame(), gradients, self.0.of_shear().lame, weight)
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
        times(product(&at.frame(), gradients), weight)
    }
}
