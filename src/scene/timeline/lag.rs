//! Lags of the actuators of a scene.

use super::input::Quantity;
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find};
use crate::scene::forces::{Actuator, Lag, Lagging, Signal};

impl Scene {
    /// Adds a lag to the named springs, cables, muscles or growths, each with a state of its own that follows the [actuation](Phase::actuate) of phases.
    pub fn lag<N: Into<String>>(
        mut self,
        lag: Lag,
        actuators: impl IntoIterator<Item = N>,
    ) -> Self {
        self.lags.extend(actuators.into_iter().map(|name| (name.into(), lag.clone())));
        self
    }

    /// Names of the actuators that lag, each with its lag.
    pub fn lags(&self) -> impl ExactSizeIterator<Item = (&str, &Lag)> + Clone {
        self.lags.iter().map(|(name, lag)| (&**name, lag))
    }

    /// The lag of an actuator, if it has one.
    pub(crate) fn lag_of(&self, actuator: &str) -> Option<&Lag> {
        self.lags().find(|(name, _)| *name == actuator).map(|(_, lag)| lag)
    }

    /// Actuation per kelvin of a heated actuator; `input` is where its name was given.
    pub(crate) fn per_kelvin(&self, actuator: &str, input: &str) -> Result<f64, InputError> {
        let heated = self.lags().filter_map(|(name, lag)| Some((name, lag.per_kelvin()?)));
        let number =
            find(actuator, heated.clone().map(|(name, _)| name), input, "heated actuators")?;
        Ok(heated.map(|(_, per_kelvin)| per_kelvin).nth(number).unwrap_or_default())
    }

    /// # Errors
    /// Names that no actuator has, or that have a lag already; numbers out of range; an activation without Hill's law.
    pub(crate) fn check_lags(&self) -> Result<(), InputError> {
        if self.lags.is_empty() {
            return Ok(());
        }
        unique("actuator with a lag", self.lags.iter().map(|(name, _)| &**name))?;
        for (name, lag) in self.lags() {
            let number = self.actuator_number(name, "lag")?;
            lag.validate(name)?;
            if lag.is_activation() && self.actuators[number].hill().is_none() {
                let help = "an activation lag needs a muscle with Hill's law (`hill`): name one, or use a first-order lag";
                return Err(InputError::new("lag", format!("of \"{name}\""), help));
            }
        }
        Ok(())
    }

    /// Steady-state input of an actuator under the commands `signals`: command times gain.
    pub(super) fn steady(&self, actuator: &str, signals: Vec<Signal>) -> Vec<Signal> {
        match self.lag_of(actuator) {
            // without a command it comes to rest
            Some(_) if signals.is_empty() => vec![Signal::constant(0.0)],
            Some(lag) => signals.into_iter().map(|signal| signal.times(lag.gain())).collect(),
            None => signals,
        }
    }

    /// The lag of an actuator that `drives` act on, with its number (from 0), unless states are no unknowns.
    pub(super) fn lagging(
        &self,
        actuator: &dyn Actuator,
        drives: &[Signal],
    ) -> Option<(usize, Lagging)> {
        let mut lags = self.lags().enumerate().filter(|_| !self.has_fixed_amounts);
        let (number, (name, lag)) = lags.find(|(_, (name, _))| *name == actuator.name())?;
        let size = self.size_of_states(actuator);
        Some((number, Lagging::new(name, lag, actuator.hill(), size, drives.to_vec())))
    }

    /// The scale of the tolerance of the state: full activation, or the value that causes large strains.
    fn size_of_states(&self, actuator: &dyn Actuator) -> f64 {
        let large = || actuator.kind().drive.large(&self.body);
        actuator.hill().map_or_else(large, |hill| hill.largest)
    }

    /// Input of an actuator at time `t` (s) in `phase`, and its rate. `states` are the last unknowns of a state, or none where these
    /// are constants; then the input is the steady-state one.
    pub(crate) fn drive_at(
        &self,
        actuator: &dyn Actuator,
        phase: &Phase,
        t: f64,
        states: &[f64],
    ) -> [f64; 2] {
        let command = phase.command(actuator.name(), t);
        let lags = self.lags().enumerate();
        let Some((number, (_, lag))) =
            lags.into_iter().find(|(_, (name, _))| *name == actuator.name())
        else {
            return command;
        };
        let steady = command.map(|x| lag.gain() * x);
        self.flowing(states).map_or(steady, |flowing| {
            let state = flowing.lags[number];
            [state, lag.rate(steady[0], state, self.size_of_states(actuator))]
        })
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
