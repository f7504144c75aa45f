//! Strain, stress and energy density of the cells, for output.
//!
//! Tensors are those of the three-dimensional body that a cell represents. With the frame F_0, E and
//! S of a cell, and n its unit normals (none in a solid, one in a plane or membrane, two in a string):
//!
//! | | strain | stress |
//! | --- | --- | --- |
//! | Cauchy | F_0 E F_0^T + e sum n n^T, n of the undeformed shape | F_0 S F_0^T + s sum n n^T, the same n |
//! | Green | the same | (F S F^T + s sum n n^T) / det F, n of the present shape |
//!
//! Across a cell there is either no strain (plane strain: e = 0, s = lambda tr E) or no stress (plane
//! stress and segments: s = 0, e = -lambda tr E / (2 mu) with their reduced lambda).

mod branches;
mod grown;
mod nodal;
mod revolved;
#[cfg(test)]
mod tests;

pub(super) use branches::BranchFields;
pub(super) use grown::GrownFields;
use nalgebra::{Matrix3, SMatrix, SVD, Vector3};
pub use nodal::NodalField;
pub(super) use nodal::{Probe, nodal_fields};

use super::elements::{ElementsOf, gradient};
use super::projection::Projected;
use super::regions::Regions;
use crate::base::vector::norm;
use crate::elements::material::{Deformation, ElasticLaw, Strain, with_law};

/// Strain, stress and strain energy density of one cell: means over its natural volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellField {
    /// Cauchy's or Green's strain, as the body measures it; a tensor along the axes of space. Strains across
    /// cells in plane stress and across strings are those that leave them without stress.
    pub strain: [[f64; 3]; 3],
    /// Stress (Pa), a tensor along the axes of space. With Green strain it is the true stress, force per
    /// present area; thickness and cross-section of cells that do not fill space count as they were in the
    /// undeformed shape in St. Venant-Kirchhoff material, and as deformed with the other laws. It is the
    /// stress of the elasticity alone: that of Maxwell branches depends on earlier deformations, and not on
    /// the shape ([`Reading::stress`](crate::simulate::Reading::stress) has it in a run).
    pub stress: [[f64; 3]; 3],
    /// Strain energy per natural volume (J/m^3), of the elasticity alone.
    pub energy_density: f64,
}

impl CellField {
    /// The von Mises stress (Pa): sqrt(3/2) times the norm of the stress without its mean pressure.
    pub fn von_mises(&self) -> f64 {
        von_mises(&self.stress)
    }

    /// The pressure (Pa): the mean normal stress with the other sign, above 0 where the body is pressed
    /// together.
    pub fn pressure(&self) -> f64 {
        -Matrix3::from(self.stress).trace() / 3.0
    }

    /// The principal stretches (1), the largest first: ratios of present to natural length along the
    /// principal axes of the strain.
    ///
    /// `strain` is the measure of the body: the stretches are sqrt(1 + 2 E) of Green's strain E, and 1 + E of
    /// Cauchy's.
    pub fn stretches(&self, strain: Strain) -> [f64; 3] {
        let principal = Matrix3::from(self.strain).symmetric_eigenvalues();
        let mut stretches = principal.map(|value| match strain {
            Strain::Cauchy => 1.0 + value,
            Strain::Green => (1.0 + 2.0 * value).max(0.0).sqrt(),
        });
        stretches.as_mut_slice().sort_unstable_by(|a, b| b.total_cmp(a));
        stretches.into()
    }
}

/// The von Mises stress (Pa) of a stress.
pub(crate) fn von_mises(stress: &[[f64; 3]; 3]) -> f64 {
    let stress = Matrix3::from(*stress);
    let deviator = stress - Matrix3::identity() * (stress.trace() / 3.0);
    1.5_f64.sqrt() * deviator.norm()
}

/// Elements as carriers of strain and stress.
pub(super) trait Fields {
    /// Strain energy (J).
    fn energy(&self, regions: &Regions, u: &[f64]) -> f64;

    /// Strain, stress and energy density of each cell.
    fn fields(&self, regions: &Regions, u: &[f64]) -> Vec<CellField>;

    /// Calls `see` with the number of each node of a cell, its number among the nodes of the cell, and the
    /// tensors there.
    fn each_node(
        &self,
        regions: &Regions,
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    );

    /// Angle (rad) by which each cell has turned.
    fn rotations(&self, u: &[f64]) -> Vec<f64>;

    /// Cells with det F <= 0 somewhere; none where cells do not fill space.
    fn inverted(&self, u: &[f64]) -> Vec<usize>;

    /// Ratio of present to natural volume of each cell.
    fn volume_ratios(&self, u: &[f64]) -> Vec<f64>;

    /// Natural volume of each cell (m^3).
    fn volumes(&self) -> Vec<f64>;

    /// The lengths (m) that make the volumes of cells of their areas in a body of revolution.
    fn circles(&self) -> Option<Vec<f64>>;
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Fields
    for ElementsOf<N, M, D, Q>
{
    fn energy(&self, regions: &Regions, u: &[f64]) -> f64 {
        self.strain_energy(regions, u)
    }

    fn fields(&self, regions: &Regions, u: &[f64]) -> Vec<CellField> {
        if let Some(revolved) = &self.revolved {
            return revolved.fields(regions, u);
        }
        let of_cell = |cell| {
            with_law!(regions.of(cell).elastic, law => {
                let of_volume = self.of_volume(&law, cell, self.dilatations(&law, cell, u));
                mean(self.deformed(cell, u).enumerate().map(|(q, (volume, at))| {
                    (volume, PointField::new(&law, &at, of_volume.map(|points| points[q])))
                }))
            })
        };
        (0..self.nodes.len()).map(of_cell).collect()
    }

    fn each_node(
        &self,
        regions: &Regions,
        u: &[f64],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        if let Some(revolved) = &self.revolved {
            return revolved.each_node(regions, u, cell, see);
        }
        let mut at_nodes = [Tensors::default(); N];
        with_law!(regions.of(cell).elastic, law => {
            let of_volume = self.of_volume(&law, cell, self.dilatations(&law, cell, u));
            for (q, (_, at)) in self.deformed(cell, u).enumerate() {
                let PointField { tensors, .. } =
                    PointField::new(&law, &at, of_volume.map(|points| points[q]));
                for (sum, factors) in at_nodes.iter_mut().zip(&self.extrapolation) {
                    sum.add(&tensors, factors[q]);
                }
            }
        });
        for (a, tensors) in at_nodes.iter().enumerate() {
            see(self.nodes[cell][a], a, tensors);
        }
    }

    fn rotations(&self, u: &[f64]) -> Vec<f64> {
        if D == 1 {
            return vec![0.0; self.nodes.len()];
        }
        let of_cell = |cell| {
            let of_point = |(volume, at): (f64, Deformation<f64, M, D>)| {
                let shape = in_space(&SMatrix::from(at.gradient()));
                let frame = in_space(&SMatrix::from(at.frame()));
                (shape * frame.transpose() + normal(&shape) * normal(&frame).transpose()) * volume
            };
            rotation::<M>(&self.deformed(cell, u).map(of_point).sum())
        };
        (0..self.nodes.len()).map(of_cell).collect()
    }

    fn inverted(&self, u: &[f64]) -> Vec<usize> {
        if let Some(revolved) = &self.revolved {
            return revolved.inverted(u);
        }
        let is_inverted =
            |&cell: &usize| M == D && self.deformed(cell, u).any(|(_, at)| at.stretch() <= 0.0);
        (0..self.nodes.len()).filter(is_inverted).collect()
    }

    fn volume_ratios(&self, u: &[f64]) -> Vec<f64> {
        if let Some(revolved) = &self.revolved {
            return revolved.volume_ratios(u);
        }
        let of_cell = |(cell, natural): (usize, f64)| {
            let present = self.deformed(cell, u).map(|(volume, at)| volume * at.stretch());
            present.sum::<f64>() / natural
        };
        self.volumes().into_iter().enumerate().map(of_cell).collect()
    }

    fn volumes(&self) -> Vec<f64> {
        let of_cell = |cell| self.points(cell).map(|point| point.volume).sum();
        (0..self.nodes.len()).map(of_cell).collect()
    }

    fn circles(&self) -> Option<Vec<f64>> {
        self.revolved.as_ref().map(|revolved| revolved.sections())
    }
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The strain points of a cell, their volumes and how they are deformed.
    pub(super) fn deformed(
        &self,
        cell: usize,
        u: &[f64],
    ) -> impl Iterator<Item = (f64, Deformation<f64, M, D>)> {
        let (u, nodes) = (u.as_chunks::<D>().0, &self.nodes[cell]);
        let of_nodes = nodes.map(|node| u[node]);
        self.points(cell).map(move |point| {
            let h = gradient(0, &of_nodes, &point.gradients);
            (point.volume, Deformation::new(point.frame, h))
        })
    }
}

/// Volumetric response of a projected dilatation at a point of its cell.
#[derive(Clone, Copy, Default)]
struct OfVolume {
    /// U', projected, and U (J/m^3).
    pull: f64,
    energy: f64,
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> ElementsOf<N, M, D, Q> {
    /// The dilatations at the points of a cell.
    fn dilatations<L: ElasticLaw>(
        &self,
        law: &L,
        cell: usize,
        u: &[f64],
    ) -> impl Iterator<Item = f64> {
        let deformed = self.deformed(cell, u);
        deformed.map(|(_, at)| law.dilatation(&law.point(L::twice_strain(&at))))
    }

    /// The values at the points of a cell with these `dilatations`, if they are projected.
    fn of_volume<L: ElasticLaw>(
        &self,
        law: &L,
        cell: usize,
        dilatations: impl Iterator<Item = f64>,
    ) -> Option<[OfVolume; Q]> {
        if !self.is_projected() {
            return None;
        }
        let (mut sum, mut whole) = (Projected::new(0.0), 0.0);
        for (q, (point, dilatation)) in self.points(cell).zip(dilatations).enumerate() {
            sum.add(point.volume * dilatation, self.modes_of(cell, q).as_ref());
            whole += point.volume;
        }
        let dilatation = sum.over(whole);
        let (mut pull, mut points) = (Projected::new(0.0), [OfVolume::default(); Q]);
        for (q, point) in self.points(cell).enumerate() {
            let modes = self.modes_of(cell, q);
            let [energy, at_point, _] = law.of_volume(dilatation.at(modes.as_ref()));
            pull.add(point.volume * at_point, modes.as_ref());
            points[q].energy = energy;
        }
        let pull = pull.over(whole);
        for (q, point) in points.iter_mut().enumerate() {
            point.pull = pull.at(self.modes_of(cell, q).as_ref());
        }
        Some(points)
    }
}

/// Strain and stress at a point, or a sum of them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tensors {
    strain: Matrix3<f64>,
    stress: Matrix3<f64>,
}

impl Tensors {
    fn add(&mut self, other: &Self, share: f64) {
        self.strain += other.strain * share;
        self.stress += other.stress * share;
    }

    /// The same with the total strain after growth by the factor `stretch`.
    pub(super) fn after_growth(&self, stretch: f64) -> Self {
        Self { strain: after_growth(self.strain, stretch), ..*self }
    }

    /// Strain and stress: this sum divided by `weight`.
    fn over(&self, weight: f64) -> [[[f64; 3]; 3]; 2] {
        let tensor = |sum: Matrix3<f64>| ((sum + sum.transpose()) / (2.0 * weight)).into();
        [tensor(self.strain), tensor(self.stress)]
    }
}

/// Total Green strain (g^2 (2 E_e + I) - I) / 2 after growth by the factor g = `stretch` and then the elastic strain E_e = `left`.
pub(super) fn after_growth(left: Matrix3<f64>, stretch: f64) -> Matrix3<f64> {
    let more = (stretch - 1.0) * (stretch + 1.0);
    left * (stretch * stretch) + Matrix3::identity() * (0.5 * more)
}

/// The fields at one strain point.
struct PointField {
    tensors: Tensors,
    energy_density: f64,
}

impl PointField {
    fn new<L: ElasticLaw, const M: usize, const D: usize>(
        law: &L,
        at: &Deformation<f64, M, D>,
        of_volume: Option<OfVolume>,
    ) -> Self {
        let twice_strain = L::twice_strain(at);
        let point = law.point(twice_strain);
        let pull = of_volume.map(|at| at.pull);
        let [strain_across, stress_across] = law.across(&point, pull);
        let energy_density = match of_volume {
            None => law.energy(&point),
            Some(of_volume) => law.energy_of_shape(&point) + of_volume.energy,
        };
        let swelling = swelling(law, at);
        let [frame, shape] =
            [at.frame(), L::shape(at)].map(|columns| in_space(&SMatrix::from(columns)));
        let strain = SMatrix::from(twice_strain) * 0.5;
        let stress = SMatrix::from(law.stress(&point, pull, 1.0));
        let tensors = Tensors {
            strain: frame * strain * frame.transpose() + normal_part(&frame) * strain_across,
            stress: (shape * stress * shape.transpose() + normal_part(&shape) * stress_across)
                / swelling,
        };
        Self { tensors, energy_density }
    }
}

/// Ratio of present to natural volume, to which the true stress refers.
fn swelling<L: ElasticLaw, const M: usize, const D: usize>(
    law: &L,
    at: &Deformation<f64, M, D>,
) -> f64 {
    match L::SMALL_STRAIN {
        true => 1.0,
        false => at.stretch() * law.thickness(&law.point(L::twice_strain(at))),
    }
}

/// The mean of `points`, each with the volume that it represents.
fn mean(points: impl Iterator<Item = (f64, PointField)>) -> CellField {
    let (mut volume, mut energy, mut sum) = (0.0, 0.0, Tensors::default());
    for (share, point) in points {
        volume += share;
        sum.add(&point.tensors, share);
        energy += point.energy_density * share;
    }
    let [strain, stress] = sum.over(volume);
    CellField { strain, stress, energy_density: energy / volume }
}

/// `frame` with a row for each axis of three-dimensional space.
fn in_space<const M: usize, const D: usize>(frame: &SMatrix<f64, D, M>) -> SMatrix<f64, 3, M> {
    SMatrix::from_fn(|i, j| if i < D { frame[(i, j)] } else { 0.0 })
}

/// The unit normal of a cell of dimension 2 with the tangents `frame`; 0 of others and of one pressed flat.
fn normal<const M: usize>(frame: &SMatrix<f64, 3, M>) -> Vector3<f64> {
    match M {
        2 => {
            let across = Vector3::from(frame.column(0)).cross(&frame.column(1));
            across.try_normalize(0.0).unwrap_or_default()
        }
        _ => Vector3::zeros(),
    }
}

/// Angle (rad) of the rotation nearest to the map `a` of a cell of dimension `M`; of a segment, which `a`
/// maps along its tangent alone, the angle between its tangents.
fn rotation<const M: usize>(a: &Matrix3<f64>) -> f64 {
    if M == 1 {
        return (a.trace() / a.norm()).clamp(-1.0, 1.0).acos();
    }
    if [a.m13, a.m23, a.m31, a.m32] == [0.0; 4] {
        return (a.m21 - a.m12).atan2(a.m11 + a.m22).abs();
    }
    let Some(SVD { u: Some(left), v_t: Some(right), .. }) =
        a.try_svd(true, true, f64::EPSILON, 100)
    else {
        return 0.0; // not finite
    };
    let mut mirror = Matrix3::identity();
    mirror.m33 = (left * right).determinant().signum();
    let turn = left * mirror * right;
    let axis = [turn.m32 - turn.m23, turn.m13 - turn.m31, turn.m21 - turn.m12];
    norm(&axis).atan2(turn.trace() - 1.0)
}

/// sum n n^T over the unit normals of the space that the columns of `frame` span.
fn normal_part<const M: usize>(frame: &SMatrix<f64, 3, M>) -> Matrix3<f64> {
    match frame.tr_mul(frame).try_inverse() {
        Some(inverse) if M < 3 => Matrix3::identity() - frame * inverse * frame.transpose(),
        // a solid has no normals; those of a cell pressed flat are undefined
        _ => Matrix3::zeros(),
    }
}
