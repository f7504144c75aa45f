//! `[[spring]]`, `[[cable]]`, `[[chamber]]` and `[[obstacle]]`.

use super::keys::{Holds, Key, Kind, TableKeys};
use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::scene::forces::{Chamber, Contact, Guide, Obstacle, Shape, Spring};
use crate::scene::timeline::Scene;

pub(super) const SPRING: TableKeys = TableKeys::new(
    "[[spring]]",
    "A spring with damper and actuator between two nodes, or a node and a fixed point. It acts in all phases; `actuate` in a phase adds a force.",
    &[
        Key::new("name", Holds::Text, "the name of the spring").default("spring 1, spring 2, ..."),
        Key::new(
            "ends",
            Holds::Array(&Holds::Either(&[Holds::Nodes, Holds::Table(&END)]), 2),
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
        Key::new("name", Holds::Text, "the name of the cable").default("spring 1, spring 2, ..."),
        Key::new(
            "path",
            Holds::List(&Holds::Either(&[Holds::Nodes, Holds::Table(&END)])),
            "nodes, by number, name or box, and points of space, in order",
        )
        .law("Those of a set or a box follow each other by their distance from the place before them, or from the first of them.")
        .required(),
        Key::number("stiffness", "the stiffness", "N/m").law("With the modulus E and the section A it is E A / length.").default("0"),
        Key::number("length", "the natural length", "m").default("that of the path at the start"),
        Key::number("damping", "the damping", "N s/m")
            .law("That of a motor whose tension falls from f at rest to 0 at the speed v is f/v.")
            .default("0"),
        Key::new("winch", Holds::Flag, "whether `actuate` gives the length that is drawn in, not the tension").default("false"),
        FRICTION_COEFFICIENT,
        Key::number("sticking_speed", "the speed below which it creeps instead of sticking", "m/s")
            .default("0.001 times its length per second"),
    ],
    "[[cable]]\nname = \"tendon\"\npath = [{ point = [-0.01, 0.1] }, \"top\"]\nfriction_coefficient = 0.1",
);

const END: TableKeys = TableKeys::new(
    "ends",
    "The end of a spring that is a fixed point of space.",
    &[vector("point", "where it is", "m")],
    "[[spring]]\nends = [3, { point = [0.0, 0.2] }]\nstiffness = 20.0",
);

pub(super) const CHAMBER: TableKeys = TableKeys::new(
    "[[chamber]]",
    "A closed space that `pressure` in a phase blows up.",
    &[
        Key::new("name", Holds::Text, "the name of the chamber").required(),
        Key::new(
            "nodes",
            Holds::Nodes,
            "the nodes of its walls: part of the boundary, or a closed polygon of numbers",
        ),
        Key::new(
            "triangles",
            Holds::List(&Holds::Array(&Holds::Count, 3)),
            "the triangles of its walls in space, by the numbers of their nodes",
        )
        .law("A closed surface, all of them counter-clockwise as seen from outside, or all clockwise."),
        Key::new(
            "closed_by_line",
            Holds::Flag,
            "whether walls in the plane that are open are closed by the straight line between their ends",
        )
        .law("Without it a gap is an error.")
        .default("false"),
        Key::new(
            "closed_by_lid",
            Holds::Flag,
            "whether walls in space that are open are closed by lids on their rims, from the mean of a rim's nodes to its edges",
        )
        .law("Without it a rim is an error. The nodes of the rim feel the pressure on its lid.")
        .default("false"),
        Key::number("thickness", "the thickness", "m").default("that of the body"),
    ],
    "[[chamber]]\nname = \"inside\"\nnodes = \"inner\"",
)
.one_of(&[&["nodes"], &["triangles"]]);

pub(super) const OBSTACLE: TableKeys = TableKeys::new(
    "[[obstacle]]",
    "A rigid obstacle, felt by penalty: a node at depth d inside is pushed out by `stiffness` d (N). With \
     `stiffness_density` (N/m^3) pressure is felt at points of boundary faces, so that no mesh changes the result, and \
     `damping` and `tangential_damping` are per area as well (N s/m^3). Coulomb's friction is a part of the \
     normal force, and needs no scaling: what sticks creeps, slower than `sticking_speed`.",
    &[
        Key::new("name", Holds::Text, "the name of the obstacle")
            .default("obstacle 1, ..."),
        Key::number("stiffness", "the stiffness per node", "N/m"),
        Key::number("stiffness_density", "the stiffness per area of the body's boundary", "N/m^3"),
        Key::number("damping", "the damping along the normal", "N s/m").default("0"),
        Key::number("tangential_damping", "a force against sliding in proportion to its speed", "N s/m")
            .default("0"),
        FRICTION_COEFFICIENT,
        Key::number("sticking_speed", "the speed below which friction sticks", "m/s")
            .default("a thousandth of the size of the body per second"),
        Key::new("adhesion", Holds::Flag, "whether damping may pull at a body that leaves")
            .default("false"),
        Key::new("velocity", Holds::Vector, "the velocity of the obstacle").in_unit("m/s").default("0"),
        Key::new("path", Holds::Table(&WAY), "the path of the obstacle, in place of a velocity"),
        Key::number(
            "friction",
            "a force against sliding in proportion to its speed",
            "N s/m",
        )
        .now("tangential_damping"),
    ],
    "[[obstacle]]\n\
     name = \"floor\"\n\
     kind = \"half-plane\"\n\
     point = [0.0, 0.0]\n\
     normal = [0.0, 1.0]\n\
     stiffness_density = 1.0e7\n\
     friction_coefficient = { static = 0.6, kinetic = 0.5 }",
)
.one_of(&[&["stiffness"], &["stiffness_density"]])
.kinds(&[HALF_PLANE, DISC, BOX, CAPSULE, UNION]);

const PARTS: TableKeys = TableKeys::new(
    "obstacle.parts",
    "One shape of a union.",
    &[],
    "[[obstacle]]\n\
     kind = \"union\"\n\
     parts = [\n\
     \x20   { kind = \"box\", min = [0.0, -0.3], max = [0.1, -0.2] },\n\
     \x20   { kind = \"disc\", centre = [0.1, -0.25], radius = 0.05 },\n\
     ]\n\
     stiffness = 1.0e3",
)
.kinds(&[HALF_PLANE, DISC, BOX, CAPSULE]);

const HALF_PLANE: Kind = Kind {
    word: "half-plane",
    about: "all that lies beyond an edge (in space, a face)",
    keys: &[
        vector("point", "a point on its edge", "m"),
        vector("normal", "the direction out of it", "1"),
    ],
};

const DISC: Kind = Kind {
    word: "disc",
    about: "a disc (in space, a ball), or all around one",
    keys: &[
        vector("centre", "the centre", "m"),
        RADIUS,
        Key::new("cavity", Holds::Flag, "whether bodies are inside of it").default("false"),
    ],
};

const BOX: Kind = Kind {
    word: "box",
    about: "a box along the axes",
    keys: &[vector("min", "the lower corner", "m"), vector("max", "the upper corner", "m")],
};

const CAPSULE: Kind = Kind {
    word: "capsule",
    about: "all that is no farther than `radius` from a straight line",
    keys: &[
        vector("from", "one end of its axis", "m"),
        vector("to", "the other end of its axis", "m"),
        RADIUS,
    ],
};

const UNION: Kind = Kind {
    word: "union",
    about: "several shapes as one, which move together",
    keys: &[Key::new("parts", Holds::Tables(&PARTS), "the shapes").required()],
};

const RADIUS: Key = Key::number("radius", "the radius", "m").required();

const fn vector(name: &'static str, meaning: &'static str, unit: &'static str) -> Key {
    Key::new(name, Holds::Vector, meaning).in_unit(unit).required()
}

const WAY: TableKeys = TableKeys::new(
    "obstacle.path",
    "The obstacle runs smoothly (a cubic spline) through points, and begins and ends at rest; before and after it stays. Or it \
     follows formulas without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.",
    &[
        Key::new("times", Holds::List(&Holds::Number), "times in ascending order").in_unit("s"),
        Key::new(
            "displacements",
            Holds::List(&Holds::Vector),
            "displacements, at these times, from where it was said to be",
        )
        .in_unit("m"),
        Key::new(
            "displacement",
            Holds::ChangingVector,
            "the displacement from where it was said to be",
        )
        .in_unit("m"),
    ],
    "[[obstacle]]\n\
     kind = \"disc\"\n\
     centre = [0.05, 0.15]\n\
     radius = 0.02\n\
     stiffness = 1.0e3\n\
     path = { times = [0.0, 0.5, 1.0], displacements = [[0.0, 0.0], [0.0, -0.02], [0.0, 0.0]] }\n\
     # or: path = { displacement = [0.0, \"0.01*sin(20*t)\"] }",
)
.one_of(&[&["times", "displacements"], &["displacement"]]);

pub(super) const FRICTION_COEFFICIENT: Key = Key::new(
    "friction_coefficient",
    Holds::Either(&[Holds::Number, Holds::Table(&COEFFICIENTS)]),
    "Coulomb's coefficient of friction, or both of them",
)
.in_unit("1")
.default("0");

const COEFFICIENTS: TableKeys = TableKeys::new(
    "friction_coefficient",
    "Two coefficients of friction.",
    &[
        Key::number("static", "the friction coefficient at rest", "1").required(),
        Key::number("kinetic", "the friction coefficient of what slides", "1").required(),
    ],
    "friction_coefficient = { static = 0.6, kinetic = 0.5 }",
);

/// The scene with the spring that `value` describes.
pub(super) fn add_spring(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&SPRING)?;
    let body = scene.body();
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| format!("spring {}", scene.springs().len() + 1), Into::into);
    unique(table, &name, scene.springs().iter().map(Spring::name))?;
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
        spring.gauge(body.mesh()).map_err(|error| value.error(error))?;
        Ok(spring)
    })?;
    spring = table.added(spring, "stiffness", Value::number, Spring::stiffness)?;
    spring = table.added(spring, "length", Value::number, Spring::length)?;
    spring = table.added(spring, "damping", Value::number, Spring::damping)?;
    spring.gauge(body.mesh()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(spring))
}

/// The scene with the cable that `value` describes.
pub(super) fn add_cable(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&CABLE)?;
    let body = scene.body();
    let name = table.optional("name", Value::string)?;
    let name = name.map_or_else(|| format!("spring {}", scene.springs().len() + 1), Into::into);
    unique(table, &name, scene.springs().iter().map(Spring::name))?;
    let mut cable = table.required("path", |value| {
        let place = |place: &Value| {
            Ok::<_, Error>(match anchor(place, body.dimension())? {
                Some(point) => Guide::point(point),
                None => Guide::nodes(selection(place, body.mesh())?),
            })
        };
        let path = value.list()?.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let cable = Spring::cable(path).named(name);
        cable.gauge(body.mesh()).map_err(|error| value.error(error))?;
        Ok(cable)
    })?;
    cable = table.added(cable, "stiffness", Value::number, Spring::stiffness)?;
    cable = table.added(cable, "length", Value::number, Spring::length)?;
    cable = table.added(cable, "damping", Value::number, Spring::damping)?;
    if table.flag("winch")? {
        cable = cable.winch();
    }
    if let Some([at_rest, sliding]) = coefficients(table)? {
        cable = cable.friction_coefficients(at_rest, sliding);
    }
    cable = table.added(cable, "sticking_speed", Value::number, Spring::sticking_speed)?;
    cable.gauge(body.mesh()).map_err(|error| table.blame(error))?;
    Ok(scene.spring(cable))
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
    unique(table, name, scene.chambers().iter().map(Chamber::name))?;
    chamber.force(body, Vec::new()).map_err(|error| table.blame(error))?;
    Ok(scene.chamber(chamber))
}

/// The scene with the obstacle that `value` describes.
pub(super) fn add_obstacle(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let body = scene.body();
    let table = &value.table(&OBSTACLE)?;
    let mut obstacle = Obstacle::new(shape(table, body.dimension())?);
    obstacle = table.added(obstacle, "name", Value::string, Obstacle::named)?;
    obstacle = match table.optional("stiffness_density", Value::number)? {
        Some(stiffness) => obstacle.stiffness_density(stiffness),
        None => obstacle.stiffness(table.required("stiffness", Value::number)?),
    };
    obstacle = table.added(obstacle, "damping", Value::number, Obstacle::damping)?;
    obstacle = friction(obstacle, table)?;
    obstacle = table.added(obstacle, "adhesion", Value::flag, Obstacle::adhesion)?;
    let velocity = |value: &Value| value.vector(body.dimension());
    obstacle = table.added(obstacle, "velocity", velocity, Obstacle::velocity)?;
    if let Some(value) = table.get("path") {
        if table.get("velocity").is_some() {
            return Err(value.error("a path has its own velocity: give one of path and velocity"));
        }
        let path = value.table(&WAY)?;
        obstacle = way(obstacle, &path, body.dimension())?;
    }
    unique(table, obstacle.name(), scene.obstacles().iter().map(Obstacle::name))?;
    Contact::new(body, &obstacle).map_err(|error| table.blame(error))?;
    Ok(scene.obstacle(obstacle))
}

/// The `obstacle` on the path that `table` describes.
fn way(obstacle: Obstacle, table: &Table, dimension: usize) -> Result<Obstacle, Error> {
    let formulas =
        table.optional("displacement", |value| value.formulas(dimension, "dimension"))?;
    if let Some(formulas) = formulas {
        return Ok(obstacle.follow_formulas(formulas));
    }
    let times = table.required("times", Value::numbers)?;
    let displacements = table.required("displacements", |value| {
        value.list_of("displacements, one per time", |x| x.vector(dimension))
    })?;
    Ok(obstacle.path(times, displacements))
}

/// The `obstacle` with the tangential forces of `table`.
fn friction(obstacle: Obstacle, table: &Table) -> Result<Obstacle, Error> {
    let damping = Obstacle::tangential_damping;
    let mut obstacle = table.added(obstacle, "tangential_damping", Value::number, damping)?;
    if let Some([at_rest, sliding]) = coefficients(table)? {
        obstacle = obstacle.friction_coefficients(at_rest, sliding);
    }
    table.added(obstacle, "sticking_speed", Value::number, Obstacle::sticking_speed)
}

/// The static and the kinetic coefficient of friction of `table`, if it has any.
pub(super) fn coefficients(table: &Table) -> Result<Option<[f64; 2]>, Error> {
    table.optional("friction_coefficient", |value| {
        if value.entries().is_none() {
            let mu = value.number();
            let mu = mu.map_err(|_| value.unexpected("a number or { static, kinetic }"))?;
            return Ok([mu, mu]);
        }
        let table = value.table(&COEFFICIENTS)?;
        let coefficient = |key| table.required(key, Value::number);
        Ok([coefficient("static")?, coefficient("kinetic")?])
    })
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

fn shape(table: &Table, dimension: usize) -> Result<Shape, Error> {
    let vector = |key: &str| table.required(key, |value| value.vector(dimension));
    let radius = || table.required("radius", Value::number);
    Ok(match table.kind() {
        "half-plane" => Shape::half_plane(vector("point")?, vector("normal")?),
        "disc" => {
            let centre = vector("centre")?;
            match table.flag("cavity")? {
                true => Shape::cavity(centre, radius()?),
                false => Shape::disc(centre, radius()?),
            }
        }
        "box" => Shape::box_between(vector("min")?, vector("max")?),
        "capsule" => Shape::capsule(vector("from")?, vector("to")?, radius()?),
        _ => {
            let part = |part: &Table| {
                let shape = shape(part, dimension)?;
                shape.validated(dimension, &str::to_owned).map_err(|error| part.blame(error))
            };
            let parts = table.required("parts", |value| value.tables(&PARTS))?;
            Shape::union(parts.iter().map(part).collect::<Result<Vec<_>, _>>()?)
        }
    })
}
