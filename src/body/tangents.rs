//! The tangents of all elements, and the constant matrices, which are tangents at rest.

use super::elements::{ElementsOf, gradient, pairs};
use super::forces::NonlinearTerms;
use super::regions::{Regions, Substance};
use crate::material::{Block, Deformation, ElasticLaw, Hooke, Linear, ViscousLaw, with_law};
use crate::sparse::{BlockMatrix, Rows};

/// Elements as matrices.
pub(super) trait Tangents {
    /// Adds sum w (lambda g_a g_b^T + mu ((g_a . g_b) I + g_b g_a^T)), `hooke` telling the constants.
    fn add_stiffness(
        &self,
        regions: &Regions,
        hooke: &dyn Fn(&Substance) -> Hooke,
        stiffness: &mut BlockMatrix,
    );

    /// Adds -df/du and -df/dv of the forces of `terms`.
    fn add_tangents(
        &self,
        regions: &Regions,
        terms: NonlinearTerms,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Tangents
    for ElementsOf<N, M, D, Q>
{
    fn add_stiffness(
        &self,
        regions: &Regions,
        hooke: &dyn Fn(&Substance) -> Hooke,
        stiffness: &mut BlockMatrix,
    ) {
        let mut stiffness = stiffness.rows_mut();
        for (cell, nodes) in self.nodes.iter().enumerate() {
            let law = Linear(hooke(regions.of(cell)));
            for point in self.points(cell) {
                let rest = Deformation::new(point.frame, [[0.0; D]; M]);
                scatter(nodes, &mut stiffness, law.tangent(&rest, &point.gradients, point.volume));
            }
        }
    }

    fn add_tangents(
        &self,
        regions: &Regions,
        terms: NonlinearTerms,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (u, v) = (u.as_chunks::<D>().0, v.as_chunks::<D>().0);
        let add = |share: usize, mut stiffness: Rows<'_>, mut damping: Rows<'_>| {
            for cell in self.shares.cells[share].iter().cloned().flatten() {
                let (nodes, substance) = (&self.nodes[cell], regions.of(cell));
                for point in self.points(cell) {
                    let (g, volume) = (&point.gradients, point.volume);
                    let of_nodes = |x: &[[f64; D]]| {
                        let mut at_nodes = [[0.0; D]; N];
                        (0..N).for_each(|a| at_nodes[a] = x[nodes[a]]);
                        gradient(0, &at_nodes, g)
                    };
                    let at = Deformation::new(point.frame, of_nodes(u));
                    if terms.elastic {
                        with_law!(substance.elastic, law => {
                            scatter(nodes, &mut stiffness, law.tangent(&at, g, volume));
                        });
                    }
                    if terms.viscous {
                        let (law, rate) = (&substance.viscous, of_nodes(v));
                        scatter(nodes, &mut damping, law.rate_tangent(&at, g, volume));
                        scatter(nodes, &mut stiffness, law.tangent(&at, &rate, g, volume));
                    }
                }
            }
        };
        self.shares.each(stiffness.rows_mut(), damping.rows_mut(), &add);
    }
}

/// Adds the block of each pair of nodes of a cell, as far as the matrix has these rows.
#[inline(always)]
fn scatter<const N: usize, const D: usize>(
    nodes: &[usize; N],
    matrix: &mut Rows<'_>,
    block: impl Fn(usize, usize) -> Block<f64, D>,
) {
    for (a, b) in pairs::<N>() {
        let Some(entries) = matrix.block_mut(nodes[a], nodes[b]) else { continue };
        entries.iter_mut().zip(block(a, b).as_flattened()).for_each(|(entry, new)| *entry += new);
    }
}
