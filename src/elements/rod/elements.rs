//! The elements of a rod: inertia, forces and tangents on the nodes of a mesh.
//!
//! A director d of a node with the position x stands in the mesh as a node of its own at p = x + a d, a point of the section's surface, so
//! that all unknowns are displacements, M is constant and nothing has to hold a norm. U, the stretch of the directors, is the strain of the
//! section in its own plane, which no load of the rod excites: it gets the stiffness and the viscosity of a section that is not much
//! softer than the rod, E A / 2 (U^2 - 1)^2 and about critical damping.

use nalgebra::{Const, SVector};
use num_dual::{DualSVec64, DualVec};

use super::end::End;
use super::strain::{Deformed, Number, Section, Strains, Vector, dot};
use crate::base::sparse::{BlockMatrix, NodeMatrix};
use crate::integrators::ode::Failure;

/// Unknowns of an element in space.
const UNKNOWNS: usize = 18;

/// An element of a rod.
#[derive(Debug, Clone)]
pub(super) struct RodElement {
    pub(super) ends: [End; 2],
    pub(super) length: f64,
    /// Strains in which it is free of stress.
    pub(super) natural: Strains<f64>,
    /// Along the strains (N, N m^2), and the same of the viscosity.
    pub(super) stiffness: [f64; 6],
    pub(super) viscosity: [f64; 6],
    /// Of the section in its plane (J, J s), at each end.
    pub(super) in_plane: [f64; 2],
    /// Mass and second moments about d_1 and d_2 per length (kg/m, kg m).
    pub(super) mass: [f64; 3],
}

/// A Maxwell branch: the share of its stiffness (1), and its relaxation time (s).
#[derive(Debug, Clone, Copy)]
pub(super) struct RodBranch {
    pub(super) share: f64,
    pub(super) time: f64,
}

/// The elements of rods, on the nodes of a body of a `dimension`.
#[derive(Debug, Clone)]
pub(crate) struct RodElements {
    pub(super) dimension: usize,
    pub(super) elements: Vec<RodElement>,
    pub(super) branches: Vec<RodBranch>,
    /// Places around its cross sections, in arms along d_1 and d_2.
    pub(super) outline: Vec<[f64; 2]>,
}

pub(super) type Dual = DualSVec64<UNKNOWNS>;

impl RodElement {
    /// The elastic forces on both ends, with the sign of those that the nodes exert.
    fn elastic<T: Number>(&self, deformed: &Deformed<T>, at: &[Section<T>; 2]) -> [Section<T>; 2] {
        let mut stress = deformed.strains();
        for k in 0..3 {
            stress.gamma[k] = (stress.gamma[k] - self.natural.gamma[k]) * self.stiffness[k];
            stress.kappa[k] = (stress.kappa[k] - self.natural.kappa[k]) * self.stiffness[3 + k];
        }
        let mut forces = deformed.forces(stress);
        for (Section { d, .. }, force) in at.iter().zip(&mut forces) {
            let strain =
                |a: usize, b: usize, unit: f64| (dot(d[a], d[b]) - unit) * (0.5 * self.in_plane[0]);
            add_in_plane(d, [strain(0, 0, 1.0), strain(0, 1, 0.0), strain(1, 1, 1.0)], force);
        }
        forces
    }

    /// The viscous forces, likewise, as the ends move with velocities.
    fn viscous<T: Number>(
        &self,
        deformed: &Deformed<T>,
        at: &[Section<T>; 2],
        moving: &[Section<T>; 2],
    ) -> [Section<T>; 2] {
        let mut forces = [Section::zero(); 2];
        if self.is_viscous() {
            let mut stress = deformed.rates(*moving);
            for k in 0..3 {
                stress.gamma[k] *= T::from(self.viscosity[k]);
                stress.kappa[k] *= T::from(self.viscosity[3 + k]);
            }
            forces = deformed.forces(stress);
        }
        for ((Section { d, .. }, Section { d: v, .. }), force) in
            at.iter().zip(moving).zip(&mut forces)
        {
            let rate =
                |a: usize, b: usize| (dot(d[a], v[b]) + dot(v[a], d[b])) * (0.5 * self.in_plane[1]);
            add_in_plane(d, [rate(0, 0), rate(0, 1), rate(1, 1)], force);
        }
        forces
    }

    /// Whether its material has a viscosity.
    fn is_viscous(&self) -> bool {
        self.viscosity != [0.0; 6]
    }

    /// Calls `see` with factors c and vectors f of forces on both ends, the slopes of strains by the state: the damping is the sum of c f f^T.
    fn each_damper(
        &self,
        deformed: &Deformed<f64>,
        at: &[Section<f64>; 2],
        mut see: impl FnMut(f64, [Section<f64>; 2]),
    ) {
        for (k, viscosity) in self.viscosity.into_iter().enumerate().filter(|(_, c)| *c > 0.0) {
            let mut unit = [0.0; 6];
            unit[k] = 1.0;
            let [a, b, c, d, e, f] = unit;
            let forces = deformed.forces(Strains { gamma: [a, b, c], kappa: [d, e, f] });
            see(viscosity / self.length, forces);
        }
        for (end, Section { d, .. }) in at.iter().enumerate() {
            for (unit, count) in
                [([1.0, 0.0, 0.0], 1.0), ([0.0, 0.5, 0.0], 2.0), ([0.0, 0.0, 1.0], 1.0)]
            {
                let mut forces = [Section::zero(); 2];
                add_in_plane(d, unit, &mut forces[end]);
                see(count * self.in_plane[1], forces);
            }
        }
    }
}

/// Adds the forces along the directors `d` of stresses 11, 12, 22 of a section in its plane.
fn add_in_plane<T: Number>(
    [first, second]: &[Vector<T>; 2],
    [s11, s12, s22]: [T; 3],
    force: &mut Section<T>,
) {
    let [on_first, on_second] = &mut force.d;
    for i in 0..3 {
        on_first[i] += first[i] * s11 + second[i] * s12;
        on_second[i] += first[i] * s12 + second[i] * s22;
    }
}

impl RodElements {
    /// The nodes of each element.
    pub(crate) fn groups(&self) -> Vec<Vec<usize>> {
        let of = |element: &RodElement| {
            element
                .ends
                .iter()
                .flat_map(|end| end.nodes[..self.dimension].iter().copied())
                .collect()
        };
        self.elements.iter().map(of).collect()
    }

    /// The same, on the nodes of several bodies, where its own begin with number `first`.
    pub(crate) fn among_others(&self, first: usize) -> Self {
        let mut moved = self.clone();
        for element in &mut moved.elements {
            for end in &mut element.ends {
                end.nodes.iter_mut().for_each(|node| *node += first);
            }
        }
        moved
    }

    /// Adds `factor` times the inertia (kg) to `matrix`: consistent with linear shape functions, or half of an element's at each of its ends.
    pub(crate) fn add_inertia(&self, factor: f64, is_lumped: bool, matrix: &mut NodeMatrix) {
        for element in &self.elements {
            let [mass, about_1, about_2] = element.mass;
            // that of a director is about the other one
            let moments = [about_2, about_1];
            for (i, first) in element.ends.iter().enumerate() {
                for (j, second) in element.ends.iter().enumerate() {
                    let share = match (is_lumped, i == j) {
                        (false, true) => 1.0 / 3.0,
                        (false, false) => 1.0 / 6.0,
                        (true, true) => 0.5,
                        (true, false) => continue,
                    };
                    let weight = factor * share * element.length;
                    let (own, other) = (first.nodes, second.nodes);
                    matrix.add(own[0], other[0], weight * mass);
                    for director in 0..self.dimension - 1 {
                        let (a, b) = (first.arms[director], second.arms[director]);
                        let value = weight * moments[director] / (a * b);
                        matrix.add(own[0], other[0], value);
                        matrix.add(own[0], other[director + 1], -value);
                        matrix.add(own[director + 1], other[0], -value);
                        matrix.add(own[director + 1], other[director + 1], value);
                    }
                }
            }
        }
    }

    /// The state of the ends of an element at `u` (m), or their velocities.
    pub(super) fn state(
        &self,
        element: &RodElement,
        u: &[f64],
        natural: bool,
    ) -> [Section<f64>; 2] {
        let d = self.dimension;
        element.ends.map(|end| end.section(d, natural, |v, i| u[end.nodes[v] * d + i]))
    }

    /// The state of the ends at `u` (m), with derivatives by all of its unknowns.
    pub(super) fn dual_state(&self, element: &RodElement, u: &[f64]) -> [Section<Dual>; 2] {
        let d = self.dimension;
        [0, 1].map(|end| {
            let nodes = element.ends[end].nodes;
            let value = |w: usize, i: usize| dual(u[nodes[w] * d + i], own(d, [end, w, i]));
            element.ends[end].section(d, true, value)
        })
    }

    /// Adds the elastic forces at displacements `u` (m) to `elastic`, and the viscous ones at velocities `v` (m/s) to `viscous`.
    ///
    /// # Errors
    /// A section that has collapsed, or that has turned by half a turn against its neighbour.
    pub(crate) fn add_forces(
        &self,
        u: &[f64],
        v: &[f64],
        elastic: &mut [f64],
        viscous: &mut [f64],
    ) -> Result<(), Failure> {
        let d = self.dimension;
        for element in &self.elements {
            let at = self.state(element, u, true);
            let moving = self.state(element, v, false);
            let deformed = Deformed::new(element.length, at);
            if !deformed.is_within_half_a_turn() {
                let problem = "a cross section of a rod has collapsed, or has turned by half a turn against the next one: more \
                               elements may help";
                return Err(Failure::Recoverable(problem.into()));
            }
            let parts = [
                (&mut *elastic, element.elastic(&deformed, &at)),
                (&mut *viscous, element.viscous(&deformed, &at, &moving)),
            ];
            for (out, part) in parts {
                for (end, on) in element.ends.iter().zip(part) {
                    end.scatter(d, &on, |v, i, force| out[end.nodes[v] * d + i] -= force);
                }
            }
        }
        Ok(())
    }

    /// Adds the tangents where nothing has moved, of a body of so many nodes.
    pub(crate) fn add_tangents_at_rest(
        &self,
        nodes: usize,
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let zeros = vec![0.0; nodes * self.dimension];
        self.add_tangents(&zeros, &zeros, stiffness, damping);
    }

    /// Adds -df/du to `stiffness` and -df/dv to `damping`.
    pub(crate) fn add_tangents(
        &self,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        let d = self.dimension;
        for element in &self.elements {
            let ends = element.ends;
            let at = self.dual_state(element, u);
            let still = self.state(element, v, false).map(constant);
            let deformed = Deformed::new(element.length, at);
            let (elastic, viscous) =
                (element.elastic(&deformed, &at), element.viscous(&deformed, &at, &still));
            for part in [elastic, viscous] {
                for (end, on) in ends.iter().zip(part) {
                    end.scatter(d, &on, |v, i, force| {
                        let slopes = force.eps.unwrap_generic(Const::<UNKNOWNS>, Const::<1>);
                        let row = end.nodes[v];
                        add_row(stiffness, &ends, d, row, i, |end, w, j| {
                            slopes[own(d, [end, w, j])]
                        });
                    });
                }
            }
            let at = self.state(element, u, true);
            let deformed = Deformed::new(element.length, at);
            element.each_damper(&deformed, &at, |factor, forces| {
                let mut all = [0.0; UNKNOWNS];
                for (number, (end, on)) in ends.iter().zip(forces).enumerate() {
                    end.scatter(d, &on, |v, i, force| all[own(d, [number, v, i])] += force);
                }
                for (number, end) in ends.iter().enumerate() {
                    for (v, i) in (0..d).flat_map(|v| (0..d).map(move |i| (v, i))) {
                        let value = factor * all[own(d, [number, v, i])];
                        let row = end.nodes[v];
                        add_row(damping, &ends, d, row, i, |end, w, j| {
                            value * all[own(d, [end, w, j])]
                        });
                    }
                }
            });
        }
    }

    /// Strain energy (J) at displacements `u` (m).
    pub(crate) fn energy(&self, u: &[f64]) -> f64 {
        let of = |element: &RodElement| {
            let at = self.state(element, u, true);
            let strains = Deformed::new(element.length, at).strains();
            let mut energy = 0.0;
            for k in 0..3 {
                let gamma = strains.gamma[k] - element.natural.gamma[k];
                let kappa = strains.kappa[k] - element.natural.kappa[k];
                energy += element.stiffness[k] * gamma * gamma;
                energy += element.stiffness[3 + k] * kappa * kappa;
            }
            energy *= 0.5 * element.length;
            for Section { d, .. } in &at {
                for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let unit = if a == b { 1.0 } else { 0.0 };
                    energy += 0.125 * element.in_plane[0] * (dot(d[a], d[b]) - unit).powi(2);
                }
            }
            energy
        };
        self.elements.iter().map(of).sum()
    }
}

/// Adds the `entries` of a row, component `i` of a node, to a `matrix`: for each end its vectors with their components.
pub(super) fn add_row(
    matrix: &mut BlockMatrix,
    ends: &[End; 2],
    d: usize,
    row: usize,
    i: usize,
    entries: impl Fn(usize, usize, usize) -> f64,
) {
    for (end, other) in ends.iter().enumerate() {
        for w in 0..d {
            let Some(block) = matrix.block_mut(row, other.nodes[w]) else { continue };
            (0..d).for_each(|j| block[i * d + j] += entries(end, w, j));
        }
    }
}

/// The number of an unknown of an element in a space of a `dimension`: of an end, a node of it, a component.
pub(super) fn own(dimension: usize, [end, node, i]: [usize; 3]) -> usize {
    (end * dimension + node) * dimension + i
}

/// A section of numbers without derivatives.
fn constant(section: Section<f64>) -> Section<Dual> {
    Section { x: section.x.map(Dual::from), d: section.d.map(|d| d.map(Dual::from)) }
}

/// A number that is one of the unknowns.
fn dual(value: f64, number: usize) -> Dual {
    let mut slopes = SVector::<f64, UNKNOWNS>::zeros();
    slopes[number] = 1.0;
    DualVec::new(value, num_dual::Derivative::some(slopes))
}
