//! Assembly of the constant matrices: one loop over the quadrature points of all cells.

use std::sync::Arc;

use crate::element::{
    Hexahedron, Quadrilateral, ReferenceCell, Segment, Tetrahedron, Tetrahedron10, Triangle,
    Triangle6, mass_points, stiffness_points,
};
use crate::error::Error;
use crate::material::Lame;
use crate::mesh::{CellKind, Mesh};
use crate::sparse::{BlockMatrix, NodeMatrix, NodePattern};

/// The numbers that a material contributes.
#[derive(Clone, Copy)]
pub(super) struct Moduli {
    pub density: f64,
    pub elastic: Lame,
    pub viscous: Lame,
}

/// Inertia, stiffness and damping of a mesh; `section` is the thickness or area of the body.
pub(super) fn assemble(
    mesh: &Mesh,
    section: f64,
    moduli: Moduli,
    pattern: &Arc<NodePattern>,
) -> Result<(NodeMatrix, [BlockMatrix; 2]), Error> {
    if mesh.dimension() != mesh.kind().dimension() {
        let mend = "bodies of lower dimension than space cannot be assembled yet";
        return Err(Error::input("mesh.dimension", mesh.dimension(), mend));
    }
    match mesh.kind() {
        CellKind::Segment => assemble_cells::<Segment, 2, 1>(mesh, section, moduli, pattern),
        CellKind::Triangle => assemble_cells::<Triangle, 3, 2>(mesh, section, moduli, pattern),
        CellKind::Triangle6 => assemble_cells::<Triangle6, 6, 2>(mesh, section, moduli, pattern),
        CellKind::Quadrilateral => {
            assemble_cells::<Quadrilateral, 4, 2>(mesh, section, moduli, pattern)
        }
        CellKind::Tetrahedron => {
            assemble_cells::<Tetrahedron, 4, 3>(mesh, section, moduli, pattern)
        }
        CellKind::Tetrahedron10 => {
            assemble_cells::<Tetrahedron10, 10, 3>(mesh, section, moduli, pattern)
        }
        CellKind::Hexahedron => assemble_cells::<Hexahedron, 8, 3>(mesh, section, moduli, pattern),
    }
}

fn assemble_cells<C: ReferenceCell<N, D>, const N: usize, const D: usize>(
    mesh: &Mesh,
    section: f64,
    moduli: Moduli,
    pattern: &Arc<NodePattern>,
) -> Result<(NodeMatrix, [BlockMatrix; 2]), Error> {
    let mut inertia = NodeMatrix::zeros(pattern);
    let mut stiffness = BlockMatrix::zeros(pattern, D);
    let mut damping = BlockMatrix::zeros(pattern, D);
    let positions = mesh.positions().as_chunks::<D>().0;

    for (number, cell) in mesh.cells().enumerate() {
        let nodes: [[f64; D]; N] = std::array::from_fn(|a| positions[cell[a]]);
        let points =
            stiffness_points::<C, N, D>(&nodes).map_err(|volume| bad_cell(number, cell, volume))?;
        for point in points {
            let weight = section * point.volume;
            for (a, ga) in point.gradients.iter().enumerate() {
                for (b, gb) in point.gradients.iter().enumerate() {
                    // J_lambda has the blocks g_a g_b^T, J_mu the blocks (g_a . g_b) I + g_b g_a^T
                    let (volumetric, shear) = (ga * gb.transpose(), gb * ga.transpose());
                    let stretch = ga.dot(gb);
                    for (matrix, lame) in
                        [(&mut stiffness, moduli.elastic), (&mut damping, moduli.viscous)]
                    {
                        let Some(block) = matrix.block_mut(cell[a], cell[b]) else { continue };
                        for i in 0..D {
                            block[i * D + i] += weight * lame.mu * stretch;
                            for j in 0..D {
                                block[i * D + j] += weight
                                    * (lame.lambda * volumetric[(i, j)] + lame.mu * shear[(i, j)]);
                            }
                        }
                    }
                }
            }
        }
        for point in mass_points::<C, N, D>(&nodes) {
            let weight = moduli.density * section * point.volume;
            for a in 0..N {
                for b in 0..N {
                    inertia.add(cell[a], cell[b], weight * point.values[a] * point.values[b]);
                }
            }
        }
    }
    Ok((inertia, [stiffness, damping]))
}

fn bad_cell(number: usize, cell: &[usize], volume: f64) -> Error {
    Error::Cell {
        cell: number + 1,
        nodes: cell.iter().map(|node| node + 1).collect(),
        volume,
        mend: if volume < 0.0 {
            "its nodes run clockwise: list them the other way round".into()
        } else {
            "it is flat: move its nodes apart or leave the cell out".into()
        },
    }
}
