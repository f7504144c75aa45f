//! With all shapes that the constraints allow and all cells, the equations of a reduced model are those of the body.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::*;
use crate::base::pod::orthonormal;
use crate::base::vector::{noise, norm};
use crate::integrators::ode::Ode;
use crate::scene::constraint::{Axis, PhaseStart, Prescribed};
use crate::scene::reduced_model::{ReducedModel, ReducedPhase};
use crate::studies::samples::SQUARE_MATERIAL;
use crate::{Body, Cells, Mesh, Obstacle, Phase, Scene, Viscosity};

const T: f64 = 0.3;
const ALPHA: f64 = 30.0;

/// Held nodes, one that moves along a curve, one that is held by a general row, loads, gravity, viscosity that follows the
/// body, a spring, contact with friction.
fn scene() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL)
        .viscosity(Viscosity::Objective)
        .thickness(0.01)
        .build()
        .unwrap();
    let curve = |t: f64| Prescribed {
        displacement: 0.01 * (3.0 * t).sin(),
        velocity: 0.03 * (3.0 * t).cos(),
        acceleration: -0.09 * (3.0 * t).sin(),
    };
    let phase = Phase::until(1.0)
        .named("p")
        .hold_axes([1, 2], [Axis::Y])
        .follow([11], Axis::X, curve)
        .follow([11], Axis::Y, curve)
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0)])
        .load([7], [3.0, -2.0])
        .load_with([6], |t| [t, 1.0]);
    let floor = Obstacle::half_plane([0.0, 0.05], [0.6, 0.8])
        .stiffness(5e3)
        .damping(20.0)
        .tangential_damping(30.0);
    Scene::new(body).gravity([0.0, -9.8]).obstacle(floor).phase(phase)
}

fn system(scene: &Scene) -> System {
    let rest = vec![0.0; scene.body().dofs()];
    let start = PhaseStart { time: 0.0, u: &rest };
    let mut forces = scene.forces().unwrap();
    let matrices = scene.matrices(&forces);
    scene.system(&matrices, &scene.phases()[0], forces.remove(0), &start, ALPHA).unwrap()
}

/// A model with all shapes, or with the first `most` of them.
fn model(scene: &Scene, most: usize) -> ReducedModel {
    let (mut system, body) = (system(scene), scene.body());
    let mass = |x: &[f64], y: &mut [f64]| body.inertia().add_product(2, 1.0, x, y);
    let allowed = (0..body.dofs()).map(|dof| {
        let mut x = vec![0.0; body.dofs()];
        x[dof] = 1.0;
        system.constrain(&mut x);
        x
    });
    let mut shapes = orthonormal(&allowed.collect::<Vec<_>>(), &mass);
    // dependent ones leave round-off
    shapes.truncate(body.dofs() - system.rows().len());
    shapes.truncate(most);
    let cells = body.mesh().cell_count();
    ReducedModel {
        dofs: body.dofs(),
        cell_count: cells,
        phases: vec![ReducedPhase {
            name: "p".into(),
            rows: system.rows().len(),
            range: vec![[0.0, 1.0]; shapes.len()],
            shapes,
            lifts: system.lifts(0.0).unwrap(),
        }],
        cells: (0..cells).map(|cell| (cell, 1.0)).collect::<BTreeMap<_, _>>(),
        error: 0.0,
        within: 0.01,
        travel: 0.1,
        error_per_imbalance: 1.0,
        is_estimate: false,
        learned_from: "nothing".into(),
    }
}

/// The reduced equations in a state without a pattern, with that state in all unknowns.
fn reduced(most: usize) -> (ReducedForm, Vec<f64>, Vec<f64>) {
    let scene = scene();
    let model = Arc::new(model(&scene, most));
    let mut own = system(&scene);
    own.reduce(scene.body(), &model, "p").unwrap();
    let start = vec![0.0; own.unknowns()];
    let (mut form, mut y) = ReducedForm::new(own, 0.0, &start).ok().unwrap();
    let free = form.free;
    for (k, y) in y.iter_mut().zip(noise(2 * free, 3)).enumerate() {
        *y.0 = y.1 * if k < free { 2e-3 } else { 0.1 };
    }
    let mut state = vec![0.0; start.len()];
    form.lift(T, &y, &mut state);
    (form, y, state)
}

fn rhs(form: &mut impl Ode, y: &[f64]) -> Vec<f64> {
    let mut ydot = vec![0.0; y.len()];
    form.rhs(T, y, &mut ydot).unwrap();
    ydot
}

#[test]
fn with_all_shapes_and_cells_it_is_the_body() {
    let (mut form, y, state) = reduced(usize::MAX);
    let mut full = system(&scene());
    let n = full.dofs();
    let drift = full.drift(T, &state[..n]);
    assert!(drift < 1e-15, "{drift:e} m");
    let exact = rhs(&mut full, &state);
    let own = rhs(&mut form, &y);
    let accelerations = form.system.reduction.as_ref().unwrap().accelerations();
    let off: Vec<f64> = exact[n..2 * n].iter().zip(&accelerations).map(|(a, b)| a - b).collect();
    // a solve with M, and 20 projections
    assert!(norm(&off) < 1e-12 * norm(&accelerations), "{:e}", norm(&off) / norm(&accelerations));
    for k in 0..2 {
        let [own, exact] = [own[2 * form.free + k], exact[2 * n + k]];
        assert!((own / exact - 1.0).abs() < 1e-10, "power {k}: {own}, {exact}");
    }
    // nothing is left over, and the state is one of its own
    let left_over = form.system.left_over(T, &state, [0.0, 1.0]).unwrap().unwrap();
    let imbalance = largest(form.system.imbalances(&[left_over])[0].as_ref().unwrap());
    assert!(imbalance < 1e-13, "{imbalance:e} m");
    let again = form.unknowns_of(T, &state).unwrap();
    let off: Vec<f64> = again.iter().zip(&y).map(|(a, b)| a - b).collect();
    assert!(norm(&off) < 1e-12 * norm(&y), "{:e}", norm(&off));
}

/// The Newton systems, against differences of the equations; and the changes of the powers.
#[test]
fn newton_systems_are_derivatives() {
    let (mut form, y, _) = reduced(9);
    let (free, gamma) = (form.free, 2e-3);
    let ydot = rhs(&mut form, &y);
    assert!(form.newton_setup(T, &y, &ydot, gamma, false).unwrap());
    let residual = noise(y.len(), 5);
    let mut x = residual.clone();
    form.newton_solve(gamma, &mut x).unwrap();
    let h = 1e-8;
    let moved = |by: f64| y.iter().zip(&x).map(|(y, x)| y + by * x).collect::<Vec<_>>();
    let [ahead, behind] = [h, -h].map(|by| rhs(&mut form, &moved(by)));
    for i in 0..2 * free {
        let slope = (ahead[i] - behind[i]) / (2.0 * h);
        let off = x[i] - gamma * slope - residual[i];
        let scale = x[i].abs() + gamma * slope.abs();
        assert!(off.abs() < 1e-5 * scale, "row {i}: {off:e} of {scale:e}");
    }
}

#[test]
fn a_state_that_the_model_does_not_have_is_none_of_its_own() {
    let (mut form, _, mut state) = reduced(9);
    assert!(form.unknowns_of(T, &state).is_some());
    let other = noise(state.len(), 7);
    state.iter_mut().zip(other).for_each(|(x, other)| *x += 1e-6 * other);
    assert!(form.unknowns_of(T, &state).is_none());
    // what is left out is told
    let left_over = form.system.left_over(T, &state, [0.0, 1.0]).unwrap().unwrap();
    let found = largest(form.system.imbalances(&[left_over])[0].as_ref().unwrap());
    assert!(found > 1e-6, "{found:e} m");
}
