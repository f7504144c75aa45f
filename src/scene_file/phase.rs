//! `[[phase]]`.

use toml::de::DeValue;

use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::constraint::Axis;
use crate::error::Error;
use crate::mesh::Mesh;
use crate::scene::{Phase, Scene};

pub(super) const KEYS: &[&str] =
    &["name", "until", "hold", "move", "load", "pressure", "actuate", "contact"];

/// The scene with the phase that `table` describes at its end.
pub(super) fn add_phase(scene: Scene, table: &Table) -> Result<Scene, Error> {
    let until = table.required("until", "the end of the phase (s)", |value| {
        let until = value.number()?;
        check(&scene, &Phase::until(until)).map_err(|error| value.error(error))?;
        Ok(until)
    })?;
    let mut phase = Phase::until(until);
    if let Some(name) = table.optional("name", "the name of the phase", Value::string)? {
        phase = phase.named(name);
    }
    phase = contact(phase, &scene, table)?;
    let parts: [(&str, &'static str, &[&str], Part); 5] = [
        ("hold", "nodes that stay", &["nodes", "axes"], hold),
        ("move", "nodes that move", &["nodes", "axes", "velocity"], moving),
        ("load", "forces on nodes", &["nodes", "force", "total"], load),
        ("pressure", "pressures in chambers", &["chamber", "value"], pressure),
        ("actuate", "forces in springs", &["springs", "force"], actuate),
    ];
    for (key, meaning, keys, add) in parts {
        let Some(value) = table.get(key, meaning) else { continue };
        for part in value.tables(keys)? {
            phase = add(phase, &part, &scene)?;
            check(&scene, &phase).map_err(|error| part.blame(error))?;
        }
    }
    Ok(scene.phase(phase))
}

/// Adds what a table inside of a phase says.
type Part = fn(Phase, &Table, &Scene) -> Result<Phase, Error>;

/// Whether `phase` may follow those of the scene.
fn check(scene: &Scene, phase: &Phase) -> Result<(), Error> {
    scene.clone().phase(phase.clone()).validate()
}

fn hold(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let nodes = nodes(table, scene.body().mesh())?;
    Ok(match axes(table)? {
        None => phase.hold(nodes),
        Some(axes) => phase.hold_axes(nodes, axes),
    })
}

fn moving(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let dimension = scene.body().dimension();
    let nodes = nodes(table, scene.body().mesh())?;
    let axes = axes(table)?;
    let velocity = table.required("velocity", "the velocity (m/s)", |value| match &axes {
        None => value.vector(dimension),
        Some(axes) => per_axis(value, axes.len()),
    })?;
    Ok(match axes {
        None => phase.move_nodes(nodes, velocity),
        Some(axes) => axes
            .into_iter()
            .zip(velocity)
            .fold(phase, |phase, (axis, velocity)| phase.move_axis(nodes.clone(), axis, velocity)),
    })
}

fn load(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let vector = |value: &Value| value.vector(scene.body().dimension());
    let nodes = nodes(table, scene.body().mesh())?;
    let force = table.optional("force", "the force on each node (N)", vector)?;
    let total = table.optional("total", "the force on all nodes together (N)", vector)?;
    match (force, total) {
        (Some(force), None) => Ok(phase.load(nodes, force)),
        (None, Some(total)) => Ok(phase.load_total(nodes, total)),
        _ => Err(table
            .error("expected either force (N, on each node) or total (N, on all nodes together)")),
    }
}

fn pressure(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.chambers().iter().map(|chamber| chamber.name()).collect();
    let chamber = table.required("chamber", "the name of a chamber", |v| named(v, &known))?;
    let pressure = table.required("value", "the pressure (Pa)", Value::number)?;
    Ok(phase.pressure(chamber, pressure))
}

fn actuate(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.springs().iter().map(|spring| spring.name()).collect();
    let springs = table.required("springs", "names of springs", |value| names(value, &known))?;
    let force = table.required("force", "the actuation force (N)", Value::number)?;
    Ok(phase.actuate(springs, force))
}

fn contact(phase: Phase, scene: &Scene, table: &Table) -> Result<Phase, Error> {
    let meaning = "with which obstacles: all (true), none (false), or a list of names";
    let Some(value) = table.get("contact", meaning) else { return Ok(phase) };
    let known: Vec<&str> = scene.obstacles().iter().map(|obstacle| obstacle.name()).collect();
    match value.value {
        DeValue::Boolean(true) => Ok(phase),
        DeValue::Boolean(false) => Ok(phase.without_contact()),
        _ => Ok(phase.contact_with(names(&value, &known)?)),
    }
}

fn nodes(table: &Table, mesh: &Mesh) -> Result<crate::mesh::Selection, Error> {
    let meaning = "a set name, node numbers, or { box = [[..], [..]] }";
    table.required("nodes", meaning, |value| selection(value, mesh))
}

fn axes(table: &Table) -> Result<Option<Vec<Axis>>, Error> {
    let known = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];
    table.optional("axes", "axes, \"x\", \"y\" or \"z\"", |value| {
        value.one_or_more()?.iter().map(|axis| axis.word(&known)).collect()
    })
}

/// One number per named axis; a number alone for one axis.
fn per_axis(value: &Value, axes: usize) -> Result<Vec<f64>, Error> {
    let numbers = value.one_or_more()?;
    let numbers = numbers.iter().map(Value::number).collect::<Result<Vec<_>, Error>>()?;
    match numbers.len() == axes {
        true => Ok(numbers),
        false => Err(value.unexpected(format!("{axes} number(s), one per named axis"))),
    }
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
