//! Contents of a checkpoint file.

use serde::{Deserialize, Serialize};

use super::commands::PhaseOverrides;
use super::identity::Identity;
use crate::base::input::{InputError, finite};
use crate::dynamics::simulate::{Angles, Checkpoint, Choice, Kept};
use crate::dynamics::state::Layout;
use crate::scene::timeline::Scene;

/// Format of the files that this version writes, and the least that it reads. In format 5, inputs of phases stand by their quantities.
const FORMAT: u32 = 6;
const LEAST_FORMAT: u32 = 5;

/// File type, as written in the file.
pub(super) const WHAT: &str = "pliant checkpoint";

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Larger counts do not occur in a simulation.
const MOST: u64 = 1 << 53;

/// Header of a file: its type and format number, readable in every format.
#[derive(Deserialize)]
pub(super) struct Head {
    what: String,
    format: u32,
    version: String,
}

/// A checkpoint, in SI units.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Record {
    what: String,
    format: u32,
    /// Version of pliant that wrote the file.
    version: String,
    scene: Identity,
    time: f64,
    /// Number of the phase in force, from 0.
    phase: usize,
    in_force: PhaseOverrides,
    #[serde(deserialize_with = "Option::deserialize")]
    chosen: Option<Choice>,
    #[serde(deserialize_with = "Option::deserialize")]
    next_step: Option<f64>,
    steps: usize,
    load_commands: usize,
    energy_balance: f64,
    /// Error, rise and scale of the energy balance.
    energies_noted: [f64; 3],
    dissipated: f64,
    supplied: f64,
    /// Start of each constraint: displacement and time.
    constraint_starts: Vec<[f64; 4]>,
    displacements: Vec<f64>,
    velocities: Vec<f64>,
    /// Of Maxwell branches.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    internal_strains: Vec<f64>,
    /// Of gas that flows (kg).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    amounts: Vec<f64>,
    /// The angles that sensors read, in turns, by the names of the sensors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    angles: Vec<(String, f64)>,
}

impl Head {
    /// # Errors
    /// Another kind of file, another format.
    pub(super) fn check(&self) -> Result<(), String> {
        let Self { what, format, version } = self;
        if what != WHAT {
            return Err(format!("it does not say \"{WHAT}\": name a file of `Checkpoint::write`"));
        }
        if !(LEAST_FORMAT..=FORMAT).contains(format) {
            let help = format!("this version, {VERSION}, reads formats {LEAST_FORMAT} to {FORMAT}");
            return Err(format!("it has format {format} of pliant {version}: {help}"));
        }
        Ok(())
    }
}

impl Record {
    pub(super) fn new(checkpoint: &Checkpoint) -> Result<Self, InputError> {
        let (scene, kept) = (checkpoint.scene(), checkpoint.kept());
        finite("the state", &kept.state)?;
        finite("the energy balance", &[&kept.energies[..], &[kept.balance]].concat())?;
        let layout = Layout::of_scene(scene);
        let state = layout.of(&kept.state);
        let (strains, amounts) = layout.split(state.internal);
        Ok(Self {
            what: WHAT.into(),
            format: FORMAT,
            version: VERSION.into(),
            scene: Identity::of(scene),
            time: kept.time,
            phase: kept.number,
            in_force: PhaseOverrides::of(&kept.phase, &scene.phases()[kept.number])?,
            chosen: checkpoint.choice(),
            next_step: kept.first_step,
            steps: kept.steps,
            load_commands: kept.commands,
            energy_balance: kept.balance,
            energies_noted: kept.energies,
            dissipated: state.dissipated,
            supplied: state.supplied,
            constraint_starts: kept.origins.clone(),
            displacements: state.u.into(),
            velocities: state.v.into(),
            internal_strains: strains.into(),
            amounts: amounts.into(),
            angles: kept.angles.0.clone(),
        })
    }

    /// Contents of the record, checked against `scene`.
    ///
    /// # Errors
    /// Another scene, numbers out of range, names that the scene does not have.
    pub(super) fn read(self, scene: &Scene) -> Result<(Kept, Option<Choice>), String> {
        self.scene.check(&Identity::of(scene)).map_err(|differs| match self.version.as_str() {
            VERSION => differs,
            other => format!("{differs} (written by pliant {other}, read by {VERSION})"),
        })?;
        let Layout { dofs, strains, amounts } = Layout::of_scene(scene);
        for (what, numbers, needed) in [
            ("displacements", &self.displacements, dofs),
            ("velocities", &self.velocities, dofs),
            ("internal strains", &self.internal_strains, strains),
            ("amounts of gas and states of lags", &self.amounts, amounts),
        ] {
            if numbers.len() != needed {
                let found = numbers.len();
                return Err(format!(
                    "it has {found} {what}, the body has {needed}: recreate the checkpoint"
                ));
            }
        }
        let phases = scene.phases();
        let Some(phase) = phases.get(self.phase) else {
            let (number, count) = (self.phase, phases.len());
            return Err(format!(
                "phase {number} is outside 0 to {}: recreate the checkpoint",
                count - 1
            ));
        };
        let begin = self.phase.checked_sub(1).map_or(0.0, |before| phases[before].until);
        if !(begin..=phase.until).contains(&self.time) {
            let (name, until, time) = (&phase.name, phase.until, self.time);
            return Err(format!(
                "time {time} s is not in phase \"{name}\", from {begin} s to {until} s: recreate the checkpoint"
            ));
        }
        if let Some(step) = self.next_step.filter(|step| *step <= 0.0) {
            return Err(format!("next_step {step} s is not above 0: recreate the checkpoint"));
        }
        let patience = self.chosen.as_ref().map_or(0, |chosen| chosen.patience);
        for (what, count) in
            [("steps", self.steps), ("load_commands", self.load_commands), ("patience", patience)]
        {
            if count as u64 > MOST {
                return Err(format!("{what} {count} is above {MOST}: recreate the checkpoint"));
            }
        }
        let energies = vec![self.dissipated, self.supplied];
        let kept = Kept {
            time: self.time,
            state: [
                self.displacements,
                self.velocities,
                self.internal_strains,
                self.amounts,
                energies,
            ]
            .concat(),
            phase: self.in_force.read(phase, scene)?.into(),
            number: self.phase,
            is_commanded: true,
            origins: self.constraint_starts,
            first_step: self.next_step,
            steps: self.steps,
            commands: self.load_commands,
            balance: self.energy_balance,
            energies: self.energies_noted,
            angles: Angles(self.angles),
        };
        Ok((kept, self.chosen))
    }
}
