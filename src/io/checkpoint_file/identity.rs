//! Identity of a scene in a file: numbers and names, and hashes of its parts.

use std::collections::BTreeMap;
use std::fmt::{self, Debug};
use std::hash::Hasher;

use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher13;

use crate::scene::forces::VectorSignal;
use crate::scene::timeline::{ContactWith, Input, LoadKind, Phase, Quantity, STEER, Scene};

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
        let actuators = |list: &str| scene.actuators_in(list).collect::<Vec<_>>();
        let parts = [
            ("positions of the nodes", of_numbers([mesh.positions()])),
            ("cells", of_text(&(mesh.kind(), cells))),
            ("sets of nodes", of_text(mesh.sets())),
            ("materials", of_numbers(matrices) ^ of_text(&body)),
            ("accelerations of gravity", of_text(&scene.acceleration())),
            ("springs", of_text(&actuators("springs"))),
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
        let tied = scene.tied().unwrap_or_default();
        let lags: Vec<_> = scene.lags().collect();
        // a scene without them keeps its identity from before they existed
        let others = [
            ("state at the start", scene.starting_state().map(of_text)),
            ("gas", scene.has_gas().then(|| of_text(&scene.gas_parts()))),
            ("liquids", of_list(scene.liquids())),
            ("pipes", of_list(scene.pipes())),
            ("ties", of_list(&tied)),
            ("muscles", of_list(&actuators("muscles"))),
            ("growths", of_list(&actuators("growths"))),
            ("lags", of_list(&lags)),
            ("magnets", of_list(scene.magnets())),
        ];
        let mut devices: BTreeMap<&str, Vec<_>> = BTreeMap::new();
        for device in scene.devices() {
            devices.entry(device.kind()).or_default().push(device);
        }
        let devices = devices.into_iter().map(|(kind, own)| (format!("{kind}s"), of_list(&own)));
        let last = [("fluids", of_list(scene.fluids())), ("touches", of_list(scene.touches()))];
        let named = |(name, hash): (&str, _)| (name.to_owned(), hash);
        let others = others.map(named).into_iter().chain(devices).chain(last.map(named));
        parts.extend(others.filter_map(|(name, hash)| Some((name, text(hash?)))));
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
        let mut hasher = SipHasher13::new();
        hasher.write(format!("{:?}", Text(phase)).as_bytes());
        let hash = hasher.finish();
        Self { name: phase.name.clone(), until: phase.until, hash: text(hash) }
    }

    fn label(&self) -> String {
        format!("\"{}\" until {} s", self.name, self.until)
    }
}

/// The text of a phase that its hash is of. Inputs stand by their quantities, and what is absent is left out where it was added later, so
/// that files of earlier versions can be read.
struct Text<'a>(&'a Phase);

impl fmt::Debug for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(phase) = self;
        let named = |quantity| {
            let own = phase.inputs.iter().filter(move |input| input.quantity == quantity);
            own.filter_map(|input| Some((input.target.names().first()?, &input.signal)))
                .collect::<Vec<_>>()
        };
        let actuations = phase.inputs.iter().filter(|i| i.quantity == Quantity::Actuation);
        let actuations = actuations.map(|input| (input.target.names(), &input.signal));
        let loads = phase.loads().map(|(nodes, kind, value)| (nodes, LoadText { kind, value }));
        let mut text = f.debug_struct("Phase");
        text.field("name", &phase.name).field("until", &phase.until);
        if phase.ends.is_some() {
            text.field("ends", &phase.ends);
        }
        text.field("gravity", &phase.gravity)
            .field("constraints", &phase.constraints)
            .field("loads", &loads.collect::<Vec<_>>())
            .field("actuations", &actuations.collect::<Vec<_>>())
            .field("pressures", &named(Quantity::Pressure))
            .field("openings", &named(Quantity::Opening))
            .field("flows", &named(Quantity::Flow))
            .field("face_pressures", &phase.face_pressures().collect::<Vec<_>>())
            .field("projects_velocity", &phase.projects_velocity)
            .field("contact", &phase.contact)
            .field("redirected", &phase.redirected);
        let is_free = matches!(&phase.contact, ContactWith::These(names) if names.is_empty());
        if !phase.has_touch && !is_free {
            text.field("touch", &false);
        }
        if let Some(field) = phase.field() {
            text.field("magnetic_field", &Some(field));
        }
        // inputs of devices with a list of their own, list by list
        let mut lists: BTreeMap<&str, Vec<_>> = BTreeMap::new();
        for Input { quantity, target, signal } in &phase.inputs {
            if let (Quantity::Device(own), Some(name)) = (quantity, target.names().first())
                && own.keys != STEER
            {
                lists.entry(own.keys[1]).or_default().push((name, Capital(own.word), signal));
            }
        }
        for (of, list) in &lists {
            text.field(&format!("{of}s"), list);
        }
        use Quantity::*;
        let is_later = |input: &&Input| match input.quantity {
            Actuation | Pressure | Opening | Flow | FacePressure | Load(_) | Field => false,
            Device(own) => own.keys == STEER,
            _ => true,
        };
        let later: Vec<_> = phase.inputs.iter().filter(is_later).collect();
        if !later.is_empty() {
            text.field("inputs", &later);
        }
        text.finish()
    }
}

/// A word with a capital.
struct Capital<'a>(&'a str);

impl fmt::Debug for Capital<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, rest) = self.0.split_at(1);
        write!(f, "{}{rest}", first.to_uppercase())
    }
}

/// A load in that text.
struct LoadText<'a> {
    kind: LoadKind,
    value: &'a VectorSignal,
}

impl fmt::Debug for LoadText<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Load").field("kind", &self.kind).field("value", self.value).finish()
    }
}

/// The hash of a list that is not empty.
fn of_list<T: Debug>(list: &[T]) -> Option<u64> {
    (!list.is_empty()).then(|| of_text(list))
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
