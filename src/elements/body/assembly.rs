//! One interface to the elements of all kinds of cells and dimensions.

use std::sync::Arc;

use super::branch_modes::BranchModal;
use super::branches::Branched;
use super::dilatation::Dilatation;
use super::elements::ElementsOf;
use super::fibres::Reinforced;
use super::fields::{BranchFields, Fields, GrownFields};
use super::forces::Forces;
use super::inertia::Masses;
use super::magnetized_points::MagnetizableElements;
use super::magnets::Magnetized;
use super::offset::Offset;
use super::oriented::Orientable;
use super::recovery::Recovery;
use super::section::Section;
use super::strain_modes::StrainProducts;
use super::tangents::Tangents;
use super::turning::Turning;
use crate::base::input::InputError;
use crate::base::sparse::NodePattern;
use crate::elements::basis::{ReferenceCell, with_element};
use crate::elements::mesh::Mesh;

/// All elements of a body.
pub(super) trait Elements:
    Masses
    + Forces
    + Branched
    + Reinforced
    + Orientable
    + Magnetized
    + MagnetizableElements
    + Tangents
    + Turning
    + Fields
    + BranchFields
    + GrownFields
    + Recovery
    + StrainProducts
    + BranchModal
    + Send
    + Sync
{
    /// The same on the nodes of several bodies.
    fn among_others(&self, offset: Offset) -> Arc<dyn Elements>;

    /// Some of these `cells` (ascending), each times a weight, on a mesh of `node_count` nodes whose pairs `pattern` has,
    /// or else that of these elements.
    fn sampled(
        &self,
        cells: &[usize],
        weights: &[f64],
        pattern: Option<&NodePattern>,
        node_count: usize,
    ) -> Arc<dyn Elements>;

    /// The nodes of all cells, one cell after the other.
    fn nodes_of_cells(&self) -> &[usize];
}

impl<const N: usize, const M: usize, const D: usize, const Q: usize> Elements
    for ElementsOf<N, M, D, Q>
{
    fn among_others(&self, offset: Offset) -> Arc<dyn Elements> {
        Arc::new(Self::among_others(self, offset))
    }

    fn sampled(
        &self,
        cells: &[usize],
        weights: &[f64],
        pattern: Option<&NodePattern>,
        node_count: usize,
    ) -> Arc<dyn Elements> {
        Arc::new(Self::sampled(self, cells, weights, pattern, node_count))
    }

    fn nodes_of_cells(&self) -> &[usize] {
        self.nodes.as_flattened()
    }
}

/// The elements on the cells of `mesh`, whose nodes `pattern` couples; `section` is the area or thickness of
/// the body.
pub(super) fn elements(
    mesh: &Mesh,
    section: Section,
    dilatation: Dilatation,
    pattern: &NodePattern,
) -> Result<Arc<dyn Elements>, InputError> {
    with_element!(mesh.kind(), mesh.dimension(), of(mesh, section, dilatation, pattern))
}

fn of<C: ReferenceCell<N, M>, const N: usize, const M: usize, const D: usize, const Q: usize>(
    mesh: &Mesh,
    section: Section,
    dilatation: Dilatation,
    pattern: &NodePattern,
) -> Result<Arc<dyn Elements>, InputError> {
    Ok(Arc::new(ElementsOf::<N, M, D, Q>::new::<C>(mesh, section, dilatation, pattern)?))
}
