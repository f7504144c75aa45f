//! `[[phase]]`.

use toml::de::DeValue;

use super::selection::selection;
use super::table::Table;
use super::value::{Value, number_of};
use crate::constraint::Axis;
use crate::error::Error;
use crate::input::InputError;
use crate::mesh::Selection;
use crate::scene::{Phase, Scene};

const KEYS: &[&str] = &[
    "name",
    "until",
    "hold",
    "move",
    "path",
    "load",
    "pressure",
    "actuate",
    "contact",
    "project_velocity",
];

/// Adds a table inside of a phase.
type Add = fn(Phase, &Table, &Scene) -> Result<Phase, Error>;

/// The tables inside of a phase: key, meaning, their own keys, what they add.
const PARTS: [(&str, &str, &[&str], Add); 6] = [
    ("hold", "nodes that stay where they are", &["nodes", "axes"], hold),
    ("move", "nodes that move on", &["nodes", "axes", "velocity"], moving),
    ("path", "nodes that follow a path", &["nodes", "axes", "times", "displacements"], path),
    ("load", "forces on nodes", &["nodes", "force", "total", "times", "forces"], load),
    ("pressure", "pressures in chambers", &["chamber", "value", "times", "values"], pressure),
    ("actuate", "forces in springs", &["springs", "force", "times", "forces"], actuate),
];

/// The scene with the phase that `value` describes at its end.
pub(super) fn add_phase(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = value.table(KEYS)?;
    let until = table.required("until", "the end of the phase (s)", |value| {
        let until = value.number()?;
        check(&scene, &Phase::until(until)).map_err(|error| value.error(error))?;
        Ok(until)
    })?;
    let mut phase = Phase::until(until);
    if let Some(name) = table.optional("name", "the name of the phase", Value::string)? {
        phase = phase.named(name);
    }
    if let Some(value) = table.get("contact", "the obstacles that act") {
        phase = contact(phase, &value, &scene)?;
    }
    for (key, meaning, keys, add) in PARTS {
        let Some(value) = table.get(key, meaning) else { continue };
        for part in value.tables(keys)? {
            phase = add(phase, &part, &scene)?;
            check(&scene, &phase).map_err(|error| part.blame(error))?;
        }
    }
    let meaning = "whether the phase begins with velocities that its constraints allow";
    if table.optional("project_velocity", meaning, Value::flag)? == Some(true) {
        phase = phase.project_velocity();
    }
    Ok(scene.phase(phase))
}

/// Whether `phase` may follow those of the scene.
fn check(scene: &Scene, phase: &Phase) -> Result<(), InputError> {
    scene.clone().phase(phase.clone()).validate()
}

fn hold(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let nodes = nodes(table, scene)?;
    Ok(match axes(table, scene)? {
        None => phase.hold(nodes),
        Some(axes) => phase.hold_axes(nodes, axes),
    })
}

fn moving(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let (nodes, axes) = (nodes(table, scene)?, axes(table, scene)?);
    table.required("velocity", "the velocity (m/s)", |value| {
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
    let times = table.required("times", "times, ascending (s)", Value::numbers)?;
    let points = table.required("displacements", "displacements at these times (m)", |value| {
        value.list_of("points, one per time", |point| along(point, &axes, scene))
    })?;
    let axes = axes.into_iter().enumerate();
    Ok(axes.fold(phase, |phase, (k, axis)| {
        let displacements: Vec<f64> = points.iter().map(|point| point[k]).collect();
        phase.path(nodes.clone(), axis, times.clone(), displacements)
    }))
}

fn load(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let vector = |value: &Value| value.vector(scene.body().dimension());
    let nodes = nodes(table, scene)?;
    let force = table.optional("force", "the force on each node (N)", vector)?;
    let total = table.optional("total", "the force on all nodes together (N)", vector)?;
    let times = table.optional("times", "times, ascending (s)", Value::numbers)?;
    let forces =
        table.optional("forces", "the force on each node at these times (N)", |value| {
            value.list_of("forces, one per time", vector)
        })?;
    match (force, total, times, forces) {
        (Some(force), None, None, None) => Ok(phase.load(nodes, force)),
        (None, Some(total), None, None) => Ok(phase.load_total(nodes, total)),
        (None, None, Some(times), Some(forces)) => Ok(phase.load_table(nodes, times, forces)),
        _ => Err(table.error(
            "expected either force (N, on each node), or total (N, on all nodes together), or times \
             (s) and forces (N, on each node)",
        )),
    }
}

fn pressure(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.chambers().iter().map(|chamber| chamber.name()).collect();
    let chamber = table.required("chamber", "the name of a chamber", |v| named(v, &known))?;
    let value = ("value", "the pressure (Pa)");
    Ok(match course(table, value, ("values", "pressures at these times (Pa)"))? {
        Course::Constant(pressure) => phase.pressure(chamber, pressure),
        Course::Table(times, values) => phase.pressure_table(chamber, times, values),
    })
}

fn actuate(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.springs().iter().map(|spring| spring.name()).collect();
    let springs = table.required("springs", "names of springs", |value| names(value, &known))?;
    let force = ("force", "the force, positive if it extends (N)");
    Ok(match course(table, force, ("forces", "forces at these times (N)"))? {
        Course::Constant(force) => phase.actuate(springs, force),
        Course::Table(times, forces) => phase.actuate_table(springs, times, forces),
    })
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

/// A number that may change with time.
enum Course {
    Constant(f64),
    Table(Vec<f64>, Vec<f64>),
}

/// Either `one` number, or `times` and `many` numbers (keys and their meanings).
fn course(
    table: &Table,
    one: (&str, &'static str),
    many: (&str, &'static str),
) -> Result<Course, Error> {
    let constant = table.optional(one.0, one.1, Value::finite)?;
    let times = table.optional("times", "times, ascending (s)", Value::numbers)?;
    let values = table.optional(many.0, many.1, Value::numbers)?;
    match (constant, times, values) {
        (Some(constant), None, None) => Ok(Course::Constant(constant)),
        (None, Some(times), Some(values)) => Ok(Course::Table(times, values)),
        _ => Err(table.error(format!(
            "expected either {}, {}, or times (s) and {}, {}",
            one.0, one.1, many.0, many.1
        ))),
    }
}

fn nodes(table: &Table, scene: &Scene) -> Result<Selection, Error> {
    table.required("nodes", "nodes", |value| selection(value, scene.body().mesh()))
}

/// The named axes; `None` stands for all.
fn axes(table: &Table, scene: &Scene) -> Result<Option<Vec<Axis>>, Error> {
    let known = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];
    let known = &known[..scene.body().dimension()];
    table.optional("axes", "the axes that are prescribed", |value| {
        value.one_or_more()?.iter().map(|axis| axis.word(known)).collect()
    })
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

fn named(value: &Value, known: &[&str]) -> Result<String, Error> {
    let name = value.string()?;
    match known.contains(&name) {
        true => Ok(name.into()),
        false => Err(value.unknown(name, known)),
    }
}

fn names(value: &Value, known: &[&str]) -> Result<Vec<String>, Error> {
    value.one_or_more()?.iter().map(|value| named(value, known)).collect()
}
