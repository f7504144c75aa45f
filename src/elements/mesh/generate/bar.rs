//! Bars of segments.

use super::{check_nodes, grid_line};
use crate::base::input::{InputError, positive};
use crate::elements::mesh::{CellKind, Mesh};

impl Mesh {
    /// A bar of `length` (m) along x from 0 with `nodes` equidistant nodes; sets `left`, `right`.
    ///
    /// [`Mesh::mapped`] makes a string in the plane or in space of it.
    ///
    /// # Errors
    /// A length that is not above 0, fewer than 2 nodes.
    pub fn bar(length: f64, nodes: usize) -> Result<Self, InputError> {
        positive("bar.length", length, "m")?;
        check_nodes("bar", [nodes])?;
        let positions = (0..nodes).map(|i| grid_line(i, nodes - 1, length)).collect();
        let connectivity = (0..nodes - 1).flat_map(|i| [i, i + 1]).collect();
        Mesh::new(1, positions, CellKind::Segment, connectivity)?
            .name_nodes("left", [1])?
            .name_nodes("right", [nodes])
    }
}
