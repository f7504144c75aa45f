//! Viscosity that does not brake a body that spins as a whole: the interface of its laws, and which of them a cell has.

use super::hookean_viscosity::HookeanViscosity;
use super::newtonian::NewtonianViscosity;
use super::{Elastic, Hooke, Lame, Plane};
use crate::base::tensor::{Matrix, Real};
use crate::elements::material::Material;
use crate::elements::material::deformation::Deformation;
use crate::elements::material::law::Blocks;

/// A viscous stress that is linear in the rate F' of the deformation gradient F.
///
/// A `pull` takes the place of lambda times the rate of dilatation, if that is projected onto few functions of the cell.
pub(crate) trait ViscousLaw {
    /// The viscous moduli (Pa s), and what is assumed across the cell.
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

    /// dP/dF', likewise, and symmetric; `is_projected` leaves out the part of a projected dilatation.
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

    /// The moduli of what acts at the points of a cell.
    #[inline(always)]
    fn moduli_at_points(&self, is_projected: bool) -> Lame {
        match is_projected {
            true => self.hooke().of_shear().lame,
            false => self.hooke().lame,
        }
    }
}

/// Objective viscosity of a cell, by its elastic law.
///
/// Hooke's law for Green's strain resists a change of tr E, and motions of nearly incompressible material keep that: the
/// viscous stress is that law's for the rate of Green's strain. Under all other laws motions keep the volume, or nearly, while
/// tr E' grows with the stretch: there the stress is that of a Newtonian fluid.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ObjectiveViscosity {
    Hookean(HookeanViscosity),
    Newtonian(NewtonianViscosity),
}

impl ObjectiveViscosity {
    /// Beside the law `elastic` of cells of `dimension`.
    pub(crate) fn new(
        elastic: &Elastic,
        material: &Material,
        dimension: usize,
        plane: Plane,
    ) -> Self {
        let hooke = Hooke::new(material.viscous(), dimension, plane);
        match elastic {
            Elastic::StVenantKirchhoff(_) => Self::Hookean(HookeanViscosity(hooke)),
            // a free thickness follows the motion, whatever the bulk viscosity is
            _ if hooke.is_free_across(dimension) => Self::Newtonian(NewtonianViscosity(hooke)),
            _ => {
                let lame = material.bounded_viscous();
                Self::Newtonian(NewtonianViscosity(Hooke::new(lame, dimension, plane)))
            }
        }
    }

    /// The same of cells of `dimension` that grow: a Newtonian fluid without bulk viscosity, which growth alike in all
    /// directions does not feel.
    pub(crate) fn of_growing(&self, dimension: usize) -> Self {
        let hooke = self.hooke();
        let lame = match hooke.is_free_across(dimension) {
            true => hooke.lame,
            false => Lame { lambda: -2.0 / 3.0 * hooke.lame.mu, ..hooke.lame },
        };
        Self::Newtonian(NewtonianViscosity(Hooke { lame, ..*hooke }))
    }

    /// None.
    pub(crate) fn zero(dimension: usize, plane: Plane) -> Self {
        let lame = Lame { lambda: 0.0, mu: 0.0 };
        Self::Hookean(HookeanViscosity(Hooke::new(lame, dimension, plane)))
    }

    fn hooke(&self) -> &Hooke {
        match self {
            Self::Hookean(law) => law.hooke(),
            Self::Newtonian(law) => law.hooke(),
        }
    }
}
