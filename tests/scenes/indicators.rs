//! What indicators measure on a motion beyond warnings, where it is known in closed form, on both sides of their limits.

use std::f64::consts::{LN_2, PI};

use pliant::mesh::CellKind;
use pliant::{
    Axis, Body, Cells, Indicator, Material, Mesh, Obstacle, Phase, Plane, Sampling, Scene,
    Settings, SolidCells, Statics, Strain, Trajectory,
    Verdict::{self, Doubtful, Fine, MoreThanNeeded},
};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.0, viscosity: 0.0 };

fn rectangle(size: [f64; 2], nodes: [usize; 2], cells: Cells, strain: Strain) -> Body {
    let mesh = Mesh::rectangle(size, nodes, cells).unwrap();
    Body::new(mesh, SOFT).plane(Plane::Stress).thickness(0.01).strain(strain).build().unwrap()
}

fn bar(cells: usize, strain: Strain, material: Material) -> Body {
    let mesh = Mesh::bar(0.1, cells + 1).unwrap();
    Body::new(mesh, material).area(1e-4).strain(strain).build().unwrap()
}

fn run(scene: &Scene, step: f64) -> Trajectory {
    let settings = Settings { rtol: 1e-6, ..Settings::default() };
    scene.simulate(&settings, &Sampling::every(step)).unwrap()
}

/// The state that a body starts in, which has no time to move.
fn started(body: Body, displacement: impl Fn(&[f64]) -> Vec<f64>) -> Trajectory {
    run(&Scene::new(body).initial_displacement(displacement).phase(Phase::until(1e-8)), 1.0)
}

fn rest(scene: &Scene) -> Trajectory {
    scene.equilibrium(&Statics::default()).unwrap().trajectory().clone()
}

fn find(motion: &Trajectory, name: &str) -> Option<Indicator> {
    motion.indicators().into_iter().find(|indicator| indicator.name == name)
}

#[track_caller]
fn is(motion: &Trajectory, name: &str, value: f64, tolerance: f64, verdict: Verdict) {
    let found = find(motion, name).unwrap_or_else(|| panic!("no {name}"));
    let off = (found.value - value).abs();
    assert!(off <= tolerance * value.abs(), "{name}: {} for {value}", found.value);
    assert_eq!(found.verdict, verdict, "{found}");
}

/// A bar that is stretched by e. St. Venant and Kirchhoff's stress is E (1 + e)(e + e^2 / 2), that of incompressible
/// neo-Hookean rubber E (l - 1 / l^2) / 3 with l = 1 + e: they differ by 2.5 e of Hooke's E e, which differs from rubber's by e.
#[test]
fn strain_and_what_the_law_makes_of_it() {
    let stretched = |strain, e: f64| {
        let pull = Phase::until(1.0).hold("left").move_axis("right", Axis::X, 0.1 * e);
        rest(&Scene::new(bar(4, strain, SOFT)).phase(pull))
    };
    let stress = |strain, e: f64| {
        let motion = stretched(strain, e);
        motion.constraint_force(motion.last(), "right").unwrap()[0] / (1e-4 * SOFT.young)
    };
    let rubber = |e: f64| ((1.0 + e) - (1.0 + e).powi(-2)) / 3.0;
    for (strain, factor, limit) in [(Strain::Green, 2.5, 0.1), (Strain::Cauchy, 1.0, 0.25)] {
        for e in [0.001, -0.001] {
            let off = (stress(strain, e) - rubber(e)) / (e * e);
            assert!((off - factor).abs() < 0.002, "{strain:?}: {off} times the strain");
        }
        for e in [0.99 * limit, -0.99 * limit] {
            is(&stretched(strain, e), "strain", e.abs(), 1e-9, Fine);
        }
        is(&stretched(strain, 1.01 * limit), "strain", 1.01 * limit, 1e-9, Doubtful);
    }
}

/// A strip of 10 x 1 cm that is bent to an arc and turned: each of its columns of cells has turned by the angle of the arc at
/// its middle, and by that alone beside the body.
#[test]
fn turns_of_cells() {
    let bent = |half: f64, turn: f64| {
        let body = rectangle([0.1, 0.01], [21, 3], Cells::Rectangles, Strain::Green);
        started(body, move |x| {
            let (along, across) = (x[0] - 0.05, x[1] - 0.005);
            let (radius, angle) = (0.05 / half, along / 0.05 * half);
            let y = [(radius - across) * angle.sin(), radius - (radius - across) * angle.cos()];
            let (sin, cos) = turn.sin_cos();
            vec![cos * y[0] - sin * y[1] - along, sin * y[0] + cos * y[1] - across]
        })
    };
    let (half, turn) = (0.2, 0.5);
    let motion = bent(half, turn);
    is(&motion, "own-turn", (0.95 * half).to_degrees(), 1e-9, Fine);
    let said = find(&motion, "own-turn").unwrap().text;
    let all = format!("{:.1} degrees", (turn + 0.95 * half).to_degrees());
    assert!(said.contains(&all), "no {all} in: {said}");
    is(&bent(half, 0.0), "own-turn", (0.95 * half).to_degrees(), 1e-9, Fine);
}

/// Under small strains without turns Cauchy strain does, e / 2 of them wrong; not where the body is turned as a whole.
#[test]
fn where_cauchy_strain_would_do() {
    let state = |strain, e: f64, turn: f64| {
        let body = rectangle([0.1, 0.1], [4, 4], Cells::Triangles, strain);
        started(body, move |x| {
            let (sin, cos) = turn.sin_cos();
            let y = [(1.0 + e) * x[0], x[1]];
            vec![cos * y[0] - sin * y[1] - x[0], sin * y[0] + cos * y[1] - x[1]]
        })
    };
    // and e of a body that is as long as it is thick for its stability
    is(&state(Strain::Green, 6e-3, 0.0), "nonlinearity", 9e-3, 1e-6, MoreThanNeeded);
    is(&state(Strain::Green, 7e-3, 0.0), "nonlinearity", 10.5e-3, 1e-6, Fine);
    let turned = (1.0 - 0.01_f64.cos()) / 4e-3 + 6e-3;
    is(&state(Strain::Green, 4e-3, 0.01), "nonlinearity", turned, 1e-6, Fine);
    assert_eq!(find(&state(Strain::Cauchy, 6e-3, 0.0), "nonlinearity"), None);
}

#[test]
fn slenderness_of_bodies() {
    let still = |body: Body| run(&Scene::new(body).phase(Phase::until(1e-8)), 1.0);
    for (size, ratio) in [([0.1, 0.02], 5.0), ([0.02, 0.02], 1.0), ([0.01, 0.3], 30.0)] {
        let body = rectangle(size, [5, 4], Cells::Triangles6, Strain::Cauchy);
        is(&still(body), "slenderness", ratio, 1e-7, Fine);
    }
    for (size, ratio) in [([0.1, 0.02, 0.01], 10.0), ([0.03, 0.3, 0.2], 10.0)] {
        for cells in [SolidCells::Hexahedra, SolidCells::Tetrahedra] {
            let mesh = Mesh::cuboid(size, [4, 4, 4], cells).unwrap();
            let body = Body::new(mesh, SOFT).build().unwrap();
            // the second moments of the nodes of tetrahedra lie a little askew
            is(&still(body), "slenderness", ratio, 0.1, Fine);
        }
    }
    // a ring is as long as its middle line, nearly
    let ring = Mesh::ring(0.045, 0.05, [64, 3], Cells::Triangles).unwrap();
    let ring = Body::new(ring, SOFT).thickness(0.01).build().unwrap();
    is(&still(ring), "slenderness", 2.0 * PI * 0.0475 / 0.005, 0.05, Fine);
}

/// Cantilevers, and the layers of cells that they were made of; one that is pulled does not bend.
#[test]
fn layers_of_cells_through_what_bends() {
    let pulled = |cells, nodes, force: [f64; 2]| {
        let body = rectangle([0.1, 0.02], nodes, cells, Strain::Cauchy);
        rest(&Scene::new(body).phase(Phase::until(1.0).hold("left").load_total("right", force)))
    };
    for (cells, nodes, layers, verdict) in [
        (Cells::Triangles, [11, 2], 1.0, Doubtful),
        (Cells::Triangles, [11, 3], 2.0, Doubtful),
        (Cells::Triangles, [21, 4], 3.0, Doubtful),
        (Cells::Triangles, [21, 5], 4.0, Fine),
        (Cells::Rectangles, [11, 2], 1.0, Doubtful),
        (Cells::Rectangles, [11, 3], 2.0, Fine),
        (Cells::Triangles6, [11, 2], 1.0, Fine),
    ] {
        is(&pulled(cells, nodes, [0.0, -1e-3]), "cells-through", layers, 0.0, verdict);
        is(&pulled(cells, nodes, [1e-3, 0.0]), "cells-through", layers, 0.0, Fine);
    }
}

/// A bar held at both ends that vibrates in its mode n: the changes between nodes are those of sin(n pi x / l).
#[test]
fn cells_in_a_wavelength() {
    let waves = |mode: f64| {
        let scene = Scene::new(bar(20, Strain::Cauchy, SOFT))
            .initial_velocity(move |x| vec![0.01 * (mode * PI * x[0] / 0.1).sin()])
            .phase(Phase::until(0.02).hold("left").hold("right"));
        run(&scene, 0.001)
    };
    for (mode, verdict) in [(1.0, Fine), (6.0, Fine), (8.0, Doubtful)] {
        let cells = PI / (0.5 * PI * mode / 20.0).sin();
        is(&waves(mode), "cells-in-a-wave", cells, 1e-4, verdict);
    }
    // rigid motions have no waves
    let square = rectangle([0.1, 0.1], [4, 4], Cells::Rectangles, Strain::Green);
    let flying = Scene::new(square)
        .initial_velocity(|x| vec![1.0 - 2.0 * x[1], 2.0 * x[0]])
        .phase(Phase::until(0.1));
    assert_eq!(find(&run(&flying, 0.01), "cells-in-a-wave"), None);
}

/// Damping ratio of a bar: omega c / (2 E), with omega = pi / (2 l) sqrt(E / rho) but for its cells.
#[test]
fn damping_of_the_lowest_vibration() {
    let viscous = Material { viscosity: 20.0, ..SOFT };
    let scene = Scene::new(bar(20, Strain::Cauchy, viscous)).phase(Phase::until(0.1).hold("left"));
    let motion = run(&scene.initial_velocity(|x| vec![0.1 * x[0]]), 0.01);
    let omega = 0.5 * PI / 0.1 * 50_f64.sqrt();
    is(&motion, "damping", omega * 20.0 / (2.0 * 5e4), 0.01, Fine);
}

/// A force on one node of a block: each time its cells are halved the displacement there grows by 2 F ln 2 / (pi E h).
#[test]
fn forces_on_single_nodes() {
    let pressed = |cells: usize, load: Phase| {
        let body = rectangle([0.1, 0.1], [cells + 1; 2], Cells::Rectangles, Strain::Cauchy);
        rest(&Scene::new(body).phase(load.hold("bottom")))
    };
    let middle = |cells: usize| (cells + 1) * cells + cells / 2;
    let point = |cells: usize| Phase::until(1.0).load([middle(cells) + 1], [0.0, -1.0]);
    let sinks =
        [8, 16, 32].map(|cells| -pressed(cells, point(cells)).last().u[2 * middle(cells) + 1]);
    let growth = 2.0 * LN_2 / (PI * SOFT.young * 0.01);
    for pair in sinks.windows(2) {
        // 1.008 and 1.002 of it
        assert!(((pair[1] - pair[0]) / growth - 1.0).abs() < 0.02, "{sinks:?}, {growth}");
    }
    is(&pressed(8, point(8)), "single-nodes", 1.0, 0.0, Doubtful);
    let said = find(&pressed(8, point(8)), "single-nodes").unwrap().text;
    let part = format!("by {:.0} % of the motion", 100.0 * growth / sinks[0]);
    assert!(said.contains(&part) && said.contains("node 77"), "no {part} in: {said}");
    let shared = Phase::until(1.0).load_total("top", [0.0, -1.0]);
    is(&pressed(8, shared), "single-nodes", 0.0, 0.0, Fine);
    // as much of it as an edge of nodes, and one more by itself
    let two = point(8).load_total("left", [0.1, 0.0]);
    is(&pressed(8, two), "single-nodes", 1.0, 0.0, Doubtful);
    let held = Phase::until(1.0).move_axis([middle(8) + 1], Axis::Y, -0.001);
    is(&pressed(8, held), "single-nodes", 1.0, 0.0, Doubtful);
    // of quadratic faces in space nothing but the middle nodes is loaded
    let mesh = Mesh::cuboid([0.1; 3], [3; 3], SolidCells::Tetrahedra10).unwrap();
    let block = Scene::new(Body::new(mesh, SOFT).strain(Strain::Cauchy).build().unwrap());
    let pull = |load: Phase| rest(&block.clone().phase(load.hold("left")));
    let traction = Phase::until(1.0).traction("right", [100.0, 0.0, 0.0]);
    is(&pull(traction), "single-nodes", 0.0, 0.0, Fine);
    // a corner that has no cell in common with what is held
    is(&pull(Phase::until(1.0).load([27], [1.0, 0.0, 0.0])), "single-nodes", 1.0, 0.0, Doubtful);
    // at the end of a slender beam nothing of it is seen
    let beam = rectangle([0.4, 0.01], [41, 3], Cells::Rectangles, Strain::Cauchy);
    let beam = Scene::new(beam).phase(Phase::until(1.0).hold("left").load([82], [0.0, -1e-4]));
    is(&rest(&beam), "single-nodes", 0.0, 0.0, Fine);
}

/// A block that slides on a floor is braked by mu of what presses it on.
#[test]
fn friction_that_is_felt() {
    let slides = |mu: f64| {
        let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness(500.0).damping(1.0);
        let body = rectangle([0.1, 0.05], [5, 3], Cells::Rectangles, Strain::Green);
        let scene = Scene::new(body).gravity([0.0, -9.8]).obstacle(floor.friction_coefficient(mu));
        run(&scene.initial_velocity(|_| vec![3.0, 0.0]).phase(Phase::until(0.2)), 0.002)
    };
    is(&slides(0.3), "friction", 0.3, 0.01, Fine);
    is(&slides(0.011), "friction", 0.011, 0.01, Fine);
    is(&slides(0.009), "friction", 0.009, 0.01, MoreThanNeeded);
    assert_eq!(find(&slides(0.0), "friction"), None);
}

/// A stiff bar that falls on a floor from height h, with its mass m and the stiffness k there: it goes
/// d = (1 + sqrt(1 + 2 h k / m g)) m g / k into it, and h + d in all.
#[test]
fn depth_beside_the_way() {
    let falls = |k: f64| {
        let stiff = Material { young: 1e8, ..SOFT };
        let floor = Obstacle::half_plane([-0.01], [1.0]).stiffness(k);
        let scene = Scene::new(bar(5, Strain::Cauchy, stiff)).gravity([-9.8]).obstacle(floor);
        run(&scene.phase(Phase::until(0.08)), 2e-4)
    };
    let (weight, height): (f64, f64) = (0.01 * 9.8, 0.01);
    for (k, verdict) in [(2500.0, Fine), (1000.0, Doubtful)] {
        let depth = weight / k * (1.0 + (1.0 + 2.0 * height * k / weight).sqrt());
        is(&falls(k), "depth-of-way", depth / (height + depth), 0.02, verdict);
    }
}

/// A node that is moved at v from rest lags behind by v t exp(-alpha t), at most v / (e alpha), on a way of v.
#[test]
fn drift_of_constraints() {
    for (alpha, verdict) in [(300.0, Doubtful), (500.0, Fine)] {
        let pull = Phase::until(1.0).hold("left").move_nodes("right", [0.01]);
        let viscous = Material { viscosity: 100.0, ..SOFT };
        let scene = Scene::new(bar(5, Strain::Cauchy, viscous)).phase(pull);
        let settings = Settings { rtol: 1e-6, alpha, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
        is(&motion, "drift", 1.0 / (alpha * 1_f64.exp()), 0.01, verdict);
    }
}

/// A bar of length l that is stretched evenly for a time T, u = v t x / l, has rho l^2 / (3 E T^2) as much kinetic as strain
/// energy in the end.
#[test]
fn motions_that_statics_would_do_for() {
    for (end, verdict) in [(0.07, Fine), (0.1, MoreThanNeeded)] {
        let pull = Phase::until(end).hold("left").move_nodes("right", [0.01]);
        let scene = Scene::new(bar(10, Strain::Cauchy, SOFT)).phase(pull);
        let motion = run(&scene.initial_velocity(|x| vec![0.1 * x[0]]), 0.01);
        let part = SOFT.density * 0.01 / (3.0 * SOFT.young * end * end);
        is(&motion, "kinetic-energy", part, 1e-3, verdict);
    }
}

/// A beam without lateral contraction moves in the plane of its load, and not if that has a part across.
#[test]
fn motions_in_a_plane() {
    let bent = |cells, across: f64| {
        let mesh = Mesh::cuboid([0.1, 0.02, 0.02], [11, 3, 3], cells).unwrap();
        let body = Body::new(mesh, SOFT).strain(Strain::Cauchy).build().unwrap();
        let load = [0.0, -1e-3, across * 1e-3];
        rest(&Scene::new(body).phase(Phase::until(1.0).hold("left").load_total("right", load)))
    };
    let plane = find(&bent(SolidCells::Hexahedra, 0.0), "plane").unwrap();
    assert!(plane.value < 1e-9 && plane.verdict == MoreThanNeeded, "{plane}");
    assert!(plane.text.contains("across z"), "{plane}");
    // as stiff across: that part of the displacements
    let verdicts = [(0.005, MoreThanNeeded), (0.02, Fine)];
    for (across, verdict) in verdicts {
        let motion = bent(SolidCells::Hexahedra, across);
        let plane = find(&motion, "plane").unwrap();
        assert_eq!(plane.verdict, verdict, "{plane}");
        // over the deformation, without the mean displacement
        let ratio = plane.value / across;
        assert!((1.0..2.0).contains(&ratio), "{ratio}");
    }
    assert_eq!(find(&rest_of_a_square(0.0), "plane"), None);
}

/// A square that bulges under a load on its top, with a part of it to the side.
fn rest_of_a_square(side: f64) -> Trajectory {
    let mesh = Mesh::rectangle([0.1, 0.1], [5, 5], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, Material { poisson: 0.3, ..SOFT }).strain(Strain::Cauchy);
    let body = body.thickness(0.01).build().unwrap();
    let load = Phase::until(1.0).hold("bottom").load_total("top", [side, -1.0]);
    rest(&Scene::new(body).phase(load))
}

/// Displacements by a load to the side are the part that is not mirrored, in linear elasticity.
#[test]
fn motions_that_are_their_mirror_images() {
    let straight = find(&rest_of_a_square(0.0), "mirror-x").unwrap();
    assert!(straight.value < 1e-9 && straight.verdict == MoreThanNeeded, "{straight}");
    let values = [1e-5, 1e-2].map(|side| find(&rest_of_a_square(side), "mirror-x").unwrap());
    assert!((values[1].value / values[0].value / 1000.0 - 1.0).abs() < 1e-2, "{values:?}");
    assert_eq!(values.map(|value| value.verdict), [MoreThanNeeded, Fine]);
    // top and bottom differ
    assert_eq!(find(&rest_of_a_square(0.0), "mirror-y").unwrap().verdict, Fine);
    // a mesh that is no image of itself
    let positions = vec![0.0, 0.0, 0.1, 0.0, 0.03, 0.1];
    let mesh = Mesh::new(2, positions, CellKind::Triangle, vec![0, 1, 2]).unwrap();
    let body = Body::new(mesh, SOFT).thickness(0.01).build().unwrap();
    let motion = started(body, |x| vec![0.01 * x[0], 0.0]);
    assert_eq!(find(&motion, "mirror-x"), None);
}

/// A path counts from the undeformed place: one of a later phase that begins there is told by how far it is away from its nodes, and one
/// that begins where they are is not.
#[test]
fn paths_that_begin_elsewhere() {
    let away = |begin: f64, displaced: f64| {
        let first = Phase::until(0.1).hold("left").move_axis("right", Axis::X, 0.1);
        let displacements = [begin, begin + 0.01];
        let second = Phase::until(0.2).named("on").hold("left");
        let second = second.path("right", Axis::X, [0.1, 0.2], displacements);
        let body = bar(4, Strain::Green, Material { viscosity: 10.0, ..SOFT });
        let scene = Scene::new(body).initial_displacement(move |x| vec![displaced * x[0] / 0.1]);
        run(&scene.phase(first).phase(second), 0.01)
    };
    let is_told = |motion: &Trajectory, leap: f64, way: f64| {
        let told = find(motion, "path-leap").unwrap();
        assert!((told.value - leap / way).abs() < 1e-3 && told.verdict == Doubtful, "{told}");
        assert!(motion.report().warnings().iter().any(|warning| warning == &told.text), "{told}");
        assert!(told.text.contains("the path of node 5 x in phase \"on\" begins at"), "{told}");
    };
    // from 10 mm, where `move` has led it, back to the undeformed place, and on
    is_told(&away(0.0, 0.0), 0.01, 0.01);
    is_told(&away(0.015, 0.0), 0.005, 0.025);
    assert!(find(&away(0.01, 0.0), "path-leap").is_none());
    // `move` goes on from a place at the start
    assert!(find(&away(0.012, 0.002), "path-leap").is_none());
    let body = bar(4, Strain::Green, SOFT);
    let first = Phase::until(0.1).hold("left").path("right", Axis::X, [0.0, 0.1], [0.001, 0.01]);
    let told = find(&run(&Scene::new(body).phase(first), 0.01), "path-leap").unwrap();
    assert!((told.value - 0.1).abs() < 1e-3, "{told}");
}

/// Pinched rings of one layer, against the finest of them: too stiff by 0.07 times the fourth power of the length of a cell over sqrt(R t),
/// which is told from 1 on, with how many cells would do. (Rectangles of nine nodes, rings 20 and 100 times as large as thick.)
#[test]
fn arched_cells_lock() {
    let pinched = |thickness: f64, around: usize| {
        let (radius, half) = (1.0, 0.5 * thickness);
        let nodes = [2 * around + 1, 2];
        let mesh =
            Mesh::half_ring(radius - half, radius + half, nodes, Cells::Rectangles9).unwrap();
        let middle: Vec<usize> = (0..mesh.node_count())
            .filter(|&node| mesh.position(node)[0].abs() < 1e-9)
            .map(|node| node + 1)
            .collect();
        let body = Body::new(mesh, SOFT).plane(Plane::Stress).thickness(0.1).strain(Strain::Cauchy);
        let phase = Phase::until(1.0)
            .hold_axes("left", [Axis::Y])
            .hold_axes("right", [Axis::Y])
            .hold_axes(middle.clone(), [Axis::X])
            .load_total(middle.clone(), [0.0, -1e-6]);
        let found = rest(&Scene::new(body.build().unwrap()).phase(phase));
        let sinks = found.last().u[2 * (middle[0] - 1) + 1];
        (sinks, found)
    };
    for (thickness, meshes) in [(0.05, [5, 6, 8]), (0.01, [8, 12, 16])] {
        let (truth, finest) = pinched(thickness, 64);
        assert_eq!(find(&finest, "arched-cells").unwrap().verdict, Fine);
        for around in meshes {
            let (sinks, found) = pinched(thickness, around);
            let told = find(&found, "arched-cells").unwrap();
            let stiffer = truth / sinks - 1.0;
            let ratio = 0.5 * PI / around as f64 / thickness.sqrt();
            println!("{thickness} {around}: {stiffer} {} {told}", 0.07 * told.value.powi(4));
            assert!((told.value / ratio - 1.0).abs() < 0.03, "{told}: {ratio}");
            assert_eq!(told.verdict == Doubtful, ratio > 1.0, "{told}");
            let part = 0.07 * told.value.powi(4);
            assert!((part / stiffer - 1.0).abs() < 0.2, "{part} {stiffer}");
        }
    }
}
