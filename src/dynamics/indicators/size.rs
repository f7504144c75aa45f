//! Sizes of cells.

use nalgebra::SVector;

use crate::elements::body::{Body, Part};
use crate::scene::forces::natural;

/// The size (m) of each cell: the edge of a square or cube that is cut into such cells, or that is such a cell.
pub(super) fn cell_sizes(body: &Body) -> Vec<f64> {
    let of_body = |part: Part| {
        let dimension = part.body.mesh().kind().dimension();
        let blocks = block_volumes(part.body).zip(part.body.cell_sections());
        let size = |(volume, section): (f64, f64)| (volume / section).powf(1.0 / dimension as f64);
        blocks.map(size).collect::<Vec<f64>>()
    };
    body.parts().flat_map(of_body).collect()
}

/// For each cell of a single body the volume (m^3) of the block that it is cut from, or is itself.
pub(super) fn block_volumes(body: &Body) -> impl Iterator<Item = f64> {
    let kind = body.mesh().kind();
    // the parallelepiped of the edges of a simplex has this many times its volume
    let is_simplex = kind.faces().len() == kind.dimension() + 1;
    let parts = if is_simplex { [1.0, 1.0, 2.0, 6.0][kind.dimension()] } else { 1.0 };
    body.cell_volumes().into_iter().map(move |volume| parts * volume)
}

/// The least length (m) of each cell of a single body, nearly: of its shortest edge, or of its height over the others.
pub(super) fn least_cell_lengths(body: &Body) -> Vec<f64> {
    let mesh = body.mesh();
    let position = |node: usize| SVector::<f64, 3>::from(natural(mesh, node));
    let of_cell = |(cell, (volume, section)): (&[usize], (f64, f64))| {
        let edges = mesh.kind().edges().iter();
        let lengths = edges.map(|edge| (position(cell[edge[1]]) - position(cell[edge[0]])).norm());
        let (least, most) = lengths.fold((f64::INFINITY, 0.0_f64), |(least, most), length| {
            (least.min(length), most.max(length))
        });
        least.min(volume / section / most.powi(mesh.kind().dimension() as i32 - 1))
    };
    let blocks = block_volumes(body).zip(body.cell_sections());
    mesh.cells().zip(blocks).map(of_cell).collect()
}

/// For each node the size (m) of the smallest of its cells. Infinite for a node without cells.
pub(super) fn least_cell_sizes(body: &Body) -> Vec<f64> {
    let mut sizes = vec![f64::INFINITY; body.mesh().node_count()];
    for (cell, size) in body.mesh().cells().zip(cell_sizes(body)) {
        cell.iter().for_each(|&node| sizes[node] = sizes[node].min(size));
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::studies::samples::SQUARE_MATERIAL;

    /// Sizes in a plane do not depend on the thickness, which bodies have of their own.
    #[test]
    fn sizes_are_those_of_squares_in_each_body() {
        let body = |thickness: f64, cells: Cells| {
            let mesh = Mesh::rectangle([0.2, 0.1], [3, 2], cells).unwrap();
            Body::new(mesh, SQUARE_MATERIAL).thickness(thickness).build().unwrap()
        };
        let both = Body::join([body(0.01, Cells::Triangles), body(0.04, Cells::Rectangles)]);
        let sizes = cell_sizes(&both.unwrap());
        assert!(sizes.iter().all(|size| (size - 0.1).abs() < 1e-15), "{sizes:?}");
        assert_eq!(sizes.len(), 6);
    }
}
