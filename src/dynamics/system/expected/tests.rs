//! Vibrations against all eigenvalues of the dense matrices, motions of second order against equilibria.

use faer::Mat;
use faer::prelude::Solve;

use super::Vibrations;
use crate::base::pod::orthonormal;
use crate::base::vector::{dot, largest};
use crate::dynamics::system::System;
use crate::dynamics::system::tests::first_phase;
use crate::scene::constraint::PhaseStart;
use crate::{Body, Cells, Material, Mesh, Phase, Scene, Statics, Strain};

/// A strip of 9 x 3 nodes, clamped on the left, with a force (N) at its tip.
fn strip(force: f64) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [9, 3], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 4.0 };
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build().unwrap();
    Scene::new(body).phase(Phase::until(1.0).hold("left").load([18], [0.3 * force, force]))
}

fn system(scene: &Scene) -> System {
    let rest = vec![0.0; scene.body().dofs()];
    first_phase(scene, &PhaseStart { time: 0.0, u: &rest }).unwrap()
}

#[test]
fn vibrations_are_those_of_the_matrices() {
    let scene = strip(0.0);
    let body = scene.body();
    let held = |dof: usize| (dof / 2).is_multiple_of(9);
    let free: Vec<usize> = (0..body.dofs()).filter(|&dof| !held(dof)).collect();
    let n = free.len();
    let mass = Mat::from_fn(n, n, |i, j| match free[i] % 2 == free[j] % 2 {
        true => body.inertia().get(free[i] / 2, free[j] / 2),
        false => 0.0,
    });
    let all = body.stiffness().to_dense();
    let stiffness = Mat::from_fn(n, n, |i, j| all[(free[i], free[j])]);
    let product = mass.partial_piv_lu().solve(&stiffness);
    let mut exact: Vec<f64> = product.eigenvalues().unwrap().iter().map(|own| own.re).collect();
    exact.sort_by(f64::total_cmp);

    let mut system = system(&scene);
    system.update_tangents_at_rest(0.0);
    let Vibrations { rigid, lowest: found, .. } = system.vibrations(8);
    assert!(rigid.is_empty() && found.len() == 8);
    for ((value, shape), exact) in found.iter().zip(exact) {
        // iteration ends where two values in a row agree to 1e-3
        assert!((value / exact - 1.0).abs() < 1e-3, "{value} {exact}");
        assert!(shape.iter().enumerate().all(|(dof, x)| !held(dof) || x.abs() < 1e-12));
    }
}

/// The even part of the response to opposite small loads is of second order, and a sum of expected motions.
#[test]
fn motions_of_second_order_are_those_of_equilibria() {
    const FORCE: f64 = 1e-5;
    let statics = Statics { rtol: 1e-13, ..Statics::default() };
    let equilibrium = |force: f64| strip(force).equilibrium(&statics).unwrap();
    let [up, down] = [FORCE, -FORCE].map(|force| equilibrium(force).displacements().to_vec());
    let alike: Vec<f64> = up.iter().zip(&down).map(|(a, b)| a + b).collect();

    let scene = strip(FORCE);
    let rest = vec![0.0; scene.body().dofs()];
    let expected =
        system(&scene).expected_motions([0.0, 1.0], &rest, &[], None, &mut None).unwrap();
    let left_over = |motions: &[Vec<f64>]| {
        let mass = |x: &[f64], y: &mut [f64]| scene.body().inertia().add_product(2, 1.0, x, y);
        let mut rest = alike.clone();
        for shape in orthonormal(motions, &mass) {
            let mut weighted = vec![0.0; rest.len()];
            mass(&shape, &mut weighted);
            let part = dot(&weighted, &alike);
            rest.iter_mut().zip(&shape).for_each(|(x, shape)| *x -= part * shape);
        }
        largest(&rest) / largest(&alike)
    };
    // terms of the fourth order, and round-off of 1e-13 of displacements that are 1e4 times as large
    let found = left_over(&expected);
    assert!(found < 1e-3, "{found:e}");
    // the load and the vibrations alone do not have it
    let first_order = left_over(&expected[..29]);
    assert!(first_order > 0.01, "{first_order:e}");
}
