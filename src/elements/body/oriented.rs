//! Cells that grow by direction: their strain points have frames that begin with it.

use super::elements::{ElementsOf, side_by_side};
use super::forces::ElasticStress;
use super::regions::Regions;
use super::tangents::ElasticTangent;
use crate::base::input::InputError;
use crate::base::sparse::BlockMatrix;
use crate::base::tensor::{apply, dot};
use crate::elements::basis::StrainPoint;
use crate::elements::material::{ByPoint, FibreDirection, GrownLaw, Stretches, with_law};
use crate::elements::mesh::Mesh;
use crate::integrators::ode::Failure;

/// Elements that can grow by direction.
pub(super) trait Orientable {
    /// Some `cells` with the directions of a `course`; without one these make no difference.
    ///
    /// # Errors
    /// Vectors of another dimension; a point where it has no direction.
    fn oriented(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        course: Option<&FibreDirection>,
    ) -> Result<Box<dyn Oriented>, InputError>;
}

/// Laws of cells, their growth stretches, and whether plane strain prevents growth across them.
#[derive(Clone, Copy)]
pub(super) struct Grown<'r> {
    pub(super) regions: &'r Regions,
    pub(super) stretches: Stretches,
    pub(super) is_pressed: bool,
}

impl Grown<'_> {
    fn law<'l>(&self, law: &'l ByPoint) -> GrownLaw<'l> {
        GrownLaw { law, stretches: self.stretches, is_pressed: self.is_pressed }
    }
}

/// Cells of any type with directions. None has a law of small strain.
pub(super) trait Oriented: Send + Sync {
    /// Adds their forces (N).
    fn add_forces(&self, grown: Grown, u: &[f64], forces: &mut [f64]) -> Result<(), Failure>;

    /// Adds their tangents to the stiffness. The damping does not change: its rows are only divided among threads with those of the stiffness.
    fn add_tangents(
        &self,
        grown: Grown,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    );

    /// Strain energy (J).
    fn energy(&self, grown: Grown, u: &[f64]) -> f64;

    /// The power (W) that growth supplies as their stretches along and across the direction change by these `rates` (1/s), each by that of
    /// itself.
    fn power(&self, grown: Grown, rates: [f64; 2], u: &[f64]) -> f64;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Orientable
    for ElementsOf<N, M, D, Q>
{
    fn oriented(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        course: Option<&FibreDirection>,
    ) -> Result<Box<dyn Oriented>, InputError> {
        course.map_or(Ok(()), |course| course.validate_in(D))?;
        let mut points = Vec::with_capacity(Q * cells.len());
        for &cell in cells {
            let directions = self.directions_of_growth(mesh, cell, course)?;
            points.extend(self.points(cell).zip(directions).map(|(point, a)| along(point, &a)));
        }
        let own = self.sampled(cells, &vec![1.0; cells.len()], None, mesh.node_count());
        Ok(Box::new(Self { points: side_by_side::<N, M, D, Q>(&points).into(), ..own }))
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The directions of growth along a `course` at the points of a cell, of length 1 and in its coordinates.
    ///
    /// # Errors
    /// A point where it has none.
    pub(super) fn directions_of_growth(
        &self,
        mesh: &Mesh,
        cell: usize,
        course: Option<&FibreDirection>,
    ) -> Result<[[f64; M]; Q], InputError> {
        match course {
            Some(course) => self.directions(mesh, cell, course),
            None => Ok([std::array::from_fn(|j| f64::from(u8::from(j == 0))); Q]),
        }
    }
}

/// The point with a frame that begins with the direction `a` of its cell.
fn along<const N: usize, const M: usize, const D: usize>(
    point: StrainPoint<f64, N, M, D>,
    a: &[f64; M],
) -> StrainPoint<f64, N, M, D> {
    let mut frame = point.frame;
    frame[0] = apply(&point.frame, a);
    // coordinates of a cell that fills space are those of space
    if M == D {
        return StrainPoint { frame, ..point };
    }
    let mut axes = [*a; M];
    if M == 2 {
        axes[1][0] = -a[1];
        axes[1][1] = a[0];
        frame[1] = apply(&point.frame, &axes[1]);
    }
    let gradients = point.gradients.map(|gradient| axes.map(|axis| dot(&axis, &gradient)));
    StrainPoint { gradients, frame, ..point }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Oriented
    for ElementsOf<N, M, D, Q>
{
    fn add_forces(&self, grown: Grown, u: &[f64], forces: &mut [f64]) -> Result<(), Failure> {
        self.shares.each_force(D, forces, &|run, first, forces| {
            grown.regions.runs(run).try_for_each(|(cells, laws)| {
                let Some(law) = &laws.elastic.called() else { return Ok(()) };
                let (law, is_projected) = (&grown.law(law), self.is_projected());
                self.add(cells, [u], first, forces, ElasticStress { law, is_projected })
            })
        })
    }

    fn add_tangents(
        &self,
        grown: Grown,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        self.shares.each(stiffness.rows_mut::<D>(), damping.rows_mut(), &|share, mut rows, _| {
            let runs = self.shares.cells[share].iter();
            for (cells, laws) in runs.flat_map(|run| grown.regions.runs(run)) {
                let Some(law) = &laws.elastic.called() else { continue };
                let (law, is_projected) = (&grown.law(law), self.is_projected());
                self.add_to(&mut rows, cells, [u], ElasticTangent { law, is_projected });
            }
        });
    }

    fn energy(&self, grown: Grown, u: &[f64]) -> f64 {
        let all = 0..self.nodes.len();
        grown.regions.runs(&all).fold(0.0, |sum, (cells, laws)| match &laws.elastic.called() {
            Some(law) => self.add_energy(cells, &grown.law(law), u, sum),
            None => sum,
        })
    }

    fn power(&self, grown: Grown, rates: [f64; 2], u: &[f64]) -> f64 {
        let of_cell = |cell| {
            let mut directions = [[0.0; M]; Q];
            for ((_, at), direction) in self.deformed(cell, u).zip(&mut directions) {
                *direction = at.first_axis();
            }
            with_law!(&grown.regions.of(cell).elastic, law => {
                let left = self.left(law, &grown, cell, u, &directions);
                left.map(|(volume, left)| volume * left.power(grown.stretches, rates)).sum::<f64>()
            })
        };
        (0..self.nodes.len()).map(of_cell).sum()
    }
}
