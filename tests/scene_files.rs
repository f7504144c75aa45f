//! Scene files give what the same scenes give that are built in Rust.

use std::path::Path;

use pliant::{SceneFile, Trajectory, samples};

/// Reads a scene file of the project.
fn read(name: &str) -> SceneFile {
    SceneFile::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap()
}

/// The motion that a scene file asks for.
fn run(file: &SceneFile) -> Trajectory {
    file.scene.simulate(&file.solver, &file.output.sampling()).unwrap()
}

#[test]
fn beam_jump() {
    let file = read("beam-jump.toml");
    let sample = SceneFile { scene: samples::beam_jump().unwrap(), ..file.clone() };
    assert_eq!(run(&file).samples(), run(&sample).samples());
}

#[test]
fn square_jump() {
    let file = read("square-jump.toml");
    let sample = SceneFile { scene: samples::square_jump(4).unwrap(), ..file.clone() };
    assert_eq!(run(&file).samples(), run(&sample).samples());
}
