//! Tables.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::columns::{Columns, EXCHANGED, STORED, stored};
use super::write_file;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Quantity, Sample, Trajectory};
use crate::elements::mesh::Selection;

/// Writes one row per sample, after a row with the names of the columns: those of
/// [`reference`](super::reference), with displacements of the nodes that `track` names.
///
/// Numbers have 17 significant digits: read back, they are exactly the same.
///
/// # Errors
/// [`Error::Input`] if `track` names a node or set that does not exist, before anything is written;
/// [`Error::Output`] if the file cannot be written.
///
/// ```
/// use pliant::output::write_csv;
/// # use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// # let path = directory.path().join("trajectory.csv");
/// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
/// write_csv(&trajectory, &path, Some(&[14, 15].into()))?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_csv(
    trajectory: &Trajectory,
    path: impl AsRef<Path>,
    track: Option<&Selection>,
) -> Result<(), Error> {
    let columns = Columns::new(trajectory, track)?;
    let rows = trajectory.samples().iter().map(|sample| columns.row(trajectory, sample));
    write(path.as_ref(), header(&columns, trajectory), rows)
}

/// The table of [`write_csv`] while a scene runs: rows are added as samples come.
///
/// A kill thus loses only the last rows. The complete table should be written once more at the end by
/// `write_csv`, all at once.
pub struct GrowingTable {
    path: PathBuf,
    columns: Columns,
    /// Rows written, and the time (s) of the last.
    rows: usize,
    last: f64,
    /// The time (s) of the state that the run has continued from; rows until then are those of an earlier
    /// run.
    began: Option<f64>,
}

impl GrowingTable {
    /// A table at `path` for a run whose motion so far is `trajectory`; nothing is written yet.
    ///
    /// # Errors
    /// [`Error::Input`] if `track` names a node or set that does not exist, or a sensor has the name of
    /// another column.
    pub fn new(
        trajectory: &Trajectory,
        path: impl Into<PathBuf>,
        track: Option<&Selection>,
    ) -> Result<Self, Error> {
        let columns = Columns::new(trajectory, track)?;
        Ok(Self { path: path.into(), columns, rows: 0, last: 0.0, began: None })
    }

    /// For a run that continues from a state at time `began` (s), with `trajectory` so far: the rows until
    /// then, which an earlier run has written, are kept.
    ///
    /// # Errors
    /// [`Error::Read`] if there is no table; one with other columns.
    pub fn going_on(self, trajectory: &Trajectory, began: f64) -> Result<Self, Error> {
        let text = self.text()?;
        let first = csv::Reader::from_reader(text.as_bytes()).headers().cloned();
        if !first.is_ok_and(|first| first == header(&self.columns, trajectory)) {
            let help =
                "its columns are others: resume with the same nodes and sensors, or run it again";
            return Err(InputError::new("table to go on with", self.path.display(), help).into());
        }
        Ok(Self { began: Some(began), ..self })
    }

    fn text(&self) -> Result<String, Error> {
        fs::read_to_string(&self.path)
            .map_err(|source| Error::Read { path: self.path.clone(), source })
    }

    /// Removes the rows after time `began` (s).
    fn cut(&self, began: f64) -> Result<(), Error> {
        let text = self.text()?;
        let mut lines = text.split_inclusive('\n');
        let header = lines.next().unwrap_or_default();
        let is_kept = |line: &&str| {
            let time = line.split(',').next().and_then(|time| time.parse::<f64>().ok());
            line.ends_with('\n') && time.is_some_and(|time| time <= began)
        };
        let kept: String = [header].into_iter().chain(lines.take_while(is_kept)).collect();
        write_file(&self.path, |file| file.write_all(kept.as_bytes()))
    }

    /// Adds the samples that are not yet in it. Where the run has gone back and dropped some, all its rows
    /// are written anew.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn catch_up(&mut self, trajectory: &Trajectory) -> Result<(), Error> {
        let samples = trajectory.samples();
        let fits = |last: &usize| samples.get(*last).is_some_and(|sample| sample.time == self.last);
        let written = match (self.rows.checked_sub(1).filter(fits), self.began) {
            (Some(last), _) => last + 1,
            (None, Some(began)) => {
                self.cut(began)?;
                samples.partition_point(|sample| sample.time <= began)
            }
            (None, None) => 0,
        };
        let rows = samples[written..].iter().map(|sample| self.columns.row(trajectory, sample));
        let done = match (written, self.began) {
            (0, None) => write(&self.path, header(&self.columns, trajectory), rows),
            _ => append(&self.path, rows)
                .map_err(|source| Error::Output { path: self.path.clone(), source }),
        };
        (self.rows, self.last) = (samples.len(), trajectory.last().time);
        done
    }
}

fn header(columns: &Columns, trajectory: &Trajectory) -> Vec<String> {
    columns.quantities(trajectory).iter().map(Quantity::heading).collect()
}

fn append(path: &Path, rows: impl Iterator<Item = Vec<f64>>) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(OpenOptions::new().append(true).open(path)?);
    write_rows(&mut table, rows)?;
    table.flush()
}

/// Writes one row per sample with the energies (J) of [`Energy`](crate::Energy), after a row with the names
/// of the columns: `t` (s), `kinetic`, `strain`, `gravity`, `contact`, `springs`, `dissipated` and `supplied`
/// since t = 0, and `balance`: the sum of what is stored and dissipated less what was supplied, constant
/// except for errors of the integration.
///
/// # Errors
/// [`Error::Output`] if the file cannot be written.
pub fn write_energies(trajectory: &Trajectory, path: impl AsRef<Path>) -> Result<(), Error> {
    let names = ["t"].into_iter().chain(STORED).chain(EXCHANGED).chain(["balance"]);
    let header = names.map(str::to_owned).collect();
    let row = |sample: &Sample| {
        let energy = &sample.energy;
        let mut row = vec![sample.time];
        row.extend(stored(energy));
        row.extend([energy.dissipated, energy.supplied, energy.balance()]);
        row
    };
    write(path.as_ref(), header, trajectory.samples().iter().map(row))
}

fn write(
    path: &Path,
    header: Vec<String>,
    rows: impl Iterator<Item = Vec<f64>>,
) -> Result<(), Error> {
    write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(header)?;
        write_rows(&mut table, rows)?;
        table.flush()
    })
}

fn write_rows(
    table: &mut csv::Writer<impl Write>,
    mut rows: impl Iterator<Item = Vec<f64>>,
) -> io::Result<()> {
    rows.try_for_each(|row| Ok(table.write_record(row.iter().map(|x| format!("{x:.16e}")))?))
}
