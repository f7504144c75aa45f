//! The phase in force, as commands have changed it: numbers and names as they are, and functions by their
//! place in the scene.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::base::formula::Formula;
use crate::base::input::InputError;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Constrained, Constraint, Motion, Spline, Turn};
use crate::scene::forces::{Signal, SignalKind, TimeTable, VectorSignal};
use crate::scene::timeline::{ContactWith, Load, LoadKind, Phase, Scene};

/// What is in force.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InForce {
    constraints: Vec<(Constrained, How)>,
    loads: Vec<(Selection, LoadKind, Vector)>,
    /// Names of springs, force.
    actuations: Vec<(Vec<String>, Number)>,
    /// Name of a chamber, pressure.
    pressures: Vec<(String, Number)>,
    /// Names of the obstacles that act; without: all.
    #[serde(deserialize_with = "Option::deserialize")]
    contact: Option<Vec<String>>,
    /// Obstacles that commands have set in motion: name, offset from where its velocity or path would have
    /// brought it, and velocity; without one: its path in the scene.
    moving: Vec<(String, [f64; 3], Option<[f64; 3]>)>,
}

/// A [`Motion`].
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum How {
    Hold,
    Velocity(Vec<f64>),
    Path {
        times: Vec<f64>,
        displacements: Vec<f64>,
    },
    Formula(String),
    Turn {
        centre: Vec<f64>,
        axis: Vec<f64>,
        /// Times and angles of its path.
        #[serde(deserialize_with = "Option::deserialize")]
        path: Option<[Vec<f64>; 2]>,
    },
    /// The motion of a constraint of the phase in the scene, by its number from 0.
    OfScene(usize),
}

/// A [`VectorSignal`].
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Vector {
    Constant(Vec<f64>),
    Table {
        times: Vec<f64>,
        values: Vec<Vec<f64>>,
    },
    Formulas(Vec<String>),
    /// A load of the phase in the scene, by its number from 0.
    OfScene(usize),
}

/// A [`Signal`].
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Number {
    Constant(f64),
    Table {
        times: Vec<f64>,
        values: Vec<Vec<f64>>,
    },
    Formula(String),
    /// An actuation or pressure of the phase in the scene, by its number from 0.
    OfScene(usize),
}

impl InForce {
    /// `phase`, which is the phase `own` of the scene as commands have changed it.
    ///
    /// # Errors
    /// A function that `own` does not have.
    pub(super) fn of(phase: &Phase, own: &Phase) -> Result<Self, InputError> {
        let constraints = phase.constraints.iter().map(|Constraint { what, how }| {
            let how = How::of(how, own).ok_or_else(|| is_function(format!("path of {what:?}")))?;
            Ok((what.clone(), how))
        });
        let loads = phase.loads.iter().map(|(nodes, load)| {
            let value = Vector::of(&load.value, own);
            let value = value.ok_or_else(|| is_function(format!("load on {nodes}")))?;
            Ok((nodes.clone(), load.kind, value))
        });
        let actuations = phase.actuations.iter().map(|(springs, force)| {
            let force = Number::of(force, own.actuations.iter().map(|(_, force)| force));
            let names = || springs.join("\", \"");
            let force =
                force.ok_or_else(|| is_function(format!("actuation of spring \"{}\"", names())))?;
            Ok((springs.clone(), force))
        });
        let pressures = phase.pressures.iter().map(|(chamber, pressure)| {
            let pressure = Number::of(pressure, own.pressures.iter().map(|(_, own)| own));
            let pressure = pressure
                .ok_or_else(|| is_function(format!("pressure of chamber \"{chamber}\"")))?;
            Ok((chamber.clone(), pressure))
        });
        Ok(Self {
            constraints: constraints.collect::<Result<_, InputError>>()?,
            loads: loads.collect::<Result<_, InputError>>()?,
            actuations: actuations.collect::<Result<_, InputError>>()?,
            pressures: pressures.collect::<Result<_, InputError>>()?,
            contact: match &phase.contact {
                ContactWith::All => None,
                ContactWith::These(names) => Some(names.clone()),
            },
            moving: phase
                .redirected
                .iter()
                .map(|obstacle| {
                    (obstacle.name().into(), obstacle.offset(), obstacle.constant_velocity())
                })
                .collect(),
        })
    }

    /// The phase in force; `own` is what the scene has.
    ///
    /// # Errors
    /// Functions that do not exist. All else is [checked](Phase) by the scene.
    pub(super) fn read(self, own: &Phase, scene: &Scene) -> Result<Phase, String> {
        let constraints = self.constraints.into_iter();
        let constraints =
            constraints.map(|(what, how)| Ok(Constraint { what, how: how.read(own)? }));
        let loads = self.loads.into_iter();
        let loads =
            loads.map(|(nodes, kind, value)| Ok((nodes, Load { kind, value: value.read(own)? })));
        let actuations = self.actuations.into_iter().map(|(springs, force)| {
            let own = own.actuations.iter().map(|(_, force)| force);
            Ok((springs, force.read("actuation", own)?))
        });
        let pressures = self.pressures.into_iter().map(|(chamber, pressure)| {
            let own = own.pressures.iter().map(|(_, pressure)| pressure);
            Ok((chamber, pressure.read("pressure", own)?))
        });
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
            constraints: constraints.collect::<Result<_, String>>()?,
            loads: loads.collect::<Result<_, String>>()?,
            actuations: actuations.collect::<Result<_, String>>()?,
            pressures: pressures.collect::<Result<_, String>>()?,
            contact: self.contact.map_or(ContactWith::All, ContactWith::These),
            redirected: moving.collect::<Result<_, String>>()?,
            ..own.clone()
        })
    }
}

fn is_function(input: String) -> InputError {
    let help = "a file cannot hold it; command a constant or a table before";
    InputError::new(input, "a function of time", help)
}

/// The item that the scene has at a place.
fn own<T: Clone>(
    what: &str,
    place: usize,
    mut items: impl Iterator<Item = T>,
) -> Result<T, String> {
    let item = items.nth(place);
    item.ok_or_else(|| format!("{what} {place} is none of the phase in the scene: write it anew"))
}

impl How {
    fn of(motion: &Motion, own: &Phase) -> Option<Self> {
        Some(match motion {
            Motion::Hold => Self::Hold,
            Motion::Velocity(velocity) => Self::Velocity(velocity.clone()),
            Motion::Spline(spline) => Self::Path {
                times: spline.times().into(),
                displacements: spline.displacements().into(),
            },
            Motion::Formula(formula) => Self::Formula(formula.text().into()),
            Motion::Turn(turn) => {
                let numbers = |path: &Spline| [path.times().into(), path.displacements().into()];
                let path = turn.angles.as_ref().map(numbers);
                Self::Turn { centre: turn.centre.clone(), axis: turn.axis.clone(), path }
            }
            Motion::Path(path) => Self::OfScene(own.constraints.iter().position(
                |constraint| matches!(&constraint.how, Motion::Path(own) if Arc::ptr_eq(own, path)),
            )?),
        })
    }

    fn read(self, phase: &Phase) -> Result<Motion, String> {
        Ok(match self {
            Self::Hold => Motion::Hold,
            Self::Velocity(velocity) => Motion::Velocity(velocity),
            Self::Path { times, displacements } => {
                Motion::Spline(Arc::new(Spline::new(times, displacements)))
            }
            Self::Formula(text) => Motion::Formula(Arc::new(Formula::parse(&text)?)),
            Self::Turn { centre, axis, path } => {
                let angles = path.map(|[times, angles]| Spline::new(times, angles));
                Motion::Turn(Arc::new(Turn { centre, axis, angles }))
            }
            Self::OfScene(place) => {
                own("constraint", place, phase.constraints.iter().map(|own| own.how.clone()))?
            }
        })
    }
}

impl Vector {
    fn of(value: &VectorSignal, own: &Phase) -> Option<Self> {
        Some(match value {
            VectorSignal::Constant(vector) => Self::Constant(vector.clone()),
            VectorSignal::Live(live) => Self::Constant(live.get()),
            VectorSignal::TimeTable(TimeTable { times, values }) => {
                Self::Table { times: times.clone(), values: values.clone() }
            }
            VectorSignal::Formulas(formulas) => {
                Self::Formulas(formulas.iter().map(|formula| formula.text().into()).collect())
            }
            VectorSignal::Function { write, .. } => {
                Self::OfScene(own.loads.iter().position(|(_, own)| match &own.value {
                    VectorSignal::Function { write: own, .. } => Arc::ptr_eq(own, write),
                    _ => false,
                })?)
            }
        })
    }

    fn read(self, phase: &Phase) -> Result<VectorSignal, String> {
        Ok(match self {
            Self::Constant(vector) => VectorSignal::Constant(vector),
            Self::Table { times, values } => VectorSignal::TimeTable(TimeTable::new(times, values)),
            Self::Formulas(texts) => {
                let formulas = texts.iter().map(|text| Formula::parse(text));
                VectorSignal::Formulas(formulas.collect::<Result<_, _>>()?)
            }
            Self::OfScene(place) => {
                own("load", place, phase.loads.iter().map(|(_, load)| load.value.clone()))?
            }
        })
    }
}

impl Number {
    fn of<'a>(signal: &Signal, mut own: impl Iterator<Item = &'a Signal>) -> Option<Self> {
        Some(match &signal.0 {
            SignalKind::Constant(_) | SignalKind::Live(_) => Self::Constant(signal.at(0.0)),
            SignalKind::TimeTable(TimeTable { times, values }) => {
                Self::Table { times: times.clone(), values: values.clone() }
            }
            SignalKind::Formula(formula) => Self::Formula(formula.text().into()),
            SignalKind::Function { function, breaks } => {
                Self::OfScene(own.position(|own| match &own.0 {
                    SignalKind::Function { function: own, breaks: theirs } => {
                        Arc::ptr_eq(own, function) && theirs == breaks
                    }
                    _ => false,
                })?)
            }
        })
    }

    fn read<'a>(
        self,
        what: &str,
        signals: impl Iterator<Item = &'a Signal>,
    ) -> Result<Signal, String> {
        Ok(match self {
            Self::Constant(value) => Signal::constant(value),
            Self::Table { times, values } => {
                Signal(SignalKind::TimeTable(TimeTable::new(times, values)))
            }
            Self::Formula(text) => Signal(SignalKind::Formula(Arc::new(Formula::parse(&text)?))),
            Self::OfScene(place) => own(what, place, signals.cloned())?,
        })
    }
}
