//! The active stress of fibres by Hill's law, and its tangents: it depends on their length, and on its rate.
//!
//! With f = F a, the stretch l = |f|, n = f/l, its rate l' = n . f' and the stress per natural section p(l, l'), the first Piola stress is p n a^T, so that
//!
//! ```text
//! d(p n)/df  = dp/dl n n^T + dp/dl' n (f' - l' n)^T / l + (p/l) (I - n n^T)
//! d(p n)/df' = dp/dl' n n^T
//! ```

use super::elements::{ElementsOf, gradients};
use super::forces::{StressTerm, relative};
use super::tangents::TangentTerm;
use crate::base::tensor::{Matrix, Real, dot, times};
use crate::elements::basis::StrainPoint;
use crate::elements::material::{Block, Blocks, Deformation, Hill};

/// Active fibres of a law.
#[derive(Clone, Copy)]
pub(crate) struct Contraction<'l> {
    pub(crate) law: &'l Hill,
    /// Activation times the largest stress (Pa).
    pub(crate) stress: f64,
}

/// Kinematics and active stress at a point of a fibre.
struct AtPoint<T, const D: usize> {
    /// l
    stretch: T,
    /// l' (1/s)
    rate: T,
    /// n
    direction: [T; D],
    /// p (Pa), dp/dl (Pa) and dp/dl' (Pa s)
    pull: [T; 3],
}

impl Contraction<'_> {
    #[inline(always)]
    fn at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        [_, rates]: &[Matrix<T, D, M>; 2],
    ) -> AtPoint<T, D> {
        let mut direction = at.gradient()[0];
        let stretch = (at.twice_green()[0][0] + 1.0).sqrt();
        for x in &mut direction {
            *x = *x / stretch;
        }
        let rate = dot(&direction, &rates[0]);
        let pull = T::each([stretch, rate], |[stretch, rate]| {
            let [of_force, by_stretch, by_rate] = self.law.factors(stretch, rate);
            [self.stress * of_force, self.stress * by_stretch, self.stress * by_rate]
        });
        AtPoint { stretch, rate, direction, pull }
    }
}

impl StressTerm<2> for Contraction<'_> {
    #[inline(always)]
    fn is_projected(&self) -> bool {
        false
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; 2],
        _: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        let AtPoint { stretch, direction, pull: [pull, ..], .. } = self.at(at, fields);
        (times(times([direction; M], pull), volume), stretch)
    }

    /// Fibres have no volume of their own.
    #[inline(always)]
    fn dilatation<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 2],
    ) -> T {
        at.h[0][0].constant(0.0)
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> T {
        dilatation.constant(0.0)
    }

    fn outside(&self, _: f64) -> String {
        "has fibres of a muscle that are pressed to nothing".into()
    }
}

/// The tangents of a contraction: that by velocities, or that by displacements.
pub(super) struct ContractionTangent<'l, const BY_RATE: bool>(pub(super) Contraction<'l>);

/// (g_a . g_b) times one matrix, along a fibre.
struct Along<'a, T, const N: usize, const M: usize, const D: usize> {
    gradients: &'a [[T; M]; N],
    matrix: Block<T, D>,
}

impl<T: Real, const N: usize, const M: usize, const D: usize> Blocks<T, D>
    for Along<'_, T, N, M, D>
{
    #[inline(always)]
    fn block(&self, a: usize, b: usize) -> Block<T, D> {
        let product = self.gradients[a][0] * self.gradients[b][0];
        times(self.matrix, product)
    }
}

impl<const BY_RATE: bool> TangentTerm<2> for ContractionTangent<'_, BY_RATE> {
    const IS_SYMMETRIC: bool = BY_RATE;

    #[inline(always)]
    fn is_projected(&self) -> bool {
        false
    }

    #[inline(always)]
    fn blocks<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        fields: &[Matrix<T, D, M>; 2],
        _: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        let AtPoint { stretch, rate, direction: n, pull: [pull, by_stretch, by_rate] } =
            self.0.at(at, fields);
        let across = pull / stretch;
        let mut matrix = [[volume; D]; D];
        for (i, row) in matrix.iter_mut().enumerate() {
            for (k, entry) in row.iter_mut().enumerate() {
                if BY_RATE {
                    *entry = by_rate * n[i] * n[k] * volume;
                    continue;
                }
                let turning = (fields[1][0][k] - rate * n[k]) / stretch;
                let mut sum = n[i] * ((by_stretch - across) * n[k] + by_rate * turning);
                if i == k {
                    sum += across;
                }
                *entry = sum * volume;
            }
        }
        Along { gradients, matrix }
    }

    /// Fibres have no volume of their own.
    #[inline(always)]
    fn swelling<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        _: &Deformation<T, M, D>,
        _: &[Matrix<T, D, M>; 2],
        _: &[[T; M]; N],
        volume: T,
    ) -> (T, [[T; D]; N], [[T; D]; N]) {
        let zero = volume.constant(0.0);
        (zero, [[zero; D]; N], [[zero; D]; N])
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 2] {
        [dilatation.constant(0.0); 2]
    }
}

impl<const N: usize, const D: usize, const Q: usize> ElementsOf<N, 1, D, Q> {
    /// The integral of the stress p over the volume of these fibres (N m).
    pub(super) fn total_pull(&self, contraction: Contraction, u: &[f64], v: &[f64]) -> f64 {
        let fields = [u.as_chunks::<D>().0, v.as_chunks::<D>().0];
        let of_cell = |cell: usize| {
            let x = fields.map(|field| relative(&self.nodes[cell], field));
            let of_point = |point: StrainPoint<f64, N, 1, D>| {
                let fields = gradients(1, &x, &point.gradients);
                let at = Deformation::new(point.frame, fields[0]);
                point.volume * contraction.at(&at, &fields).pull[0]
            };
            self.points(cell).map(of_point).sum::<f64>()
        };
        (0..self.nodes.len()).map(of_cell).sum()
    }
}
