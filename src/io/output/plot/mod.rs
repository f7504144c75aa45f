//! Plots of sensors and energies of a motion over time, or of a load curve over the load factor.

mod page;
mod table;

use std::path::Path;

use page::figure;
pub use table::Table;

use crate::dynamics::error::Error;
use crate::dynamics::trajectory::Trajectory;

/// Sensors and energies over time, of a load curve over its load factor: a panel for each unit, with a legend; thin lines at the ends of the
/// phases.
///
/// ```
/// use pliant::output::Plot;
/// use pliant::simulate::{Component, Reading};
/// use pliant::{Sampling, Settings, samples};
///
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("plot.svg");
/// let sampling = Sampling::every(0.01).read("height", Reading::position("top").component(Component::Y));
/// let motion = samples::square_jump(4)?.simulate(&Settings::default(), &sampling)?;
/// Plot::new().title("A square jumps").write(&motion, path)?;
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Plot {
    title: String,
    columns: Option<Vec<String>>,
}

impl Plot {
    /// A plot of all sensors, and of the energies that there are.
    pub fn new() -> Self {
        Self::default()
    }

    /// The title above the plot. Default: the title of the scene, if its file has one.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Draws these columns of the [table](crate::io::output::write_csv) instead, in this order.
    pub fn columns<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.columns = Some(names.into_iter().map(Into::into).collect());
        self
    }

    /// Draws a motion to an SVG file, or, with the feature `png`, a PNG file.
    ///
    /// # Errors
    /// [`Error::Input`] for a name that no column has, and another ending of `path`; [`Error::Output`] if the
    /// file cannot be written, or this machine has no fonts for a PNG file.
    pub fn write(&self, trajectory: &Trajectory, path: impl AsRef<Path>) -> Result<(), Error> {
        self.write_table(&Table::of(trajectory, None)?, path)
    }

    /// As [`write`](Self::write), of a table, such as one that a run [has left](Table::read).
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn write_table(&self, table: &Table, path: impl AsRef<Path>) -> Result<(), Error> {
        let title = if self.title.is_empty() { &table.title } else { &self.title };
        figure(title, table, &table.chosen(self.columns.as_deref())?).write(path.as_ref())
    }
}
