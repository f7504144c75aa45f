//! The elasticity of cells that grow: F = F_e G, and the energy det(G) W(F_e) per natural volume.
//!
//! Where they grow alike in all directions, G = g I, F_e = F / g is the gradient of the positions x / g, so that forces, tangents and energies are those of
//! the elements as they are, at the displacements u' = x / g - X, times powers of g: g^3 U(u') has the forces g^2 f(u') and the tangents g K(u').
//!
//! Rods change the strains in which they are free of stress (`elements/rod/growth.rs`).
//!
//! Where they grow by direction, or are pressed across their plane as they grow, they have a [law](crate::elements::material::GrownLaw) of
//! that.
//!
//! All loops, laws and projected dilatations so serve growth as they are. For growth by direction one law is
//! compiled that calls the material's (`elements/material/grown.rs`), and not one for each; its direction is
//! that of the frames of the strain points (`oriented.rs`). Its power is summed point by point
//! (`fields/grown.rs`) while a strain changes:
//!
//! ```text
//! det(G) ((g'/g + 2 g_t'/g_t) W - g'/g a . M a - g_t'/g_t (tr M - a . M a)),   M = C_e S_e
//! ```

use std::sync::{Arc, Mutex, PoisonError};

use super::assembled::Body;
use super::continuum::Continuum;
use super::elastic::Elastic;
use super::forces::Terms;
use super::oriented::{Grown, Oriented};
use super::regions::Regions;
use crate::base::input::InputError;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::dot;
use crate::elements::force::NodalForces;
use crate::elements::material::{FibreDirection, Plane, Strain, Stretches};
use crate::elements::rod::RodGrowth;
use crate::integrators::ode::Failure;

/// The elasticity of some cells of a body, which grow.
pub(crate) struct Growing {
    /// Bodies with the elasticity of those of these cells alone that grow alike in all directions.
    bodies: Vec<Continuum>,
    oriented: Vec<OrientedPart>,
    rods: Vec<RodGrowth>,
    /// Undeformed positions of the nodes (m).
    positions: Vec<f64>,
    pattern: Arc<NodePattern>,
    /// Room that no evaluation has at the moment. The lock is not held while one runs: its threads may meanwhile begin
    /// that of another fork.
    free: Mutex<Vec<Scratch>>,
}

/// Cells of one body that grow by direction.
struct OrientedPart {
    cells: Box<dyn Oriented>,
    regions: Regions,
    is_pressed: bool,
}

impl OrientedPart {
    fn grown(&self, stretches: Stretches) -> Grown<'_> {
        Grown { regions: &self.regions, stretches, is_pressed: self.is_pressed }
    }
}

/// Room for an evaluation.
struct Scratch {
    u: Vec<f64>,
    forces: NodalForces,
    matrices: [BlockMatrix; 2],
}

impl Scratch {
    fn new(pattern: &Arc<NodePattern>, dofs: usize) -> Self {
        let zeros = BlockMatrix::zeros(pattern, dofs / pattern.nodes());
        Self {
            u: vec![0.0; dofs],
            forces: NodalForces::zeros(dofs),
            matrices: [zeros.clone(), zeros],
        }
    }
}

const ELASTIC: Terms = Terms { elastic: true, viscous: false };

impl Growing {
    /// Strain energy (J) of cells that have grown.
    pub(crate) fn energy(&self, stretches: Stretches, u: &[f64]) -> f64 {
        let parts = self.oriented.iter();
        let oriented: f64 = parts.map(|part| part.cells.energy(part.grown(stretches), u)).sum();
        let of_rods = self.rods.iter().map(|rod| rod.energy(stretches.along - 1.0, u));
        let oriented = oriented + of_rods.sum::<f64>();
        if self.bodies.is_empty() {
            return oriented;
        }
        let mut scratch = self.scratch();
        let (stretch, own) = (stretches.along, &mut scratch.u);
        shrink(&self.positions, u, stretch, own);
        let energy = stretch.powi(3) * energy(&self.bodies, own);
        self.give_back(scratch);
        energy + oriented
    }

    /// Adds their forces (N), and the power (W) that growth supplies as the stretches along the direction and across it change by these `rates` (1/s).
    pub(crate) fn add_forces(
        &self,
        stretches: Stretches,
        rates: [f64; 2],
        u: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        for part in &self.oriented {
            let grown = part.grown(stretches);
            part.cells.add_forces(grown, u, &mut forces.conservative)?;
            if rates != [0.0; 2] {
                let by_themselves = [rates[0] / stretches.along, rates[1] / stretches.across];
                forces.carried_power += part.cells.power(grown, by_themselves, u);
            }
        }
        for rod in &self.rods {
            let strain = stretches.along - 1.0;
            rod.add_forces(strain, u, &mut forces.conservative);
            if rates[0] != 0.0 {
                forces.carried_power += rod.power([strain, rates[0]], u);
            }
        }
        if self.bodies.is_empty() {
            return Ok(());
        }
        let mut scratch = self.scratch();
        let added = self.add_forces_in(&mut scratch, [stretches.along, rates[0]], u, forces);
        self.give_back(scratch);
        added
    }

    /// Those of isotropic growth.
    fn add_forces_in(
        &self,
        Scratch { u: own, forces: inner, .. }: &mut Scratch,
        [stretch, rate]: [f64; 2],
        u: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        shrink(&self.positions, u, stretch, own);
        inner.clear();
        for Continuum { elements, regions, .. } in &self.bodies {
            elements.add_forces(regions, ELASTIC, own, own, inner)?;
        }
        let square = stretch * stretch;
        for (force, inner) in forces.conservative.iter_mut().zip(&*inner.conservative) {
            *force += square * inner;
        }
        if rate != 0.0 {
            // x . f(u'), with x = g (X + u')
            let pull = stretch
                * (dot(&self.positions, &inner.conservative) + dot(own, &inner.conservative));
            forces.carried_power +=
                rate * (3.0 * square * energy(&self.bodies, own) + stretch * pull);
        }
        Ok(())
    }

    /// Adds their tangents to the stiffness. The damping does not change: its rows are only divided among threads with those of the stiffness.
    pub(crate) fn add_tangents(
        &self,
        stretches: Stretches,
        u: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) {
        for part in &self.oriented {
            part.cells.add_tangents(part.grown(stretches), u, stiffness, damping);
        }
        for rod in &self.rods {
            rod.add_tangents(stretches.along - 1.0, u, stiffness);
        }
        if self.bodies.is_empty() {
            return;
        }
        let (stretch, mut scratch) = (stretches.along, self.scratch());
        let Scratch { u: own, matrices: [inner, damping], .. } = &mut scratch;
        shrink(&self.positions, u, stretch, own);
        inner.values.fill(0.0);
        for Continuum { elements, regions, .. } in &self.bodies {
            elements.add_tangents(regions, ELASTIC, own, own, inner, damping);
        }
        let pattern = inner.pattern().clone();
        let size = inner.dimension() * inner.dimension();
        for row in 0..pattern.nodes() {
            for (entry, column) in pattern.row(row) {
                let Some(block) = stiffness.block_mut(row, column) else { continue };
                let values = &inner.values[entry * size..(entry + 1) * size];
                block.iter_mut().zip(values).for_each(|(sum, value)| *sum += stretch * value);
            }
        }
        self.give_back(scratch);
    }

    fn scratch(&self) -> Scratch {
        let free = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        free.unwrap_or_else(|| Scratch::new(&self.pattern, self.positions.len()))
    }

    fn give_back(&self, scratch: Scratch) {
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(scratch);
    }
}

/// Writes the displacements u' = (X + u) / `stretch` - X.
pub(super) fn shrink(positions: &[f64], u: &[f64], stretch: f64, own: &mut [f64]) {
    for ((own, x), u) in own.iter_mut().zip(positions).zip(u) {
        *own = (x + u) / stretch - x;
    }
}

fn energy(bodies: &[Continuum], u: &[f64]) -> f64 {
    bodies.iter().map(|Continuum { elements, regions, .. }| elements.energy(regions, u)).sum()
}

impl Continuum {
    /// Whether its cells cannot grow across their plane.
    fn is_pressed(&self) -> bool {
        self.kind.dimension() == 2 && self.plane == Plane::Strain
    }

    /// Its cells as they are after growth.
    pub(super) fn grown(&self, stretches: Stretches) -> Grown<'_> {
        Grown { regions: &self.regions, stretches, is_pressed: self.is_pressed() }
    }

    /// Whether its cells grow alike in all directions, those across them included.
    pub(super) fn grows_alike(&self, course: Option<&FibreDirection>) -> bool {
        course.is_none() && !self.is_pressed()
    }
}

impl Body {
    /// The elasticity of `cells` (counted from 0), which grow along and across the directions of a `course`, or alike in all directions; of rods, which get longer,
    /// or bend and twist by these curvatures and this twist (1/m) per strain.
    ///
    /// # Errors
    /// Cells that are rigid, whose strain is Cauchy's, or whose material relaxes; a course that is none there.
    pub(crate) fn growing(
        &self,
        cells: &[usize],
        course: Option<&FibreDirection>,
        bends: Option<[f64; 3]>,
    ) -> Result<Growing, InputError> {
        let grows = self.marked(cells);
        let (mut bodies, mut oriented, mut rods) = (Vec::new(), Vec::new(), Vec::new());
        for own in &self.continua {
            let inside = |cell: usize| grows[own.cells.start + cell];
            let cells: Vec<usize> = (0..own.cells.len()).filter(|cell| inside(*cell)).collect();
            if cells.is_empty() {
                continue;
            }
            let wrong =
                |input: &str, value: &str, help: &str| Err(InputError::new(input, value, help));
            match &own.rod {
                Some(_) if course.is_some() => {
                    return wrong("direction", "given", "rods grow along their axis: leave it out");
                }
                Some(rod) if rod.relaxes() => {
                    let help = "Maxwell branches do not support growth: remove them";
                    return wrong("material.branch", "given", help);
                }
                Some(rod) => {
                    rods.push(RodGrowth::new(rod.clone(), &cells, bends));
                    continue;
                }
                None if bends.is_some() => {
                    return wrong("bend", "given", "rods alone have curvatures: name their cells");
                }
                None => {}
            }
            if own.strain == Strain::Cauchy {
                return wrong("strain", "Cauchy", "growth is not small: measure strain by Green's");
            }
            if let Some(cell) = cells.iter().find(|cell| own.regions.of(**cell).of_rigid.is_some())
            {
                let number = (own.cells.start + cell + 1).to_string();
                return wrong("cell", &number, "it is rigid: name cells that are soft");
            }
            if own.regions.branches().next().is_some() {
                let help = "Maxwell branches do not support growth: remove them";
                return wrong("material.branch", "given", help);
            }
            if !own.grows_alike(course) {
                oriented.push(OrientedPart {
                    cells: own.elements.oriented(&self.mesh, &cells, course)?,
                    regions: own.regions.sampled(&cells),
                    is_pressed: own.is_pressed(),
                });
                continue;
            }
            let regions =
                own.regions.parted(own.cells.len(), own.kind.dimension(), own.plane, inside);
            let [regions, _] = regions;
            bodies.push(Continuum { regions: regions.into(), ..own.clone() });
        }
        let positions = self.mesh.positions().to_vec();
        let pattern = self.inertia.pattern().clone();
        let free = match bodies.is_empty() {
            true => Vec::new(),
            false => vec![Scratch::new(&pattern, positions.len())],
        };
        Ok(Growing { bodies, oriented, rods, positions, pattern, free: free.into() })
    }

    /// The elastic and viscous forces that have no constant matrix, without those of rigid pieces and without the elasticity of `cells` (counted from 0).
    pub(crate) fn elastic_outside(&self, cells: &[usize]) -> Option<Elastic> {
        if cells.is_empty() {
            return self.elastic();
        }
        let grows = self.marked(cells);
        let mut rest = self.clone();
        for own in &mut rest.continua {
            let (first, count) = (own.cells.start, own.cells.len());
            let inside = |cell: usize| grows[first + cell];
            if (0..count).any(inside) {
                let [_, regions] =
                    own.regions.parted(count, own.kind.dimension(), own.plane, inside);
                own.regions = regions.into();
            }
        }
        rest.elastic()
    }

    fn marked(&self, cells: &[usize]) -> Vec<bool> {
        let mut marked = vec![false; self.mesh.cell_count()];
        cells.iter().for_each(|cell| marked[*cell] = true);
        marked
    }
}
