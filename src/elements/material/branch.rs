//! Maxwell branches: springs that relax, parallel to the elasticity of a substance.
//!
//! Beside Hooke's law the strain is split additively, and not F = F_e F_i: G is linear in its own equation,
//! objective with Green's strain, and the heat S : G' is a square. In rubber, whose tr E grows with the
//! stretch at constant volume, that would be wrong, hence the metric C_v there. A motion starts with G = E,
//! and branches leave equilibria unchanged: where no internal strains are given, forces and energies are
//! those of relaxed branches. With a yield stress equilibria and starts have E = G, as if the body had been
//! made in that shape.

use super::deformation::Deformation;
use super::flow::{Components, Flowing, Step, components, trace};
use super::hooke::{Hooke, Lame, Spread};
use super::law::{Block, Blocks};
use super::laws::{Elastic, Maxwell};
use super::response::{self, Response, axes};
use super::{Material, Plane, Strain};
use crate::base::input::{InputError, not_negative, positive};
use crate::base::tensor::{Matrix, dot, product, times};

/// A spring and a damper in series, parallel to the elasticity of a [`Substance`](crate::Substance).
///
/// Under a strain that is applied suddenly and kept, the stress of the spring decays as exp(-t/tau).
///
/// Beside Hooke's law its energy is that of Hooke's law for the strain E - G, with g times the material's Young's modulus and
/// the same Poisson's ratio. E is the strain of the body (Green's, or Cauchy's with Cauchy strain); G, an
/// unknown at each point of a cell where stress is computed, follows it by G' = (E - G)/tau (finite
/// viscoelasticity by internal variables: J. C. Simo, T. J. R. Hughes, *Computational Inelasticity*, chapter
/// 10). So under Green's strain a rigid rotation causes no stress in it, and it dissipates S : G' >= 0.
///
/// Beside a [`Law`](crate::Law) of rubber the spring is neo-Hookean and C_v = I + 2 G the shape in which it has no stress, which
/// follows that of the body, C, by C_v' = (r (C - tr(C C_v^-1) C_v/3) + ln(J) (2/3) C_v)/tau, with J^2 = det(C)/det(C_v) and
/// r = J^(-2/3) (S. Reese, S. Govindjee, International Journal of Solids and Structures 35 (1998) 3455-3482): the
/// same at small strains, and g times neo-Hookean rubber under a sudden stretch, however large it is. Its bulk modulus is at most that
/// of a Poisson's ratio of 0.45, as nearly incompressible material is not to change its volume twice.
///
/// With a yield stress Y the damper does not move below it, like dough and tissue: pressed, held and
/// released, these keep part of the deformation. With the von Mises stress q of the spring, G' = max(0,
/// 1 - Y/q) dev(E - G)/tau (P. Perzyna, Advances in Applied Mechanics 9 (1966) 243-377, with a linear
/// overstress): the stress of shear relaxes to q = Y and no further, that of a change of volume not at all. Beside a law of rubber the
/// same factor multiplies r, and the last term is omitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellBranch {
    /// Share g of stiffness (1), above 0: Young's modulus of the spring over that of the material, which is
    /// the remainder when all branches have relaxed.
    pub share: f64,
    /// Relaxation time tau (s), above 0.
    pub time: f64,
    /// Yield stress Y (Pa), 0 or above, of second Piola stress, or of Kirchhoff stress beside a law of rubber; 0 is a Maxwell branch
    /// without one.
    pub yield_stress: f64,
}

impl MaxwellBranch {
    pub(crate) fn validate(&self) -> Result<(), InputError> {
        positive("material.branch.share", self.share, "1")?;
        positive("material.branch.time", self.time, "s")?;
        not_negative("material.branch.yield_stress", self.yield_stress, "Pa").map(drop)
    }
}

/// A branch in cells of a given dimension.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Relaxing {
    hooke: Hooke,
    /// tau (s)
    pub(crate) time: f64,
    strain: Strain,
    dimension: usize,
    flowing: Option<Flowing>,
    /// Its spring and damper beside a law of rubber.
    pub(crate) rubber: Option<Maxwell>,
}

/// The strain of a point, and the shape in which stress acts there.
pub(crate) struct Strained<const M: usize, const D: usize> {
    /// 2 E
    twice: Matrix<f64, M, M>,
    /// The deformation of the point; none under small strains.
    shape: Deformation<f64, M, D>,
}

/// A strain of the spring of a branch.
#[derive(Clone, Copy)]
pub(crate) struct Stretch {
    pub(crate) strain: Components,
    /// The trace that the stress of a change of volume takes: that of `strain`, or its mean over the cell.
    pub(crate) trace: f64,
}

impl Relaxing {
    /// The branch beside the law `elastic` in cells of `dimension`.
    pub(crate) fn new(
        branch: &MaxwellBranch,
        material: &Material,
        elastic: &Elastic,
        dimension: usize,
        plane: Plane,
    ) -> Self {
        let MaxwellBranch { time, yield_stress, .. } = *branch;
        let spring = Material { young: branch.share * material.young, ..*material };
        let hooke = Hooke::new(spring.elastic(), dimension, plane);
        let flowing = (yield_stress > 0.0).then(|| Flowing::new(&hooke, dimension, yield_stress));
        let is_free = hooke.is_free_across(dimension);
        let rubber = matches!(elastic, Elastic::ByPoint(_)).then(|| {
            // a free thickness follows the motion with any bulk modulus
            let Lame { lambda, mu } = match is_free {
                true => spring.elastic(),
                false => spring.bounded(spring.young),
            };
            Maxwell { shear: mu, bulk: lambda + 2.0 / 3.0 * mu, time, yield_stress, is_free }
        });
        let strain = match elastic {
            Elastic::Linear(_) => Strain::Cauchy,
            Elastic::StVenantKirchhoff(_) | Elastic::ByPoint(_) => Strain::Green,
        };
        Self { hooke, time, strain, dimension, flowing, rubber }
    }

    /// The name of its internal variable, which identifies the components.
    pub(crate) fn variable(&self) -> &'static str {
        match self.strain {
            Strain::Cauchy => "cauchy strain",
            Strain::Green => "green strain",
        }
    }

    /// Components of G.
    pub(crate) fn components(&self) -> usize {
        if let Some(rubber) = &self.rubber {
            return rubber.components(self.dimension);
        }
        let across = self.flowing.is_some_and(|flowing| flowing.strains_across(self.dimension));
        components(self.dimension) + usize::from(across)
    }

    /// Whether it has a yield stress.
    pub(crate) fn yields(&self) -> bool {
        self.flowing.is_some()
    }

    /// Whether its internal strain follows the strain linearly.
    pub(crate) fn is_linear(&self) -> bool {
        self.flowing.is_none() && self.rubber.is_none()
    }

    /// G' (1/s), where E - G is `apart`.
    pub(crate) fn rate<const M: usize>(&self, apart: &Components) -> Components {
        match &self.flowing {
            None => apart.map(|apart| apart / self.time),
            Some(flowing) => flowing.towards::<M>(apart).map(|flow| flow / self.time),
        }
    }

    /// tau S : G' (J/m^3): the heat S : G' during a time tau.
    pub(crate) fn loss<const M: usize>(&self, apart: &Stretch) -> f64 {
        match &self.flowing {
            None => self.twice_energy::<M>(apart),
            Some(flowing) => flowing.loss::<M>(&apart.strain),
        }
    }

    /// The change of this loss `from` one strain `to` another; to first order with a yield stress.
    pub(crate) fn loss_change<const M: usize>(&self, from: &Stretch, to: &Stretch) -> f64 {
        match &self.flowing {
            None => self.twice_energy::<M>(to) - self.twice_energy::<M>(from),
            Some(flowing) => {
                let change = std::array::from_fn(|v| to.strain[v] - from.strain[v]);
                flowing.loss_change::<M>(&from.strain, &change)
            }
        }
    }

    /// Derivative of E - G by the strain in a step of the parameter `gamma` (s), where E - G is
    /// `apart` now.
    pub(crate) fn step<const M: usize>(&self, gamma: f64, apart: &Components) -> Step {
        match &self.flowing {
            None => Step::of_all(1.0 / (1.0 + gamma / self.time)),
            Some(flowing) => flowing.step::<M>(gamma / self.time, apart),
        }
    }

    /// The strain at a point with the displacement gradient `h`.
    pub(crate) fn at<const M: usize, const D: usize>(
        &self,
        frame: Matrix<f64, D, M>,
        h: Matrix<f64, D, M>,
    ) -> Strained<M, D> {
        let at = Deformation::new(frame, h);
        match self.strain {
            Strain::Cauchy => {
                Strained { twice: at.twice_cauchy(), shape: Deformation::new(frame, [[0.0; D]; M]) }
            }
            Strain::Green => Strained { twice: at.twice_green(), shape: at },
        }
    }

    /// Whether its strain is a quadratic function of the displacements, and not a linear one.
    pub(crate) fn is_quadratic(&self) -> bool {
        self.strain == Strain::Green
    }

    /// The moduli lambda and mu of its spring (Pa).
    pub(crate) fn moduli(&self) -> [f64; 2] {
        [self.hooke.lame.lambda, self.hooke.lame.mu]
    }

    /// Its modulus lambda against a change of volume (Pa).
    pub(crate) fn lambda(&self) -> f64 {
        self.hooke.lame.lambda
    }

    /// 2 W (J/m^3) of the strain E - G.
    pub(crate) fn twice_energy<const M: usize>(&self, apart: &Stretch) -> f64 {
        let of_volume = apart.trace * (0.5 * self.lambda()) * trace::<M>(&apart.strain);
        let across = if M == 2 { apart.strain[3] } else { 0.0 };
        let of_shape = self.hooke.of_shear().energy(&doubled::<M>(&apart.strain));
        2.0 * (of_volume + (of_shape + self.hooke.lame.mu * across * across))
    }

    /// Second Piola stress (Pa) of the strain E - G, times `weight`.
    fn second<const M: usize>(&self, apart: &Stretch, weight: f64) -> Matrix<f64, M, M> {
        let pull = self.lambda() * apart.trace;
        self.hooke.stress(&doubled::<M>(&apart.strain), Some(pull), weight)
    }

    /// Stress (Pa) of the strain E - G across a cell, where that cannot change its thickness.
    pub(crate) fn stress_across<const M: usize>(&self, apart: &Stretch) -> f64 {
        if M != 2 || self.hooke.is_free_across(M) {
            return 0.0;
        }
        self.lambda() * apart.trace + 2.0 * self.hooke.lame.mu * apart.strain[3]
    }

    /// First Piola stress (Pa) of the strain E - G, times `weight`.
    pub(crate) fn stress<const M: usize, const D: usize>(
        &self,
        at: &Strained<M, D>,
        apart: &Stretch,
        weight: f64,
    ) -> Matrix<f64, D, M> {
        product(&at.shape.gradient(), &self.second(apart, weight))
    }

    /// The stiffness between nodes, as in [`ElasticLaw::tangent`](super::ElasticLaw::tangent), times
    /// `weight`: that of the spring in a `step`, with `lambda` (Pa) in place of its own, and the geometric
    /// stiffness of the stress of E - G.
    pub(crate) fn tangent<'a, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Strained<M, D>,
        apart: &Stretch,
        (step, lambda): (&Step, f64),
        gradients: &'a [[f64; M]; N],
        weight: f64,
    ) -> Tangent<'a, N, M, D> {
        let Lame { mu, .. } = self.hooke.lame;
        let lame = Lame { lambda: lambda + step.swelling * (lambda + step.of_mean(2.0 * mu)), mu };
        let (f, part) = (at.shape.gradient(), step.part * weight);
        let spread = Spread::new(&f, gradients, lame, part);
        let turning = match self.strain {
            Strain::Cauchy => 0.0,
            Strain::Green => weight,
        };
        let pulls = product(&self.second(apart, turning), gradients);
        let along = product(&product(&f, &times(doubled::<M>(&step.along), 0.5)), gradients);
        Tangent { spread, pulls, along, drop: 2.0 * mu * step.drop * part }
    }
}

impl<const M: usize, const D: usize> Strained<M, D> {
    /// E
    pub(crate) fn strain(&self) -> Components {
        halved(&self.twice)
    }

    /// The change of E with the displacements, whose change has the gradient `h`.
    pub(crate) fn change(&self, h: &Matrix<f64, D, M>) -> Components {
        halved(&self.shape.twice_green_rate(h))
    }

    /// The shape in which the stress acts, by columns as a frame.
    pub(crate) fn shape(&self) -> Matrix<f64, D, M> {
        self.shape.gradient()
    }

    /// First Piola stress (Pa) of the `second`, times `weight`.
    pub(crate) fn first(&self, second: &Components, weight: f64) -> Matrix<f64, D, M> {
        product(&self.shape.gradient(), &times(doubled::<M>(second), 0.5 * weight))
    }

    /// The stiffness between nodes of a stress and its derivative by the strain, times `weight`.
    pub(crate) fn tangent<'a, const N: usize>(
        &self,
        second: &Components,
        elasticity: response::Elasticity<f64>,
        gradients: &'a [[f64; M]; N],
        weight: f64,
    ) -> impl Blocks<f64, D> + use<'a, N, M, D> {
        let response = Response { stress: times(doubled::<M>(second), 0.5), elasticity };
        response::Tangent::new(&self.shape.gradient(), &response, gradients, weight)
    }

    /// The derivative of the trace of E by the displacements of the nodes, times `weight`.
    pub(crate) fn swelling<const N: usize>(
        &self,
        gradients: &[[f64; M]; N],
        weight: f64,
    ) -> [[f64; D]; N] {
        times(product(&self.shape.gradient(), gradients), weight)
    }
}

fn halved<const M: usize>(twice: &Matrix<f64, M, M>) -> Components {
    let mut strain = Components::default();
    for (v, component) in strain[..components(M)].iter_mut().enumerate() {
        let (j, k) = axes::<M>(v);
        *component = 0.5 * twice[j][k];
    }
    strain
}

fn doubled<const M: usize>(strain: &Components) -> Matrix<f64, M, M> {
    let mut twice = [[0.0; M]; M];
    for (v, component) in strain[..components(M)].iter().enumerate() {
        let (j, k) = axes::<M>(v);
        twice[j][k] = 2.0 * component;
        twice[k][j] = twice[j][k];
    }
    twice
}

pub(crate) struct Tangent<'a, const N: usize, const M: usize, const D: usize> {
    spread: Spread<'a, f64, N, M, D>,
    /// S g_a, times the weight
    pulls: [[f64; M]; N],
    /// In the direction of a flow the stiffness is less: by `drop` times the products of these vectors.
    along: [[f64; D]; N],
    drop: f64,
}

impl<const N: usize, const M: usize, const D: usize> Blocks<f64, D> for Tangent<'_, N, M, D> {
    fn block(&self, a: usize, b: usize) -> Block<f64, D> {
        let mut block = times(self.spread.material(a, b), self.spread.weight);
        let geometric = dot(&self.spread.gradients[a], &self.pulls[b]);
        (0..D).for_each(|i| block[i][i] += geometric);
        if self.drop > 0.0 {
            for (row, along) in block.iter_mut().zip(&self.along[a]) {
                let taken = self.drop * along;
                row.iter_mut()
                    .zip(&self.along[b])
                    .for_each(|(entry, other)| *entry -= taken * other);
            }
        }
        block
    }
}
