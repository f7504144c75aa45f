//! Reduced models of scenes, as `pliant reduce` learns them.

use std::ops::ControlFlow;
use std::path::PathBuf;

use pliant::reduce::{Reduced as Learned, Training, VariedKey, reduce, reduce_by_modes, words};
use pliant::{Error, Scene, SceneFile};
use pyo3::prelude::*;

use crate::errors::raised;

/// A reduced model, with all that were tried, and the scene that it is of.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Reduced {
    pub learned: Learned,
    scene: Scene,
    within: f64,
}

/// A key, the least and the most of its range, and how many of its values are learned.
type Range = (String, f64, f64, Option<usize>);

impl Reduced {
    /// Learns a reduced model of the scene that `read` reads with other values for its keys.
    pub fn learn(
        read: &dyn Fn(&[String]) -> Result<SceneFile, Error>,
        within: f64,
        vary: Vec<Range>,
        [hold_out, most_unknowns]: [usize; 2],
        modes: bool,
        observer: &mut dyn FnMut(&str) -> ControlFlow<()>,
    ) -> Result<Self, Error> {
        let keys = vary.into_iter().map(|(key, least, most, count)| {
            let key = VariedKey::new(key, least, most);
            count.map_or(key.clone(), |count| key.count(count))
        });
        let keys: Vec<VariedKey> = keys.collect();
        let training = Training::varied(read, &keys, hold_out)?;
        let training = Training { within, most_unknowns, ..training };
        let mut learned = match modes {
            true => reduce_by_modes(&training, observer)?,
            false => reduce(&training, observer)?,
        };
        if !keys.is_empty() {
            learned.model = learned.model.learned_over(&words(&keys));
        }
        Ok(Self { learned, scene: training.scenes[0].clone(), within })
    }
}

#[pymethods]
impl Reduced {
    #[getter]
    fn unknowns(&self) -> usize {
        self.learned.model.unknowns()
    }

    #[getter]
    fn cells(&self) -> usize {
        self.learned.model.cells()
    }

    #[getter]
    fn error(&self) -> f64 {
        self.learned.model.error()
    }

    #[getter]
    fn is_within(&self) -> bool {
        self.learned.is_within
    }

    /// All numbers, as JSON.
    #[getter]
    fn data(&self) -> String {
        self.learned.to_json().to_string()
    }

    /// Writes the model to a file.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        self.learned.model.write(path, &self.scene).map_err(raised)
    }

    /// Draws error over time of all models that were tried.
    fn write_chart(&self, path: PathBuf, title: &str) -> PyResult<()> {
        self.learned.write_chart(path, title, self.within).map_err(raised)
    }

    fn __str__(&self) -> String {
        self.learned.to_string()
    }
}
