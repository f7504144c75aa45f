//! Grids whose cells get longer or shorter along an axis.

use pliant::{Cells, InputError, Mesh, SolidCells};

use super::middles;

/// The lengths of the cells along `axis`, from lines at which corner nodes stand.
fn lengths(mesh: &Mesh, axis: usize) -> Vec<f64> {
    let corners = 1 << mesh.kind().dimension();
    let corners = if mesh.kind().nodes() < corners { mesh.kind().dimension() + 1 } else { corners };
    let mut lines: Vec<f64> = mesh
        .cells()
        .flat_map(|cell| cell[..corners].iter().map(|&node| mesh.position(node)[axis]))
        .collect();
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    lines.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Lengths of 1, 2 and 4 parts of 7; the same the other way round for the reciprocal, and equal ones for 1.
#[test]
fn cells_grow_by_the_same_factor() {
    let near = |found: &[f64], exact: &[f64]| {
        assert_eq!(found.len(), exact.len());
        let off = found.iter().zip(exact).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-14, "{found:?} instead of {exact:?}");
    };
    for cells in [Cells::Triangles, Cells::Rectangles] {
        let mesh = Mesh::graded_rectangle([7.0, 6.0], [4, 3], [4.0, 0.5], cells).unwrap();
        near(&lengths(&mesh, 0), &[1.0, 2.0, 4.0]);
        near(&lengths(&mesh, 1), &[4.0, 2.0]);
        assert_eq!(mesh.position(11), [7.0, 6.0]);
    }
    let grading = [0.25, 1.0, 2.0];
    let mesh = Mesh::graded_cuboid([7.0, 2.0, 3.0], [4, 3, 3], grading, SolidCells::Hexahedra);
    let mesh = mesh.unwrap();
    near(&lengths(&mesh, 0), &[4.0, 2.0, 1.0]);
    near(&lengths(&mesh, 1), &[1.0, 1.0]);
    near(&lengths(&mesh, 2), &[1.0, 2.0]);
    // dividing cells at the middles of their edges leaves the grading
    near(&lengths(&mesh.halved(), 0), &[2.0, 2.0, 1.0, 1.0, 0.5, 0.5]);
    // a grading of nearly 1 is nearly none
    let nearly = [1.0 + 1e-12, 1.0];
    let mesh = Mesh::graded_rectangle([1.0; 2], [5, 2], nearly, Cells::Rectangles).unwrap();
    lengths(&mesh, 0).iter().for_each(|length| assert!((length - 0.25).abs() < 1e-12));
}

/// Mid nodes are in the middles of edges, as those of cells with straight sides have to be.
#[test]
fn mid_nodes_stay_in_the_middle() {
    let flat = |cells| Mesh::graded_rectangle([2.0, 1.0], [4, 3], [10.0, 0.2], cells);
    let solid = |cells| Mesh::graded_cuboid([2.0, 1.0, 1.5], [3, 4, 3], [9.0, 0.1, 3.0], cells);
    for mesh in [
        flat(Cells::Triangles6),
        flat(Cells::Rectangles9),
        solid(SolidCells::Tetrahedra10),
        solid(SolidCells::Hexahedra20),
        solid(SolidCells::Hexahedra27),
    ] {
        let mesh = mesh.unwrap();
        for cell in mesh.cells() {
            for (corners, middle) in middles(mesh.kind()) {
                for axis in 0..mesh.dimension() {
                    let sum: f64 = corners.iter().map(|&k| mesh.position(cell[k])[axis]).sum();
                    let off = sum / corners.len() as f64 - mesh.position(cell[middle])[axis];
                    assert!(off.abs() < 1e-15, "{:?}: {off:e}", mesh.kind());
                }
            }
        }
    }
}

#[test]
fn bad_gradings_are_named() {
    let says = |mesh: Result<Mesh, InputError>, parts: &[&str]| {
        let message = mesh.unwrap_err().to_string();
        parts.iter().for_each(|part| assert!(message.contains(part), "{part}: {message}"));
    };
    let flat =
        |nodes, grading| Mesh::graded_rectangle([1.0, 1.0], nodes, grading, Cells::Triangles);
    says(flat([3, 3], [1.0, 0.0]), &["rectangle.grading[1] = 0 ", "above 0"]);
    says(flat([3, 3], [f64::NAN, 1.0]), &["rectangle.grading[0] = NaN "]);
    says(flat([3, 3], [1e5, 1.0]), &["rectangle.grading[0] = 100000 ", "10000"]);
    says(flat([3, 3], [1e-5, 1.0]), &["rectangle.grading[0] = 0.00001 ", "10000"]);
    says(flat([3, 2], [1.0, 2.0]), &["rectangle.grading[1] = 2 ", "more nodes"]);
    let solid = Mesh::graded_cuboid([1.0; 3], [3; 3], [1.0, 1.0, -1.0], SolidCells::Tetrahedra);
    says(solid, &["cuboid.grading[2] = -1 "]);
}
