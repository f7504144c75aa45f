//! Laws of rubber that a program defines by their energy.

use std::fmt;

use nalgebra::{SVector, Vector3};
use num_dual::{Dual2SVec64, DualNum, hessian};

use crate::base::input::InputError;

/// The energy of a change of shape, of an isotropic law: [`Law::own`](super::Law::own) makes a law of it.
///
/// It is written once over the numbers of [`num_dual`], from which stresses and tangents follow to all digits.
///
/// ```
/// use pliant::num_dual::DualNum;
/// use pliant::{Law, Material, StrainEnergy, Substance};
///
/// /// Gent's rubber, whose chains have a longest stretch: W = -mu J/2 ln(1 - (I1 - 3)/J).
/// #[derive(Debug)]
/// struct Gent {
///     shear: f64, // mu, Pa
///     limit: f64, // J
/// }
///
/// impl StrainEnergy for Gent {
///     fn energy<T: DualNum<Primitive = f64> + Copy>(&self, [a, b, c]: [T; 3]) -> T {
///         let above = a * a + b * b + c * c - 3.0;
///         (-above / self.limit).ln_1p() * (-0.5 * self.shear * self.limit)
///     }
/// }
///
/// static GENT: Gent = Gent { shear: 1e5, limit: 20.0 };
/// // E = 2 mu (1 + nu)
/// let rubber: Substance = Material { density: 1000.0, young: 2.98e5, poisson: 0.49, viscosity: 0.0 }.law(Law::own(&GENT));
/// ```
pub trait StrainEnergy: fmt::Debug + Sync + 'static {
    /// W (J/m^3) at the principal stretches without the change of volume, whose product is 1: symmetric in them, with W = 0 where all are 1. Where
    /// it is not defined it is NaN.
    fn energy<T: DualNum<Primitive = f64> + Copy>(&self, stretches: [T; 3]) -> T;
}

/// A [`StrainEnergy`] behind a pointer.
trait Evaluate: fmt::Debug + Sync {
    fn value(&self, stretches: [f64; 3]) -> f64;

    /// Its gradient and its second derivatives.
    fn slopes(&self, stretches: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]);
}

impl<E: StrainEnergy> Evaluate for E {
    fn value(&self, stretches: [f64; 3]) -> f64 {
        self.energy(stretches)
    }

    fn slopes(&self, stretches: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let energy = |l: SVector<Dual2SVec64<3>, 3>| self.energy([l[0], l[1], l[2]]);
        let (_, gradient, hessian) = hessian(energy, &Vector3::from(stretches));
        (gradient.into(), hessian.into())
    }
}

/// The energy of a law of a program's own.
#[derive(Clone, Copy)]
pub struct OwnEnergy(&'static dyn Evaluate);

impl PartialEq for OwnEnergy {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self.0, other.0)
    }
}

impl fmt::Debug for OwnEnergy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Logarithms of stretches below which W follows from its slopes, whose error is of the seventh order.
const SMALL: f64 = 0.01;

/// Tolerance of the shear modulus of an energy, relative to that of the material.
const APART: f64 = 1e-3;

impl OwnEnergy {
    pub(super) const fn new(energy: &'static impl StrainEnergy) -> Self {
        Self(energy)
    }

    /// W at logarithms of the stretches that add up to 0.
    pub(super) fn value(self, x: [f64; 3]) -> f64 {
        if x.iter().all(|x| x.abs() < SMALL) {
            // the work on the way there, by Gauss's rule: W itself would be a small difference of terms of the size of the moduli
            let power = |s: f64| {
                let (slope, _) = self.slopes(x.map(|x| s * x));
                slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2]
            };
            let off = 0.5 * 0.6_f64.sqrt();
            return (5.0 * power(0.5 - off) + 8.0 * power(0.5) + 5.0 * power(0.5 + off)) / 18.0;
        }
        self.0.value(x.map(f64::exp))
    }

    /// dW/dx_i and d^2 W/dx_i dx_j at logarithms x of the stretches, of which it sees those without their mean.
    pub(super) fn slopes(self, x: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let mean = (x[0] + x[1] + x[2]) / 3.0;
        let stretches = x.map(|x| (x - mean).exp());
        let (gradient, hessian) = self.0.slopes(stretches);
        let first: [f64; 3] = std::array::from_fn(|i| gradient[i] * stretches[i]);
        let second = |i: usize, j: usize| {
            hessian[i][j] * stretches[i] * stretches[j] + if i == j { first[i] } else { 0.0 }
        };
        let rows: [f64; 3] =
            std::array::from_fn(|i| (second(i, 0) + second(i, 1) + second(i, 2)) / 3.0);
        let all = (rows[0] + rows[1] + rows[2]) / 3.0;
        let mean = (first[0] + first[1] + first[2]) / 3.0;
        let by = |i: usize| std::array::from_fn(|j| second(i, j) - rows[i] - rows[j] + all);
        (first.map(|own| own - mean), [by(0), by(1), by(2)])
    }

    /// Whether it fits a material with the shear modulus `mu` (Pa).
    ///
    /// # Errors
    /// An energy with another one, which is not symmetric, or not defined at rest.
    pub(in crate::elements::material) fn validate(self, mu: f64) -> Result<(), InputError> {
        let input = format!("material.law {self:?}");
        let [one, other] = [[0.1, 0.0, -0.1], [-0.1, 0.1, 0.0]].map(|x| self.value(x));
        if (one - other).abs() > 1e-9 * one.abs() || !(one - other).is_finite() {
            let help = "the material is isotropic: the energy is symmetric in the stretches";
            let value = format!("{one} J/m^3, {other} J/m^3 with the stretches exchanged");
            return Err(InputError::new(input, value, help));
        }
        let (_, by) = self.slopes([0.0; 3]);
        let shear = 0.25 * (by[0][0] + by[1][1] - 2.0 * by[0][1]);
        if (shear / mu - 1.0).abs() <= APART {
            return Ok(());
        }
        let help = format!(
            "that of the material is E / (2 (1 + nu)) = {mu:.6e} Pa: both are the same at small strains"
        );
        Err(InputError::new(input, format!("with a shear modulus of {shear:.6e} Pa"), help))
    }
}
