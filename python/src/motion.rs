//! Motions: samples as arrays, reports, files.

use std::path::PathBuf;

use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pliant::output::{Snapshots, report, write_animation, write_csv, write_report, write_vtk};
use pliant::{CellField, NodalContact, Sample, Trajectory};
use pyo3::prelude::*;

use crate::arrays::{of_nodes, rows};
use crate::errors::raised;

/// The motion of a body, sampled.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Motion {
    pub trajectory: Trajectory,
    title: String,
    /// Why the run ended early.
    failure: Option<String>,
}

impl Motion {
    pub fn new(trajectory: Trajectory, title: String, failure: Option<String>) -> Self {
        Self { trajectory, title, failure }
    }

    fn samples(&self) -> &[Sample] {
        self.trajectory.samples()
    }

    fn dimension(&self) -> usize {
        self.trajectory.body().dimension()
    }

    fn tensors<'py>(
        &self,
        py: Python<'py>,
        sample: usize,
        tensor: impl Fn(&CellField) -> [[f64; 3]; 3],
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let fields = self.trajectory.cell_fields(self.sample(sample)?).map_err(raised)?;
        let numbers: Vec<f64> = fields.iter().flat_map(|field| tensor(field).concat()).collect();
        PyArray1::from_vec(py, numbers).reshape([fields.len(), 3, 3])
    }

    /// A number of the contact at the nodes: [sample, node].
    fn contacts<'py, T: Element>(
        &self,
        py: Python<'py>,
        number: fn(&NodalContact) -> T,
    ) -> PyResult<Bound<'py, PyArray2<T>>> {
        let mut numbers = Vec::new();
        for sample in self.samples() {
            let nodal = self.trajectory.nodal_contacts(sample).map_err(raised)?;
            numbers.extend(nodal.iter().map(number));
        }
        let nodes = self.trajectory.body().mesh().node_count();
        PyArray1::from_vec(py, numbers).reshape([self.samples().len(), nodes])
    }

    fn sample(&self, number: usize) -> PyResult<&Sample> {
        self.samples().get(number).ok_or_else(|| {
            let message = format!("sample {number}: there are {}", self.samples().len());
            pyo3::exceptions::PyIndexError::new_err(message)
        })
    }
}

#[pymethods]
impl Motion {
    #[getter]
    fn title(&self) -> &str {
        &self.title
    }

    #[getter]
    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.samples().iter().map(|sample| sample.time))
    }

    /// Numbers of phases, from 0.
    fn phases<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        PyArray1::from_iter(py, self.samples().iter().map(|sample| sample.phase as i64))
    }

    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        of_nodes(py, self.samples(), self.dimension(), |sample| Ok(sample.u.clone()))
    }

    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        of_nodes(py, self.samples(), self.dimension(), |sample| Ok(sample.v.clone()))
    }

    fn contact_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let forces = |sample: &Sample| self.trajectory.contact_forces(sample).map_err(raised);
        of_nodes(py, self.samples(), self.dimension(), forces)
    }

    /// Contact pressure (Pa) at the nodes: [sample, node].
    fn contact_pressures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.contacts(py, NodalContact::pressure)
    }

    /// 0 at nodes where nothing touches, 1 where it sticks, 2 where it slides: [sample, node].
    fn contact_status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        self.contacts(py, |nodal| nodal.status().number())
    }

    fn constraint_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let forces = |sample: &Sample| self.trajectory.constraint_forces(sample).map_err(raised);
        of_nodes(py, self.samples(), self.dimension(), forces)
    }

    /// Energies, in the order of [`energy_names`](Self::energy_names).
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.samples(), ENERGIES.len(), |sample| {
            let e = &sample.energy;
            vec![
                e.kinetic,
                e.strain,
                e.gravity,
                e.contact,
                e.springs,
                e.dissipated,
                e.supplied,
                e.balance(),
            ]
        })
    }

    #[staticmethod]
    fn energy_names() -> [&'static str; 8] {
        ENERGIES
    }

    fn centre_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let centre = |sample: &Sample| self.trajectory.centre_of_mass(sample);
        rows(py, self.samples(), self.dimension(), centre)
    }

    fn momentum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, self.samples(), self.dimension(), |sample| self.trajectory.momentum(sample))
    }

    fn angular_momentum<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let width = [0, 0, 1, 3][self.dimension()];
        rows(py, self.samples(), width, |sample| self.trajectory.angular_momentum(sample))
    }

    /// Names and units of sensors, in the order of their readings.
    #[getter]
    fn sensor_names(&self) -> Vec<(String, String)> {
        let sensors = self.trajectory.sensors().iter();
        sensors.map(|sensor| (sensor.name.clone(), sensor.unit.clone())).collect()
    }

    fn sensors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let width = self.trajectory.sensors().len();
        rows(py, self.samples(), width, |sample| sample.sensors.clone())
    }

    /// Positions of the nodes in the undeformed body.
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = self.trajectory.body().mesh().positions().to_vec();
        crate::arrays::vectors(py, positions, self.dimension())
    }

    /// Nodes of the cells, from 0.
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        crate::scene::cells(py, self.trajectory.body().mesh())
    }

    /// The bodies: their names, and their first and last node, from 0.
    fn bodies(&self) -> Vec<(String, usize, usize)> {
        let parts = self.trajectory.body().parts();
        parts.map(|part| (part.name.into(), part.nodes.start, part.nodes.end)).collect()
    }

    /// The word for the cells.
    #[getter]
    fn cell_kind(&self) -> &'static str {
        self.trajectory.body().mesh().kind().word()
    }

    /// Stress (Pa) in each cell of a sample: [cell, axis, axis].
    fn stress<'py>(&self, py: Python<'py>, sample: usize) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.tensors(py, sample, |field| field.stress)
    }

    /// Strain in each cell of a sample, as the body measures it: [cell, axis, axis].
    fn strain<'py>(&self, py: Python<'py>, sample: usize) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.tensors(py, sample, |field| field.strain)
    }

    /// Von Mises stress (Pa) in each cell of a sample.
    fn von_mises<'py>(
        &self,
        py: Python<'py>,
        sample: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let fields = self.trajectory.cell_fields(self.sample(sample)?).map_err(raised)?;
        Ok(PyArray1::from_iter(py, fields.iter().map(CellField::von_mises)))
    }

    /// The report as JSON.
    fn report_json(&self) -> String {
        report(Ok(&self.trajectory)).to_string()
    }

    fn warnings(&self) -> Vec<String> {
        self.trajectory.report().warnings()
    }

    fn __str__(&self) -> String {
        self.trajectory.report().to_string()
    }

    fn write_csv(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| write_csv(&self.trajectory, path, None)).map_err(raised)
    }

    fn write_report(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| write_report(Ok(&self.trajectory), path)).map_err(raised)
    }

    fn write_vtk(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        py.detach(|| write_vtk(&self.trajectory, directory, "body")).map_err(raised)
    }

    fn write_html(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| write_animation(&self.trajectory, path, &self.title)).map_err(raised)
    }

    fn write_svg(&self, py: Python<'_>, path: PathBuf, times: Vec<f64>) -> PyResult<()> {
        py.detach(|| Snapshots::at(times).write(&self.trajectory, path)).map_err(raised)
    }
}

const ENERGIES: [&str; 8] =
    ["kinetic", "strain", "gravity", "contact", "springs", "dissipated", "supplied", "balance"];
