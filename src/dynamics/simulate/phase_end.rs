//! Phases that end as a sensor passes a level.

use super::interval::Interval;
use super::run::Run;
use super::sensor::Sensors;
use crate::base::input::{InputError, unknown_among};
use crate::base::root::{Point, bracket};
use crate::dynamics::phase::{Failed, Stepper};
use crate::scene::timeline::Phase;

/// Times within a step at which the reading is compared with the level.
const LOOKS: u32 = 8;

/// Precision to which the end is located, relative to the step.
const PRECISION: f64 = 1e-12;

impl Sensors {
    /// The column by which a phase ends, if it ends by one.
    ///
    /// # Errors
    /// A sensor that is not read.
    pub(super) fn ending(&self, phase: &Phase) -> Result<Option<usize>, InputError> {
        let Some(end) = &phase.ends else { return Ok(None) };
        let mut names = self.quantities.iter().map(|column| &column.name[..]);
        let column = names.position(|name| name == end.sensor);
        column.map(Some).ok_or_else(|| {
            let names: Vec<&str> = self.quantities.iter().map(|column| &column.name[..]).collect();
            let input = format!("end of phase \"{}\"", phase.name());
            let help = unknown_among(&end.sensor, &names, "run", "sensors");
            InputError::new(input, format!("sensor \"{}\"", end.sensor), help)
        })
    }
}

impl Run {
    /// When (s) in the last step, up to the time `last` (s), the phase ends by its sensor, if it does. `work` has room for a state.
    ///
    /// It is the last moment before, so that a run that is continued from there finds it again.
    pub(super) fn end_within(
        &self,
        stepper: &mut dyn Stepper,
        last: f64,
        work: &mut [f64],
    ) -> Result<Option<f64>, Failed> {
        // checked when the phase began
        let (Some(end), Ok(Some(column))) = (&self.phase.ends, self.sensors.ending(&self.phase))
        else {
            return Ok(None);
        };
        let mut beyond = |t: f64| -> Result<f64, Failed> {
            let reading = self.seen(stepper, t, work)?.sensors[column] - end.level;
            Ok(if end.rises { reading } else { -reading })
        };
        let start = self.time;
        let mut near = Point { t: start, g: beyond(start)? };
        for look in 1..=LOOKS {
            let t = match look {
                LOOKS => last,
                _ => start + (last - start) * f64::from(look) / f64::from(LOOKS),
            };
            let far = Point { t, g: beyond(t)? };
            if near.g < 0.0 && far.g >= 0.0 {
                let (near, _) = bracket(near, far, PRECISION * (last - start), &mut beyond)?;
                return Ok(Some(near.t));
            }
            near = far;
        }
        Ok(None)
    }
}

impl Interval {
    /// Ends it and its phase at a time (s) before the one that was planned.
    pub(super) fn cut(&mut self, end: f64) {
        self.times.cut(self.taken, end);
        (self.stop, self.inside) = (end, None);
    }
}
