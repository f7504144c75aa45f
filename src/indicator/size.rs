//! Sizes of cells.

use crate::body::Body;

/// For each node the size (m) of the smallest of its cells: the edge of a square or cube that is cut into such cells, or that
/// is such a cell. Infinite of a node without cells.
pub(super) fn cell_sizes(body: &Body) -> Vec<f64> {
    let mesh = body.mesh();
    let dimension = mesh.kind().dimension();
    // a simplex fills the parallelepiped of its edges to this part
    let is_simplex = mesh.kind().faces().len() == dimension + 1;
    let parts = if is_simplex { [1.0, 1.0, 2.0, 6.0][dimension] } else { 1.0 };
    let mut sizes = vec![f64::INFINITY; mesh.node_count()];
    for (cell, volume) in mesh.cells().zip(body.cell_volumes()) {
        let size = (parts * volume / body.section()).powf(1.0 / dimension as f64);
        cell.iter().for_each(|&node| sizes[node] = sizes[node].min(size));
    }
    sizes
}
