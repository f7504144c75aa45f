//! What a material law is: the one formula for energy, stress and tangent that forces, tangents of
//! forces and fields take.
//!
//! Laws see one point of a cell of dimension `M` in a space of dimension `D`. They are written over a
//! number `T` that may be a lane of several points, so no branch may depend on a value: where a law has
//! meaning is a number of its own ([`ElasticLaw::domain`]), apart from its stress.

use super::deformation::Deformation;
use crate::tensor::{Matrix, Real};

/// A block of a tangent, row by row.
pub(crate) type Block<T, const D: usize> = [[T; D]; D];

/// A tangent at one point of a cell.
pub(crate) trait Blocks<T, const D: usize> {
    /// The block of two nodes, by their numbers in the cell.
    fn block(&self, a: usize, b: usize) -> Block<T, D>;
}

/// A hyperelastic law: strain energy W(F) per natural volume and its derivatives.
pub(crate) trait ElasticLaw {
    /// Whether strains are taken for small, so that natural and present shape count as one.
    const SMALL_STRAIN: bool = false;

    /// W (J/m^3)
    fn energy<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T;

    /// First Piola stress P = dW/dF (Pa), times `weight`, the volume of the point.
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        weight: T,
    ) -> Matrix<T, D, M>;

    /// dP/dF, as the stiffness between two nodes: with the `gradients` g of their shape functions, the
    /// block of nodes a and b has the entries sum_jl g_a[j] dP_ij/dF_kl g_b[l], times `weight`. That of b and a is the
    /// same transposed, as P has a potential.
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D>;

    /// Strain and stress (Pa) across a cell that does not fill space.
    fn across<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> [T; 2];

    /// A number above 0 where the law has meaning, such as det F.
    fn domain<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        at.h[0][0].constant(1.0)
    }

    /// Says of a cell whose `domain` is not above 0 what happened to it.
    fn outside(&self, domain: f64) -> String {
        format!("is deformed beyond what its material law describes ({domain:.3})")
    }
}

/// A law whose resistance to a change of volume is apart, W = W_rest + U(g), with a measure g of the volume that is 0 at rest, so
/// that U may be given the mean of g over a cell ("mean dilatation") in place of g at each point.
pub(crate) trait DilatationalLaw: ElasticLaw {
    /// g
    fn dilatation<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T;

    /// U (J/m^3), U' and U'' at g.
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3];

    /// W_rest (J/m^3)
    fn energy_of_rest<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T;

    /// First Piola stress with `pull` in place of U'(g), times `weight`.
    fn stress_under<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
        weight: T,
    ) -> Matrix<T, D, M>;

    /// The derivative of that by F, as [`ElasticLaw::tangent`]; `pull` stays as it is.
    fn tangent_under<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D>;

    /// As [`ElasticLaw::across`], with `pull` in place of U'(g).
    fn across_under<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: T,
    ) -> [T; 2];

    /// How g follows the nodes: dg/dF times the `gradients` of their shape functions, times `weight`.
    fn swelling_by_nodes<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> [[T; D]; N];
}

/// A viscous law: stress from the rate of deformation F'.
pub(crate) trait ViscousLaw {
    /// First Piola stress P (Pa), times `weight`, the volume of the point.
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        weight: T,
    ) -> Matrix<T, D, M>;

    /// dP/dF, as [`ElasticLaw::tangent`].
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D>;

    /// dP/dF', likewise, and symmetric.
    fn rate_tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D>;
}
