//! The constant matrices of a body, against printed ones, closed forms and invariants.

use faer::Side;
use pliant::{Body, Cells, Material, Mesh, Plane, Strain};

/// Slides, "Example (inertia matrix)": isosceles right triangles of legs 1, thickness 2. With
/// this density rho h Delta / 12 = 1, as printed.
fn six_nodes() -> Body {
    let mesh = Mesh::rectangle([2.0, 1.0], [3, 2], Cells::Triangles).unwrap();
    let material = Material { density: 12.0, young: 1.0, poisson: 0.3, viscosity: 0.0 };
    Body::new(mesh, material).strain(Strain::Cauchy).thickness(2.0).build().unwrap()
}

/// An irregular square: the inner nodes of a 4 x 4 grid pushed about.
fn irregular_square() -> Mesh {
    let grid = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles).unwrap();
    let mut positions = grid.positions().to_vec();
    let shifts = [(5, 0.21, -0.13), (6, -0.17, 0.24), (9, 0.11, 0.19), (10, -0.23, -0.08)];
    for (node, dx, dy) in shifts {
        positions[2 * node] += dx;
        positions[2 * node + 1] += dy;
    }
    let connectivity = grid.cells().flatten().copied().collect();
    Mesh::new(2, positions, grid.kind(), connectivity).unwrap()
}

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };

#[test]
fn inertia_matrix_as_printed() {
    let body = six_nodes();
    #[rustfmt::skip]
    let printed = [
        [2.0, 1.0, 0.0, 1.0, 0.0, 0.0],
        [1.0, 6.0, 1.0, 2.0, 2.0, 0.0],
        [0.0, 1.0, 4.0, 0.0, 2.0, 1.0],
        [1.0, 2.0, 0.0, 4.0, 1.0, 0.0],
        [0.0, 2.0, 2.0, 1.0, 6.0, 1.0],
        [0.0, 0.0, 1.0, 0.0, 1.0, 2.0],
    ];
    for (i, row) in printed.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            // sums of products of thirds and halves: round-off only
            assert!((body.inertia().get(i, j) - value).abs() < 1e-14, "({i}, {j})");
        }
    }
}

#[test]
fn connection_matrices_as_printed() {
    #[rustfmt::skip]
    let lambda = [
        [ 1,  1, -1,  0,  0,  0,  0, -1,  0,  0,  0,  0],
        [ 1,  1, -1,  0,  0,  0,  0, -1,  0,  0,  0,  0],
        [-1, -1,  2,  1, -1,  0,  0,  1,  0, -1,  0,  0],
        [ 0,  0,  1,  2, -1,  0,  1,  0, -1, -2,  0,  0],
        [ 0,  0, -1, -1,  1,  0,  0,  0,  0,  1,  0,  0],
        [ 0,  0,  0,  0,  0,  1,  0,  0,  1,  0, -1, -1],
        [ 0,  0,  0,  1,  0,  0,  1,  0, -1, -1,  0,  0],
        [-1, -1,  1,  0,  0,  0,  0,  1,  0,  0,  0,  0],
        [ 0,  0,  0, -1,  0,  1, -1,  0,  2,  1, -1, -1],
        [ 0,  0, -1, -2,  1,  0, -1,  0,  1,  2,  0,  0],
        [ 0,  0,  0,  0,  0, -1,  0,  0, -1,  0,  1,  1],
        [ 0,  0,  0,  0,  0, -1,  0,  0, -1,  0,  1,  1],
    ];
    #[rustfmt::skip]
    let mu = [
        [ 3,  1, -2, -1,  0,  0, -1,  0,  0,  0,  0,  0],
        [ 1,  3,  0, -1,  0,  0, -1, -2,  0,  0,  0,  0],
        [-2,  0,  6,  1, -2, -1,  0,  1, -2, -1,  0,  0],
        [-1, -1,  1,  6,  0, -1,  1,  0, -1, -4,  0,  0],
        [ 0,  0, -2,  0,  3,  0,  0,  0,  0,  1, -1, -1],
        [ 0,  0, -1, -1,  0,  3,  0,  0,  1,  0,  0, -2],
        [-1, -1,  0,  1,  0,  0,  3,  0, -2,  0,  0,  0],
        [ 0, -2,  1,  0,  0,  0,  0,  3, -1, -1,  0,  0],
        [ 0,  0, -2, -1,  0,  1, -2, -1,  6,  1, -2,  0],
        [ 0,  0, -1, -4,  1,  0,  0, -1,  1,  6, -1, -1],
        [ 0,  0,  0,  0, -1,  0,  0,  0, -2, -1,  3,  1],
        [ 0,  0,  0,  0, -1, -2,  0,  0,  0, -1,  1,  3],
    ];
    let [j_lambda, j_mu] = six_nodes().connection_matrices();
    for i in 0..12 {
        for j in 0..12 {
            // halves and ones only: exact in floating point
            assert_eq!(j_lambda.get(i, j), f64::from(lambda[i][j]), "J_lambda ({i}, {j})");
            assert_eq!(j_mu.get(i, j), f64::from(mu[i][j]), "J_mu ({i}, {j})");
        }
    }
}

#[test]
fn bar_matrices_as_printed() {
    // spec: K = (E A / h) tridiag(-1; 1, 2, ..., 2, 1; -1), M = (rho A h / 6) tridiag(1; 2, 4, ..., 2; 1)
    let material = Material { density: 6.0, young: 5.0, poisson: 0.3, viscosity: 2.0 };
    let body = Body::new(Mesh::bar(4.0, 5).unwrap(), material)
        .strain(Strain::Cauchy)
        .area(3.0)
        .build()
        .unwrap();
    for i in 0..5_usize {
        for j in 0..5 {
            let end = i == 0 || i == 4;
            let (k, m) = match i.abs_diff(j) {
                0 => (if end { 1.0 } else { 2.0 }, if end { 2.0 } else { 4.0 }),
                1 => (-1.0, 1.0),
                _ => (0.0, 0.0),
            };
            assert!((body.stiffness().get(i, j) - 15.0 * k).abs() < 1e-13, "K ({i}, {j})");
            assert!((body.damping().get(i, j) - 6.0 * k).abs() < 1e-13, "B ({i}, {j})");
            assert!((body.inertia().get(i, j) - 3.0 * m).abs() < 1e-13, "M ({i}, {j})");
        }
    }
}

#[test]
fn total_mass_and_centre() {
    let body = Body::new(irregular_square(), RUBBER)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .build()
        .unwrap();
    assert!((body.mass() - 1000.0 * 9.0 * 0.01).abs() < 2e-12);
}

/// K times the displacement that `field` gives at each position.
fn forces(body: &Body, field: impl Fn(&[f64]) -> [f64; 2]) -> Vec<f64> {
    let u: Vec<f64> = body.mesh().positions().chunks(2).flat_map(field).collect();
    let k = body.stiffness().to_dense();
    (0..u.len()).map(|i| (0..u.len()).map(|j| k[(i, j)] * u[j]).sum()).collect()
}

#[test]
fn rigid_modes_cost_nothing_and_there_are_three_of_them() {
    let body = Body::new(irregular_square(), RUBBER)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .build()
        .unwrap();
    let scale = body.stiffness().get(0, 0);
    for mode in [|_: &[f64]| [1.0, 0.0], |_: &[f64]| [0.0, 1.0], |x: &[f64]| [-x[1], x[0]]] {
        let largest = forces(&body, mode).iter().fold(0.0_f64, |worst, f| worst.max(f.abs()));
        assert!(largest < 1e-13 * scale, "{largest:e}");
    }
    // no other mode is free: hour-glassing, loose nodes
    let eigenvalues = body.stiffness().to_dense().self_adjoint_eigenvalues(Side::Lower).unwrap();
    let free = eigenvalues.iter().filter(|x| x.abs() < 1e-9 * scale).count();
    assert_eq!(free, 3);
}

/// A linear displacement field is an exact solution: it leaves the inner nodes of any mesh in
/// equilibrium and costs the energy of its strain.
#[test]
fn patch_test() {
    let body = Body::new(irregular_square(), RUBBER)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .build()
        .unwrap();
    let field = |x: &[f64]| [0.02 * x[0] + 0.03 * x[1], -0.01 * x[0] + 0.05 * x[1]];
    let forces = forces(&body, field);
    for node in [5, 6, 9, 10] {
        for f in &forces[2 * node..2 * node + 2] {
            assert!(f.abs() < 1e-11 * body.stiffness().get(0, 0), "node {node}: {f:e}");
        }
    }
    let energy: f64 = body
        .mesh()
        .positions()
        .chunks(2)
        .flat_map(field)
        .zip(&forces)
        .map(|(u, f)| 0.5 * u * f)
        .sum();
    let (xx, yy, twice_xy) = (0.02, 0.05, 0.03 - 0.01);
    let lame = RUBBER.elastic();
    let density = 0.5 * lame.lambda * (xx + yy) * (xx + yy)
        + lame.mu * (xx * xx + yy * yy + 0.5 * twice_xy * twice_xy);
    let exact = density * 9.0 * 0.01;
    assert!((energy / exact - 1.0).abs() < 1e-13, "{energy} {exact}");
}

/// Under uniaxial stress a plane-stress body stretches with Young's modulus: stress E e along x,
/// none across.
#[test]
fn plane_stress_stretches_with_youngs_modulus() {
    let body = Body::new(irregular_square(), RUBBER)
        .strain(Strain::Cauchy)
        .thickness(0.01)
        .plane(Plane::Stress);
    let body = body.build().unwrap();
    let forces = forces(&body, |x| [0.01 * x[0], -0.48 * 0.01 * x[1]]);
    let total: f64 = body.mesh().sets()["all"]
        .iter()
        .filter(|&&node| body.mesh().position(node)[0] == 3.0)
        .map(|node| forces[2 * node])
        .sum();
    let exact = 1e6 * 0.01 * (3.0 * 0.01);
    assert!((total / exact - 1.0).abs() < 1e-12, "{total} {exact}");
    let across = forces.iter().skip(1).step_by(2).fold(0.0_f64, |worst, f| worst.max(f.abs()));
    assert!(across < 1e-13 * exact);
}

/// Slides, "Example (static simulation)": 4 x 4 nodes, bottom fixed, nodes 14 and 15 pressed down
/// by 0.3 (unit cells, E = 1e6, thickness 1). Displacements and constraint forces were computed
/// independently; trusted to 12 digits.
#[test]
fn static_square_is_in_equilibrium() {
    #[rustfmt::skip]
    let u = [
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
        -0.10898434108450147, -0.015540996841346223, -0.07134640040085799, -0.03920332073808863,
        0.000607108153257671, -0.06640042531084175, 0.1421223163363305, -0.13457823155375725,
        -0.16551704332716716, -0.059086102373863476, -0.089829581327084, -0.1311567604264059,
        0.06715127132770206, -0.2401393583861693, 0.11526328480515981, -0.18015694233983356,
        -0.1535438568533657, -0.1319595617924208, 0.0, -0.3,
        0.0, -0.3, -8.807255490403375e-05, -0.18024501489473752,
    ];
    #[rustfmt::skip]
    let multipliers = [
        (0, 81413.55832378718), (1, 86663.8950945124), (2, 124028.86794261461),
        (3, 185409.48670431576), (4, 114647.53344802432), (5, 279389.25714710884),
        (6, -281681.5401273009), (7, 17445.292594121813), (26, 216080.07662838307),
        (27, -226066.72553784316), (28, -254488.4962155085), (29, -342841.2060022152),
    ];
    let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles).unwrap();
    let material = Material { density: 1.0, young: 1e6, poisson: 0.48, viscosity: 0.0 };
    let body = Body::new(mesh, material).strain(Strain::Cauchy).thickness(1.0).build().unwrap();
    let mut expected = vec![0.0; 32];
    multipliers.iter().for_each(|&(dof, force)| expected[dof] = force);
    let k = body.stiffness().to_dense();
    for i in 0..32 {
        let force: f64 = (0..32).map(|j| k[(i, j)] * u[j]).sum();
        // 12 digits of forces of size 1e5
        assert!((force - expected[i]).abs() < 1e-7, "dof {i}: {force} {}", expected[i]);
    }
}
