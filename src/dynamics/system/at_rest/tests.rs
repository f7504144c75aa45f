//! Tests of statics against the energies and forces of dynamics.

use std::sync::Arc;

use super::*;
use crate::dynamics::matrices::Matrices;
use crate::elements::body::{Body, Strain};
use crate::elements::force::Tangents;
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::constraint::PhaseStart;
use crate::scene::forces::{Chamber, Obstacle, Spring};
use crate::scene::timeline::{Phase, Scene};
use crate::studies::samples::{BEAM_MATERIAL, SQUARE_MATERIAL};

/// A load on the last of three nodes that grows with the square of its displacement.
struct Growing;

impl Force for Growing {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        forces.applied[2] += 500.0 * u[2] * u[2];
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        stiffness.block_mut(2, 2).unwrap()[0] -= 1000.0 * u[2];
        Tangents::Added
    }
}

/// K is the derivative of the forces, and their total that of the energy, when a part of the
/// loads acts: linear elasticity, Green's, and a load that follows the body.
#[test]
fn partial_loads_have_partial_tangents() {
    for strain in [Strain::Cauchy, Strain::Green] {
        let mesh = Mesh::bar(0.1, 3).unwrap();
        let body = Body::new(mesh, BEAM_MATERIAL).area(2e-4).strain(strain).build().unwrap();
        let mut forces: Vec<Arc<dyn Force>> = vec![Arc::new(Growing)];
        if let Some(elastic) = body.elastic() {
            forces.push(Arc::new(elastic));
        }
        let matrices = Arc::new(Matrices::new(&body, forces.iter().map(|force| &**force)));
        let system = System::new(matrices, forces, Vec::new(), 0.0, "test").unwrap();
        let mut rest = AtRest::new(system, 1.0, "test").unwrap();
        let (u, part) = ([0.001, 0.004, 0.01], 0.3);
        rest.update_tangent(part, &u);
        let h = 1e-6;
        for j in 0..3 {
            let mut at = |by: f64| {
                let (mut moved, mut balance) = (u, ForceBalance::zeros(3));
                moved[j] += by;
                rest.evaluate(part, &moved, &mut balance).unwrap();
                balance
            };
            let (here, ahead, behind) = (at(0.0), at(h), at(-h));
            let mut step = [0.0; 3];
            step[j] = 2.0 * h;
            let fall = -ahead.energy_since(&behind, 1.0, &step) / (2.0 * h);
            // central differences: h^2 U'''/6, about 2e-9, of forces of 0.7 N
            assert!((fall - here.total[j]).abs() < 1e-8, "{strain:?} {j}: {fall}");
            for i in 0..3 {
                let slope = (behind.total[i] - ahead.total[i]) / (2.0 * h);
                let k = rest.system.tangents().0.get(i, j);
                // forces of 1 N, known to 1e-16, over 1e-6 m; stiffness 200 N/m
                assert!((k - slope).abs() < 1e-6, "{strain:?} ({i}, {j}): {k} {slope}");
            }
        }
    }
}

/// A square with a spring, a chamber and a moving obstacle, with everything from outside times a factor;
/// returns the equations of its only phase at rest.
fn all_at_once(factor: f64) -> AtRest {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let body = body.point_mass("bob", [0.5, 0.4], 0.1).build().unwrap();
    // it comes down by 3 cm times the factor
    let disc = Obstacle::disc([0.1, 0.38], 0.1).velocity([0.01 * factor, -0.03 * factor]);
    let phase = Phase::until(1.0)
        .hold("bottom")
        .load([16], [2.0 * factor, -factor])
        .load_total("right", [0.0, 3.0 * factor])
        .load_with("left", move |t| [factor * t, 0.0])
        .load_table("top", [0.0, 2.0], [[0.0, 0.0], [4.0 * factor, 0.0]])
        .actuate(["A1"], -2.0 * factor)
        .actuate_with(["A1"], move |t| 0.5 * factor * t)
        .pressure("cell", 2e3 * factor);
    let scene = Scene::new(body)
        .gravity([1.0 * factor, -9.8 * factor])
        .spring(Spring::between([16], "bob").named("A1").stiffness(20.0).damping(5.0))
        .chamber(Chamber::within("cell", [6, 7, 11, 10]))
        .obstacle(disc.stiffness(100.0).damping(50.0).tangential_damping(20.0))
        .phase(phase.clone());
    let forces = scene.forces().unwrap();
    let (matrices, start) = (scene.matrices(&forces), vec![0.0; scene.body().dofs()]);
    let start = PhaseStart { time: 0.0, u: &start };
    let forces = forces.into_iter().next().unwrap();
    let system = scene.system(&matrices, &phase, forces, &start, 0.0).unwrap();
    AtRest::new(system, 1.0, "test").unwrap()
}

/// A part of the load equals the load with all its inputs made smaller: forces, their energy and their
/// tangents, which are the derivatives of the forces.
#[test]
fn a_part_of_the_load_is_the_load_made_smaller() {
    let part = 0.3;
    let (mut rest, mut smaller) = (all_at_once(1.0), all_at_once(part));
    let dofs = rest.system.dofs();
    let u: Vec<f64> = (0..dofs).map(|i| 0.01 * (i as f64 * 1.7 + 0.3).sin()).collect();
    let evaluate = |rest: &mut AtRest, part: f64, u: &[f64]| {
        let mut balance = ForceBalance::zeros(dofs);
        rest.evaluate(part, u, &mut balance).unwrap();
        balance
    };
    let (found, expected) = (evaluate(&mut rest, part, &u), evaluate(&mut smaller, 1.0, &u));
    assert!(rest.energy(part, &u).contact > 1e-3, "the obstacle touches");
    rest.update_tangent(part, &u);
    let k = rest.system.tangents().0;
    for i in 0..dofs {
        // round-off of forces up to 1 kN
        assert!((found.total[i] - expected.total[i]).abs() < 1e-11, "{i}");
        assert!((found.unbound[i] - expected.unbound[i]).abs() < 1e-11, "{i}");
    }
    assert!((found.potential - expected.potential).abs() < 1e-11);
    let h = 1e-6;
    for j in 0..dofs {
        let at = |by: f64| {
            let mut moved = u.clone();
            moved[j] += by;
            evaluate(&mut all_at_once(1.0), part, &moved).total
        };
        let (ahead, behind) = (at(h), at(-h));
        for i in 0..dofs {
            let slope = (behind[i] - ahead[i]) / (2.0 * h);
            // central differences of forces of 1 kN that change over 0.1 m: 1e3 h^2/0.1^3, and
            // round-off, 1e-13/h
            assert!((k.get(i, j) - slope).abs() < 1e-4, "({i}, {j}): {} {slope}", k.get(i, j));
        }
    }
}

/// The dual system for a tangent that is not symmetric (pressure on a surface that is not closed), with nodes
/// that are held and others on an oblique plane: its equations are checked row by row with the dense matrix.
#[cfg(feature = "study")]
#[test]
fn duals_solve_the_transposed_system() {
    let mesh = Mesh::rectangle([0.1, 0.04], [4, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green);
    let scene = Scene::new(body.build().unwrap()).phase(
        Phase::until(1.0).hold("left").symmetry("right", [1.0, 2.0]).pressure_on("top", 2e5),
    );
    let mut rest = scene.at_rest_in(0).unwrap();
    let dofs = rest.system().dofs();
    let rows = rest.system().rows().to_vec();
    let some = |count: usize, step: f64| -> Vec<f64> {
        (0..count).map(|i| (step * (i + 1) as f64).sin()).collect()
    };
    let (u, j, g) = (some(dofs, 0.7), some(dofs, 1.3), some(rows.len(), 2.1));
    let u: Vec<f64> = u.iter().map(|u| 1e-4 * u).collect();
    rest.update_tangent(1.0, &u);
    assert!(rest.factorize_any());
    let (mut z, mut nu) = (vec![0.0; dofs], vec![0.0; rows.len()]);
    assert!(rest.solve_dual([&j, &g], &mut z, &mut nu));
    let k = rest.tangent().to_dense();
    let skew = (0..dofs * dofs).map(|i| (k[(i / dofs, i % dofs)] - k[(i % dofs, i / dofs)]).abs());
    assert!(skew.fold(0.0, f64::max) > 100.0);
    let mut left = j.clone();
    for i in 0..dofs {
        left[i] -= (0..dofs).map(|row| k[(row, i)] * z[row]).sum::<f64>();
    }
    for ((row, nu), g) in rows.iter().zip(&nu).zip(&g) {
        row.terms.iter().for_each(|&(dof, c)| left[dof] += c * nu);
        assert!((row.apply(&z) + g).abs() < 1e-12, "{}", row.apply(&z));
    }
    // found: 2e-16, as the last refinement is better than it has to be
    assert!(largest(&left) < 1e-12 * largest(&nu), "{:e} {:e}", largest(&left), largest(&nu));
}
