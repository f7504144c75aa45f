//! The law of a fibre: an exponential of its strain in tension, or an active stress.

use crate::base::tensor::{Matrix, Real};
use crate::elements::material::law::{Blocks, ElasticLaw};
use crate::elements::material::response::{Response, Tangent};

/// The law of a fibre, whose energy all counts as that of shape. Its cell has one dimension.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Fibre {
    /// W = (young / (8 k2)) (exp(4 k2 E^2) - 1) of a stretched fibre, else 0.
    Passive {
        /// Young's modulus (Pa).
        young: f64,
        /// k2
        stiffening: f64,
    },
    /// W = stress (l - 1), with the stretch l: it pulls by one force, however long it is.
    Active {
        /// Force per natural section (Pa).
        stress: f64,
    },
}

/// The largest exponent 4 k2 E^2: with it moduli are still finite.
const LARGEST: f64 = 300.0;

impl Fibre {
    /// W, S and dS/dE.
    #[inline]
    fn slopes(&self, twice: f64) -> [f64; 3] {
        let (young, stiffening) = match *self {
            Self::Passive { young, stiffening } => (young, stiffening),
            Self::Active { stress } => {
                let stretch = (1.0 + twice).sqrt();
                let pull = stress / stretch;
                let energy = stress * twice / (1.0 + stretch);
                return [energy, pull, -pull / (stretch * stretch)];
            }
        };
        let strain = 0.5 * twice;
        // at rest a fibre counts as stretched
        if strain < 0.0 {
            return [0.0; 3];
        }
        let exponent = 4.0 * stiffening * strain * strain;
        let growth = exponent.exp();
        let energy = match stiffening == 0.0 {
            true => 0.5 * young * strain * strain,
            false => young / (8.0 * stiffening) * exponent.exp_m1(),
        };
        [energy, young * strain * growth, young * growth * (1.0 + 2.0 * exponent)]
    }

    /// k2; an active one has no limit of stretch.
    #[inline(always)]
    fn stiffening(&self) -> f64 {
        match *self {
            Self::Passive { stiffening, .. } => stiffening,
            Self::Active { .. } => 0.0,
        }
    }
}

impl ElasticLaw for Fibre {
    /// 2 E
    type Point<T: Real, const M: usize> = Matrix<T, M, M>;

    #[inline(always)]
    fn point<T: Real, const M: usize>(&self, twice: Matrix<T, M, M>) -> Matrix<T, M, M> {
        twice
    }

    #[inline(always)]
    fn energy<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        let [energy, ..] = T::each([twice[0][0]], |[twice]| self.slopes(twice));
        energy
    }

    #[inline(always)]
    fn energy_of_shape<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        self.energy(twice)
    }

    #[inline(always)]
    fn dilatation<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        twice[0][0].constant(0.0)
    }

    #[inline(always)]
    fn swelling<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> Matrix<T, M, M> {
        [[twice[0][0].constant(0.0); M]; M]
    }

    #[inline(always)]
    fn of_volume<T: Real>(&self, dilatation: T) -> [T; 3] {
        [dilatation.constant(0.0); 3]
    }

    #[inline(always)]
    fn stress<T: Real, const M: usize>(
        &self,
        twice: &Matrix<T, M, M>,
        _: Option<T>,
        weight: T,
    ) -> Matrix<T, M, M> {
        let [_, stress, _] = T::each([twice[0][0]], |[twice]| self.slopes(twice));
        [[stress * weight; M]; M]
    }

    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        f: Matrix<T, D, M>,
        twice: Matrix<T, M, M>,
        _: Option<T>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Blocks<T, D> {
        let [_, stress, slope] = T::each([twice[0][0]], |[twice]| self.slopes(twice));
        let response = Response { stress: [[stress; M]; M], elasticity: [[slope; 6]; 6] };
        Tangent::new(&f, &response, gradients, weight)
    }

    #[inline(always)]
    fn across<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>, _: Option<T>) -> [T; 2] {
        [twice[0][0].constant(0.0); 2]
    }

    #[inline(always)]
    fn thickness<T: Real, const M: usize>(&self, twice: &Matrix<T, M, M>) -> T {
        twice[0][0].constant(1.0)
    }

    #[inline(always)]
    fn domain<T: Real, const M: usize>(&self, _: T, twice: &Matrix<T, M, M>) -> T {
        // slack fibres have no limit
        let [stretched] = T::each([twice[0][0]], |[twice]| [twice.max(0.0)]);
        stretched * stretched * -self.stiffening() + LARGEST
    }

    fn outside(&self, domain: f64) -> String {
        format!(
            "has fibres that are stretched beyond what their law describes, 4 k2 E^2 = {:.0}: load it less, or give them less \
             `stiffening`",
            LARGEST - domain
        )
    }
}
