//! `[[spring]]`, `[[cable]]` and `[[chamber]]`.

use super::friction::{FRICTION_COEFFICIENT, coefficients};
use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::{Actuator, Chamber, Guide, Spring};
use crate::scene::timeline::Scene;

pub(super) const SPRING: TableKeys = TableKeys::new(
    "[[spring]]",
    "A spring with damper and actuator between two nodes, or a node and a fixed point. It acts in all phases; `actuate` in a phase adds a force.",
    &[
        Key::new("name", ValueType::Text, "the name of the spring")
            .default("spring 1, spring 2, ..."),
        Key::new(
            "ends",
            ValueType::Array(&ValueType::Either(&[ValueType::Nodes, ValueType::Table(&END)]), 2),
            "one node each, by number or name, or a point of space",
        )
        .required(),
        Key::number("stiffness", "the stiffness", "N/m").default("0"),
        Key::number("length", "the natural length", "m").default("that at the start"),
        Key::number("damping", "the damping", "N s/m").default("0"),
    ],
    "[[spring]]\nname = \"down\"\nends = [1, 3]\nstiffness = 20.0\nlength = 0.04",
);

pub(super) const CABLE: TableKeys = TableKeys::new(
    "[[cable]]",
    "A cable (tendon) along a path, straight from place to place and free to slide around those between its ends. It only pulls, by one \
     tension along all of its path if there is no friction. It acts in all phases; `actuate` in a phase drives it, at its first place.",
    &[
        Key::new("name", ValueType::Text, "the name of the cable").default("spring 1, spring 2, ..."),
        Key::new(
            "path",
            ValueType::List(&ValueType::Either(&[ValueType::Nodes, ValueType::Table(&END), ValueType::Table(&INSIDE)])),
            "nodes, by number, name or box, points in the body, and fixed points of space, in order",
        )
        .note("Nodes of a set or a box are ordered by their distance from the point before them, or from the first of them.")
        .required(),
        Key::number("stiffness", "the stiffness", "N/m").note("With the modulus E and the section A it is E A / length.").default("0"),
        Key::number("length", "the natural length", "m").default("that of the path at the start"),
        Key::number("damping", "the damping", "N s/m")
            .note("That of a motor whose tension falls from f at rest to 0 at the speed v is f/v.")
            .default("0"),
        Key::new("winch", ValueType::Flag, "whether `actuate` gives the length that is drawn in, not the tension").default("false"),
        FRICTION_COEFFICIENT,
        Key::number("sticking_speed", "the speed below which it creeps instead of sticking", "m/s")
            .default("0.001 times its length per second"),
    ],
    "[[cable]]\nname = \"tendon\"\npath = [{ point = [-0.01, 0.1] }, \"top\"]\nfriction_coefficient = 0.1",
);

const END: TableKeys = TableKeys::new(
    "ends",
    "The end of a spring that is a fixed point of space.",
    &[Key::vector("point", "where it is", "m")],
    "[[spring]]\nends = [3, { point = [0.0, 0.2] }]\nstiffness = 20.0",
);

const INSIDE: TableKeys = TableKeys::new(
    "inside",
    "A point in the body that guides a cable. It moves with the body, and is the same on a finer mesh.",
    &[Key::vector(
        "inside",
        "its undeformed position, within a cell or on the surface, of a rod in a cross section",
        "m",
    )],
    "[[cable]]\npath = [{ inside = [0.02, 0.08] }, { inside = [0.05, 0.08] }, { inside = [0.08, 0.08] }]",
);

pub(super) const CHAMBER: TableKeys = TableKeys::new(
    "[[chamber]]",
    "A closed space that `pressure` in a phase blows up, unless it has `[[gas]]` or a `[[liquid]]`.",
    &[
        Key::new("name", ValueType::Text, "the name of the chamber").required(),
        Key::new(
            "nodes",
            ValueType::Nodes,
            "the nodes of its walls: part of the boundary, or a closed polygon of numbers",
        ),
        Key::new(
            "triangles",
            ValueType::List(&ValueType::Array(&ValueType::Count, 3)),
            "the triangles of its walls in space, by the numbers of their nodes",
        )
        .note("A closed surface, all of them counter-clockwise as seen from outside, or all clockwise."),
        Key::new(
            "closed_by_line",
            ValueType::Flag,
            "whether walls in the plane that are open are closed by the straight line between their ends",
        )
        .note("Without it a gap is an error.")
        .default("false"),
        Key::new(
            "closed_by_lid",
            ValueType::Flag,
            "whether walls in space that are open are closed by lids on their rims, from the mean of a rim's nodes to its edges",
        )
        .note("Without it a rim is an error. The pressure force on the lid acts on the nodes of the rim.")
        .default("false"),
        Key::number("thickness", "the thickness", "m").default("that of the body"),
        Key::number("burst", "the pressure, above that outside, at which it bursts", "Pa")
            .note("The first step that ends with more ends the run, with an error that says when and how much.")
            .default("none"),
    ],
    "[[chamber]]\nname = \"inside\"\nnodes = \"inner\"",
)
.one_of(&[&["nodes"], &["triangles"]]);

/// The scene with the spring that `value` describes.
pub(super) fn add_spring(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&SPRING)?;
    let body = scene.body();
    let name = actuator_name(table, &scene, "spring")?;
    let mut spring = table.required("ends", |value| {
        let list = value.list()?;
        let [first, second] = &list[..] else { return Err(value.unexpected("two ends")) };
        let node = |end: &Value| selection(end, body.mesh());
        let spring = match (anchor(first, body.dimension())?, anchor(second, body.dimension())?) {
            (None, None) => Spring::between(node(first)?, node(second)?),
            (None, Some(point)) => Spring::anchored(node(first)?, point),
            (Some(point), None) => Spring::anchored(node(second)?, point),
            (Some(_), Some(_)) => return Err(value.unexpected("one node at least")),
        };
        let spring = spring.named(name);
        spring.driven(body, Vec::new()).map_err(|error| value.error(error))?;
        Ok(spring)
    })?;
    spring = elastic(spring, table)?;
    spring.driven(body, Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(spring))
}

/// The scene with the cable that `value` describes.
pub(super) fn add_cable(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&CABLE)?;
    let body = scene.body();
    let name = actuator_name(table, &scene, "spring")?;
    let mut cable = table.required("path", |value| {
        let place = |place: &Value| {
            if place.entries().is_some_and(|entries| entries.contains_key("inside")) {
                let inside = place.table(&INSIDE)?;
                return Ok(Guide::inside(
                    inside.required("inside", |value| value.vector(body.dimension()))?,
                ));
            }
            Ok::<_, Error>(match anchor(place, body.dimension())? {
                Some(point) => Guide::point(point),
                None => Guide::nodes(selection(place, body.mesh())?),
            })
        };
        let path = value.list()?.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let cable = Spring::cable(path).named(name);
        cable.driven(body, Vec::new()).map_err(|error| value.error(error))?;
        Ok(cable)
    })?;
    cable = elastic(cable, table)?;
    if table.flag("winch")? {
        cable = cable.winch();
    }
    if let Some([at_rest, sliding]) = coefficients(table)? {
        cable = cable.friction_coefficients(at_rest, sliding);
    }
    cable = table.added(cable, "sticking_speed", Value::number, Spring::sticking_speed)?;
    cable.driven(body, Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(cable))
}

/// A spring or cable with the elasticity and the damping of its table.
fn elastic(spring: Spring, table: &Table) -> Result<Spring, Error> {
    let spring = table.added(spring, "stiffness", Value::number, Spring::stiffness)?;
    let spring = table.added(spring, "length", Value::number, Spring::length)?;
    table.added(spring, "damping", Value::number, Spring::damping)
}

/// The point of space at an end of a spring, if that end is not a node.
fn anchor(end: &Value, dimension: usize) -> Result<Option<Vec<f64>>, Error> {
    match end.entries() {
        Some(entries) if entries.contains_key("point") => {
            let point = end.table(&END)?.required("point", |value| value.vector(dimension))?;
            Ok(Some(point))
        }
        _ => Ok(None),
    }
}

/// The scene with the chamber that `value` describes.
pub(super) fn add_chamber(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&CHAMBER)?;
    let body = scene.body();
    let name = table.required("name", Value::string)?;
    let triangles = table.optional("triangles", |value| {
        value.list_of("triangles, three node numbers each", Value::counts::<3>)
    })?;
    let mut chamber = match triangles {
        Some(triangles) => Chamber::surface(name, triangles),
        None => {
            let nodes = table.required("nodes", |value| selection(value, body.mesh()))?;
            Chamber::within(name, nodes)
        }
    };
    if table.flag("closed_by_line")? {
        chamber = chamber.closed_by_line();
    }
    if table.flag("closed_by_lid")? {
        chamber = chamber.closed_by_lid();
    }
    chamber = table.added(chamber, "thickness", Value::number, Chamber::thickness)?;
    chamber = table.added(chamber, "burst", Value::number, Chamber::burst)?;
    unique(table, name, scene.chambers().iter().map(Chamber::name))?;
    chamber.force(body, Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.chamber(chamber))
}

/// The name of an actuator that the table describes, which no other one has; `word` and a number where it is given none.
pub(super) fn actuator_name(table: &Table, scene: &Scene, word: &str) -> Result<String, Error> {
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| scene.next_actuator(word), Into::into);
    unique(table, &name, scene.actuators().iter().map(|own| own.name()))?;
    Ok(name)
}

/// Checks that nothing else of its kind has the `name` of what `table` describes.
pub(super) fn unique<'a>(
    table: &Table,
    name: &str,
    mut others: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    match others.any(|other| other == name) {
        false => Ok(()),
        true => {
            let help = "another one has it already: give each a name of its own";
            Err(table.blame(InputError::new("name", format!("\"{name}\""), help)))
        }
    }
}
