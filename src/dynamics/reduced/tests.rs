//! With all shapes that the constraints allow and all cells, the equations of a reduced model are those of the body.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::*;
use crate::base::pod::orthonormal;
use crate::base::vector::{noise, norm};
use crate::dynamics::state::ENERGIES;
use crate::integrators::ode::Ode;
use crate::scene::constraint::{Axis, PhaseStart, Prescribed};
use crate::scene::reduced_model::{ReducedModel, ReducedPhase};
use crate::studies::samples::SQUARE_MATERIAL;
use crate::{
    Body, CellSelection, Cells, Chamber, Gas, Growth, Lag, Liquid, Mesh, Obstacle, Orifice, Phase,
    Pipe, Plane, Scene, Spring, Strain, Viscosity,
};

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

/// A motion so fast that its power is a large part of all.
fn fast(t: f64) -> Prescribed {
    Prescribed {
        displacement: 1e-4 * (3e4 * t).sin(),
        velocity: 3.0 * (3e4 * t).cos(),
        acceleration: -9e4 * (3e4 * t).sin(),
    }
}

/// Two rooms of gas with orifices, two of liquids with weight, one of them with a surface, pipes, and a spring that lags, in a body
/// with nodes that move.
fn with_amounts() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).thickness(1.0).build().unwrap();
    let phase = Phase::until(1.0)
        .named("p")
        .hold_axes([1, 2], [Axis::Y])
        .follow([11], Axis::X, fast)
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0)])
        .load([7], [3.0, -2.0])
        .open("out", 0.5)
        .flow("c", 1e-3)
        .actuate(["wire"], 30.0);
    Scene::new(body)
        .gravity([3.0, -9.0])
        .chamber(Chamber::within("a", [1, 2, 6, 5]))
        .chamber(Chamber::within("b", [3, 4, 12, 11]))
        .chamber(Chamber::within("c", [6, 7, 11, 10]))
        .chamber(Chamber::within("d", [2, 3, 7, 6]))
        .gas(Gas::in_chamber("a").pressure(1.3e5).exponent(1.4))
        .gas(Gas::in_chamber("b").pressure(2.0e5).exponent(1.1))
        .liquid(Liquid::in_chamber("c").bulk_modulus(3e5).density(50.0))
        .liquid(Liquid::in_chamber("d").density(50.0).fill(0.5).surface())
        .pipe(Pipe::new("flat", "c", "d", 0.3, 1e-3).viscosity(0.02).loss(0.7))
        .pipe(Pipe::new("fed", "pump", "c", 0.2, 2e-3).loss(1.2))
        .supply("pump", 4e5)
        .orifice(Orifice::new("in", "pump", "a", 1e-5))
        .orifice(Orifice::new("between", "a", "b", 2e-5).critical_ratio(0.3))
        .orifice(Orifice::new("out", "b", "atmosphere", 3e-5))
        .spring(Spring::between([5], [8]).named("wire").stiffness(1e3).damping(2.0))
        .lag(Lag::rise_and_fall(0.1, 0.2), ["wire"])
        .phase(phase)
}

/// Cells that grow alike in all directions, and others that grow along one, by a strain that changes by `rate` (1/s).
fn growing(rate: f64) -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL)
        .strain(Strain::Green)
        .plane(Plane::Stress)
        .thickness(0.01)
        .build()
        .unwrap();
    let [all, along] = [[0.0, 0.1], [0.1, 0.2]]
        .map(|[low, high]| Growth::within(CellSelection::inside([0.0, low], [0.2, high])));
    let phase = Phase::until(1.0)
        .named("p")
        .hold_axes([1, 2], [Axis::Y])
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0)])
        .actuate_with(["all"], move |t| 0.1 + rate * t)
        .actuate_with(["along"], move |t| -0.1 - rate * t);
    Scene::new(body)
        .growth(all.named("all"))
        .growth(along.named("along").along([1.0, 0.5]).keeping_volume())
        .phase(phase)
}

/// Branches with and without a yield stress, and nodes that move.
fn relaxing() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let dough = SQUARE_MATERIAL.yielding(1.5, 0.03, 300.0).maxwell(0.5, 0.01);
    let body = Body::new(mesh, SQUARE_MATERIAL.maxwell(0.8, 0.02))
        .strain(Strain::Green)
        .thickness(0.01)
        .region(CellSelection::inside([0.0, 0.0], [0.15, 0.2]), dough)
        .build()
        .unwrap();
    let phase = Phase::until(1.0)
        .named("p")
        .hold_axes([1, 2], [Axis::Y])
        .follow([11], Axis::X, fast)
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0)])
        .load([7], [3.0, -2.0]);
    Scene::new(body).phase(phase)
}

/// Branches without a yield stress in so many cells that modes of their strains are less work.
fn relaxing_by_modes() -> Scene {
    let mesh = Mesh::rectangle([0.3, 0.2], [13, 9], Cells::Rectangles9).unwrap();
    let substance = SQUARE_MATERIAL.maxwell(0.8, 0.02).maxwell(0.5, 0.01);
    let body = Body::new(mesh, substance).strain(Strain::Green).thickness(0.01).build().unwrap();
    let phase = Phase::until(1.0)
        .named("p")
        .hold_axes([1, 2], [Axis::Y])
        .follow([11], Axis::X, fast)
        .load([70], [3.0, -2.0]);
    Scene::new(body).phase(phase)
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
    // each row makes one of them depend on those before at most
    let count = body.dofs().min(most.saturating_add(system.rows().len()));
    let allowed = (0..count).map(|dof| {
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
        runs: 1,
        learned_from: "nothing".into(),
        learned_keys: BTreeMap::new(),
    }
}

/// The reduced equations in a state without a pattern, with that state in all unknowns.
fn reduced(scene: &Scene, most: usize) -> (ReducedSystem, Vec<f64>, Vec<f64>) {
    let model = Arc::new(model(scene, most));
    let own = system(scene);
    let layout = own.layout();
    let mut start = vec![0.0; layout.unknowns()];
    let (strains, amounts) = layout.split_mut(layout.of_mut(&mut start).internal);
    strains.iter_mut().zip(noise(1000, 11)).for_each(|(g, x)| *g = 1e-2 * x);
    // states that lag and flows are 0 at the start
    let filled = |x: &f64| if *x == 0.0 { 0.02 } else { 1.1 * x };
    amounts.iter_mut().zip(own.amounts()).for_each(|(m, x)| *m = filled(x));
    let mut form = ReducedSystem::new(own, scene.body(), &model, "p").unwrap();
    let (mut y, free) = (form.begin(0.0, &start), form.free());
    // cells keep far from turning inside out
    let most = 2e-3 * 12.0 / scene.body().mesh().node_count() as f64;
    for (k, y) in y.iter_mut().zip(noise(2 * free, 3)).enumerate() {
        *y.0 = y.1 * if k < free { most } else { 0.1 };
    }
    let of_branches =
        form.projection.branches.as_ref().map_or(Vec::new(), |own| own.tolerances(1e-3));
    let relaxing = y[2 * free..].iter_mut().zip(&of_branches);
    relaxing.zip(noise(of_branches.len(), 13)).for_each(|((y, scale), x)| *y += scale * x);
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
    for scene in [scene(), with_amounts(), growing(0.2), relaxing()] {
        let (mut form, y, state) = reduced(&scene, usize::MAX);
        let mut full = system(&scene);
        let n = full.dofs();
        let drift = full.drift(T, &state[..n]);
        assert!(drift < 1e-15, "{drift:e} m");
        let exact = rhs(&mut full, &state);
        let own = rhs(&mut form, &y);
        let accelerations = form.projection.accelerations();
        let exactly = exact[n..2 * n].iter();
        let off: Vec<f64> = exactly.zip(&accelerations).map(|(a, b)| a - b).collect();
        // a solve with M, and 20 projections
        let off = norm(&off) / norm(&accelerations);
        assert!(off < 1e-12, "{off:e}");
        // powers, and rates of amounts
        let [own, of_body] = [(&own, 2 * form.free()), (&exact, 2 * n)].map(|(x, at)| &x[at..]);
        for (k, (own, exact)) in own.iter().zip(of_body).enumerate() {
            assert!((own / exact - 1.0).abs() < 1e-10, "rate {k}: {own}, {exact}");
        }
        // nothing is left over, and the state is one of its own
        let left_over = form.left_over(T, &state, [0.0, 1.0]).unwrap().unwrap();
        let imbalance = largest(form.full.imbalances(&[left_over], 0.0)[0].as_ref().unwrap());
        assert!(imbalance < 1e-13, "{imbalance:e} m");
        let again = form.unknowns_of(T, &state).unwrap();
        let off: Vec<f64> = again.iter().zip(&y).map(|(a, b)| a - b).collect();
        assert!(norm(&off) < 1e-12 * norm(&y), "{:e}", norm(&off));
    }
}

/// The Newton systems, against differences of the equations, of the power supplied, too: those of constraints that move, and with what
/// flows in.
#[test]
fn newton_systems_are_derivatives() {
    // what growth supplies is not among what is differentiated
    for scene in [scene(), with_amounts(), growing(0.0), relaxing(), relaxing_by_modes()] {
        let (mut form, y, _) = reduced(&scene, 9);
        let (free, gamma) = (form.free(), 2e-3);
        let ydot = rhs(&mut form, &y);
        assert!(form.newton_setup(T, &y, &ydot, gamma, false).unwrap());
        // of what is dissipated the solution has the part of second order, too
        let rows = (0..y.len()).filter(|i| *i != y.len() - ENERGIES);
        let mut residual = noise(y.len(), 5);
        // small where a unit is large
        (2 * free..y.len() - ENERGIES).for_each(|i| residual[i] *= y[i]);
        let mut x = residual.clone();
        form.newton_solve(gamma, &mut x).unwrap();
        let h = 1e-8;
        let moved = |by: f64| y.iter().zip(&x).map(|(y, x)| y + by * x).collect::<Vec<_>>();
        let [ahead, behind] = [h, -h].map(|by| rhs(&mut form, &moved(by)));
        for i in rows {
            let slope = (ahead[i] - behind[i]) / (2.0 * h);
            let off = x[i] - gamma * slope - residual[i];
            let scale = x[i].abs() + gamma * slope.abs();
            assert!(off.abs() < 1e-5 * scale, "row {i} of {free}: {off:e} of {scale:e}");
        }
    }
}

#[test]
fn a_state_that_the_model_does_not_have_is_none_of_its_own() {
    for scene in [scene(), with_amounts(), relaxing(), relaxing_by_modes()] {
        let (mut form, _, mut state) = reduced(&scene, 9);
        assert!(form.unknowns_of(T, &state).is_some());
        let other = noise(state.len(), 7);
        let motion = 2 * form.full.dofs();
        state[..motion].iter_mut().zip(other).for_each(|(x, other)| *x += 1e-6 * other);
        assert!(form.unknowns_of(T, &state).is_none());
        // what is left out is told
        let left_over = form.left_over(T, &state, [0.0, 1.0]).unwrap().unwrap();
        let found = largest(form.full.imbalances(&[left_over], 0.0)[0].as_ref().unwrap());
        assert!(found > 1e-6, "{found:e} m");
    }
}
