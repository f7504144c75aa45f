//! The columns of the table of a motion.

use crate::constraint::Constrained;
use crate::input::InputError;
use crate::mesh::Selection;
use crate::system::Energy;
use crate::trajectory::{Quantity, Sample, Trajectory};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Energies that are stored.
pub(super) const STORED: [&str; 5] = ["kinetic", "strain", "gravity", "contact", "springs"];
/// Energies that have gone and come since t = 0.
pub(super) const EXCHANGED: [&str; 2] = ["dissipated", "supplied"];

pub(super) fn stored(energy: &Energy) -> [f64; 5] {
    [energy.kinetic, energy.strain, energy.gravity, energy.contact, energy.springs]
}

/// Which columns there are besides those of every motion.
pub(super) struct Columns {
    /// Tracked nodes, counted from 0.
    tracked: Vec<usize>,
    /// What the phases hold or move: a name each, and the nodes.
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
                let mend = "a column of tables has it: name the sensor otherwise";
                Err(InputError::new("name of a sensor", format!("\"{name}\""), mend))
            }
        }
    }

    /// Their names and units.
    pub(super) fn quantities(&self, trajectory: &Trajectory) -> Vec<Quantity> {
        let dimension = trajectory.body().dimension();
        let mut all = Vec::new();
        let mut add = |name: &str, unit: &str| {
            all.push(Quantity { name: name.to_owned(), unit: unit.to_owned() });
        };
        let vector = |name: &str, unit: &str, add: &mut dyn FnMut(&str, &str)| {
            AXES[..dimension].iter().for_each(|axis| add(&format!("{name}_{axis}"), unit));
        };
        add("t", "s");
        vector("com", "m", &mut add);
        vector("momentum", "kg m/s", &mut add);
        match dimension {
            1 => {}
            2 => add("angular_momentum", "kg m^2/s"),
            _ => vector("angular_momentum", "kg m^2/s", &mut add),
        }
        STORED.iter().for_each(|name| add(name, "J"));
        add("constraint_drift", "m");
        for node in &self.tracked {
            vector(&format!("u{}", node + 1), "m", &mut add);
        }
        for Quantity { name, unit } in trajectory.sensors() {
            add(name, unit);
        }
        EXCHANGED.iter().for_each(|name| add(name, "J"));
        for (name, _) in &self.constrained {
            vector(&format!("reaction_{name}"), "N", &mut add);
        }
        all
    }

    /// What they hold of a sample.
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
            // samples of this very trajectory have them
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

/// A name for the nodes of a constraint: that of the set, or the numbers, of many the first and the last.
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

/// Unit of a column that a motion has without being asked for it; `None` of others, which are sensors.
pub(super) fn standard_unit(name: &str) -> Option<&'static str> {
    let is_axis = |axis: &str| AXES.contains(&axis);
    let vector = name.rsplit_once('_').filter(|(_, axis)| is_axis(axis)).map(|(stem, _)| stem);
    match name {
        "t" => return Some("s"),
        "angular_momentum" => return Some("kg m^2/s"),
        "constraint_drift" => return Some("m"),
        _ if STORED.contains(&name) || EXCHANGED.contains(&name) => return Some("J"),
        _ => {}
    }
    let stem = vector?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    match stem {
        "com" => Some("m"),
        "momentum" => Some("kg m/s"),
        "angular_momentum" => Some("kg m^2/s"),
        _ if stem.starts_with("reaction_") => Some("N"),
        _ if stem.strip_prefix('u').is_some_and(is_number) => Some("m"),
        _ => None,
    }
}
