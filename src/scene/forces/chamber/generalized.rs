//! The force of a chamber along shapes: the area within its walls is a quadratic function of their coordinates, the volume a
//! cubic one.

use super::{ChamberForce, Geometry};
use crate::base::vector::{dot, largest};
use crate::elements::force::{GeneralizedForce, NodalForces};
use crate::integrators::ode::Failure;
use crate::scene::forces::signal::{self, Signal, finite_at};

/// The force p dV/dz on the coordinates z of shapes.
pub(super) struct GeneralizedPressure {
    name: String,
    pressure: Vec<Signal>,
    /// dV/dz and d^2V/dz^2 at z = 0, and d^3V/dz^3, by rows; the last one is empty where it is 0.
    gradient: Vec<f64>,
    hessian: Vec<f64>,
    third: Vec<f64>,
    /// d^2V/dz^2, and half of its change since z = 0, at the last z.
    slopes: [Vec<f64>; 2],
}

/// Multiplications that a part of the walls in space takes, a node of it for each shape, and the third derivatives for
/// each of their numbers.
const OF_PART: usize = 40;

impl ChamberForce {
    /// Whether the walls take more multiplications than the derivatives along so many shapes.
    pub(super) fn is_larger_than(&self, shapes: usize) -> bool {
        match &self.geometry {
            Geometry::Polygon(..) => true,
            Geometry::Surface(surface, _) => {
                shapes.saturating_pow(3) <= OF_PART * surface.parts() * shapes
            }
            Geometry::Circles(circles, _) => {
                shapes.saturating_pow(3) <= OF_PART * circles.edges() * shapes
            }
        }
    }

    /// The force along `shapes` from displacements `origin`.
    pub(super) fn along(&self, origin: &[f64], shapes: &[&[f64]]) -> GeneralizedPressure {
        let count = shapes.len();
        // of the size that makes the largest displacement 1 m: no matter which, as the derivatives are those of polynomials
        let sizes: Vec<f64> = shapes.iter().map(|shape| 1.0 / largest(shape)).collect();
        let gradient = |moved: &[usize]| -> Vec<f64> {
            let mut u = origin.to_vec();
            for &shape in moved {
                u.iter_mut().zip(shapes[shape]).for_each(|(u, x)| *u += sizes[shape] * x);
            }
            let mut nodal = vec![0.0; u.len()];
            self.add_gradient(1.0, &u, &mut nodal);
            shapes.iter().map(|shape| dot(shape, &nodal)).collect()
        };
        let start = gradient(&[]);
        let once: Vec<Vec<f64>> = (0..count).map(|k| gradient(&[k])).collect();
        let mut third = Vec::new();
        if !matches!(self.geometry, Geometry::Polygon(..)) {
            third = vec![0.0; count * count * count];
            for k in 0..count {
                for l in 0..=k {
                    let both = gradient(&[k, l]);
                    for m in 0..count {
                        let change = both[m] - once[k][m] - once[l][m] + start[m];
                        let change = change / (sizes[k] * sizes[l]);
                        third[(k * count + l) * count + m] = change;
                        third[(l * count + k) * count + m] = change;
                    }
                }
            }
        }
        let mut hessian = vec![0.0; count * count];
        for k in 0..count {
            for m in 0..count {
                let curved = third.get((k * count + k) * count + m).unwrap_or(&0.0);
                let change = (once[k][m] - start[m]) / sizes[k];
                hessian[k * count + m] = change - 0.5 * sizes[k] * curved;
            }
        }
        let slopes = [hessian.clone(), vec![0.0; count * count]];
        let (name, pressure) = (self.name.clone(), self.pressure.clone());
        GeneralizedPressure { name, pressure, gradient: start, hessian, third, slopes }
    }
}

impl GeneralizedPressure {
    /// Sets the slopes at z.
    fn turn(&mut self, z: &[f64]) {
        let [slope, half] = &mut self.slopes;
        if self.third.is_empty() {
            return;
        }
        for (row, own) in self.third.chunks_exact(z.len()).zip(&mut *half) {
            *own = 0.5 * dot(row, z);
        }
        for ((slope, start), half) in slope.iter_mut().zip(&self.hessian).zip(half) {
            *slope = start + 2.0 * *half;
        }
    }
}

impl GeneralizedForce for GeneralizedPressure {
    fn add_forces(
        &mut self,
        t: f64,
        [z, _]: [&[f64]; 2],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let pressure = signal::sum(&self.pressure, t);
        finite_at(t, format_args!("the pressure in chamber \"{}\"", self.name), pressure)?;
        self.turn(z);
        let [_, half] = &self.slopes;
        for (k, force) in forces.applied.iter_mut().enumerate() {
            let row = k * z.len()..(k + 1) * z.len();
            let change = dot(&self.hessian[row.clone()], z) + dot(&half[row], z);
            *force += pressure * (self.gradient[k] + change);
        }
        Ok(())
    }

    fn add_tangents(
        &mut self,
        t: f64,
        [z, _]: [&[f64]; 2],
        stiffness: &mut [f64],
        _damping: &mut [f64],
    ) {
        let pressure = signal::sum(&self.pressure, t);
        self.turn(z);
        let [slope, _] = &self.slopes;
        stiffness.iter_mut().zip(slope).for_each(|(x, slope)| *x -= pressure * slope);
    }
}

#[cfg(test)]
mod tests;
