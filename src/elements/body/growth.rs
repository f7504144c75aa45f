//! The elasticity of cells that grow: F = F_e F_g with F_g = g I, and the energy g^3 W(F_e) per natural volume.
//!
//! F_e = F / g is the gradient of the positions x / g, so that forces, tangents and energies are those of the elements as they are, at the
//! displacements u' = x / g - X, times powers of g: g^3 U(u') has the forces g^2 f(u') and the tangents g K(u').

use std::sync::{Arc, Mutex, PoisonError};

use super::assembled::Body;
use super::continuum::Continuum;
use super::elastic::Elastic;
use super::fields::{CellField, NodalField, Probe, Tensors, nodal_fields};
use super::forces::Terms;
use crate::base::input::InputError;
use crate::base::sparse::{BlockMatrix, NodePattern};
use crate::base::vector::dot;
use crate::elements::force::NodalForces;
use crate::elements::material::{Plane, Strain};
use crate::integrators::ode::Failure;

/// The elasticity of some cells of a body, which grow.
pub(crate) struct Growing {
    /// Bodies with the elasticity of these cells alone.
    bodies: Vec<Continuum>,
    /// Undeformed positions of the nodes (m).
    positions: Vec<f64>,
    pattern: Arc<NodePattern>,
    /// Room that no evaluation has at the moment. The lock is not held while one runs: its threads may meanwhile begin
    /// that of another fork.
    free: Mutex<Vec<Scratch>>,
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
    /// Strain energy (J) of cells that have grown to `stretch` (1) times their size.
    pub(crate) fn energy(&self, stretch: f64, u: &[f64]) -> f64 {
        let mut scratch = self.scratch();
        let own = &mut scratch.u;
        shrink(&self.positions, u, stretch, own);
        let energy = stretch.powi(3) * energy(&self.bodies, own);
        self.give_back(scratch);
        energy
    }

    /// Adds their forces (N), and the power (W) that growth at a `rate` (1/s) supplies.
    pub(crate) fn add_forces(
        &self,
        [stretch, rate]: [f64; 2],
        u: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let mut scratch = self.scratch();
        let added = self.add_forces_in(&mut scratch, [stretch, rate], u, forces);
        self.give_back(scratch);
        added
    }

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

    /// Adds their tangents to the stiffness.
    pub(crate) fn add_tangents(&self, stretch: f64, u: &[f64], stiffness: &mut BlockMatrix) {
        let mut scratch = self.scratch();
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
fn shrink(positions: &[f64], u: &[f64], stretch: f64, own: &mut [f64]) {
    for ((own, x), u) in own.iter_mut().zip(positions).zip(u) {
        *own = (x + u) / stretch - x;
    }
}

fn energy(bodies: &[Continuum], u: &[f64]) -> f64 {
    bodies.iter().map(|Continuum { elements, regions, .. }| elements.energy(regions, u)).sum()
}

/// Cells (counted from 0) that have grown, and to how many times their size (1).
pub(crate) type Grown = (Vec<usize>, f64);

impl Body {
    /// The elasticity of `cells` (counted from 0), which grow.
    ///
    /// # Errors
    /// Cells that are rigid, whose strain is Cauchy's, in plane strain, or whose material relaxes.
    pub(crate) fn growing(&self, cells: &[usize]) -> Result<Growing, InputError> {
        let grows = self.marked(cells);
        let mut bodies = Vec::new();
        for own in &self.continua {
            let inside = |cell: usize| grows[own.cells.start + cell];
            if !(0..own.cells.len()).any(inside) {
                continue;
            }
            let wrong =
                |input: &str, value: &str, help: &str| Err(InputError::new(input, value, help));
            if own.strain == Strain::Cauchy {
                return wrong("strain", "Cauchy", "growth is not small: measure strain by Green's");
            }
            if own.kind.dimension() == 2 && own.plane == Plane::Strain {
                let help = "what cannot grow across the plane is pressed there, which cells in the plane do not know: take plane stress, or a solid";
                return wrong("plane", "strain", help);
            }
            let is_rigid = |cell: &usize| own.regions.of(*cell).of_rigid.is_some();
            if let Some(cell) = (0..own.cells.len()).find(|cell| inside(*cell) && is_rigid(cell)) {
                let number = (own.cells.start + cell + 1).to_string();
                return wrong("cell", &number, "it is rigid: name cells that are soft");
            }
            if own.regions.branches().next().is_some() {
                let help = "what relaxes does not know of growth: leave the Maxwell branches out";
                return wrong("material.branch", "given", help);
            }
            let regions =
                own.regions.parted(own.cells.len(), own.kind.dimension(), own.plane, inside);
            let [regions, _] = regions;
            bodies.push(Continuum { regions: regions.into(), ..own.clone() });
        }
        let positions = self.mesh.positions().to_vec();
        let pattern = self.inertia.pattern().clone();
        let free = vec![Scratch::new(&pattern, positions.len())];
        Ok(Growing { bodies, positions, pattern, free: free.into() })
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

    /// The displacements whose strains are those that are left of `u` (m) where cells have grown to `stretch` times their size.
    fn shrunk(&self, u: &[f64], stretch: f64) -> Vec<f64> {
        let mut own = vec![0.0; u.len()];
        shrink(self.mesh.positions(), u, stretch, &mut own);
        own
    }

    /// As [`cell_fields`](Self::cell_fields), with the stress and the energy of cells that have `grown`.
    pub(crate) fn cell_fields_of(&self, u: &[f64], grown: &[Grown]) -> Vec<CellField> {
        let mut fields = self.cell_fields(u);
        for (cells, stretch) in grown {
            let own = self.cell_fields(&self.shrunk(u, *stretch));
            for &cell in cells {
                fields[cell].stress = own[cell].stress;
                fields[cell].energy_density = stretch.powi(3) * own[cell].energy_density;
            }
        }
        fields
    }

    /// As [`nodal_fields`](Self::nodal_fields), likewise.
    pub(crate) fn nodal_fields_of(&self, u: &[f64], grown: &[Grown]) -> Vec<NodalField> {
        let (volumes, shrunk) = (self.cell_volumes(), self.all_shrunk(u, grown));
        nodal_fields(self.mesh.node_count(), &volumes, |cell, see| {
            self.each_node_of(u, &shrunk, cell, see);
        })
    }

    /// What `probe` reads under the displacements `u` (m), likewise.
    pub(crate) fn probed(&self, probe: &Probe, u: &[f64], grown: &[Grown]) -> NodalField {
        let shrunk = self.all_shrunk(u, grown);
        probe.read(|cell, see| self.each_node_of(u, &shrunk, cell, see))
    }

    fn all_shrunk<'a>(&self, u: &[f64], grown: &'a [Grown]) -> Vec<(&'a [usize], Vec<f64>)> {
        grown.iter().map(|(cells, stretch)| (&cells[..], self.shrunk(u, *stretch))).collect()
    }

    /// The tensors at the nodes of a cell: its strain, and the stress of what is left where it has grown.
    fn each_node_of(
        &self,
        u: &[f64],
        shrunk: &[(&[usize], Vec<f64>)],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        let Some((_, own)) = shrunk.iter().find(|(cells, _)| cells.contains(&cell)) else {
            return self.each_node(u, cell, see);
        };
        let mut strains = Vec::new();
        self.each_node(u, cell, &mut |_, _, tensors| strains.push(*tensors));
        self.each_node(own, cell, &mut |node, a, tensors| {
            see(node, a, &strains[a].stressed_as(tensors))
        });
    }
}
