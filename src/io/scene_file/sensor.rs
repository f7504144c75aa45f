//! `[[sensor]]`.

use super::keys::{Key, Kind, TableKeys, ValueType};
use super::selection::selection;
use super::table::Table;
use super::value::{Value, number_of};
use crate::dynamics::error::Error;
use crate::dynamics::simulate::{Component, OUTPUTS, Output, Reading, Sampling, Spot};
use crate::elements::mesh::{Mesh, Selection};
use crate::scene::timeline::Scene;

pub(super) const SENSOR: TableKeys = TableKeys::new(
    "[[sensor]]",
    "A quantity that is read with each sample: a column of `trajectory.csv`, a line of plots. One with several \
     components has a column for each: `tip.x`, `tip.y`. Of several nodes, positions and the like are means, forces \
     are sums.",
    &[
        Key::new("name", ValueType::Text, "the name of the sensor").required(),
        Key::new("component", ValueType::Word(|| Component::WORDS.map(|(word, _)| word).into()), "one component alone")
            .note("Vectors have `x`, `y`, `z` and their length `norm`; tensors `xx` and so on; stress has `von-mises` besides.")
            .default("all, each a column"),
    ],
    "[[sensor]]\nname = \"bottom\"\nkind = \"constraint-force\"\nnodes = \"all\"\ncomponent = \"y\"",
)
.kinds(&KINDS);

/// Quantities of places, contacts, fields and bodies.
const OWN: [Kind; 24] = [
    Kind {
        word: "position",
        about: "position of nodes, of a point of a body or of a marker (m)",
        keys: &SPOT,
    },
    Kind {
        word: "displacement",
        about: "displacement of nodes, of a point of a body or of a marker from the undeformed shape (m)",
        keys: &SPOT,
    },
    Kind {
        word: "velocity",
        about: "velocity of nodes, of a point of a body or of a marker (m/s)",
        keys: &SPOT,
    },
    Kind {
        word: "acceleration",
        about: "acceleration of nodes, of a point of a body or of a marker (m/s^2)",
        keys: &SPOT,
    },
    Kind {
        word: "constraint-force",
        about: "the constraint force on nodes, their reaction (N)",
        keys: &[NODES],
    },
    Kind {
        word: "constraint-moment",
        about: "the moment of the constraint forces on nodes about a fixed point (N m), counter-clockwise in the plane",
        keys: &[
            NODES,
            Key::new("about", ValueType::Vector, "the point").in_unit("m").required(),
            Key::new(
                "axis",
                ValueType::Vector,
                "the direction along which it is read, of a body in space",
            )
            .default("all components, each a column"),
        ],
    },
    Kind {
        word: "contact-force",
        about: "the force of an obstacle, or of bodies that touch, on a body (N)",
        keys: &[OBSTACLE, TOUCH, TOUCHED, TOUCHED_BODY],
    },
    Kind {
        word: "contact-area",
        about: "the area of the surface of a body that an obstacle, or another body, touches: in the plane a length times the thickness (m^2)",
        keys: &[OBSTACLE, TOUCH, TOUCHED, TOUCHED_BODY],
    },
    Kind {
        word: "contact-pressure",
        about: "the largest contact pressure at any of the nodes (Pa)",
        keys: &[OBSTACLE, TOUCH, TOUCHED, TOUCHED_BODY],
    },
    Kind {
        word: "gap",
        about: "the least gap between the surfaces of bodies that touch, at most the contact distance (m)",
        keys: &[Key::new("touch", ValueType::Text, "the name of the contact").required()],
    },
    Kind {
        word: "magnetic-moment",
        about: "the magnetic moment of all magnets (A m^2)",
        keys: &[],
    },
    Kind {
        word: "fluid-force",
        about: "the force of a fluid, its drag and pressure, on all nodes, on some of them or on those of one body (N)",
        keys: &[
            Key::new("fluid", ValueType::Text, "the name of the fluid").required(),
            Key::new("nodes", ValueType::Nodes, "the nodes on which it acts").default("all"),
            BODY,
        ],
    },
    Kind {
        word: "device",
        about: "an output of a device by its word: the `force` of a `[[wind]]` (N), the `angle` of a `[[joint]]`",
        keys: &[
            Key::new("device", ValueType::Text, "the name of the device").required(),
            Key::new("output", ValueType::Text, "the word of the output").required(),
            UNIT,
        ],
    },
    Kind {
        word: "stress",
        about: "the stress of the elastic law and of Maxwell branches, without viscosity, at nodes or at a point, extrapolated from the cells around (Pa)",
        keys: &[PLACES, POINT],
    },
    Kind {
        word: "strain",
        about: "the strain at nodes or at a point, extrapolated from the cells around (no unit)",
        keys: &[PLACES, POINT],
    },
    Kind {
        word: "distance",
        about: "the distance between two nodes, or the middles of sets (m)",
        keys: &[
            Key::new("from", ValueType::Nodes, "where it is measured from").required(),
            Key::new("to", ValueType::Nodes, "where it is measured to").required(),
        ],
    },
    Kind {
        word: "angle",
        about: "the angle from one line to another, counter-clockwise in the plane, where it goes on over whole turns; \
                without sign, from 0 to half a turn, in space",
        keys: &[
            Key::new("from", LINE, "the two ends of the one line").required(),
            Key::new("to", LINE, "the two ends of the other").required(),
            UNIT,
        ],
    },
    Kind { word: "centre-of-mass", about: "the centre of mass (m)", keys: &[BODY] },
    Kind { word: "momentum", about: "the momentum (kg m/s)", keys: &[BODY] },
    Kind {
        word: "rotation",
        about: "the rotation of a body, or of nodes, as a whole, the one nearest to its motion: in the plane an angle, counter-clockwise, \
                which goes on over whole turns; in space a vector along the axis, of a length of at most half a turn",
        keys: &[UNIT, TURNED, BODY],
    },
    Kind {
        word: "angular-velocity",
        about: "the rate of that rotation (rad/s): in the plane counter-clockwise, in space a vector",
        keys: &[TURNED, BODY],
    },
    Kind {
        word: "angular-acceleration",
        about: "the rate of that angular velocity (rad/s^2)",
        keys: &[TURNED, BODY],
    },
    Kind {
        word: "accelerometer",
        about: "acceleration less gravity in axes that turn with a body or nodes (m/s^2), at their middle: 0 in free fall, g upwards at rest",
        keys: &[TURNED, BODY],
    },
    Kind {
        word: "gyroscope",
        about: "the angular velocity in axes that turn with a body or nodes (rad/s)",
        keys: &[TURNED, BODY],
    },
];

/// The key of the component of each output.
const COMPONENTS: [[Key; 1]; OUTPUTS.len()] = {
    let mut keys = [[NODES]; OUTPUTS.len()];
    let mut k = 0;
    while k < keys.len() {
        let of = OUTPUTS[k].of;
        keys[k] = [Key::new(of.key, ValueType::Text, of.about).required()];
        k += 1;
    }
    keys
};

/// These, and the outputs of components.
const KINDS: [Kind; OWN.len() + OUTPUTS.len()] = {
    let mut kinds = [const { Kind { word: "", about: "", keys: &[] } }; OWN.len() + OUTPUTS.len()];
    let mut k = 0;
    while k < kinds.len() {
        kinds[k] = match k.checked_sub(OWN.len()) {
            None => OWN[k],
            Some(number) => {
                let (Output { word, about, .. }, keys) = (OUTPUTS[number], &COMPONENTS[number]);
                Kind { word, about, keys }
            }
        };
        k += 1;
    }
    kinds
};

const MARKER: TableKeys = TableKeys::new(
    "marker",
    "A point outside of the body, as on a post or a plate: it moves with nodes as if both were one rigid body, by the best-fitting rigid motion.",
    &[
        Key::new("nodes", ValueType::Nodes, "the nodes that it moves with").required(),
        Key::vector("at", "where it is in the undeformed shape", "m"),
    ],
    "[[sensor]]\nname = \"lamp\"\nkind = \"position\"\nmarker = { nodes = \"top\", at = [0.05, 0.15] }",
);

const OBSTACLE: Key =
    Key::new("obstacle", ValueType::Text, "the name of the obstacle").default("`touch`");
const TOUCH: Key =
    Key::new("touch", ValueType::Text, "the name of the contact of bodies").default("`obstacle`");
const TOUCHED: Key = Key::new("nodes", ValueType::Nodes, "the nodes on which it acts").default("all").note(
    "Those of one finger, say: the forces on both sides of what is gripped cancel each other. A `touch` needs `nodes` or \
     `body`, as it acts on both sides alike: all of its forces together are 0.",
);
const TOUCHED_BODY: Key =
    Key::new("body", ValueType::Text, "the body on which a `touch` acts").default("`nodes`");
const NODES: Key = Key::new("nodes", ValueType::Nodes, "the nodes").required();
const SPOT: [Key; 3] = [
    Key::new("nodes", ValueType::Nodes, "the nodes").default("`inside` or `marker`"),
    Key::new(
        "inside",
        ValueType::Vector,
        "the undeformed position of a point of a body, which need not be a node",
    )
    .in_unit("m")
    .default("`nodes` or `marker`"),
    Key::new(
        "marker",
        ValueType::Table(&MARKER),
        "a point outside of the body that moves with some of its nodes",
    )
    .default("`nodes` or `inside`"),
];
const TURNED: Key =
    Key::new("nodes", ValueType::Nodes, "the nodes whose rotation is read, with equal weights")
        .default("the body");
const PLACES: Key = Key::new("nodes", ValueType::Nodes, "the nodes").default("`point`");
const POINT: Key =
    Key::new("point", ValueType::Vector, "the undeformed position of a point of the body")
        .in_unit("m")
        .default("`nodes`");
const UNIT: Key =
    Key::new("unit", ValueType::Word(|| vec!["rad", "deg"]), "the unit").default("rad");
const BODY: Key =
    Key::new("body", ValueType::Text, "the name of one of several bodies").default("all together");
const LINE: ValueType = ValueType::Array(&ValueType::Nodes, 2);

/// A sensor's name, and what it reads in `scene`.
pub(super) fn sensor(value: &Value, scene: &Scene) -> Result<(String, Reading), Error> {
    let table = value.table(&SENSOR)?;
    let name = table.required("name", Value::string)?;
    let mesh = scene.body().mesh();
    let nodes = || table.required("nodes", |value| selection(value, mesh));
    let named = |key: &str| table.required(key, Value::string);
    let ends = |key: &str| table.required(key, |value| line(value, mesh));
    let reading = match table.kind() {
        "position" => Reading::position(spot(&table, mesh)?),
        "displacement" => Reading::displacement(spot(&table, mesh)?),
        "velocity" => Reading::velocity(spot(&table, mesh)?),
        "acceleration" => Reading::acceleration(spot(&table, mesh)?),
        "constraint-force" => Reading::constraint_force(nodes()?),
        "constraint-moment" => {
            let vector = |value: &Value| value.vector(mesh.dimension());
            let about = table.required("about", vector)?;
            match table.optional("axis", vector)? {
                Some(axis) => Reading::constraint_torque(nodes()?, about, axis),
                None => Reading::constraint_moment(nodes()?, about),
            }
        }
        "contact-force" => contact(&table, mesh, Reading::contact_force, Reading::touch_force)?,
        "contact-area" => contact(&table, mesh, Reading::contact_area, Reading::touch_area)?,
        "contact-pressure" => {
            contact(&table, mesh, Reading::contact_pressure, Reading::touch_pressure)?
        }
        "gap" => Reading::gap(named("touch")?),
        "magnetic-moment" => Reading::magnetic_moment(),
        "fluid-force" => {
            of_nodes(&table, mesh, of_body(&table, Reading::fluid_force(named("fluid")?))?)?
        }
        "device" => device(&table, scene)?,
        "stress" => field(&table, mesh, Reading::stress, Reading::stress_at)?,
        "strain" => field(&table, mesh, Reading::strain, Reading::strain_at)?,
        "distance" => {
            let end = |key: &str| table.required(key, |value| selection(value, mesh));
            Reading::distance(end("from")?, end("to")?)
        }
        "angle" => in_unit(&table, Reading::angle(ends("from")?, ends("to")?))?,
        "centre-of-mass" => of_body(&table, Reading::centre_of_mass())?,
        "momentum" => of_body(&table, Reading::momentum())?,
        "angular-velocity" => turning(&table, mesh, Reading::angular_velocity())?,
        "angular-acceleration" => turning(&table, mesh, Reading::angular_acceleration())?,
        "accelerometer" => turning(&table, mesh, Reading::accelerometer())?,
        "gyroscope" => turning(&table, mesh, Reading::gyroscope())?,
        "rotation" => turning(&table, mesh, in_unit(&table, Reading::rotation())?)?,
        word => match OUTPUTS.iter().find(|output| output.word == word) {
            Some(output) => Reading::of(output, named(output.of.key)?),
            None => return Err(table.error("a kind that is not read")),
        },
    };
    let component = table.optional("component", |value| value.word(&Component::WORDS))?;
    let reading = match component {
        Some(component) => reading.component(component),
        None => reading,
    };
    let alone = Sampling::phase_ends().read(name, reading.clone());
    alone.check(scene).map_err(|error| table.blame(error))?;
    Ok((name.into(), reading))
}

/// An output of a device.
fn device(table: &Table, scene: &Scene) -> Result<Reading, Error> {
    let (name, word) =
        (table.required("device", Value::string)?, table.required("output", Value::string)?);
    let blame = |error| table.blame(error);
    let device = scene.device_number(name, "device").map_err(blame)?;
    let number = scene.output_number(device, word).map_err(blame)?;
    in_unit(table, Reading::device(name, &scene.devices()[device].outputs()[number]))
}

/// A place whose motion is read.
fn spot(table: &Table, mesh: &Mesh) -> Result<Spot, Error> {
    let vector = |value: &Value| value.vector(mesh.dimension());
    let marker = |value: &Value| {
        let marker = value.table(&MARKER)?;
        let nodes = marker.required("nodes", |value| selection(value, mesh))?;
        Ok(Spot::marker(nodes, marker.required("at", vector)?))
    };
    let nodes = table.optional("nodes", |value| selection(value, mesh))?.map(Spot::from);
    let inside = table.optional("inside", vector)?.map(Spot::inside);
    let mut given = [nodes, inside, table.optional("marker", marker)?].into_iter().flatten();
    match (given.next(), given.next()) {
        (Some(spot), None) => Ok(spot),
        (None, _) => Err(table.missing("nodes", "expected either nodes, inside or marker")),
        _ => Err(table.error("expected either nodes, inside or marker; found several of them")),
    }
}

/// How the nodes or the body of the table turn.
fn turning(table: &Table, mesh: &Mesh, reading: Reading) -> Result<Reading, Error> {
    of_nodes(table, mesh, of_body(table, reading)?)
}

/// The nodes of the table that are read, if there are any.
fn of_nodes(table: &Table, mesh: &Mesh, reading: Reading) -> Result<Reading, Error> {
    table.added(reading, "nodes", |value| selection(value, mesh), Reading::on)
}

/// Contact reading of an obstacle, or of bodies that touch.
fn contact(
    table: &Table,
    mesh: &Mesh,
    of_obstacle: fn(String) -> Reading,
    of_touch: fn(String) -> Reading,
) -> Result<Reading, Error> {
    let nodes = table.optional("nodes", |value| selection(value, mesh))?;
    let named = |key: &str| table.required(key, Value::string);
    let reading = match (table.optional("touch", Value::string)?, &nodes) {
        (Some(touch), Some(_)) => of_touch(touch.into()),
        (Some(touch), None) => of_touch(touch.into()).of_body(named("body")?),
        (None, _) => of_obstacle(named("obstacle")?.into()),
    };
    Ok(match nodes {
        Some(nodes) => reading.on(nodes),
        None => reading,
    })
}

/// An angle in the unit of the table.
fn in_unit(table: &Table, angle: Reading) -> Result<Reading, Error> {
    let in_degrees =
        table.optional("unit", |value| value.word(&[("rad", false), ("deg", true)]))?;
    Ok(if in_degrees == Some(true) { angle.in_degrees() } else { angle })
}

/// Reading of the body named in the table, or of all bodies.
fn of_body(table: &Table, reading: Reading) -> Result<Reading, Error> {
    table.added(reading, "body", Value::string, Reading::of_body)
}

/// The ends of a line.
fn line(value: &Value, mesh: &Mesh) -> Result<[Selection; 2], Error> {
    let ends = value.list_of("two ends", |end| selection(end, mesh))?;
    ends.try_into().map_err(|_| value.unexpected(number_of(2, "end")))
}

/// Strain or stress at nodes or a point.
fn field(
    table: &Table,
    mesh: &Mesh,
    at_nodes: fn(Selection) -> Reading,
    at_point: fn(Vec<f64>) -> Reading,
) -> Result<Reading, Error> {
    let nodes = table.optional("nodes", |value| selection(value, mesh))?;
    let point = table.optional("point", |value| value.vector(mesh.dimension()))?;
    match (nodes, point) {
        (Some(nodes), None) => Ok(at_nodes(nodes)),
        (None, Some(point)) => Ok(at_point(point)),
        (None, None) => Err(table.missing("nodes", "expected either nodes or point")),
        (Some(_), Some(_)) => Err(table.error("expected either nodes or point; found both")),
    }
}
