//! Nodal forces and the magnetic moment of cells with a remanence, in a magnetic field that is linear in x.
//!
//! With the deformed position x = sum N_a x_a and F = sum x_a g_a^T, the moment per natural volume is F b / mu_0. In a field
//! B(x) = B_0 + G x, G symmetric, cells have the energy -sum w (F b) . B(x) / mu_0, so that the force on a node is
//!
//! ```text
//! f_a = q_a B_0 + sum_b S_ab G x_b,    q_a = sum w (g_a . b) / mu_0,    S_ab = sum w ((g_a . b) N_b + N_a (g_b . b)) / mu_0
//! ```
//!
//! q and S, one number per node and per coupled pair, are set up once: a uniform field costs one
//! multiplication per node and has no tangents. The moment is sum q_a x_a. Work counts as supplied, as a
//! field may change with time.

use super::elements::ElementsOf;
use crate::base::input::InputError;
use crate::base::sparse::NodeMatrix;
use crate::base::tensor::dot;
use crate::elements::basis::StrainPoint;

/// The permeability of vacuum mu_0 (T m/A), CODATA 2018.
pub(crate) const VACUUM: f64 = 1.256_637_062_12e-6;

/// The magnetization of a body.
pub(crate) struct Magnets {
    /// q (A m): the sum of q_a x_a is the magnetic moment (A m^2).
    pub(crate) poles: Vec<f64>,
    /// S (A m), symmetric, on the pattern of the body.
    pub(crate) products: NodeMatrix,
}

/// A `remanence` (T) in the coordinates of a cell at one of its points.
pub(super) fn direction<const N: usize, const M: usize, const D: usize>(
    point: &StrainPoint<f64, N, M, D>,
    remanence: &[f64],
) -> [f64; M] {
    std::array::from_fn(|j| point.frame[j].iter().zip(remanence).map(|(e, b)| e * b).sum())
}

/// Elements that can be magnetized.
pub(super) trait Magnetized {
    /// Adds the contributions of a `remanence` (T) in some `cells`.
    fn add_magnets(
        &self,
        cells: &[usize],
        remanence: &[f64],
        magnets: &mut Magnets,
    ) -> Result<(), InputError>;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Magnetized
    for ElementsOf<N, M, D, Q>
{
    fn add_magnets(
        &self,
        cells: &[usize],
        remanence: &[f64],
        magnets: &mut Magnets,
    ) -> Result<(), InputError> {
        let strength = remanence.iter().map(|b| b * b).sum::<f64>().sqrt();
        for &cell in cells {
            let nodes = &self.nodes[cell];
            for (point, values) in self.points(cell).zip(&self.values) {
                let own = direction(&point, remanence);
                // round-off of the components
                if M < D && dot(&own, &own).sqrt() < (1.0 - 1e-9) * strength {
                    let help = "it has a part across the cells, which have no thickness that turns: give one along them";
                    return Err(InputError::new(
                        format!("remanence in cell {}", cell + 1),
                        format!("{remanence:?} T"),
                        help,
                    ));
                }
                let poles: [f64; N] =
                    std::array::from_fn(|a| point.volume * dot(&point.gradients[a], &own) / VACUUM);
                for (a, &node) in nodes.iter().enumerate() {
                    magnets.poles[node] += poles[a];
                    for (b, &other) in nodes.iter().enumerate() {
                        let product = poles[a] * values[b] + values[a] * poles[b];
                        magnets.products.add(node, other, product);
                    }
                }
            }
        }
        Ok(())
    }
}
