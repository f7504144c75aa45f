//! The search for an equilibrium of a body with free rigid motions.
//!
//! K + floor M of the search is definite, and its steps leave the body where it is. Two things remain to be
//! done. Loads of constant direction (dead loads) may have to rotate a body far before they balance each other.
//! Straight steps would strain it, so it is rotated rigidly, along circles: by Newton's method on
//! the angles, with falling energy. And in equilibrium, motions that no force resists are removed from the
//! displacements.
//!
//! A linear free body needs loads in balance: K plus 1e-10 of the highest eigenvalue times M then has the
//! same solution but for an error that iteration removes, and rigid motions are projected out by M. A net
//! force without a support is rejected beforehand; moments that no rotation balances are reported when
//! the search ends.

use nalgebra::{DMatrix, DVector};

use super::newton::{Search, Stuck};
use crate::base::vector::{dot, largest};
use crate::dynamics::system::rigid::{self, RigidMotion, Shape};

/// Largest number of turns before each step of Newton's method: ten are enough from any position.
const MOST_TURNS: usize = 20;

/// Largest turn (rad): a part of the quarter turn after which a moment decreases.
const LARGEST_TURN: f64 = 0.5;

/// Largest number of iterations that remove finite turns from displacements.
const MOST_ROUNDS: usize = 20;

/// Part of |K| |R| that is round-off in K R.
const ROUND_OFF: f64 = 1e-12;

impl Search<'_> {
    /// Turns the body as long as the energy falls, from displacements at which the forces are known.
    pub(super) fn turn(&mut self) {
        if !self.is_loose || !self.turns_in_circles() {
            return;
        }
        for _ in 0..MOST_TURNS {
            let mut turns = self.free_motions(&self.u);
            turns.retain(|motion| motion.is_turn);
            let moments = turns.iter().map(|motion| dot(&motion.values, &self.at.total));
            let moments = DVector::from_iterator(turns.len(), moments);
            let nothing = 0.1 * self.statics.rtol * self.at.scale * self.size;
            if moments.iter().all(|moment| moment.abs() <= nothing) {
                return;
            }
            self.rest.update_tangent(self.tried, &self.u);
            let stiffness = self.stiffness_against(&turns).symmetric_eigen();
            let mut angles = stiffness.eigenvectors.tr_mul(&moments);
            for (angle, resistance) in angles.iter_mut().zip(stiffness.eigenvalues.iter()) {
                let moment = if angle.abs() > nothing { *angle } else { 0.0 };
                *angle = moment / resistance.abs().max(moment.abs() / LARGEST_TURN).max(nothing);
            }
            let angles = stiffness.eigenvectors * angles;
            let mut turned = self.u.clone();
            for (motion, &angle) in turns.iter().zip(angles.iter()) {
                motion.carry(angle, self.body.mesh().positions(), &mut turned);
            }
            if !self.is_lower(&turned) {
                return;
            }
            std::mem::swap(&mut self.at, &mut self.trial);
            self.u = turned;
        }
    }

    /// Whether the energy is lower at other displacements, where constraints are met no worse; `trial` then
    /// holds the forces there.
    fn is_lower(&mut self, other: &[f64]) -> bool {
        self.rest.lacking(self.tried, &self.u, &mut self.d);
        let lacking = largest(&self.d);
        self.rest.lacking(self.tried, other, &mut self.d);
        if largest(&self.d) > lacking + 1e-13 * self.size
            || self.rest.evaluate(self.tried, other, &mut self.trial).is_err()
        {
            return false;
        }
        self.x.iter_mut().zip(other).zip(&self.u).for_each(|((x, other), u)| *x = other - u);
        let rise = self.trial.energy_since(&self.at, 1.0, &self.x);
        rise <= self.trial.round_off(&self.u) + self.at.round_off(&self.u)
    }

    /// Removes the motions that no force resists from the step x: they come from round-off and the small
    /// floor.
    pub(super) fn keep_place(&mut self) {
        if self.is_loose && !self.is_linear {
            let mut motions = self.free_motions(&self.u);
            motions.retain(|motion| self.is_neutral(motion, 0.0));
            rigid::remove(&motions, self.body.inertia(), &mut self.x);
        }
    }

    /// Removes the motions that no force resists from the equilibrium that was found.
    pub(super) fn place(&mut self) -> Result<(), Stuck> {
        if !self.is_loose {
            return Ok(());
        }
        let mut motions = self.free_motions(&self.u);
        if !self.is_linear {
            self.rest.update_tangent(self.tried, &self.u);
            let residual = 10.0 * self.statics.rtol * self.at.scale;
            motions.retain(|motion| self.is_neutral(motion, residual));
        }
        self.removed = motions.iter().map(|motion| motion.words.clone()).collect();
        let inertia = self.body.inertia();
        if !self.turns_in_circles() {
            rigid::remove(&motions, inertia, &mut self.u);
            return if self.is_linear { Ok(()) } else { self.balance(self.statics.max_iterations) };
        }
        for _ in 0..MOST_ROUNDS {
            let parts = rigid::parts(&motions, inertia, &self.u);
            for (motion, &part) in motions.iter().zip(&parts) {
                motion.carry(-part, self.body.mesh().positions(), &mut self.u);
            }
            if largest(&parts) <= f64::EPSILON * self.size.max(1.0) {
                break;
            }
            motions
                .iter_mut()
                .for_each(|motion| motion.move_to(self.body.mesh().positions(), &self.u));
        }
        self.balance(self.statics.max_iterations)
    }

    /// Resultants of the loads last tried, in words, along the motions that nothing restrains, where the search has arrived.
    pub(super) fn resultants(&mut self) -> Vec<String> {
        let motions = self.free_motions(&self.u);
        if self.evaluate().is_err() {
            return Vec::new();
        }
        self.rest.update_tangent(self.tried, &self.u);
        let round_off = self.round_off();
        motions.iter().filter_map(|motion| motion.resultant(&self.at.total, round_off)).collect()
    }

    /// The rigid motions that the constraints leave free, of the body with the displacements `u`.
    fn free_motions(&self, u: &[f64]) -> Vec<RigidMotion> {
        let mesh = self.body.mesh();
        let mut positions = mesh.positions().to_vec();
        if self.turns_in_circles() {
            positions.iter_mut().zip(u).for_each(|(x, u)| *x += u);
        }
        let shape = Shape { size: self.size, positions: &positions, ..Shape::natural(self.body) };
        rigid::free_motions(shape, self.body.inertia().pattern(), self.rest.system().rows())
    }

    /// Whether a turn along circles causes no strain; with linear strain, one along straight lines causes
    /// none.
    pub(super) fn turns_in_circles(&self) -> bool {
        self.body.constant_stiffness().is_none()
    }

    /// Moments (N m) that `turns` by a unit angle cause along each other, where the forces and K are known:
    /// R^T K R minus f . W R, the latter as the forces keep their directions while their points turn.
    fn stiffness_against(&self, turns: &[RigidMotion]) -> DMatrix<f64> {
        let stiffness = DMatrix::from_fn(turns.len(), turns.len(), |i, j| {
            let [one, other] = [&turns[i], &turns[j]];
            let stiffness = dot(&one.values, &self.resistance(other));
            stiffness - one.turned_work(&self.at.total, &other.values)
        });
        0.5 * (&stiffness + stiffness.transpose())
    }

    /// K R of a motion R.
    fn resistance(&self, motion: &RigidMotion) -> Vec<f64> {
        let mut forces = vec![0.0; motion.values.len()];
        self.rest.tangent().add_product(1.0, &motion.values, &mut forces);
        forces
    }

    /// Whether no force changes along a motion, where K is known, apart from round-off and a `residual` (N).
    pub(super) fn is_neutral(&self, motion: &RigidMotion, residual: f64) -> bool {
        let sizes: Vec<f64> = motion.values.iter().map(|r| r.abs()).collect();
        let most = (0..sizes.len())
            .map(|dof| self.rest.tangent().absolute_row_product(dof, &sizes))
            .fold(0.0, f64::max);
        largest(&self.resistance(motion)) <= ROUND_OFF * most + residual
    }
}
