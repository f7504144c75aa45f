//! Sensors: named numbers that are read from the motion at each sample.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::angles::Angles;
use super::component::Component;
use super::gauge::AngleGauge;
use super::output::Value;
use super::reading::Reading;
use super::view::View;
use crate::base::input::InputError;
use crate::dynamics::report::SensorErrorEstimate;
use crate::dynamics::trajectory::{Quantity, Sample};
use crate::scene::timeline::Scene;

/// A sensor as requested.
#[derive(Clone)]
pub(super) struct Sensor {
    pub(super) name: String,
    pub(super) source: SensorKind,
}

/// Reads a user-defined number.
pub(super) type Own = dyn Fn(&View, &Sample) -> f64 + Send + Sync;

/// Quantity that a sensor reads.
#[derive(Clone)]
pub(super) enum SensorKind {
    /// A user-defined number: its unit, and the function that reads it.
    Own(String, Arc<Own>),
    /// A quantity that scenes have.
    Named(Reading),
}

/// Adds the numbers of a sensor to those of a sample.
type Read = dyn Fn(&View, &Sample, &mut Vec<f64>) + Send + Sync;

/// The sensors of a run in its scene: their quantities, and the functions that read them.
#[derive(Clone, Default)]
pub(super) struct Sensors {
    pub(super) quantities: Vec<Quantity>,
    reads: Vec<Arc<Read>>,
    angles: Vec<Angle>,
    /// Those that follow from the places of nodes: numbers among `reads`, and their columns.
    of_places: Vec<(usize, Range<usize>)>,
    /// Whether one reads forces of constraints, accelerations or energies of a sample, for which all forces are evaluated.
    need_forces: bool,
    /// Whether one reads accelerations.
    need_accelerations: bool,
}

/// An angle that is continuous over whole turns.
#[derive(Clone)]
struct Angle {
    /// Number of its column.
    column: usize,
    gauge: AngleGauge,
    /// A full turn in its unit.
    full_turn: f64,
}

impl Sensors {
    /// # Errors
    /// A quantity that `scene` does not have; two columns with one name.
    pub(super) fn new(asked: &[Sensor], scene: &Scene) -> Result<Self, InputError> {
        let mut sensors = Self::default();
        for sensor in asked {
            sensors.add(sensor, scene).map_err(|error| InputError {
                input: format!("{} of sensor \"{}\"", error.input, sensor.name),
                ..error
            })?;
        }
        for (number, Quantity { name, .. }) in sensors.quantities.iter().enumerate() {
            if sensors.quantities[..number].iter().any(|other| other.name == *name) {
                let help = "two sensors have it: name one of them otherwise";
                return Err(InputError::new("name of a sensor", format!("\"{name}\""), help));
            }
        }
        Ok(sensors)
    }

    fn add(&mut self, Sensor { name, source }: &Sensor, scene: &Scene) -> Result<(), InputError> {
        let reading = match source {
            SensorKind::Own(unit, read) => {
                self.quantities.push(Quantity { name: name.clone(), unit: unit.clone() });
                self.need_forces = true; // it may read them
                let read = read.clone();
                self.reads
                    .push(Arc::new(move |view, sample, numbers| numbers.push(read(view, sample))));
                return Ok(());
            }
            SensorKind::Named(reading) => reading,
        };
        let components = reading.components(scene.body().dimension())?;
        let gauge = reading.gauge(scene)?;
        self.need_accelerations |= reading.is_of_accelerations();
        self.need_forces |= reading.is_of_constraints(scene) || reading.is_of_accelerations();
        let unit = reading.unit();
        if reading.turns(scene.body().dimension()) {
            let (gauge, full_turn) = (reading.angle_gauge(scene)?, reading.full_turn());
            self.angles.push(Angle { column: self.quantities.len(), gauge, full_turn });
        }
        let first = self.quantities.len();
        let named = |name: String| Quantity { name, unit: unit.to_owned() };
        if reading.component.is_some() || components.is_empty() {
            self.quantities.push(named(name.clone()));
        } else {
            let column = |part: &Component| named(format!("{name}.{}", part.word()));
            self.quantities.extend(components.iter().map(column));
        }
        if reading.is_of_places() {
            self.of_places.push((self.reads.len(), first..self.quantities.len()));
        }
        self.reads.push(Arc::new(move |view, sample, numbers| match gauge(view, sample) {
            Value::Number(number) => numbers.push(number),
            value => numbers.extend(components.iter().map(|&part| value.part(part))),
        }));
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.reads.is_empty()
    }

    pub(super) fn need_forces(&self) -> bool {
        self.need_forces
    }

    pub(super) fn need_accelerations(&self) -> bool {
        self.need_accelerations
    }

    /// Their readings, with angles continued from the last ones, `angles`.
    pub(super) fn read(&self, view: &View, sample: &Sample, angles: &Angles) -> Vec<f64> {
        let mut numbers = Vec::with_capacity(self.quantities.len());
        self.reads.iter().for_each(|read| read(view, sample, &mut numbers));
        for &Angle { column, full_turn, .. } in &self.angles {
            let behind = angles.behind(&self.quantities[column].name, numbers[column] / full_turn);
            numbers[column] += full_turn * behind;
        }
        numbers
    }

    /// Whether one follows from the places of nodes.
    pub(super) fn read_places(&self) -> bool {
        !self.of_places.is_empty()
    }

    /// Differences between two states of the readings that depend on nodal positions.
    pub(super) fn changes(&self, states: [(&View, &Sample); 2]) -> Vec<SensorErrorEstimate> {
        let mut changes = Vec::new();
        for (number, columns) in &self.of_places {
            let read = |(view, sample): (&View, &Sample)| {
                let mut numbers = Vec::new();
                self.reads[*number](view, sample, &mut numbers);
                numbers
            };
            let [one, other] = states.map(read);
            for (column, (one, other)) in columns.clone().zip(one.into_iter().zip(other)) {
                let turn = self.angles.iter().find(|angle| angle.column == column);
                let whole = turn.map_or(0.0, |angle| {
                    angle.full_turn * ((other - one) / angle.full_turn).round()
                });
                let Quantity { name, unit } = self.quantities[column].clone();
                changes.push(SensorErrorEstimate {
                    name,
                    unit,
                    error: (other - one - whole).abs(),
                });
            }
        }
        changes
    }

    /// Notes the present values of the angles among them.
    pub(super) fn follow(&self, view: &View, angles: &mut Angles) {
        for Angle { column, gauge, full_turn } in &self.angles {
            let (name, turns) = (&self.quantities[*column].name, gauge(view) / full_turn);
            angles.note(name, turns + angles.behind(name, turns));
        }
    }

    /// Whether there are angles among them.
    pub(super) fn have_angles(&self) -> bool {
        !self.angles.is_empty()
    }
}

impl fmt::Debug for Sensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.source {
            SensorKind::Own(unit, _) => f.debug_tuple("Own").field(&self.name).field(unit).finish(),
            SensorKind::Named(reading) => {
                f.debug_tuple("Named").field(&self.name).field(reading).finish()
            }
        }
    }
}
