//! The equations of a phase by themselves, against the matrices of the body and against
//! finite differences.

use pliant::samples::{ClampedBeam, SquareJump, square_jump};
use pliant::{Axis, Body, Cells, Inertia, InputError, Material, Mesh, Phase, Scene, Strain};

/// Displacements (m) that push the square into the floor, and velocities (m/s).
fn state(dofs: usize) -> [Vec<f64>; 2] {
    let wave = |k: usize, phase: f64| (0.7 * k as f64 + phase).sin();
    let u = (0..dofs).map(|k| 1e-3 * wave(k, 0.0) - if k % 2 == 1 { 2e-3 } else { 0.0 }).collect();
    [u, (0..dofs).map(|k| 0.1 * wave(k, 1.0)).collect()]
}

fn forces(scene: &Scene, phase: usize, u: &[f64], v: &[f64]) -> Vec<f64> {
    let mut equations = scene.equations(phase, &vec![0.0; u.len()]).unwrap();
    let mut f = vec![0.0; u.len()];
    equations.forces(0.0, u, v, &mut f).unwrap();
    f
}

#[test]
fn forces_are_those_of_the_matrices_and_the_floor() {
    let scene = square_jump(4).unwrap();
    let body = scene.body();
    let [u, v] = state(body.dofs());
    let f = forces(&scene, 2, &u, &v);
    let (k, b) = (body.stiffness().to_dense(), body.damping().to_dense());
    let scale = f.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for (i, f) in f.iter().enumerate() {
        let inner: f64 = (0..u.len()).map(|j| k[(i, j)] * u[j] + b[(i, j)] * v[j]).sum();
        // 400 N/m under 4 nodes
        let is_bottom = i < 8 && i % 2 == 1;
        let floor = if is_bottom { 100.0 * (-u[i]).max(0.0) } else { 0.0 };
        // round-off of sums of about 30 terms
        assert!((f + inner - floor).abs() < 1e-13 * scale, "component {i}");
    }
    // no floor before the release
    assert_eq!(forces(&scene, 0, &u, &v)[3], f[3] - 100.0 * -u[3]);
}

#[test]
fn tangents_are_the_derivatives_of_the_forces() {
    let scene = ClampedBeam { nodes: [6, 3], viscosity: 4000.0, ..ClampedBeam::default() };
    let scene = scene.scene().unwrap();
    let [u, v] = state(scene.body().dofs());
    let mut equations = scene.equations(0, &vec![0.0; u.len()]).unwrap();
    let [k, d] = equations.tangents(0.0, &u, &v).map(|matrix| matrix.to_dense());
    let largest = |matrix: &faer::Mat<f64>| {
        (0..u.len())
            .flat_map(|i| (0..u.len()).map(move |j| (i, j)))
            .fold(0.0_f64, |most, at| most.max(matrix[at].abs()))
    };
    for (tangent, by_u, h) in [(&k, true, 1e-7), (&d, false, 1e-3)] {
        let scale = largest(tangent);
        for j in 0..u.len() {
            let shifted = |by: f64| {
                let [mut u, mut v] = [u.clone(), v.clone()];
                if by_u {
                    u[j] += by
                } else {
                    v[j] += by
                }
                forces(&scene, 0, &u, &v)
            };
            let (ahead, behind) = (shifted(h), shifted(-h));
            for i in 0..u.len() {
                let slope = (behind[i] - ahead[i]) / (2.0 * h);
                // of central differences: h^2 times the third derivative, and round-off of forces over h
                assert!((tangent[(i, j)] - slope).abs() < 1e-8 * scale, "({i}, {j})");
            }
        }
    }
}

#[test]
fn what_is_prescribed_starts_where_the_phase_starts() {
    let scene = square_jump(4).unwrap();
    let mut u = vec![0.0; 32];
    u[29] = -0.08;
    let held: Vec<_> = scene.equations(1, &u).unwrap().prescribed(0.7).collect();
    assert_eq!(held.len(), 12);
    let (_, pushed) = held.iter().find(|(dof, _)| *dof == 29).unwrap();
    assert_eq!([pushed.displacement, pushed.velocity, pushed.acceleration], [-0.08, 0.0, 0.0]);
    let moved: Vec<_> = scene.equations(0, &[0.0; 32]).unwrap().prescribed(0.5).collect();
    let (_, pushed) = moved.iter().find(|(dof, _)| *dof == 29).unwrap();
    assert_eq!([pushed.displacement, pushed.velocity], [-0.08, -0.16]);
    assert_eq!(scene.equations(2, &u).unwrap().prescribed(1.2).count(), 0);
}

#[test]
fn lumped_inertia_is_diagonal() {
    let scene = SquareJump { inertia: Inertia::Lumped, ..SquareJump::default() }.scene().unwrap();
    let equations = scene.equations(2, &[0.0; 32]).unwrap();
    let m = equations.inertia();
    for row in 0..16 {
        for (entry, column) in m.pattern().row(row) {
            assert_eq!(m.values()[entry] == 0.0, row != column);
        }
    }
}

#[test]
fn bad_input_is_named() {
    let scene = square_jump(4).unwrap();
    let message = |error: Result<_, InputError>| {
        error.map(|_: pliant::Equations| ()).unwrap_err().to_string()
    };
    assert!(message(scene.equations(3, &[0.0; 32])).contains("number of the phase"));
    assert!(message(scene.equations(0, &[0.0; 31])).contains("31 numbers"));
    let mesh = Mesh::rectangle([1.0, 1.0], [2, 2], Cells::Triangles).unwrap();
    let material = Material { density: 1.0, young: 1.0, poisson: 0.3, viscosity: 0.0 };
    let body = Body::new(mesh, material).strain(Strain::Cauchy).thickness(1.0).build().unwrap();
    let tied = Phase::until(1.0).named("tied");
    let tied = tied.hold_combination([(1, Axis::X, 1.0), (2, Axis::X, -1.0)]);
    let error = message(Scene::new(body).phase(tied).equations(0, &[0.0; 8]));
    assert!(error.contains("tied") && error.contains("single components"), "{error}");
}

/// The solution of the Newton system, put into the equations it stands for:
/// (M + gamma D) xv + gamma Kt xu = M rv, and xu = ru + gamma xv.
#[test]
fn the_newton_matrix_is_that_of_the_ode() {
    let scene = ClampedBeam { nodes: [6, 3], viscosity: 4000.0, ..ClampedBeam::default() };
    let scene = scene.scene().unwrap();
    let [u, v] = state(scene.body().dofs());
    let n = u.len();
    let mut equations = scene.equations(0, &vec![0.0; n]).unwrap();
    // symmetric tangents, as the Newton matrix takes their symmetric part
    let [k, d] = equations.tangents(0.0, &u, &vec![0.0; n]).map(|matrix| matrix.to_dense());
    let m = |i: usize, j: usize| {
        if i % 2 == j % 2 { equations.inertia().get(i / 2, j / 2) } else { 0.0 }
    };
    let m = faer::Mat::from_fn(n, n, m);
    let held: Vec<usize> = equations.prescribed(0.0).map(|(dof, _)| dof).collect();
    let gamma = 3e-4;
    let (ru, rv) = (v.clone(), u.iter().map(|u| 1e3 * u).collect::<Vec<_>>());
    let (mut xu, mut xv) = (ru.clone(), rv.clone());
    equations.factorize(gamma).unwrap();
    equations.solve(&mut xu, &mut xv);
    for i in 0..n {
        assert!((xu[i] - ru[i] - gamma * xv[i]).abs() < 1e-15);
        if held.contains(&i) {
            assert_eq!(xv[i], rv[i]);
            continue;
        }
        let terms = (0..n).flat_map(|j| {
            [m[(i, j)] * (xv[j] - rv[j]), gamma * d[(i, j)] * xv[j], gamma * k[(i, j)] * xu[j]]
        });
        let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), x: f64| (sum + x, size + x.abs()));
        // round-off of about 50 terms, times the condition of the matrix
        assert!(sum.abs() < 1e-13 * size, "component {i}: {sum:e} of {size:e}");
    }
}
