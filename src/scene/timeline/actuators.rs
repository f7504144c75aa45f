//! The actuators of a scene: one list of springs, cables, muscles and growths, in the order of their kinds.

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::input::Quantity;
use super::{Phase, Scene};
use crate::base::input::{InputError, find};
use crate::elements::body::Grown;
use crate::elements::force::Forces;
#[cfg(feature = "output")]
use crate::scene::forces::LinePoint;
use crate::scene::forces::{ACTUATORS, Actuator, Drive, Growth, Lagging, Muscle, Signal, Spring};

impl Scene {
    /// Adds a spring between two nodes, which acts in every phase.
    pub fn spring(self, spring: Spring) -> Self {
        let name = self.next_actuator("spring");
        self.with_actuator(spring.or_named(name))
    }

    /// Adds a muscle in the body, to be contracted by the stress that phases give it.
    pub fn muscle(self, muscle: Muscle) -> Self {
        let name = self.next_actuator("muscle");
        self.with_actuator(muscle.or_named(name))
    }

    /// Lets cells of the body grow, by the strain that phases give.
    pub fn growth(self, growth: Growth) -> Self {
        let name = self.next_actuator("growth");
        self.with_actuator(growth.or_named(name))
    }

    /// The springs and cables.
    pub fn springs(&self) -> Vec<&Spring> {
        self.actuators_of()
    }

    /// The muscles.
    pub fn muscles(&self) -> Vec<&Muscle> {
        self.actuators_of()
    }

    /// The growths.
    pub fn growths(&self) -> Vec<&Growth> {
        self.actuators_of()
    }

    /// The kind and the name of each spring, cable, muscle and growth.
    pub fn actuator_names(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.actuators.iter().map(|own| (own.kind().name, own.name()))
    }

    fn actuators_of<T: Actuator>(&self) -> Vec<&T> {
        let own = self.actuators.iter().map(|actuator| &**actuator as &dyn Any);
        own.filter_map(|actuator| actuator.downcast_ref()).collect()
    }

    fn with_actuator(mut self, actuator: impl Actuator) -> Self {
        let place =
            |own: &dyn Actuator| ACTUATORS.iter().position(|kind| kind.list == own.kind().list);
        let end = self.actuators.partition_point(|own| place(&**own) <= place(&actuator));
        self.actuators.insert(end, Arc::new(actuator));
        self
    }

    /// The name of one more actuator of a list, where it is given none: the `word` of the list and a number.
    pub(crate) fn next_actuator(&self, word: &str) -> String {
        format!("{word} {}", self.actuators_in(&format!("{word}s")).count() + 1)
    }

    /// The actuators, by their kinds.
    pub(crate) fn actuators(&self) -> &[Arc<dyn Actuator>] {
        &self.actuators
    }

    /// Those in a list of kinds.
    pub(crate) fn actuators_in(
        &self,
        list: &str,
    ) -> impl Iterator<Item = &Arc<dyn Actuator>> + Clone {
        self.actuators.iter().filter(move |own| own.kind().list == list)
    }

    /// The actuator with a name, if there is one.
    pub(crate) fn actuator_named(&self, name: &str) -> Option<&dyn Actuator> {
        self.actuators.iter().map(|own| &**own).find(|own| own.name() == name)
    }

    /// Number (from 0) of the actuator with a name; `input` is where that was given.
    pub(crate) fn actuator_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.actuators.iter().map(|own| own.name()), input, "actuators")
    }

    /// The same of an actuator in a list of kinds.
    pub(crate) fn number_in(
        &self,
        list: &str,
        name: &str,
        input: &str,
    ) -> Result<usize, InputError> {
        find(name, self.actuators_in(list).map(|own| own.name()), input, list)?;
        self.actuator_number(name, input)
    }

    /// The lines along which actuators act, with the numbers of these (from 0).
    ///
    /// # Errors
    /// Nodes that do not exist.
    #[cfg(feature = "output")]
    pub(crate) fn actuator_lines(&self) -> Result<Vec<(usize, Vec<LinePoint>)>, InputError> {
        let mut lines = Vec::new();
        for (number, own) in self.actuators.iter().enumerate() {
            let line = own.line(&self.body)?;
            if !line.is_empty() {
                lines.push((number, line));
            }
        }
        Ok(lines)
    }

    /// Adds the forces of actuators, and returns those that lag, in the order of the lags.
    ///
    /// # Errors
    /// Names that no actuator has, numbers out of range.
    pub(super) fn add_actuators(
        &self,
        phase: &Phase,
        forces: &mut Forces,
    ) -> Result<Vec<Lagging>, InputError> {
        let mut lags: Vec<Option<Lagging>> = self.lags().map(|_| None).collect();
        for (actuator, signals) in self.actuators.iter().zip(self.actuation_signals(phase)?) {
            let lagging = self.lagging(&**actuator, &signals);
            let drive = match &lagging {
                Some((_, lagging)) => vec![lagging.signal()],
                None => signals.clone(),
            };
            let driven = actuator.driven(&self.body, drive)?;
            actuator.check_signals(&phase.name, &signals)?;
            if let Some((number, mut lagging)) = lagging {
                driven.last().into_iter().for_each(|force| lagging.drive(force.clone()));
                lags[number] = Some(lagging);
            }
            forces.extend(driven);
        }
        Ok(lags.into_iter().flatten().collect())
    }

    /// Actuation signals of all actuators in `phase`; for lagged ones, the steady-state input.
    fn actuation_signals(&self, phase: &Phase) -> Result<Vec<Vec<Signal>>, InputError> {
        let input = format!("actuation of phase \"{}\"", phase.name);
        let mut signals: Vec<Vec<Signal>> = vec![Vec::new(); self.actuators.len()];
        for (name, signal) in phase.signals(Quantity::Actuation) {
            signal.validate(&input)?;
            signals[self.actuator_number(name, &input)?].push(signal.clone());
        }
        let each = self.actuators.iter().zip(signals).map(|(actuator, signals)| {
            let mut driven = self.steady(actuator.name(), signals);
            // statics scales loads
            if self.rises && actuator.kind().drive != Drive::Stress {
                driven.iter_mut().for_each(|signal| *signal = signal.rising(phase.until));
            }
            driven
        });
        Ok(each.collect())
    }

    /// The cells that grow in `phase`, counted from 0.
    ///
    /// # Errors
    /// Cells that the body does not have, or that two actuators let grow.
    pub(crate) fn growing_cells(&self, phase: &Phase) -> Result<Vec<usize>, InputError> {
        let (mut owners, mut all) = (BTreeMap::new(), Vec::new());
        for (actuator, Grown { cells, .. }) in self.grown_by(phase, |_| 0.0)? {
            for cell in &cells {
                if let Some(other) = owners.insert(*cell, actuator.name()) {
                    let (kind, name) = (actuator.kind().name, actuator.name());
                    let help =
                        format!("{kind} \"{other}\" has it, too: give each cells of its own");
                    let input = format!("{kind} \"{name}\" cell");
                    return Err(InputError::new(input, cell + 1, help));
                }
            }
            all.extend(cells);
        }
        Ok(all)
    }

    /// The cells that have grown in `phase` at time `t` (s); `states` as [`drive_at`](Self::drive_at) takes them.
    pub(crate) fn grown(
        &self,
        phase: &Phase,
        t: f64,
        states: &[f64],
    ) -> Result<Vec<Grown>, InputError> {
        let strain = |actuator: &dyn Actuator| self.drive_at(actuator, phase, t, states)[0];
        Ok(self.grown_by(phase, strain)?.into_iter().map(|(_, grown)| grown).collect())
    }

    /// The actuators that let cells grow in `phase`, with those cells as a strain has grown them.
    fn grown_by(
        &self,
        phase: &Phase,
        strain: impl Fn(&dyn Actuator) -> f64,
    ) -> Result<Vec<(&dyn Actuator, Grown)>, InputError> {
        let mut all = Vec::new();
        for actuator in self.actuators.iter().map(|own| &**own) {
            let mut commands = phase.signals_of(Quantity::Actuation, actuator.name());
            let acts = commands.next().is_some() || self.lag_of(actuator.name()).is_some();
            if acts && actuator.kind().drive == Drive::Strain {
                let grown = actuator.grown(&self.body, strain(actuator))?;
                all.extend(grown.map(|grown| (actuator, grown)));
            }
        }
        Ok(all)
    }
}
