//! Tests of the structured solves against finite differences of the equations themselves.

use faer::Mat;
use faer::prelude::Solve;

use super::{DaeForm, Index, System};
use crate::dynamics::state::ENERGIES;
use crate::elements::body::BodyBuilder;
use crate::integrators::ode::{Dae, Ode};
use crate::scene::constraint::{Axis, PhaseStart};
use crate::studies::samples::SQUARE_MATERIAL;
use crate::{
    Body, CellSelection, Cells, Chamber, Dilatation, Gas, InputError, Law, Liquid, Mesh, Obstacle,
    Orifice, Phase, Pipe, Plane, Scene, SolidCells, Strain, Substance, Viscosity,
};

const ALPHA: f64 = 30.0;

/// A square of 4 x 3 nodes with everything at work: nodal and general constraints, held and moved,
/// loads, gravity, contact with damping and friction at some nodes.
fn system() -> System {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let floor = Obstacle::half_plane([0.0, 0.05], [0.6, 0.8]);
    let phase = Phase::until(1.0)
        .hold_axes([1, 2], [Axis::Y])
        .move_nodes([11], [0.1, -0.2])
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0), (11, Axis::X, 0.5)])
        .hold_combination([(9, Axis::Y, 1.0), (4, Axis::X, 1.0)])
        .load([7], [3.0, -2.0]);
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor.stiffness(5e3).damping(20.0).tangential_damping(30.0))
        .phase(phase);
    let natural = vec![0.0; scene.body().dofs()];
    let start = PhaseStart { time: 0.0, u: &natural };
    first_phase(&scene, &start).unwrap()
}

pub(super) fn first_phase(scene: &Scene, start: &PhaseStart) -> Result<System, InputError> {
    let mut forces = scene.forces()?;
    let matrices = scene.matrices(&forces);
    scene.system(&matrices, &scene.phases()[0], forces.remove(0), start, ALPHA)
}

/// Numbers between -1 and 1 without a pattern (a linear congruential generator).
pub(super) fn noise(length: usize, seed: u64) -> Vec<f64> {
    let mut x = seed;
    let mut next = || {
        x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..length).map(|_| next()).collect()
}

/// A state with these internal unknowns.
fn state_with(system: &System, internal: &[f64]) -> Vec<f64> {
    let n = system.dofs();
    let mut y = noise(2 * n + ENERGIES, 1);
    y[..n].iter_mut().for_each(|u| *u *= 0.01);
    y.splice(2 * n..2 * n, internal.iter().copied());
    assert_eq!(y.len(), system.layout.unknowns());
    y
}

fn state(system: &System) -> Vec<f64> {
    state_with(system, &[])
}

/// y and y' that are consistent at t = 0.1.
pub(super) fn consistent(equations: &mut DaeForm, state: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let [mut y, mut yp] = [(); 2].map(|()| vec![0.0; equations.size()]);
    equations.consistent(0.1, state, [&mut y, &mut yp]).unwrap();
    (y, yp)
}

/// df/dy of a function, column by column, by central differences: exact up to round-off where
/// `f` is linear or quadratic, as all forces here are away from d = 0.
pub(super) fn derivative(y: &[f64], step: f64, mut f: impl FnMut(&[f64]) -> Vec<f64>) -> Mat<f64> {
    let columns: Vec<Vec<f64>> = (0..y.len())
        .map(|j| {
            let mut at = |shift: f64| {
                let mut y = y.to_vec();
                y[j] += shift;
                f(&y)
            };
            let (ahead, behind) = (at(step), at(-step));
            ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect()
        })
        .collect();
    Mat::from_fn(columns[0].len(), y.len(), |i, j| columns[j][i])
}

pub(super) fn solve(matrix: &Mat<f64>, right: &[f64]) -> Vec<f64> {
    let solution = matrix.partial_piv_lu().solve(&Mat::from_fn(right.len(), 1, |i, _| right[i]));
    solution.col_as_slice(0).to_vec()
}

/// Differences relative to the size of the block they are in.
pub(super) fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, blocks: &[usize]) {
    let mut start = 0;
    for &end in blocks {
        let scale = expected[start..end].iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        for i in start..end {
            let apart = (found[i] - expected[i]).abs();
            assert!(apart < tolerance * scale, "{i}: {} {} ({scale:e})", found[i], expected[i]);
        }
        start = end;
    }
}

/// The residual that integrators know lacks the accelerations; the solve adds them.
#[test]
fn structured_solve_is_that_of_the_ode_jacobian() {
    let system = system();
    let y = state(&system);
    solves_by_the_ode_jacobian(system, &y, 1e-5, 1e-6);
}

/// Friction follows the normal force of a contact that is stiff in these steps: then a solve by the symmetric part alone is off by
/// more than the solution itself.
#[test]
fn friction_is_solved_with_the_normal_force_that_it_follows() {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body = Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01);
    let floor = Obstacle::half_plane([0.0, 0.05], [0.6, 0.8]).stiffness(1e6).damping(20.0);
    let phase = Phase::until(1.0).hold([12]).hold_combination([
        (10, Axis::X, 1.0),
        (11, Axis::X, -2.0),
        (11, Axis::Y, 0.5),
    ]);
    let scene = Scene::new(body.build().unwrap())
        .obstacle(floor.friction_coefficient(0.8).sticking_speed(0.3))
        .phase(phase);
    let natural = vec![0.0; scene.body().dofs()];
    let system = first_phase(&scene, &PhaseStart { time: 0.0, u: &natural }).unwrap();
    let y = state(&system);
    // powers of friction are no squares, of which integrators solve the energies
    solves_blocks_by_the_ode_jacobian(system, &y, (1e-6, 1e-5), &[]);
}

/// Two branches in one part of a body and one in another, strained away from their relaxed state; some of
/// them flow, and some do not.
#[test]
fn internal_strains_are_eliminated() {
    let triangles = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let triangles6 = Mesh::rectangle([0.3, 0.2], [3, 2], Cells::Triangles6).unwrap();
    let rectangles9 = Mesh::rectangle([0.3, 0.2], [3, 2], Cells::Rectangles9).unwrap();
    let hexahedra = Mesh::cuboid([0.3, 0.2, 0.1], [3, 2, 2], SolidCells::Hexahedra).unwrap();
    let (points, mean, linear) = (Dilatation::AtPoints, Dilatation::Mean, Dilatation::Linear);
    // components, points and cells, half of which have two branches; and the accuracy that the dense solve
    // loses (measured: 2e-5 of the energies of triangles of 6 nodes, less than 3e-5 of all)
    for (mesh, dilatation, plane, yield_stress, internal, tolerance) in [
        (&triangles, points, Plane::Strain, 0.0, 3 * (2 * 6 + 6), 1e-5),
        (&triangles6, mean, Plane::Strain, 0.0, 3 * 3 * (2 * 2 + 2), 1e-4),
        (&hexahedra, mean, Plane::Strain, 0.0, 6 * 8 * (2 + 1), 1e-4),
        (&rectangles9, linear, Plane::Strain, 0.0, 3 * 9 * (2 + 1), 1e-4),
        (&triangles, points, Plane::Strain, 3e3, (4 + 3) * 6 + 4 * 6, 1e-4),
        (&triangles, points, Plane::Stress, 3e3, 3 * (2 * 6 + 6), 1e-4),
        (&hexahedra, points, Plane::Strain, 3e3, 6 * 8 * (2 + 1), 1e-4),
        (&triangles6, mean, Plane::Strain, 3e3, 3 * ((4 + 3) * 2 + 4 * 2), 1e-4),
        (&rectangles9, linear, Plane::Strain, 3e3, 9 * ((4 + 3) + 4), 1e-4),
    ] {
        for strain in [Strain::Cauchy, Strain::Green] {
            let left = SQUARE_MATERIAL.yielding(0.7, 1e-3, yield_stress).maxwell(2.0, 0.3);
            let right = SQUARE_MATERIAL.yielding(1.0, 1e-2, yield_stress);
            let body = Body::new(mesh.clone(), left).dilatation(dilatation).plane(plane);
            let size = if yield_stress > 0.0 { 0.05 } else { 0.2 };
            eliminates(body.strain(strain), right, (internal, size), tolerance);
        }
    }
}

/// Beside rubber the part of a point's matrices that is not symmetric is left out, which is of the size of the strains: 1e-4 here.
#[test]
fn internal_strains_beside_rubber_are_eliminated() {
    let rectangles = Mesh::rectangle([0.3, 0.2], [3, 4], Cells::Rectangles).unwrap();
    let hexahedra = Mesh::cuboid([0.3, 0.2, 0.1], [3, 2, 2], SolidCells::Hexahedra).unwrap();
    for (mesh, dilatation, plane, internal) in [
        (&rectangles, Dilatation::AtPoints, Plane::Strain, 4 * 4 * (2 * 3 + 3)),
        (&rectangles, Dilatation::Mean, Plane::Strain, 4 * 4 * (2 * 3 + 3)),
        (&rectangles, Dilatation::AtPoints, Plane::Stress, 3 * 4 * (2 * 3 + 3)),
        (&hexahedra, Dilatation::Mean, Plane::Strain, 6 * 8 * (2 + 1)),
    ] {
        let rubber = Substance::from(SQUARE_MATERIAL).law(Law::NeoHookean);
        let left = rubber.clone().maxwell(0.7, 1e-3).maxwell(2.0, 0.3);
        let right = rubber.maxwell(1.0, 1e-2);
        let body = Body::new(mesh.clone(), left).dilatation(dilatation).plane(plane);
        eliminates(body, right, (internal, 1e-3), 1e-3);
    }
}

/// A body with another substance on its right.
fn eliminates(body: BodyBuilder, right: Substance, (internal, size): (usize, f64), tolerance: f64) {
    let (d, yields) = (body.own_mesh().dimension(), right.branches[0].yield_stress > 0.0);
    let cells = CellSelection::inside(&[0.15, 0.0, 0.0][..d], &[0.3, 0.2, 0.1][..d]);
    let body = body.region(cells, right).viscosity(Viscosity::Natural);
    let body = if d == 2 { body.thickness(0.01) } else { body };
    let phase = Phase::until(1.0).hold_axes([1, 2], [Axis::Y]).hold_combination([
        (10, Axis::X, 1.0),
        (12, Axis::X, -2.0),
        (11, Axis::X, 0.5),
    ]);
    let scene = Scene::new(body.build().unwrap()).phase(phase);
    let natural = vec![0.0; scene.body().dofs()];
    let start = PhaseStart { time: 0.0, u: &natural };
    let strains: Vec<f64> = noise(internal, 4).iter().map(|g| 0.1 * size * g).collect();
    let system = || first_phase(&scene, &start).unwrap();
    let mut y = state_with(&system(), &strains);
    // small enough that no cell collapses
    y[..natural.len()].iter_mut().for_each(|u| *u *= size);
    // steps that are small compared with the excess over the yield stress
    let step = if yields { 1e-7 } else { 1e-5 };
    solves_by_the_ode_jacobian(system(), &y, step, tolerance);
    for index in [Index::One, Index::Two] {
        solves_by_the_dae_jacobian(DaeForm::new(system(), index), &y, step, tolerance);
    }
}

fn solves_by_the_ode_jacobian(system: System, y: &[f64], step: f64, tolerance: f64) {
    let energies = system.layout().energies();
    let blocks = [energies.start, energies.start + 1, energies.end];
    solves_blocks_by_the_ode_jacobian(system, y, (step, tolerance), &blocks);
}

/// As [`solves_by_the_ode_jacobian`], for displacements, velocities and further `blocks`.
fn solves_blocks_by_the_ode_jacobian(
    mut system: System,
    y: &[f64],
    (step, tolerance): (f64, f64),
    blocks: &[usize],
) {
    let n = system.dofs();
    let mut rhs = |y: &[f64]| {
        let mut ydot = vec![0.0; y.len()];
        system.rhs(0.1, y, &mut ydot).unwrap();
        ydot
    };
    let (jacobian, full) = (derivative(y, step, &mut rhs), rhs(y));
    for gamma in [1e-4, 1e-2] {
        let newton =
            Mat::from_fn(y.len(), y.len(), |i, j| f64::from(i == j) - gamma * jacobian[(i, j)]);
        assert!(system.newton_setup(0.1, y, &full, gamma, false).unwrap());
        let mut known = vec![0.0; y.len()];
        system.newton_rhs(0.1, y, &mut known).unwrap();
        let mut r = noise(y.len(), 2);
        // the accuracy of the energies, which the dense solve limits, goes by these numbers
        r[2 * n..].rotate_left(ENERGIES);
        let mut solved = |sign: f64| {
            let mut x: Vec<f64> =
                (0..y.len()).map(|i| sign * r[i] + gamma * (known[i] - full[i])).collect();
            system.newton_solve(gamma, &mut x).unwrap();
            x
        };
        // the squares in the powers, which the solve includes, cancel out
        let (x, opposite) = (solved(1.0), solved(-1.0));
        let x: Vec<f64> = x.iter().zip(&opposite).map(|(a, b)| 0.5 * (a - b)).collect();
        // The dense solve loses some digits to the condition number of its matrix.
        let blocks = [&[n, 2 * n], blocks].concat();
        assert_close(&x, &solve(&newton, &r), tolerance, &blocks);
    }
}

#[test]
fn structured_solve_is_that_of_the_index_one_jacobian() {
    let mut equations = DaeForm::new(system(), Index::One);
    let n = equations.system.dofs();
    let state = state(&equations.system);
    let (y, yp) = consistent(&mut equations, &state);
    for cj in [100.0, 1e4] {
        let mut jacobian = Mat::<f64>::zeros(y.len(), y.len());
        equations.newton_setup(0.1, cj, &y, &yp).unwrap();
        equations.visit_jacobian(cj, |i, j, value| jacobian[(i, j)] += value);
        let r = noise(y.len(), 3);
        let mut x = r.clone();
        equations.newton_solve(&mut x).unwrap();
        let blocks = [n, 2 * n, 2 * n + ENERGIES, y.len()];
        let expected = solve(&jacobian, &r);
        assert_close(&x[..2 * n], &expected[..2 * n], 1e-9, &blocks[..2]);
        assert_close(&x[blocks[2]..], &expected[blocks[2]..], 1e-9, &[y.len() - blocks[2]]);
    }
}

/// dF/dy, by differences of this `step`, and dF/dy' at t = 0.1.
pub(super) fn residual_derivatives(
    equations: &mut DaeForm,
    y: &[f64],
    yp: &[f64],
    step: f64,
) -> [Mat<f64>; 2] {
    let mut residual = |y: &[f64], yp: &[f64]| {
        let mut residual = vec![0.0; y.len()];
        equations.residual(0.1, y, yp, &mut residual).unwrap();
        residual
    };
    let by_y = derivative(y, step, |y| residual(y, yp));
    [by_y, derivative(yp, 1.0, |yp| residual(y, yp))]
}

#[test]
fn structured_solve_is_that_of_the_index_two_jacobian() {
    let mut equations = DaeForm::new(system(), Index::Two);
    let (n, rows) = (equations.system.dofs(), equations.system.rows.len());
    let state = state(&equations.system);
    for [x, expected] in newton_and_dense(&mut equations, &state, 1e-5) {
        // some digits are lost to the differences
        assert_close(&x, &expected, 1e-6, &[n, 2 * n, 2 * n + rows, x.len()]);
    }
}

/// Solutions of the Newton systems of two steps, structured and dense. Energies, which have their own test and on which nothing
/// depends, are left out.
fn newton_and_dense(equations: &mut DaeForm, state: &[f64], step: f64) -> [[Vec<f64>; 2]; 2] {
    let energies = equations.system.layout().energies();
    let (y, yp) = consistent(equations, state);
    let kept: Vec<usize> = (0..y.len()).filter(|i| !energies.contains(i)).collect();
    let [by_y, by_yp] = residual_derivatives(equations, &y, &yp, step);
    [100.0, 1e4].map(|cj| {
        let entry = |i: usize, j: usize| by_y[(i, j)] + cj * by_yp[(i, j)];
        let jacobian = Mat::from_fn(kept.len(), kept.len(), |i, j| entry(kept[i], kept[j]));
        equations.newton_setup(0.1, cj, &y, &yp).unwrap();
        let r = noise(y.len(), 3);
        let mut x = r.clone();
        equations.newton_solve(&mut x).unwrap();
        let [x, r] = [x, r].map(|all| kept.iter().map(|&i| all[i]).collect::<Vec<_>>());
        [x, solve(&jacobian, &r)]
    })
}

#[test]
fn index_one_jacobian_is_the_derivative_of_the_residual() {
    let mut equations = DaeForm::new(system(), Index::One);
    let n = equations.system.dofs();
    let state = state(&equations.system);
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
            assert!(apart < 1e-6 * (1e3 + expected.abs()), "({i}, {j}): {expected}");
        }
    }
}

#[test]
fn consistent_start_satisfies_the_residual() {
    let mut equations = DaeForm::new(system(), Index::One);
    let state = state(&equations.system);
    let (y, yp) = consistent(&mut equations, &state);
    let mut residual = vec![0.0; y.len()];
    equations.residual(0.1, &y, &yp, &mut residual).unwrap();
    let scale = equations.system.at.total.iter().fold(0.0_f64, |s, f| s.max(f.abs()));
    for (i, r) in residual.iter().enumerate() {
        assert!(r.abs() < 1e-10 * scale, "{i}: {r:e}");
    }
}

/// The accelerations minimise (a - M^-1 f).M (a - M^-1 f) among those the constraints allow (Gauss): the
/// multipliers do no work on allowed changes. The demands of the constraints are met.
#[test]
fn accelerations_meet_the_demands_of_the_constraints() {
    let mut system = system();
    let (n, y) = (system.dofs(), state(&system));
    system.evaluate(0.1, &y[..n], &y[n..2 * n], &[]).unwrap();
    for (row, demand) in system.rows.iter().zip(&system.at.demands) {
        let met = row.apply(&system.at.acceleration);
        assert!((met - demand).abs() < 1e-9 * demand.abs().max(1.0), "{met} {demand}");
    }
}

#[test]
fn projection_changes_velocities_to_allowed_ones_only() {
    let mut system = system();
    let n = system.dofs();
    let (u, mut v) = (vec![0.0; n], noise(n, 5));
    system.project(0.1, &u, &mut v);
    for row in &system.rows {
        assert!((row.apply(&v) - row.prescribed(0.1).velocity).abs() < 1e-12);
    }
    let once = v.clone();
    system.project(0.1, &u, &mut v);
    assert_close(&v, &once, 1e-12, &[n]);
}

#[test]
fn a_row_that_follows_from_others_is_named() {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
    let phase = Phase::until(1.0)
        .named("pull")
        .hold_combination([(6, Axis::X, 1.0), (7, Axis::X, 1.0)])
        .hold_combination([(6, Axis::X, 2.0), (7, Axis::X, 2.0), (1, Axis::X, 3.0)])
        .hold([1]);
    let scene = Scene::new(body).phase(phase);
    let natural = vec![0.0; 32];
    let start = PhaseStart { time: 0.0, u: &natural };
    let Err(error) = first_phase(&scene, &start) else { panic!("accepted") };
    let message = error.to_string();
    assert!(message.contains("pull") && message.contains("node 6 x + node 7 x"), "{message}");
    assert!(message.contains("follows from the other constraints"), "{message}");
}

/// Two rooms of gas within a body, with an orifice between them, from a supply and into the open, one full of a light liquid that is pumped in, and one half full, with pipes between
/// them and from a supply.
fn with_gas() -> System {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(1.0).build().unwrap();
    let phase = Phase::until(1.0)
        .hold_axes([1, 2], [Axis::Y])
        .hold_combination([(10, Axis::X, 1.0), (12, Axis::X, -2.0), (11, Axis::X, 0.5)])
        .open("out", 0.5)
        .flow("c", 1e-3);
    let scene = Scene::new(body)
        .chamber(Chamber::within("a", [1, 2, 6, 5]))
        .chamber(Chamber::within("b", [3, 4, 12, 11]))
        .chamber(Chamber::within("c", [6, 7, 11, 10]))
        .gravity([3.0, -9.0])
        .chamber(Chamber::within("d", [2, 3, 7, 6]))
        .liquid(Liquid::in_chamber("c").bulk_modulus(3e5).density(50.0))
        .liquid(Liquid::in_chamber("d").density(50.0).fill(0.5).surface())
        .pipe(Pipe::new("flat", "c", "d", 0.3, 1e-3).viscosity(0.02).loss(0.7))
        .pipe(Pipe::new("fed", "pump", "c", 0.2, 2e-3).loss(1.2))
        .gas(Gas::in_chamber("a").pressure(1.3e5).exponent(1.4))
        .gas(Gas::in_chamber("b").pressure(2.0e5).exponent(1.1))
        .supply("pump", 4e5)
        .orifice(Orifice::new("in", "pump", "a", 1e-5))
        .orifice(Orifice::new("between", "a", "b", 2e-5).critical_ratio(0.3))
        .orifice(Orifice::new("out", "b", "atmosphere", 3e-5))
        .phase(phase);
    let natural = vec![0.0; scene.body().dofs()];
    first_phase(&scene, &PhaseStart { time: 0.0, u: &natural }).unwrap()
}

fn state_with_gas(system: &System) -> Vec<f64> {
    // flows are 0 at the start
    let filled = |amount: &f64| if *amount == 0.0 { 0.02 } else { 1.1 * amount };
    let mut y = state_with(system, &system.amounts().iter().map(filled).collect::<Vec<_>>());
    y[..system.dofs()].iter_mut().for_each(|u| *u *= 0.2);
    y
}

/// Pressures that the tangents of the walls lack, and flows that follow them.
#[test]
fn amounts_of_gas_are_eliminated() {
    let y = state_with_gas(&with_gas());
    solves_by_the_ode_jacobian(with_gas(), &y, 1e-5, 1e-6);
    for index in [Index::One, Index::Two] {
        solves_by_the_dae_jacobian(DaeForm::new(with_gas(), index), &y, 1e-5, 1e-5);
    }
}

/// Of index 2 all but the second multipliers.
fn solves_by_the_dae_jacobian(mut equations: DaeForm, state: &[f64], step: f64, tolerance: f64) {
    let (n, first_multiplier) = (equations.system.dofs(), equations.system.layout().internal().end);
    let rows = first_multiplier + equations.system.rows.len();
    for [x, expected] in newton_and_dense(&mut equations, state, step) {
        let blocks = [n, 2 * n, first_multiplier, rows];
        assert_close(&x[..rows], &expected[..rows], tolerance, &blocks);
    }
}
