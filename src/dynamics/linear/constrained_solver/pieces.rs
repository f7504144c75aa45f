//! Tests of systems with many rigid pieces: by their rigid motions, against one by one.

use super::{ConstrainedSolver, Coupling, EXACT, Edges, EntrySource};
use crate::base::vector::largest;
use crate::dynamics::linear::stabilized;
use crate::dynamics::matrices::Matrices;
use crate::mesh::CellKind;
use crate::scene::constraint::{Axis, ConstraintRow, PhaseStart};
use crate::{Body, Material, Mesh, Phase, Scene};

const PIECES: usize = 9;

/// Pieces in a row, a gap of half their size apart.
fn row_of_pieces(dimension: usize, phase: Phase) -> Scene {
    let corners: &[[f64; 3]] = match dimension {
        2 => &[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.08, 0.0], [0.0, 0.08, 0.0]],
        _ => &[
            [0.0, 0.0, 0.0],
            [0.1, 0.0, 0.0],
            [0.1, 0.08, 0.0],
            [0.0, 0.08, 0.0],
            [0.0, 0.0, 0.07],
            [0.1, 0.0, 0.07],
            [0.1, 0.08, 0.07],
            [0.0, 0.08, 0.07],
        ],
    };
    let kind = if dimension == 2 { CellKind::Quadrilateral } else { CellKind::Hexahedron };
    let mut positions = Vec::new();
    for piece in 0..PIECES {
        for corner in corners {
            let along = corner[0] + 0.15 * piece as f64;
            positions.extend([along, corner[1], corner[2]].iter().take(dimension));
        }
    }
    let cells = (0..PIECES * corners.len()).collect();
    let mesh = Mesh::new(dimension, positions, kind, cells).unwrap();
    let body = Body::new(mesh, Material::rigid(1000.0));
    let body = if dimension == 2 { body.thickness(0.01) } else { body };
    Scene::new(body.build().unwrap()).phase(phase)
}

fn wave(length: usize, seed: f64) -> Vec<f64> {
    (0..length).map(|i| (12.9898 * (i as f64 + seed)).sin()).collect()
}

/// Edges that the rows do not imply.
fn edges_of(matrices: &Matrices, rows: &[ConstraintRow], dimension: usize) -> Edges {
    let edges = Edges::new(matrices.rigid.as_deref(), &matrices.positions, dimension);
    let mut inertia = ConstrainedSolver::new(matrices, rows, &edges, Coupling::SameAxis);
    inertia.begin(EXACT, |source| matrices.inertia.values[source.entry()]).unwrap();
    let is_kept = inertia.edges.as_mut().unwrap().independent(&edges);
    edges.retained(&is_kept)
}

/// Solutions with M and stiff springs between the pieces, of the step parameter 1 ms, in which pieces turn by 0.05 rad. Where refinement continues to 1e-11, motions
/// agree to about that (7e-12 was measured), and multipliers, as forces of springs of 1e4 times the masses, to 1e4 times as much (1e-8). Where they
/// end at 1e-5, as for Newton's iteration, that is what motions have.
#[test]
fn many_pieces_are_solved_as_each_by_itself() {
    let tied =
        Phase::until(1.0).hold([1]).hold_combination([(7, Axis::X, 1.0), (10, Axis::X, -1.0)]);
    let hinged = |axes: &[Axis], [a, b]: [usize; 2]| {
        let tied =
            |phase: Phase, &axis: &Axis| phase.hold_combination([(a, axis, 1.0), (b, axis, -1.0)]);
        axes.iter().fold(Phase::until(1.0), tied)
    };
    let plane = hinged(&[Axis::X, Axis::Y], [3, 5]);
    let space = hinged(&[Axis::X, Axis::Y, Axis::Z], [6, 11]);
    let mut counts = Vec::new();
    for (dimension, phase) in
        [(2, Phase::until(1.0)), (3, Phase::until(1.0)), (2, tied), (2, plane), (3, space)]
    {
        let scene = row_of_pieces(dimension, phase);
        let forces = scene.forces().unwrap();
        let matrices = scene.matrices(&forces);
        let (nodes, n) = (scene.body().mesh().node_count() / PIECES, scene.body().dofs());
        // the nodes 1 and 3 of a piece with the nodes 0 and 2 of the next
        let pairs: Vec<[usize; 2]> = (1..PIECES)
            .flat_map(|piece| {
                [(1, 0), (3, 2)].map(|(a, b)| [nodes * (piece - 1) + a, nodes * piece + b])
            })
            .collect();
        let matrices = matrices.with_pairs(&pairs);
        let natural = vec![0.0; n];
        let start = PhaseStart { time: 0.0, u: &natural };
        let rows = scene.rows(&scene.phases()[0], &start).unwrap();
        let mut edges = edges_of(&matrices, &rows, dimension);
        counts.push(edges.list.len());

        let [alpha, gamma] = [100.0, 1e-3];
        let u: Vec<f64> = wave(n, 0.1).iter().map(|x| 1e-3 * x).collect();
        let v: Vec<f64> = wave(n, 0.2).iter().map(|x| 4.0 * x).collect();
        edges.move_to(alpha, &u, &v);
        edges.accelerate(&wave(n, 0.4).iter().map(|x| 500.0 * x).collect::<Vec<_>>());

        let normal = [0.6, 0.8, 0.3];
        let springs = |a: usize, b: usize| {
            let of = |pair: &&[usize; 2]| a == b && pair.contains(&a);
            let own = pairs.iter().filter(of).count() as f64;
            let across = pairs.contains(&[a, b]) || pairs.contains(&[b, a]);
            if across { -1.0 } else { own }
        };
        let pattern = matrices.pattern().clone();
        let ends: Vec<[usize; 2]> = (0..pattern.nodes())
            .flat_map(|row| {
                pattern.row(row).map(move |(_, column)| [row, column]).collect::<Vec<_>>()
            })
            .collect();
        let stiffness = 1e4 * matrices.inertia.get(0, 0);
        let value = |source: EntrySource| {
            let ([i, j], [a, b]) = (source.axes(), ends[source.entry()]);
            let mass = if i == j { matrices.inertia.values[source.entry()] } else { 0.0 };
            mass + stiffness * springs(a, b) * normal[i] * normal[j]
        };
        let (f, d) = (wave(n, 0.3), wave(rows.len(), 0.7));
        let solve = |by_motions: bool, accuracy: f64| {
            let mut solver = ConstrainedSolver::with_motions(
                &matrices,
                &rows,
                &edges,
                Coupling::AllAxes,
                by_motions,
            );
            solver.begin(accuracy, value).unwrap();
            let of_edges = solver.edges.as_mut().unwrap();
            of_edges.turn(&edges, Some(stabilized(gamma, alpha)));
            of_edges.demands = wave(edges.list.len(), 0.9);
            let (mut x, mut mu) = (vec![0.0; n], vec![0.0; rows.len()]);
            solver.solve(&rows, &f, &d, &mut x, &mut mu);
            (x, mu, solver.edges.unwrap().multipliers)
        };
        let (x, mu, multipliers) = solve(false, EXACT);
        for (accuracy, tolerances) in [(1e-11, [1e-10, 1e-7, 1e-7]), (1e-5, [1e-4, 1.0, 1.0])] {
            let found = solve(true, accuracy);
            let found = [(found.0, &x), (found.1, &mu), (found.2, &multipliers)];
            for ((found, expected), tolerance) in found.into_iter().zip(tolerances) {
                let apart = found.iter().zip(expected).map(|(x, y)| (x - y).abs());
                let (apart, scale) = (apart.fold(0.0, f64::max), largest(expected));
                println!("{dimension} {} rows: {accuracy:e} {apart:e} of {scale:e}", rows.len());
                assert!(apart <= tolerance * scale && found.iter().all(|x| x.is_finite()));
            }
        }
    }
    // three edges in the plane, six in space for each piece, without those that a held node and ties imply
    assert_eq!(counts[..2], [3 * PIECES, 6 * PIECES]);
    assert!(counts[3] <= 3 * PIECES && counts[4] <= 6 * PIECES, "{counts:?}");
}
