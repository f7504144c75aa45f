//! Summary of a scene, phase by phase, with the spectrum of the body in each.

use crate::base::input::InputError;
use crate::dynamics::system::Spectrum;
use crate::scene::constraint::PhaseStart;
use crate::scene::forces::Obstacle;
use crate::scene::timeline::{Phase, Quantity, Scene};

/// Summary of a phase, with the spectrum of the body in it.
#[derive(Debug, Clone, PartialEq)]
pub struct PhaseSummary {
    /// Name of the phase.
    pub name: String,
    /// When it begins (s).
    pub start: f64,
    /// When it ends (s), at the latest.
    pub end: f64,
    /// The sensor that ends it before, and the level that this passes, in words.
    pub ends: Option<String>,
    /// Acceleration of gravity (m/s^2), if it differs from the scene's.
    pub gravity: Option<Vec<f64>>,
    /// Number of rows of its constraints: one for each component of a node that is held or moved.
    pub constraints: usize,
    /// Devices of which rows follow from other constraints and are left out: kind and name, how many rows, and of how many.
    pub redundant: Vec<(String, [usize; 2])>,
    /// Number of nodes under loads and pressures on faces, counted once for each of them.
    pub loaded_nodes: usize,
    /// Whether a magnetic field acts.
    pub has_magnetic_field: bool,
    /// Names of the springs, muscles and growths that are actuated.
    pub actuated: Vec<String>,
    /// Names of the chambers that are under pressure.
    pub pressurized: Vec<String>,
    /// Names of the obstacles that act.
    pub obstacles: Vec<String>,
    /// Spectrum of the body, in its undeformed shape and at rest.
    pub spectrum: Spectrum,
}

impl Scene {
    /// Spectrum of the body in each phase, in its undeformed shape and at rest.
    ///
    /// It shows the stiff parts of a scene, and suitable methods. Orifices count as closed.
    ///
    /// ```
    /// let scene = pliant::samples::square_jump(4)?;
    /// let free = scene.spectrum()?[2];
    /// assert!(free.highest_frequency > 4e3 && free.slowest_period().unwrap() > 0.01);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn spectrum(&self) -> Result<Vec<Spectrum>, InputError> {
        let shut = self.with_fixed_amounts();
        let forces = shut.forces()?;
        let matrices = self.matrices(&forces);
        let rest = vec![0.0; self.body().dofs()];
        let mut time = 0.0;
        let spectra = self.phases().iter().zip(forces).map(|(phase, forces)| {
            let start = PhaseStart { time, u: &rest };
            let full = self.system(&matrices, phase, forces, &start, 0.0)?;
            let mut system = self.phase_system(full, phase.name())?;
            let spectrum = system.spectrum(time, &rest, &rest);
            time = phase.until;
            Ok(spectrum)
        });
        spectra.collect()
    }

    /// Summary of each phase.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn summary(&self) -> Result<Vec<PhaseSummary>, InputError> {
        self.validate()?;
        let spectra = self.spectrum()?;
        let starts = [0.0].into_iter().chain(self.phases().iter().map(Phase::end));
        let phases = self.phases().iter().zip(starts).zip(spectra);
        phases.map(|((phase, start), spectrum)| self.summary_of(phase, start, spectrum)).collect()
    }

    fn summary_of(
        &self,
        phase: &Phase,
        start: f64,
        spectrum: Spectrum,
    ) -> Result<PhaseSummary, InputError> {
        let rows =
            self.rows(phase, &PhaseStart { time: start, u: self.initial_displacements() })?;
        let mut redundant = Vec::new();
        for (number, device) in self.devices().iter().enumerate() {
            let own = self.terms_of_device(number)?;
            let is_left_out = |terms: &&Vec<_>| rows.iter().all(|row| row.terms != **terms);
            let count = own.iter().filter(is_left_out).count();
            if count > 0 {
                let device = format!("{} \"{}\"", device.kind(), device.name());
                redundant.push((device, [count, own.len()]));
            }
        }
        let mut loaded_nodes = 0;
        let loads = phase.vectors_on_nodes().map(|(_, selection, _)| selection);
        for selection in loads.chain(phase.face_pressures().map(|(selection, _)| selection)) {
            loaded_nodes += self.body().mesh().select(selection)?.len();
        }
        let names = |quantity| phase.signals(quantity).map(|(name, _)| name.to_owned()).collect();
        let obstacles = phase.contacts(self.obstacles())?.into_iter().map(Obstacle::name);
        let gravity = phase.gravity.as_deref().filter(|own| Some(*own) != self.acceleration());
        Ok(PhaseSummary {
            name: phase.name.clone(),
            start,
            end: phase.until,
            ends: phase.ends.as_ref().map(ToString::to_string),
            gravity: gravity.map(Into::into),
            constraints: rows.len(),
            redundant,
            loaded_nodes,
            has_magnetic_field: phase.uniform_field().is_some(),
            actuated: names(Quantity::Actuation),
            pressurized: names(Quantity::Pressure),
            obstacles: obstacles.map(str::to_owned).collect(),
            spectrum,
        })
    }
}
