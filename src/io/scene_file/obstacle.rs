//! `[[obstacle]]`.

use super::friction::{FRICTION_COEFFICIENT, coefficients};
use super::keys::{Key, Kind, TableKeys, ValueType};
use super::surroundings::unique;
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::{Contact, Obstacle, Shape};
use crate::scene::timeline::Scene;

pub(super) const OBSTACLE: TableKeys = TableKeys::new(
    "[[obstacle]]",
    "A rigid obstacle, felt by penalty: a node at depth d inside is pushed out by `stiffness` d (N). With \
     `stiffness_density` (N/m^3) pressure is felt at points of boundary faces, so that no mesh changes the result, and \
     `damping` and `tangential_damping` are per area as well (N s/m^3). Coulomb's friction is a part of the \
     normal force, and needs no scaling: what sticks creeps, slower than `sticking_speed`.",
    &[
        Key::new("name", ValueType::Text, "the name of the obstacle")
            .default("obstacle 1, ..."),
        Key::number("stiffness", "the stiffness per node", "N/m"),
        Key::number("stiffness_density", "the stiffness per area of the body's boundary", "N/m^3"),
        Key::number("damping", "the damping along the normal", "N s/m").default("0"),
        Key::number("tangential_damping", "a force against sliding in proportion to its speed", "N s/m")
            .default("0"),
        FRICTION_COEFFICIENT,
        Key::number("sticking_speed", "the speed below which friction sticks", "m/s")
            .default("a thousandth of the size of the body per second"),
        Key::new("backward", ValueType::Table(&BACKWARD), "a direction of larger friction, as of bristles, scales or claws"),
        Key::new("adhesion", ValueType::Flag, "whether damping may pull a separating body")
            .default("false"),
        Key::new("velocity", ValueType::Vector, "the velocity of the obstacle").in_unit("m/s").default("0"),
        Key::new("path", ValueType::Table(&WAY), "the path of the obstacle, in place of a velocity"),
        Key::number(
            "friction",
            "a force against sliding in proportion to its speed",
            "N s/m",
        )
        .renamed_to("tangential_damping"),
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

const BACKWARD: TableKeys = TableKeys::new(
    "backward",
    "Larger friction against sliding one way; what slides at an angle to it has less, and all other ways have \
     `friction_coefficient`.",
    &[
        Key::new("direction", ValueType::Vector, "the direction of larger friction, fixed in space")
            .required(),
        Key::number("friction_coefficient", "the static coefficient of friction in that direction", "1")
            .note("The kinetic one is larger in proportion.")
            .required(),
    ],
    "[[obstacle]]\nkind = \"half-plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nstiffness_density = 1.0e7\n\
     friction_coefficient = 0.15\nbackward = { direction = [-1.0, 0.0], friction_coefficient = 0.8 }",
);

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
        Key::vector("point", "a point on its edge", "m"),
        Key::vector("normal", "the direction out of it", "1"),
    ],
};

const DISC: Kind = Kind {
    word: "disc",
    about: "a disc (in space, a ball), or all around one",
    keys: &[
        Key::vector("centre", "the centre", "m"),
        RADIUS,
        Key::new("cavity", ValueType::Flag, "whether bodies are inside of it").default("false"),
    ],
};

const BOX: Kind = Kind {
    word: "box",
    about: "a box along the axes, unless it is turned",
    keys: &[
        Key::vector("min", "the lower corner", "m"),
        Key::vector("max", "the upper corner", "m"),
        Key::new(
            "turn",
            ValueType::OneOrMore(&ValueType::Number),
            "the angle by which the box is turned about its middle",
        )
        .in_unit("rad")
        .note(
            "One number in the plane, counter-clockwise; in space three, the axis times the angle.",
        )
        .default("0"),
    ],
};

const CAPSULE: Kind = Kind {
    word: "capsule",
    about: "all that is no farther than `radius` from a straight line",
    keys: &[
        Key::vector("from", "one end of its axis", "m"),
        Key::vector("to", "the other end of its axis", "m"),
        RADIUS,
    ],
};

const UNION: Kind = Kind {
    word: "union",
    about: "several shapes as one, which move together",
    keys: &[Key::new("parts", ValueType::Tables(&PARTS), "the shapes").required()],
};

const RADIUS: Key = Key::number("radius", "the radius", "m").required();

const WAY: TableKeys = TableKeys::new(
    "obstacle.path",
    "The obstacle runs smoothly (a cubic spline) through points, and begins and ends at rest; before and after it stays. Or it \
     follows formulas without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.",
    &[
        Key::new("times", ValueType::List(&ValueType::Number), "times in ascending order").in_unit("s"),
        Key::new(
            "displacements",
            ValueType::List(&ValueType::Vector),
            "displacements, at these times, from the position of its shape",
        )
        .in_unit("m"),
        Key::new(
            "displacement",
            ValueType::ChangingVector,
            "the displacement from the position of its shape",
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
    obstacle = friction(obstacle, table, body.dimension())?;
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
fn friction(obstacle: Obstacle, table: &Table, dimension: usize) -> Result<Obstacle, Error> {
    let damping = Obstacle::tangential_damping;
    let mut obstacle = table.added(obstacle, "tangential_damping", Value::number, damping)?;
    if let Some([at_rest, sliding]) = coefficients(table)? {
        obstacle = obstacle.friction_coefficients(at_rest, sliding);
    }
    if let Some(value) = table.get("backward") {
        let backward = value.table(&BACKWARD)?;
        let direction = backward.required("direction", |value| value.vector(dimension))?;
        let coefficient = backward.required("friction_coefficient", Value::number)?;
        obstacle = obstacle.backward_friction(direction, coefficient);
    }
    table.added(obstacle, "sticking_speed", Value::number, Obstacle::sticking_speed)
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
        "box" => match table.optional("turn", Value::one_or_more_numbers)? {
            Some(turn) => Shape::turned_box(vector("min")?, vector("max")?, turn),
            None => Shape::box_between(vector("min")?, vector("max")?),
        },
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
