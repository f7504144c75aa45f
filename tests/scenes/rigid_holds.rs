//! Rigid bodies that are held at some of their nodes: what is held stays, or is refused by its name.

use pliant::{
    Axis, Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, SolidCells, Trajectory,
};

const G: f64 = 9.8;

/// A block of 50 x 20 mm; nodes 1 and 2 are its lower edge, 1 and 3 its left one.
fn block() -> Scene {
    let mesh = Mesh::rectangle([0.05, 0.02], [2, 2], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, Material::rigid(2000.0)).thickness(0.03).build().unwrap();
    Scene::new(body).gravity([1.0, -G])
}

/// A beam of 0.1 x 0.02 x 0.02 m in space, with 3 x 2 x 2 nodes along x, y and z.
fn beam() -> Scene {
    let mesh = Mesh::cuboid([0.1, 0.02, 0.02], [3, 2, 2], SolidCells::Hexahedra).unwrap();
    Scene::new(Body::new(mesh, Material::rigid(2000.0)).build().unwrap()).gravity([0.0, 0.0, -G])
}

fn refused(scene: Scene, words: &[&str]) {
    let said = scene.validate().unwrap_err().to_string();
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
    assert!(scene.start(&Settings::default()).is_err());
}

fn run(scene: Scene) -> Trajectory {
    let motion = scene.simulate(&Settings::default(), &Sampling::every(0.05)).unwrap();
    let report = motion.report();
    // every run says how far constraints are off
    let drift = report.indicators.iter().find(|told| told.name == "lasting-drift").unwrap();
    assert!(!drift.is_doubtful(), "{drift}");
    motion
}

/// Two nodes that are held along the line through both, in two phases, one after the other: lengths are those of the piece, so that the
/// line keeps its direction. The body does not turn, though a force beside its centre would turn it, and falls by a t^2/2.
#[test]
fn holds_along_the_line_between_nodes_keep_its_direction() {
    let (mass, force) = (0.05 * 0.02 * 0.03 * 2000.0, 0.3);
    for speed in [0.0, 0.1] {
        let phase = |until: f64| {
            Phase::until(until).move_axis([1, 2], Axis::X, speed).load([4], [0.0, force])
        };
        let motion = run(block().phase(phase(0.1)).phase(phase(0.2)));
        for sample in motion.samples() {
            let (t, along) = (sample.time, speed * sample.time);
            let fall = 0.5 * (force / mass - G) * t * t;
            for u in sample.u.chunks(2) {
                // of 0.1 m at rtol 1e-5
                assert!((u[0] - along).abs() < 1e-8 && (u[1] - fall).abs() < 1e-6, "{u:?} {fall}");
            }
        }
    }
    let guided = Phase::until(0.2).hold_axes([1, 2, 3], [Axis::X]).load([12], [0.0, 0.0, 0.1]);
    let motion = run(beam().phase(guided));
    let (mass, last) = (0.1 * 0.02 * 0.02 * 2000.0, motion.last());
    // it may turn about the line: the centre of mass falls as if it did not
    let fall = 0.5 * (0.1 / mass - G) * 0.2 * 0.2;
    let mean = (0..12).map(|node| last.u[3 * node + 2]).sum::<f64>() / 12.0;
    assert!((mean - fall).abs() < 1e-6, "{mean} {fall}");
    let height = |node: usize| last.u[3 * node + 2];
    // rows are stabilized, to parts of the 0.2 m of the fall
    assert!((height(0) - height(1)).abs() + (height(0) - height(2)).abs() < 3e-7);
    // it swings about the line, by 90 degrees to its mirror image
    let swung = |sample: usize| {
        let u = &motion.samples()[sample].u;
        u[3 * 11 + 2] - u[2]
    };
    assert!(swung(2) > 1e-3, "{}", swung(2));
}

/// A command that holds a second node on such a line.
#[test]
fn a_line_may_be_held_by_a_command() {
    let mut driven = block()
        .phase(Phase::until(0.1).hold_axes([1], [Axis::X]))
        .start(&Settings::default())
        .unwrap();
    driven.hold_axes([2], [Axis::X]).unwrap();
    driven.advance_to(0.1).unwrap();
    let u = driven.view().displacements();
    assert!((u[3] - u[1]).abs() < 1e-9, "{u:?}");
}

/// A row of several nodes that implies the same is no such hold.
#[test]
fn rows_that_small_motions_alone_imply_are_refused() {
    let level = Phase::until(0.2).named("slide").hold_axes([1], [Axis::X]);
    let level = level.hold_combination([(1, Axis::X, 1.0), (2, Axis::X, 1.0)]);
    refused(block().phase(level), &["node 1 x + node 2 x", "\"slide\"", "small motions"]);
}

/// Nodes of the left edge hold the turn: the block falls as g t^2/2, and does not move along x.
#[test]
fn holds_across_the_line_between_nodes_guide_the_body() {
    let motion = run(block().phase(Phase::until(0.2).hold_axes([1, 3], [Axis::X])));
    for sample in motion.samples() {
        let fall = -0.5 * G * sample.time * sample.time;
        for u in sample.u.chunks(2) {
            // of 0.2 m at rtol 1e-5
            assert!(u[0].abs() < 1e-9 && (u[1] - fall).abs() < 1e-6, "{u:?} {fall}");
        }
    }
}

/// What the other holds imply for all motions stays without a row of its own: a whole edge, an axis in space.
#[test]
fn holds_that_are_implied_are_kept_by_the_others() {
    let motion = run(block().phase(Phase::until(0.2).hold([1, 2]).load([4], [0.0, 1.0])));
    assert!(motion.last().u.iter().all(|u| u.abs() < 1e-9), "{:?}", motion.last().u);
    // nodes 1 and 4 of the beam are at x = 0, 0.02 m apart along y: it turns about that edge
    let motion = run(beam().phase(Phase::until(0.2).hold([1, 4])));
    let end = motion.last();
    for node in [0, 3] {
        assert!(end.u[3 * node..][..3].iter().all(|u| u.abs() < 1e-8), "{:?}", end.u);
    }
    assert!(end.u[3 * 2 + 2] < -0.05, "{:?}", &end.u[6..9]);
}
