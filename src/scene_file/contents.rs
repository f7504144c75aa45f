//! What a scene file says.

use crate::mesh::Selection;
use crate::scene::Scene;
use crate::settings::Settings;
use crate::simulate::Sampling;

/// The contents of a scene file.
#[derive(Debug, Clone)]
pub struct SceneFile {
    /// Title of the scene; empty without one.
    pub title: String,
    /// The scene.
    pub scene: Scene,
    /// How it is integrated.
    pub settings: Settings,
    /// What is to be written.
    pub output: OutputRequest,
    /// What `pliant check` says about the text: keys that have another name now.
    pub notes: Vec<String>,
}

/// What a run is to write.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputRequest {
    /// Time between samples (s). Without it, phases are sampled at their ends only.
    pub step: Option<f64>,
    /// Nodes whose displacements the table lists.
    pub track: Option<Selection>,
    /// Kinds of files. Default: CSV.
    pub formats: Vec<Format>,
}

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A table of the motion.
    Csv,
    /// Files for ParaView.
    Vtk,
    /// Snapshots.
    Svg,
    /// An animation.
    Html,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Csv, Self::Vtk, Self::Svg, Self::Html];

    /// Name: `csv`, `vtk`, `svg`, `html`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Vtk => "vtk",
            Self::Svg => "svg",
            Self::Html => "html",
        }
    }
}

impl Default for OutputRequest {
    fn default() -> Self {
        Self { step: None, track: None, formats: vec![Format::Csv] }
    }
}

impl OutputRequest {
    /// When the motion is sampled.
    pub fn sampling(&self) -> Sampling {
        self.step.map_or_else(Sampling::phase_ends, Sampling::every)
    }
}
