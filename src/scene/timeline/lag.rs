//! Lags of the actuators of a scene.

use super::input::Quantity;
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::scene::forces::{Lag, Lagging, Signal, Spring};

impl Scene {
    /// Lets the named springs, cables, muscles or growths lag behind what phases [actuate](Phase::actuate) them by, each on its own.
    pub fn lag<N: Into<String>>(
        mut self,
        lag: Lag,
        actuators: impl IntoIterator<Item = N>,
    ) -> Self {
        self.lags.extend(actuators.into_iter().map(|name| (name.into(), lag.clone())));
        self
    }

    /// Names of the actuators that lag, each with its lag.
    pub fn lags(&self) -> impl ExactSizeIterator<Item = (&str, &Lag)> {
        self.lags.iter().map(|(name, lag)| (&**name, lag))
    }

    /// The lag of an actuator, if it has one.
    pub(crate) fn lag_of(&self, actuator: &str) -> Option<&Lag> {
        self.lags().find(|(name, _)| *name == actuator).map(|(_, lag)| lag)
    }

    /// Actuation per kelvin of a heated actuator; `input` is where its name was given.
    pub(crate) fn per_kelvin(&self, actuator: &str, input: &str) -> Result<f64, InputError> {
        let heated = self.lags().filter_map(|(name, lag)| Some((name, lag.per_kelvin()?)));
        let heated: Vec<(&str, f64)> = heated.collect();
        let number =
            find(actuator, heated.iter().map(|(name, _)| *name), input, "heated actuators");
        Ok(heated[number?].1)
    }

    /// # Errors
    /// Names that no actuator has, or that have a lag already; numbers out of range; an activation without Hill's law.
    pub(crate) fn check_lags(&self) -> Result<(), InputError> {
        if self.lags.is_empty() {
            return Ok(());
        }
        unique("actuator with a lag", self.lags.iter().map(|(name, _)| &**name))?;
        for (name, lag) in self.lags() {
            self.actuator_number(name, "lag")?;
            lag.validate(name)?;
            let muscle = self.muscle_named(name);
            if lag.is_activation() && muscle.and_then(|muscle| muscle.law()).is_none() {
                let help = "an activation lag needs a muscle with Hill's law (`hill`): name one, or use a first-order lag";
                return Err(InputError::new("lag", format!("of \"{name}\""), help));
            }
        }
        Ok(())
    }

    /// Steady-state input of an actuator under the commands `signals`: command times gain.
    pub(super) fn driven(&self, actuator: &str, signals: Vec<Signal>) -> Vec<Signal> {
        match self.lag_of(actuator) {
            // without a command it comes to rest
            Some(_) if signals.is_empty() => vec![Signal::constant(0.0)],
            Some(lag) => signals.into_iter().map(|signal| signal.times(lag.gain())).collect(),
            None => signals,
        }
    }

    /// The lag of an actuator that `drives` act on, with its number (from 0), unless states are no unknowns.
    ///
    /// # Errors
    /// A constant stress that Hill's law does not have.
    pub(super) fn lagging(
        &self,
        actuator: &str,
        drives: &[Signal],
    ) -> Result<Option<(usize, Lagging)>, InputError> {
        let mut lags = self.lags().enumerate().filter(|_| !self.has_fixed_amounts);
        let Some((number, (_, lag))) = lags.find(|(_, (name, _))| *name == actuator) else {
            return Ok(None);
        };
        let muscle = self.muscle_named(actuator);
        if let (Some(muscle), Some(stress)) =
            (muscle, drives.iter().map(Signal::value).sum::<Option<f64>>())
        {
            muscle.check_stress(stress)?;
        }
        let hill = muscle.and_then(|muscle| muscle.law());
        let size = self.size_of_states(actuator);
        Ok(Some((number, Lagging::new(actuator, lag, hill, size, drives.to_vec()))))
    }

    /// A size of what drives an actuator, by which tolerances are chosen: what makes large strains, or full activation.
    fn size_of_states(&self, actuator: &str) -> f64 {
        let (body, muscle) = (&self.body, self.muscle_named(actuator));
        if let Some(muscle) = muscle {
            return muscle.law().map_or(body.largest_young(), |hill| hill.largest);
        }
        let winch = self.springs.iter().find(|spring| spring.name() == actuator);
        match winch.map(Spring::is_winch) {
            Some(true) => body.size(),
            Some(false) => body.largest_young() * body.volume() / body.size(),
            None => 1.0,
        }
    }

    /// Input of an actuator at time `t` (s) in `phase`, and its rate. `states` are the last unknowns of a state, or none where these
    /// are constants; then the input is the steady-state one.
    pub(crate) fn drive_at(
        &self,
        actuator: &str,
        phase: &Phase,
        t: f64,
        states: &[f64],
    ) -> [f64; 2] {
        let sum = phase.command(actuator, t);
        let Some(lag) = self.lag_of(actuator) else { return sum };
        let sum = sum.map(|x| lag.gain() * x);
        let number = self.lags().position(|(name, _)| name == actuator);
        match (self.flowing(states), number) {
            (Some(flowing), Some(number)) => {
                let state = flowing.lags[number];
                [state, lag.rate(sum[0], state, self.size_of_states(actuator))]
            }
            _ => sum,
        }
    }
}

impl Phase {
    /// The command of an actuator at time `t` (s), and its rate.
    pub(crate) fn command(&self, actuator: &str, t: f64) -> [f64; 2] {
        let signals = self.signals_of(Quantity::Actuation, actuator);
        signals
            .fold([0.0; 2], |[value, rate], signal| [value + signal.at(t), rate + signal.rate(t)])
    }
}
