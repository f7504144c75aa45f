//! Scenes given to the adviser.

use std::path::Path;

use pliant::samples::ClampedBeam;
use pliant::{Body, Error, Material, Mesh, Phase, Scene, SceneFile, Settings, SolidCells, Strain};

/// Scenes of statics alone: nothing in them lets a motion end, or be worth a look.
const STATIC: [&str; 3] = ["static-square", "beam-static-cauchy", "beam-static-green"];

/// All scene files with a motion, and some more: names, scenes, and how they are integrated as written.
pub fn all() -> Result<Vec<(String, Scene, Settings)>, Error> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let mut files: Vec<_> = files.map(|file| file.path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    let mut all = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if !STATIC.contains(&&*name) {
            let SceneFile { scene, settings, .. } = SceneFile::read(&file)?;
            all.push((name, scene, settings));
        }
    }
    for viscosity in [0.0, 400.0, 40_000.0] {
        let scene = ClampedBeam { nodes: [12, 3], viscosity, ..ClampedBeam::default() }.scene()?;
        all.push((format!("clamped beam, c = {viscosity} Pa s"), scene, Settings::default()));
    }
    all.push(("cantilever in space".into(), cantilever()?, Settings::default()));
    Ok(all)
}

/// A soft bar of 20 x 2 x 2 cm, let go under its weight.
fn cantilever() -> Result<Scene, Error> {
    let mesh = Mesh::cuboid([0.2, 0.02, 0.02], [9, 2, 2], SolidCells::Hexahedra)?;
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.4, viscosity: 2000.0 };
    let body = Body::new(mesh, rubber).strain(Strain::Green).build()?;
    Ok(Scene::new(body).gravity([0.0, 0.0, -9.8]).phase(Phase::until(1.0).hold("left")))
}
