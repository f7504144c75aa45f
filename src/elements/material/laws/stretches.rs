//! Laws that are written by the principal stretches: Ogden's rubber, energies of programs, and Hooke's law of the stretches.
//!
//! The corotated frame rotates at each point and not with the cell as a whole, so that energy is conserved
//! and tangents are symmetric. Both laws are one for the loops: eigenvalues, eigenvectors and functions of
//! the stretches are computed cell by cell, tensors of them for all cells of a register. Formulas use
//! logarithms x of the stretches, and (S_i - S_j)/(E_i - E_j), 0/0 where two stretches meet, is written by
//! (exp(a d) - 1)/(exp(2 d) - 1), d = x_i - x_j, to all digits.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::own::OwnEnergy;
use super::principal::{Principal, Slopes};
use super::volume::{less_exponential, swollen};
use crate::base::tensor::{Matrix, Real};
use crate::elements::material::hooke::{Lame, Plane};
use crate::elements::material::law::{Blocks, ElasticLaw};
use crate::elements::material::response::{Response, Tangent};

/// A law of the principal stretches l, those along the cell first; x are their logarithms.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByStretches {
    pub(super) kind: Kind,
    /// Assumption across a cell of less than three dimensions.
    pub(super) across: Plane,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// W = sum (mu_p / alpha_p) (sum_i l_i^alpha_p / J^(alpha_p / 3) - 3) + (kappa/4) (J^2 - 1 - 2 ln J),
    /// g = J - 1 (R. W. Ogden, Proceedings of the Royal Society A 328 (1972) 567-583).
    Ogden {
        /// mu_p (Pa) and alpha_p
        terms: [[f64; 2]; 3],
        /// kappa (Pa)
        bulk: f64,
    },
    /// W = an energy of l_i / J^(1/3) + (kappa/4) (J^2 - 1 - 2 ln J), g = J - 1.
    Own {
        energy: OwnEnergy,
        /// kappa (Pa)
        bulk: f64,
    },
    /// W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with U^2 = F^T F, g = tr(U - I): Hooke's law in the frame
    /// that rotates with the point.
    Corotated(Lame),
}

impl Kind {
    /// W_shape (J/m^3) at the principal values of 2E, l_i^2 - 1.
    #[inline]
    fn energy_of_shape(self, twice: [f64; 3]) -> f64 {
        match self {
            Self::Ogden { terms, .. } => {
                let x = each(twice, logarithm);
                let mean = (x[0] + x[1] + x[2]) / 3.0;
                let of_term = |[modulus, power]: [f64; 2]| {
                    // the exponents add up to 0
                    let sum: f64 = each(x, |x| less_exponential(power * (x - mean))).iter().sum();
                    modulus / power * sum
                };
                terms.into_iter().map(of_term).sum()
            }
            Self::Own { energy, .. } => {
                let x = each(twice, logarithm);
                let mean = (x[0] + x[1] + x[2]) / 3.0;
                energy.value(each(x, |x| x - mean))
            }
            Self::Corotated(Lame { mu, .. }) => {
                let squares = each(twice, |twice| longer(twice) * longer(twice));
                mu * squares.iter().sum::<f64>()
            }
        }
    }

    /// g
    #[inline]
    fn dilatation(self, twice: [f64; 3]) -> f64 {
        match self {
            Self::Ogden { .. } | Self::Own { .. } => {
                each(twice, logarithm).iter().sum::<f64>().exp_m1()
            }
            Self::Corotated(_) => each(twice, longer).iter().sum(),
        }
    }

    /// dg/dE_i
    #[inline]
    fn swelling(self, twice: [f64; 3]) -> [f64; 3] {
        let stretch = match self {
            Self::Ogden { .. } | Self::Own { .. } => {
                return each(twice, |own| (self.dilatation(twice) + 1.0) / (own + 1.0));
            }
            Self::Corotated(_) => each(twice, |twice| longer(twice) + 1.0),
        };
        each(stretch, |stretch| 1.0 / stretch)
    }

    /// U (J/m^3), U' and U'' at g.
    #[inline]
    fn of_volume(self, dilatation: f64) -> [f64; 3] {
        match self {
            Self::Ogden { bulk, .. } | Self::Own { bulk, .. } => swollen(bulk, dilatation),
            Self::Corotated(Lame { lambda, .. }) => {
                let pull = lambda * dilatation;
                [0.5 * pull * dilatation, pull, lambda]
            }
        }
    }

    /// U' and U''; with a `pull`, which is constant, it and 0.
    #[inline]
    fn volume(self, twice: [f64; 3], pull: Option<f64>) -> [f64; 2] {
        match pull {
            Some(pull) => [pull, 0.0],
            None => {
                let [_, pull, stiff] = self.of_volume(self.dilatation(twice));
                [pull, stiff]
            }
        }
    }

    /// S_i (Pa)
    #[inline(never)]
    fn stress(self, twice: [f64; 3], pull: Option<f64>) -> [f64; 3] {
        match self {
            Self::Ogden { terms, bulk } => {
                let x = each(twice, logarithm);
                let dilatation = (x[0] + x[1] + x[2]).exp_m1();
                let pull = match pull {
                    Some(pull) => (dilatation + 1.0) * pull,
                    None => 0.5 * bulk * dilatation * (dilatation + 2.0),
                };
                let mut kirchhoff = [pull; 3];
                for [modulus, power] in terms.into_iter().filter(|[modulus, _]| *modulus != 0.0) {
                    let (more, mean) = more_of(power, x);
                    (0..3).for_each(|i| kirchhoff[i] += modulus * (more[i] - mean));
                }
                (0..3).for_each(|i| kirchhoff[i] /= twice[i] + 1.0);
                kirchhoff
            }
            Self::Own { energy, .. } => {
                let [pull, _] = self.volume(twice, pull);
                let x = each(twice, logarithm);
                let (mut kirchhoff, _) = energy.slopes(x);
                let stretch = (x[0] + x[1] + x[2]).exp();
                (0..3).for_each(|i| {
                    kirchhoff[i] = (kirchhoff[i] + stretch * pull) / (twice[i] + 1.0)
                });
                kirchhoff
            }
            // S_i l_i = U' + 2 mu (l_i - 1)
            Self::Corotated(Lame { mu, .. }) => {
                let [pull, _] = self.volume(twice, pull);
                each(each(twice, longer), |longer| (pull + 2.0 * mu * longer) / (longer + 1.0))
            }
        }
    }

    /// S_i and its derivatives by E_j; a `pull` is kept constant.
    #[inline(never)]
    fn slopes(self, twice: [f64; 3], pull: Option<f64>) -> Slopes {
        let stress = self.stress(twice, pull);
        let volume = self.volume(twice, pull);
        match self {
            Self::Ogden { terms, .. } => ogden(terms, twice, stress, volume),
            Self::Own { energy, .. } => own(energy, twice, stress, volume),
            Self::Corotated(Lame { mu, .. }) => corotated(mu, twice, stress, volume),
        }
    }

    /// 2E across a cell of dimension `M` without stress there, given 2E along it; NaN if there is none. With
    /// Ogden's law by Newton's method in the logarithm.
    #[inline(never)]
    fn free_across<const M: usize>(self, along: [f64; 3]) -> f64 {
        if let Self::Corotated(Lame { lambda, mu }) = self {
            // 2 mu (l - 1) + lambda (sum of all l - 1) = 0
            let sum: f64 = along[..M].iter().map(|twice| longer(*twice)).sum();
            let across = -lambda * sum / (2.0 * mu + (3 - M) as f64 * lambda);
            return if across > -1.0 { across * (across + 2.0) } else { f64::NAN };
        }
        /// Most iterations: more than strains of any size take.
        const MOST: usize = 100;
        let mut twice = along;
        let m = (3 - M) as f64;
        let mut across = -along[..M].iter().map(|twice| logarithm(*twice)).sum::<f64>() / m;
        for _ in 0..MOST {
            twice[M..].fill((2.0 * across).exp_m1());
            let Slopes { stress, normal, .. } = self.slopes(twice, None);
            let slope: f64 = normal[2][M..].iter().sum();
            // dE = exp(2 x) dx
            let change = stress[2] / (slope * (twice[2] + 1.0));
            across -= change.clamp(-1.0, 1.0);
            if change.abs() < 1e-15 {
                return (2.0 * across).exp_m1();
            }
        }
        f64::NAN
    }
}

/// The values of `of` for three numbers. (The `map` of arrays is a function that is not inlined.)
#[inline(always)]
fn each([x, y, z]: [f64; 3], of: impl Fn(f64) -> f64) -> [f64; 3] {
    [of(x), of(y), of(z)]
}

/// ln l, given l^2 - 1
#[inline]
fn logarithm(twice: f64) -> f64 {
    0.5 * twice.ln_1p()
}

/// l - 1, given l^2 - 1
#[inline]
fn longer(twice: f64) -> f64 {
    twice / ((twice + 1.0).sqrt() + 1.0)
}

/// e_i - 1 of e_i = (l_i / J^(1/3))^power, and their mean.
fn more_of(power: f64, x: [f64; 3]) -> ([f64; 3], f64) {
    let third = (x[0] + x[1] + x[2]) / 3.0;
    let more = each(x, |x| (power * (x - third)).exp_m1());
    (more, (more[0] + more[1] + more[2]) / 3.0)
}

/// Ogden's law: S_i = t_i / l_i^2 with t_i = sum mu_p (e_i - mean of e) + J U'.
fn ogden(
    terms: [[f64; 2]; 3],
    twice: [f64; 3],
    stress: [f64; 3],
    [pull, stiff]: [f64; 2],
) -> Slopes {
    let x = each(twice, logarithm);
    let stretch = (x[0] + x[1] + x[2]).exp();
    let squares = each(twice, |twice| twice + 1.0);
    // dt_i/dx_j, and (t_j - t_k) / (l_j^2 - l_k^2)
    let mut by = [[stretch * (pull + stretch * stiff); 3]; 3];
    let mut apart = [0.0; 3];
    for [modulus, power] in terms.into_iter().filter(|[modulus, _]| *modulus != 0.0) {
        let (more, mean) = more_of(power, x);
        for i in 0..3 {
            for j in 0..3 {
                let own = if i == j { more[i] + 1.0 } else { 0.0 };
                by[i][j] += modulus * power * (own - (more[i] + more[j] + 1.0 - mean) / 3.0);
            }
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            let d = x[j] - x[k];
            // differences keep their digits where stretches are apart
            apart[i] += modulus
                * match d.abs() > 1e-3 {
                    true => (more[j] - more[k]) / (squares[j] - squares[k]),
                    false => (more[k] + 1.0) * growth(power, d) / squares[k],
                };
        }
    }
    by_logarithms(squares, stress, by, apart)
}

/// A law of a program's own, likewise.
fn own(energy: OwnEnergy, twice: [f64; 3], stress: [f64; 3], [pull, stiff]: [f64; 2]) -> Slopes {
    let x = each(twice, logarithm);
    let stretch = (x[0] + x[1] + x[2]).exp();
    let squares = each(twice, |twice| twice + 1.0);
    let (kirchhoff, mut by) = energy.slopes(x);
    let apart = std::array::from_fn(|i| {
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let d = x[j] - x[k];
        // where stretches meet, the mean of the slopes on both sides, an error of second order in d
        match d.abs() > NEAR {
            true => (kirchhoff[j] - kirchhoff[k]) / (squares[j] - squares[k]),
            false => {
                0.25 * (by[j][j] + by[k][k] - 2.0 * by[j][k]) / (0.5 * (squares[j] + squares[k]))
            }
        }
    });
    for row in &mut by {
        row.iter_mut().for_each(|by| *by += stretch * (pull + stretch * stiff));
    }
    by_logarithms(squares, stress, by, apart)
}

/// Difference of logarithms of stretches below which a quotient of differences has fewer digits than a derivative.
const NEAR: f64 = 1e-5;

/// Slopes of S_i = t_i / l_i^2, from the squares of l, the derivatives of t_i by x_j, and (t_j - t_k) / (l_j^2 - l_k^2) for each i.
fn by_logarithms(
    squares: [f64; 3],
    stress: [f64; 3],
    by: [[f64; 3]; 3],
    apart: [f64; 3],
) -> Slopes {
    let mut slopes = Slopes { stress, ..Slopes::default() };
    for i in 0..3 {
        for j in 0..3 {
            let own = if i == j { 2.0 * stress[i] / squares[i] } else { 0.0 };
            slopes.normal[i][j] = by[i][j] / (squares[i] * squares[j]) - own;
        }
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        slopes.shear[i] = 2.0 * (apart[i] - stress[k]) / squares[j];
    }
    slopes
}

/// (exp(a d) - 1) / (exp(2 d) - 1) of a small d.
fn growth(a: f64, d: f64) -> f64 {
    match d == 0.0 {
        true => 0.5 * a,
        false => (a * d).exp_m1() / (2.0 * d).exp_m1(),
    }
}

/// Hooke's law of the stretches: S_i = 2 mu + c / l_i with c = U' - 2 mu.
fn corotated(mu: f64, twice: [f64; 3], stress: [f64; 3], [pull, stiff]: [f64; 2]) -> Slopes {
    let inverse = each(twice, |twice| 1.0 / (longer(twice) + 1.0));
    let c = pull - 2.0 * mu;
    let mut slopes = Slopes { stress, ..Slopes::default() };
    for i in 0..3 {
        for j in 0..3 {
            let own = if i == j { c * inverse[i].powi(3) } else { 0.0 };
            slopes.normal[i][j] = stiff * inverse[i] * inverse[j] - own;
        }
        let [a, b] = [inverse[(i + 1) % 3], inverse[(i + 2) % 3]];
        slopes.shear[i] = -2.0 * c * a * a * b * b / (a + b);
    }
    slopes
}

impl ByStretches {
    /// S and dS/dE
    #[inline(always)]
    pub(super) fn response<T: Real, const M: usize>(
        &self,
        at: &Principal<T, M>,
        pull: Option<T>,
    ) -> Response<T, M> {
        let is_free = self.across.is_free::<M>();
        at.response(at.each_with(pull, |twice, pull| {
            let mut slopes = self.kind.slopes(twice, pull);
            if is_free {
                slopes.free_across::<M>();
            }
            slopes.numbers()
        }))
    }
}

impl ElasticLaw for ByStretches {
    type Point<T: Real, const M: usize> = Principal<T, M>;

    #[inline(always)]
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Principal<T, M> {
        let is_free = self.across.is_free::<M>();
        Principal::new(twice, |along| if is_free { self.kind.free_across::<M>(along) } else { 0.0 })
    }

    #[inline(always)]
    fn energy<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let kind = self.kind;
        let [energy] = T::each(at.twice, |twice| {
            [kind.energy_of_shape(twice) + kind.of_volume(kind.dilatation(twice))[0]]
        });
        energy
    }

    #[inline(always)]
    fn energy_of_shape<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let [energy] = T::each(at.twice, |twice| [self.kind.energy_of_shape(twice)]);
        energy
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let [dilatation] = T::each(at.twice, |twice| [self.kind.dilatation(twice)]);
        dilatation
    }

    #[inline(always)]
    fn swelling<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> Matrix<T, M, M> {
        at.tensor(&T::each(at.twice, |twice| self.kind.swelling(twice)))
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        T::each([dilatation], |[dilatation]| self.kind.of_volume(dilatation))
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize>(
        &self,
        at: &Principal<T, M>,
        pull: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M> {
        let mut stress = at.each_with(pull, |twice, pull| self.kind.stress(twice, pull));
        for i in 0..3 {
            stress[i] = stress[i] * weight;
        }
        at.tensor(&stress)
    }

    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        f: Matrix<T, D, M>,
        at: Principal<T, M>,
        pull: Option<T>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        Tangent::new(&f, &self.response(&at, pull), gradients, weight)
    }

    #[inline(always)]
    fn across<T: Real, const M: usize>(&self, at: &Principal<T, M>, pull: Option<T>) -> [T; 2] {
        let zero = at.twice[2].constant(0.0);
        if M == 3 || self.across.is_free::<M>() {
            return [at.twice[2] * 0.5, zero];
        }
        [zero, at.each_with(pull, |twice, pull| self.kind.stress(twice, pull))[2]]
    }

    #[inline(always)]
    fn thickness<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        match M {
            1 => at.twice[2] + 1.0,
            _ => (at.twice[2] + 1.0).sqrt(),
        }
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize>(&self, stretch: T, at: &Principal<T, M>) -> T {
        let stretch = match self.across.is_free::<M>() {
            true => stretch * self.thickness(at),
            false => stretch,
        };
        let Kind::Own { .. } = self.kind else { return stretch };
        let [x, y, z] = at.twice;
        let [domain] = T::each([stretch, x, y, z], |[stretch, x, y, z]| {
            let is_defined = self.kind.energy_of_shape([x, y, z]).is_finite();
            [if is_defined { stretch } else { -1.0 }]
        });
        domain
    }

    fn outside(&self, domain: f64) -> String {
        let law = match self.kind {
            Kind::Ogden { .. } => "rubber of Ogden's law cannot be pressed to nothing",
            Kind::Own { energy, .. } => {
                return format!(
                    "is inverted, or the energy of {energy:?} is not defined there: load it less, or refine the mesh there"
                );
            }
            Kind::Corotated(_) => {
                "the corotated law is one of small strains; take one of rubber for larger ones"
            }
        };
        format!("is inverted, det F = {domain:.3}: {law}; load it less, or refine the mesh there")
    }
}
