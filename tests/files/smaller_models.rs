//! `half` and `plane` of `[solver]`: sensors read what they would read of the whole.

use std::path::Path;

use pliant::{Axis, Plane, SceneFile, Smaller};

/// A plate between two walls, which is pulled at both ends; symmetric along x, and the same all along y.
const SCENE: &str = r#"
gravity = [0.0, 0.0, -9.8]
[body]
mesh = { kind = "cuboid", size = [0.2, 0.04, 0.05], nodes = [5, 2, 3], cells = "hexahedra" }
material = { density = 1000.0, young = 1e5, poisson = 0.3, viscosity = 20.0 }
[[obstacle]]
name = "floor"
kind = "half-plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
stiffness = 500.0
damping = 1.0
[[phase]]
until = 0.05
hold = [{ nodes = "front", axes = ["y"] }, { nodes = "back", axes = ["y"] }]
load = [{ nodes = "left", total = [-0.5, 0.0, 0.0] }, { nodes = "right", total = [0.5, 0.0, 0.0] }]
[[sensor]]
name = "end"
kind = "position"
nodes = "right"
component = "x"
[[sensor]]
name = "height"
kind = "centre-of-mass"
component = "z"
[solver]
rtol = 1e-8
"#;

fn read(solver: &str) -> Result<SceneFile, pliant::Error> {
    SceneFile::parse(&format!("{SCENE}{solver}"), Path::new("plate.toml"))
}

/// What the sensors read at the end, and the number of unknown displacements.
fn run(file: &SceneFile) -> (Vec<f64>, usize) {
    let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
    (motion.last().sensors.clone(), file.scene.body().dofs())
}

/// To some errors of the steps, which are not the same ones, of where things are (measured: 8e-13 m of 0.2 m, which moves 3e-4 m).
#[test]
fn sensors_of_smaller_models_read_those_of_the_whole() {
    let whole = read("").unwrap();
    assert!(
        whole.smaller.is_empty() && read("half = \"\"\nplane = \"\"").unwrap().smaller.is_empty()
    );
    let (expected, unknowns) = run(&whole);
    assert_eq!(unknowns, 90);
    let at = 0.1;
    let half = Smaller::Half { axis: Axis::X, at };
    let plane = Smaller::Plane { axis: Axis::Y, plane: Plane::Strain };
    for (solver, kinds, own_unknowns) in [
        ("half = \"x\"", vec![half], 54),
        ("plane = \"y\"", vec![plane], 30),
        ("half = \"x\"\nplane = \"y\"", vec![half, plane], 18),
    ] {
        let file = read(solver).unwrap();
        assert_eq!(file.smaller, kinds);
        let (found, unknowns) = run(&file);
        assert_eq!(unknowns, own_unknowns);
        for (found, expected) in found.iter().zip(&expected) {
            println!("{solver:?}: {found} {expected} {:e}", found - expected);
            assert!(
                (found - expected).abs() < 1e-10 * expected.abs(),
                "{solver}: {found} {expected}"
            );
        }
    }
}

/// Hexahedra of 20 nodes have 2 or 3 of them along y, so that in their section some nodes of a mean count more than others: at the start to round-off,
/// with 13, 6, 13 and 6 nodes at x = 0, 2.5, 5 and 7.5 cm. They move nearly alike, as the section's cells have a node more (measured: 0.2 % apart).
#[test]
fn means_count_all_nodes_of_the_whole() {
    let read = |solver: &str| {
        let sensor = "[[sensor]]\nname = \"part\"\nkind = \"position\"\nnodes = { box = [[-1.0, -1.0, -1.0], [0.08, 1.0, 1.0]] }\n";
        let text = SCENE.replace("cells = \"hexahedra\"", "cells = \"hexahedra20\"");
        let text = text.replace("stiffness = 500.0\ndamping = 1.0", "stiffness_density = 1e6");
        let text = text.replace("total = [-0.5, 0.0, 0.0]", "traction = [-250.0, 0.0, 0.0]");
        let text = text.replace("total = [0.5, 0.0, 0.0]", "traction = [250.0, 0.0, 0.0]");
        let text = text.replace("[solver]", &format!("{sensor}component = \"x\"\n[solver]"));
        SceneFile::parse(&format!("{text}{solver}"), Path::new("plate.toml")).unwrap()
    };
    let [space, own] = ["", "plane = \"y\""].map(|solver| {
        let file = read(solver);
        let motion = file.scene.simulate(&file.settings, &file.output.sampling()).unwrap();
        let part = |sample: &pliant::Sample| *sample.sensors.last().unwrap();
        [part(&motion.samples()[0]), part(motion.last())]
    });
    println!("{space:?} {own:?}");
    let mean = (6.0 * 0.025 + 13.0 * 0.05 + 6.0 * 0.075) / 38.0;
    assert!((space[0] - mean).abs() < 1e-15 && (own[0] - mean).abs() < 1e-15);
    let moved = [space, own].map(|part| part[1] - part[0]);
    assert!((moved[1] / moved[0] - 1.0).abs() < 0.01, "{moved:?}");
}

/// A bar that is drawn across a mat between two walls, on a coarse mesh of one layer: forces and displacements of the section are those of the mat, to some errors of the
/// steps of what sticks and slips (measured: 5e-6 of the largest). Contact is per node here: per area it is felt at other points of faces than of edges.
#[test]
fn the_section_of_a_mat_reads_what_the_mat_does() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/rolled-mat.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let coarse = text.replace("nodes = [21, 7, 5]", "nodes = [11, 2, 3]");
    let coarse = coarse.replace("stiffness_density = 5.0e7", "stiffness = 5.0e4");
    let coarse = coarse.replace("rtol = 1.0e-4", "rtol = 1.0e-6");
    let [space, own] = [("", 198), ("y", 66)].map(|(axis, unknowns)| {
        let text = coarse.replace("plane = \"y\"", &format!("plane = \"{axis}\""));
        let file = SceneFile::parse(&text, Path::new("mat.toml")).unwrap();
        assert_eq!(file.scene.body().dofs(), unknowns);
        let scene = file.scene.ended_at(0.8);
        let motion = scene.simulate(&file.settings, &file.output.sampling()).unwrap();
        motion.samples().iter().map(|sample| sample.sensors.clone()).collect::<Vec<_>>()
    });
    // forces along x, y and z in space, along x and y in the plane, and the mean displacement along x
    for (k, other) in [(0, 0), (2, 1), (3, 2)] {
        let largest = space.iter().fold(0.0_f64, |most, read| most.max(read[k].abs()));
        let apart = space.iter().zip(&own).map(|(a, b)| (a[k] - b[other]).abs());
        let apart = apart.fold(0.0, f64::max);
        println!("{apart:e} of {largest:e}");
        assert!(apart < 1e-4 * largest, "{apart:e} of {largest:e}");
    }
}

/// What a smaller model does not have is an error in its line, with what to do.
#[test]
fn what_has_no_smaller_model_is_refused() {
    let told = |solver: &str, sensor: &str| {
        let text = format!("{SCENE}{solver}\n{sensor}");
        SceneFile::parse(&text, Path::new("plate.toml")).unwrap_err().to_string()
    };
    let has = |told: String, parts: &[&str]| {
        println!("{told}");
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    };
    has(told("half = \"z\"", ""), &["plate.toml:28: solver.half", "gravity of phase"]);
    has(told("plane = \"x\"", ""), &["plate.toml:28: solver.plane", "along x"]);
    let stress = "[[sensor]]\nname = \"stress\"\nkind = \"stress\"\nnodes = [1]";
    has(told("plane = \"y\"", stress), &["quantity of sensor \"stress\"", "of another kind"]);
    let across =
        "[[sensor]]\nname = \"across\"\nkind = \"velocity\"\nnodes = [1]\ncomponent = \"y\"";
    has(told("plane = \"y\"", across), &["component \"y\"", "x and z alone"]);
    has(
        told("half = \"x\"", &across.replace("[1]", "\"bottom\"").replace("\"y\"", "\"x\"")),
        &["quantity of sensor \"across\""],
    );
    has(
        told("half = \"x\"", "[output]\ntrack = \"left\""),
        &["output.track", "the side that is left out"],
    );
}
