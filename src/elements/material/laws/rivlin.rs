//! Rubber: a polynomial in the invariants of the deformation without its change of volume, and an energy of
//! that change.
//!
//! Neo-Hookean, Mooney-Rivlin and Yeoh material are one law with other constants, so that one loop per kind
//! of cell is compiled for all. Differences such as I1 - 3, of second order in the strain, have their
//! first-order terms divided out by hand. Forces take one cube root a point, by Newton's method from a third
//! of the exponent, with the same bits on all machines, and no logarithm; energies take one. The tangent of a
//! cell with a free thickness needs no iteration. A [`Law`](super::Law) has ratios only: Young's modulus and
//! Poisson's ratio are those at small strains, so that time scales, constant matrices and checks go by one
//! pair of moduli. The loop over forces keeps these formulas inside, as a call would cost more
//! (`docs/notes/elements.md`).

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::invariants::{Strained, directions, invariants_of};
use super::volume::{less_logarithm, swollen};
use crate::base::tensor::{Matrix, Real, product, symmetric, times};
use crate::elements::material::hooke::Plane;
use crate::elements::material::law::{Blocks, ElasticLaw};
use crate::elements::material::response::{Elasticity, Response, Tangent, axes};

/// W = c10 (I1 - 3) + c20 (I1 - 3)^2 + c30 (I1 - 3)^3 + c01 (I2 - 3) + (kappa/4) (J^2 - 1 - 2 ln J), with the
/// invariants I1 and I2 of J^(-2/3) C: neo-Hookean with c10 alone, Mooney-Rivlin with c01, Yeoh with c20 and
/// c30 (G. A. Holzapfel, *Nonlinear Solid Mechanics*, chapter 6; the part of the volume: J. C. Simo, R. L.
/// Taylor, Computer Methods in Applied Mechanics and Engineering 85 (1991) 273-310).
///
/// All formulas use G = 2 E = C - I, so that small strains keep their digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rivlin {
    /// c10, c20, c30 (Pa)
    pub(super) first: [f64; 3],
    /// c01 (Pa)
    pub(super) second: f64,
    /// kappa (Pa)
    pub(super) bulk: f64,
    /// Assumption across a cell of less than three dimensions.
    pub(super) across: Plane,
}

impl Rivlin {
    /// G across a cell that is free to change its thickness: the one without stress there.
    #[inline(always)]
    fn free_across<T: Real, const M: usize>(&self, along: &Matrix<T, M, M>) -> T {
        let [trace, minors, _] = invariants_of(along);
        let [across] =
            T::each([trace, minors], |[trace, minors]| [self.without_stress::<M>(trace, minors)]);
        across
    }

    /// G across a cell of `M` dimensions with these invariants of G along it, by Newton's method in ln C
    /// across; NaN if there is none.
    fn without_stress<const M: usize>(&self, trace: f64, minors: f64) -> f64 {
        /// Most iterations: more than strains of any size take.
        const MOST: usize = 100;
        let m = directions::<M>();
        // det C and tr C along the cell
        let area = 1.0 + trace + minors;
        let in_plane = M as f64 + trace;
        // start: the volume does not change
        let mut c = area.powf(-1.0 / m);
        for _ in 0..MOST {
            let volume = area * c.powf(m);
            let i1 = in_plane + m * c;
            let i2 = m * c * in_plane + if M == 1 { c * c } else { area };
            let r = volume.powf(-1.0 / 3.0);
            let [w1, w11] = self.slopes(r * i1 - 3.0);
            // x, y: c dI1/dc and c dI2/dc of the invariants without volume, by one direction across; 2 (W1
            // x + W2 y) + J U' is S c
            let x = r * (c - i1 / 3.0);
            let y = r * r * (i1 * c - c * c - 2.0 / 3.0 * i2);
            let stress = 2.0 * (w1 * x + self.second * y) + 0.5 * self.bulk * (volume - 1.0);
            // derivatives by ln c, all directions across together
            let di1 = m * c;
            let di2 = m * c * in_plane + if M == 1 { 2.0 * c * c } else { 0.0 };
            let dr = -m / 3.0 * r;
            let dx = dr * (c - i1 / 3.0) + r * (c - di1 / 3.0);
            let dy = 2.0 * dr * r * (i1 * c - c * c - 2.0 / 3.0 * i2)
                + r * r * (di1 * c + i1 * c - 2.0 * c * c - 2.0 / 3.0 * di2);
            let slope = 2.0 * (w1 * dx + w11 * (dr * i1 + r * di1) * x + self.second * dy)
                + 0.5 * self.bulk * m * volume;
            let change = stress / slope;
            c *= (-change.clamp(-1.0, 1.0)).exp();
            if change.abs() < 1e-15 {
                return c - 1.0;
            }
        }
        f64::NAN
    }

    /// Derivatives of W by I1, the first and the second, at I1 - 3.
    #[inline(always)]
    fn slopes<T: Real>(&self, above: T) -> [T; 2] {
        let [c10, c20, c30] = self.first;
        [(above * (3.0 * c30) + 2.0 * c20) * above + c10, above * (6.0 * c30) + 2.0 * c20]
    }
}

impl Rivlin {
    /// J U'(J) and J^2 U''(J) at the point; with a `pull`, which is constant, J times it and 0.
    #[inline(always)]
    fn volume<T: Real, const M: usize>(&self, at: &Strained<T, M>, pull: Option<T>) -> [T; 2] {
        match pull {
            None => [at.swelling * (0.5 * self.bulk), (at.swelling + 2.0) * (0.5 * self.bulk)],
            Some(pull) => [pull * at.stretch(), pull.constant(0.0)],
        }
    }

    /// S, with `volume` for J U'(J).
    #[inline(always)]
    fn second_piola<T: Real, const M: usize>(
        &self,
        at: &Strained<T, M>,
        volume: T,
        weight: T,
    ) -> Matrix<T, M, M> {
        let [above, _] = at.above_rest();
        let [w1, _] = self.slopes(above);
        let square = product(&at.along, &at.along);
        let first = at.shrink * w1 * 2.0;
        let second = at.shrink * at.shrink * (2.0 * self.second);
        let zero = weight.constant(0.0);
        // (first part + volume I) in the product with C^-1
        let (first_rest, second_rest) = (at.first_slope(zero), at.second_slope(zero, zero));
        let second_share = at.invariants[0] + 1.0;
        let inner: Matrix<T, M, M> = symmetric!(zero; j, k => {
            let g = at.along[j][k];
            let sum = first * g + second * (second_share * g - square[j][k]);
            match j == k {
                true => sum + first * first_rest + second * second_rest + volume,
                false => sum,
            }
        });
        let stress = product(&at.inverse, &inner);
        times(symmetric!(zero; j, k => stress[j][k]), weight)
    }

    /// S across a cell without strain there, with `volume` for J U'(J).
    #[inline(always)]
    fn stress_across<T: Real, const M: usize>(&self, at: &Strained<T, M>, volume: T) -> T {
        let zero = volume.constant(0.0);
        let [above, _] = at.above_rest();
        let [w1, _] = self.slopes(above);
        let second = at.shrink * at.shrink * at.second_slope(zero, zero);
        w1 * at.shrink * at.first_slope(zero) * 2.0 + second * (2.0 * self.second) + volume
    }

    /// S and dS/dE
    #[inline(always)]
    pub(super) fn response<T: Real, const M: usize>(
        &self,
        at: &Strained<T, M>,
        pull: Option<T>,
    ) -> Response<T, M> {
        let [volume, stiffness] = self.volume(at, pull);
        let zero = at.swelling.constant(0.0);
        let one = at.swelling.constant(1.0);
        let [above, _] = at.above_rest();
        let [w1, w11] = self.slopes(above);
        let (r, r2) = (at.shrink, at.shrink * at.shrink);
        let (i1, i2) = (at.invariants[0] + 3.0, at.invariants[0] * 2.0 + at.invariants[1] + 3.0);
        // dI1/dC along the cell and across it
        let mut inner = at.along;
        let rest = at.first_slope(zero);
        for j in 0..M {
            inner[j][j] += rest;
        }
        let slope = times(product(&at.inverse, &inner), r);
        let slope_across = at.first_slope(at.across) * at.inverse_across * r;
        // factors of C^-1 (x) C^-1, of the product of C^-1 with itself that is symmetric in all pairs, of
        // I (x) I less the identity, and the tensor P in C^-1 (x) P + P (x) C^-1
        let dyadic = (w1 * r * i1 * (1.0 / 9.0) + r2 * i2 * (self.second * 4.0 / 9.0)) * 4.0
            + volume
            + stiffness;
        let turned =
            (w1 * r * i1 * (1.0 / 3.0) + r2 * i2 * (self.second * 2.0 / 3.0)) * 4.0 - volume * 2.0;
        let mixed = r2 * (4.0 * self.second);
        let of_one = w1 * r * (-4.0 / 3.0) - r2 * i1 * (self.second * 8.0 / 3.0);
        let of_c = r2 * (self.second * 8.0 / 3.0);
        let mut p = times(at.along, of_c);
        for j in 0..M {
            p[j][j] = p[j][j] + of_one + of_c;
        }
        let p_across = of_one + of_c * (at.across + 1.0);
        let curved = w11 * 4.0;

        let delta = |j: usize, k: usize| if j == k { one } else { zero };
        let ci = &at.inverse;
        let mut elasticity: Elasticity<T> = [[zero; 6]; 6];
        for v in 0..M * (M + 1) / 2 {
            let (j, l) = axes::<M>(v);
            for w in 0..=v {
                let (k, n) = axes::<M>(w);
                let pairs = (ci[j][k] * ci[l][n] + ci[j][n] * ci[l][k]) * 0.5;
                let units = (delta(j, k) * delta(l, n) + delta(j, n) * delta(l, k)) * 0.5;
                elasticity[v][w] = dyadic * ci[j][l] * ci[k][n]
                    + turned * pairs
                    + ci[j][l] * p[k][n]
                    + p[j][l] * ci[k][n]
                    + mixed * (delta(j, l) * delta(k, n) - units)
                    + curved * slope[j][l] * slope[k][n];
                elasticity[w][v] = elasticity[v][w];
            }
        }
        if self.across.is_free::<M>() {
            let ca = at.inverse_across;
            let both =
                dyadic * ca * ca + p_across * ca * 2.0 + curved * slope_across * slope_across;
            // M = 1: two directions, which change alike
            let mut own = both + turned * ca * ca;
            if M == 1 {
                own = own + both + mixed;
            }
            let mut with = [zero; 6];
            for v in 0..M * (M + 1) / 2 {
                let (j, l) = axes::<M>(v);
                with[v] = dyadic * ci[j][l] * ca
                    + ci[j][l] * p_across
                    + p[j][l] * ca
                    + mixed * delta(j, l)
                    + curved * slope[j][l] * slope_across;
            }
            let share = one * directions::<M>() / own;
            for v in 0..M * (M + 1) / 2 {
                for w in 0..M * (M + 1) / 2 {
                    elasticity[v][w] = elasticity[v][w] - with[v] * with[w] * share;
                }
            }
        }
        Response { stress: self.second_piola(at, volume, one), elasticity }
    }
}

/// g = J - 1
impl ElasticLaw for Rivlin {
    type Point<T: Real, const M: usize> = Strained<T, M>;

    #[inline(always)]
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Strained<T, M> {
        let across = match self.across.is_free::<M>() {
            true => self.free_across(&twice),
            false => twice[0][0].constant(0.0),
        };
        Strained::new(twice, across)
    }

    #[inline(always)]
    fn energy<T: Real, const M: usize>(&self, at: &Strained<T, M>) -> T {
        let [volume] = T::each([at.swelling], |[x]| [less_logarithm(x)]);
        self.energy_of_shape(at) + volume * (0.25 * self.bulk)
    }

    #[inline(always)]
    fn energy_of_shape<T: Real, const M: usize>(&self, at: &Strained<T, M>) -> T {
        let [first, second] = at.above_rest();
        let [c10, c20, c30] = self.first;
        ((first * c30 + c20) * first + c10) * first + second * self.second
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize>(&self, at: &Strained<T, M>) -> T {
        at.swelling / (at.stretch() + 1.0)
    }

    /// J C^-1
    #[inline(always)]
    fn swelling<T: Real, const M: usize>(&self, at: &Strained<T, M>) -> Matrix<T, M, M> {
        times(at.inverse, at.stretch())
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        T::each([dilatation], |[dilatation]| swollen(self.bulk, dilatation))
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize>(
        &self,
        at: &Strained<T, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M> {
        let [volume, _] = self.volume(at, pull);
        self.second_piola(at, volume, weight)
    }

    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        f: Matrix<T, D, M>,
        at: Strained<T, M>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Tangent::new(&f, &self.response(&at, pull), gradients, weight)
    }

    #[inline(always)]
    fn across<T: Real, const M: usize>(&self, at: &Strained<T, M>, pull: Option<T>) -> [T; 2] {
        let zero = at.across.constant(0.0);
        if M == 3 || self.across.is_free::<M>() {
            return [at.across * 0.5, zero];
        }
        let [volume, _] = self.volume(at, pull);
        [zero, self.stress_across(at, volume)]
    }

    #[inline(always)]
    fn thickness<T: Real, const M: usize>(&self, at: &Strained<T, M>) -> T {
        match M {
            1 => at.across + 1.0,
            _ => (at.across + 1.0).sqrt(),
        }
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize>(&self, stretch: T, at: &Strained<T, M>) -> T {
        match self.across.is_free::<M>() {
            true => stretch * (at.across + 1.0),
            false => stretch,
        }
    }

    fn outside(&self, domain: f64) -> String {
        format!(
            "is inverted, det F = {domain:.3}: rubber cannot be pressed to nothing; load it less, or refine the mesh there"
        )
    }
}
