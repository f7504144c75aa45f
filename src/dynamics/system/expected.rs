//! The expected motions of a body in a phase, found at rest without a run: displacements by its loads, its free
//! vibrations, displacements by its constraints, and the modal derivatives of all these, that is the change of the shapes as the body moves
//! along them (S. Idelsohn, A. Cardona, Comput. Methods Appl. Mech. Engng 49 (1985) 253-279).

#[cfg(test)]
mod tests;

use super::System;
use super::spectrum::RIGID;
use crate::base::simd::add_multiple;
use crate::base::vector::{dot, largest};
use crate::integrators::ode::Failure;
use crate::scene::constraint::ConstraintRow;

/// Free vibrations that are looked for, and motions whose derivatives are: those that move most.
const VIBRATIONS: usize = 24;
const CURVED: usize = 10;

/// Fractions of a phase at which loads are evaluated.
const TIMES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Part of the largest motion that the lowest vibration makes at least, and each other as its period is shorter.
const LEAST: f64 = 0.03;

/// That part of the size of the body where nothing is known to move it.
const UNKNOWN: f64 = 0.01;

/// Largest displacement for differences, relative to the size of the body: they are of second order, so round-off is 1e-9 of
/// the forces, and what they leave out 1e-6.
const STEP: f64 = 1e-3;

/// Motions at rest of a body with some constraints.
pub(crate) struct Vibrations {
    /// The entries of the tangent stiffness (N/m) there.
    stiffness: Vec<f64>,
    /// Rigid motions that nothing resists, orthonormal by M.
    rigid: Vec<Vec<f64>>,
    /// Squares of angular frequencies (rad^2/s^2), ascending, with shapes that are orthonormal by M.
    lowest: Vec<(f64, Vec<f64>)>,
}

impl System {
    /// Expected displacements (m) from `start` to `end` (s), of realistic size, in a phase that begins with `velocities` (m/s): no
    /// larger than `most` (m), if that is known. Motions of moving constraints by their `lifts` are excluded, but the second-order
    /// response to them is included. `known` vibrations are reused where the tangents are the same.
    pub(crate) fn expected_motions(
        &mut self,
        [start, end]: [f64; 2],
        velocities: &[f64],
        lifts: &[Vec<f64>],
        most: Option<f64>,
        known: &mut Option<Vibrations>,
    ) -> Result<Vec<Vec<f64>>, Failure> {
        let times = TIMES.map(|part| start + part * (end - start));
        self.update_tangents_at_rest(start);
        let found = match known.take() {
            Some(known) if known.stiffness == self.tangents().0.values => known,
            _ => self.vibrations(VIBRATIONS),
        };
        let Vibrations { rigid, lowest: vibrations, .. } = &*known.insert(found);
        let [size, _] = self.matrices.scales;
        self.factorize_at_rest()?;

        let largest_of = |all: &[Vec<f64>]| all.iter().map(|x| largest(x)).fold(0.0, f64::max);
        let moved = self.lifted(lifts, times);
        let (mut motions, mut loads) = (Vec::new(), Vec::new());
        for time in times {
            let mut load = self.load_at_rest(time)?;
            // the remainder when the body moves as a whole
            for motion in rigid {
                let part = -dot(motion, &load);
                self.matrices.add_momentum(part, motion, &mut load);
            }
            motions.push(self.response(&load));
            loads.push(load);
        }
        // the resistance to large motions is not linear
        let linear = largest_of(&motions);
        let part = most.map_or(1.0, |most| if linear > most { most / linear } else { 1.0 });
        motions.iter_mut().chain(&mut loads).flatten().for_each(|x| *x *= part);
        let most = match largest_of(&motions).max(largest_of(&moved)) {
            most if most > 0.0 => most.min(size),
            _ => UNKNOWN * size,
        };
        let slowest = vibrations.first().map_or(0.0, |(value, _)| *value);
        let momentum = self.matrices.momentum(velocities);
        for (value, shape) in vibrations {
            // how far it swings by each load that comes at once, and by the velocities
            let by_loads = loads.iter().map(|load| dot(load, shape).abs() / value);
            let by_velocities = dot(&momentum, shape).abs() / value.sqrt();
            let least = LEAST * most * slowest / value / largest(shape);
            let amplitude = by_loads.fold(by_velocities.max(least), f64::max);
            motions.push(shape.iter().map(|x| amplitude * x).collect());
        }
        motions.retain(|motion| largest(motion) > 0.0);

        let mut curved = [&moved[..], &motions].concat();
        let length = |x: &Vec<f64>| self.matrices.square(x);
        curved.retain(|motion| length(motion) > 0.0);
        curved.sort_by(|a, b| length(b).total_cmp(&length(a)));
        curved.truncate(CURVED);
        for (number, one) in curved.iter().enumerate() {
            for other in &curved[..=number] {
                let bent = self.curvature(start, one, other)?;
                motions.push(self.response(&bent));
            }
        }
        Ok(motions)
    }

    /// Sets the tangents to those at rest.
    pub(super) fn update_tangents_at_rest(&mut self, t: f64) {
        let rest = vec![0.0; self.dofs()];
        self.newton.is_set = false;
        self.update_tangents(t, &rest, &rest, false);
    }

    /// The `count` lowest vibrations by the tangents at rest.
    fn vibrations(&mut self, count: usize) -> Vibrations {
        let highest =
            self.highest(|system, x, image| system.tangents().0.add_product(1.0, x, image));
        let rigid = self.rigid_motions(&vec![0.0; self.dofs()], RIGID * highest);
        let lowest = self.lowest(highest, &rigid, count);
        Vibrations { stiffness: self.tangents().0.values.clone(), rigid, lowest }
    }

    /// Motion of each moving row: its lift times its largest displacement from the first of the `times` on.
    fn lifted(&self, lifts: &[Vec<f64>], times: [f64; TIMES.len()]) -> Vec<Vec<f64>> {
        let rows = self.rows.iter().filter(|row| row.moves());
        let scaled = |(row, lift): (&ConstraintRow, &Vec<f64>)| {
            let place = |time: f64| row.prescribed(time).displacement;
            let ways = times.map(|time| place(time) - place(times[0]));
            let way = ways
                .into_iter()
                .fold(0.0, |most: f64, way| if way.abs() > most.abs() { way } else { most });
            lift.iter().map(|x| way * x).collect()
        };
        rows.zip(lifts).map(scaled).collect()
    }

    /// Nodal forces (N) of all but the cells, at rest.
    fn load_at_rest(&mut self, t: f64) -> Result<Vec<f64>, Failure> {
        let rest = vec![0.0; self.dofs()];
        self.at.nodal.clear();
        self.add_forces_where(|force| force.capabilities().by_cells.is_none(), t, &rest, &rest)?;
        let mut load = rest;
        self.at.nodal.add_up(&mut load);
        Ok(load)
    }

    /// Displacements (m) in equilibrium with a load (N), by the tangents that are factorized.
    fn response(&mut self, load: &[f64]) -> Vec<f64> {
        let gamma = self.newton.gamma;
        let right: Vec<f64> = load.iter().map(|force| force * (gamma * gamma)).collect();
        self.newton.solver.solve_free(&self.rows, &right)
    }

    /// Second derivative at rest of the forces of cells (N) along two displacements, by differences.
    fn curvature(&mut self, t: f64, one: &[f64], other: &[f64]) -> Result<Vec<f64>, Failure> {
        let [size, _] = self.matrices.scales;
        let steps = [one, other].map(|x| STEP * size / largest(x));
        let rest = vec![0.0; self.dofs()];
        let (mut sum, mut total) = (rest.clone(), rest.clone());
        for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let mut u = rest.clone();
            add_multiple(signs[0] * steps[0], one, &mut u);
            add_multiple(signs[1] * steps[1], other, &mut u);
            self.at.nodal.clear();
            self.add_forces_where(|force| force.capabilities().by_cells.is_some(), t, &u, &rest)?;
            self.at.nodal.add_up(&mut total);
            add_multiple(signs[0] * signs[1] / (4.0 * steps[0] * steps[1]), &total, &mut sum);
        }
        Ok(sum)
    }
}
