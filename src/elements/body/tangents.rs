//! The tangents of all elements, and the constant matrices, which are tangents at rest.
//!
//! Tangents are computed as forces are: compiled for each instruction set, several cells at once, in an order
//! of additions that is the same on all machines. Those of a cell are summed up over its points, and added to
//! the matrix once. The gradients of a cell add up to 0, and so do the rows and columns of its tangent: the
//! blocks of its first node balance the others. Of a symmetric tangent half of the blocks are computed.
//!
//! Each cell stores the positions of its pairs of nodes in the body's pattern, 4 N^2 bytes, and a pattern
//! that springs have widened maps them to new ones. K and B are assembled point by point, all blocks, as they
//! are the forces of linear bodies.

use std::ops::Range;

use super::elements::{ElementsOf, pairs};
use super::forces::Terms;
use super::projection::COEFFICIENTS;
use super::regions::{Laws, Regions};
use crate::base::simd::at_once;
use crate::base::sparse::{BlockMatrix, Rows};
use crate::base::tensor::{Matrix, times};
use crate::elements::material::{Blocks, Deformation, Elastic, ObjectiveViscosity, ViscousLaw};

mod pass;
mod revolved;
mod tangent;
#[cfg(test)]
mod tests;

use pass::Pass;
pub(super) use tangent::{ElasticTangent, TangentTerm};
use tangent::{OfVolume, RateTangent, ViscousTangent};

/// Elements as matrices.
pub(super) trait Tangents {
    /// Adds the tangents at rest of the law that `law` returns: sum w (lambda g_a g_b^T + mu ((g_a . g_b)
    /// I + g_b g_a^T)).
    fn add_stiffness(
        &self,
        regions: &Regions,
        law: &dyn Fn(&Laws) -> Elastic,
        stiffness: &mut BlockMatrix,
    );

    /// Adds -df/du and -df/dv of the forces of `terms`.
    fn add_tangents(
        &self,
        regions: &Regions,
        terms: Terms,
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
        law: &dyn Fn(&Laws) -> Elastic,
        stiffness: &mut BlockMatrix,
    ) {
        if let Some(revolved) = &self.revolved {
            return revolved.add_stiffness(regions, law, stiffness);
        }
        let mut rows = stiffness.rows_mut::<D>();
        for cell in 0..self.nodes.len() {
            let is_projected = self.is_projected();
            match &law(regions.of(cell)) {
                Elastic::Linear(law) => {
                    self.add_at_rest(cell, &ElasticTangent { law, is_projected }, &mut rows);
                }
                Elastic::StVenantKirchhoff(law) => {
                    self.add_at_rest(cell, &ElasticTangent { law, is_projected }, &mut rows);
                }
                Elastic::ByPoint(law) => {
                    self.add_at_rest(cell, &ElasticTangent { law, is_projected }, &mut rows);
                }
            }
        }
    }

    fn add_tangents(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        if let Some(revolved) = &self.revolved {
            return revolved.add_tangents(regions, terms, [u, v], stiffness, damping);
        }
        let add = |share: usize, mut stiffness: Rows<'_, D>, mut damping: Rows<'_, D>| {
            for (cells, laws) in self.shares.cells[share].iter().flat_map(|run| regions.runs(run)) {
                let is_projected = self.is_projected();
                if terms.elastic {
                    let cells = cells.clone();
                    match &laws.elastic {
                        // constant
                        Elastic::Linear(_) => {}
                        Elastic::StVenantKirchhoff(law) => {
                            self.add_to(
                                &mut stiffness,
                                cells,
                                [u],
                                ElasticTangent { law, is_projected },
                            );
                        }
                        Elastic::ByPoint(law) => {
                            self.add_to(
                                &mut stiffness,
                                cells,
                                [u],
                                ElasticTangent { law, is_projected },
                            );
                        }
                    }
                }
                if terms.viscous {
                    match &laws.objective {
                        ObjectiveViscosity::Hookean(law) => {
                            self.add_viscous(cells, [u, v], law, &mut stiffness, &mut damping);
                        }
                        ObjectiveViscosity::Newtonian(law) => {
                            self.add_viscous(cells, [u, v], law, &mut stiffness, &mut damping);
                        }
                    }
                }
            }
        };
        self.shares.each(stiffness.rows_mut(), damping.rows_mut(), &add);
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// Adds the tangents of a viscous law by displacements and velocities, to the stiffness and the damping.
    fn add_viscous(
        &self,
        cells: Range<usize>,
        [u, v]: [&[f64]; 2],
        law: &impl ViscousLaw,
        stiffness: &mut Rows<'_, D>,
        damping: &mut Rows<'_, D>,
    ) {
        let is_projected = self.is_projected();
        self.add_to(damping, cells.clone(), [u], RateTangent { law, is_projected });
        self.add_to(stiffness, cells, [u, v], ViscousTangent { law, is_projected });
    }

    /// Adds the tangent at rest of one cell.
    fn add_at_rest(&self, cell: usize, slope: &impl TangentTerm<1>, rows: &mut Rows<'_, D>) {
        let entries = &self.entries[cell];
        let (mut swelling, mut volume) = ([[[0.0; D]; N]; COEFFICIENTS], 0.0);
        let pull = self.is_projected().then_some(0.0);
        for (q, point) in self.points(cell).enumerate() {
            let rest = Deformation::new(point.frame, [[0.0; D]; M]);
            let (gradients, weight) = (&point.gradients, point.volume);
            add_blocks(entries, rows, &slope.blocks(&rest, &[rest.h], pull, gradients, weight));
            if self.is_projected() {
                let (_, by_nodes, _) = slope.swelling(&rest, &[rest.h], gradients, weight);
                add(&mut swelling[0], &by_nodes);
                for (mode, sum) in self.modes_of(cell, q).iter().flatten().zip(&mut swelling[1..]) {
                    add(sum, &times(by_nodes, *mode));
                }
                volume += weight;
            }
        }
        if self.is_projected() {
            let [_, stiff] = slope.of_volume(0.0);
            for by_nodes in &swelling[..self.coefficients()] {
                let share = stiff / volume;
                add_blocks(entries, rows, &OfVolume { force: *by_nodes, motion: *by_nodes, share });
            }
        }
    }

    /// Adds the tangents of `cells`, cell after cell, to the rows of a matrix, by the `fields` that `slope`
    /// requires.
    pub(super) fn add_to<const K: usize>(
        &self,
        rows: &mut Rows<'_, D>,
        cells: Range<usize>,
        fields: [&[f64]; K],
        slope: impl TangentTerm<K>,
    ) {
        at_once(Pass { elements: self, rows, cells, fields, slope });
    }
}

/// Adds the blocks of all pairs of nodes of a cell to a matrix.
pub(super) fn add_blocks<const N: usize, const D: usize>(
    entries: &[[u32; N]; N],
    rows: &mut Rows<'_, D>,
    blocks: &impl Blocks<f64, D>,
) {
    for (a, b) in pairs::<N>() {
        if let Some(sum) = rows.block_mut(entries[a][b]) {
            add(sum, &blocks.block(a, b));
        }
    }
}

fn add<const R: usize, const C: usize>(sum: &mut Matrix<f64, R, C>, part: &Matrix<f64, R, C>) {
    for j in 0..C {
        for i in 0..R {
            sum[j][i] += part[j][i];
        }
    }
}
