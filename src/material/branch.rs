//! Maxwell branches: springs that relax, beside the elasticity of a substance.

use super::deformation::Deformation;
use super::hooke::{Hooke, Lame, Spread};
use super::law::{Block, Blocks};
use super::response::axes;
use super::{Material, Plane, Strain};
use crate::input::{InputError, positive};
use crate::tensor::{Matrix, dot, product, times};

/// A spring and a damper in a row, beside the elasticity of a [`Substance`](crate::Substance): what is strained at once and
/// kept so pulls by the spring, less and less, as exp(-t/tau).
///
/// Its energy is Hooke's, with g times the material's Young's modulus and the same Poisson's ratio, of the strain E - G: E
/// is that of the body (Green's, or Cauchy's with Cauchy strain), and G, an unknown at each point of a cell where stress is
/// computed, goes after it by G' = (E - G)/tau (finite viscoelasticity by internal variables: J. C. Simo, T. J. R. Hughes,
/// *Computational Inelasticity*, chapter 10). So it is not felt by rigid rotation under Green's strain, and dissipates
/// S : G' >= 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaxwellBranch {
    /// Share g of stiffness (1), above 0: Young's modulus of the spring over that of the material, which is what is left
    /// when all has relaxed.
    pub share: f64,
    /// Relaxation time tau (s), above 0.
    pub time: f64,
}

impl MaxwellBranch {
    pub(super) fn validate(&self) -> Result<(), InputError> {
        positive("material.branch.share", self.share, "1")?;
        positive("material.branch.time", self.time, "s").map(drop)
    }
}

/// A branch in cells of one dimension.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Relaxing {
    hooke: Hooke,
    /// tau (s)
    pub(crate) time: f64,
    strain: Strain,
}

/// The strain of a point, and the shape in which stress acts there.
pub(crate) struct Strained<const M: usize, const D: usize> {
    /// 2 E
    twice: Matrix<f64, M, M>,
    /// As it is deformed, or not at all under small strains.
    shape: Deformation<f64, M, D>,
}

/// A strain by its components; 0 where cells have none.
pub(crate) type Components = [f64; components(3)];

/// A strain of the spring of a branch.
#[derive(Clone, Copy)]
pub(crate) struct Stretch {
    pub(crate) strain: Components,
    /// What resists a change of volume takes this trace: its own, or the mean of that over the cell.
    pub(crate) trace: f64,
}

impl Relaxing {
    /// That of cells of `dimension`.
    pub(crate) fn new(
        branch: &MaxwellBranch,
        material: &Material,
        strain: Strain,
        dimension: usize,
        plane: Plane,
    ) -> Self {
        let spring = Material { young: branch.share * material.young, ..*material };
        let hooke = Hooke::new(spring.elastic(), dimension, plane);
        Self { hooke, time: branch.time, strain }
    }

    /// The part of a strain that passes to E - G in a step of the parameter `gamma` (s): 1 / (1 + gamma/tau).
    pub(crate) fn part(&self, gamma: f64) -> f64 {
        1.0 / (1.0 + gamma / self.time)
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

    /// What it resists a change of volume with (Pa).
    pub(crate) fn lambda(&self) -> f64 {
        self.hooke.lame.lambda
    }

    /// 2 W (J/m^3) of the strain E - G.
    pub(crate) fn twice_energy<const M: usize>(&self, apart: &Stretch) -> f64 {
        let of_volume = apart.trace * (0.5 * self.lambda()) * trace::<M>(&apart.strain);
        2.0 * (of_volume + self.hooke.of_shear().energy(&doubled::<M>(&apart.strain)))
    }

    /// Second Piola stress (Pa) of the strain E - G, times `weight`.
    fn second<const M: usize>(&self, apart: &Stretch, weight: f64) -> Matrix<f64, M, M> {
        let pull = self.lambda() * apart.trace;
        self.hooke.stress(&doubled::<M>(&apart.strain), Some(pull), weight)
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

    /// The stiffness between nodes, as of [`ElasticLaw::tangent`](super::ElasticLaw::tangent), times `weight`: `part` of
    /// that of the spring with `lambda` (Pa) for its own, and what the turning of the stress of E - G adds.
    pub(crate) fn tangent<'a, const N: usize, const M: usize, const D: usize>(
        &self,
        at: &Strained<M, D>,
        apart: &Stretch,
        (part, lambda): (f64, f64),
        gradients: &'a [[f64; M]; N],
        weight: f64,
    ) -> Tangent<'a, N, M, D> {
        let lame = Lame { lambda, ..self.hooke.lame };
        let spread = Spread::new(&at.shape.gradient(), gradients, lame, part * weight);
        let turning = match self.strain {
            Strain::Cauchy => 0.0,
            Strain::Green => weight,
        };
        Tangent { spread, pulls: product(&self.second(apart, turning), gradients) }
    }
}

impl<const M: usize, const D: usize> Strained<M, D> {
    /// E
    pub(crate) fn strain(&self) -> Components {
        halved(&self.twice)
    }

    /// How E changes with the displacements, whose change has the gradient `h`.
    pub(crate) fn change(&self, h: &Matrix<f64, D, M>) -> Components {
        halved(&self.shape.twice_green_rate(h))
    }

    /// How the trace of E follows the nodes, times `weight`.
    pub(crate) fn swelling<const N: usize>(
        &self,
        gradients: &[[f64; M]; N],
        weight: f64,
    ) -> [[f64; D]; N] {
        times(product(&self.shape.gradient(), gradients), weight)
    }
}

/// Components of a symmetric tensor of cells of `dimension`.
pub(crate) const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

pub(crate) fn trace<const M: usize>(strain: &Components) -> f64 {
    strain[..M].iter().sum()
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
}

impl<const N: usize, const M: usize, const D: usize> Blocks<f64, D> for Tangent<'_, N, M, D> {
    fn block(&self, a: usize, b: usize) -> Block<f64, D> {
        let mut block = times(self.spread.material(a, b), self.spread.weight);
        let geometric = dot(&self.spread.gradients[a], &self.pulls[b]);
        (0..D).for_each(|i| block[i][i] += geometric);
        block
    }
}
