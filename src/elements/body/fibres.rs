//! The fibres of a body: strings through the strain points of its cells.
//!
//! A fibre at a point of a cell depends on the strain in its direction there. It is a cell of one dimension on the
//! same nodes: its gradients are those of the shape functions along it, and its frame is its direction.

use super::contraction::{Contraction, ContractionTangent};
use super::elements::ElementsOf;
use super::forces::ElasticStress;
use super::offset::Offset;
use super::tangents::ElasticTangent;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::base::tensor::{apply, dot};
use crate::elements::basis::StrainPoint;
use crate::elements::material::{Fibre, FibreDirection};
use crate::elements::mesh::Mesh;
use crate::integrators::ode::Failure;

/// Elements that fibres can lie in.
pub(super) trait Reinforced {
    /// The fibres of a `course` in some cells.
    fn fibres(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        course: &FibreDirection,
    ) -> Result<Box<dyn Strings>, InputError>;
}

/// Fibres in cells of any kind.
pub(super) trait Strings: Send + Sync {
    fn add_forces(&self, law: &Fibre, u: &[f64], forces: &mut [f64]) -> Result<(), Failure>;

    /// Adds tangents to the stiffness. The damping does not change: its rows are only divided among threads
    /// with those of the stiffness.
    fn add_tangents(
        &self,
        law: &Fibre,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );

    fn energy(&self, law: &Fibre, u: &[f64]) -> f64;

    /// Adds the forces of a contraction.
    fn contract(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Failure>;

    /// Adds the tangents of a contraction to the stiffness and to the damping.
    fn add_contraction_tangents(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );

    /// The integral of the stress of a contraction over their volume (N m).
    fn total_pull(&self, contraction: Contraction, u: &[f64], v: &[f64]) -> f64;

    /// Their natural volume (m^3): that of their cells.
    fn volume(&self) -> f64;

    /// The same on the nodes of several bodies.
    fn among_others(&self, offset: Offset) -> Box<dyn Strings>;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Reinforced
    for ElementsOf<N, M, D, Q>
{
    fn fibres(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        course: &FibreDirection,
    ) -> Result<Box<dyn Strings>, InputError> {
        course.validate_in(D)?;
        let mut points = Vec::with_capacity(Q * cells.len());
        for &cell in cells {
            let directions = self.directions(mesh, cell, course)?;
            points.extend(self.points(cell).zip(directions).map(|(point, own)| StrainPoint {
                gradients: std::array::from_fn(|a| [dot(&point.gradients[a], &own)]),
                frame: [apply(&point.frame, &own)],
                volume: point.volume,
            }));
        }
        Ok(Box::new(self.with_points(cells, &points, mesh.node_count())))
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The directions of a `course` at the points of a cell, of length 1 and in its coordinates.
    ///
    /// # Errors
    /// A point where it has none.
    pub(super) fn directions(
        &self,
        mesh: &Mesh,
        cell: usize,
        course: &FibreDirection,
    ) -> Result<[[f64; M]; Q], InputError> {
        let positions = mesh.positions().as_chunks::<D>().0;
        let of_nodes = self.nodes[cell].map(|node| positions[node]);
        let mut directions = [[0.0; M]; Q];
        for ((point, values), own) in self.points(cell).zip(&self.values).zip(&mut directions) {
            let mut position = [0.0; D];
            for (value, of_node) in values.iter().zip(&of_nodes) {
                position.iter_mut().zip(of_node).for_each(|(x, of_node)| *x += value * of_node);
            }
            let direction = course.at(&position);
            *own = std::array::from_fn(|j| {
                point.frame[j].iter().zip(&direction).map(|(e, d)| e * d).sum()
            });
            let length = dot(own, own).sqrt();
            // round-off of the components of a unit vector
            if length < 1e-9 {
                let help = "fibres have no direction there: move their axis out of the cell, turn them into the membrane, or \
                            give them a region of their own";
                return Err(InputError::new("fibres in cell", cell + 1, help));
            }
            own.iter_mut().for_each(|x| *x /= length);
            // fibres have no sign, and the frame of a cell that fills a line is the identity
            if D == 1 {
                *own = own.map(f64::abs);
            }
        }
        Ok(directions)
    }
}

impl<const N: usize, const D: usize, const Q: usize> Strings for ElementsOf<N, 1, D, Q> {
    fn add_forces(&self, law: &Fibre, u: &[f64], forces: &mut [f64]) -> Result<(), Failure> {
        self.shares.each_force(D, forces, &|run, first, forces| {
            self.add(run.clone(), [u], first, forces, ElasticStress { law, is_projected: false })
        })
    }

    fn add_tangents(
        &self,
        law: &Fibre,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        self.shares.each(stiffness.rows_mut::<D>(), damping.rows_mut(), &|share, mut rows, _| {
            for run in &self.shares.cells[share] {
                self.add_to(
                    &mut rows,
                    run.clone(),
                    [u],
                    ElasticTangent { law, is_projected: false },
                );
            }
        });
    }

    fn energy(&self, law: &Fibre, u: &[f64]) -> f64 {
        self.add_energy(0..self.nodes.len(), law, u, 0.0)
    }

    fn contract(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        forces: &mut [f64],
    ) -> Result<(), Failure> {
        self.shares.each_force(D, forces, &|run, first, forces| {
            self.add(run.clone(), [u, v], first, forces, contraction)
        })
    }

    fn add_contraction_tangents(
        &self,
        contraction: Contraction,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let rows = (stiffness.rows_mut(), damping.rows_mut());
        self.shares.each(rows.0, rows.1, &|share, mut stiffness, mut damping| {
            for run in &self.shares.cells[share] {
                let by_shape = ContractionTangent::<false>(contraction);
                self.add_to(&mut stiffness, run.clone(), [u, v], by_shape);
                let by_rate = ContractionTangent::<true>(contraction);
                self.add_to(&mut damping, run.clone(), [u, v], by_rate);
            }
        });
    }

    fn total_pull(&self, contraction: Contraction, u: &[f64], v: &[f64]) -> f64 {
        Self::total_pull(self, contraction, u, v)
    }

    fn volume(&self) -> f64 {
        let points = (0..self.nodes.len()).flat_map(|cell| self.points(cell));
        points.map(|point| point.volume).sum()
    }

    fn among_others(&self, offset: Offset) -> Box<dyn Strings> {
        Box::new(Self::among_others(self, offset))
    }
}

#[cfg(test)]
mod tests;
