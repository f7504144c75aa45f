//! Masses of nodes, and means over them: the centre of mass, the rotation.

use super::assembled::Body;
use crate::base::rotation::plane_rotation;

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

    /// Mean of `x` (dimension components per node), weighted by mass.
    pub(crate) fn mass_average(&self, x: &[f64]) -> Vec<f64> {
        self.masses.average(x, self.dimension())
    }

    /// Centre of mass (m) under the displacements `u` (m).
    pub fn centre_of_mass(&self, u: &[f64]) -> Vec<f64> {
        self.masses.centre.iter().zip(self.mass_average(u)).map(|(x, u)| x + u).collect()
    }

    /// Velocity (m/s) of the centre of mass, where nodes have the velocities `v` (m/s).
    pub fn mean_velocity(&self, v: &[f64]) -> Vec<f64> {
        self.mass_average(v)
    }

    /// Angle (rad, counter-clockwise) by which a body in the plane has turned as a whole under the
    /// displacements `u` (m): that of the rotation which, in the mean over its mass, brings the undeformed
    /// shape nearest to the present one. `None` in other dimensions.
    pub(crate) fn rotation(&self, u: &[f64]) -> Option<f64> {
        if self.dimension() != 2 {
            return None;
        }
        let nodes = self.mesh().positions().chunks_exact(2).zip(u.chunks_exact(2));
        let places = nodes.map(|(x, u)| [x[0] + u[0], x[1] + u[1]]);
        Some(plane_rotation(self.arms().into_iter().map(|[a, b, _]| [a, b]).zip(places)))
    }

    /// The mass of each node, times its natural position relative to the centre of mass (kg m); 0 beyond the dimension. They
    /// add up to 0.
    pub(crate) fn arms(&self) -> Vec<[f64; 3]> {
        let (positions, centre, d) =
            (self.mesh().positions(), &self.masses.centre, self.dimension());
        let filled = |arm: &[f64]| std::array::from_fn(|i| arm.get(i).copied().unwrap_or(0.0));
        if self.substances().any(|substance| substance.mass.is_some()) {
            // all mass is at the nodes of a frame, where row sums may be below 0: the whole matrix counts
            let from_centre =
                self.mesh().field(|x| x.iter().zip(centre).map(|(x, c)| x - c).collect());
            let mut arms = vec![0.0; from_centre.len()];
            self.inertia.add_product(d, 1.0, &from_centre, &mut arms);
            return arms.chunks_exact(d).map(filled).collect();
        }
        let arm = |(mass, x): (&f64, &[f64])| {
            filled(&x.iter().zip(centre).map(|(x, c)| mass * (x - c)).collect::<Vec<_>>())
        };
        self.masses.of_nodes.iter().zip(positions.chunks_exact(d)).map(arm).collect()
    }
}
