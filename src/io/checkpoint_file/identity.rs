//! Identity of a scene in a file: numbers and names, and hashes of its parts.

use std::fmt::Debug;
use std::hash::Hasher;

use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher13;

use crate::scene::timeline::{Phase, Scene};

/// Identity of a scene.
///
/// Functions cannot be compared: of those in phases, obstacles and other forces only their presence is
/// recorded.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Identity {
    nodes: usize,
    cells: usize,
    dimension: usize,
    /// Names of the parts, and their hashes.
    parts: Vec<(String, String)>,
    phases: Vec<PhaseIdentity>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PhaseIdentity {
    name: String,
    until: f64,
    hash: String,
}

const HELP: &str = "read it by a simulation of the scene that it was written for";

impl Identity {
    pub(super) fn of(scene: &Scene) -> Self {
        let (body, mesh) = (scene.body(), scene.body().mesh());
        let matrices =
            [body.inertia().values(), body.stiffness().values(), body.damping().values()];
        let cells: Vec<&[usize]> = mesh.cells().collect();
        // a simulation has started with them, so there is no error
        let start = scene.initial_velocities().unwrap_or_default();
        let parts = [
            ("positions of the nodes", of_numbers([mesh.positions()])),
            ("cells", of_text(&(mesh.kind(), cells))),
            ("sets of nodes", of_text(mesh.sets())),
            ("materials", of_numbers(matrices) ^ of_text(&body)),
            ("accelerations of gravity", of_text(&scene.acceleration())),
            ("springs", of_text(scene.springs())),
            ("chambers", of_text(scene.chambers())),
            (
                "displacements and velocities at the start",
                of_numbers([scene.initial_displacements(), &start]),
            ),
            ("obstacles", of_text(scene.obstacles())),
            ("other forces", of_text(scene.other_forces())),
        ];
        let mut parts: Vec<(String, String)> =
            parts.map(|(name, hash)| (name.into(), text(hash))).into();
        if let Some(state) = scene.starting_state() {
            parts.push(("state at the start".into(), text(of_text(state))));
        }
        // a scene without gas is what it was before there was any
        if scene.has_gas() {
            parts.push(("gas".into(), text(of_text(&scene.gas_parts()))));
        }
        if !scene.liquids().is_empty() {
            parts.push(("liquids".into(), text(of_text(scene.liquids()))));
        }
        if !scene.pipes().is_empty() {
            parts.push(("pipes".into(), text(of_text(scene.pipes()))));
        }
        // as in files that were written before there were several bodies
        let tied = scene.tied().unwrap_or_default();
        let [ties, touches] = [of_text(&tied), of_text(&scene.touches())].map(text);
        if !tied.is_empty() {
            parts.push(("ties".into(), ties));
        }
        if !scene.muscles().is_empty() {
            parts.push(("muscles".into(), text(of_text(scene.muscles()))));
        }
        if !scene.growths().is_empty() {
            parts.push(("growths".into(), text(of_text(scene.growths()))));
        }
        if scene.lags().len() > 0 {
            parts.push(("lags".into(), text(of_text(&scene.lags().collect::<Vec<_>>()))));
        }
        if !scene.magnets().is_empty() {
            parts.push(("magnets".into(), text(of_text(scene.magnets()))));
        }
        if !scene.dipoles().is_empty() {
            parts.push(("dipoles".into(), text(of_text(scene.dipoles()))));
        }
        if !scene.fluids().is_empty() {
            parts.push(("fluids".into(), text(of_text(scene.fluids()))));
        }
        if !scene.touches().is_empty() {
            parts.push(("touches".into(), touches));
        }
        Self {
            nodes: mesh.node_count(),
            cells: mesh.cell_count(),
            dimension: mesh.dimension(),
            parts,
            phases: scene.phases().iter().map(PhaseIdentity::of).collect(),
        }
    }

    /// # Errors
    /// The first of these parts that differs in `scene`.
    pub(super) fn check(&self, scene: &Self) -> Result<(), String> {
        let counts = [
            ("nodes", self.nodes, scene.nodes),
            ("dimensions", self.dimension, scene.dimension),
            ("cells", self.cells, scene.cells),
            ("parts", self.parts.len(), scene.parts.len()),
            ("phases", self.phases.len(), scene.phases.len()),
        ];
        if let Some((what, ours, theirs)) = counts.iter().find(|(_, ours, theirs)| ours != theirs) {
            return Err(format!(
                "{what}: it is of a scene with {ours}, this one has {theirs}; {HELP}"
            ));
        }
        let mut parts = self.parts.iter().zip(&scene.parts);
        if let Some((_, (part, _))) = parts.find(|(ours, theirs)| ours != theirs) {
            return Err(format!("{part}: they differ from those of the scene in the file; {HELP}"));
        }
        for (number, (ours, theirs)) in (1..).zip(self.phases.iter().zip(&scene.phases)) {
            if (&ours.name, ours.until) != (&theirs.name, theirs.until) {
                let [file, here] = [ours, theirs].map(PhaseIdentity::label);
                return Err(format!(
                    "phases: number {number} is {file}, here it is {here}; {HELP}"
                ));
            }
            if ours.hash != theirs.hash {
                let name = &ours.name;
                return Err(format!(
                    "phases: what \"{name}\" holds, moves, loads or touches differs from the scene in \
                     the file; {HELP}"
                ));
            }
        }
        Ok(())
    }
}

impl PhaseIdentity {
    fn of(phase: &Phase) -> Self {
        // without a magnetic field, dipoles or an end by a sensor as in files that were written before there were any
        let said = format!("{phase:?}");
        let said = said.replace(", dipoles: []", "").replace(", magnetic_field: None", "");
        let said = said.replace(", ends: None", "");
        let mut hasher = SipHasher13::new();
        hasher.write(said.as_bytes());
        let hash = hasher.finish();
        Self { name: phase.name.clone(), until: phase.until, hash: text(hash) }
    }

    fn label(&self) -> String {
        format!("\"{}\" until {} s", self.name, self.until)
    }
}

fn of_text(part: &(impl Debug + ?Sized)) -> u64 {
    let mut hasher = SipHasher13::new();
    hasher.write(format!("{part:?}").as_bytes());
    hasher.finish()
}

fn of_numbers<const N: usize>(parts: [&[f64]; N]) -> u64 {
    let mut hasher = SipHasher13::new();
    parts.into_iter().flatten().for_each(|number| hasher.write(&number.to_le_bytes()));
    hasher.finish()
}

fn text(hash: u64) -> String {
    format!("{hash:016x}")
}
