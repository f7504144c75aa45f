//! Linear bodies that nothing holds, under loads that balance each other.
//! Those with Green's strain: `free_green.rs`.

use pliant::{
    Axis, Body, Cells, Equilibrium, Mesh, Phase, Scene, SolidCells, Stability, Statics, Strain,
};

use super::{RUBBER, solve};

fn square() -> Body {
    let mesh = Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Triangles).unwrap();
    Body::new(mesh, RUBBER).strain(Strain::Cauchy).thickness(0.01).build().unwrap()
}

fn block() -> Body {
    let mesh = Mesh::cuboid([0.1, 0.2, 0.3], [2, 3, 3], SolidCells::Hexahedra).unwrap();
    Body::new(mesh, RUBBER).strain(Strain::Cauchy).build().unwrap()
}

/// Products (x_i - x_j) . (u_i - u_j) over all pairs of nodes: how distances change, which no small rigid motion does.
fn stretches(rest: &Equilibrium) -> Vec<f64> {
    let mesh = rest.trajectory().body().mesh();
    let (d, u) = (mesh.dimension(), rest.displacements());
    let pairs = (0..mesh.node_count()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let stretch = |(i, j): (usize, usize)| {
        let along =
            |k: usize| (mesh.position(i)[k] - mesh.position(j)[k]) * (u[d * i + k] - u[d * j + k]);
        (0..d).map(along).sum()
    };
    pairs.map(stretch).collect()
}

/// The free body against itself held so that nothing strains it: `loads` are those of both.
#[track_caller]
fn is_the_held_one(free: &Equilibrium, held: &Equilibrium, removed: &[&str]) {
    assert_eq!(free.removed, removed);
    assert!(held.removed.is_empty());
    assert_eq!(free.stability, Stability::Neutral);
    removed.iter().for_each(|motion| assert!(free.to_string().contains(motion), "{free}"));
    let [free_energy, held_energy] = [free, held].map(|rest| rest.sample().energy.strain);
    assert!(held_energy > 1e-5);
    // residuals of 1e-10, squared, and round-off
    assert!((free_energy / held_energy - 1.0).abs() < 1e-11, "{free_energy} {held_energy}");
    let (a, b) = (stretches(free), stretches(held));
    let scale = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-9 * scale, "{a} {b}, of {scale}");
    }
}

/// Neither the centre of mass nor the angle has moved: M u has no momentum.
#[track_caller]
fn has_not_moved(rest: &Equilibrium) {
    let trajectory = rest.trajectory();
    let mut sample = rest.sample().clone();
    sample.v = std::mem::replace(&mut sample.u, vec![0.0; rest.displacements().len()]);
    let most = sample.v.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let mass = trajectory.body().mass();
    for (momentum, arm) in
        [(trajectory.momentum(&sample), 1.0), (trajectory.angular_momentum(&sample), 0.3)]
    {
        momentum.iter().for_each(|p| assert!(p.abs() < 1e-13 * mass * arm * most, "{p}"));
    }
}

#[test]
fn a_free_square_is_deformed_as_a_held_one() {
    // two couples, and a pull: no resultant, though no two forces are opposite
    let loaded = |phase: Phase| {
        let phase = phase.load([1], [-3.0, 0.0]).load([9], [-3.0, 0.0]).load([8], [6.0, 0.0]);
        let phase = phase.load([2], [0.0, -2.0]).load([3], [0.0, 2.0]);
        Scene::new(square()).phase(phase.load([9], [0.0, 1.0]).load([11], [0.0, -1.0]))
    };
    let held = solve(&loaded(Phase::until(1.0).hold([1]).hold_axes([4], [Axis::Y])));
    let scene = loaded(Phase::until(1.0));
    // about the middle: -2 * 0.1 + 2 * 0.2 + 1 * 0 - 1 * 0.2 = 0
    let free = solve(&scene);
    let motions =
        ["moving along (1, 0)", "moving along (0, 1)", "turning about the point (0.15, 0.1)"];
    is_the_held_one(&free, &held, &[motions[2], motions[1], motions[0]]);
    has_not_moved(&free);
    // without a held node there is nothing to carry a force
    assert!(free.sample().multipliers.is_empty());
    // one direction held
    let rails = solve(&loaded(Phase::until(1.0).hold_axes([1, 4], [Axis::Y])));
    is_the_held_one(&rails, &held, &[motions[0]]);
}

#[test]
fn a_free_block_is_twisted_as_a_held_one() {
    let twisted = |phase: Phase| {
        // couples about the axis z on its ends, nodes 1 and 2 below, 13 and 14 on top
        let phase = phase.load([1], [0.0, 5.0, 0.0]).load([2], [0.0, -5.0, 0.0]);
        Scene::new(block()).phase(phase.load([13], [0.0, -5.0, 0.0]).load([14], [0.0, 5.0, 0.0]))
    };
    let held =
        Phase::until(1.0).hold([1]).hold_axes([2], [Axis::Y, Axis::Z]).hold_axes([5], [Axis::Z]);
    let free = solve(&twisted(Phase::until(1.0)));
    assert_eq!(free.removed.len(), 6);
    let removed: Vec<String> = free.removed.clone();
    let removed: Vec<&str> = removed.iter().map(|motion| &**motion).collect();
    is_the_held_one(&free, &solve(&twisted(held)), &removed);
    has_not_moved(&free);
}

#[test]
fn what_loads_leave_is_told() {
    let told = |phase: Phase| {
        let scene = Scene::new(square()).phase(phase);
        scene.equilibrium(&Statics::default()).unwrap_err().to_string()
    };
    let pushed = told(Phase::until(1.0).load([1], [0.5, 0.0]).load([12], [0.0, -0.25]));
    assert!(pushed.contains("= leaving the body free for "), "{pushed}");
    assert!(pushed.contains("balance the loads"), "{pushed}");
    // of the motions the turn comes first: 0.5 N at y = -0.1 and -0.25 N at x = 0.15 about the middle
    assert!(pushed.contains("loads leave a moment of 1.250e-2 N m for turning"), "{pushed}");
    let shifted = told(Phase::until(1.0).load_total([1, 4, 9, 12], [0.0, -0.3]));
    assert!(
        shifted.contains("loads leave a force of -3.000e-1 N for moving along (0, 1)"),
        "{shifted}"
    );
}
