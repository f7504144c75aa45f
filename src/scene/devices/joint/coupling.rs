//! Couplings of coordinates, held by a stiffness: teeth of gears, threads, crosses of universal joints, guides that move.
//!
//! A coupling keeps a combination of coordinates near 0,
//!
//! ```text
//! phi = sum c_k q_k,   Q_k = -c_k (k phi + d phi'),
//! ```
//!
//! as what transmits a load gives way under it. Coordinates are no linear functions of the displacements, so that they have no rows. Where angles have
//! a part, phi is known up to a `period`, the pitch of the teeth or of the thread: without memory of whole turns the coupling holds the tooth that is
//! nearest, and jumps to the next one where half of a pitch is exceeded.

use super::coordinate::{At, Coordinate};
use crate::base::sparse::BlockMatrix;
use crate::elements::force::NodalForces;

/// One coupling.
#[derive(Debug, Clone)]
pub(super) struct Coupling {
    /// The coordinates with their coefficients c.
    pub(super) parts: Vec<(Coordinate, f64)>,
    /// k (N m/rad, N/m) and d (N m s, N s/m).
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    /// Of phi (rad, m).
    pub(super) period: Option<f64>,
}

impl Coupling {
    /// phi.
    fn off(&self, value: impl Fn(&Coordinate) -> f64) -> f64 {
        let off: f64 = self.parts.iter().map(|(coordinate, c)| c * value(coordinate)).sum();
        self.period.map_or(off, |period| off - period * (off / period).round())
    }

    pub(super) fn potential(&self, u: &[f64]) -> f64 {
        // the value needs no velocities
        let off = self.off(|coordinate| coordinate.at(u, u, false).value);
        0.5 * self.stiffness * off * off
    }

    pub(super) fn add_forces(&self, u: &[f64], v: &[f64], forces: &mut NodalForces) {
        let off = self.off(|coordinate| coordinate.at(u, v, false).value);
        let rates = self.parts.iter().map(|(coordinate, c)| c * coordinate.at(u, v, false).rate);
        let rate: f64 = rates.sum();
        for (coordinate, c) in &self.parts {
            let at = coordinate.at(u, v, false);
            coordinate.add_forces(&at, -c * self.stiffness * off, &mut forces.conservative);
            if self.damping > 0.0 {
                coordinate.add_forces(&at, -c * self.damping * rate, &mut forces.dissipative);
            }
        }
    }

    pub(super) fn add_tangents(
        &self,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let [k, d] = [self.stiffness, self.damping];
        let off = self.off(|coordinate| coordinate.at(u, v, false).value);
        let state = |(coordinate, _): &(Coordinate, f64)| coordinate.at(u, v, true);
        let rate: f64 = self.parts.iter().map(|part| part.1 * state(part).rate).sum();
        let force = -(k * off + d * rate);
        for (first, part) in self.parts.iter().enumerate() {
            let (at, c): (At, f64) = (state(part), part.1);
            let slopes = [-c * c * k, -c * c * d];
            part.0.add_tangents(&at, (c * force, slopes), stiffness, damping);
            for (_, other) in self.parts.iter().enumerate().filter(|(second, _)| *second != first) {
                let slopes = [c * other.1 * k, c * other.1 * d];
                let of_other = (&other.0, &state(other));
                part.0.add_shared_tangents(&at, of_other, slopes, stiffness, damping);
            }
        }
    }

    /// Nodes (from 0) that it depends on.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> + Clone {
        self.parts.iter().flat_map(|(coordinate, _)| coordinate.nodes())
    }
}
