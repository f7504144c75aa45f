//! Objective viscosity: Hooke's law, with viscous moduli, for the rate of Green's strain.

use crate::material::deformation::Deformation;
use crate::material::hooke::{Hooke, Lame, Spread};
use crate::material::law::{Block, ViscousLaw};
use crate::tensor::{Matrix, Real, dot, product, product_transposed, times};

/// P = F S with E' = sym(F^T F'), S = lambda tr(E') I + 2 mu E'. A body that spins as a whole is not
/// braked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ObjectiveViscosity(pub(crate) Hooke);

impl ViscousLaw for ObjectiveViscosity {
    #[inline(always)]
    fn stress<T: Real, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        weight: T,
    ) -> Matrix<T, D, M> {
        product(&at.gradient(), &self.0.stress(&at.twice_green_rate(rate), weight))
    }

    /// The rate of strain changes with F, too, so that this is not symmetric:
    /// lambda f_a f'_b^T + mu ((g_a . g_b) F F'^T + f_b f'_a^T) + (g_a . S g_b) I, f'_a = F' g_a
    #[inline(always)]
    fn tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        rate: &Matrix<T, D, M>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Fn(usize, usize) -> Block<T, D> {
        let f = at.gradient();
        let spread = Spread::new(&f, gradients);
        let moving = product(rate, gradients);
        let mixed = product_transposed(rate, &f);
        let stress = self.0.stress(&at.twice_green_rate(rate), weight.constant(1.0));
        let pulls = product(&stress, gradients);
        let Lame { lambda, mu } = self.0.lame;
        move |a, b| {
            let stretch = dot(&gradients[a], &gradients[b]);
            let geometric = dot(&gradients[a], &pulls[b]);
            let along = &spread.along;
            let mut block = [[weight.constant(0.0); D]; D];
            for i in 0..D {
                block[i][i] += geometric;
                for k in 0..D {
                    let shear = mixed[i][k] * stretch + along[b][i] * moving[a][k];
                    let volumetric = along[a][i] * moving[b][k];
                    block[i][k] = (block[i][k] + volumetric * lambda + shear * mu) * weight;
                }
            }
            block
        }
    }

    #[inline(always)]
    fn rate_tangent<T: Real, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Deformation<T, M, D>,
        gradients: &[[T; M]; N],
        weight: T,
    ) -> impl Fn(usize, usize) -> Block<T, D> {
        let spread = Spread::new(&at.gradient(), gradients);
        move |a, b| times(spread.material(self.0.lame, a, b), weight)
    }
}
