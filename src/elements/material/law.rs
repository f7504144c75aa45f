//! Interface of material laws: one formula for energy, stress and tangent, shared by forces, tangents of forces
//! and fields.
//!
//! Laws are evaluated at one point of a cell of dimension `M`, by its strain in the coordinates of the cell. They are
//! generic over a number `T` that may be a lane of several points, so no branch may depend on a value: where
//! a law is defined is given by a separate number ([`ElasticLaw::domain`]), not by its stress.
//!
//! A cell outside of the domain (det F <= 0) makes the evaluation fail recoverably, with the name of the
//! cell: the integrator tries a smaller step, and the run ends with that message if none helps.

use super::deformation::Deformation;
use crate::base::tensor::{Matrix, Real};

/// A block of a tangent, row by row.
pub(crate) type Block<T, const D: usize> = [[T; D]; D];

/// A tangent at one point of a cell.
pub(crate) trait Blocks<T, const D: usize> {
    /// The block of two nodes, by their numbers in the cell.
    fn block(&self, a: usize, b: usize) -> Block<T, D>;
}

/// A hyperelastic law: strain energy W per natural volume as a function of the strain E, and its derivatives.
///
/// Its resistance to a change of volume is a separate term: W = W_shape + U(g), with a measure g of the
/// volume that is 0 at rest. So U may be given a projection of g onto few functions of a cell ("projected
/// dilatation", such as its mean) in place of g at each point; then `pull` is U' of that, projected in turn, else `None`.
pub(crate) trait ElasticLaw {
    /// Whether strains are assumed small: then E is Cauchy's strain, and natural and present shape count as
    /// the same; else E is Green's.
    const SMALL_STRAIN: bool = false;

    /// The values at a point that the formulas share.
    type Point<T: Real, const M: usize>;

    /// These values at a point with `twice` the strain E.
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Self::Point<T, M>;

    /// W (J/m^3), with U at the point.
    fn energy<T: Real, const M: usize>(&self, at: &Self::Point<T, M>) -> T;

    /// W_shape (J/m^3)
    fn energy_of_shape<T: Real, const M: usize>(&self, at: &Self::Point<T, M>) -> T;

    /// g
    fn dilatation<T: Real, const M: usize>(&self, at: &Self::Point<T, M>) -> T;

    /// dg/dE
    fn swelling<T: Real, const M: usize>(&self, at: &Self::Point<T, M>) -> Matrix<T, M, M>;

    /// U (J/m^3), U' and U'' at g.
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3];

    /// Second Piola stress S = dW/dE (Pa), times `weight`, the volume of the point.
    fn stress<T: Real, const M: usize>(
        &self,
        at: &Self::Point<T, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M>;

    /// dP/dF of the first Piola stress P = F S, as the stiffness between two nodes: with the `gradients` g of
    /// their shape functions, the block of nodes a and b has the entries sum_jl g_a[j] dP_ij/dF_kl g_b[l],
    /// times `weight`. That of b and a is the same transposed, as P has a potential. A `pull` is kept
    /// constant.
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        f: Matrix<T, D, M>,
        at: Self::Point<T, M>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D>;

    /// Strain and stress S (Pa) across a cell that does not fill space.
    fn across<T: Real, const M: usize>(&self, at: &Self::Point<T, M>, pull: Option<T>) -> [T; 2];

    /// Ratio of present to natural thickness, or section, of a cell that does not fill space.
    fn thickness<T: Real, const M: usize>(&self, at: &Self::Point<T, M>) -> T;

    /// A number above 0 where the law has meaning, such as det F, with the `stretch` of the cell.
    fn domain<T: Real, const M: usize>(&self, stretch: T, at: &Self::Point<T, M>) -> T;

    /// The message for a cell whose `domain` is not above 0.
    fn outside(&self, domain: f64) -> String;

    /// Twice the strain E of the law.
    #[inline(always)]
    fn twice_strain<T: Real, const M: usize, const D: usize>(
        at: &Deformation<T, M, D>,
    ) -> Matrix<T, M, M> {
        match Self::SMALL_STRAIN {
            true => at.twice_cauchy(),
            false => at.twice_green(),
        }
    }

    /// F in P = F S: where strains are small the present shape counts as the natural one.
    #[inline(always)]
    fn shape<T: Real, const M: usize, const D: usize>(
        at: &Deformation<T, M, D>,
    ) -> Matrix<T, D, M> {
        match Self::SMALL_STRAIN {
            true => at.frame(),
            false => at.gradient(),
        }
    }
}
