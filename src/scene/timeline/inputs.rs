//! The inputs of phases: those on a target, their values, and changes by commands and statics.

use super::input::{Input, InputSignal, LoadKind, Quantity, Target};
use super::{Phase, Scene};
use crate::elements::mesh::Selection;
use crate::scene::forces::{SharedValue, Signal, VectorSignal};

impl Phase {
    pub(crate) fn with(mut self, input: Input) -> Self {
        self.inputs.push(input);
        self
    }

    /// Replaces the inputs of the same quantity on the same target.
    pub(crate) fn set(&mut self, input: Input) {
        let Input { quantity, target, .. } = &input;
        self.inputs.retain_mut(|other| {
            if !quantity.replaces(other.quantity) || !target.overlaps(&other.target) {
                return true;
            }
            let Target::Named(names) = &mut other.target else { return false };
            names.retain(|name| !target.names().contains(name));
            !names.is_empty()
        });
        self.inputs.push(input);
    }

    /// The inputs of a quantity on a target.
    pub(crate) fn inputs_on(
        &self,
        quantity: Quantity,
        target: &Target,
    ) -> impl Iterator<Item = &Input> + Clone {
        self.inputs.iter().filter(move |input| {
            quantity.replaces(input.quantity) && target.overlaps(&input.target)
        })
    }

    /// The numbers of a quantity that a command can set, if they alone act on the target.
    pub(crate) fn live(&self, quantity: Quantity, target: &Target) -> Option<&SharedValue> {
        let mut all = self.inputs_on(quantity, target);
        let only = all.next().filter(|input| all.next().is_none() && input.target == *target)?;
        only.signal.live()
    }

    /// The same for the component with a `name`.
    pub(crate) fn shared_of(&self, quantity: Quantity, name: &str) -> Option<&SharedValue> {
        let acts = |input: &&Input| {
            input.quantity == quantity && input.target.names().iter().any(|own| own == name)
        };
        let mut all = self.inputs.iter().filter(acts);
        let only = all.next().filter(|_| all.next().is_none())?;
        only.signal.live().filter(|_| only.target.names().len() == 1)
    }

    /// Signals of components that have a quantity, by their names.
    pub(crate) fn signals(
        &self,
        quantity: Quantity,
    ) -> impl Iterator<Item = (&str, &Signal)> + Clone {
        self.inputs.iter().filter(move |input| input.quantity == quantity).flat_map(|input| {
            let signal = match &input.signal {
                InputSignal::Number(signal) => Some(signal),
                InputSignal::Vector(_) => None,
            };
            input.target.names().iter().filter_map(move |name| Some((&**name, signal?)))
        })
    }

    /// Signals of the component with a `name`, which add up.
    pub(crate) fn signals_of<'a>(
        &'a self,
        quantity: Quantity,
        name: &'a str,
    ) -> impl Iterator<Item = &'a Signal> + Clone {
        let all = self.signals(quantity);
        all.filter(move |(other, _)| *other == name).map(|(_, signal)| signal)
    }

    /// Vectors on nodes.
    pub(crate) fn vectors_on_nodes(
        &self,
    ) -> impl Iterator<Item = (Quantity, &Selection, &VectorSignal)> {
        self.inputs.iter().filter_map(|input| match &input.signal {
            InputSignal::Vector(value) => Some((input.quantity, input.target.nodes()?, value)),
            InputSignal::Number(_) => None,
        })
    }

    /// Loads on nodes.
    pub(crate) fn loads(&self) -> impl Iterator<Item = (&Selection, LoadKind, &VectorSignal)> {
        self.vectors_on_nodes().filter_map(|(quantity, nodes, value)| match quantity {
            Quantity::Load(kind) => Some((nodes, kind, value)),
            _ => None,
        })
    }

    /// Pressures on the faces between nodes.
    pub(crate) fn face_pressures(&self) -> impl Iterator<Item = (&Selection, &Signal)> + Clone {
        self.inputs.iter().filter_map(|input| match (input.quantity, &input.signal) {
            (Quantity::FacePressure, InputSignal::Number(pressure)) => {
                Some((input.target.nodes()?, pressure))
            }
            _ => None,
        })
    }

    /// The first vector of a quantity on a target.
    pub(crate) fn vector(&self, quantity: Quantity, target: &Target) -> Option<&VectorSignal> {
        self.inputs_on(quantity, target).find_map(|input| match &input.signal {
            InputSignal::Vector(vector) => Some(vector),
            InputSignal::Number(_) => None,
        })
    }

    /// Gives up the inputs of some quantities.
    pub(super) fn without_inputs(&mut self, of: impl Fn(Quantity) -> bool) {
        self.inputs.retain(|input| !of(input.quantity));
    }

    /// Whether there are numbers that commands can set.
    pub(super) fn is_live(&self) -> bool {
        self.inputs.iter().any(|input| input.signal.live().is_some())
    }

    /// Replaces numbers that commands can set by constants.
    pub(super) fn freeze(&mut self) {
        self.inputs.iter_mut().for_each(|input| input.signal = input.signal.snapshot());
    }

    /// Replaces what statics scale by this `fraction` of its value at the end of the phase, and other inputs of devices by that value.
    pub(super) fn scale_inputs(&mut self, fraction: f64, dimension: usize) {
        let end = self.until;
        for input in &mut self.inputs {
            let scales = input.quantity.row().scales;
            if scales || matches!(input.quantity, Quantity::Device(_)) {
                let (part, rank) =
                    (if scales { fraction } else { 1.0 }, input.quantity.rank(dimension));
                input.signal = input.signal.at_rest(part, end, rank);
            }
        }
    }
}

impl Scene {
    /// Components of a quantity on a target in `phase` at time `t` (s): the sum of its signals there, or else the preset of a device.
    pub(crate) fn input_at(
        &self,
        phase: &Phase,
        quantity: Quantity,
        target: &Target,
        t: f64,
    ) -> Vec<f64> {
        let dimension = self.body.dimension();
        let rank = quantity.rank(dimension);
        let absent = || vec![quantity.row().absent; rank];
        match (quantity, target) {
            (Quantity::Load(kind), Target::Nodes(nodes)) => {
                self.load_on(phase, nodes, kind, t).unwrap_or_else(|_| absent())
            }
            _ => {
                let presets = self.presets_in(phase);
                let preset =
                    presets.iter().filter(|i| i.quantity == quantity && i.target == *target);
                let all = phase.inputs_on(quantity, target).chain(preset);
                let all = all.map(|input| input.signal.components(t, rank));
                let sum = |sum: Vec<f64>, more: Vec<f64>| {
                    sum.into_iter().zip(more).map(|(sum, more)| sum + more).collect()
                };
                all.reduce(sum).unwrap_or_else(absent)
            }
        }
    }

    /// Times (s, ascending) at which its signals there change their laws.
    pub(crate) fn input_breaks(
        &self,
        phase: &Phase,
        quantity: Quantity,
        target: &Target,
    ) -> Vec<f64> {
        let presets = self.presets_in(phase);
        let preset = presets.iter().filter(|i| i.quantity == quantity && i.target == *target);
        let all = phase.inputs_on(quantity, target).chain(preset);
        let mut breaks: Vec<f64> = all.flat_map(|input| input.signal.breaks()).copied().collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}
