//! `[[spring]]`, `[[chamber]]` and `[[obstacle]]`.

use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::error::Error;
use crate::force::{Chamber, Contact, Obstacle, Shape, Spring};
use crate::scene::Scene;

/// The scene with the spring that `value` describes.
pub(super) fn add_spring(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&["name", "ends", "stiffness", "length", "damping"])?;
    let body = scene.body();
    let meaning = "the two ends: one node each, by number or name";
    let ends = table.required("ends", meaning, |value| match &value.list()?[..] {
        [first, second] => Ok([selection(first, body.mesh())?, selection(second, body.mesh())?]),
        _ => Err(value.unexpected("two ends")),
    })?;
    let [first, second] = ends;
    let mut spring = Spring::between(first, second);
    if let Some(name) = table.optional("name", "the name of the spring", Value::string)? {
        spring = spring.named(name);
    }
    if let Some(k) = table.optional("stiffness", "the stiffness (N/m)", Value::number)? {
        spring = spring.stiffness(k);
    }
    if let Some(length) = table.optional("length", "the natural length (m)", Value::number)? {
        spring = spring.length(length);
    }
    if let Some(c) = table.optional("damping", "the damping (N s/m)", Value::number)? {
        spring = spring.damping(c);
    }
    unique(table, spring.name(), scene.springs().iter().map(Spring::name))?;
    spring.force(body.mesh(), Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(spring))
}

/// The scene with the chamber that `value` describes.
pub(super) fn add_chamber(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&["name", "nodes", "thickness"])?;
    let body = scene.body();
    let name = table.required("name", "the name of the chamber", Value::string)?;
    let meaning = "its nodes: a closed polygon of numbers in order, or a named set";
    let nodes = table.required("nodes", meaning, |value| selection(value, body.mesh()))?;
    let mut chamber = Chamber::polygon(name, nodes);
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

const KINDS: [(&str, Kind); 4] = [
    ("half-plane", Kind::HalfPlane),
    ("disc", Kind::Disc),
    ("box", Kind::Box),
    ("capsule", Kind::Capsule),
];

/// Keys of all obstacles.
const LAW: [&str; 8] = [
    "name",
    "kind",
    "stiffness",
    "stiffness_density",
    "damping",
    "friction",
    "adhesion",
    "velocity",
];

/// Keys of the shapes.
const SHAPES: [&str; 9] =
    ["point", "normal", "centre", "radius", "cavity", "min", "max", "from", "to"];

/// The scene with the obstacle that `value` describes.
pub(super) fn add_obstacle(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let body = scene.body();
    let kind = value.table(&[&LAW[..], &SHAPES].concat())?.required(
        "kind",
        "the shape of the obstacle",
        |value| value.word(&KINDS),
    )?;
    let keys: &[&str] = match kind {
        Kind::HalfPlane => &["point", "normal"],
        Kind::Disc => &["centre", "radius", "cavity"],
        Kind::Box => &["min", "max"],
        Kind::Capsule => &["from", "to", "radius"],
    };
    let table = &value.table(&[&LAW[..], keys].concat())?;
    let mut obstacle = Obstacle::new(shape(kind, table, body.dimension())?);
    if let Some(name) = table.optional("name", "the name of the obstacle", Value::string)? {
        obstacle = obstacle.named(name);
    }
    let per_node = table.optional("stiffness", "N/m per node", Value::number)?;
    let per_area = table.optional("stiffness_density", "N/m^3", Value::number)?;
    obstacle = match (per_node, per_area) {
        (Some(stiffness), None) => obstacle.stiffness(stiffness),
        (None, Some(stiffness)) => obstacle.stiffness_density(stiffness),
        _ => {
            return Err(table.error(
                "expected either stiffness (N/m per node) or stiffness_density (N/m^3, per area \
                 of the body's boundary)",
            ));
        }
    };
    if let Some(damping) = table.optional("damping", "the damping (N s/m)", Value::number)? {
        obstacle = obstacle.damping(damping);
    }
    if let Some(friction) =
        table.optional("friction", "the tangential damping (N s/m)", Value::number)?
    {
        obstacle = obstacle.friction(friction);
    }
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

/// Checks that no other one of its kind has the `name` of the thing that `table` describes.
fn unique<'a>(
    table: &Table,
    name: &str,
    mut others: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    match others.any(|other| other == name) {
        false => Ok(()),
        true => {
            let mend = "another one has this name: give each its own";
            Err(table.blame(Error::input("name", format!("\"{name}\""), mend)))
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
