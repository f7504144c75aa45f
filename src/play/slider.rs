//! What a person moves by sliders: pressures of chambers and forces of actuators.

use serde_json::{Value, json};

use crate::error::Error;
use crate::external::Signal;
use crate::scene::{Phase, Scene};
use crate::simulate::Simulation;

/// What a slider sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The pressure of a chamber (Pa).
    Pressure,
    /// The force of the actuator of a spring (N).
    Actuation,
}

/// A slider.
pub(super) struct Slider {
    pub(super) kind: Kind,
    /// Name of the chamber or the spring.
    pub(super) name: String,
    /// It goes from -`most` to `most`.
    most: f64,
}

/// Pressure (in Young's moduli) and strain by which a slider reaches as far as is useful, where the scene says
/// nothing itself.
const USUAL: f64 = 0.05;

impl Slider {
    /// The sliders of a scene.
    pub(super) fn all(scene: &Scene) -> Vec<Self> {
        let young = scene.body().material().young;
        let chambers = scene.chambers().iter().map(|chamber| {
            let name = chamber.name().to_owned();
            (Kind::Pressure, name, USUAL * young)
        });
        // what a spring of the stiffness of the body needs for half of that strain is a usual force
        let size = scene.body().mesh().size();
        let force = USUAL * young * scene.body().volume() / size;
        let springs = scene.springs().iter().map(|spring| {
            let name = spring.name().to_owned();
            (Kind::Actuation, name, force)
        });
        let sliders = chambers.chain(springs).map(|(kind, name, usual)| {
            let most = largest(scene, kind, &name);
            let most = round_up(if most > 0.0 { 2.0 * most } else { usual });
            Self { kind, name, most }
        });
        sliders.collect()
    }

    /// The value in force.
    pub(super) fn value(&self, simulation: &Simulation) -> Result<f64, Error> {
        Ok(match self.kind {
            Kind::Pressure => simulation.pressure_in(&self.name)?,
            Kind::Actuation => simulation.actuation_of(&self.name)?,
        })
    }

    /// Puts `signal` in force.
    pub(super) fn set(&self, simulation: &mut Simulation, signal: Signal) -> Result<(), Error> {
        match self.kind {
            Kind::Pressure => simulation.pressure(&self.name, signal),
            Kind::Actuation => simulation.actuate(&self.name, signal),
        }
    }

    pub(super) fn to_json(&self) -> Value {
        let (what, unit, order) = match self.kind {
            Kind::Pressure => ("pressure", "Pa", "pressure"),
            Kind::Actuation => ("actuator", "N", "actuate"),
        };
        json!({ "do": order, "name": self.name, "what": what, "unit": unit, "most": self.most })
    }
}

/// What `phase` itself says of a chamber or a spring; the sum of it acts.
pub(super) fn signals<'a>(
    phase: &'a Phase,
    kind: Kind,
    name: &'a str,
) -> Box<dyn Iterator<Item = &'a Signal> + 'a> {
    match kind {
        Kind::Pressure => Box::new(
            phase.pressures.iter().filter(move |(chamber, _)| chamber == name).map(|(_, s)| s),
        ),
        Kind::Actuation => Box::new(phase.actuations.iter().flat_map(move |(springs, signal)| {
            springs.iter().filter(move |spring| *spring == name).map(move |_| signal)
        })),
    }
}

/// The largest value that the scene itself has for a chamber or a spring.
fn largest(scene: &Scene, kind: Kind, name: &str) -> f64 {
    let mut largest = 0.0_f64;
    for phase in scene.phases() {
        for signal in signals(phase, kind, name) {
            let times = signal.breaks().iter().copied().chain([phase.end()]);
            largest = times.fold(largest, |largest, t| largest.max(signal.at(t).abs()));
        }
    }
    largest
}

/// The next number with one digit.
fn round_up(x: f64) -> f64 {
    if !x.is_normal() {
        return 1.0;
    }
    let unit = 10_f64.powf(x.abs().log10().floor());
    // 2.0000001 of them are 2
    (x.abs() / unit - 1e-6).ceil() * unit
}
