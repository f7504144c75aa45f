//! Rates of the motions of a phase: the numbers by which a method is chosen.
//!
//! Power iteration finds the highest frequency and rate of decay, subspace iteration with K + shift M the
//! lowest vibration and its damping ratio. Rigid motions are recognized by their Rayleigh quotient.

use nalgebra::{DMatrix, SymmetricEigen};

use super::System;
use super::at_rest::shifted;
use super::rigid::{self, Shape};
use crate::base::simd::add_multiple;
use crate::base::sparse::NodeMatrix;
use crate::base::vector::{dot, noise};
use crate::dynamics::linear::{ConstrainedSolver, Coupling};
use crate::dynamics::matrices::Matrices;

/// Frequencies and decay rates of a body in a phase.
///
/// It follows from the tangents M, Kt, D in one state and the motions that the constraints allow. Contacts
/// and springs count as far as they act in that state, Maxwell branches as springs, without their damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Highest angular frequency (rad/s), of Kt x = omega^2 M x: an estimate from below, good to a
    /// few per cent.
    pub highest_frequency: f64,
    /// Lowest angular frequency (rad/s) of a vibration, rigid motions left out; `None` if nothing
    /// vibrates.
    pub lowest_frequency: Option<f64>,
    /// Largest rate of decay (1/s), of D x = rate M x: likewise an estimate from below.
    pub damping_rate: f64,
    /// Damping ratio of the lowest vibration, x.D x / (2 omega x.M x) of its shape x.
    pub lowest_damping_ratio: f64,
    /// The part of it that is due to [mass damping](crate::Substance::mass_damping), which damps fast
    /// vibrations less.
    pub mass_damping_ratio: f64,
}

impl Spectrum {
    /// From the highest eigenvalues of Kt and of D, and of the lowest vibration x that of Kt, x.D x, and the part of that which is
    /// mass damping.
    pub(crate) fn new([highest, damping_rate]: [f64; 2], lowest: Option<[f64; 3]>) -> Self {
        let ratio = |k: usize| lowest.map_or(0.0, |own| own[k] / (2.0 * own[0].sqrt()));
        Self {
            highest_frequency: highest.sqrt(),
            lowest_frequency: lowest.map(|[eigenvalue, ..]| eigenvalue.sqrt()),
            damping_rate,
            lowest_damping_ratio: ratio(1),
            mass_damping_ratio: ratio(2),
        }
    }

    /// Period of the slowest vibration (s).
    pub fn slowest_period(&self) -> Option<f64> {
        self.lowest_frequency.map(|omega| std::f64::consts::TAU / omega)
    }

    /// Largest |eigenvalue| (1/s) of the equations of motion, without those of the constraint stabilization.
    ///
    /// It bounds the step of an explicit method. The fastest decay and the fastest vibration are assumed to
    /// have the same shape, as they have in a body of one material.
    pub fn stiffest_rate(&self) -> f64 {
        let (omega, half) = (self.highest_frequency, 0.5 * self.damping_rate);
        if half > omega { half + (half * half - omega * omega).sqrt() } else { omega }
    }

    /// Twice the damping ratio over the angular frequency of the lowest vibration (s).
    ///
    /// It is c/E where viscosity alone damps. The damping ratio of other vibrations is about half of it times
    /// their angular frequency.
    pub fn retardation_time(&self) -> f64 {
        self.lowest_frequency.map_or(0.0, |omega| 2.0 * self.lowest_damping_ratio / omega)
    }
}

/// Bounds on iterations. Power iteration is within some per cent by then; subspace iteration ends
/// when the lowest vibration is known to three digits.
const POWER_ITERATIONS: usize = 40;
const SUBSPACE_ITERATIONS: usize = 12;

/// Parts of the highest eigenvalue: those below the first belong to motions without stiffness; the second is
/// the shift that makes Kt + shift M definite without loss of accuracy in the solves.
pub(super) const RIGID: f64 = 1e-12;
const SHIFT: f64 = 1e-8;
/// A shift above the lowest eigenvalue is lowered to this part of it: slender bodies are so soft.
const LOWER_SHIFT: f64 = 0.1;

impl System {
    /// The spectrum at (t, u, v).
    pub(crate) fn spectrum(&mut self, t: f64, u: &[f64], v: &[f64]) -> Spectrum {
        self.update_stiffest_tangents(t, u, v);
        self.edges.move_to(self.alpha, u, v);
        self.turn_inertia(false);
        let highest = self.highest(Self::add_stiffness);
        let damping_rate =
            self.highest(|system, x, image| system.tangents().1.add_product(1.0, x, image));
        let rigid = self.rigid_motions(u, RIGID * highest);
        let lowest = self.lowest(highest, &rigid, 1).pop().map(|(eigenvalue, x)| {
            let by_mass = |m: &NodeMatrix| m.quadratic_form(self.matrices.dimension, &x);
            let by_mass = self.matrices.mass_damping.as_deref().map_or(0.0, by_mass);
            [eigenvalue, self.tangents().1.quadratic_form(&x), by_mass]
        });
        Spectrum::new([highest, damping_rate], lowest)
    }

    /// Updates the tangents to (t, u, v), with those of branches and amounts that have no time to yield.
    pub(crate) fn update_stiffest_tangents(&mut self, t: f64, u: &[f64], v: &[f64]) {
        let amounts = self.amounts().to_vec();
        self.update_tangents(t, u, v, false);
        self.add_branch_tangents(0.0, u, &[]);
        self.add_flow_tangents(t, [u, v, &amounts]);
    }

    /// Adds Kt `x` to `forces`, with the resistance of flowing amounts at constant amount, which is not part of the pattern.
    pub(crate) fn add_stiffness(&self, x: &[f64], forces: &mut [f64]) {
        self.tangents().0.add_product(1.0, x, forces);
        if let Some(flow) = &self.newton.flow {
            flow.add_stiffness(x, forces);
        }
    }

    /// Largest eigenvalue of X x = eigenvalue M x, X symmetric, whose product is added by `add_product`, by power iteration; 0 if
    /// nothing can move.
    pub(super) fn highest(&mut self, add_product: impl Fn(&Self, &[f64], &mut [f64])) -> f64 {
        let dofs = self.dofs();
        let (mut x, mut image) = (noise(dofs, 0), vec![0.0; dofs]);
        let mut highest = 0.0;
        for iteration in 0..=POWER_ITERATIONS {
            // the constraints are applied to the first guess as to all others
            image.fill(0.0);
            match iteration {
                0 => self.matrices.add_momentum(1.0, &x, &mut image),
                _ => add_product(self, &x, &mut image),
            }
            if iteration > 0 {
                // x has length 1 in the norm of M
                highest = f64::max(highest, dot(&x, &image));
            }
            x = self.inertia.solve_free(&self.rows, &image);
            let length = self.length(&x);
            if length == 0.0 {
                break;
            }
            x.iter_mut().for_each(|x| *x /= length);
        }
        highest
    }

    /// The rigid motions of the body with displacements `u` that neither rows nor stiffness resist, with eigenvalues below
    /// `round_off`, orthonormal by M.
    pub(crate) fn rigid_motions(&self, u: &[f64], round_off: f64) -> Vec<Vec<f64>> {
        let Matrices { positions, size, stiffness, dimension, inertia, .. } = &*self.matrices;
        let mut positions = positions.clone();
        // with linear strain, turns along straight lines cause no strain
        if stiffness.is_none() {
            positions.iter_mut().zip(u).for_each(|(x, u)| *x += u);
        }
        // stiff modes are omitted below, such as circles that get longer
        let shape =
            Shape { dimension: *dimension, size: *size, positions: &positions, is_turned: false };
        let free = rigid::free_motions(shape, inertia.pattern(), &self.rows);
        let mut motions = free.into_iter().map(|motion| motion.values).collect();
        self.orthonormalize(&[], &mut motions);
        if motions.is_empty() {
            return motions;
        }
        let values = self.ritz(&mut motions);
        let unresisted = motions.into_iter().zip(values);
        let unresisted = unresisted.filter(|(_, value)| value.abs() <= round_off);
        unresisted.map(|(motion, _)| motion).collect()
    }

    /// The lowest eigenvalues of Kt x = eigenvalue M x above those of motions without stiffness, `count` at most and ascending, each
    /// with its x of length 1 in the norm of M, by subspace iteration orthogonal to the `rigid` motions, which are
    /// orthonormal by M.
    pub(super) fn lowest(
        &mut self,
        highest: f64,
        rigid: &[Vec<f64>],
        count: usize,
    ) -> Vec<(f64, Vec<f64>)> {
        let (dofs, d) = (self.dofs(), self.matrices.dimension);
        if highest == 0.0 {
            return Vec::new();
        }
        let mut solver =
            ConstrainedSolver::new(&self.matrices, &self.rows, &self.edges, Coupling::AllAxes);
        let mut shift = SHIFT * highest;
        // Kt may have become indefinite by compression
        while !self.shift(&mut solver, shift) {
            shift *= 100.0;
            if shift > highest {
                return Vec::new();
            }
        }
        let mut block = (d * (d + 1) / 2 + 2 * count).min(dofs);
        let mut basis: Vec<Vec<f64>> = (0..block).map(|k| noise(dofs, k)).collect();
        let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
        let mut can_be_lower = shift <= SHIFT * highest;
        let mut iterations = 0;
        while iterations < SUBSPACE_ITERATIONS {
            for x in &mut basis {
                *x = solver.solve_free(&self.rows, &self.matrices.momentum(x));
            }
            self.orthonormalize(rigid, &mut basis);
            if basis.is_empty() {
                return Vec::new(); // numbers beyond double precision
            }
            let values = self.ritz(&mut basis);
            let Some(lowest) = values.iter().position(|&value| value > RIGID * highest) else {
                if basis.len() < block || block == dofs {
                    return Vec::new();
                }
                // the block is full of mechanisms
                let filled = block;
                block = (2 * block).min(dofs);
                basis.extend((filled..block).map(|k| noise(dofs, k)));
                continue;
            };
            iterations += 1;
            let value = values[lowest];
            let above = values.into_iter().zip(&basis).skip(lowest).take(count);
            let above = above.map(|(value, x)| (value, x.clone())).collect();
            let before = std::mem::replace(&mut found, above);
            if can_be_lower && value < shift {
                let lower = (LOWER_SHIFT * value).max(RIGID * highest);
                can_be_lower = self.shift(&mut solver, lower);
                if can_be_lower {
                    shift = lower;
                } else {
                    self.shift(&mut solver, shift);
                }
                iterations = 0;
                continue;
            }
            let has_settled =
                |(before, now): (&(f64, _), &(f64, _))| (before.0 - now.0).abs() < 1e-3 * before.0;
            if before.len() == found.len() && before.iter().zip(&found).all(has_settled) {
                break;
            }
        }
        found
    }

    /// Factorizes Kt + `shift` M in `solver`. Returns whether it is positive definite.
    fn shift(&self, solver: &mut ConstrainedSolver, shift: f64) -> bool {
        let (inertia, stiffness) = (&self.matrices.inertia, self.tangents().0);
        let factorized = solver.factorize(|source| shifted(inertia, stiffness, shift, source));
        if let (Ok(()), Some(edges)) = (&factorized, &mut solver.edges) {
            edges.turn(&self.edges, None);
        }
        factorized.is_ok()
    }

    /// Makes `basis` orthonormal by M, one vector after the other, and orthogonal to `others`, which are
    /// orthonormal; vectors that depend linearly on others are dropped.
    fn orthonormalize(&self, others: &[Vec<f64>], basis: &mut Vec<Vec<f64>>) {
        let with_image = |x: Vec<f64>| {
            let image = self.matrices.momentum(&x);
            (x, image)
        };
        let mut done: Vec<(Vec<f64>, Vec<f64>)> = others.iter().cloned().map(with_image).collect();
        for mut x in basis.drain(..) {
            let before = self.length(&x);
            // twice is enough: the first round leaves round-off of the part that it removes
            for _ in 0..2 {
                for (other, image) in &done {
                    let part = dot(image, &x);
                    x.iter_mut().zip(other).for_each(|(x, other)| *x -= part * other);
                }
            }
            let length = self.length(&x);
            if length > 1e-12 * before {
                x.iter_mut().for_each(|x| *x /= length);
                done.push(with_image(x));
            }
        }
        basis.extend(done.into_iter().skip(others.len()).map(|(x, _)| x));
    }

    /// Turns a basis that is orthonormal by M into one that is orthogonal by Kt as well, and returns its
    /// eigenvalues, ascending.
    fn ritz(&self, basis: &mut Vec<Vec<f64>>) -> Vec<f64> {
        let dofs = self.dofs();
        let image = |x: &Vec<f64>| {
            let mut image = vec![0.0; dofs];
            self.tangents().0.add_product(1.0, x, &mut image);
            image
        };
        let images: Vec<Vec<f64>> = basis.iter().map(image).collect();
        let product = |i: usize, j: usize| dot(&basis[i], &images[j]);
        let size = basis.len();
        let small = DMatrix::from_fn(size, size, |i, j| 0.5 * (product(i, j) + product(j, i)));
        let eigen = SymmetricEigen::new(small);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let combined = |&mode: &usize| {
            let mut x = vec![0.0; dofs];
            for (vector, &part) in basis.iter().zip(eigen.eigenvectors.column(mode).iter()) {
                add_multiple(part, vector, &mut x);
            }
            x
        };
        let combined = order.iter().map(combined).collect();
        *basis = combined;
        order.iter().map(|&mode| eigen.eigenvalues[mode]).collect()
    }

    /// sqrt(x.M x)
    fn length(&self, x: &[f64]) -> f64 {
        self.matrices.square(x).sqrt()
    }
}
