//! The current phase, as commands have changed it: numbers and names as values, and functions by their
//! index in the scene.

use std::collections::BTreeMap;
use std::mem::take;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Constrained, Constraint, Motion};
use crate::scene::forces::{Signal, SignalKind, VectorSignal};
use crate::scene::timeline::{
    ContactWith, Input, InputSignal, LoadKind, Phase, Quantity, Scene, Target,
};

/// Constraints, inputs and obstacles in force.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PhaseOverrides {
    constraints: Vec<(Constrained, Stored<Motion>)>,
    /// None in files in which they stand by their quantities.
    inputs: Option<Vec<(StoredQuantity, Target, StoredSignal)>>,
    /// Names of the obstacles that act; without: all.
    contact: ContactWith,
    /// Obstacles that commands have set in motion: name, offset from where its velocity or path would have
    /// brought it, and velocity; without one: its path in the scene.
    moving: Vec<(String, [f64; 3], Option<[f64; 3]>)>,
    // inputs of files that were written when each quantity had a list
    #[serde(default, skip_serializing)]
    loads: Vec<(Selection, LoadKind, Stored<VectorSignal>)>,
    #[serde(default, skip_serializing)]
    actuations: Vec<(Vec<String>, Stored<SignalKind>)>,
    #[serde(default, skip_serializing)]
    pressures: Vec<(String, Stored<SignalKind>)>,
    #[serde(default, skip_serializing)]
    openings: Vec<(String, Stored<SignalKind>)>,
    #[serde(default, skip_serializing)]
    flows: Vec<(String, Stored<SignalKind>)>,
    #[serde(default, skip_serializing)]
    magnetic_field: Option<Stored<VectorSignal>>,
    #[serde(default, skip_serializing)]
    dipoles: Vec<(String, String, Stored<VectorSignal>)>,
}

/// A quantity; of a device the word of its input.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum StoredQuantity {
    Device {
        input: String,
    },
    Known(Quantity),
    /// The word of the input by the kind of the device, in files of earlier versions.
    OfKind(BTreeMap<String, String>),
}

impl StoredQuantity {
    fn of(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Device(input) => Self::Device { input: input.word.into() },
            known => Self::Known(known),
        }
    }

    /// # Errors
    /// An input that the device does not have.
    fn read(self, target: &Target, scene: &Scene) -> Result<Quantity, String> {
        let input = match self {
            Self::Known(quantity) => return Ok(quantity),
            Self::Device { input } => input,
            Self::OfKind(words) => words.into_values().collect(),
        };
        Self::of_device(&input, target, scene)
    }

    fn of_device(input: &str, target: &Target, scene: &Scene) -> Result<Quantity, String> {
        let device = target.names().first().map_or("", |name| name);
        let row = scene.device_row(device, input).map_err(|error| error.to_string())?;
        Ok(Quantity::Device(row))
    }
}

/// A motion or a signal.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Stored<T> {
    /// A function, by the number (from 0) among its like that the phase has in the scene.
    #[serde(rename = "of_scene")]
    SceneFunction(usize),
    #[serde(untagged)]
    Itself(T),
}

/// Values that may be given by a function.
trait Changing: Clone {
    /// Index of the function, and its breaks, if it is one.
    fn function(&self) -> Option<(*const (), &[f64])>;
}

impl Changing for Motion {
    fn function(&self) -> Option<(*const (), &[f64])> {
        match self {
            Self::Path(path) => Some((Arc::as_ptr(path).cast(), &[])),
            _ => None,
        }
    }
}

impl Changing for VectorSignal {
    fn function(&self) -> Option<(*const (), &[f64])> {
        match self {
            Self::Function { write, .. } => Some((Arc::as_ptr(write).cast(), &[])),
            _ => None,
        }
    }
}

impl Changing for SignalKind {
    fn function(&self) -> Option<(*const (), &[f64])> {
        match self {
            Self::Function { function, breaks } => Some((Arc::as_ptr(function).cast(), breaks)),
            _ => None,
        }
    }
}

impl<T: Changing> Stored<T> {
    /// `own` are its like in the scene.
    ///
    /// # Errors
    /// A function that is none of them.
    fn of<'a>(
        value: &'a T,
        mut own: impl Iterator<Item = &'a T>,
        name: impl FnOnce() -> String,
    ) -> Result<Self, InputError> {
        let Some(function) = value.function() else { return Ok(Self::Itself(value.clone())) };
        let place = own.position(|own| own.function() == Some(function));
        place.map(Self::SceneFunction).ok_or_else(|| {
            let help = "a file cannot hold it; command a constant or a table before";
            InputError::new(name(), "a function of time", help)
        })
    }

    /// # Errors
    /// A function that the scene does not have.
    fn read<'a>(self, what: &str, mut own: impl Iterator<Item = &'a T>) -> Result<T, String>
    where
        T: 'a,
    {
        match self {
            Self::Itself(value) => Ok(value),
            Self::SceneFunction(place) => own.nth(place).cloned().ok_or_else(|| {
                format!("the phase in the scene has no {what} {place}: recreate the checkpoint")
            }),
        }
    }
}

fn motions(phase: &Phase) -> impl Iterator<Item = &Motion> {
    phase.constraints.iter().map(|constraint| &constraint.how)
}

/// Signals of one component of the inputs of some quantities.
fn numbers(phase: &Phase, of: impl Fn(Quantity) -> bool) -> impl Iterator<Item = &SignalKind> {
    let all = phase.inputs.iter().filter(move |input| of(input.quantity));
    all.filter_map(|input| match &input.signal {
        InputSignal::Number(Signal(signal)) => Some(signal),
        InputSignal::Vector(_) => None,
    })
}

/// Signals of one component per dimension, likewise.
fn vectors(phase: &Phase, of: impl Fn(Quantity) -> bool) -> impl Iterator<Item = &VectorSignal> {
    let all = phase.inputs.iter().filter(move |input| of(input.quantity));
    all.filter_map(|input| match &input.signal {
        InputSignal::Vector(vector) => Some(vector),
        InputSignal::Number(_) => None,
    })
}

/// The signal of an input.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StoredSignal {
    Number(Stored<SignalKind>),
    Vector(Stored<VectorSignal>),
}

impl StoredSignal {
    fn of(
        signal: &InputSignal,
        own: &Phase,
        name: impl FnOnce() -> String,
    ) -> Result<Self, InputError> {
        match signal {
            InputSignal::Number(Signal(signal)) => {
                Stored::of(signal, numbers(own, |_| true), name).map(Self::Number)
            }
            InputSignal::Vector(signal) => {
                Stored::of(signal, vectors(own, |_| true), name).map(Self::Vector)
            }
        }
    }

    fn read(self, own: &Phase) -> Result<InputSignal, String> {
        Ok(match self {
            Self::Number(signal) => Signal(signal.read("signal", numbers(own, |_| true))?).into(),
            Self::Vector(signal) => signal.read("signal", vectors(own, |_| true))?.into(),
        })
    }
}

impl PhaseOverrides {
    /// `phase`, which is the phase `own` of the scene as commands have changed it.
    ///
    /// # Errors
    /// A function that `own` does not have.
    pub(super) fn of(phase: &Phase, own: &Phase) -> Result<Self, InputError> {
        let constraints = phase.constraints.iter().map(|Constraint { what, how }| {
            let how = Stored::of(how, motions(own), || format!("path of {what:?}"))?;
            Ok((what.clone(), how))
        });
        let inputs = phase.inputs.iter().map(|Input { quantity, target, signal }| {
            let signal = StoredSignal::of(signal, own, || quantity.of(target))?;
            Ok((StoredQuantity::of(*quantity), target.clone(), signal))
        });
        let moving = phase.redirected.iter().map(|obstacle| {
            (obstacle.name().into(), obstacle.offset(), obstacle.constant_velocity())
        });
        Ok(Self {
            constraints: constraints.collect::<Result<_, InputError>>()?,
            inputs: Some(inputs.collect::<Result<_, InputError>>()?),
            contact: phase.contact.clone(),
            moving: moving.collect(),
            loads: Vec::new(),
            actuations: Vec::new(),
            pressures: Vec::new(),
            openings: Vec::new(),
            flows: Vec::new(),
            magnetic_field: None,
            dipoles: Vec::new(),
        })
    }

    /// The current phase; `own` is that of the scene.
    ///
    /// # Errors
    /// Functions that do not exist. All else is [checked](Phase) by the scene.
    pub(super) fn read(mut self, own: &Phase, scene: &Scene) -> Result<Phase, String> {
        let inputs = match self.inputs.take() {
            Some(inputs) => {
                let read = |(quantity, target, signal): (StoredQuantity, _, StoredSignal)| {
                    let quantity = quantity.read(&target, scene)?;
                    Ok(Input { quantity, target, signal: signal.read(own)? })
                };
                inputs.into_iter().map(read).collect::<Result<_, String>>()?
            }
            None => self.inputs_by_quantity(own, scene)?,
        };
        let constraints = self
            .constraints
            .into_iter()
            .map(|(what, how)| Ok(Constraint { what, how: how.read("constraint", motions(own))? }));
        let moving = self.moving.into_iter().map(|(name, offset, velocity)| {
            let obstacle = scene.obstacles().iter().find(|obstacle| obstacle.name() == name);
            let obstacle =
                obstacle.ok_or_else(|| format!("the scene has no obstacle \"{name}\""))?;
            let obstacle = obstacle.clone().with_offset(offset);
            Ok(match velocity {
                Some(velocity) => obstacle.velocity(&velocity[..scene.body().dimension()]),
                None => obstacle,
            })
        });
        Ok(Phase {
            inputs,
            constraints: constraints.collect::<Result<_, String>>()?,
            contact: self.contact,
            redirected: moving.collect::<Result<_, String>>()?,
            ..own.clone()
        })
    }

    /// Inputs of a file in which each quantity has a list; a function has a number among those of its list.
    fn inputs_by_quantity(&mut self, own: &Phase, scene: &Scene) -> Result<Vec<Input>, String> {
        let mut inputs = Vec::new();
        let mut add = |quantity, target, signal: InputSignal| {
            inputs.push(Input { quantity, target, signal });
        };
        let named = |list: &mut Vec<(String, Stored<SignalKind>)>| {
            let list = take(list).into_iter();
            list.map(|(name, signal)| (vec![name], signal)).collect::<Vec<_>>()
        };
        let [pressures, openings, flows] =
            [&mut self.pressures, &mut self.openings, &mut self.flows].map(named);
        for (quantity, list) in [
            (Quantity::Actuation, take(&mut self.actuations)),
            (Quantity::Pressure, pressures),
            (Quantity::Opening, openings),
            (Quantity::Flow, flows),
        ] {
            for (names, signal) in list {
                let own = numbers(own, |other| other == quantity);
                let signal = Signal(signal.read(quantity.row().name, own)?);
                add(quantity, Target::Named(names), signal.into());
            }
        }
        for (nodes, kind, value) in take(&mut self.loads) {
            let own = vectors(own, |other| matches!(other, Quantity::Load(_)));
            add(Quantity::Load(kind), Target::Nodes(nodes), value.read("load", own)?.into());
        }
        for (name, word, value) in take(&mut self.dipoles) {
            let own = vectors(own, |other| matches!(other, Quantity::Device(_)));
            let target = Target::one(name);
            let quantity = StoredQuantity::of_device(&word, &target, scene)?;
            add(quantity, target, value.read("dipole", own)?.into());
        }
        let fields = || vectors(own, |other| other == Quantity::Field);
        let field = self.magnetic_field.take();
        let field = field.map(|field| field.read("magnetic field", fields())).transpose()?;
        if let Some(field) = field.or_else(|| fields().next().cloned()) {
            add(Quantity::Field, Target::Everything, field.into());
        }
        // no command sets them, and no such file has them
        let on_faces = own.inputs.iter().filter(|i| i.quantity == Quantity::FacePressure);
        inputs.extend(on_faces.cloned());
        Ok(inputs)
    }
}
