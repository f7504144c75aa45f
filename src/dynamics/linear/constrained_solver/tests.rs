//! Tests of the reduced solves against dense ones of the whole saddle-point system.

use faer::Mat;
use faer::prelude::Solve;

use super::{ConstrainedSolver, Coupling, EXACT, Edges, EntrySource, nodal_multipliers};
use crate::scene::constraint::{Axis, ConstraintRow, PhaseStart};
use crate::studies::samples::SQUARE_MATERIAL;
use crate::{Body, Cells, Inertia, Mesh, Phase, Scene, Strain};

/// Two pieces of 3 x 3 nodes each that nothing joins.
fn scene(inertia: Inertia, phase: Phase) -> Scene {
    let square = Mesh::rectangle([0.2, 0.1], [3, 3], Cells::Triangles).unwrap();
    let mut positions = square.positions().to_vec();
    positions.extend(square.positions().iter().map(|x| x + 0.5));
    let cells: Vec<usize> = square.cells().flatten().copied().collect();
    let cells = cells.iter().copied().chain(cells.iter().map(|node| node + 9)).collect();
    let mesh = Mesh::new(2, positions, square.kind(), cells).unwrap();
    let body =
        Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).inertia(inertia);
    Scene::new(body.build().unwrap()).phase(phase)
}

/// Nodal and general rows in both pieces and across them; some terms of the general ones are held.
fn tied() -> Phase {
    Phase::until(1.0)
        .hold([1, 2])
        .hold_axes([12], [Axis::X])
        .hold_combination([(2, Axis::X, 3.0), (9, Axis::X, 1.0), (14, Axis::Y, -2.0)])
        .hold_combination([(12, Axis::X, 1.0), (5, Axis::Y, 0.5)])
        .hold_combination([(16, Axis::X, 1.0), (16, Axis::Y, 1.0)])
}

fn wave(length: usize, seed: f64) -> Vec<f64> {
    (0..length).map(|i| (12.9898 * (i as f64 + seed)).sin()).collect()
}

/// Compares solutions with X = `mass` M + `stiffness` K by the reduced solver and by a dense one, for some f
/// and d. Returns whether X was positive definite.
fn compare(scene: &Scene, coupling: Coupling, [mass, stiffness]: [f64; 2]) -> bool {
    let forces = scene.forces().unwrap();
    let matrices = scene.matrices(&forces);
    let (body, n) = (scene.body(), scene.body().dofs());
    let natural = vec![0.0; n];
    let rows: Vec<ConstraintRow> =
        scene.rows(&scene.phases()[0], &PhaseStart { time: 0.0, u: &natural }).unwrap();
    let mut reduced = ConstrainedSolver::new(&matrices, &rows, &Edges::default(), coupling);
    let value = |source: EntrySource| {
        let (entry, transposed, axes) = (source.entry(), source.transposed(), source.axes());
        let own = if axes[0] == axes[1] { mass * matrices.inertia.values[entry] } else { 0.0 };
        match stiffness {
            0.0 => own,
            factor => own + factor * body.stiffness().symmetric(entry, transposed, axes),
        }
    };
    let is_definite = reduced.factorize(value).is_ok();
    if !is_definite {
        assert!(reduced.factorize_indefinite().is_ok());
    }
    let x_matrix = |i: usize, j: usize| {
        let same = if i % 2 == j % 2 { mass * matrices.inertia.get(i / 2, j / 2) } else { 0.0 };
        same + stiffness * body.stiffness().get(i, j)
    };
    let a = |i: usize, k: usize| {
        rows[k].terms.iter().filter(|term| term.0 == i).map(|term| term.1).sum::<f64>()
    };
    let dense = Mat::from_fn(n + rows.len(), n + rows.len(), |i, j| match (i < n, j < n) {
        (true, true) => x_matrix(i, j),
        (true, false) => -a(i, j - n),
        (false, true) => a(j, i - n),
        (false, false) => 0.0,
    });
    let (f, d) = (wave(n, 0.3), wave(rows.len(), 0.7));
    let right = Mat::from_fn(n + rows.len(), 1, |i, _| if i < n { f[i] } else { d[i - n] });
    let exact = dense.partial_piv_lu().solve(&right);
    let check = |reduced: &mut ConstrainedSolver, tolerance: f64| {
        let (mut x, mut mu) = (vec![0.0; n], vec![0.0; rows.len()]);
        reduced.solve(&rows, &f, &d, &mut x, &mut mu);
        nodal_multipliers(&rows, &mut mu, |dof| {
            (0..n).map(|j| x_matrix(dof, j) * x[j]).sum::<f64>() - f[dof]
        });
        for (found, from, to) in [(&x, 0, n), (&mu, n, n + rows.len())] {
            let scale = (from..to).map(|i| exact[(i, 0)].abs()).fold(0.0, f64::max);
            for (i, found) in (from..to).zip(found) {
                let apart = (found - exact[(i, 0)]).abs();
                assert!(apart <= tolerance * scale, "{i}: {found} {} ({scale:e})", exact[(i, 0)]);
            }
        }
    };
    // round-off times the condition number of X, 1e4 at most
    check(&mut reduced, 1e-11);

    // and by iterations, in place of a factor or before it
    for iterations in [1e4, 2.0] {
        let new = ConstrainedSolver::new(&matrices, &rows, &Edges::default(), coupling);
        let mut iterating = new.rent(&matrices, &rows, coupling, iterations);
        for _ in 0..2 {
            if iterating.begin(EXACT, value).is_err() {
                assert!(!is_definite && iterating.factorize_indefinite().is_ok());
            }
            check(&mut iterating, 1e-10);
            check(&mut iterating, 1e-10);
        }
        let [spared, found, indefinite] = iterating.counts();
        assert_eq!(indefinite == 0, is_definite);
        let least = if is_definite && iterations > 2.0 { 2 } else { 0 };
        assert!(spared >= least && (found <= 4 || iterations > 2.0), "{spared} {found}");
    }
    is_definite
}

#[test]
fn each_coupling_is_that_of_its_matrix() {
    for phase in [tied(), Phase::until(1.0), Phase::until(1.0).hold([1, 5, 10])] {
        let consistent = scene(Inertia::Consistent, phase.clone());
        assert!(compare(&consistent, Coupling::SameAxis, [1.0, 0.0]));
        assert!(compare(&consistent, Coupling::AllAxes, [1.0, 1e-4]));
        let lumped = scene(Inertia::Lumped, phase);
        assert!(compare(&lumped, Coupling::Diagonal, [1.0, 0.0]));
        assert!(compare(&lumped, Coupling::SameAxis, [1.0, 0.0]));
        assert!(compare(&lumped, Coupling::AllAxes, [1.0, 1e-4]));
    }
}

/// M - s K has eigenvalues of both signs, and so has the Schur complement of general rows.
#[test]
fn what_is_not_definite_is_solved_all_the_same() {
    for phase in [tied(), Phase::until(1.0).hold([1, 5, 10])] {
        let held = scene(Inertia::Consistent, phase);
        assert!(!compare(&held, Coupling::AllAxes, [1.0, -1e-5]));
    }
}

/// Where everything is held nothing is left to factorize, and the multipliers are X d - f.
#[test]
fn all_may_be_held() {
    let held = scene(Inertia::Consistent, Phase::until(1.0).hold("all"));
    assert!(compare(&held, Coupling::AllAxes, [1.0, 1e-4]));
}

/// A row that follows from the others is reported by its number, however it is hidden.
#[test]
fn rows_that_follow_from_others_are_found() {
    let twice = |factor: f64| [(14, Axis::X, factor), (15, Axis::Y, 2.0 * factor)];
    for (phase, expected) in [
        (Phase::until(1.0).hold_combination(twice(1.0)).hold_combination(twice(3.0)), 1),
        (tied().hold_combination([(5, Axis::Y, 7.0), (12, Axis::X, -1.0)]), 8),
    ] {
        let scene = scene(Inertia::Consistent, phase);
        let forces = scene.forces().unwrap();
        let matrices = scene.matrices(&forces);
        let natural = vec![0.0; scene.body().dofs()];
        let start = PhaseStart { time: 0.0, u: &natural };
        let rows = scene.rows(&scene.phases()[0], &start).unwrap();
        let mut reduced =
            ConstrainedSolver::new(&matrices, &rows, &Edges::default(), Coupling::SameAxis);
        assert!(reduced.factorize(|source| matrices.inertia.values[source.entry()]).is_err());
        assert_eq!(reduced.dependent_row(), Some(expected));
    }
}

/// An indefinite matrix with a positive diagonal is detected by the iterations.
#[test]
fn iterations_meet_directions_of_negative_curvature() {
    let held = scene(Inertia::Consistent, Phase::until(1.0).hold([1, 5, 10]));
    let forces = held.forces().unwrap();
    let matrices = held.matrices(&forces);
    let natural = vec![0.0; held.body().dofs()];
    let start = PhaseStart { time: 0.0, u: &natural };
    let rows = held.rows(&held.phases()[0], &start).unwrap();
    // K minus a part of its diagonal: modes softer than that part get negative eigenvalues
    let value = |source: EntrySource| {
        let (entry, transposed, axes) = (source.entry(), source.transposed(), source.axes());
        let k = held.body().stiffness().symmetric(entry, transposed, axes);
        if entry == transposed && axes[0] == axes[1] { 0.7 * k } else { k }
    };
    let solution = |mut solver: ConstrainedSolver| {
        let f = wave(natural.len(), 0.3);
        let (mut x, mut mu) = (natural.clone(), vec![0.0; rows.len()]);
        solver.solve(&rows, &f, &vec![0.0; rows.len()], &mut x, &mut mu);
        (x, solver.counts())
    };
    let mut direct = ConstrainedSolver::new(&matrices, &rows, &Edges::default(), Coupling::AllAxes);
    assert!(direct.factorize(value).is_err());
    direct.factorize_indefinite().unwrap();
    let mut iterating = ConstrainedSolver::new(
        &matrices,
        &rows,
        &Edges::default(),
        Coupling::AllAxes,
    )
    .rent(&matrices, &rows, Coupling::AllAxes, 1e4);
    iterating.begin(1e-6, value).unwrap();
    let ((direct, _), (found, counts)) = (solution(direct), solution(iterating));
    assert_eq!(direct, found, "LU of the same matrix");
    assert_eq!((counts[0], counts[2]), (0, 1));
    assert!(counts[1] > 0);
}
