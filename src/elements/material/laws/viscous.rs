//! Viscosity that does not brake a body that spins as a whole: the interface of its laws.

use crate::base::tensor::{Matrix, Real};
use crate::elements::material::deformation::Deformation;
use crate::elements::material::hooke::{Hooke, Lame};
use crate::elements::material::law::Blocks;

/// A viscous stress that is linear in the rate F' of the deformation gradient F.
///
/// A `pull` takes the place of lambda times the rate of dilatation, if that is projected onto few functions of the cell.
pub(crate) trait ViscousLaw {
    /// The viscous moduli (Pa s), and the assumption across the cell.
    fn hooke(&self) -> &Hooke;

    /// Rate of dilatation (1/s): the trace of the rate of strain of the law.
    fn rate_of_dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
    ) -> T;

    /// First Piola stress P (Pa), times `weight`, the volume of the point.
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, D, M>;

    /// dP/dF, as [`ElasticLaw::tangent`](crate::elements::material::ElasticLaw::tangent), with the `pull` kept constant. The
    /// rate of strain changes with F, too, so that this is not symmetric.
    fn tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        pull: Option<T>,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, Self, T, N, M, D>;

    /// dP/dF', likewise, and symmetric; `is_projected` omits the part of a projected dilatation.
    fn rate_tangent<'a, T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        is_projected: bool,
        gradients: &'a [[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> + use<'a, Self, T, N, M, D>;

    /// Derivatives by the nodes of the rate of dilatation: by their velocities, which is that of their forces by the
    /// `pull`, too, and by their displacements.
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
    ) -> [[[T; D]; N]; 2];

    /// lambda times a projected `rate` of dilatation, and lambda.
    #[inline(always)]
    fn of_volume<T: Real>(&self, rate: T) -> [T; 2] {
        let [_, pull, stiff] = self.hooke().of_volume(rate);
        [pull, stiff]
    }

    /// The moduli of the pointwise stress: without the bulk part if that is projected.
    #[inline(always)]
    fn moduli_at_points(&self, is_projected: bool) -> Lame {
        match is_projected {
            true => self.hooke().of_shear().lame,
            false => self.hooke().lame,
        }
    }
}
