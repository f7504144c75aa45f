//! The forces of the cells of a body of revolution.

use std::ops::Range;

use super::Terms;
use super::stress::{ElasticStress, StressTerm, ViscousStress};
use crate::base::tensor::Matrix;
use crate::elements::body::projection::Projected;
use crate::elements::body::regions::{Laws, Regions};
use crate::elements::body::revolved::{Revolved, UNIT, hoop};
use crate::elements::force::NodalForces;
use crate::elements::material::{Deformation, Elastic, Hooke, Hookean, Linear, ObjectiveViscosity};
use crate::integrators::ode::Failure;

impl Revolved {
    /// As [`Forces::add_forces`](super::Forces::add_forces).
    pub(super) fn add_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let is_projected = self.is_projected;
        for (cells, laws) in regions.runs(&(0..self.count())) {
            if terms.elastic {
                let (cells, forces) = (cells.clone(), &mut forces.conservative[..]);
                match &laws.elastic {
                    Elastic::Linear(law) => {
                        self.add((cells, true), [u], forces, &ElasticStress { law, is_projected })?;
                    }
                    Elastic::StVenantKirchhoff(law) => {
                        self.add(
                            (cells, false),
                            [u],
                            forces,
                            &ElasticStress { law, is_projected },
                        )?;
                    }
                    Elastic::ByPoint(law) => {
                        self.add(
                            (cells, false),
                            [u],
                            forces,
                            &ElasticStress { law, is_projected },
                        )?;
                    }
                }
            }
            if terms.viscous {
                let forces = &mut forces.dissipative[..];
                match &laws.objective {
                    ObjectiveViscosity::Hookean(law) => {
                        self.add(
                            (cells, false),
                            [u, v],
                            forces,
                            &ViscousStress { law, is_projected },
                        )?;
                    }
                    ObjectiveViscosity::Newtonian(law) => {
                        self.add(
                            (cells, false),
                            [u, v],
                            forces,
                            &ViscousStress { law, is_projected },
                        )?;
                    }
                }
            }
        }
        Ok(())
    }

    /// As [`Forces::add_linear_forces`](super::Forces::add_linear_forces).
    pub(super) fn add_linear_forces(
        &self,
        regions: &Regions,
        terms: Terms,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let add = |x: &[f64], hooke: fn(&Laws) -> Hooke, forces: &mut [f64]| {
            regions.runs(&(0..self.count())).try_for_each(|(cells, laws)| {
                let law: Linear = Hookean(hooke(laws));
                let pull = ElasticStress { law: &law, is_projected: self.is_projected };
                self.add((cells, true), [x], forces, &pull)
            })
        };
        if terms.elastic {
            add(u, |laws| laws.hooke, &mut forces.conservative)?;
        }
        if terms.viscous {
            add(v, |laws| laws.viscous, &mut forces.dissipative)?;
        }
        Ok(())
    }

    /// Adds the forces of `cells` by the `fields` that `pull` requires, the first of which moves them, unless strains `are_small`.
    fn add<const K: usize>(
        &self,
        (cells, are_small): (Range<usize>, bool),
        fields: [&[f64]; K],
        forces: &mut [f64],
        pull: &impl StressTerm<K>,
    ) -> Result<(), Failure> {
        for cell in cells {
            let gradients = |point: usize| fields.map(|field| self.gradient(cell, point, field));
            let of_volume = pull.is_projected().then(|| self.of_volume(cell, pull, &gradients));
            for point in self.points_of(cell) {
                let gradients = gradients(point);
                let at = Deformation::new(UNIT, gradients[0]);
                let own = of_volume.as_ref().map(|of_volume| of_volume.at(self.modes_at(point)));
                let (stress, domain) = pull.stress(&at, &gradients, own, self.volumes[point]);
                // false for NaN
                let is_inside = domain > 0.0 && (are_small || hoop(&at) > 0.0);
                if !is_inside {
                    return Err(self.outside(cell, hoop(&at), pull.outside(domain)));
                }
                for (node, [by_r, by_z, hoop]) in
                    self.nodes_of(cell).iter().zip(self.shapes_at(point))
                {
                    let [along_r, along_z, around] = &stress;
                    forces[2 * node] -= along_r[0] * by_r + along_z[0] * by_z + around[2] * hoop;
                    forces[2 * node + 1] -= along_r[1] * by_r + along_z[1] * by_z;
                }
            }
        }
        Ok(())
    }

    /// The `pull` of a projected dilatation of a cell.
    fn of_volume<const K: usize>(
        &self,
        cell: usize,
        pull: &impl StressTerm<K>,
        gradients: &impl Fn(usize) -> [Matrix<f64, 3, 3>; K],
    ) -> Projected<f64, 2> {
        let dilatation = self.projected(cell, |point| {
            let gradients = gradients(point);
            pull.dilatation(&Deformation::new(UNIT, gradients[0]), &gradients)
        });
        self.projected(cell, |point| pull.of_volume(dilatation.at(self.modes_at(point))))
    }

    #[cold]
    fn outside(&self, cell: usize, hoop: f64, problem: String) -> Failure {
        let problem = match hoop > 0.0 {
            true => problem,
            false => "lies beyond the axis r = 0: load it less, or refine the mesh there".into(),
        };
        let nodes: Vec<usize> = self.nodes_of(cell).iter().map(|node| node + 1).collect();
        let number = self.number(cell) + 1;
        Failure::Recoverable(format!("cell {number} (nodes {nodes:?}) {problem}"))
    }
}
