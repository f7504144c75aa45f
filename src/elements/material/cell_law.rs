//! Interface of elastic laws for loops over cells: by the deformation of a point, whether their formulas are compiled into
//! the loop or are called.

use super::deformation::Deformation;
use super::law::{Blocks, ElasticLaw};
use super::laws::ByPoint;
use super::response::Tangent;
use crate::base::tensor::{Matrix, Real, product};

/// A law at a point of a cell. A `pull` is that of a projected dilatation, as in [`ElasticLaw`].
pub(crate) trait CellLaw {
    /// W (J/m^3), with U at the point.
    fn energy_at<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T;

    /// W_shape (J/m^3) and the dilatation g.
    fn shape_and_volume<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> [T; 2];

    /// First Piola stress P (Pa) times the `volume` of the point, and a number above 0 where the law has meaning.
    fn piola<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T);

    /// dP/dF between two nodes, times the `volume` of the point.
    fn tangent_at<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D>;

    /// The dilatation g.
    fn dilatation_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T;

    /// The dilatation g and dg/dF.
    fn swelling_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> (T, Matrix<T, D, M>);

    /// U (J/m^3), U' and U'' of a projected dilatation.
    fn of_projected<T: Real>(&self, dilatation: T) -> [T; 3];

    /// A description of the failure of a cell whose number of [`Self::piola`] is not above 0.
    fn outside_at(&self, domain: f64) -> String;
}

/// Formulas are compiled into the loop.
impl<L: ElasticLaw> CellLaw for L {
    #[inline(always)]
    fn energy_at<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        self.energy(&self.point(L::twice_strain(at)))
    }

    #[inline(always)]
    fn shape_and_volume<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> [T; 2] {
        let point = self.point(L::twice_strain(at));
        [self.energy_of_shape(&point), self.dilatation(&point)]
    }

    #[inline(always)]
    fn piola<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        let point = self.point(L::twice_strain(at));
        let stress = product(&L::shape(at), &self.stress(&point, pull, volume));
        (stress, self.domain(at.stretch(), &point))
    }

    #[inline(always)]
    fn tangent_at<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        self.tangent(L::shape(at), self.point(L::twice_strain(at)), pull, gradients, volume)
    }

    #[inline(always)]
    fn dilatation_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T {
        self.dilatation(&self.point(L::twice_strain(at)))
    }

    #[inline(always)]
    fn swelling_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> (T, Matrix<T, D, M>) {
        let point = self.point(L::twice_strain(at));
        (self.dilatation(&point), product(&L::shape(at), &self.swelling(&point)))
    }

    #[inline(always)]
    fn of_projected<T: Real>(&self, dilatation: T) -> [T; 3] {
        self.of_volume(dilatation)
    }

    fn outside_at(&self, domain: f64) -> String {
        self.outside(domain)
    }
}

/// Formulas are called.
impl CellLaw for ByPoint {
    #[inline(always)]
    fn energy_at<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        self.energy(&at.twice_green())
    }

    #[inline(always)]
    fn shape_and_volume<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> [T; 2] {
        self.shape_and_volume(&at.twice_green())
    }

    #[inline(always)]
    fn piola<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        let (stress, domain) = self.stress(&at.twice_green(), at.stretch(), pull, volume);
        (product(&at.gradient(), &stress), domain)
    }

    #[inline(always)]
    fn tangent_at<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        let response = self.response(&at.twice_green(), pull);
        Tangent::new(&at.gradient(), &response, gradients, volume)
    }

    #[inline(always)]
    fn dilatation_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T {
        self.dilatation(&at.twice_green())
    }

    #[inline(always)]
    fn swelling_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> (T, Matrix<T, D, M>) {
        let (dilatation, swelling) = self.swelling(&at.twice_green());
        (dilatation, product(&at.gradient(), &swelling))
    }

    #[inline(always)]
    fn of_projected<T: Real>(&self, dilatation: T) -> [T; 3] {
        self.of_volume(dilatation)
    }

    fn outside_at(&self, domain: f64) -> String {
        self.outside(domain)
    }
}
