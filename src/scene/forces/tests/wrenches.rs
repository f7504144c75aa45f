//! Moments and followers on nodes: sums, power and tangents.

use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{check, nodal_forces, noise};
use crate::elements::body::Body;
use crate::elements::force::Force;
use crate::elements::mesh::{Cells, Mesh, SolidCells};
use crate::scene::forces::{VectorSignal, WrenchForce, WrenchKind};
use crate::studies::samples::SQUARE_MATERIAL;

const KINDS: [WrenchKind; 3] =
    [WrenchKind::Moment, WrenchKind::FollowerForce, WrenchKind::FollowerMoment];

fn bodies() -> [Body; 2] {
    let plane = Mesh::rectangle([0.1, 0.2], [2, 3], Cells::Triangles6).unwrap();
    let solid = Mesh::cuboid([0.1, 0.2, 0.3], [2, 2, 2], SolidCells::Hexahedra20).unwrap();
    [
        Body::new(plane, SQUARE_MATERIAL).thickness(0.01).build().unwrap(),
        Body::new(solid, SQUARE_MATERIAL).build().unwrap(),
    ]
}

fn wrench(body: &Body, kind: WrenchKind) -> (Arc<dyn Force>, Vec<f64>) {
    let value = [0.4, -0.7, 0.9][..kind.rank(body.dimension())].to_vec();
    let signal = VectorSignal::Constant(value.clone());
    (WrenchForce::build(body, kind, &"right".into(), &signal).unwrap(), value)
}

/// The position (m) or force (N) of a node.
fn at(all: &[f64], node: usize, d: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i < d { all[node * d + i] } else { 0.0 })
}

/// Displacements (m) by a rotation about an axis.
fn turned(body: &Body, turn: &Matrix3<f64>) -> Vec<f64> {
    let (d, x) = (body.dimension(), body.mesh().positions());
    let node = |n| turn * at(x, n, d) - at(x, n, d);
    (0..body.mesh().node_count())
        .flat_map(|n| node(n).iter().copied().take(d).collect::<Vec<_>>())
        .collect()
}

/// In any shape a moment makes no sum of forces, and its own moment about any point; its tangent is exact.
#[test]
fn moments() {
    for body in bodies() {
        let (d, cells) = (body.dimension(), body.mesh().cells().collect::<Vec<&[usize]>>());
        let (moment, value) = wrench(&body, WrenchKind::Moment);
        let (u, v) = (noise(body.dofs(), 0.02, 1.0), noise(body.dofs(), 1.0, 2.0));
        let stiffest = check(&*moment, (d, &cells), 0.3, &u, &v, 1e-7);
        assert!(stiffest > 1.0, "{stiffest}");
        let forces = nodal_forces(&*moment, 0.3, &u, &v).applied;
        let (mut sum, mut about) = (Vector3::zeros(), Vector3::zeros());
        for node in 0..body.mesh().node_count() {
            let (f, x) =
                (at(&forces, node, d), at(body.mesh().positions(), node, d) + at(&u, node, d));
            sum += f;
            about += x.cross(&f);
        }
        let expected =
            if d == 2 { Vector3::new(0.0, 0.0, value[0]) } else { Vector3::from_row_slice(&value) };
        assert!(sum.norm() < 1e-12, "{sum}");
        assert!((about - expected).norm() < 1e-13, "{about}");
    }
}

/// Followers turn with the body, and their tangents are exact, where the nodes have moved as a rigid body and where they are strained.
#[test]
fn followers() {
    for body in bodies() {
        let (d, cells) = (body.dimension(), body.mesh().cells().collect::<Vec<&[usize]>>());
        let axis = if d == 2 { Vector3::z() } else { Vector3::new(0.3, -0.5, 0.8) };
        let turn = Rotation3::new(axis * 0.9).into_inner();
        let (rest, moved) = (vec![0.0; body.dofs()], turned(&body, &turn));
        for kind in KINDS {
            let (follower, _) = wrench(&body, kind);
            let [before, after] =
                [&rest, &moved].map(|u| nodal_forces(&*follower, 0.3, u, &rest).applied);
            let follows = if kind == WrenchKind::Moment { Matrix3::identity() } else { turn };
            let sum = |forces: &[f64]| {
                (0..body.mesh().node_count()).map(|n| at(forces, n, d)).sum::<Vector3<f64>>()
            };
            assert!((follows * sum(&before) - sum(&after)).norm() < 1e-14);
            let is_turned = (0..body.mesh().node_count())
                .all(|n| (turn * at(&before, n, d) - at(&after, n, d)).norm() < 1e-13);
            // in the plane a moment is the same for all rotations
            assert_eq!(is_turned, kind != WrenchKind::Moment || d == 2, "{kind:?}");
            let noise = noise(moved.len(), 0.05 * body.size(), 1.0);
            let strained: Vec<f64> = moved.iter().zip(noise).map(|(u, noise)| u + noise).collect();
            for u in [&moved, &strained] {
                check(&*follower, (d, &cells), 0.3, u, &rest, 1e-7);
            }
        }
    }
}

/// Nodes that do not turn are refused, with the number of components that a value needs.
#[test]
fn nodes_that_do_not_turn() {
    let [plane, solid] = bodies();
    let say = |body: &Body, kind, nodes: &[usize], value: &[f64]| {
        let signal = VectorSignal::Constant(value.to_vec());
        let nodes = nodes.to_vec().into();
        WrenchForce::build(body, kind, &nodes, &signal).map(|_| ()).unwrap_err().to_string()
    };
    let one = say(&plane, WrenchKind::Moment, &[1], &[1.0]);
    assert!(one.contains("one point"), "{one}");
    let line = say(&solid, WrenchKind::FollowerForce, &[1, 2], &[1.0, 0.0, 0.0]);
    assert!(line.contains("one line"), "{line}");
    let count = say(&plane, WrenchKind::Moment, &[1, 2], &[1.0, 0.0]);
    assert!(count.contains("1 component"), "{count}");
}
