//! Touches with the numbers that they have by default: bodies that begin near each other, thin ones, rigid ones; phases without a
//! touch; planes of symmetry.

use pliant::simulate::{Component, Reading};
use pliant::{
    Axis, Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Statics,
    Substance, Touch,
};

use crate::common::settings;

const G: f64 = 9.8;

fn block(
    name: &str,
    size: [f64; 2],
    nodes: [usize; 2],
    at: [f64; 2],
    material: impl Into<Substance>,
) -> Body {
    let mesh = Mesh::rectangle(size, nodes, Cells::Rectangles).unwrap().translated(&at).unwrap();
    Body::new(mesh, material).thickness(0.01).named(name).build().unwrap()
}

fn soft() -> Material {
    Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 }
}

/// A block of 2 x 5 cm above a floor by a `gap` (m), both rigid.
fn above_floor(gap: f64, touch: Touch) -> Scene {
    let rigid = || Material::rigid(1000.0);
    let upper = block("block", [0.02, 0.05], [3, 3], [0.0, gap], rigid());
    // a single cell, whose points stand for far more than lies over them, and have a small part of the energy
    let floor = block("floor", [1.0, 0.01], [2, 2], [-0.2, -0.01], rigid());
    Scene::new(Body::join([upper, floor]).unwrap()).gravity([0.0, -G]).touch(touch)
}

/// Bodies that begin nearer than the usual distance have their gap as distance: nothing presses at the start, and the block
/// sinks by a part of it; it never rises above where it began by more than a hundredth of it (1.1e-7 m at this tolerance; thrown, it rose by metres).
#[test]
fn what_begins_near_is_not_thrown() {
    let scene = above_floor(1e-4, Touch::all()).phase(Phase::until(0.3).hold("floor"));
    let distances = scene.touch_distances().unwrap();
    assert!((distances[0].distance - 1e-4).abs() < 1e-12, "{}", distances[0]);
    let height = Reading::displacement("block").component(Component::Y);
    let motion = scene
        .simulate(&settings(Method::Auto, 1e-6), &Sampling::every(0.005).read("height", height))
        .unwrap();
    let heights = motion.samples().iter().map(|sample| sample.sensors[0]);
    let (low, high) = heights.fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    assert!(high < 1e-6 && low > -1e-4, "{low} {high}");
}

/// A wall 1 mm thick in cells 10 mm long: a tenth of the thickness, not of the edges, which would be 0.73 mm.
#[test]
fn thin_walls_are_felt_from_a_tenth_of_their_thickness() {
    let wall = block("wall", [0.05, 0.001], [6, 2], [0.0, 0.005], soft());
    let plate = block("plate", [0.05, 0.02], [6, 3], [0.0, -0.02], soft());
    let scene = Scene::new(Body::join([wall, plate]).unwrap())
        .touch(Touch::all())
        .phase(Phase::until(0.1).hold("plate"));
    let told = &scene.touch_distances().unwrap()[0];
    // 2 V/A of the wall, in the plane
    let thickness = 2.0 * 0.05 * 0.001 / (2.0 * (0.05 + 0.001));
    assert!((told.distance / (0.1 * thickness) - 1.0).abs() < 1e-9, "{told}");
}

/// A rigid block on a rigid floor that a force pushes by 0.3 of its weight, at mid-height, which friction of 0.6 holds and does not tip
/// over: it creeps below the sticking speed and stays down. With a stiffness of 5e11 N/m^3, that of a modulus of 1e8 Pa, it hopped by 2.7 mm
/// and fell over.
#[test]
fn a_rigid_block_that_friction_holds_stays_down() {
    let (gap, mass, speed, end) = (2e-5, 0.01, 1e-3, 0.8);
    let touch = Touch::all().friction_coefficient(0.6).sticking_speed(speed);
    let scene = above_floor(gap, touch.damping_density(2e5))
        .phase(Phase::until(end).hold("floor").load_total("block", [0.3 * mass * G, 0.0]));
    let read = |component| Reading::centre_of_mass().of_body("block").component(component);
    let sampling =
        Sampling::every(0.01).read("x", read(Component::X)).read("y", read(Component::Y));
    let motion = scene.simulate(&Settings::default(), &sampling).unwrap();
    let start = motion.samples()[0].sensors.clone();
    for sample in motion.samples() {
        let [along, up] = [0, 1].map(|k| sample.sensors[k] - start[k]);
        assert!((-gap..gap).contains(&up), "{} s: {up} m", sample.time);
        assert!((-gap..speed * end).contains(&along), "{} s: {along} m", sample.time);
    }
}

/// In a phase without contact a block falls through a plate, by g t^2/2; in one with `touching` it lies on it.
#[test]
fn phases_may_leave_out_the_touch() {
    let fall = |phase: Phase| {
        let scene = above_floor(1e-3, Touch::all()).phase(phase.hold("floor"));
        let height = Reading::displacement("block").component(Component::Y);
        let force = Reading::touch_force("touch").of_body("block");
        let sampling = Sampling::phase_ends().read("height", height).read("force", force);
        let motion = scene.simulate(&settings(Method::Auto, 1e-7), &sampling).unwrap();
        let last = motion.last();
        assert_eq!(
            last.sensors[1] == 0.0,
            motion.contact_forces(last).unwrap().iter().all(|f| *f == 0.0)
        );
        last.sensors[0]
    };
    let free = -0.5 * G * 0.1 * 0.1;
    for without in [Phase::until(0.1).without_contact(), Phase::until(0.1).touching(false)] {
        let fallen = fall(without);
        assert!((fallen / free - 1.0).abs() < 1e-6, "{fallen}");
    }
    assert!(fall(Phase::until(0.1)) > -1e-3);
}

/// A soft block that is pressed on a rigid plate, whole, and its right half with a plane of symmetry in the middle: faces on
/// that plane are no surface, so that the half is pressed by half of the force, and its pressures are the same.
#[test]
fn faces_on_planes_of_symmetry_do_not_touch() {
    let pressed = |half: bool| {
        let (width, cells, left) = if half { (0.01, 5, 0.0) } else { (0.02, 9, -0.01) };
        let upper = block("block", [width, 0.01], [cells, 5], [left, 2e-4], soft());
        let plate = block("plate", [0.06, 0.01], [49, 2], [-0.03, -0.01], Material::rigid(1000.0));
        let touch = Touch::all().distance(1e-4);
        let mut phase = Phase::until(0.1).hold("plate").move_nodes("block/top", [0.0, -4e-3]);
        if half {
            phase = phase.symmetry("block/left", [1.0, 0.0]);
        }
        let scene = Scene::new(Body::join([upper, plate]).unwrap()).touch(touch).phase(phase);
        let rest = scene.equilibrium(&Statics::default()).unwrap();
        let (motion, sample) = (rest.trajectory(), rest.sample());
        let force: f64 =
            motion.contact_forces(sample).unwrap()[1..2 * cells * 5].iter().step_by(2).sum();
        let corner = 5 - 1;
        let middle = if half { 0 } else { corner };
        let nodal = motion.nodal_contacts(sample).unwrap();
        (force, nodal[middle].pressure(), nodal[if half { corner } else { 2 * corner }].pressure())
    };
    let (whole, half) = (pressed(false), pressed(true));
    assert!((half.0 / (0.5 * whole.0) - 1.0).abs() < 1e-3, "{half:?} {whole:?}");
    // the point of the plate at the plane counts wholly beside the half (3.3 %)
    assert!((half.1 / whole.1 - 1.0).abs() < 0.05, "{half:?} {whole:?}");
    assert!((half.2 / whole.2 - 1.0).abs() < 1e-3, "{half:?} {whole:?}");
}

/// A block on a plate with friction: statics, which knows no friction, tells so; not without friction.
#[test]
fn statics_tells_of_the_friction_that_it_leaves_out() {
    let lying = |coefficient: f64| {
        let upper = block("block", [0.02, 0.02], [5, 5], [0.0, 1.9e-4], soft());
        let plate =
            block("plate", [0.06, 0.004], [13, 3], [-0.02, -0.004], Material::rigid(1000.0));
        let touch = Touch::all().distance(2e-4).friction_coefficient(coefficient);
        let scene = Scene::new(Body::join([upper, plate]).unwrap()).gravity([0.0, -G]).touch(touch);
        let held = Phase::until(1.0).hold("plate").hold_axes("block/left", [Axis::X]);
        let rest = scene.phase(held).equilibrium(&Statics::default()).unwrap();
        let said = rest.trajectory().report().warnings().concat();
        said.contains("touch \"touch\" has friction, which does not act in statics")
    };
    assert!(lying(0.5) && !lying(0.0));
}
