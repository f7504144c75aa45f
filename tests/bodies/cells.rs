//! The constant matrices of a body, by the same checks for every cell that fills its space.

use faer::Side;
use pliant::mesh::CellKind;
use pliant::{Body, Cells, Material, Mesh, SolidCells, Strain};

use super::meshes::middles;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// Sides of the bodies (m).
const SIZE: [f64; 3] = [3.0, 2.0, 1.5];
const THICKNESS: f64 = 0.01;

fn rectangle(cells: Cells) -> Mesh {
    Mesh::rectangle([SIZE[0], SIZE[1]], [4, 4], cells).unwrap()
}

fn cuboid(cells: SolidCells) -> Mesh {
    Mesh::cuboid(SIZE, [4, 3, 3], cells).unwrap()
}

/// Grids of every kind of cell.
fn grids() -> Vec<Mesh> {
    vec![
        rectangle(Cells::Triangles),
        rectangle(Cells::Crossed),
        rectangle(Cells::Rectangles),
        rectangle(Cells::Triangles6),
        rectangle(Cells::Rectangles9),
        cuboid(SolidCells::Hexahedra),
        cuboid(SolidCells::Tetrahedra),
        cuboid(SolidCells::Tetrahedra10),
        cuboid(SolidCells::Hexahedra20),
        cuboid(SolidCells::Hexahedra27),
    ]
}

/// The mesh with its inner nodes pushed about; mid nodes go back to the middle of their edge, face or cell
/// if `straight`.
fn irregular(mesh: Mesh, straight: bool) -> Mesh {
    let dimension = mesh.dimension();
    let inner: Vec<usize> =
        (0..mesh.node_count()).filter(|node| !mesh.boundary_nodes().contains(node)).collect();
    assert!(!inner.is_empty());
    let mut positions = mesh.positions().to_vec();
    for &node in &inner {
        for axis in 0..dimension {
            let way = (1.7 * node as f64 + 2.9 * axis as f64 + 0.4).sin();
            positions[dimension * node + axis] += 0.09 * way;
        }
    }
    if straight {
        for cell in mesh.cells() {
            for (corners, middle) in middles(mesh.kind()) {
                for axis in 0..dimension {
                    let at = |local: usize| dimension * cell[local] + axis;
                    let sum: f64 = corners.iter().map(|&corner| positions[at(corner)]).sum();
                    positions[at(middle)] = sum / corners.len() as f64;
                }
            }
        }
    }
    let mut next = positions.iter().copied();
    let mut moved = || next.next().unwrap();
    match dimension {
        2 => mesh.mapped(|_| [moved(), moved()]),
        _ => mesh.mapped(|_| [moved(), moved(), moved()]),
    }
    .unwrap()
}

fn body(mesh: Mesh) -> Body {
    let flat = mesh.dimension() == 2;
    let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy);
    if flat { body.thickness(THICKNESS) } else { body }.build().unwrap()
}

/// Length across what is not meshed, area or volume of a body (m^3 over all).
fn volume(dimension: usize) -> f64 {
    SIZE[0] * SIZE[1] * depth(dimension)
}

fn depth(dimension: usize) -> f64 {
    if dimension == 2 { THICKNESS } else { SIZE[2] }
}

/// K times the displacement that `field` gives at each position, and half its product with it.
fn elastic(body: &Body, field: impl Fn(&[f64]) -> [f64; 3]) -> (Vec<f64>, f64) {
    let dimension = body.dimension();
    let positions = body.mesh().positions().chunks(dimension);
    let u: Vec<f64> = positions.flat_map(|x| field(x).into_iter().take(dimension)).collect();
    let k = body.stiffness().to_dense();
    let forces: Vec<f64> =
        (0..u.len()).map(|i| (0..u.len()).map(|j| k[(i, j)] * u[j]).sum()).collect();
    let energy = u.iter().zip(&forces).map(|(u, f)| 0.5 * u * f).sum();
    (forces, energy)
}

/// sum m_ab p_a q_b for two functions of position (kg times their units).
fn inertia(body: &Body, p: impl Fn(&[f64]) -> f64, q: impl Fn(&[f64]) -> f64) -> f64 {
    let mesh = body.mesh();
    let values = |f: &dyn Fn(&[f64]) -> f64| -> Vec<f64> {
        (0..mesh.node_count()).map(|node| f(mesh.position(node))).collect()
    };
    let (p, q) = (values(&p), values(&q));
    let row = |a: usize| -> f64 { (0..q.len()).map(|b| body.inertia().get(a, b) * q[b]).sum() };
    (0..p.len()).map(|a| p[a] * row(a)).sum()
}

fn close(value: f64, exact: f64, kind: CellKind) {
    assert!((value / exact - 1.0).abs() < 1e-12, "{kind:?}: {value} instead of {exact}");
}

#[test]
fn inertia_integrates_products_of_what_cells_can_follow() {
    let [a, b, _] = SIZE;
    for mesh in grids() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let body = body(irregular(mesh, true));
        let density = RUBBER.density * depth(dimension);
        close(body.mass(), RUBBER.density * volume(dimension), kind);
        close(inertia(&body, |x| x[0], |x| x[0]), density * a.powi(3) * b / 3.0, kind);
        close(inertia(&body, |x| x[0], |x| x[1]), density * a * a * b * b / 4.0, kind);
        if matches!(kind, CellKind::Triangle6 | CellKind::Tetrahedron10) {
            let fourth = inertia(&body, |x| x[0] * x[0], |x| x[1] * x[1]);
            close(fourth, density * a.powi(3) * b.powi(3) / 9.0, kind);
        }
    }
}

#[test]
fn rigid_modes_cost_nothing_and_no_others_are_free() {
    for mesh in grids() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let body = body(irregular(mesh, true));
        let scale = body.stiffness().get(0, 0);
        let turn = |i: usize, j: usize| {
            move |x: &[f64]| {
                let mut u = [0.0; 3];
                (u[i], u[j]) = (-x[j], x[i]);
                u
            }
        };
        let along = |i: usize| {
            move |_: &[f64]| {
                let mut u = [0.0; 3];
                u[i] = 1.0;
                u
            }
        };
        let mut forces: Vec<f64> = Vec::new();
        for i in 0..dimension {
            forces.extend(elastic(&body, along(i)).0);
            for j in i + 1..dimension {
                forces.extend(elastic(&body, turn(i, j)).0);
            }
        }
        let largest = forces.iter().fold(0.0_f64, |worst, f| worst.max(f.abs()));
        assert!(largest < 5e-13 * scale, "{kind:?}: {largest:e}");

        let k = body.stiffness().to_dense();
        let eigenvalues = k.self_adjoint_eigenvalues(Side::Lower).unwrap();
        let free = eigenvalues.iter().filter(|x| x.abs() < 1e-9 * scale).count();
        assert_eq!(free, if dimension == 2 { 3 } else { 6 }, "{kind:?}");
        assert!(eigenvalues.iter().all(|x| *x > -1e-9 * scale), "{kind:?}");
    }
}

/// Of single cells, rows and blocks of them no motions but the rigid ones are free. (Twenty-node hexahedra with Gauss's rule of two points
/// along each axis would have 6 more, alone or in a row; with one end clamped, one for each cell of the row is left. A block of
/// 2 x 2 x 2 has none.)
#[test]
fn no_cell_has_a_free_motion_of_its_own() {
    for cells in SolidCells::ALL {
        for nodes in [[2, 2, 2], [2, 2, 6], [3, 3, 3]] {
            let body = body(Mesh::cuboid(SIZE, nodes, cells).unwrap());
            let eigenvalues = body.stiffness().to_dense().self_adjoint_eigenvalues(Side::Lower);
            let eigenvalues = eigenvalues.unwrap();
            let scale = eigenvalues.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let free = eigenvalues.iter().filter(|x| x.abs() < 1e-9 * scale).count();
            println!("{cells:?} {nodes:?}: {free} free");
            assert_eq!(free, 6, "{cells:?} {nodes:?}");
        }
    }
}

/// A linear displacement field is an exact solution: it leaves the inner nodes of any mesh in
/// equilibrium and costs the energy of its strain.
fn patch_test(mesh: Mesh, volume: f64) {
    let kind = mesh.kind();
    let body = body(mesh);
    let dimension = body.dimension();
    let g = [[0.02, 0.03, -0.02], [-0.01, 0.05, 0.04], [0.03, 0.01, -0.04]];
    let slope = |i: usize, j: usize| if i < dimension && j < dimension { g[i][j] } else { 0.0 };
    let field = |x: &[f64]| {
        [0, 1, 2].map(|i| x.iter().enumerate().map(|(j, x)| slope(i, j) * x).sum::<f64>())
    };
    let (forces, energy) = elastic(&body, field);
    let scale = body.stiffness().get(0, 0);
    for node in 0..body.mesh().node_count() {
        if !body.mesh().boundary_nodes().contains(&node) {
            for f in &forces[dimension * node..][..dimension] {
                assert!(f.abs() < 1e-13 * scale, "{kind:?}, node {node}: {f:e}");
            }
        }
    }
    let strain = |i: usize, j: usize| (slope(i, j) + slope(j, i)) / 2.0;
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let trace: f64 = (0..3).map(|i| strain(i, i)).sum();
    let square: f64 = pairs().map(|(i, j)| strain(i, j).powi(2)).sum();
    let lame = RUBBER.elastic();
    close(energy, (0.5 * lame.lambda * trace * trace + lame.mu * square) * volume, kind);
}

#[test]
fn patch_test_on_irregular_meshes() {
    for mesh in grids() {
        let volume = volume(mesh.dimension());
        patch_test(irregular(mesh, true), volume);
    }
}

#[test]
fn curved_cells_pass_the_patch_test() {
    // each of 16 pieces of a rim is a parabola over the chord of 45 degrees: area by Simpson's rule
    let (chord, rise) =
        (2.0 * (45f64 / 2.0).to_radians().sin(), 1.0 - (45f64 / 2.0).to_radians().cos());
    let unit_disc = 8.0 * (0.5 * 45f64.to_radians().sin() + 2.0 / 3.0 * chord * rise);
    for cells in [Cells::Triangles6, Cells::Rectangles9] {
        patch_test(irregular(rectangle(cells), false), volume(2));
        let ring = Mesh::ring(1.0, 2.0, [8, 3], cells).unwrap();
        patch_test(ring, unit_disc * (4.0 - 1.0) * THICKNESS);
    }
    patch_test(irregular(cuboid(SolidCells::Hexahedra27), false), volume(3));
}

/// The displacement (x y, 0, 0), which quadratic triangles and tetrahedra and biquadratic cells follow on any
/// straight-sided mesh, others on a grid.
#[test]
fn stiffness_rules_integrate_a_bilinear_field() {
    let [a, b, _] = SIZE;
    for mesh in grids() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let mesh = match kind {
            CellKind::Triangle | CellKind::Tetrahedron => continue,
            CellKind::Triangle6
            | CellKind::Tetrahedron10
            | CellKind::Quadrilateral9
            | CellKind::Hexahedron27 => irregular(mesh, true),
            _ => mesh,
        };
        let (_, energy) = elastic(&body(mesh), |x| [x[0] * x[1], 0.0, 0.0]);
        let lame = RUBBER.elastic();
        // strain y along x, shear x between x and y
        let stretch = (0.5 * lame.lambda + lame.mu) * a * b.powi(3) / 3.0;
        let shear = 0.5 * lame.mu * a.powi(3) * b / 3.0;
        close(energy, (stretch + shear) * depth(dimension), kind);
    }
}

/// Spec: M = (rho V/20) (2 on the diagonal, 1 elsewhere) for a tetrahedron; the rectangle and the
/// quadratic triangle likewise in closed form.
#[test]
fn inertia_in_closed_form() {
    let check = |mesh: Mesh, size: f64, table: &[&[i32]]| {
        let kind = mesh.kind();
        let body = body(mesh);
        let cell: Vec<usize> = body.mesh().cells().next().unwrap().to_vec();
        for (i, row) in table.iter().enumerate() {
            for (j, &entry) in row.iter().enumerate() {
                let value = body.inertia().get(cell[i], cell[j]);
                let exact = RUBBER.density * size * f64::from(entry);
                assert!((value - exact).abs() < 1e-13 * body.mass(), "{kind:?} ({i}, {j})");
            }
        }
    };
    let corners = [0.0, 0.0, 0.0, 1.0, 0.1, 0.0, 0.2, 1.3, 0.1, 0.3, 0.2, 0.9];
    let mesh = Mesh::new(3, corners.into(), CellKind::Tetrahedron, vec![0, 1, 2, 3]).unwrap();
    // determinant of the edges (1, 0.1, 0), (0.2, 1.3, 0.1), (0.3, 0.2, 0.9)
    let volume: f64 = (1.0 * (1.3 * 0.9 - 0.1 * 0.2) - 0.1 * (0.2 * 0.9 - 0.1 * 0.3)) / 6.0;
    let row = [[2, 1, 1, 1], [1, 2, 1, 1], [1, 1, 2, 1], [1, 1, 1, 2]];
    check(mesh, volume / 20.0, &row.each_ref().map(|row| &row[..]));

    let mesh = Mesh::rectangle([3.0, 2.0], [2, 2], Cells::Rectangles).unwrap();
    let row = [[4, 2, 1, 2], [2, 4, 2, 1], [1, 2, 4, 2], [2, 1, 2, 4]];
    check(mesh, 6.0 * THICKNESS / 36.0, &row.each_ref().map(|row| &row[..]));

    let corners = [0.0, 0.0, 2.0, 0.2, 0.4, 1.0, 1.0, 0.1, 1.2, 0.6, 0.2, 0.5];
    let mesh = Mesh::new(2, corners.into(), CellKind::Triangle6, (0..6).collect()).unwrap();
    let row = [
        [6, -1, -1, 0, -4, 0],
        [-1, 6, -1, 0, 0, -4],
        [-1, -1, 6, -4, 0, 0],
        [0, 0, -4, 32, 16, 16],
        [-4, 0, 0, 16, 32, 16],
        [0, -4, 0, 16, 16, 32],
    ];
    check(mesh, 0.96 * THICKNESS / 180.0, &row.each_ref().map(|row| &row[..]));

    // products of those of a line: its ends, then its middle
    let mesh = Mesh::rectangle([3.0, 2.0], [2, 2], Cells::Rectangles9).unwrap();
    let line = [[4, -1, 2], [-1, 4, 2], [2, 2, 16]];
    let places = [[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [1, 2], [2, 1], [0, 2], [2, 2]];
    let row = places.map(|[i, j]| places.map(|[k, l]| line[i][k] * line[j][l]));
    check(mesh, 6.0 * THICKNESS / 900.0, &row.each_ref().map(|row| &row[..]));
}

#[test]
fn cells_that_are_turned_over_are_named() {
    for mesh in grids() {
        let (kind, dimension) = (mesh.kind(), mesh.dimension());
        let turned = match dimension {
            2 => mesh.mapped(|x| [x[1], x[0]]),
            _ => mesh.mapped(|x| [x[1], x[0], x[2]]),
        };
        let turned = turned.unwrap();
        let all = turned.cell_count();
        let builder = Body::new(turned, RUBBER).strain(Strain::Cauchy);
        let builder = if dimension == 2 { builder.thickness(THICKNESS) } else { builder };
        let message = builder.build().unwrap_err().to_string();
        let told = format!("= {all} of {all} cannot be used: {all} run the wrong way round");
        assert!(message.contains(&told), "{kind:?}: {message}");
        assert!(message.contains("such as cell 1 (nodes ["), "{kind:?}: {message}");
    }
}

/// Cells with a quadrature point that is inside out are told as what they are, with how many there are of each.
#[test]
fn cells_of_no_good_shape_are_told_as_what_they_are() {
    let says = |positions: &[[f64; 2]], kind, cells: &[usize], parts: &[&str]| {
        let mesh = Mesh::new(2, positions.concat(), kind, cells.to_vec()).unwrap();
        let body = Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(THICKNESS);
        let message = body.build().unwrap_err().to_string();
        for part in parts {
            assert!(message.contains(part), "\"{part}\" is missing from: {message}");
        }
    };
    let quadrilaterals = CellKind::Quadrilateral;
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    says(
        &square,
        quadrilaterals,
        &[0, 2, 1, 3],
        &["1 of 1 cannot be used: 1 are bow-ties", "cell 1 (nodes [1, 3, 2, 4]"],
    );
    let dart = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
    says(
        &dart,
        quadrilaterals,
        &[0, 1, 2, 3],
        &["1 of 1 cannot be used: 1 are concave", "two triangles"],
    );
    says(&square, CellKind::Triangle, &[0, 2, 1], &["1 run the wrong way round"]);
    let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
    says(&line, CellKind::Triangle, &[0, 1, 2], &["1 are flat"]);
    // a good square, a bow-tie, and two that are concave
    let mut positions = Vec::new();
    for (place, shape) in [square, square, dart, dart].iter().enumerate() {
        positions.extend(shape.map(|[x, y]| [x + 2.0 * place as f64, y]));
    }
    let cells: Vec<usize> = (0..4).chain([4, 6, 5, 7]).chain(8..16).collect();
    says(
        &positions,
        quadrilaterals,
        &cells,
        &[
            "3 of 4 cannot be used: 1 are bow-ties",
            "such as cell 2",
            "2 are concave",
            "such as cell 3",
        ],
    );
    // the middle of the long side is beyond the opposite corner
    let bulged = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.8], [0.5, 0.5], [0.0, 0.5]];
    says(&bulged, CellKind::Triangle6, &[0, 1, 2, 3, 4, 5], &["1 have sides so curved", "refine"]);
}

/// A hexahedron one end of which is turned over has corners of both orientations.
#[test]
fn twisted_hexahedra_are_told() {
    let brick = Mesh::cuboid([1.0; 3], [2; 3], SolidCells::Hexahedra).unwrap();
    let mut cell = brick.cells().next().unwrap().to_vec();
    cell[4..].reverse();
    let twisted = Mesh::new(3, brick.positions().to_vec(), brick.kind(), cell).unwrap();
    let message = Body::new(twisted, RUBBER).strain(Strain::Cauchy).build().unwrap_err();
    assert!(message.to_string().contains("1 of 1 cannot be used: 1 are twisted"), "{message}");
}

#[test]
fn solids_have_no_section() {
    let message = |body: pliant::body::BodyBuilder| body.build().unwrap_err().to_string();
    let solid = || Body::new(cuboid(SolidCells::Hexahedra), RUBBER).strain(Strain::Cauchy);
    assert!(message(solid().thickness(0.1)).contains("Hexahedron cells has no thickness"));
    assert!(message(solid().area(0.1)).contains("Hexahedron cells has no area"));
}
