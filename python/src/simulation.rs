//! A scene that a program drives.

use std::path::PathBuf;
use std::sync::MutexGuard;

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pliant::simulate::Direction;
use pliant::{Selection, Signals};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::arrays::vectors;
use crate::errors::raised;
use crate::motion::Motion;
use crate::watched::{Slot, Watched, positions, value};

/// A state of a simulation, to return to.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Checkpoint(pliant::Checkpoint);

#[pymethods]
impl Checkpoint {
    /// Time (s).
    #[getter]
    fn time(&self) -> f64 {
        self.0.time()
    }

    /// Writes it to a file, for another process or another day.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        self.0.write(path).map_err(raised)
    }
}

/// A scene in motion under the control of a program.
#[pyclass(frozen, module = "pliant._pliant")]
pub struct Simulation {
    inner: Watched,
    title: String,
}

/// A value for an input of a device.
#[derive(FromPyObject)]
enum InputValue {
    Number(f64),
    Vector(Vec<f64>),
}

/// Nodes: the name of a set, a number (from 1), or several.
#[derive(FromPyObject)]
enum Nodes {
    Set(String),
    Number(usize),
    Numbers(Vec<usize>),
}

impl From<Nodes> for Selection {
    fn from(nodes: Nodes) -> Self {
        match nodes {
            Nodes::Set(name) => Self::Set(name),
            Nodes::Number(number) => Self::Numbers(vec![number]),
            Nodes::Numbers(numbers) => Self::Numbers(numbers),
        }
    }
}

impl Simulation {
    pub fn new(simulation: pliant::Simulation, title: String) -> Self {
        Self { inner: Watched::new(simulation), title }
    }

    fn lock(&self) -> PyResult<MutexGuard<'_, Slot>> {
        self.inner.lock()
    }
}

#[pymethods]
impl Simulation {
    /// Time (s).
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.lock()?.time())
    }

    /// End of the scene (s).
    #[getter]
    fn end(&self) -> PyResult<f64> {
        Ok(self.lock()?.scene().end())
    }

    /// Name of the phase.
    #[getter]
    fn phase(&self) -> PyResult<String> {
        Ok(self.lock()?.phase().to_owned())
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> PyResult<usize> {
        Ok(self.lock()?.steps())
    }

    /// Displacements (m): [node, axis].
    #[getter]
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let simulation = self.lock()?;
        let view = simulation.view();
        vectors(py, view.displacements().to_vec(), view.body().dimension())
    }

    /// Velocities (m/s): [node, axis].
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let simulation = self.lock()?;
        let view = simulation.view();
        vectors(py, view.velocities().to_vec(), view.body().dimension())
    }

    /// Places of all nodes (m): [node, axis].
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        positions(py, &self.lock()?.view())
    }

    /// Mean position (m) of nodes.
    fn position<'py>(&self, py: Python<'py>, nodes: Nodes) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let position = self.lock()?.view().position(nodes).map_err(raised)?;
        Ok(PyArray1::from_vec(py, position))
    }

    /// Mean velocity (m/s) of nodes.
    fn velocity<'py>(&self, py: Python<'py>, nodes: Nodes) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let velocity = self.lock()?.view().velocity(nodes).map_err(raised)?;
        Ok(PyArray1::from_vec(py, velocity))
    }

    /// Centre of mass (m).
    fn centre_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.lock()?.view().centre_of_mass()))
    }

    /// Velocity of the centre of mass (m/s).
    fn mean_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.lock()?.view().mean_velocity()))
    }

    /// Angle (rad) by which a body in the plane has turned.
    fn rotation(&self) -> PyResult<Option<f64>> {
        Ok(self.lock()?.view().rotation())
    }

    /// Absolute pressure (Pa) of the gas in a chamber.
    fn absolute_pressure(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().absolute_pressure(chamber).map_err(raised)
    }

    /// Amount of gas (kg) in a chamber.
    fn gas_amount(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().gas_amount(chamber).map_err(raised)
    }

    /// Flow of gas (kg/s) through an orifice.
    fn gas_flow(&self, orifice: &str) -> PyResult<f64> {
        self.lock()?.view().gas_flow(orifice).map_err(raised)
    }

    /// Volume (m^3) of the liquid in a chamber, as it is without pressure.
    fn liquid_volume(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().liquid_volume(chamber).map_err(raised)
    }

    /// Height (m) of the surface of the liquid in a chamber above the origin, against gravity.
    fn liquid_level(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().liquid_level(chamber).map_err(raised)
    }

    /// Flow of liquid (m^3/s) through a pipe, from its first end to its second.
    fn pipe_flow(&self, pipe: &str) -> PyResult<f64> {
        self.lock()?.view().pipe_flow(pipe).map_err(raised)
    }

    /// Flow of liquid (m^3/s) into a chamber.
    fn liquid_flow(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().liquid_flow(chamber).map_err(raised)
    }

    /// Pressure (Pa) in a chamber.
    fn pressure(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().pressure(chamber).map_err(raised)
    }

    /// Volume (m^3) of a chamber.
    fn chamber_volume(&self, chamber: &str) -> PyResult<f64> {
        self.lock()?.view().chamber_volume(chamber).map_err(raised)
    }

    /// Stress (Pa) by which a muscle pulls.
    fn muscle_stress(&self, muscle: &str) -> PyResult<f64> {
        self.lock()?.view().muscle_stress(muscle).map_err(raised)
    }

    /// Stretch of the fibres of a muscle relative to the undeformed shape: their mean.
    fn muscle_stretch(&self, muscle: &str) -> PyResult<f64> {
        self.lock()?.view().muscle_stretch(muscle).map_err(raised)
    }

    /// Activation (0 to 1) of a muscle with Hill's law.
    fn activation(&self, muscle: &str) -> PyResult<f64> {
        self.lock()?.view().activation(muscle).map_err(raised)
    }

    /// Actuation of an actuator, after its lag if it has one.
    fn actuation(&self, actuator: &str) -> PyResult<f64> {
        self.lock()?.view().actuation(actuator).map_err(raised)
    }

    /// Temperature rise (K) of a heated actuator above its surroundings.
    fn temperature(&self, actuator: &str) -> PyResult<f64> {
        self.lock()?.view().temperature(actuator).map_err(raised)
    }

    /// Magnetic moment (A m^2) of all magnets.
    fn magnetic_moment<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.lock()?.view().magnetic_moment()))
    }

    /// Position of a dipole (m).
    fn dipole_position<'py>(
        &self,
        py: Python<'py>,
        dipole: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let position = self.lock()?.view().dipole_position(dipole).map_err(raised)?;
        Ok(PyArray1::from_vec(py, position))
    }

    /// Force (N) of a dipole on all magnets.
    fn dipole_force<'py>(
        &self,
        py: Python<'py>,
        dipole: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let force = self.lock()?.view().dipole_force(dipole).map_err(raised)?;
        Ok(PyArray1::from_vec(py, force))
    }

    /// Output of a device.
    fn device_output<'py>(
        &self,
        py: Python<'py>,
        device: &str,
        output: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let value = self.lock()?.view().device(device, output).map_err(raised)?;
        Ok(PyArray1::from_vec(py, value))
    }

    /// Force (N) of a fluid on the bodies.
    fn fluid_force<'py>(
        &self,
        py: Python<'py>,
        fluid: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let force = self.lock()?.view().fluid_force(fluid).map_err(raised)?;
        Ok(PyArray1::from_vec(py, force))
    }

    /// Length (m) of a spring.
    fn spring_length(&self, spring: &str) -> PyResult<f64> {
        self.lock()?.view().spring_length(spring).map_err(raised)
    }

    /// Pull (N) of a spring.
    fn spring_pull(&self, spring: &str) -> PyResult<f64> {
        self.lock()?.view().spring_pull(spring).map_err(raised)
    }

    /// Force (N) of an obstacle on the body.
    fn contact_force<'py>(
        &self,
        py: Python<'py>,
        obstacle: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let force = self.lock()?.view().contact_force(obstacle).map_err(raised)?;
        Ok(PyArray1::from_vec(py, force))
    }

    /// Energies (J) by name.
    #[getter]
    fn energy(&self) -> PyResult<Vec<(&'static str, f64)>> {
        let e = self.lock()?.energy();
        Ok(vec![
            ("kinetic", e.kinetic),
            ("strain", e.strain),
            ("gravity", e.gravity),
            ("contact", e.contact),
            ("springs", e.springs),
            ("dissipated", e.dissipated),
            ("supplied", e.supplied),
        ])
    }

    /// Takes one step of the integrator; whether the scene goes on.
    fn step(&self, py: Python<'_>) -> PyResult<bool> {
        self.inner.detached(py, pliant::Simulation::step)
    }

    /// Advances to a time (s).
    fn advance_to(&self, py: Python<'_>, time: f64) -> PyResult<bool> {
        self.inner.advancing(py, |simulation| simulation.advance_to(time))
    }

    /// Advances by a time (s).
    fn advance_by(&self, py: Python<'_>, dt: f64) -> PyResult<bool> {
        self.inner.advancing(py, |simulation| simulation.advance_by(dt))
    }

    /// Advances to a time (s), at most until `event(time, positions, velocities)` changes its sign; whether it did.
    fn advance_until(&self, py: Python<'_>, time: f64, event: Py<PyAny>) -> PyResult<bool> {
        let mut error = None;
        let met = {
            let error = &mut error;
            self.inner.advancing(py, move |simulation| {
                simulation.advance_until(time, |view| {
                    Python::attach(|py| value(py, &event, view)).unwrap_or_else(|raised| {
                        error.get_or_insert(raised);
                        f64::NAN
                    })
                })
            })
        };
        error.map_or(met, Err)
    }

    /// Calls `action()` wherever `event(time, positions, velocities)` changes its sign: upwards (1), downwards (-1), or
    /// both (0). An action that returns True stops the advance.
    fn when(&self, event: Py<PyAny>, action: Py<PyAny>, direction: i32) -> PyResult<()> {
        let direction = match direction {
            1.. => Direction::Rising,
            0 => Direction::Either,
            _ => Direction::Falling,
        };
        self.inner.when(event, action, direction)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.inner.traverse(&visit)
    }

    fn __clear__(&self) {
        self.inner.clear();
    }

    /// Sets the pressure (Pa) in a chamber.
    fn set_pressure(&self, chamber: &str, pressure: f64) -> PyResult<()> {
        self.lock()?.pressure(chamber, pressure).map_err(raised)
    }

    /// Sets how far an orifice is open, from 0 to 1.
    fn open(&self, orifice: &str, opening: f64) -> PyResult<()> {
        self.lock()?.open(orifice, opening).map_err(raised)
    }

    /// Sets the flow of liquid (m^3/s) into a chamber.
    fn flow(&self, chamber: &str, flow: f64) -> PyResult<()> {
        self.lock()?.flow(chamber, flow).map_err(raised)
    }

    /// Sets the force (N) of the actuator of a spring.
    fn actuate(&self, spring: &str, force: f64) -> PyResult<()> {
        self.lock()?.actuate(spring, force).map_err(raised)
    }

    /// Sets a force (N) on each of the nodes.
    fn load(&self, nodes: Nodes, force: Vec<f64>) -> PyResult<()> {
        self.lock()?.load(nodes, force).map_err(raised)
    }

    /// Sets a moment (N m) on nodes together.
    fn moment(&self, nodes: Nodes, moment: Vec<f64>) -> PyResult<()> {
        self.lock()?.moment(nodes, moment).map_err(raised)
    }

    /// Sets a force (N) on nodes together that turns with them.
    fn follower_force(&self, nodes: Nodes, force: Vec<f64>) -> PyResult<()> {
        self.lock()?.follower_force(nodes, force).map_err(raised)
    }

    /// Sets a moment (N m) on nodes together that turns with them.
    fn follower_moment(&self, nodes: Nodes, moment: Vec<f64>) -> PyResult<()> {
        self.lock()?.follower_moment(nodes, moment).map_err(raised)
    }

    /// Sets an input of a device.
    fn set_input(&self, device: &str, word: &str, value: InputValue) -> PyResult<()> {
        let mut simulation = self.lock()?;
        let set = match value {
            InputValue::Number(number) => simulation.device_input(device, word, number),
            InputValue::Vector(vector) => {
                simulation.device_input(device, word, Signals::from(vector))
            }
        };
        set.map_err(raised)
    }

    /// Sets the magnetic field (T) that acts on magnets.
    fn set_magnetic_field(&self, field: Vec<f64>) -> PyResult<()> {
        self.lock()?.magnetic_field(field).map_err(raised)
    }

    /// Sets the position (m) of a dipole.
    fn set_dipole_position(&self, dipole: &str, position: Vec<f64>) -> PyResult<()> {
        self.lock()?.dipole_position(dipole, position).map_err(raised)
    }

    /// Sets the moment (A m^2) of a dipole.
    fn set_dipole_moment(&self, dipole: &str, moment: Vec<f64>) -> PyResult<()> {
        self.lock()?.dipole_moment(dipole, moment).map_err(raised)
    }

    /// Holds nodes where they are.
    fn hold(&self, nodes: Nodes) -> PyResult<()> {
        self.lock()?.hold(nodes).map_err(raised)
    }

    /// Moves nodes with a constant velocity (m/s).
    fn move_nodes(&self, nodes: Nodes, velocity: Vec<f64>) -> PyResult<()> {
        self.lock()?.move_nodes(nodes, velocity).map_err(raised)
    }

    /// Frees nodes that are held or moved.
    fn release(&self, nodes: Nodes) -> PyResult<()> {
        self.lock()?.release(nodes).map_err(raised)
    }

    /// Lets an obstacle act, or not.
    fn contact(&self, obstacle: &str, acts: bool) -> PyResult<()> {
        self.lock()?.contact(obstacle, acts).map_err(raised)
    }

    /// Moves an obstacle on with a constant velocity (m/s).
    fn move_obstacle(&self, obstacle: &str, velocity: Vec<f64>) -> PyResult<()> {
        self.lock()?.move_obstacle(obstacle, velocity).map_err(raised)
    }

    /// Gives the body other displacements (m) and velocities (m/s), as by an impact.
    fn change_state(
        &self,
        displacements: PyReadonlyArray2<'_, f64>,
        velocities: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let flat = |array: &PyReadonlyArray2<'_, f64>| -> Vec<f64> {
            array.as_array().iter().copied().collect()
        };
        let (new_u, new_v) = (flat(&displacements), flat(&velocities));
        let mut simulation = self.lock()?;
        for (name, new) in [("displacements", &new_u), ("velocities", &new_v)] {
            let needed = simulation.view().displacements().len();
            if new.len() != needed {
                let help = format!("it needs {needed} numbers, those of all nodes along all axes");
                let (input, value) = (format!("number of {name}"), new.len().to_string());
                return Err(raised(pliant::InputError { input, value, help }));
            }
        }
        let changed = simulation.change_state(|u, v| {
            u.copy_from_slice(&new_u);
            v.copy_from_slice(&new_v);
        });
        changed.map_err(raised)
    }

    /// Keeps the present state.
    fn checkpoint(&self) -> PyResult<Checkpoint> {
        Ok(Checkpoint(self.lock()?.checkpoint()))
    }

    /// Returns to a state.
    fn restore(&self, checkpoint: &Checkpoint) -> PyResult<()> {
        self.lock()?.restore(&checkpoint.0).map_err(raised)
    }

    /// A state from a file.
    fn read_checkpoint(&self, path: PathBuf) -> PyResult<Checkpoint> {
        self.lock()?.read_checkpoint(path).map(Checkpoint).map_err(raised)
    }

    /// An independent simulation that goes on from here.
    fn fork(&self) -> PyResult<Self> {
        let fork = self.lock()?.fork().map_err(raised)?;
        Ok(Self::new(fork, self.title.clone()))
    }

    /// The motion so far.
    fn motion(&self) -> PyResult<Motion> {
        Ok(Motion::new(self.lock()?.trajectory().clone(), self.title.clone(), None))
    }
}
