//! Velocities from forces under the constraints,
//!
//! ```text
//! M a = f + A lambda,   w = v + tau a,   A^T w = rates
//! ```
//!
//! For central differences the multipliers of edges (`edges.rs`) in the first half of a step act along the
//! edges at its start, so that lengths are exact at its end, and those of the second half along the edges at
//! its end (RATTLE; on a free body the method of Moser and Veselov, which keeps momenta and energy to
//! round-off). Where g is not 0 at the start it decays by the stabilization (`guide.rs`), so that a
//! run continues from any other method. A step in which an edge turns by more than 60 degrees is repeated with
//! a shorter one. Multipliers of the halves belong to times h/3 within the step: the error estimate uses
//! differences between the halves of each step only, a third of their change.

use super::System;
use crate::base::simd::{Formula, each};
use crate::base::tensor::Real;
use crate::base::vector::dot;
use crate::dynamics::matrices::Matrices;
use crate::integrators::ode::Kick;
use crate::scene::constraint::ConstraintRow;

pub(super) enum Mobility {
    /// Lumped inertia, one component per row: nothing has to be solved.
    Diagonal {
        /// 1/M_ii (1/kg); 0 where a row prescribes.
        inverse: Vec<f64>,
        rows: Vec<NodalRow>,
    },
    /// Anything else.
    Coupled {
        /// A^T a and lambda, row by row.
        demands: Vec<f64>,
        multipliers: Vec<f64>,
    },
}

pub(super) struct NodalRow {
    dof: usize,
    coefficient: f64,
    mass: f64,
}

impl Mobility {
    pub(super) fn new(system: &System) -> Self {
        let Matrices { inertia, dimension, .. } = &*system.matrices;
        let rows: Option<Vec<_>> = system.rows.iter().map(ConstraintRow::nodal).collect();
        let Some(rows) = rows.filter(|_| system.is_lumped()) else {
            let none = vec![0.0; system.rows.len()];
            return Self::Coupled { demands: none.clone(), multipliers: none };
        };
        let mass = |dof: usize| inertia.get(dof / dimension, dof / dimension);
        let mut inverse: Vec<f64> = (0..system.dofs()).map(|dof| 1.0 / mass(dof)).collect();
        rows.iter().for_each(|&(dof, _)| inverse[dof] = 0.0);
        let row = |(dof, coefficient)| NodalRow { dof, coefficient, mass: mass(dof) };
        Self::Diagonal { inverse, rows: rows.into_iter().map(row).collect() }
    }

    /// Whether accelerations depend on the force alone, not on the velocities.
    pub(super) fn is_diagonal(&self) -> bool {
        matches!(self, Self::Diagonal { .. })
    }

    /// The accelerations in a kick, 0 where a nodal row prescribes.
    pub(super) fn accelerations(
        &mut self,
        system: &mut System,
        kick: &Kick<'_>,
        rates: &[f64],
        accelerations: &mut [f64],
    ) {
        let Kick { duration, force, before } = *kick;
        match self {
            Self::Diagonal { inverse, .. } => {
                each(ByMass, [inverse, force], [accelerations]);
            }
            Self::Coupled { demands, multipliers } => {
                let rows = system.rows.iter().zip(rates);
                demands
                    .iter_mut()
                    .zip(rows)
                    .for_each(|(d, (row, rate))| *d = (rate - row.apply(before)) / duration);
                system.accelerations(force, demands, accelerations, multipliers);
                let rows = system.rows.iter().filter_map(ConstraintRow::nodal);
                rows.for_each(|(dof, _)| accelerations[dof] = 0.0);
            }
        }
    }

    /// Sets the components that nodal rows prescribe in the velocities `after` the last kick, which are v +
    /// tau a so far. Returns the work of the constraint forces (J).
    pub(super) fn lead(
        &self,
        system: &System,
        kick: &Kick<'_>,
        rates: &[f64],
        after: &mut [f64],
    ) -> f64 {
        let Kick { duration, force, before } = *kick;
        let mut work = 0.0;
        match self {
            Self::Diagonal { rows, .. } => {
                for (&NodalRow { dof, coefficient, mass }, rate) in rows.iter().zip(rates) {
                    after[dof] = rate / coefficient;
                    let momentum = mass * (after[dof] - before[dof]) - duration * force[dof];
                    work += 0.5 * momentum * (before[dof] + after[dof]);
                }
            }
            Self::Coupled { multipliers, .. } => {
                for ((row, rate), multiplier) in system.rows.iter().zip(rates).zip(multipliers) {
                    work += 0.5 * duration * multiplier * (row.apply(before) + rate);
                    if let Some((dof, coefficient)) = row.nodal() {
                        after[dof] = rate / coefficient;
                    }
                }
            }
        }
        work
    }
}

/// a = f / M
struct ByMass;

impl Formula<2, 1, 0> for ByMass {
    #[inline(always)]
    fn at<T: Real>(&self, [inverse, f]: [T; 2], _: [T; 1]) -> ([T; 1], [T; 0]) {
        ([inverse * f], [])
    }
}

impl System {
    /// Has the accelerations in the first kick of a step of size `h` (s), from where the edges were placed, end it with
    /// the `goals` of g (m^2).
    pub(super) fn aim_edges(&mut self, h: f64, kick: &Kick<'_>, goals: &[f64]) {
        let Some(solver) = &mut self.inertia.edges else { return };
        let arrival = &mut solver.arrival;
        arrival.weight = Some(h * kick.duration);
        let all = self.edges.list.iter().zip(&self.edges.arms).zip(goals);
        for (k, ((edge, arm), goal)) in all.enumerate() {
            let rate = edge.apart(kick.before, self.matrices.dimension);
            arrival.starts[k] = std::array::from_fn(|i| arm[i] + h * rate[i]);
            arrival.halves[k] = edge.half_square() + goal;
        }
        solver.aim(&self.edges);
    }

    /// Has the accelerations in a kick, where the edges were placed, end it with the rates `goals` of g (m^2/s).
    pub(super) fn lead_edges(&mut self, kick: &Kick<'_>, goals: &[f64]) {
        let Some(solver) = &mut self.inertia.edges else { return };
        let all = self.edges.list.iter().zip(&self.edges.arms).zip(goals);
        for (demand, ((edge, arm), goal)) in solver.demands.iter_mut().zip(all) {
            let rate = dot(arm, &edge.apart(kick.before, self.matrices.dimension));
            *demand = (goal - rate) / kick.duration;
        }
        solver.turn(&self.edges, None);
    }

    /// Accelerations a and multipliers lambda with M a - A lambda = f, A^T a = d.
    fn accelerations(&mut self, f: &[f64], d: &[f64], a: &mut [f64], multipliers: &mut [f64]) {
        let of = |dof: usize, a: &[f64]| self.matrices.momentum_of(dof, a);
        self.inertia.solve_whole(&self.rows, f, d, a, multipliers, of);
    }
}
