//! The columns of the table of a motion.

use crate::base::input::InputError;
use crate::dynamics::system::Energy;
use crate::dynamics::trajectory::{Quantity, Sample, Trajectory};
use crate::elements::mesh::Selection;
use crate::scene::constraint::Constrained;

const AXES: [&str; 3] = ["x", "y", "z"];

/// Energies that are stored.
pub(super) const STORED: [&str; 5] = ["kinetic", "strain", "gravity", "contact", "springs"];
/// Energies that were dissipated and supplied since t = 0.
pub(super) const EXCHANGED: [&str; 2] = ["dissipated", "supplied"];

pub(super) fn stored(energy: &Energy) -> [f64; 5] {
    [energy.kinetic, energy.strain, energy.gravity, energy.contact, energy.springs]
}

/// A kind of columns.
pub(super) struct ColumnKind {
    /// Their name, without axes; words in `<>` stand for what differs.
    pub(super) name: &'static str,
    pub(super) along: Along,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
}

/// Number of columns of a kind.
#[derive(Clone, Copy)]
pub(super) enum Along {
    /// One.
    None,
    /// One for each axis.
    Axes,
    /// As rotations have components: none in one dimension, one in the plane, three in space.
    Rotations,
    /// As many as a sensor has components, with names and units of their own.
    Sensor,
    /// Those that a verified motion has, which stand among its sensors.
    Verified,
}

/// Name of the column with the distance from a run with a looser tolerance, and the ending of the names of
/// the sensors' differences from that run.
pub(crate) const DIFFERENCE: &str = "difference";
pub(crate) const OF_SENSOR: &str = ".difference";

const TRACKED: &str = "u<N>";
const SENSOR: &str = "<sensor>";
const REACTION: &str = "reaction_<nodes>";

/// All kinds, in their order.
pub(super) const COLUMNS: [ColumnKind; 17] = [
    kind("t", Along::None, "s", "time"),
    kind("com", Along::Axes, "m", "centre of mass"),
    kind("momentum", Along::Axes, "kg m/s", "momentum"),
    kind(
        "angular_momentum",
        Along::Rotations,
        "kg m^2/s",
        "angular momentum about the centre of mass; `angular_momentum_x`, ... in three dimensions, none in one",
    ),
    kind(STORED[0], Along::None, "J", "kinetic energy"),
    kind(STORED[1], Along::None, "J", "strain energy"),
    kind(STORED[2], Along::None, "J", "potential energy of gravity"),
    kind(STORED[3], Along::None, "J", "energy of the contacts"),
    kind(STORED[4], Along::None, "J", "energy of the springs"),
    kind("constraint_drift", Along::None, "m", "largest error of a constraint"),
    kind(
        TRACKED,
        Along::Axes,
        "m",
        "displacement of each tracked node N, counted from 1 (`track` in `[output]`)",
    ),
    kind(
        SENSOR,
        Along::Sensor,
        "its own",
        "what a sensor reads; each of its components is a column. Equilibria on the way to the load have `load factor`",
    ),
    kind(
        DIFFERENCE,
        Along::Verified,
        "m",
        "root mean square distance of the nodes from where the run before had them, by ten times the tolerance, with \
         `--accuracy`",
    ),
    kind(
        "<sensor>.difference",
        Along::Verified,
        "its own",
        "likewise, how far a sensor was from there",
    ),
    kind(EXCHANGED[0], Along::None, "J", "energy turned into heat since t = 0"),
    kind(EXCHANGED[1], Along::None, "J", "energy supplied from outside since t = 0"),
    kind(
        REACTION,
        Along::Axes,
        "N",
        "force of the constraints on the nodes that a phase holds or moves together, by the name of their set or \
         their numbers; 0 in phases in which nothing holds them",
    ),
];

const fn kind(
    name: &'static str,
    along: Along,
    unit: &'static str,
    meaning: &'static str,
) -> ColumnKind {
    ColumnKind { name, along, unit, meaning }
}

impl ColumnKind {
    /// Whether a column with this name is of this kind.
    fn has(&self, column: &str) -> bool {
        let stem = match (column.rsplit_once('_'), self.along) {
            (_, Along::Sensor | Along::Verified) => return false,
            (Some((stem, axis)), Along::Axes | Along::Rotations) if AXES.contains(&axis) => stem,
            (_, Along::Axes) => return false,
            (_, Along::None | Along::Rotations) => column,
        };
        let is_number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
        match self.name {
            TRACKED => stem.strip_prefix('u').is_some_and(is_number),
            REACTION => stem.starts_with("reaction_"),
            name => stem == name,
        }
    }
}

/// Which columns there are besides those of every motion.
pub(super) struct Columns {
    /// Tracked nodes, counted from 0.
    tracked: Vec<usize>,
    /// Constrained node sets of the phases: name and nodes of each.
    constrained: Vec<(String, Vec<usize>)>,
}

impl Columns {
    /// # Errors
    /// Nodes or sets that do not exist; a sensor with the name of another column.
    pub(super) fn new(
        trajectory: &Trajectory,
        track: Option<&Selection>,
    ) -> Result<Self, InputError> {
        let scene = trajectory.scene();
        let mesh = scene.body().mesh();
        let tracked = track.map(|selection| mesh.select(selection)).transpose()?;
        let mut seen: Vec<&Selection> = Vec::new();
        let mut constrained: Vec<(String, Vec<usize>)> = Vec::new();
        for constraint in scene.phases().iter().flat_map(|phase| &phase.constraints) {
            let Constrained::Nodes(selection, _) = &constraint.what else { continue };
            if seen.contains(&selection) {
                continue;
            }
            seen.push(selection);
            let name = label(selection);
            let same =
                |other: &&(String, _)| other.0 == name || other.0.starts_with(&format!("{name} "));
            let name = match constrained.iter().filter(same).count() {
                0 => name,
                count => format!("{name} {}", count + 1),
            };
            constrained.push((name, mesh.select(selection)?));
        }
        let columns = Self { tracked: tracked.unwrap_or_default(), constrained };
        let all = columns.quantities(trajectory);
        let is_double =
            |sensor: &&Quantity| all.iter().filter(|column| column.name == sensor.name).count() > 1;
        match trajectory.sensors().iter().find(is_double) {
            None => Ok(columns),
            Some(Quantity { name, .. }) => {
                let help = "a column of tables has it: name the sensor otherwise";
                Err(InputError::new("name of a sensor", format!("\"{name}\""), help))
            }
        }
    }

    /// Their names and units.
    pub(super) fn quantities(&self, trajectory: &Trajectory) -> Vec<Quantity> {
        let dimension = trajectory.body().dimension();
        let mut all = Vec::new();
        for kind in &COLUMNS {
            let stems: Vec<String> = match kind.name {
                TRACKED => self.tracked.iter().map(|node| format!("u{}", node + 1)).collect(),
                REACTION => {
                    self.constrained.iter().map(|(name, _)| format!("reaction_{name}")).collect()
                }
                name => vec![name.into()],
            };
            let column = |name| Quantity { name, unit: kind.unit.into() };
            let axes = match (kind.along, dimension) {
                (Along::Sensor, _) => {
                    all.extend(trajectory.sensors().iter().cloned());
                    continue;
                }
                (Along::None, _) | (Along::Rotations, 2) => {
                    all.extend(stems.into_iter().map(column));
                    continue;
                }
                (Along::Verified, _) | (Along::Rotations, 1) => continue,
                (Along::Axes | Along::Rotations, _) => &AXES[..dimension],
            };
            for stem in stems {
                all.extend(axes.iter().map(|axis| column(format!("{stem}_{axis}"))));
            }
        }
        all
    }

    /// The values of a sample in these columns.
    pub(super) fn row(&self, trajectory: &Trajectory, sample: &Sample) -> Vec<f64> {
        let dimension = trajectory.body().dimension();
        let energy = &sample.energy;
        let mut row = vec![sample.time];
        row.extend(trajectory.centre_of_mass(sample));
        row.extend(trajectory.momentum(sample));
        row.extend(trajectory.angular_momentum(sample));
        row.extend(stored(energy));
        row.push(sample.constraint_drift);
        row.extend(self.tracked.iter().flat_map(|node| &sample.u[node * dimension..][..dimension]));
        row.extend(&sample.sensors);
        row.extend([energy.dissipated, energy.supplied]);
        if !self.constrained.is_empty() {
            // samples of this trajectory have them
            let forces = trajectory.constraint_forces(sample);
            let forces = forces.unwrap_or_else(|_| vec![f64::NAN; sample.u.len()]);
            for (_, nodes) in &self.constrained {
                let along =
                    |axis| nodes.iter().map(|node| forces[node * dimension + axis]).sum::<f64>();
                row.extend((0..dimension).map(along));
            }
        }
        row
    }
}

/// A name for the nodes of a constraint: that of the set, or the numbers; if they are many, the first and the
/// last.
fn label(selection: &Selection) -> String {
    match selection {
        Selection::Set(name) => name.clone(),
        Selection::Numbers(numbers) if numbers.len() <= 3 => {
            numbers.iter().map(usize::to_string).collect::<Vec<_>>().join("_")
        }
        Selection::Numbers(numbers) => {
            let ends = [numbers.first(), numbers.last()];
            ends.into_iter().flatten().map(usize::to_string).collect::<Vec<_>>().join("_to_")
        }
        Selection::Box { .. } => "box".into(),
    }
}

/// Unit of a standard column; `None` of others, which are sensors.
pub(super) fn standard_unit(name: &str) -> Option<&'static str> {
    COLUMNS.iter().find(|kind| kind.has(name)).map(|kind| kind.unit)
}
