//! Bodies that keep their volume: patches, pressures, stability, conditions, closed forms, Cook's membrane, a punch.

mod closed_forms;
mod condition;
mod cook;
mod patches;
mod pressures;
mod punch;

use faer::prelude::Solve;
use faer::{Mat, Side};
use pliant::{Body, Cells, Dilatation, Mesh, SolidCells, Substance};

/// How cells are made: in the plane, or in space; `Triangles7` and `Tetrahedra15` are those with bubbles.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Plane(Cells),
    Solid(SolidCells),
    Triangles7,
    Tetrahedra15,
}

impl Kind {
    const ALL: [Self; 12] = [
        Self::Plane(Cells::Triangles),
        Self::Plane(Cells::Crossed),
        Self::Plane(Cells::Rectangles),
        Self::Plane(Cells::Triangles6),
        Self::Plane(Cells::Rectangles9),
        Self::Solid(SolidCells::Tetrahedra),
        Self::Solid(SolidCells::Hexahedra),
        Self::Solid(SolidCells::Tetrahedra10),
        Self::Solid(SolidCells::Hexahedra20),
        Self::Solid(SolidCells::Hexahedra27),
        Self::Triangles7,
        Self::Tetrahedra15,
    ];

    /// A unit square or cube with so many cells along its sides.
    fn mesh(self, cells: usize) -> Mesh {
        match self {
            Self::Plane(kind) => Mesh::rectangle([1.0; 2], [cells + 1; 2], kind),
            Self::Solid(kind) => Mesh::cuboid([1.0; 3], [cells + 1; 3], kind),
            Self::Triangles7 => Self::Plane(Cells::Triangles6).mesh(cells).with_bubbles(),
            Self::Tetrahedra15 => Self::Solid(SolidCells::Tetrahedra10).mesh(cells).with_bubbles(),
        }
        .unwrap()
    }

    /// The same with corners within moved by up to a fifth of a cell, edges straight. A node in the middle of a face or
    /// of a cell moves as the mean of the corners around it.
    fn distorted(self, cells: usize) -> Mesh {
        let straight = match self {
            Self::Triangles7 => Some(Self::Plane(Cells::Triangles6)),
            Self::Tetrahedra15 => Some(Self::Solid(SolidCells::Tetrahedra10)),
            _ => None,
        };
        if let Some(straight) = straight {
            return straight.distorted(cells).with_bubbles().unwrap();
        }
        let noise = |x: &[f64], i: usize| {
            let mixed: f64 = x.iter().enumerate().map(|(k, x)| (k * k + 3) as f64 * 37.7 * x).sum();
            let random = 2.0 * (43758.5453 * (mixed + 2.0 * i as f64).sin()).rem_euclid(1.0) - 1.0;
            let is_within = x.iter().all(|&x| x > 1e-9 && x < 1.0 - 1e-9);
            if is_within { 0.2 / cells as f64 * random } else { 0.0 }
        };
        // over the corners around a node, of which each coordinate is on a line of corners or halfway between two
        let mean = |x: &[f64], i: usize| {
            let place = |k: usize, axis: usize| {
                let line = (2.0 * cells as f64 * x[axis]).round() / 2.0;
                let line = if k >> axis & 1 == 0 { line.floor() } else { line.ceil() };
                line / cells as f64
            };
            let corner = |k: usize| (0..x.len()).map(|axis| place(k, axis)).collect::<Vec<_>>();
            let count = 1 << x.len();
            (0..count).map(|k| noise(&corner(k), i)).sum::<f64>() / count as f64
        };
        let (corners, is_quadratic) = match self {
            Self::Plane(Cells::Triangles6) => (Self::Plane(Cells::Triangles), true),
            Self::Solid(SolidCells::Tetrahedra10) => (Self::Solid(SolidCells::Tetrahedra), true),
            Self::Solid(SolidCells::Hexahedra20) => (Self::Solid(SolidCells::Hexahedra), true),
            other => (other, false),
        };
        let mesh = corners.mesh(cells);
        let mesh = match mesh.dimension() {
            2 => mesh.mapped(|x| [0, 1].map(|i| x[i] + mean(x, i))),
            _ => mesh.mapped(|x| [0, 1, 2].map(|i| x[i] + mean(x, i))),
        };
        let mesh = mesh.unwrap();
        if is_quadratic { mesh.quadratic().unwrap() } else { mesh }
    }

    fn is_plane(self) -> bool {
        matches!(self, Self::Plane(_) | Self::Triangles7)
    }

    /// The dilatations that its cells can have.
    fn dilatations(self) -> &'static [Dilatation] {
        let all = &[Dilatation::AtPoints, Dilatation::Mean, Dilatation::Linear];
        match self {
            Self::Plane(Cells::Triangles | Cells::Crossed)
            | Self::Solid(SolidCells::Tetrahedra) => &all[..1],
            Self::Triangles7
            | Self::Tetrahedra15
            | Self::Plane(Cells::Rectangles9)
            | Self::Solid(SolidCells::Hexahedra20 | SolidCells::Hexahedra27) => all,
            _ => &all[..2],
        }
    }
}

fn body(
    mesh: Mesh,
    substance: impl Into<Substance>,
    dilatation: Dilatation,
) -> pliant::body::BodyBuilder {
    let is_plane = mesh.dimension() == 2;
    let body = Body::new(mesh, substance).dilatation(dilatation);
    if is_plane { body.thickness(1.0) } else { body }
}

/// Degrees of freedom of nodes within a unit square or cube.
fn within(body: &Body) -> Vec<usize> {
    let is_within = |x: &f64| *x > 1e-9 && *x < 1.0 - 1e-9;
    let d = body.dimension();
    let positions = body.mesh().positions().chunks(d);
    let nodes = positions.enumerate().filter(|(_, x)| x.iter().all(is_within));
    nodes.flat_map(|(node, _)| (0..d).map(move |axis| d * node + axis)).collect()
}

/// Eigenvalues of A x = eigenvalue B x, ascending; B is positive definite.
fn eigenvalues(a: &Mat<f64>, b: &Mat<f64>) -> Vec<f64> {
    let l = b.llt(Side::Lower).unwrap();
    let half = l.L().to_owned().partial_piv_lu().solve(a);
    let whole = l.L().to_owned().partial_piv_lu().solve(half.transpose());
    let n = a.nrows();
    let symmetric = Mat::from_fn(n, n, |i, j| 0.5 * (whole[(i, j)] + whole[(j, i)]));
    symmetric.self_adjoint_eigenvalues(Side::Lower).unwrap()
}
