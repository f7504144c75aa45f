//! Masses of nodes, and means over them: the centre of mass, the rotation.

use super::assembled::Body;

impl Body {
    /// Total mass (kg).
    pub fn mass(&self) -> f64 {
        self.masses.total
    }

    /// Mass that moves with each node (kg): the row sums of m. Unless inertia is lumped, those of corners of
    /// quadratic cells may be 0 or below.
    pub fn nodal_masses(&self) -> Vec<f64> {
        self.masses.of_nodes.clone()
    }

    /// Mean of `x` (dimension components per node), weighted by mass. Of a body of revolution it is along the axis.
    pub(crate) fn mass_average(&self, x: &[f64]) -> Vec<f64> {
        self.along_axis(self.masses.average(x, self.dimension()))
    }

    /// A mean vector; the components along r of a body of revolution cancel each other.
    fn along_axis(&self, mut mean: Vec<f64>) -> Vec<f64> {
        if self.is_axisymmetric() {
            mean[0] = 0.0;
        }
        mean
    }

    /// Centre of mass (m) under the displacements `u` (m).
    pub fn centre_of_mass(&self, u: &[f64]) -> Vec<f64> {
        let centre = self.masses.centre.iter().zip(self.mass_average(u));
        self.along_axis(centre.map(|(x, u)| x + u).collect())
    }

    /// Velocity (m/s) of the centre of mass, where nodes have the velocities `v` (m/s).
    pub fn mean_velocity(&self, v: &[f64]) -> Vec<f64> {
        self.mass_average(v)
    }

    /// Angle (rad, counter-clockwise) by which a body in the plane has turned as a whole under the
    /// displacements `u` (m): that of the rotation which, in the mean over its mass, brings the undeformed
    /// shape nearest to the present one. `None` in other dimensions, and of a body of revolution.
    pub(crate) fn rotation(&self, u: &[f64]) -> Option<f64> {
        if self.dimension() != 2 || self.is_axisymmetric() {
            return None;
        }
        Some(self.rotation_by(&self.arms(), u))
    }

    /// The mass of each node of a body in the plane, times its natural position relative to the centre of
    /// mass (kg m). They add up to 0.
    pub(crate) fn arms(&self) -> Vec<[f64; 2]> {
        let (positions, centre) = (self.mesh().positions(), &self.masses.centre);
        if self.substances().any(|substance| substance.mass.is_some()) {
            // all mass is at the nodes of a frame, where row sums may be below 0: the whole matrix counts
            let from_centre = self.mesh().field(|x| vec![x[0] - centre[0], x[1] - centre[1]]);
            let mut arms = vec![0.0; from_centre.len()];
            self.inertia.add_product(2, 1.0, &from_centre, &mut arms);
            return arms.as_chunks::<2>().0.to_vec();
        }
        let arm = |(mass, x): (&f64, &[f64])| [0, 1].map(|i| mass * (x[i] - centre[i]));
        self.masses.of_nodes.iter().zip(positions.chunks_exact(2)).map(arm).collect()
    }

    /// The [`rotation`](Self::rotation) of a body in the plane, by its `arms`.
    pub(crate) fn rotation_by(&self, arms: &[[f64; 2]], u: &[f64]) -> f64 {
        let nodes = self.mesh().positions().chunks_exact(2).zip(u.chunks_exact(2));
        let (mut along, mut across) = (0.0, 0.0);
        for ([a, b], (x, u)) in arms.iter().zip(nodes) {
            // relative to any point: the arms add up to 0
            let [x, y] = [x[0] + u[0], x[1] + u[1]];
            along += a * x + b * y;
            across += a * y - b * x;
        }
        across.atan2(along)
    }
}
