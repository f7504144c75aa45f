//! Reduced models in files, as JSON.

use std::hash::Hasher;
use std::path::Path;

use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher13;

use crate::base::input::{InputError, finite};
use crate::dynamics::error::Error;
use crate::io::file::{Kind, write_file};
use crate::scene::reduced_model::ReducedModel;
use crate::scene::timeline::Scene;

/// Format 1 has no checksum.
const KIND: Kind = Kind {
    what: "pliant reduced model",
    format: 2,
    oldest: 1,
    input: "file of a reduced model",
    help: "a file that `pliant reduce` has written",
    // fifty million numbers
    most_bytes: 1 << 30,
};

const HELP: &str = "run `pliant reduce` for this scene";

/// A file, in SI units.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Record {
    what: String,
    format: u32,
    /// Names of the parts of the scene that the model depends on, and their hashes.
    scene: Vec<(String, String)>,
    /// Hash of both others, by which a changed file is detected.
    #[serde(default)]
    checksum: Option<String>,
    model: ReducedModel,
}

impl ReducedModel {
    /// Writes the model of `scene` to a file, as JSON, with hashes that identify the scene: positions of nodes, cells,
    /// materials, and which nodes its phases hold and move. Loads, pressures and signals are not among them: a model is for
    /// scenes that differ in these. A number takes some 21 bytes: 24 shapes of 6048 displacements are 3 MB.
    ///
    /// # Errors
    /// A model of another scene, numbers that are not finite; [`Error::Output`] if the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>, scene: &Scene) -> Result<(), Error> {
        scene.clone().reduced(self.clone())?;
        self.check().map_err(|problem| InputError::new("reduced model", problem, HELP))?;
        let Kind { what, format, .. } = KIND;
        let (scene, model) = (identity(scene)?, self.clone());
        let checksum = Some(checksum(&scene, &model)?);
        let record = Record { what: what.into(), format, scene, checksum, model };
        write_file(path.as_ref(), |file| {
            serde_json::to_writer(&mut *file, &record)?;
            writeln!(file)
        })
    }

    /// Reads the model of `scene` from a file.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no file that can be read; a file that holds no reduced model, is damaged, or was written
    /// for another scene: the message names the difference.
    pub fn read(path: impl AsRef<Path>, scene: &Scene) -> Result<Self, Error> {
        let path = path.as_ref();
        let Record { format, scene: parts, checksum: kept, model, .. } = KIND.read(path)?;
        if format > 1 && kept != Some(checksum(&parts, &model)?) {
            let help = format!(
                "its checksum is not that of its numbers, so that it was changed or damaged: {HELP}"
            );
            return Err(KIND.refuse(path, help));
        }
        let own = identity(scene)?;
        // phases that only the file has do not matter
        for part in &own {
            let (name, _) = part;
            let differs = match parts.iter().find(|(other, _)| other == name) {
                Some(other) if other == part => continue,
                Some(_) => "differ from those of the scene that it is of",
                None => "are not in the scene that it is of",
            };
            return Err(KIND.refuse(path, format!("{name} {differs}: {HELP}")));
        }
        model.check().map_err(|problem| KIND.refuse(path, format!("it has {problem}: {HELP}")))?;
        scene.clone().reduced(model.clone())?;
        Ok(model)
    }

    /// # Errors
    /// Inconsistent sizes or invalid numbers of the model, in words.
    fn check(&self) -> Result<(), String> {
        for phase in &self.phases {
            let [shapes, ranges] = [phase.shapes.len(), phase.range.len()];
            if shapes != ranges {
                return Err(format!("{shapes} shapes and {ranges} ranges"));
            }
            let columns = || phase.shapes.iter().chain(&phase.lifts);
            if let Some(shape) = columns().find(|shape| shape.len() != self.dofs) {
                return Err(format!("a shape of {} numbers, not {}", shape.len(), self.dofs));
            }
            let numbers = columns().map(Vec::as_slice);
            let ranges = phase.range.iter().map(<[f64; 2]>::as_slice);
            for numbers in numbers.chain(ranges) {
                finite("a shape", numbers)
                    .map_err(|error| format!("{} = {}", error.input, error.value))?;
            }
        }
        if let Some(cell) = self.cells.keys().find(|cell| **cell >= self.cell_count) {
            return Err(format!("cell {} of {}", cell + 1, self.cell_count));
        }
        let is_weight = |weight: &f64| *weight > 0.0 && weight.is_finite();
        if let Some(weight) = self.cells.values().find(|weight| !is_weight(weight)) {
            return Err(format!("a weight of {weight}"));
        }
        for (name, error) in [
            ("a largest displacement", self.travel),
            ("an error", self.error),
            ("an error for an imbalance", self.error_per_imbalance),
        ] {
            if !(error >= 0.0 && error.is_finite()) {
                return Err(format!("{name} of {error}"));
            }
        }
        Ok(())
    }
}

/// Names of the parts of a scene that a model depends on, and their hashes.
fn identity(scene: &Scene) -> Result<Vec<(String, String)>, InputError> {
    let parts = scene.reduced_parts()?.into_iter();
    Ok(parts.map(|(name, bytes)| (name, hashed(&bytes))).collect())
}

/// The hash of a model and of the identity of its scene: of their text, which has all digits.
fn checksum(scene: &[(String, String)], model: &ReducedModel) -> Result<String, InputError> {
    let text = serde_json::to_vec(&(scene, model));
    let text = text.map_err(|error| InputError::new("reduced model", error, HELP))?;
    Ok(hashed(&text))
}

fn hashed(bytes: &[u8]) -> String {
    let mut hasher = SipHasher13::new();
    hasher.write(bytes);
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fs;

    use super::*;
    use crate::elements::body::Body;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::scene::reduced_model::ReducedPhase;
    use crate::scene::timeline::Phase;
    use crate::studies::samples::SQUARE_MATERIAL;

    fn scene(size: f64, young: f64, hold: &str) -> Scene {
        let mesh = Mesh::rectangle([size, 0.02], [5, 2], Cells::Triangles).unwrap();
        let material = crate::Material { young, ..SQUARE_MATERIAL };
        let body = Body::new(mesh, material).thickness(0.01).build().unwrap();
        Scene::new(body)
            .phase(Phase::until(0.1).hold(hold).named("swing"))
            .phase(Phase::until(0.2).hold("left").named("rest"))
    }

    fn model(scene: &Scene) -> ReducedModel {
        let dofs = scene.body().dofs();
        let shape = |k: usize| (0..dofs).map(|i| ((i * (k + 2)) as f64).sin() / 3.0).collect();
        let phase = |name: &str, count| ReducedPhase {
            name: name.into(),
            rows: 4,
            lifts: vec![shape(9)],
            shapes: (0..count).map(shape).collect(),
            range: (0..count).map(|k| [-1.0 / (k + 1) as f64, 0.1]).collect(),
        };
        ReducedModel {
            dofs,
            cell_count: scene.body().mesh().cell_count(),
            phases: vec![phase("swing", 3), phase("rest", 2)],
            cells: BTreeMap::from([(1, 1.0 / 7.0), (5, 3.25)]),
            error: 0.01,
            travel: 0.02,
            error_per_imbalance: 1.7,
            is_estimate: true,
            runs: 3,
            within: 0.02,
            learned_from: "two runs".into(),
            learned_keys: BTreeMap::new(),
        }
    }

    fn says(result: Result<impl Sized, Error>, words: &[&str]) {
        let Err(error) = result else { panic!("accepted; expected {words:?}") };
        let message = error.to_string();
        for word in words {
            assert!(message.contains(word), "\"{word}\" is missing from: {message}");
        }
    }

    #[test]
    fn files_hold_models_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("beam.reduced");
        let scene = scene(0.1, 1e5, "left");
        model(&scene).write(&path, &scene).unwrap();
        assert_eq!(ReducedModel::read(&path, &scene).unwrap(), model(&scene));
        // loads, and omitted phases, do not matter
        let other = scene.clone().gravity([0.0, -9.8]).ended_at(0.05);
        assert_eq!(ReducedModel::read(&path, &other).unwrap(), model(&scene));
    }

    #[test]
    fn files_of_other_scenes_are_refused_by_what_differs() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("beam.reduced");
        let own = scene(0.1, 1e5, "left");
        model(&own).write(&path, &own).unwrap();
        for (other, what) in [
            (scene(0.11, 1e5, "left"), "positions of the nodes differ"),
            (scene(0.1, 1.1e5, "left"), "materials differ"),
            (scene(0.1, 1e5, "bottom"), "nodes that phase \"swing\" holds and moves differ"),
            (
                scene(0.1, 1e5, "left").phase(Phase::until(0.3)),
                "phase \"phase 3\" holds and moves are not in",
            ),
        ] {
            says(ReducedModel::read(&path, &other), &[what, HELP]);
        }
        says(
            model(&scene(0.1, 1e5, "left").phase(Phase::until(0.3)))
                .write(&path, &own.clone().phase(Phase::until(0.3))),
            &["without a phase \"phase 3\""],
        );
    }

    #[test]
    fn files_that_hold_no_model_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("beam.reduced");
        let scene = scene(0.1, 1e5, "left");
        says(ReducedModel::read(&path, &scene), &["cannot read", "beam.reduced"]);
        model(&scene).write(&path, &scene).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, text.replacen("3.25", "3.26", 1)).unwrap();
        says(ReducedModel::read(&path, &scene), &["its checksum is not that of its numbers"]);
        // files of format 1 have no checksum
        let text = text.replacen("\"format\":2", "\"format\":1", 1);
        for (from, to, words) in [
            ("pliant reduced", "pliant", &["it does not say \"pliant reduced model\""][..]),
            ("\"format\":1", "\"format\":3", &["format 3", "reads formats 1 to 2"]),
            ("3.25", "-3.25", &["a weight of -3.25", HELP]),
            ("\"5\":", "\"16\":", &["cell 17 of", HELP]),
            ("\"error\":0.01", "\"error\":-1.0", &["an error of -1"]),
            ("[-1.0,0.1],", "", &["3 shapes and 2 ranges"]),
            ("\"error\":0.01", "", &["damaged"]),
        ] {
            assert!(text.contains(from), "{from}");
            fs::write(&path, text.replacen(from, to, 1)).unwrap();
            says(ReducedModel::read(&path, &scene), words);
        }
        fs::write(&path, &text[..text.len() / 2]).unwrap();
        says(ReducedModel::read(&path, &scene), &["damaged or cut off"]);
        let mut failed = model(&scene);
        failed.error = f64::INFINITY;
        says(failed.write(&path, &scene), &["an error of inf"]);
    }
}
