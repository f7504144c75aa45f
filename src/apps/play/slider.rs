//! Sliders for pressures of chambers, flows of liquids, openings of orifices, actuators, loads, magnetic fields, inputs of devices.
//!
//! A slider changes its value along a straight line and not by a jump, so that the table in the saved file is
//! exactly the signal that acted (`io/scene_file/rewrite.rs`). A load has a slider for each component, each
//! with lines of its own, and the table of all of them acts.

use std::sync::Arc;

use serde_json::{Value, json};

use crate::dynamics::simulate::Simulation;
use crate::elements::body::{Body, Part};
use crate::elements::mesh::Selection;
use crate::scene::forces::{Chamber, Drive, Lag};
use crate::scene::timeline::{self, Device, DeviceInput, LoadKind, Phase, Quantity, Scene};

/// The input that a slider sets, or a component of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Target {
    pub(super) quantity: Quantity,
    pub(super) of: timeline::Target,
    /// Number of the component, from 0; none of an input that has one.
    pub(super) axis: Option<usize>,
}

/// A slider.
pub(super) struct Slider {
    pub(super) target: Target,
    /// Its range is `least` to `most`.
    least: f64,
    most: f64,
    /// Name of the quantity on the page.
    what: String,
    unit: &'static str,
}

/// Steady-state temperature rise (K) of a usual heating power, where the phases give less; sliders go to twice that power.
const USUAL_WARMTH: f64 = 50.0;

/// Pressure (in Young's moduli) and strain that give a useful range of a slider where the scene has no
/// values.
const USUAL: f64 = 0.05;
/// A usual magnetic field (T).
const USUAL_FIELD: f64 = 0.05;
/// Times of a phase at which its values are looked at.
const LOOKS: u32 = 20;
/// Most node numbers in the name of a slider.
const FEW: usize = 6;

impl Slider {
    /// The sliders of a scene.
    pub(super) fn all(scene: &Scene) -> Vec<Self> {
        let [force, pressure] = usual(scene.body());
        let is_empty = |chamber: &&Chamber| {
            let name = chamber.name();
            scene.gas_in(name).is_none() && scene.liquid_in(name).is_none()
        };
        let chambers = scene.chambers().iter().filter(is_empty).map(|chamber| {
            let target = Target::of(Quantity::Pressure, chamber.name());
            let range = [target.largest_in(scene), pressure];
            Self::new(target, "pressure".into(), range, "Pa")
        });
        let orifices = scene.orifices().iter().map(|orifice| Self {
            target: Target::of(Quantity::Opening, orifice.name()),
            least: 0.0,
            most: 1.0,
            what: "opening".into(),
            unit: "",
        });
        // a usual part of the volume of the bodies in a second
        let pumped = USUAL * scene.body().volume();
        let flows = scene.liquids().iter().map(|liquid| {
            let target = Target::of(Quantity::Flow, liquid.chamber());
            let range = [target.largest_in(scene), pumped];
            Self::new(target, "flow".into(), range, "m^3/s")
        });
        let (mut actuators, mut heaters) = (Vec::new(), Vec::new());
        for actuator in scene.actuators() {
            let target = Target::of(Quantity::Actuation, actuator.name());
            let (kind, largest) = (actuator.kind(), target.largest_in(scene));
            if let Some(loss) = scene.lag_of(actuator.name()).and_then(Lag::loss) {
                let most = round_up(2.0 * largest.max(loss * USUAL_WARMTH));
                heaters.push(Self { target, least: 0.0, most, what: "power".into(), unit: "W" });
                continue;
            }
            let (what, unit) = (kind.label.into(), kind.drive.unit());
            if let Some(hill) = actuator.hill() {
                actuators.push(Self { target, least: 0.0, most: hill.largest, what, unit });
                continue;
            }
            let usual = match kind.drive {
                Drive::Force => force,
                Drive::Length => USUAL * scene.body().size(),
                Drive::Stress => pressure,
                Drive::Strain => USUAL,
            };
            actuators.push(Self::new(target, what, [largest, usual], unit));
        }
        let mut loaded: Vec<&Selection> = Vec::new();
        for (nodes, ..) in scene.phases().iter().flat_map(Phase::loads) {
            if !loaded.contains(&nodes) {
                loaded.push(nodes);
            }
        }
        let loads =
            loaded.into_iter().flat_map(|nodes| Self::of_load(scene, nodes, [force, pressure]));
        let of = timeline::Target::Everything;
        let field = Target { quantity: Quantity::Field, of, axis: None };
        let field = Some(field).filter(|_| !scene.magnets().is_empty());
        let fields = field
            .iter()
            .flat_map(|field| Self::of_input(scene, field, USUAL_FIELD, |axis| axis.into()));
        chambers
            .chain(orifices)
            .chain(flows)
            .chain(actuators)
            .chain(heaters)
            .chain(fields)
            .chain(Self::of_devices(scene))
            .chain(loads)
            .chain(Self::on_nodes(scene, force))
            .collect()
    }

    /// One slider per component of the forces and moments on nodes together; the last argument is a usual force.
    fn on_nodes(scene: &Scene, force: f64) -> Vec<Self> {
        let mut targets: Vec<Target> = Vec::new();
        for input in scene.phases().iter().flat_map(|phase| &phase.inputs) {
            let (quantity, of) = (input.quantity, input.target.clone());
            let whole = Target { quantity, of, axis: None };
            if quantity.is_force_on_nodes() && !targets.contains(&whole) {
                targets.push(whole);
            }
        }
        let sliders = targets.into_iter().flat_map(|whole| {
            let is_force = whole.quantity.row().unit == "N";
            let usual = if is_force { force } else { force * scene.body().size() };
            Self::by_word(scene, &whole, usual)
        });
        sliders.collect()
    }

    /// One slider per component of the inputs of devices.
    fn of_devices(scene: &Scene) -> Vec<Self> {
        let of_device = |device: &Arc<dyn Device>| {
            let whole = |input| Target::of(Quantity::Device(input), device.name());
            let usual =
                |input: &DeviceInput| if input.unit == "m" { scene.body().size() } else { 1.0 };
            let inputs = device.inputs().iter();
            let sliders =
                inputs.flat_map(|input| Self::by_word(scene, &whole(input), usual(input)));
            sliders.collect::<Vec<_>>()
        };
        scene.devices().iter().flat_map(of_device).collect()
    }

    /// One slider per component of an input, by its word.
    fn by_word(scene: &Scene, whole: &Target, usual: f64) -> Vec<Self> {
        let (word, rank) =
            (whole.quantity.row().word, whole.quantity.rank(scene.body().dimension()));
        Self::of_input(scene, whole, usual, |axis| match rank {
            1 => word.into(),
            _ => format!("{word} {axis}"),
        })
    }

    /// One slider per component of an input, with a `name` by its axis: up to `usual` if the scene has no values. All have one range, as
    /// an input in another direction may be as strong.
    fn of_input(
        scene: &Scene,
        whole: &Target,
        usual: f64,
        name: impl Fn(&str) -> String,
    ) -> Vec<Self> {
        let rank = whole.quantity.rank(scene.body().dimension());
        let parts: Vec<Target> = (0..rank).map(|axis| whole.along(axis)).collect();
        let largest = parts.iter().map(|part| part.largest_in(scene)).fold(0.0, f64::max);
        let unit = whole.quantity.row().unit;
        let slider = |(part, axis)| Self::new(part, name(axis), [largest, usual], unit);
        parts.into_iter().zip(["x", "y", "z"]).map(slider).collect()
    }

    /// One slider per component of the loads on a selection. The loads are of the kind that the scene always
    /// uses there, or else act on each node. The last argument is a usual force and traction.
    fn of_load(scene: &Scene, nodes: &Selection, [force, traction]: [f64; 2]) -> Vec<Self> {
        // a scene has no loads on an empty selection
        let count = scene.body().mesh().select(nodes).map_or(1, |nodes| nodes.len());
        let loads = || scene.phases().iter().flat_map(Phase::loads).filter(|(on, ..)| *on == nodes);
        let always = |kind: &LoadKind| loads().all(|(_, own, _)| own == *kind);
        let kind = LoadKind::ALL.into_iter().find(always).unwrap_or(LoadKind::Each);
        let (name, of_what, usual) = match kind {
            LoadKind::Traction => ("traction", "", traction),
            _ if count == 1 => ("load", "", force),
            LoadKind::Each => ("load", ", each node", force),
            LoadKind::Total => ("load", ", in total", force),
        };
        let of = timeline::Target::Nodes(nodes.clone());
        let whole = Target { quantity: Quantity::Load(kind), of, axis: None };
        Self::of_input(scene, &whole, usual, |axis| format!("{name} {axis}{of_what}"))
    }

    /// A slider up to twice the largest value of the scene, or up to `usual` if the scene has none.
    fn new(target: Target, what: String, [largest, usual]: [f64; 2], unit: &'static str) -> Self {
        let most = round_up(if largest > 0.0 { 2.0 * largest } else { usual });
        Self { target, least: -most, most, what, unit }
    }

    /// The value in force, as it is shown.
    pub(super) fn value(&self, simulation: &Simulation) -> f64 {
        let t = simulation.time();
        simulation.view().with_states(|scene, phase, _, _| self.target.value_in(scene, phase, t))
    }

    pub(super) fn to_json(&self) -> Value {
        let name = match &self.target.of {
            timeline::Target::Named(names) => names.join(", "),
            timeline::Target::Everything => self.target.quantity.row().name.into(),
            timeline::Target::Nodes(nodes) => name_of(nodes),
        };
        json!({
            "name": name, "what": self.what, "unit": self.unit, "least": self.least, "most": self.most
        })
    }
}

impl Target {
    /// A quantity of a component.
    pub(super) fn of(quantity: Quantity, name: &str) -> Self {
        Self { quantity, of: timeline::Target::one(name), axis: None }
    }

    /// A component of it.
    pub(super) fn along(&self, axis: usize) -> Self {
        Self { axis: Some(axis), ..self.clone() }
    }

    /// Its value in `phase` of `scene` at time `t` (s).
    pub(super) fn value_in(&self, scene: &Scene, phase: &Phase, t: f64) -> f64 {
        scene.input_at(phase, self.quantity, &self.of, t)[self.axis.unwrap_or(0)]
    }

    /// Times (s) at which its signals in `phase` have breaks, ascending.
    pub(super) fn breaks_in(&self, scene: &Scene, phase: &Phase) -> Vec<f64> {
        scene.input_breaks(phase, self.quantity, &self.of)
    }

    /// The largest value that the scene itself has for it.
    fn largest_in(&self, scene: &Scene) -> f64 {
        let starts = [0.0].into_iter().chain(scene.phases().iter().map(Phase::end));
        let phases = scene.phases().iter().zip(starts).flat_map(|(phase, start)| {
            // formulas have no breaks
            let part = |look| f64::from(look) / f64::from(LOOKS);
            let looks = (1..LOOKS).map(move |look| start + part(look) * (phase.end() - start));
            let times = self.breaks_in(scene, phase).into_iter().chain(looks).chain([phase.end()]);
            times.map(move |t| self.value_in(scene, phase, t).abs())
        });
        phases.fold(0.0, f64::max)
    }
}

/// A usual force (N), and a usual pressure or traction (Pa): of several bodies those that the softest one stands.
fn usual(body: &Body) -> [f64; 2] {
    let of_part = |Part { body, .. }: Part| {
        let young = body.material().young;
        // what a spring of the stiffness of the body needs for half of that strain is a usual force
        [USUAL * young * body.volume() / body.size(), USUAL * young]
    };
    let least = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.min(d)];
    body.parts().map(of_part).fold([f64::INFINITY; 2], least)
}

/// Times (s) in ascending order, without duplicates.
pub(super) fn ascending<'a>(times: impl Iterator<Item = &'a f64>) -> Vec<f64> {
    let mut times: Vec<f64> = times.copied().collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// A readable name of the nodes.
fn name_of(nodes: &Selection) -> String {
    match nodes {
        Selection::Set(name) => name.clone(),
        Selection::Numbers(numbers) => {
            let word = if numbers.len() == 1 { "node" } else { "nodes" };
            let few: Vec<String> = numbers.iter().take(FEW).map(usize::to_string).collect();
            let more = if numbers.len() > FEW { ", ..." } else { "" };
            format!("{word} {}{more}", few.join(", "))
        }
        Selection::Box { .. } => nodes.to_string(),
    }
}

/// The next larger number with one digit.
fn round_up(x: f64) -> f64 {
    if !x.is_normal() {
        return 1.0;
    }
    let unit = 10_f64.powf(x.abs().log10().floor());
    // 2.0000001 of them count as 2
    (x.abs() / unit - 1e-6).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::material::Material;
    use crate::elements::mesh::{Cells, Mesh};

    /// Usual values follow the softest of several bodies, in any order.
    #[test]
    fn usual_values_are_those_of_the_softest_body() {
        let body = |young: f64, name: &str| {
            let mesh = Mesh::rectangle([0.3, 0.4], [2, 2], Cells::Triangles).unwrap();
            let material = Material { density: 1000.0, young, poisson: 0.3, viscosity: 0.0 };
            Body::new(mesh, material).thickness(0.1).named(name).build().unwrap()
        };
        let (soft, stiff) = (body(1e5, "soft"), body(1e9, "stiff"));
        let [force, pressure] = usual(&soft);
        // 5 % of the modulus; on 0.012 m^3 that are 0.5 m across
        assert!((pressure - 5e3).abs() < 1e-9 && (force - 120.0).abs() < 1e-9);
        for bodies in [[&soft, &stiff], [&stiff, &soft]] {
            let both = Body::join(bodies.map(Clone::clone)).unwrap();
            assert_eq!(usual(&both), [force, pressure]);
        }
    }
}
