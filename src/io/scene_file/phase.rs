//! `[[phase]]`.

use toml::de::DeValue;

use super::course::{course, plural, vectors_until};
use super::device::{DRIVE, drive};
use super::joint::{MOTOR, motor};
use super::keys::TableKeys;
use super::magnet::magnetic_field;
use super::phase_keys::{
    ACTUATE, END, FLOW, FOLLOWER, HOLD, HOLD_COMBINATION, LOAD, MOMENT, MOVE, OPEN, PATH, PHASE,
    PRESSURE, PRESSURE_ON, ROTATE, STEER, SYMMETRY, TERMS,
};
use super::selection::selection;
use super::table::Table;
use super::value::{Value, named, number_of};
use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::dynamics::error::Error;
use crate::elements::mesh::Selection;
use crate::scene::constraint::Axis;
use crate::scene::forces::{ACTUATORS, Drive, Signals, WrenchKind};
use crate::scene::timeline::{Input, Phase, Quantity, Row, Scene, Target};

/// Adds a table inside of a phase.
type Add = fn(Phase, &Table, &Scene) -> Result<Phase, Error>;

/// The additions of the tables inside a phase.
const PARTS: [(&TableKeys, Add); 17] = [
    (&HOLD, hold),
    (&MOVE, moving),
    (&PATH, path),
    (&ROTATE, rotate),
    (&SYMMETRY, symmetry),
    (&HOLD_COMBINATION, hold_combination),
    (&LOAD, on_nodes),
    (&MOMENT, on_nodes),
    (&FOLLOWER, on_nodes),
    (&PRESSURE, pressure),
    (&PRESSURE_ON, pressure_on),
    (&OPEN, open),
    (&FLOW, flow),
    (&ACTUATE, actuate),
    (&DRIVE, drive),
    (&MOTOR, motor),
    (&STEER, steer),
];

/// The scene with the phases that `values` describe at its end.
pub(super) fn add_phases(scene: Scene, values: &[Value]) -> Result<Scene, Error> {
    // a check after each table takes time in proportion to the scene: done only to find the table with a
    // mistake
    let add = |scene: Scene, check: &Check| {
        values.iter().try_fold(scene, |scene, value| add_phase(scene, value, check))
    };
    match add(scene.clone(), &|_, _| Ok(())) {
        Ok(complete) if complete.validate().is_ok() => Ok(complete),
        _ => add(scene, &|scene, phase| scene.clone().phase(phase.clone()).validate()),
    }
}

/// Whether a phase may follow those of the scene.
type Check = dyn Fn(&Scene, &Phase) -> Result<(), InputError>;

/// The scene with the phase that `value` describes at its end, of which each part has passed the `check`.
fn add_phase(scene: Scene, value: &Value, check: &Check) -> Result<Scene, Error> {
    let table = value.table(&PHASE)?;
    let until = table.required("until", |value| {
        let until = value.number()?;
        check(&scene, &Phase::until(until)).map_err(|error| value.error(error))?;
        Ok(until)
    })?;
    let mut phase = Phase::until(until);
    phase = table.added(phase, "name", Value::string, Phase::named)?;
    if let Some(value) = table.get("end") {
        let end = value.table(&END)?;
        let sensor = end.required("sensor", Value::string)?;
        phase = match end.optional("above", Value::finite)? {
            Some(level) => phase.ends_above(sensor, level),
            None => phase.ends_below(sensor, end.required("below", Value::finite)?),
        };
    }
    if let Some(value) = table.get("contact") {
        phase = contact(phase, &value, &scene)?;
    }
    if let Some(touch) = table.optional("touch", Value::flag)? {
        phase = phase.touching(touch);
    }
    let gravity = table.optional("gravity", |value| value.vector(scene.body().dimension()))?;
    if let Some(gravity) = gravity {
        phase = phase.gravity(gravity);
        check(&scene, &phase).map_err(|error| table.blame(error))?;
    }
    for (keys, add) in PARTS {
        for part in table.tables(keys.name, keys)? {
            phase = add(phase, &part, &scene)?;
            check(&scene, &phase).map_err(|error| part.blame(error))?;
        }
    }
    if let Some(value) = table.get("magnetic_field") {
        phase = phase.magnetic_field(magnetic_field(&value, until, &scene)?);
        check(&scene, &phase).map_err(|error| value.error(error))?;
    }
    if table.flag("project_velocity")? {
        phase = phase.project_velocity();
    }
    Ok(scene.phase(phase))
}

fn hold(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let mut nodes = nodes(table, scene)?;
    if table.flag("rotation")? {
        let with_sections = scene.body().with_sections(&nodes);
        nodes = with_sections.map_err(|error| table.blame(error))?;
    }
    Ok(match axes(table, scene)? {
        None => phase.hold(nodes),
        Some(axes) => phase.hold_axes(nodes, axes),
    })
}

fn moving(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let (nodes, axes) = (nodes(table, scene)?, axes(table, scene)?);
    table.required("velocity", |value| {
        let Some(axes) = axes else {
            return Ok(phase.move_nodes(nodes, along(value, all_axes(scene), scene)?));
        };
        let along = along(value, &axes, scene)?;
        Ok(axes
            .into_iter()
            .zip(along)
            .fold(phase, |phase, (axis, velocity)| phase.move_axis(nodes.clone(), axis, velocity)))
    })
}

fn path(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let nodes = nodes(table, scene)?;
    let axes = axes(table, scene)?.unwrap_or_else(|| all_axes(scene).into());
    let formulas = table.optional("displacement", |value| value.formulas(axes.len(), "axis"))?;
    if let Some(formulas) = formulas {
        let axes = axes.into_iter().zip(formulas);
        return Ok(axes.fold(phase, |phase, (axis, formula)| {
            phase.follow_formula(nodes.clone(), axis, formula)
        }));
    }
    let times = table.required("times", Value::numbers)?;
    let points = table.required("displacements", |value| {
        value.list_of("points, one per time", |point| along(point, &axes, scene))
    })?;
    let axes = axes.into_iter().enumerate();
    Ok(axes.fold(phase, |phase, (k, axis)| {
        let displacements: Vec<f64> = points.iter().map(|point| point[k]).collect();
        phase.path(nodes.clone(), axis, times.clone(), displacements)
    }))
}

fn rotate(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let (nodes, dimension) = (nodes(table, scene)?, scene.body().dimension());
    let centre = table.required("centre", |value| value.vector(dimension))?;
    let direction = |value: &Value| {
        let axis = value.vector(3)?;
        match norm(&axis) {
            0.0 => Err(value.unexpected("a direction, not all of it 0")),
            length => Ok(axis.into_iter().map(|x| x / length).collect()),
        }
    };
    let axis = match (dimension, table.get("axis")) {
        (3, _) => table.required("axis", direction)?,
        (_, None) => vec![1.0],
        (_, Some(axis)) => {
            return Err(axis.unexpected("no axis in the plane, where nodes turn counter-clockwise"));
        }
    };
    if let Some(rate) = table.optional("rate", Value::finite)? {
        let velocity: Vec<f64> = axis.iter().map(|x| rate * x).collect();
        return Ok(phase.rotate(nodes, centre, velocity));
    }
    let times = table.required("times", Value::numbers)?;
    let angles = table.required("angles", Value::numbers)?;
    Ok(phase.rotate_path(nodes, centre, axis, times, angles))
}

fn symmetry(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let normal = table.required("normal", |value| value.vector(scene.body().dimension()))?;
    Ok(phase.symmetry(nodes(table, scene)?, normal))
}

fn hold_combination(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let terms = table.required("terms", |value| value.tables(&TERMS))?;
    let term = |term: &Table| {
        let node = term.required("node", |value| {
            let node = value.count()?;
            let known = scene.body().mesh().select(&[node].into());
            known.map(|_| node).map_err(|error| value.error(error))
        })?;
        let axis = term.required("axis", |value| value.word(known_axes(scene)))?;
        let coefficient = term.required("coefficient", |value| match value.finite()? {
            0.0 => Err(value.unexpected("a number other than 0")),
            coefficient => Ok(coefficient),
        })?;
        Ok((node, axis, coefficient))
    };
    Ok(phase.hold_combination(terms.iter().map(term).collect::<Result<Vec<_>, Error>>()?))
}

/// Vectors on nodes, of the quantities of the table; a load may have a moment, too.
fn on_nodes(mut phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let (nodes, dimension) = (nodes(table, scene)?, scene.body().dimension());
    for quantity in Quantity::ON_NODES {
        let (Row { keys: [list, _], word, .. }, rank) = (quantity.row(), quantity.rank(dimension));
        let is_beside =
            table.name() == LOAD.name && quantity == Quantity::Wrench(WrenchKind::Moment);
        if list != table.name() && !is_beside {
            continue;
        }
        if let Some(value) = vectors_until(table, phase.end(), word, rank)? {
            phase = phase.with(Input::new(quantity, Target::Nodes(nodes.clone()), value));
        }
    }
    Ok(phase)
}

fn steer(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.devices().iter().map(|device| device.name()).collect();
    let device = table.required("device", |value| named(value, &known))?;
    let word = table.required("input", Value::string)?;
    let input = scene.device_row(&device, word).map_err(|error| table.blame(error))?;
    if !input.is_vector {
        let value = course(table, phase.end(), "value")?;
        return Ok(phase.device_input(device, input, value));
    }
    let value = vectors_until(table, phase.end(), "value", scene.body().dimension())?;
    // one of them is there: the table's groups say so
    let value = value.ok_or_else(|| table.missing("value", "expected a vector"))?;
    Ok(phase.device_input(device, input, Signals(value)))
}

fn pressure(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.chambers().iter().map(|chamber| chamber.name()).collect();
    let chamber = table.required("chamber", |v| named(v, &known))?;
    let signal = course(table, phase.end(), "value")?;
    Ok(phase.pressure(chamber, signal))
}

fn pressure_on(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let (nodes, end) = (nodes(table, scene)?, phase.end());
    Ok(phase.pressure_on(nodes, course(table, end, "value")?))
}

fn open(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.orifices().iter().map(|orifice| orifice.name()).collect();
    let orifice = table.required("orifice", |v| named(v, &known))?;
    let signal = course(table, phase.end(), "opening")?;
    Ok(phase.open(orifice, signal))
}

fn flow(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.liquids().iter().map(|liquid| liquid.chamber()).collect();
    let chamber = table.required("chamber", |v| named(v, &known))?;
    let signal = course(table, phase.end(), "rate")?;
    Ok(phase.flow(chamber, signal))
}

fn actuate(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let end = phase.end();
    let heated: Vec<&str> =
        scene.lags().filter(|(_, lag)| lag.per_kelvin().is_some()).map(|(name, _)| name).collect();
    if let Some(actuators) = table.optional("heated", |value| names(value, &heated))? {
        return Ok(phase.actuate(actuators, course(table, end, "power")?));
    }
    let mut lists = ACTUATORS.iter().map(|kind| kind.list);
    let list = lists.find(|list| table.get(list).is_some());
    let list = list.unwrap_or(Quantity::Actuation.row().keys[1]);
    let known: Vec<&str> = scene.actuators_in(list).map(|own| own.name()).collect();
    let names = table.required(list, |value| names(value, &known))?;
    if let Some(name) = names.iter().find(|name| heated.contains(&&***name)) {
        let help = "it is heated: give a power, { heated = ..., power = ... }";
        return Err(table.blame(InputError::new("actuation", format!("of \"{name}\""), help)));
    }
    let mut word = Drive::Force.word();
    for actuator in names.iter().filter_map(|name| scene.actuator_named(name)) {
        word = actuator.kind().drive.word();
        if table.get(word).or(table.get(&plural(word))).is_none() {
            let (kind, name) = (actuator.kind().name, actuator.name());
            let help = format!("it is driven by a {word}: give {word} or {}", plural(word));
            let input = format!("actuation of {kind}");
            return Err(table.blame(InputError::new(input, format!("\"{name}\""), help)));
        }
    }
    Ok(phase.actuate(names, course(table, end, word)?))
}

fn contact(phase: Phase, value: &Value, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.obstacles().iter().map(|obstacle| obstacle.name()).collect();
    match value.value {
        DeValue::Boolean(true) => Ok(phase),
        DeValue::Boolean(false) => Ok(phase.without_contact()),
        DeValue::String(_) | DeValue::Array(_) => Ok(phase.contact_with(names(value, &known)?)),
        _ => Err(value.unexpected("true, false, or a list of names")),
    }
}

fn nodes(table: &Table, scene: &Scene) -> Result<Selection, Error> {
    table.required("nodes", |value| selection(value, scene.body().mesh()))
}

/// The named axes; `None` stands for all.
fn axes(table: &Table, scene: &Scene) -> Result<Option<Vec<Axis>>, Error> {
    table.optional("axes", |value| {
        value.one_or_more()?.iter().map(|axis| axis.word(known_axes(scene))).collect()
    })
}

fn known_axes(scene: &Scene) -> &'static [(&'static str, Axis)] {
    &[("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)][..scene.body().dimension()]
}

fn all_axes(scene: &Scene) -> &'static [Axis] {
    Axis::all(scene.body().dimension())
}

/// The components along `axes`: one number per named axis (for one axis, a number alone), or one
/// per dimension, 0 along the axes that are not named.
fn along(value: &Value, axes: &[Axis], scene: &Scene) -> Result<Vec<f64>, Error> {
    let dimension = scene.body().dimension();
    let numbers = value.one_or_more()?;
    let numbers = numbers.iter().map(Value::finite).collect::<Result<Vec<_>, Error>>()?;
    if numbers.len() == axes.len() {
        return Ok(numbers);
    }
    let is_free = |i: usize| axes.iter().all(|axis| axis.index() != i);
    if numbers.len() == dimension && (0..dimension).all(|i| numbers[i] == 0.0 || !is_free(i)) {
        return Ok(axes.iter().map(|axis| numbers[axis.index()]).collect());
    }
    let per = if axes.len() == dimension { "dimension" } else { "named axis" };
    Err(value.unexpected(format!("{}, one per {per}", number_of(axes.len(), "number"))))
}

pub(super) fn names(value: &Value, known: &[&str]) -> Result<Vec<String>, Error> {
    value.one_or_more()?.iter().map(|value| named(value, known)).collect()
}
