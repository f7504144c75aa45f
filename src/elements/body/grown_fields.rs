//! Fields of a body some of whose cells have grown: strains are those of F, stresses and energies those of F_e.

use nalgebra::Matrix3;

use super::assembled::Body;
use super::fields::{CellField, NodalField, Probe, Tensors, after_growth, nodal_fields};
use super::growth::shrink;
use crate::elements::material::{FibreDirection, Stretches};

/// Cells (counted from 0) that have grown: along a course and across it, or alike in all directions.
pub(crate) struct Grown {
    pub(crate) cells: Vec<usize>,
    pub(crate) course: Option<FibreDirection>,
    pub(crate) stretches: Stretches,
}

/// Cells that have grown, with the displacements (m) that are left of those of the nodes where they grow alike in all directions; none if none do.
type Shrunk<'g> = (&'g Grown, Vec<f64>);

impl Body {
    /// As [`cell_fields`](Self::cell_fields), where cells have `grown`.
    pub(crate) fn cell_fields_of(&self, u: &[f64], grown: &[Grown]) -> Vec<CellField> {
        let mut fields = self.cell_fields(u);
        for (grown, left) in self.left(u, grown) {
            let alike = if left.is_empty() { Vec::new() } else { self.cell_fields(&left) };
            for &cell in &grown.cells {
                let own = self.continuum_of(cell);
                let (course, stretches) = (grown.course.as_ref(), grown.stretches);
                if !own.grows_alike(course) {
                    let number = cell - own.cells.start;
                    let grown = own.grown(stretches);
                    let course = (self.mesh(), course);
                    fields[cell] = own.elements.grown_field(grown, course, u, number);
                    continue;
                }
                let CellField { strain, stress, energy_density } = alike[cell];
                fields[cell] = CellField {
                    strain: after_growth(Matrix3::from(strain), stretches.along).into(),
                    stress,
                    energy_density: stretches.volume() * energy_density,
                };
            }
        }
        fields
    }

    /// As [`nodal_fields`](Self::nodal_fields), likewise.
    pub(crate) fn nodal_fields_of(&self, u: &[f64], grown: &[Grown]) -> Vec<NodalField> {
        let (volumes, left) = (self.cell_volumes(), self.left(u, grown));
        nodal_fields(self.mesh().node_count(), &volumes, |cell, see| {
            self.each_node_of(u, &left, cell, see);
        })
    }

    /// Nodal values of the field that `probe` reads under the displacements `u` (m), likewise.
    pub(crate) fn probed(&self, probe: &Probe, u: &[f64], grown: &[Grown]) -> NodalField {
        let left = self.left(u, grown);
        probe.read(|cell, see| self.each_node_of(u, &left, cell, see))
    }

    fn left<'g>(&self, u: &[f64], grown: &'g [Grown]) -> Vec<Shrunk<'g>> {
        let shrunk = |grown: &'g Grown| {
            let course = grown.course.as_ref();
            if !grown.cells.iter().any(|cell| self.continuum_of(*cell).grows_alike(course)) {
                return (grown, Vec::new());
            }
            let mut own = vec![0.0; u.len()];
            shrink(self.mesh().positions(), u, grown.stretches.along, &mut own);
            (grown, own)
        };
        grown.iter().map(shrunk).collect()
    }

    /// The tensors at the nodes of a cell.
    fn each_node_of(
        &self,
        u: &[f64],
        left: &[Shrunk],
        cell: usize,
        see: &mut dyn FnMut(usize, usize, &Tensors),
    ) {
        let Some((grown, alike)) = left.iter().find(|(grown, _)| grown.cells.contains(&cell))
        else {
            return self.each_node(u, cell, see);
        };
        let own = self.continuum_of(cell);
        let (course, stretches) = (grown.course.as_ref(), grown.stretches);
        if !own.grows_alike(course) {
            let (course, number) = ((self.mesh(), course), cell - own.cells.start);
            let grown = own.grown(stretches);
            return own.elements.each_grown_node(grown, course, u, number, see);
        }
        self.each_node(alike, cell, &mut |node, a, tensors| {
            see(node, a, &tensors.after_growth(stretches.along));
        });
    }
}
