//! Nodal forces by their effect on the energy, and the steps over which forces are followed.

use std::ops::{Deref, DerefMut};

use crate::base::simd::add;
use crate::base::vector::dot;

/// Nodal forces (N), divided by their effect on the energy of the system.
#[derive(Debug, Clone)]
pub struct NodalForces {
    /// Forces with a potential: -dU/du.
    pub conservative: ForceVector,
    /// Forces that turn motion into heat: their power -f.v is dissipated.
    pub dissipative: ForceVector,
    /// Forces from outside: their power f.v is supplied.
    pub applied: ForceVector,
    /// Power (W) that obstacles in motion add to the heat: their own velocity times the
    /// dissipative forces on the body.
    pub carried_heat: f64,
    /// Power (W) that keeps obstacles in motion: their velocity times their forces on the body.
    pub carried_power: f64,
}

impl NodalForces {
    /// No forces on `dofs` degrees of freedom.
    pub fn zeros(dofs: usize) -> Self {
        let none = ForceVector { values: vec![0.0; dofs], is_zero: true };
        Self {
            conservative: none.clone(),
            dissipative: none.clone(),
            applied: none,
            carried_heat: 0.0,
            carried_power: 0.0,
        }
    }

    /// Sets all forces to 0.
    pub fn clear(&mut self) {
        self.conservative.clear();
        self.dissipative.clear();
        self.applied.clear();
        (self.carried_heat, self.carried_power) = (0.0, 0.0);
    }

    /// Writes the sum of all forces.
    pub(crate) fn add_up(&self, total: &mut [f64]) {
        total.copy_from_slice(&self.conservative);
        for part in [&self.dissipative, &self.applied] {
            if !part.is_zero {
                add(part, total);
            }
        }
    }

    /// Power that is dissipated and power that is supplied (W) at the velocities `v`.
    pub(crate) fn powers(&self, v: &[f64]) -> (f64, f64) {
        let (dissipated, supplied) = self.work(v);
        (dissipated + self.carried_heat, supplied + self.carried_power)
    }

    /// Energy that is dissipated and energy that is supplied (J) along the displacements `x`.
    pub(crate) fn work(&self, x: &[f64]) -> (f64, f64) {
        (-self.dissipative.work(x), self.applied.work(x))
    }
}

/// Nodal forces (N) of one kind: a slice that remembers whether anything was added, and costs nothing if not.
#[derive(Debug, Clone)]
pub struct ForceVector {
    values: Vec<f64>,
    /// Whether it has not been borrowed mutably since it was cleared.
    is_zero: bool,
}

impl ForceVector {
    /// Whether nothing was added.
    pub(crate) fn is_zero(&self) -> bool {
        self.is_zero
    }

    fn clear(&mut self) {
        if !self.is_zero {
            self.values.fill(0.0);
            self.is_zero = true;
        }
    }

    /// Work (J) along the displacements `x`.
    fn work(&self, x: &[f64]) -> f64 {
        if self.is_zero { 0.0 } else { dot(&self.values, x) }
    }
}

impl Deref for ForceVector {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values
    }
}

impl DerefMut for ForceVector {
    fn deref_mut(&mut self) -> &mut [f64] {
        self.is_zero = false;
        &mut self.values
    }
}

/// Account of the potential energy of a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reservoir {
    /// Strain energy.
    Strain,
    /// Gravitational energy.
    Gravity,
    /// Energy stored in penalty springs at obstacles.
    Contact,
    /// Energy of springs, and of gas and liquids in chambers.
    Springs,
    /// None: the force has no potential.
    None,
}

/// A completed step of an integrator: the states at both ends.
pub struct Step<'a> {
    /// Times (s).
    pub times: [f64; 2],
    /// Displacements (m).
    pub u: [&'a [f64]; 2],
    /// Velocities (m/s).
    pub v: [&'a [f64]; 2],
}

impl Step<'_> {
    /// A bound (m) on how far any node moves, if each component of a displacement follows the cubic that has
    /// its values and velocities at both ends.
    pub(crate) fn reach(&self, dimension: usize) -> f64 {
        let third = (self.times[1] - self.times[0]) / 3.0;
        let ([u0, u1], [v0, v1]) = (self.u, self.v);
        let largest = u0.iter().zip(u1).zip(v0.iter().zip(v1)).fold(
            0.0_f64,
            |largest, ((u0, u1), (v0, v1))| {
                let (first, last) = (third * v0, third * v1);
                largest.max(first.abs() + (u1 - u0 - first - last).abs() + last.abs())
            },
        );
        largest * (dimension as f64).sqrt()
    }
}
