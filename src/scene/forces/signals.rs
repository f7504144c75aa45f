//! Vectors that change with time, as programs give them.

use super::signal::VectorSignal;
use super::time_table::TimeTable;
use crate::base::input::InputError;

/// A vector with one component per dimension of space, constant or changing with time (s).
///
/// Vectors convert into constant ones.
#[derive(Debug, Clone)]
pub struct Signals(pub(crate) VectorSignal);

impl Signals {
    /// A function of time (s).
    pub fn function<const D: usize>(f: impl Fn(f64) -> [f64; D] + Send + Sync + 'static) -> Self {
        Self(VectorSignal::function(f))
    }

    /// A vector that has the `values` at the `times` (s, ascending). In between it is interpolated linearly; before and after it is constant.
    pub fn table(
        times: impl Into<Vec<f64>>,
        values: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        let values = values.into_iter().map(Into::into).collect();
        Self(VectorSignal::TimeTable(TimeTable::new(times.into(), values)))
    }

    /// The same table over and over, as [`Signal::repeated`](super::Signal::repeated) has it.
    ///
    /// # Errors
    /// As there.
    pub fn repeated(self, period: f64, until: f64) -> Result<Self, InputError> {
        self.0.repeated(period, until).map(Self)
    }
}

impl From<Vec<f64>> for Signals {
    fn from(vector: Vec<f64>) -> Self {
        Self(VectorSignal::Constant(vector))
    }
}

impl<const D: usize> From<[f64; D]> for Signals {
    fn from(vector: [f64; D]) -> Self {
        Self(VectorSignal::Constant(vector.into()))
    }
}
