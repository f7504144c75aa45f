//! The scene file that a command is about.

use std::path::{Path, PathBuf};

use clap::Args;
use pliant::scene_file::override_of;
use pliant::{Error, ReducedModel, SceneFile, SceneReader};

use super::failure::Failure;
use super::shell::absolute;

/// Override for a scene without its reduced model.
pub const UNREDUCED: &str = "solver.reduced=\"\"";

/// The scene file, and values that replace its own.
#[derive(Args)]
pub struct SceneArguments {
    /// Scene file
    #[arg(value_name = "FILE")]
    pub path: PathBuf,
    /// Another value for a key of the scene file, as body.material.young=2e5 or phase.2.until=1.5 (a list of tables is
    /// followed by the name or number of one); may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// How scene files are read: with the tables of devices of the program.
    #[arg(skip)]
    pub reader: SceneReader,
}

impl SceneArguments {
    /// Reads the file.
    pub fn read(&self) -> Result<SceneFile, Error> {
        self.read_with(&[])
    }

    /// Reads the file with these values, and then `others`, in place of its own.
    pub fn read_with(&self, others: &[String]) -> Result<SceneFile, Error> {
        self.reader.read_with(&self.path, &[&self.set[..], others].concat())
    }

    /// Reads the file, with this reduced model in place of its own if there is one.
    pub fn read_reduced(&self, model: Option<&Path>) -> Result<SceneFile, Error> {
        let Some(path) = model else { return self.read() };
        let mut file = self.read_with(&[UNREDUCED.to_owned()])?;
        let model = ReducedModel::read(path, &file.scene)?;
        file.scene = file.scene.reduced(model)?;
        Ok(file)
    }

    /// Reads another file, with the same values in place of its own.
    pub fn read_too(&self, path: &Path) -> Result<SceneFile, Error> {
        self.reader.read_with(path, &self.set)
    }

    /// Where the file divides cells: `body.mesh.halved_in`.
    pub fn halved_in(&self) -> Result<Vec<toml::Value>, Error> {
        let scene: Option<toml::Table> = toml::from_str(&self.text(&[])?).ok();
        let places =
            scene.as_ref().and_then(|scene| scene.get("body")?.get("mesh")?.get("halved_in"));
        Ok(match places {
            None => Vec::new(),
            Some(toml::Value::Array(places)) => places.clone(),
            Some(place) => vec![place.clone()],
        })
    }

    /// A title that names the values that differ from the file.
    pub fn title(&self, title: &str) -> String {
        match self.set[..] {
            [] => title.into(),
            _ => format!("{title} ({})", self.set.join(", ")),
        }
    }

    /// The text of the file with these values, and then `others`, in it.
    pub fn text(&self, others: &[String]) -> Result<String, Error> {
        SceneFile::text_with(&self.path, &[&self.set[..], others].concat())
    }

    /// Override of the mesh path for a copy of the file at `copy`, as the path is relative to the file; none if the file names no
    /// mesh file, or both are in one directory.
    pub fn mesh_for(&self, copy: &Path) -> Result<Option<String>, Failure> {
        let scene: Option<toml::Table> = toml::from_str(&self.text(&[])?).ok();
        let mesh = scene.as_ref().and_then(|scene| scene.get("body")?.get("mesh")?.get("file"));
        let Some(file) = mesh.and_then(toml::Value::as_str) else { return Ok(None) };
        let (own, copy) = (absolute(&self.path)?, absolute(copy)?);
        if own.parent() == copy.parent() {
            return Ok(None);
        }
        let path = own.with_file_name(file);
        Ok(Some(override_of("body.mesh.file", &path.to_string_lossy().into())?))
    }
}
