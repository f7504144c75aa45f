//! The tangents of the cells of a body of revolution.

#![allow(clippy::needless_range_loop, reason = "indices that several arrays share read best")]

use std::ops::Range;

use super::tangent::{ElasticTangent, RateTangent, TangentTerm, ViscousTangent};
use crate::base::sparse::{BlockMatrix, Rows};
use crate::base::tensor::{Matrix, dot};
use crate::elements::body::forces::Terms;
use crate::elements::body::projection::{COEFFICIENTS, Projected};
use crate::elements::body::regions::{Laws, Regions};
use crate::elements::body::revolved::{MOST, Revolved, Shape, UNIT};
use crate::elements::material::{
    Block, Blocks, Deformation, Elastic, ObjectiveViscosity, ViscousLaw,
};

/// The components of F that change, as rows and columns: those in the plane, and that around.
const CHANGES: [(usize, usize); 5] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)];

/// Vectors of the nodes of a cell.
type Vectors = [[f64; 2]; MOST];

/// The changes of these components by the motion of a node along r and along z.
fn changes(shape: &Shape) -> [[f64; 5]; 2] {
    let [by_r, by_z, hoop] = *shape;
    [[by_r, by_z, 0.0, 0.0, hoop], [0.0, 0.0, by_r, by_z, 0.0]]
}

impl Revolved {
    /// As [`Tangents::add_stiffness`](super::Tangents::add_stiffness).
    pub(super) fn add_stiffness(
        &self,
        regions: &Regions,
        law: &dyn Fn(&Laws) -> Elastic,
        stiffness: &mut BlockMatrix,
    ) {
        let rest = vec![0.0; 2 * stiffness.pattern().nodes()];
        let (mut rows, is_projected) = (stiffness.rows_mut(), self.is_projected);
        for (cells, laws) in regions.runs(&(0..self.count())) {
            match &law(laws) {
                Elastic::Linear(law) => {
                    let slope = ElasticTangent { law, is_projected };
                    self.add_to(&mut rows, cells, [&rest], &slope);
                }
                Elastic::StVenantKirchhoff(law) => {
                    let slope = ElasticTangent { law, is_projected };
                    self.add_to(&mut rows, cells, [&rest], &slope);
                }
                Elastic::ByPoint(law) => {
                    let slope = ElasticTangent { law, is_projected };
                    self.add_to(&mut rows, cells, [&rest], &slope);
                }
            }
        }
    }

    /// As [`Tangents::add_tangents`](super::Tangents::add_tangents).
    pub(super) fn add_tangents(
        &self,
        regions: &Regions,
        terms: Terms,
        [u, v]: [&[f64]; 2],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let (mut stiffness, mut damping) = (stiffness.rows_mut(), damping.rows_mut());
        let is_projected = self.is_projected;
        for (cells, laws) in regions.runs(&(0..self.count())) {
            if terms.elastic {
                let cells = cells.clone();
                match &laws.elastic {
                    // constant
                    Elastic::Linear(_) => {}
                    Elastic::StVenantKirchhoff(law) => {
                        let slope = ElasticTangent { law, is_projected };
                        self.add_to(&mut stiffness, cells, [u], &slope);
                    }
                    Elastic::ByPoint(law) => {
                        let slope = ElasticTangent { law, is_projected };
                        self.add_to(&mut stiffness, cells, [u], &slope);
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
    }

    fn add_viscous(
        &self,
        cells: Range<usize>,
        [u, v]: [&[f64]; 2],
        law: &impl ViscousLaw,
        stiffness: &mut Rows<'_, 2>,
        damping: &mut Rows<'_, 2>,
    ) {
        let is_projected = self.is_projected;
        self.add_to(damping, cells.clone(), [u], &RateTangent { law, is_projected });
        self.add_to(stiffness, cells, [u, v], &ViscousTangent { law, is_projected });
    }

    /// Adds the tangents of `cells` by the `fields` that `slope` requires.
    fn add_to<const K: usize>(
        &self,
        rows: &mut Rows<'_, 2>,
        cells: Range<usize>,
        fields: [&[f64]; K],
        slope: &impl TangentTerm<K>,
    ) {
        let count = self.of_cell;
        for cell in cells {
            let mut sums = [[[[0.0; 2]; 2]; MOST]; MOST];
            let gradients = |point: usize| fields.map(|field| self.gradient(cell, point, field));
            let of_volume = slope
                .is_projected()
                .then(|| self.add_changes_of_volume(cell, slope, &gradients, &mut sums));
            for point in self.points_of(cell) {
                let gradients = gradients(point);
                let at = Deformation::new(UNIT, gradients[0]);
                let pull = of_volume.as_ref().map(|of_volume| of_volume.at(self.modes_at(point)));
                // with the axes in place of gradients, blocks are dP/dF itself
                let blocks = slope.blocks(&at, &gradients, pull, &UNIT, self.volumes[point]);
                self.add_at(point, &blocks, &mut sums);
            }
            for a in 0..count {
                for b in 0..count {
                    let Some(block) = rows.block_mut(self.entry(cell, [a, b])) else { continue };
                    for i in 0..2 {
                        for k in 0..2 {
                            block[i][k] += sums[a][b][i][k];
                        }
                    }
                }
            }
        }
    }

    /// Adds the contribution of dP/dF at a point.
    fn add_at(
        &self,
        point: usize,
        blocks: &impl Blocks<f64, 3>,
        sums: &mut [[Block<f64, 2>; MOST]; MOST],
    ) {
        let all: [[Block<f64, 3>; 3]; 3] =
            std::array::from_fn(|j| std::array::from_fn(|l| blocks.block(j, l)));
        let elasticity = CHANGES.map(|(i, j)| CHANGES.map(|(k, l)| all[j][l][i][k]));
        let shapes = self.shapes_at(point);
        for (b, of_b) in shapes.iter().map(changes).enumerate() {
            let stresses = of_b.map(|change| elasticity.map(|row| dot(&row, &change)));
            for (a, of_a) in shapes.iter().map(changes).enumerate() {
                for i in 0..2 {
                    for k in 0..2 {
                        sums[a][b][i][k] += dot(&of_a[i], &stresses[k]);
                    }
                }
            }
        }
    }

    /// The `pull` of a projected dilatation of a cell; adds the tangent terms of its coefficients.
    fn add_changes_of_volume<const K: usize>(
        &self,
        cell: usize,
        slope: &impl TangentTerm<K>,
        gradients: &impl Fn(usize) -> [Matrix<f64, 3, 3>; K],
        sums: &mut [[Block<f64, 2>; MOST]; MOST],
    ) -> Projected<f64, 2> {
        let nothing: Vectors = [[0.0; 2]; MOST];
        let (mut force, mut motion) = ([nothing; COEFFICIENTS], [nothing; COEFFICIENTS]);
        let coefficients = if self.modes.is_empty() { 1 } else { 3 };
        let mut dilatations = (Projected::new(0.0), 0.0);
        for point in self.points_of(cell) {
            let (gradients, volume) = (gradients(point), self.volumes[point]);
            let at = Deformation::new(UNIT, gradients[0]);
            let (own, by_pull, by_motion) = slope.swelling(&at, &gradients, &UNIT, volume);
            dilatations.0.add(own, self.modes_at(point));
            dilatations.1 += volume;
            let values = self.values_of_modes(point);
            for (a, of_a) in self.shapes_at(point).iter().map(changes).enumerate() {
                for i in 0..2 {
                    let along = |by: &[[f64; 3]; 3]| dot(&CHANGES.map(|(i, j)| by[j][i]), &of_a[i]);
                    for k in 0..coefficients {
                        force[k][a][i] += values[k] * along(&by_pull);
                        motion[k][a][i] += values[k] * along(&by_motion);
                    }
                }
            }
        }
        let (dilatation, volume) = (dilatations.0.over(dilatations.1), dilatations.1);
        let mut stiff = [[0.0; COEFFICIENTS]; COEFFICIENTS];
        let of_volume = self.projected(cell, |point| {
            let [pull, by_volume] = slope.of_volume(dilatation.at(self.modes_at(point)));
            let (values, weight) = (self.values_of_modes(point), by_volume * self.volumes[point]);
            for k in 0..coefficients {
                for l in 0..coefficients {
                    stiff[k][l] += weight * values[k] * values[l];
                }
            }
            pull
        });
        for k in 0..coefficients {
            for l in 0..coefficients {
                let share = stiff[k][l] / (volume * volume);
                for a in 0..self.of_cell {
                    for b in 0..self.of_cell {
                        for i in 0..2 {
                            for j in 0..2 {
                                sums[a][b][i][j] += share * force[k][a][i] * motion[l][b][j];
                            }
                        }
                    }
                }
            }
        }
        of_volume
    }

    /// The values of the functions onto which a dilatation is projected.
    fn values_of_modes(&self, point: usize) -> [f64; COEFFICIENTS] {
        let [first, second] = self.modes_at(point).copied().unwrap_or_default();
        [1.0, first, second, 0.0]
    }
}
