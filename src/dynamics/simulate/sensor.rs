//! Sensors: named numbers that are read from the motion at each sample.

use std::fmt;
use std::sync::Arc;

use super::angles::Angles;
use super::gauge::{AngleGauge, Value};
use super::reading::{Component, Reading};
use super::view::View;
use crate::base::input::InputError;
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

/// What a sensor reads.
#[derive(Clone)]
pub(super) enum SensorKind {
    /// A user-defined number: its unit, and the function that reads it.
    Own(String, Arc<Own>),
    /// A quantity that scenes have.
    Named(Reading),
}

/// Adds the numbers of a sensor to those of a sample.
type Read = dyn Fn(&View, &Sample, &mut Vec<f64>) + Send + Sync;

/// The sensors of a run in its scene: what they read, and how.
#[derive(Clone, Default)]
pub(super) struct Sensors {
    pub(super) quantities: Vec<Quantity>,
    reads: Vec<Arc<Read>>,
    angles: Vec<Angle>,
    /// Whether one reads forces of constraints or energies of a sample, for which all forces are evaluated.
    need_forces: bool,
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
        self.need_forces |= reading.is_of_constraints();
        let unit = reading.unit();
        if reading.turns(scene.body().dimension()) {
            let (gauge, full_turn) = (reading.angle_gauge(scene)?, reading.full_turn());
            self.angles.push(Angle { column: self.quantities.len(), gauge, full_turn });
        }
        let named = |name: String| Quantity { name, unit: unit.to_owned() };
        if reading.component.is_some() || components.is_empty() {
            self.quantities.push(named(name.clone()));
        } else {
            let column = |part: &Component| named(format!("{name}.{}", part.word()));
            self.quantities.extend(components.iter().map(column));
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
