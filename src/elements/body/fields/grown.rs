//! Elastic deformation F_e = F G^-1 of cells that have grown by direction, with the fields and the power that follow from it.

use nalgebra::{Matrix3, SMatrix};

use super::{CellField, OfVolume, PointField, Tensors, in_space, mean, normal_part};
use crate::base::tensor::{Matrix, dot, product};
use crate::elements::body::elements::ElementsOf;
use crate::elements::body::oriented::Grown;
use crate::elements::material::{
    Deformation, ElasticLaw, FibreDirection, Stretches, along_cell, with_law,
};
use crate::elements::mesh::Mesh;

/// Elements as carriers of strain and stress where they have grown along a `course`.
pub(in crate::elements::body) trait GrownFields {
    /// The fields of one cell.
    fn grown_field(
        &self,
        grown: Grown,
        course: (&Mesh, Option<&FibreDirection>),
        u: &[f64],
        cell: usize,
    ) -> CellField;

    /// As [`each_node`](super::Fields::each_node).
    fn each_grown_node(
        &self,
        grown: Grown,
        course: (&Mesh, Option<&FibreDirection>),
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    );
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> GrownFields
    for ElementsOf<N, M, D, Q>
{
    fn grown_field(
        &self,
        grown: Grown,
        course: (&Mesh, Option<&FibreDirection>),
        u: &[f64],
        cell: usize,
    ) -> CellField {
        mean(self.grown_points(grown, course, u, cell).into_iter())
    }

    fn each_grown_node(
        &self,
        grown: Grown,
        course: (&Mesh, Option<&FibreDirection>),
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        let points = self.grown_points(grown, course, u, cell);
        for (a, factors) in self.extrapolation.iter().enumerate() {
            let mut at_node = Tensors::default();
            for ((_, point), factor) in points.iter().zip(factors) {
                at_node.add(&point.tensors, *factor);
            }
            see(self.nodes[cell][a], a, &at_node);
        }
    }
}

/// The state of a point that has grown.
pub(in crate::elements::body) struct Left<const M: usize> {
    /// a, in the coordinates of the cell.
    direction: [f64; M],
    /// 2 E_e and S_e (Pa) along the cell, and across it.
    twice: Matrix<f64, M, M>,
    stress: Matrix<f64, M, M>,
    twice_across: f64,
    stress_across: f64,
    /// Ratio of present thickness, or section, to that without stress.
    thickness: f64,
    /// W(F_e) (J/m^3)
    energy: f64,
}

impl<const M: usize> Left<M> {
    fn new<L: ElasticLaw>(
        law: &L,
        grown: &Grown,
        direction: [f64; M],
        twice: Matrix<f64, M, M>,
        of_volume: Option<OfVolume>,
    ) -> Self {
        let pull = of_volume.map(|at| at.pull);
        if grown.is_pressed {
            let solid = grown.stretches.pressed(&twice);
            let point = law.point(solid);
            let stress = law.stress(&point, pull, 1.0);
            return Self {
                direction,
                twice,
                stress: along_cell(&stress),
                twice_across: solid[2][2],
                stress_across: stress[2][2],
                thickness: 1.0 / grown.stretches.across,
                energy: energy(law, &point, of_volume),
            };
        }
        let point = law.point(twice);
        let [strain_across, _] = law.across(&point, pull);
        Self {
            direction,
            twice,
            stress: law.stress(&point, pull, 1.0),
            twice_across: 2.0 * strain_across,
            // a solid, or free
            stress_across: 0.0,
            thickness: law.thickness(&point),
            energy: energy(law, &point, of_volume),
        }
    }

    /// Power density (W/m^3) supplied by growth at fixed F: the rate of det(G) W(F G^-1) for these rates (1/s) of the stretches along
    /// and across the direction, each relative to the stretch itself.
    pub(in crate::elements::body) fn power(
        &self,
        stretches: Stretches,
        [along, across]: [f64; 2],
    ) -> f64 {
        let mut c = self.twice;
        (0..M).for_each(|j| c[j][j] += 1.0);
        // F_e^T P_e, whose part along a growth relieves
        let work = product(&c, &self.stress);
        let of_all = (0..M).map(|j| work[j][j]).sum::<f64>()
            + (1.0 + self.twice_across) * self.stress_across;
        let own: f64 = (0..M).map(|j| self.direction[j] * dot(&work[j], &self.direction)).sum();
        let swells = (along + 2.0 * across) * self.energy;
        stretches.volume() * (swells - along * own - across * (of_all - own))
    }

    /// The fields of the point, which is deformed as `at`: the strain of F, the stress of F_e.
    fn field<const D: usize>(
        &self,
        at: &Deformation<f64, M, D>,
        stretches: Stretches,
    ) -> PointField {
        let Stretches { along, across } = stretches;
        let frame = in_space(&SMatrix::from(at.frame()));
        let a = frame * SMatrix::<f64, M, 1>::from(self.direction);
        let of_growth = |x: f64, y: f64| Matrix3::identity() * y + a * a.transpose() * (x - y);
        let left = frame * SMatrix::from(self.twice) * frame.transpose()
            + normal_part(&frame) * self.twice_across;
        let g = of_growth(along, across);
        let more = |g: f64| (g - 1.0) * (g + 1.0);
        let strain = (g * left * g + of_growth(more(along), more(across))) * 0.5;

        let shape = product(&at.gradient(), &stretches.inverse(&self.direction));
        let shape = in_space(&SMatrix::from(shape));
        let natural = match M {
            1 => along,
            2 => along * across,
            _ => stretches.volume(),
        };
        let stress = shape * SMatrix::from(self.stress) * shape.transpose()
            + normal_part(&shape) * ((1.0 + self.twice_across) * self.stress_across);
        let stress = stress * (natural / (at.stretch() * self.thickness));
        PointField {
            tensors: Tensors { strain, stress },
            energy_density: stretches.volume() * self.energy,
        }
    }
}

fn energy<L: ElasticLaw, const M: usize>(
    law: &L,
    point: &L::Point<f64, M>,
    of_volume: Option<OfVolume>,
) -> f64 {
    match of_volume {
        None => law.energy(point),
        Some(of_volume) => law.energy_of_shape(point) + of_volume.energy,
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The points of a cell that has grown along these `directions`, with their volumes.
    pub(in crate::elements::body) fn left<L: ElasticLaw>(
        &self,
        law: &L,
        grown: &Grown,
        cell: usize,
        u: &[f64],
        directions: &[[f64; M]; Q],
    ) -> impl Iterator<Item = (f64, Left<M>)> {
        let twice = |((_, at), a): ((f64, Deformation<f64, M, D>), &[f64; M])| {
            grown.stretches.left(a, &at.twice_green())
        };
        let all = || self.deformed(cell, u).zip(directions).map(twice);
        let dilatation = |twice: Matrix<f64, M, M>| match grown.is_pressed {
            true => law.dilatation(&law.point(grown.stretches.pressed(&twice))),
            false => law.dilatation(&law.point(twice)),
        };
        let of_volume = self.of_volume(law, cell, all().map(dilatation));
        let points = self.points(cell).zip(all()).zip(directions).enumerate();
        points.map(move |(q, ((point, twice), a))| {
            let of_volume = of_volume.map(|points| points[q]);
            (point.volume, Left::new(law, grown, *a, twice, of_volume))
        })
    }

    /// The fields at the points of a cell that has grown along a `course`, with their volumes.
    fn grown_points(
        &self,
        grown: Grown,
        (mesh, course): (&Mesh, Option<&FibreDirection>),
        u: &[f64],
        cell: usize,
    ) -> Vec<(f64, PointField)> {
        // there are some: this was checked before the cell grew
        let directions = self.directions_of_growth(mesh, cell, course);
        let directions = directions.unwrap_or([[f64::NAN; M]; Q]);
        with_law!(&grown.regions.of(cell).elastic, law => {
            let left = self.left(law, &grown, cell, u, &directions);
            let points = left.zip(self.deformed(cell, u));
            let field = |((volume, left), (_, at)): ((f64, Left<M>), (f64, Deformation<f64, M, D>))| {
                (volume, left.field(&at, grown.stretches))
            };
            points.map(field).collect()
        })
    }
}
