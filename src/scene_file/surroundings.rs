//! `[[spring]]`, `[[chamber]]` and `[[obstacle]]`.

use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::error::Error;
use crate::external::{Chamber, Contact, Obstacle, Shape, Spring};
use crate::input::InputError;
use crate::scene::Scene;

/// The scene with the spring that `value` describes.
pub(super) fn add_spring(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&["name", "ends", "stiffness", "length", "damping"])?;
    let body = scene.body();
    let name = table.optional("name", "the name of the spring", Value::string)?;
    let name = name.map_or_else(|| format!("spring {}", scene.springs().len() + 1), Into::into);
    unique(table, &name, scene.springs().iter().map(Spring::name))?;
    let mut spring = table.required("ends", "one node each, by number or name", |value| {
        let list = value.list()?;
        let [first, second] = &list[..] else { return Err(value.unexpected("two ends")) };
        let ends = [selection(first, body.mesh())?, selection(second, body.mesh())?];
        let spring = Spring::between(ends[0].clone(), ends[1].clone()).named(name);
        spring.force(body.mesh()).map_err(|error| value.error(error))?;
        Ok(spring)
    })?;
    if let Some(k) = table.optional("stiffness", "the stiffness (N/m)", Value::number)? {
        spring = spring.stiffness(k);
    }
    if let Some(length) = table.optional("length", "the natural length (m)", Value::number)? {
        spring = spring.length(length);
    }
    if let Some(c) = table.optional("damping", "the damping (N s/m)", Value::number)? {
        spring = spring.damping(c);
    }
    spring.force(body.mesh()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(spring))
}

/// The scene with the chamber that `value` describes.
pub(super) fn add_chamber(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&["name", "nodes", "thickness"])?;
    let body = scene.body();
    let name = table.required("name", "the name of the chamber", Value::string)?;
    let meaning = "the nodes of its walls: part of the boundary, or a closed polygon of numbers";
    let nodes = table.required("nodes", meaning, |value| selection(value, body.mesh()))?;
    let mut chamber = Chamber::within(name, nodes);
    if let Some(h) = table.optional("thickness", "the thickness (m)", Value::number)? {
        chamber = chamber.thickness(h);
    }
    unique(table, name, scene.chambers().iter().map(Chamber::name))?;
    chamber.force(body, Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.chamber(chamber))
}

#[derive(Clone, Copy)]
enum Kind {
    HalfPlane,
    Disc,
    Box,
    Capsule,
}

/// The words for them, and their keys.
const KINDS: [(&str, Kind, &[&str]); 4] = [
    ("half-plane", Kind::HalfPlane, &["point", "normal"]),
    ("disc", Kind::Disc, &["centre", "radius", "cavity"]),
    ("box", Kind::Box, &["min", "max"]),
    ("capsule", Kind::Capsule, &["from", "to", "radius"]),
];

/// Keys of all obstacles.
const LAW: &[&str] = &[
    "name",
    "stiffness",
    "stiffness_density",
    "damping",
    "tangential_damping",
    "friction_coefficient",
    "sticking_speed",
    "adhesion",
    "velocity",
    FRICTION,
];

/// The key of tangential damping before Coulomb's friction came.
const FRICTION: &str = "friction";

/// What is to be said about the obstacles that `value` describes.
pub(super) fn notes(value: &Value) -> Result<Vec<String>, Error> {
    let line = |value: &Value| {
        let damping = value.entries()?.get(FRICTION)?;
        Some(value.source.line(damping.span().start))
    };
    let note = |line: usize| {
        format!(
            "line {line}: obstacle.{FRICTION} is read as tangential_damping, its name now: a force in \
             proportion to the sliding speed. Coulomb's friction is friction_coefficient"
        )
    };
    Ok(value.one_or_more()?.iter().filter_map(line).map(note).collect())
}

/// The scene with the obstacle that `value` describes.
pub(super) fn add_obstacle(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let body = scene.body();
    let (kind, table) = &value.table_of_kind(&KINDS, LAW)?;
    let mut obstacle = Obstacle::new(shape(*kind, table, body.dimension())?);
    if let Some(name) = table.optional("name", "the name of the obstacle", Value::string)? {
        obstacle = obstacle.named(name);
    }
    let meaning = "the stiffness per node (N/m)";
    let per_node = table.optional("stiffness", meaning, Value::number)?;
    let meaning = "the stiffness per area of the body's boundary (N/m^3)";
    let per_area = table.optional("stiffness_density", meaning, Value::number)?;
    obstacle = match (per_node, per_area) {
        (Some(stiffness), None) => obstacle.stiffness(stiffness),
        (None, Some(stiffness)) => obstacle.stiffness_density(stiffness),
        (None, None) => {
            let mend = "expected the stiffness per node (N/m), or stiffness_density (N/m^3)";
            return Err(table.missing("stiffness", mend));
        }
        (Some(_), Some(_)) => {
            return Err(table.error("expected stiffness or stiffness_density, found both"));
        }
    };
    if let Some(damping) = table.optional("damping", "the damping (N s/m)", Value::number)? {
        obstacle = obstacle.damping(damping);
    }
    obstacle = friction(obstacle, table)?;
    if let Some(adhesion) = table.optional("adhesion", "whether damping may pull", Value::flag)? {
        obstacle = obstacle.adhesion(adhesion);
    }
    if let Some(velocity) =
        table.optional("velocity", "the velocity of the obstacle (m/s)", |v| {
            v.vector(body.dimension())
        })?
    {
        obstacle = obstacle.velocity(velocity);
    }
    unique(table, obstacle.name(), scene.obstacles().iter().map(Obstacle::name))?;
    Contact::new(body, &obstacle).map_err(|error| table.blame(error))?;
    Ok(scene.obstacle(obstacle))
}

/// The `obstacle` with the tangential forces of `table`.
fn friction(mut obstacle: Obstacle, table: &Table) -> Result<Obstacle, Error> {
    let meaning = "the tangential damping (N s/m)";
    let damping = table.optional("tangential_damping", meaning, Value::number)?;
    let alias = table.optional(FRICTION, meaning, Value::number)?;
    if damping.is_some() && alias.is_some() {
        return Err(table.error("friction is the old name of tangential_damping: give that alone"));
    }
    if let Some(damping) = damping.or(alias) {
        obstacle = obstacle.tangential_damping(damping);
    }
    let meaning = "the friction coefficient (no unit)";
    let coefficients = table.optional("friction_coefficient", meaning, |value| {
        if value.entries().is_none() {
            let mu = value.number();
            let mu = mu.map_err(|_| value.unexpected("a number or { static, kinetic }"))?;
            return Ok([mu, mu]);
        }
        let table = value.table(&["static", "kinetic"])?;
        let coefficient = |key, meaning| table.required(key, meaning, Value::number);
        Ok([
            coefficient("static", "the friction coefficient at rest (no unit)")?,
            coefficient("kinetic", "the friction coefficient of what slides (no unit)")?,
        ])
    })?;
    if let Some([at_rest, sliding]) = coefficients {
        obstacle = obstacle.friction_coefficients(at_rest, sliding);
    }
    let meaning = "the speed below which friction sticks (m/s)";
    if let Some(speed) = table.optional("sticking_speed", meaning, Value::number)? {
        obstacle = obstacle.sticking_speed(speed);
    }
    Ok(obstacle)
}

/// Checks that no other one of its kind has the `name` of the thing that `table` describes.
fn unique<'a>(
    table: &Table,
    name: &str,
    mut others: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    match others.any(|other| other == name) {
        false => Ok(()),
        true => {
            let mend = "another one has it already: give each a name of its own";
            Err(table.blame(InputError::new("name", format!("\"{name}\""), mend)))
        }
    }
}

fn shape(kind: Kind, table: &Table, dimension: usize) -> Result<Shape, Error> {
    let vector = |key: &str, meaning: &'static str| {
        table.required(key, meaning, |value| value.vector(dimension))
    };
    let radius = || table.required("radius", "the radius (m)", Value::number);
    Ok(match kind {
        Kind::HalfPlane => Shape::half_plane(
            vector("point", "a point on its edge (m)")?,
            vector("normal", "the direction out of it (no unit)")?,
        ),
        Kind::Disc => {
            let centre = vector("centre", "the centre (m)")?;
            let meaning = "whether bodies are inside of it";
            match table.optional("cavity", meaning, Value::flag)? {
                Some(true) => Shape::cavity(centre, radius()?),
                _ => Shape::disc(centre, radius()?),
            }
        }
        Kind::Box => Shape::box_between(
            vector("min", "the lower corner (m)")?,
            vector("max", "the upper corner (m)")?,
        ),
        Kind::Capsule => Shape::capsule(
            vector("from", "one end of its axis (m)")?,
            vector("to", "the other end of its axis (m)")?,
            radius()?,
        ),
    })
}
