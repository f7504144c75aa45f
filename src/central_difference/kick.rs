//! Kicks: what a force does to velocities in some time under the constraints,
//!
//! ```text
//! M a = f + A lambda,   w = v + tau a,   A^T w = rates
//! ```

use crate::constraint::Row;
use crate::system::System;

/// How velocities follow from forces.
pub(super) enum Mobility {
    /// Lumped inertia, one component per row: nothing is to be solved.
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

/// A force at work for some time.
pub(super) struct Kick<'a> {
    pub(super) duration: f64,
    pub(super) force: &'a [f64],
    /// A^T w at its end, row by row.
    pub(super) rates: &'a [f64],
}

impl Mobility {
    pub(super) fn new(system: &System) -> Self {
        let rows: Option<Vec<_>> = system.rows().iter().map(Row::nodal).collect();
        let Some((rows, masses)) = rows.zip(system.lumped_masses()) else {
            let none = vec![0.0; system.rows().len()];
            return Self::Coupled { demands: none.clone(), multipliers: none };
        };
        let mut inverse: Vec<f64> = masses.iter().map(|mass| 1.0 / mass).collect();
        rows.iter().for_each(|&(dof, _)| inverse[dof] = 0.0);
        let row = |(dof, coefficient)| NodalRow { dof, coefficient, mass: masses[dof] };
        Self::Diagonal { inverse, rows: rows.into_iter().map(row).collect() }
    }

    /// Whether accelerations are those of the force alone, whatever the velocities.
    pub(super) fn is_diagonal(&self) -> bool {
        matches!(self, Self::Diagonal { .. })
    }

    /// The accelerations in a kick that begins with the velocities `before`, 0 where a nodal row prescribes.
    pub(super) fn accelerations(
        &mut self,
        system: &mut System,
        kick: &Kick,
        before: &[f64],
        accelerations: &mut [f64],
    ) {
        let Kick { duration, force, rates } = *kick;
        match self {
            Self::Diagonal { inverse, .. } => {
                let of_force = inverse.iter().zip(force).map(|(inverse, f)| inverse * f);
                accelerations.iter_mut().zip(of_force).for_each(|(a, of_force)| *a = of_force);
            }
            Self::Coupled { demands, multipliers } => {
                let rows = system.rows().iter().zip(rates);
                demands
                    .iter_mut()
                    .zip(rows)
                    .for_each(|(d, (row, rate))| *d = (rate - row.apply(before)) / duration);
                system.accelerations(force, demands, accelerations, multipliers);
                let rows = system.rows().iter().filter_map(Row::nodal);
                rows.for_each(|(dof, _)| accelerations[dof] = 0.0);
            }
        }
    }

    /// Leads the velocities `after` the kick last asked about, which are v + tau a so far, where nodal
    /// rows prescribe. Returns the work of the constraint forces (J).
    pub(super) fn lead(
        &self,
        system: &System,
        kick: &Kick,
        before: &[f64],
        after: &mut [f64],
    ) -> f64 {
        let Kick { duration, force, rates } = *kick;
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
                for ((row, rate), multiplier) in system.rows().iter().zip(rates).zip(multipliers) {
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
