//! Rigid pieces in the differential-algebraic forms: Jacobians and structured solves against differences of the residuals.

use faer::Mat;

use crate::dynamics::state::ENERGIES;
use crate::dynamics::system::tests::{
    assert_close, consistent, first_phase, noise, residual_derivatives, solve,
};
use crate::dynamics::system::{DaeForm, Index, System};
use crate::integrators::ode::Dae;
use crate::scene::constraint::{Axis, PhaseStart};
use crate::{Body, CellSelection, Cells, Material, Mesh, Phase, Scene};

/// A soft beam with a rigid insert, of which one node is held in one direction and another one tied to a soft one.
fn with_insert() -> System {
    let soft = Material { density: 1000.0, young: 1e4, poisson: 0.3, viscosity: 0.0 };
    let mesh = Mesh::rectangle([0.5, 0.3], [6, 4], Cells::Triangles).unwrap();
    let cells = CellSelection::inside([0.1, 0.0], [0.4, 0.2]);
    let body = Body::new(mesh, soft).thickness(0.01).region(cells, Material::rigid(2000.0));
    let phase = Phase::until(1.0)
        .hold([1, 7])
        .hold_axes([3], [Axis::Y])
        .hold_combination([(9, Axis::X, 1.0), (18, Axis::X, -1.0)])
        .load([24], [0.3, -0.2]);
    let scene = Scene::new(body.build().unwrap()).gravity([0.0, -9.8]).phase(phase);
    let natural = vec![0.0; scene.body().dofs()];
    first_phase(&scene, &PhaseStart { time: 0.0, u: &natural }).unwrap()
}

/// A state in which the rigid piece has turned and turns, if it `moves`.
fn turned(system: &System, moves: bool) -> Vec<f64> {
    let n = system.dofs();
    let mut y = noise(2 * n + ENERGIES, 1);
    let rigid = system.matrices.rigid.as_ref().unwrap();
    assert!(rigid.dependent_nodes() > 5 && system.edges.list.len() == 3);
    y[..n].iter_mut().for_each(|u| *u *= 0.01);
    y[n..2 * n].iter_mut().for_each(|v| *v *= if moves { 1.0 } else { 0.0 });
    rigid.carry(&mut y[..n]);
    rigid.carry(&mut y[n..2 * n]);
    y
}

/// Components that dependent nodes have nothing of, and those of energies, which have a test of their own.
fn without_strays(system: &System, mut r: Vec<f64>) -> Vec<f64> {
    let (n, d) = (system.dofs(), system.matrices.dimension);
    for (node, _) in system.matrices.rigid.as_ref().unwrap().dependents() {
        for at in node * d..(node + 1) * d {
            (r[at], r[n + at]) = (0.0, 0.0);
        }
    }
    r
}

#[test]
fn index_one_jacobian_is_the_derivative_of_the_residual() {
    let mut equations = DaeForm::new(with_insert(), Index::One);
    let n = equations.system.dofs();
    let state = turned(&equations.system, true);
    let (y, yp) = consistent(&mut equations, &state);
    let [by_y, by_yp] = residual_derivatives(&mut equations, &y, &yp, 1e-5);
    let cj = 50.0;
    let mut jacobian = Mat::<f64>::zeros(y.len(), y.len());
    equations.newton_setup(0.1, cj, &y, &yp).unwrap();
    equations.visit_jacobian(cj, |i, j, value| jacobian[(i, j)] += value);
    for j in 0..y.len() {
        for i in (0..y.len()).filter(|i| !(2 * n..2 * n + ENERGIES).contains(i)) {
            let expected = by_y[(i, j)] + cj * by_yp[(i, j)];
            let apart = (jacobian[(i, j)] - expected).abs();
            assert!(apart < 1e-6 * (1.0 + expected.abs()), "({i}, {j}): {expected}, {apart:e} off");
        }
    }
}

#[test]
fn structured_solve_is_that_of_the_index_one_jacobian() {
    let mut equations = DaeForm::new(with_insert(), Index::One);
    let n = equations.system.dofs();
    let state = turned(&equations.system, true);
    let (y, yp) = consistent(&mut equations, &state);
    for cj in [100.0, 1e4] {
        let mut jacobian = Mat::<f64>::zeros(y.len(), y.len());
        equations.newton_setup(0.1, cj, &y, &yp).unwrap();
        equations.visit_jacobian(cj, |i, j, value| jacobian[(i, j)] += value);
        let r = without_strays(&equations.system, noise(y.len(), 3));
        let mut x = r.clone();
        equations.newton_solve(&mut x).unwrap();
        let lambda = 2 * n + ENERGIES;
        let edges = y.len() - equations.system.edges.list.len() - lambda;
        let expected = solve(&jacobian, &r);
        assert_close(&x[..2 * n], &expected[..2 * n], 1e-8, &[n, 2 * n]);
        assert_close(&x[lambda..], &expected[lambda..], 1e-8, &[edges, y.len() - lambda]);
    }
}

/// Where pieces do not turn: what the demands of positions lack is in proportion to that.
#[test]
fn structured_solve_is_that_of_the_index_two_jacobian() {
    let mut equations = DaeForm::new(with_insert(), Index::Two);
    let n = equations.system.dofs();
    let state = turned(&equations.system, false);
    let (y, yp) = consistent(&mut equations, &state);
    let [by_y, by_yp] = residual_derivatives(&mut equations, &y, &yp, 1e-5);
    let lambda = 2 * n + ENERGIES;
    let kept: Vec<usize> = (0..2 * n).chain(lambda..y.len()).collect();
    let [rows, edges] = [equations.system.rows.len(), equations.system.edges.list.len()];
    let multipliers = [rows, rows + edges, 2 * rows + edges, 2 * (rows + edges)];
    let blocks = [[n, 2 * n].to_vec(), multipliers.map(|count| 2 * n + count).to_vec()].concat();
    for cj in [100.0, 1e4] {
        let entry = |i: usize, j: usize| by_y[(i, j)] + cj * by_yp[(i, j)];
        let jacobian = Mat::from_fn(kept.len(), kept.len(), |i, j| entry(kept[i], kept[j]));
        equations.newton_setup(0.1, cj, &y, &yp).unwrap();
        let r = without_strays(&equations.system, noise(y.len(), 3));
        let mut x = r.clone();
        equations.newton_solve(&mut x).unwrap();
        let [x, r] = [x, r].map(|all| kept.iter().map(|&i| all[i]).collect::<Vec<_>>());
        // some digits are lost to the differences
        assert_close(&x, &solve(&jacobian, &r), 1e-6, &blocks);
    }
}

#[test]
fn consistent_start_satisfies_the_residual() {
    for (index, moves) in [(Index::One, true), (Index::Two, false)] {
        let mut equations = DaeForm::new(with_insert(), index);
        let n = equations.system.dofs();
        // the form of index 2 begins where the constraints hold
        let state = match moves {
            true => turned(&equations.system, true),
            false => vec![0.0; 2 * n + ENERGIES],
        };
        let (y, yp) = consistent(&mut equations, &state);
        let mut residual = vec![0.0; y.len()];
        equations.residual(0.1, &y, &yp, &mut residual).unwrap();
        let scale = equations.system.at.total.iter().fold(0.0_f64, |s, f| s.max(f.abs()));
        for (i, r) in residual.iter().enumerate() {
            assert!(r.abs() < 1e-10 * scale, "{index:?} {i}: {r:e}");
        }
    }
}
