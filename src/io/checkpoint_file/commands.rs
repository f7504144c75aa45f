//! The phase in force, as commands have changed it: numbers and names as they are, and functions by their
//! place in the scene.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Constrained, Constraint, Motion};
use crate::scene::forces::{DipolePart, MagneticField, Signal, SignalKind, VectorSignal};
use crate::scene::timeline::{ContactWith, Load, LoadKind, Phase, Scene};

/// Constraints, loads, signals, flows and obstacles in force.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InForce {
    constraints: Vec<(Constrained, Given<Motion>)>,
    loads: Vec<(Selection, LoadKind, Given<VectorSignal>)>,
    /// Names of springs or muscles, force or stress.
    actuations: Vec<(Vec<String>, Given<SignalKind>)>,
    /// Name of a chamber, pressure.
    pressures: Vec<(String, Given<SignalKind>)>,
    /// Name of an orifice, opening.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    openings: Vec<(String, Given<SignalKind>)>,
    /// Name of a chamber, flow of its liquid.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    flows: Vec<(String, Given<SignalKind>)>,
    /// Names of the obstacles that act; without: all.
    contact: ContactWith,
    /// Obstacles that commands have set in motion: name, offset from where its velocity or path would have
    /// brought it, and velocity; without one: its path in the scene.
    moving: Vec<(String, [f64; 3], Option<[f64; 3]>)>,
    /// The uniform part of the magnetic field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    magnetic_field: Option<Given<VectorSignal>>,
    /// Name of a dipole, and what is otherwise of it than in the scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    dipoles: Vec<(String, DipolePart, Given<VectorSignal>)>,
}

/// A motion, load, force or pressure.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Given<T> {
    /// A function, by the number (from 0) among its like that the phase has in the scene.
    OfScene(usize),
    #[serde(untagged)]
    Itself(T),
}

/// Values that may be given by a function.
trait Changing: Clone {
    /// Where the function is, and its breaks, if it is one.
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

impl<T: Changing> Given<T> {
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
        place.map(Self::OfScene).ok_or_else(|| {
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
            Self::OfScene(place) => own.nth(place).cloned().ok_or_else(|| {
                format!("{what} {place} is none of the phase in the scene: write it anew")
            }),
        }
    }
}

fn motions(phase: &Phase) -> impl Iterator<Item = &Motion> {
    phase.constraints.iter().map(|constraint| &constraint.how)
}

fn values(phase: &Phase) -> impl Iterator<Item = &VectorSignal> {
    phase.loads.iter().map(|(_, load)| &load.value)
}

fn fields(phase: &Phase) -> impl Iterator<Item = &VectorSignal> {
    phase.magnetic_field.iter().map(|field| &field.field)
}

fn of_dipoles(phase: &Phase) -> impl Iterator<Item = &VectorSignal> {
    phase.dipoles.iter().map(|(.., value)| value)
}

fn forces(phase: &Phase) -> impl Iterator<Item = &SignalKind> {
    phase.actuations.iter().map(|(_, force)| &force.0)
}

fn pressures(phase: &Phase) -> impl Iterator<Item = &SignalKind> {
    phase.pressures.iter().map(|(_, pressure)| &pressure.0)
}

fn openings(phase: &Phase) -> impl Iterator<Item = &SignalKind> {
    phase.openings.iter().map(|(_, opening)| &opening.0)
}

fn flows(phase: &Phase) -> impl Iterator<Item = &SignalKind> {
    phase.flows.iter().map(|(_, flow)| &flow.0)
}

impl InForce {
    /// `phase`, which is the phase `own` of the scene as commands have changed it.
    ///
    /// # Errors
    /// A function that `own` does not have.
    pub(super) fn of(phase: &Phase, own: &Phase) -> Result<Self, InputError> {
        let constraints = phase.constraints.iter().map(|Constraint { what, how }| {
            let how = Given::of(how, motions(own), || format!("path of {what:?}"))?;
            Ok((what.clone(), how))
        });
        let loads = phase.loads.iter().map(|(nodes, load)| {
            let value = Given::of(&load.value, values(own), || format!("load on {nodes}"))?;
            Ok((nodes.clone(), load.kind, value))
        });
        let actuations = phase.actuations.iter().map(|(springs, force)| {
            let name = || format!("actuation of spring \"{}\"", springs.join("\", \""));
            Ok((springs.clone(), Given::of(&force.0, forces(own), name)?))
        });
        let pressures = phase.pressures.iter().map(|(chamber, pressure)| {
            let name = || format!("pressure of chamber \"{chamber}\"");
            Ok((chamber.clone(), Given::of(&pressure.0, pressures(own), name)?))
        });
        let openings = phase.openings.iter().map(|(orifice, opening)| {
            let name = || format!("opening of orifice \"{orifice}\"");
            Ok((orifice.clone(), Given::of(&opening.0, openings(own), name)?))
        });
        let flows_given = phase.flows.iter().map(|(chamber, flow)| {
            let name = || format!("flow into chamber \"{chamber}\"");
            Ok((chamber.clone(), Given::of(&flow.0, flows(own), name)?))
        });
        let mut fields_given = fields(phase)
            .map(|field| Given::of(field, fields(own), || "magnetic field".to_owned()));
        let magnetic_field = fields_given.next().transpose()?;
        let dipoles = phase.dipoles.iter().map(|(name, part, value)| {
            let what = || format!("{part} of dipole \"{name}\"");
            Ok((name.clone(), *part, Given::of(value, of_dipoles(own), what)?))
        });
        let moving = phase.redirected.iter().map(|obstacle| {
            (obstacle.name().into(), obstacle.offset(), obstacle.constant_velocity())
        });
        Ok(Self {
            constraints: constraints.collect::<Result<_, InputError>>()?,
            loads: loads.collect::<Result<_, InputError>>()?,
            actuations: actuations.collect::<Result<_, InputError>>()?,
            pressures: pressures.collect::<Result<_, InputError>>()?,
            openings: openings.collect::<Result<_, InputError>>()?,
            flows: flows_given.collect::<Result<_, InputError>>()?,
            contact: phase.contact.clone(),
            moving: moving.collect(),
            magnetic_field,
            dipoles: dipoles.collect::<Result<_, InputError>>()?,
        })
    }

    /// The phase in force; `own` is what the scene has.
    ///
    /// # Errors
    /// Functions that do not exist. All else is [checked](Phase) by the scene.
    pub(super) fn read(self, own: &Phase, scene: &Scene) -> Result<Phase, String> {
        let constraints = self
            .constraints
            .into_iter()
            .map(|(what, how)| Ok(Constraint { what, how: how.read("constraint", motions(own))? }));
        let loads = self.loads.into_iter().map(|(nodes, kind, value)| {
            Ok((nodes, Load { kind, value: value.read("load", values(own))? }))
        });
        let actuations = self
            .actuations
            .into_iter()
            .map(|(springs, force)| Ok((springs, Signal(force.read("actuation", forces(own))?))));
        let pressures = self.pressures.into_iter().map(|(chamber, pressure)| {
            Ok((chamber, Signal(pressure.read("pressure", pressures(own))?)))
        });
        let openings = self.openings.into_iter().map(|(orifice, opening)| {
            Ok((orifice, Signal(opening.read("opening", openings(own))?)))
        });
        let flows_given = self
            .flows
            .into_iter()
            .map(|(chamber, flow)| Ok((chamber, Signal(flow.read("flow", flows(own))?))));
        let dipoles = self
            .dipoles
            .into_iter()
            .map(|(name, part, value)| Ok((name, part, value.read("dipole", of_dipoles(own))?)));
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
        let mut magnetic_field = own.magnetic_field.clone();
        if let Some(field) = self.magnetic_field {
            let field = field.read("magnetic field", fields(own))?;
            match &mut magnetic_field {
                Some(own) => own.field = field,
                none => *none = Some(MagneticField::of(field)),
            }
        }
        Ok(Phase {
            magnetic_field,
            dipoles: dipoles.collect::<Result<_, String>>()?,
            constraints: constraints.collect::<Result<_, String>>()?,
            loads: loads.collect::<Result<_, String>>()?,
            actuations: actuations.collect::<Result<_, String>>()?,
            pressures: pressures.collect::<Result<_, String>>()?,
            openings: openings.collect::<Result<_, String>>()?,
            flows: flows_given.collect::<Result<_, String>>()?,
            contact: self.contact,
            redirected: moving.collect::<Result<_, String>>()?,
            ..own.clone()
        })
    }
}
