//! The whole file.

use std::sync::Arc;

use super::body::{self, BODY, POINT};
use super::contents::{OutputRequest, SceneFile};
use super::device::{self, DIPOLE, WIND};
use super::fluid::{self, FLUID};
use super::gas::{self, GAS, ORIFICE, SUPPLY};
use super::growth::{self, GROWTH};
use super::initial::{self, INITIAL};
use super::joint::{self, JOINT};
use super::keys::{Key, TableKeys, ValueType};
use super::lag::{self, LAG};
use super::liquid::{self, LIQUID, PIPE};
use super::magnet::{self, MAGNET};
use super::muscle::{self, MUSCLE};
use super::obstacle::{self, OBSTACLE};
use super::phase;
use super::phase_keys::PHASE;
use super::rod::{self, ROD};
use super::sensor::{SENSOR, sensor};
use super::settings::{self, OUTPUT, SOLVER, STATICS};
use super::smaller;
use super::surroundings::{self, CABLE, CHAMBER, SPRING};
use super::table::Table;
use super::tie::{self, TIE};
use super::touch::{self, TOUCH};
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::body::Body;
use crate::scene::timeline::{Device, Scene};

/// Keys before and after those of components.
const BEFORE: [Key; 9] = [
    Key::new("title", ValueType::Text, "the title, for pictures and pages"),
    Key::new("dimension", ValueType::Count, "the dimension of space")
        .note("1, 2 or 3. In a higher one than the mesh has, bars are strings and surfaces membranes.")
        .default("that of the mesh"),
    Key::new("gravity", ValueType::Vector, "the acceleration of gravity")
        .in_unit("m/s^2")
        .default("0"),
    Key::number("atmosphere", "the absolute pressure of the air around chambers with gas", "Pa")
        .default("101325"),
    Key::new("unusual", ValueType::List(&ValueType::Text), "quantities whose warnings of units are suppressed")
        .note("Of `size`, `mass`, `density`, `young`, `wave-speed`, `thickness`, `weight`, `remanence`, `magnetic-field`, `dipole-moment`, `absolute-pressure`, `orifice-area`, `touch-start`, `facets`: they are not [warned of](scenes/warnings.md#warnings).")
        .default("none"),
    Key::new("body", ValueType::Tables(&BODY), "the mesh and material of a body").default("required without rods"),
    Key::new("rod", ValueType::Tables(&ROD), "rods: slender bodies"),
    Key::new("point", ValueType::Tables(&POINT), "point masses"),
    Key::new("initial", ValueType::Table(&INITIAL), "the initial motion").default("at rest"),
];
const AFTER: [Key; 5] = [
    Key::new("phase", ValueType::Tables(&PHASE), "the phases, one after the other").required(),
    Key::new("sensor", ValueType::Tables(&SENSOR), "sensors, each read with each sample"),
    Key::new("solver", ValueType::Table(&SOLVER), "how it is integrated"),
    Key::new("statics", ValueType::Table(&STATICS), "how its equilibrium is sought"),
    Key::new("output", ValueType::Table(&OUTPUT), "the output"),
];

/// Adds a table to a scene.
type Add = fn(Scene, &Value) -> Result<Scene, Error>;

/// The tables of components, in the order in which they are read.
const COMPONENTS: [(Key, Add); 19] = [
    (Key::new("tie", ValueType::Tables(&TIE), "ties between bodies"), tie::add_tie),
    (
        Key::new(
            "touch",
            ValueType::Tables(&TOUCH),
            "contact of bodies with each other and themselves",
        ),
        touch::add_touch,
    ),
    (Key::new("spring", ValueType::Tables(&SPRING), "springs"), surroundings::add_spring),
    (Key::new("cable", ValueType::Tables(&CABLE), "cables"), surroundings::add_cable),
    (Key::new("muscle", ValueType::Tables(&MUSCLE), "muscles in the bodies"), muscle::add_muscle),
    (
        Key::new("growth", ValueType::Tables(&GROWTH), "cells that grow, by swelling or heat"),
        growth::add_growth,
    ),
    (
        Key::new(
            "lag",
            ValueType::Tables(&LAG),
            "actuators that follow their commands with a delay",
        ),
        lag::add_lag,
    ),
    (Key::new("magnet", ValueType::Tables(&MAGNET), "magnets in the bodies"), magnet::add_magnet),
    (
        Key::new("dipole", ValueType::Tables(&DIPOLE), "magnets outside of the bodies"),
        device::add_dipole,
    ),
    (Key::new("chamber", ValueType::Tables(&CHAMBER), "chambers"), surroundings::add_chamber),
    (Key::new("gas", ValueType::Tables(&GAS), "gas in chambers"), gas::add_gas),
    (Key::new("supply", ValueType::Tables(&SUPPLY), "supplies of gas"), gas::add_supply),
    (
        Key::new(
            "orifice",
            ValueType::Tables(&ORIFICE),
            "orifices and valves through which gas flows",
        ),
        gas::add_orifice,
    ),
    (Key::new("liquid", ValueType::Tables(&LIQUID), "liquids in chambers"), liquid::add_liquid),
    (
        Key::new("pipe", ValueType::Tables(&PIPE), "pipes between liquids in chambers"),
        liquid::add_pipe,
    ),
    (Key::new("fluid", ValueType::Tables(&FLUID), "fluids around bodies"), fluid::add_fluid),
    (Key::new("wind", ValueType::Tables(&WIND), "wind over faces"), device::add_wind),
    (
        Key::new("joint", ValueType::Tables(&JOINT), "joints between bodies, with motors"),
        joint::add_joint,
    ),
    (Key::new("obstacle", ValueType::Tables(&OBSTACLE), "obstacles"), obstacle::add_obstacle),
];

const KEYS: [Key; BEFORE.len() + COMPONENTS.len() + AFTER.len()] = {
    let mut keys = [BEFORE[0]; BEFORE.len() + COMPONENTS.len() + AFTER.len()];
    let mut k = 0;
    while k < keys.len() {
        keys[k] = if k < BEFORE.len() {
            BEFORE[k]
        } else if k < BEFORE.len() + COMPONENTS.len() {
            COMPONENTS[k - BEFORE.len()].0
        } else {
            AFTER[k - BEFORE.len() - COMPONENTS.len()]
        };
        k += 1;
    }
    keys
};

pub(super) const TOP: TableKeys = TableKeys::new(
    "The file",
    "The keys before the first table.",
    &KEYS,
    "title = \"A beam sinks\"\ndimension = 2\ngravity = [0.0, -9.8]",
);

/// Contents of the file with the top-level table `top`.
pub(super) fn scene_file(top: &Table, devices: Vec<Arc<dyn Device>>) -> Result<SceneFile, Error> {
    let title = top.optional("title", Value::string)?.unwrap_or_default();
    let (dimension, points) = (top.get("dimension"), top.get("point"));
    let rods = top.optional("rod", |value| rod::rods(value, dimension.as_ref()))?;
    let rods = rods.unwrap_or_default();
    let bodies = match top.get("body") {
        None if !rods.is_empty() => Vec::new(),
        _ => top.required("body", |value| {
            body::bodies(value, dimension.as_ref(), points.as_ref(), !rods.is_empty())
        })?,
    };
    let of = top.get(if bodies.is_empty() { "rod" } else { "body" });
    let body = Body::join(bodies.into_iter().chain(rods));
    let mut scene = Scene::new(body.map_err(|error| match &of {
        Some(of) => of.error(error),
        None => top.blame(error),
    })?);
    if let Some(gravity) = top.get("gravity") {
        let gravity = gravity.vector(scene.body().dimension())?;
        scene = scene.gravity(gravity);
    }
    if let Some(pressure) = top.get("atmosphere") {
        scene = gas::add_atmosphere(scene, &pressure)?;
    }
    if let Some(names) = top.get("unusual") {
        let names = names.list()?;
        let names = names.iter().map(|name| name.string().map(str::to_owned));
        scene = scene.unusual(names.collect::<Result<Vec<String>, Error>>()?);
    }
    // an initial state belongs to the mesh as it is given, or to the finer one on which the scene ends up
    let initial = top.get("initial");
    let started = initial.as_ref().map(|initial| initial::add_initial(scene.clone(), initial));
    let starts_finer = match started {
        Some(Ok(started)) => {
            scene = started;
            None
        }
        Some(Err(_)) => initial,
        None => None,
    };
    let mut scene = devices.into_iter().fold(scene, Scene::shared_device);
    for (key, add) in COMPONENTS {
        if let Some(values) = top.get(key.name) {
            scene = values.one_or_more()?.iter().try_fold(scene, add)?;
        }
    }
    if let Some(values) = top.get("phase") {
        scene = phase::add_phases(scene, &values.one_or_more()?)?;
    }
    if scene.phases().is_empty() {
        return Err(top.missing("phase", "a scene needs one phase at least: [[phase]]"));
    }
    if let Some(body) = top.get("body") {
        scene = body::on_finer_mesh(scene, &body)?;
    }
    if let Some(initial) = starts_finer {
        scene = initial::add_initial(scene, &initial)?;
    }
    if let Some(body) = top.get("body") {
        scene = body::moving(scene, &body)?;
    }
    let auto = top.optional("body", body::auto)?.unwrap_or_default();
    let settings = top.optional("solver", settings::solver)?.unwrap_or_default();
    let accuracy = top.optional("solver", settings::accuracy)?.unwrap_or_default();
    let statics = top.optional("statics", |value| settings::statics(value, &scene))?;
    let statics = statics.unwrap_or_default();
    let output = top.optional("output", |value| settings::output(value, &scene))?;
    let mut output = output.unwrap_or_else(OutputRequest::default);
    if let Some(values) = top.get("sensor") {
        let sensors = values.one_or_more()?.into_iter().map(|value| sensor(&value, &scene));
        output.sensors = sensors.collect::<Result<_, _>>()?;
        output.sampling().check(&scene).map_err(|error| values.error(error))?;
    }
    if let Some(phases) = top.get("phase") {
        output.sampling().check_ends(&scene).map_err(|error| phases.error(error))?;
    }
    let mut smaller = Vec::new();
    if let Some(solver) = top.get("solver") {
        (scene, output, smaller) = smaller::smaller(scene, output, &solver.table(&SOLVER)?)?;
        scene = settings::reduced(scene, &solver)?;
    }
    Ok(SceneFile {
        title: title.into(),
        scene,
        smaller,
        settings,
        accuracy,
        auto,
        statics,
        output,
        notes: Vec::new(),
    })
}
