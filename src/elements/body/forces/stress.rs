//! Stress terms at the points of cells: elastic laws and viscosity, pointwise or with a projected dilatation.

use crate::base::tensor::{Matrix, Real};
use crate::elements::material::{CellLaw, Deformation, ViscousLaw};

/// A stress at a point, by the gradients of `K` fields: of displacements and, if K is 2, of velocities.
pub(in crate::elements::body) trait StressTerm<const K: usize> {
    /// Whether the dilatation is a projected one.
    fn is_projected(&self) -> bool;

    /// First Piola stress P times the `volume` of the point, with the `pull` of a projected dilatation if there
    /// is one, and a number that is above 0 where the stress has meaning.
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[Matrix<T, D, M>; K],
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T);

    /// The dilatation of a point, or its rate.
    fn dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[Matrix<T, D, M>; K],
    ) -> T;

    /// The `pull` of a projected dilatation where it has this value.
    fn of_volume<T: Real>(&self, dilatation: T) -> T;

    /// The message for a cell where the number of [`Self::stress`] is not above 0.
    fn outside(&self, domain: f64) -> String;
}

/// The stress of an elastic law.
pub(in crate::elements::body) struct ElasticStress<'l, L> {
    pub(in crate::elements::body) law: &'l L,
    pub(in crate::elements::body) is_projected: bool,
}

impl<L: CellLaw> StressTerm<1> for ElasticStress<'_, L> {
    #[inline(always)]
    fn is_projected(&self) -> bool {
        self.is_projected
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        self.law.piola(at, pull, volume)
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 1],
    ) -> T {
        self.law.dilatation_at(at)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> T {
        let [_, pull, _] = self.law.of_projected(dilatation);
        pull
    }

    fn outside(&self, domain: f64) -> String {
        self.law.outside_at(domain)
    }
}

/// Viscous stress.
pub(super) struct ViscousStress<'l, L> {
    pub(super) law: &'l L,
    pub(super) is_projected: bool,
}

impl<L: ViscousLaw> StressTerm<2> for ViscousStress<'_, L> {
    #[inline(always)]
    fn is_projected(&self) -> bool {
        self.is_projected
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        (self.law.stress(at, rate, pull, volume), volume.constant(1.0))
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rate]: &[Matrix<T, D, M>; 2],
    ) -> T {
        self.law.rate_of_dilatation(at, rate)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, rate: T) -> T {
        let [pull, _] = self.law.of_volume(rate);
        pull
    }

    /// It has meaning wherever the elastic law has.
    fn outside(&self, _: f64) -> String {
        String::new()
    }
}
