//! Sensors: numbers with names that are read from the motion with each sample.

use std::fmt;
use std::sync::Arc;

use super::view::View;
use crate::trajectory::{Quantity, Sample};

/// Reads a number.
type Reading = dyn Fn(&View, &Sample) -> f64 + Send + Sync;

/// What is read, and how.
#[derive(Clone)]
pub(super) struct Sensor {
    pub(super) quantity: Quantity,
    reading: Arc<Reading>,
}

impl Sensor {
    pub(super) fn new(
        quantity: Quantity,
        reading: impl Fn(&View, &Sample) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { quantity, reading: Arc::new(reading) }
    }

    pub(super) fn read(&self, view: &View, sample: &Sample) -> f64 {
        (self.reading)(view, sample)
    }
}

impl fmt::Debug for Sensor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.quantity.fmt(f)
    }
}
