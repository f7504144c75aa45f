//! Laws that are written by the principal stretches: Ogden's rubber, and Hooke's law of the stretches.

#![allow(clippy::needless_range_loop, reason = "closures would not be compiled in place")]

use super::principal::{Principal, Slopes, directions_of};
use super::volume::{less_exponential, swollen};
use crate::material::hooke::{Lame, Plane};
use crate::material::law::{Blocks, ElasticLaw};
use crate::material::response::Tangent;
use crate::tensor::{Matrix, Real};

/// A law of the logarithms x of the principal stretches l = exp(x), those along the cell first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByStretches {
    pub(super) kind: Kind,
    /// What there is across a cell that does not fill space.
    pub(super) across: Plane,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Kind {
    /// W = sum (mu_p / alpha_p) (sum_i l_i^alpha_p / J^(alpha_p / 3) - 3) + (kappa/4) (J^2 - 1 - 2 ln J), g = J - 1
    /// (R. W. Ogden, Proceedings of the Royal Society A 328 (1972) 567-583).
    Ogden {
        /// mu_p (Pa) and alpha_p
        terms: [[f64; 2]; 3],
        /// kappa (Pa)
        bulk: f64,
    },
    /// W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with U^2 = F^T F, g = tr(U - I): Hooke's law in the frame that turns along with
    /// the point.
    Corotated(Lame),
}

impl ByStretches {
    const fn is_free<const M: usize>(&self) -> bool {
        M == 1 || M == 2 && matches!(self.across, Plane::Stress)
    }
}

impl Kind {
    /// W_shape (J/m^3)
    fn energy_of_shape(self, x: [f64; 3]) -> f64 {
        match self {
            Self::Ogden { terms, .. } => {
                let mean = (x[0] + x[1] + x[2]) / 3.0;
                let of_term = |[modulus, power]: [f64; 2]| {
                    // the exponents add up to 0
                    let sum: f64 = x.map(|x| less_exponential(power * (x - mean))).iter().sum();
                    modulus / power * sum
                };
                terms.map(of_term).iter().sum()
            }
            Self::Corotated(Lame { mu, .. }) => {
                mu * x.map(|x| x.exp_m1() * x.exp_m1()).iter().sum::<f64>()
            }
        }
    }

    /// g
    fn dilatation(self, x: [f64; 3]) -> f64 {
        match self {
            Self::Ogden { .. } => (x[0] + x[1] + x[2]).exp_m1(),
            Self::Corotated(_) => x.map(f64::exp_m1).iter().sum(),
        }
    }

    /// dg/dE_i
    fn swelling(self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Ogden { .. } => x.map(|own| (x[0] + x[1] + x[2] - 2.0 * own).exp()),
            Self::Corotated(_) => x.map(|x| (-x).exp()),
        }
    }

    /// U (J/m^3), U' and U'' at g.
    fn of_volume(self, dilatation: f64) -> [f64; 3] {
        match self {
            Self::Ogden { bulk, .. } => swollen(bulk, dilatation),
            Self::Corotated(Lame { lambda, .. }) => {
                let pull = lambda * dilatation;
                [0.5 * pull * dilatation, pull, lambda]
            }
        }
    }

    /// U' and U'', which a `pull` leaves out.
    fn volume(self, x: [f64; 3], pull: Option<f64>) -> [f64; 2] {
        match pull {
            Some(pull) => [pull, 0.0],
            None => {
                let [_, pull, stiff] = self.of_volume(self.dilatation(x));
                [pull, stiff]
            }
        }
    }

    /// S_i (Pa)
    fn stress(self, x: [f64; 3], pull: Option<f64>) -> [f64; 3] {
        let [pull, _] = self.volume(x, pull);
        match self {
            Self::Ogden { terms, .. } => {
                let stretch = (x[0] + x[1] + x[2]).exp();
                let mut kirchhoff = [stretch * pull; 3];
                for [modulus, power] in terms.into_iter().filter(|[modulus, _]| *modulus != 0.0) {
                    let (more, mean) = more_of(power, x);
                    (0..3).for_each(|i| kirchhoff[i] += modulus * (more[i] - mean));
                }
                std::array::from_fn(|i| kirchhoff[i] * (-2.0 * x[i]).exp())
            }
            // 2 mu (1 - 1 / l_i), which small strains do not round off
            Self::Corotated(Lame { mu, .. }) => {
                x.map(|x| pull * (-x).exp() - 2.0 * mu * (-x).exp_m1())
            }
        }
    }

    /// S_i and its derivatives by E_j; a `pull` stays as it is.
    fn slopes(self, x: [f64; 3], pull: Option<f64>) -> Slopes {
        let stress = self.stress(x, pull);
        let volume = self.volume(x, pull);
        match self {
            Self::Ogden { terms, .. } => ogden(terms, x, stress, volume),
            Self::Corotated(Lame { mu, .. }) => corotated(mu, x, stress, volume),
        }
    }

    /// The logarithm of the stretch across a cell where there is no stress, given those along it, by Newton's method; NaN if there
    /// is none.
    fn free_across<const M: usize>(self, along: [f64; 3]) -> f64 {
        /// More than strains of any size take.
        const MOST: usize = 100;
        let mut x = along;
        let m = (3 - M) as f64;
        let mut across = -along[..M].iter().sum::<f64>() / m;
        for _ in 0..MOST {
            x[M..].fill(across);
            let Slopes { stress, normal, .. } = self.slopes(x, None);
            let slope: f64 = normal[2][M..].iter().sum();
            // dE = exp(2 x) dx
            let change = stress[2] / (slope * (2.0 * across).exp());
            across -= change.clamp(-1.0, 1.0);
            if change.abs() < 1e-15 {
                return across;
            }
        }
        f64::NAN
    }
}

/// e_i - 1 of e_i = (l_i / J^(1/3))^power, and their mean.
fn more_of(power: f64, x: [f64; 3]) -> ([f64; 3], f64) {
    let third = (x[0] + x[1] + x[2]) / 3.0;
    let more = x.map(|x| (power * (x - third)).exp_m1());
    (more, (more[0] + more[1] + more[2]) / 3.0)
}

/// Ogden's law: S_i = t_i / l_i^2 with t_i = sum mu_p (e_i - mean of e) + J U'.
fn ogden(terms: [[f64; 2]; 3], x: [f64; 3], stress: [f64; 3], [pull, stiff]: [f64; 2]) -> Slopes {
    let stretch = (x[0] + x[1] + x[2]).exp();
    let squares = x.map(|x| (2.0 * x).exp());
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
fn corotated(mu: f64, x: [f64; 3], stress: [f64; 3], [pull, stiff]: [f64; 2]) -> Slopes {
    let inverse = x.map(|x| (-x).exp());
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

impl ElasticLaw for ByStretches {
    type Point<T: Real, const M: usize> = Principal<T, M>;

    #[inline(always)]
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Principal<T, M> {
        let mut numbers = [twice[0][0]; 9];
        for j in 0..M {
            for k in 0..M {
                numbers[M * j + k] = twice[j][k];
            }
        }
        let found = T::each(numbers, |numbers| {
            let (mut x, directions) = directions_of::<M>(numbers);
            let across = if self.is_free::<M>() { self.kind.free_across::<M>(x) } else { 0.0 };
            x[M..].fill(across);
            let mut found = [0.0; 12];
            found[..3].copy_from_slice(&x);
            found[3..].copy_from_slice(&directions);
            found
        });
        Principal::new(found)
    }

    #[inline(always)]
    fn energy<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let kind = self.kind;
        let [energy] = T::each(at.logarithms, |x| {
            [kind.energy_of_shape(x) + kind.of_volume(kind.dilatation(x))[0]]
        });
        energy
    }

    #[inline(always)]
    fn energy_of_shape<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let [energy] = T::each(at.logarithms, |x| [self.kind.energy_of_shape(x)]);
        energy
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let [dilatation] = T::each(at.logarithms, |x| [self.kind.dilatation(x)]);
        dilatation
    }

    #[inline(always)]
    fn swelling<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> Matrix<T, M, M> {
        at.tensor(&T::each(at.logarithms, |x| self.kind.swelling(x)))
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
        let mut stress = at.each_with(pull, |x, pull| self.kind.stress(x, pull));
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
        let is_free = self.is_free::<M>();
        let numbers = at.each_with(pull, |x, pull| {
            let mut slopes = self.kind.slopes(x, pull);
            if is_free {
                slopes.free_across::<M>();
            }
            slopes.numbers()
        });
        Tangent::new(&f, &at.response(numbers), gradients, weight)
    }

    #[inline(always)]
    fn across<T: Real, const M: usize>(&self, at: &Principal<T, M>, pull: Option<T>) -> [T; 2] {
        let zero = at.logarithms[2].constant(0.0);
        if M == 3 || self.is_free::<M>() {
            let [strain] = T::each([at.logarithms[2]], |[x]| [0.5 * (2.0 * x).exp_m1()]);
            return [strain, zero];
        }
        [zero, at.each_with(pull, |x, pull| self.kind.stress(x, pull))[2]]
    }

    #[inline(always)]
    fn thickness<T: Real, const M: usize>(&self, at: &Principal<T, M>) -> T {
        let [thickness] = T::each([at.logarithms[2]], |[x]| [((3 - M) as f64 * x).exp()]);
        thickness
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize>(&self, stretch: T, at: &Principal<T, M>) -> T {
        match self.is_free::<M>() {
            true => stretch * self.thickness(at),
            false => stretch,
        }
    }

    fn outside(&self, domain: f64) -> String {
        let law = match self.kind {
            Kind::Ogden { .. } => "rubber of Ogden's law cannot be pressed to nothing",
            Kind::Corotated(_) => {
                "the corotated law is one of small strains; take one of rubber for larger ones"
            }
        };
        format!("is inverted, det F = {domain:.3}: {law}; load it less, or refine the mesh there")
    }
}
