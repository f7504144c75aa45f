//! The law of cells that grow by direction: F = F_e G, with the energy det(G) W(F_e) per natural volume and
//! G = g_a a a^T + g_t (I - a a^T).
//!
//! With C_e = G^-1 C G^-1 everything follows in the coordinates of the cell: S = det(G) G^-1 S_e G^-1 and dS/dE likewise. So F and the gradients of
//! the shape functions remain those of the cell, and the formulas of all laws are unchanged.
//!
//! Where there is no strain across a cell of two dimensions, growth is compressed there to the stretch 1/g_t: then the law is that of a
//! solid, which has the same formulas, and components across the cell are omitted from its stress.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::cell_law::CellLaw;
use super::deformation::Deformation;
use super::law::Blocks;
use super::laws::ByPoint;
use super::response::{Response, Tangent, axes};
use crate::base::tensor::{Matrix, Real, product, symmetric};

/// Growth stretches of stress-free material along the direction of growth, g_a, and across it, g_t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretches {
    pub(crate) along: f64,
    pub(crate) across: f64,
}

impl Stretches {
    /// det G
    pub(crate) fn volume(self) -> f64 {
        self.along * self.across * self.across
    }

    /// x along `a`, and y across it: x a a^T + y (I - a a^T).
    #[inline(always)]
    fn tensor<T: Real, const M: usize>([x, y]: [f64; 2], a: &[T; M]) -> Matrix<T, M, M> {
        let zero = a[0].constant(0.0);
        symmetric!(zero; j, k => {
            let share = a[j] * a[k] * (x - y);
            if j == k { share + y } else { share }
        })
    }

    /// G^-1 in the coordinates of a cell in which the direction is `a`.
    #[inline(always)]
    pub(crate) fn inverse<T: Real, const M: usize>(self, a: &[T; M]) -> Matrix<T, M, M> {
        Self::tensor([1.0 / self.along, 1.0 / self.across], a)
    }

    /// 2 E_e = G^-1 2E G^-1 + G^-2 - I, of `twice` the strain E.
    #[inline(always)]
    pub(crate) fn left<T: Real, const M: usize>(
        self,
        a: &[T; M],
        twice: &Matrix<T, M, M>,
    ) -> Matrix<T, M, M> {
        let mut left = sandwiched(&self.inverse(a), twice);
        let [x, y] = [self.along, self.across].map(|g| (1.0 - g) * (1.0 + g) / (g * g));
        let of_growth = Self::tensor([x, y], a);
        for j in 0..M {
            for k in 0..M {
                left[j][k] += of_growth[j][k];
            }
        }
        left
    }

    /// 2 E_e of a solid whose stretch across the cell is 1/g_t, of that along the cell.
    #[inline(always)]
    pub(crate) fn pressed<T: Real, const M: usize>(
        self,
        left: &Matrix<T, M, M>,
    ) -> Matrix<T, 3, 3> {
        let g = self.across;
        let across = left[0][0].constant((1.0 - g) * (1.0 + g) / (g * g));
        let mut solid = [[left[0][0].constant(0.0); 3]; 3];
        for j in 0..3 {
            for k in 0..3 {
                if j < M && k < M {
                    solid[j][k] = left[j][k];
                } else if j == k {
                    solid[j][k] = across;
                }
            }
        }
        solid
    }
}

/// A S A of two symmetric matrices.
#[inline(always)]
fn sandwiched<T: Real, const M: usize>(
    a: &Matrix<T, M, M>,
    s: &Matrix<T, M, M>,
) -> Matrix<T, M, M> {
    let both = product(a, &product(s, a));
    symmetric!(a[0][0]; j, k => both[j][k])
}

/// The part along a cell of a tensor of a solid.
#[inline(always)]
pub(crate) fn along_cell<T: Real, const M: usize>(solid: &Matrix<T, 3, 3>) -> Matrix<T, M, M> {
    symmetric!(solid[0][0]; j, k => solid[j][k])
}

/// The law of cells that have grown. Their frames [begin with the direction](Deformation::first_axis).
#[derive(Clone, Copy)]
pub(crate) struct GrownLaw<'l> {
    pub(crate) law: &'l ByPoint,
    pub(crate) stretches: Stretches,
    /// Whether there is no strain across the cell, of two dimensions.
    pub(crate) is_pressed: bool,
}

/// Evaluates a formula of the law at 2 E_e; for a cell in plane strain, `of_solid` reduces the value of the solid to its part along the
/// cell.
macro_rules! at_left {
    ($own:ident, $left:ident => $formula:expr, $value:ident => $of_solid:expr) => {
        if const { M == 2 } && $own.is_pressed {
            let $left = &$own.stretches.pressed($left);
            let $value = $formula;
            $of_solid
        } else {
            $formula
        }
    };
}

impl GrownLaw<'_> {
    /// G^-1 and 2 E_e
    #[inline(always)]
    fn left<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> [Matrix<T, M, M>; 2] {
        let a = at.first_axis();
        [self.stretches.inverse(&a), self.stretches.left(&a, &at.twice_green())]
    }

    /// The factor by which G changes the measure of the cell (length, area or volume) in the law.
    #[inline(always)]
    fn natural_stretch<const M: usize>(&self) -> f64 {
        let Stretches { along, across } = self.stretches;
        match M {
            1 => along,
            2 if !self.is_pressed => along * across,
            _ => self.stretches.volume(),
        }
    }

    /// S and dS/dE by E, of those by E_e, over det G.
    #[inline(always)]
    fn pulled_back<T: Real, const M: usize>(
        left: &Response<T, M>,
        inverse: &Matrix<T, M, M>,
    ) -> Response<T, M> {
        let components = M * (M + 1) / 2;
        // sum over both orders of the axes of a component
        let mut by = [[inverse[0][0]; 6]; 6];
        for v in 0..components {
            let (p, q) = axes::<M>(v);
            for w in 0..components {
                let (j, l) = axes::<M>(w);
                by[v][w] = inverse[j][p] * inverse[l][q];
                if p != q {
                    by[v][w] += inverse[j][q] * inverse[l][p];
                }
            }
        }
        let zero = inverse[0][0].constant(0.0);
        let (mut half, mut elasticity) = ([[zero; 6]; 6], [[zero; 6]; 6]);
        for v in 0..components {
            for w in 0..components {
                for x in 0..components {
                    half[v][w] += left.elasticity[v][x] * by[x][w];
                }
            }
        }
        for v in 0..components {
            for w in 0..components {
                for x in 0..components {
                    elasticity[v][w] += by[x][v] * half[x][w];
                }
            }
        }
        Response { stress: sandwiched(inverse, &left.stress), elasticity }
    }
}

/// The response along a cell of that of a solid.
#[inline(always)]
fn response_along<T: Real, const M: usize>(solid: &Response<T, 3>) -> Response<T, M> {
    let zero = solid.stress[0][0].constant(0.0);
    let mut elasticity = [[zero; 6]; 6];
    // the components of cells of two dimensions are these of solids
    let of_solid = [0, 1, 5];
    for v in 0..3 {
        for w in 0..3 {
            elasticity[v][w] = solid.elasticity[of_solid[v]][of_solid[w]];
        }
    }
    Response { stress: along_cell(&solid.stress), elasticity }
}

impl CellLaw for GrownLaw<'_> {
    #[inline(always)]
    fn energy_at<T: Real, const M: usize, const D: usize>(&self, at: &Deformation<T, M, D>) -> T {
        let [_, left] = &self.left(at);
        let energy = at_left!(self, left => self.law.energy(left), energy => energy);
        energy * self.stretches.volume()
    }

    #[inline(always)]
    fn shape_and_volume<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> [T; 2] {
        let [_, left] = &self.left(at);
        let [energy, dilatation] =
            at_left!(self, left => self.law.shape_and_volume(left), both => both);
        [energy * self.stretches.volume(), dilatation]
    }

    #[inline(always)]
    fn piola<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        volume: T,
    ) -> (Matrix<T, D, M>, T) {
        let [inverse, left] = &self.left(at);
        let stretch = at.stretch() * (1.0 / self.natural_stretch::<M>());
        let weight = volume * self.stretches.volume();
        let (stress, domain) = at_left!(
            self,
            left => self.law.stress(left, stretch, pull, weight),
            both => (along_cell(&both.0), both.1)
        );
        (product(&at.gradient(), &sandwiched(inverse, &stress)), domain)
    }

    #[inline(always)]
    fn tangent_at<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        volume: T,
    ) -> impl Blocks<T, D> {
        let [inverse, left] = &self.left(at);
        let response = at_left!(
            self,
            left => self.law.response(left, pull),
            solid => response_along(&solid)
        );
        let response = Self::pulled_back(&response, inverse);
        Tangent::new(&at.gradient(), &response, gradients, volume * self.stretches.volume())
    }

    #[inline(always)]
    fn dilatation_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> T {
        let [_, left] = &self.left(at);
        at_left!(self, left => self.law.dilatation(left), dilatation => dilatation)
    }

    #[inline(always)]
    fn swelling_at<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
    ) -> (T, Matrix<T, D, M>) {
        let [inverse, left] = &self.left(at);
        let (dilatation, swelling) = at_left!(
            self,
            left => self.law.swelling(left),
            both => (both.0, along_cell(&both.1))
        );
        (dilatation, product(&at.gradient(), &sandwiched(inverse, &swelling)))
    }

    /// Energies are per volume before growth, as all forces are; the `pull` is times their weight, which has that factor.
    #[inline(always)]
    fn of_projected<T: Real>(&self, dilatation: T) -> [T; 3] {
        let [energy, pull, stiff] = self.law.of_volume(dilatation);
        let volume = self.stretches.volume();
        [energy * volume, pull, stiff * volume]
    }

    fn outside_at(&self, domain: f64) -> String {
        self.law.outside(domain)
    }
}
