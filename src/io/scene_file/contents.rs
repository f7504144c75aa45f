//! Contents of a scene file.

use crate::base::input::Fraction;
#[cfg(feature = "sweep")]
use crate::base::input::InputError;
use crate::dynamics::equilibrium::Equilibrium;
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Reading, Sampling};
use crate::dynamics::statics::Statics;
use crate::elements::mesh::Selection;
use crate::scene::settings::Settings;
use crate::scene::timeline::{Scene, Smaller};

/// The contents of a scene file.
#[derive(Debug, Clone)]
pub struct SceneFile {
    /// Title of the scene; empty without one.
    pub title: String,
    /// The scene, by the smaller models of it by which it is run.
    pub scene: Scene,
    /// Its simplification relative to the tables: `half`, `plane` and `rod` of `[solver]`.
    pub smaller: Vec<Smaller>,
    /// Its settings.
    pub settings: Settings,
    /// Required accuracy of its motion.
    pub accuracy: AccuracyRequest,
    /// Choices left open for each body.
    pub auto: Vec<AutoRequest>,
    /// Options of its equilibrium.
    pub statics: StaticsRequest,
    /// Requested output.
    pub output: OutputRequest,
    /// Notes of `pliant check` about the text: keys that have another name now.
    pub notes: Vec<String>,
}

/// Required accuracy of a motion, if there is one: see `studies::work_precision::Verification`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AccuracyRequest {
    /// The largest relative difference of two runs that is allowed.
    pub within: Option<Fraction>,
    /// The text that names a `studies::work_precision::Quantity`; the whole motion without it.
    pub quantity: Option<String>,
}

/// Choices that a scene file leaves open for a body, by the word `auto`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct AutoRequest {
    /// The measure of strain: Green's.
    pub strain: bool,
    /// The cells of a generated mesh: quadratic ones.
    pub cells: bool,
}

/// Which equilibrium is sought, and how.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StaticsRequest {
    /// Name of the phase; the first one without it.
    pub phase: Option<String>,
    /// Options of the search.
    pub options: Statics,
}

impl SceneFile {
    /// The equilibrium that the file describes, with the readings of its sensors.
    ///
    /// # Errors
    /// As [`Scene::equilibrium_of`] and [`Equilibrium::read`].
    pub fn equilibrium(&self) -> Result<Equilibrium, Error> {
        let StaticsRequest { phase, options } = &self.statics;
        let mut result = match phase {
            None => self.scene.equilibrium(options),
            Some(phase) => self.scene.equilibrium_of(phase, options),
        };
        let sensors = self.output.sampling();
        match &mut result {
            Ok(found) => found.read(&sensors)?,
            Err(Error::Statics(failure)) => failure.read(&sensors)?,
            Err(_) => {}
        }
        result
    }

    /// Checks that the scene has an equilibrium to be sought, without a search.
    ///
    /// # Errors
    /// Bad input; orifices, pipes and flows, which statics does not have.
    #[cfg(feature = "sweep")]
    pub(crate) fn check_equilibrium(&self) -> Result<(), InputError> {
        self.scene.check_equilibrium(self.statics.phase.as_deref())
    }
}

/// Output requested of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputRequest {
    /// Time between samples (s). Without it and `times`, phases are sampled at their ends only.
    pub step: Option<f64>,
    /// Times of samples (s), in place of a step.
    pub times: Option<Vec<f64>>,
    /// Nodes whose displacements the table lists.
    pub track: Option<Selection>,
    /// Sensors: their names and readings.
    pub sensors: Vec<(String, Reading)>,
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
    /// Sensors and energies over time.
    Plot,
    /// The same plot as pixels.
    Png,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 6] = [Self::Csv, Self::Vtk, Self::Svg, Self::Html, Self::Plot, Self::Png];

    /// Name: `csv`, `vtk`, `svg`, `html`, `plot`, `png`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Vtk => "vtk",
            Self::Svg => "svg",
            Self::Html => "html",
            Self::Plot => "plot",
            Self::Png => "png",
        }
    }
}

impl Default for OutputRequest {
    fn default() -> Self {
        Self {
            step: None,
            times: None,
            track: None,
            sensors: Vec::new(),
            formats: vec![Format::Csv],
        }
    }
}

impl OutputRequest {
    /// Times of the samples of the motion, and the readings at them.
    pub fn sampling(&self) -> Sampling {
        let times = match (&self.times, self.step) {
            (Some(times), _) => Sampling::at(&**times),
            (None, Some(step)) => Sampling::every(step),
            (None, None) => Sampling::phase_ends(),
        };
        let sensors = self.sensors.iter();
        sensors.fold(times, |sampling, (name, reading)| sampling.read(name, reading.clone()))
    }

    /// As [`sampling`](Self::sampling), for a motion until `end` (s) that is to be accurate: a hundred samples if none
    /// are requested.
    #[cfg(feature = "study")]
    pub(crate) fn verified_sampling(&self, end: f64) -> Sampling {
        match (&self.times, self.step) {
            (None, None) => Self { step: Some(end / SAMPLES), ..self.clone() }.sampling(),
            _ => self.sampling(),
        }
    }
}

/// Number of samples of a motion that is to be accurate, if none are requested.
#[cfg(feature = "study")]
const SAMPLES: f64 = 100.0;
