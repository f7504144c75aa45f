//! `[[phase]]`.

use toml::de::DeValue;

use super::keys::{Holds, Key, TableKeys};
use super::selection::selection;
use super::table::Table;
use super::value::{Value, number_of};
use crate::constraint::Axis;
use crate::error::Error;
use crate::external::{Signal, TimeTable, VectorSignal};
use crate::input::InputError;
use crate::mesh::Selection;
use crate::scene::{LoadKind, Phase, Scene};
use crate::vector::norm;

pub(super) const PHASE: TableKeys = TableKeys::new(
    "[[phase]]",
    "A stretch of time with its own constraints, loads and contacts. Displacements and velocities carry over from \
     phase to phase. Times in it are those of the scene.",
    &[
        Key::new("name", Holds::Text, "the name of the phase").default("phase 1, ..."),
        Key::number("until", "the end of the phase", "s").required(),
        Key::new("gravity", Holds::Vector, "the acceleration of gravity in this phase")
            .in_unit("m/s^2")
            .default("that of the file"),
        part("hold", &HOLD, "nodes that stay where they are"),
        part("move", &MOVE, "nodes that move on"),
        part("path", &PATH, "nodes that follow a path"),
        part("rotate", &ROTATE, "nodes that turn"),
        part("symmetry", &SYMMETRY, "nodes on planes of symmetry"),
        part("load", &LOAD, "forces on nodes, tractions on faces"),
        part("pressure", &PRESSURE, "pressures in chambers"),
        part("pressure_on", &PRESSURE_ON, "pressures on faces"),
        part("actuate", &ACTUATE, "forces in springs"),
        Key::new(
            "contact",
            Holds::Either(&[Holds::Flag, Holds::OneOrMore(&Holds::Text)]),
            "the obstacles that act",
        )
        .law("All, none, or those of these names.")
        .default("true"),
        Key::new(
            "project_velocity",
            Holds::Flag,
            "whether the phase begins with velocities that its constraints allow",
        )
        .law("What is taken away is lost, as in a perfectly plastic impact.")
        .default("false"),
    ],
    "[[phase]]\nname = \"push\"\nuntil = 0.5\nhold = [{ nodes = \"bottom\" }]\ncontact = false",
);

const fn part(name: &'static str, keys: &'static TableKeys, meaning: &'static str) -> Key {
    Key::new(name, Holds::Tables(keys), meaning)
}

const NODES: Key = Key::new("nodes", Holds::Nodes, "nodes").required();
const AXES: Key =
    Key::new("axes", Holds::Axes, "the axes that are prescribed").default("all of them");
const TIMES: Key =
    Key::new("times", Holds::List(&Holds::Number), "times in ascending order").in_unit("s");

const HOLD: TableKeys = TableKeys::new(
    "hold",
    "Nodes stay where they are when the phase begins.",
    &[NODES, AXES],
    "hold = [{ nodes = \"left\" }, { nodes = 3, axes = \"y\" }]",
);

const MOVE: TableKeys = TableKeys::new(
    "move",
    "Nodes move on, with a constant velocity, from where they are when the phase begins.",
    &[NODES, AXES, Key::new("velocity", Holds::Along, "the velocity").in_unit("m/s").required()],
    "move = [{ nodes = \"right\", velocity = [0.0, -0.16] }]",
);

const PATH: TableKeys = TableKeys::new(
    "path",
    "Nodes run smoothly (a cubic spline) through points, and begin and end at rest; before and after they stay. Or they \
     follow a formula without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.",
    &[
        NODES,
        AXES,
        TIMES,
        Key::new(
            "displacements",
            Holds::List(&Holds::Along),
            "displacements from the natural position at these times",
        )
        .in_unit("m"),
        Key::new(
            "displacement",
            Holds::OneOrMore(&Holds::Changing),
            "the displacement from the natural position, for each of the axes",
        )
        .in_unit("m"),
    ],
    "path = [\n\
     \x20   { nodes = \"right\", axes = \"x\", times = [0.0, 0.1, 0.3], displacements = [0.0, 0.01, 0.0] },\n\
     \x20   { nodes = \"left\", displacement = [\"0.01*sin(20*t)\", 0.0] },\n\
     ]",
)
.one_of(&[&["times", "displacements"], &["displacement"]]);

const ROTATE: TableKeys = TableKeys::new(
    "rotate",
    "Nodes turn about a point (in space, an axis) from where they are when the phase begins: at a constant rate, or \
     smoothly (a cubic spline that begins and ends at rest) by what the angle has changed since then.",
    &[
        NODES,
        Key::new("centre", Holds::Vector, "the point, or one of the axis").in_unit("m").required(),
        Key::new("axis", Holds::Array(&Holds::Number, 3), "the direction of the axis")
            .in_unit("1")
            .law("In space only; in the plane nodes turn counter-clockwise."),
        Key::number("rate", "the angular velocity", "rad/s"),
        TIMES,
        Key::new("angles", Holds::List(&Holds::Number), "angles at these times").in_unit("rad"),
    ],
    "rotate = [{ nodes = \"left\", centre = [0.0, 0.01], times = [0.0, 0.5], angles = [0.0, 1.5708] }]",
)
.one_of(&[&["rate"], &["times", "angles"]]);

const SYMMETRY: TableKeys = TableKeys::new(
    "symmetry",
    "Nodes on a plane of symmetry keep their displacement along its normal, and slide freely in it. What is given \
     node by node there has to be halved: loads, point masses, springs, `stiffness` of obstacles.",
    &[
        NODES,
        Key::new("normal", Holds::Vector, "the normal of the plane, of any length")
            .in_unit("1")
            .required(),
    ],
    "symmetry = [{ nodes = \"left\", normal = [1.0, 0.0] }]",
);

const LOAD: TableKeys = TableKeys::new(
    "load",
    "Forces on nodes, and tractions on the faces of the boundary (edges in the plane) between them. Those of tables run \
     along straight lines, and are constant before and after. Directions stay as the body turns.",
    &[
        NODES,
        Key::new("force", Holds::ChangingVector, "the force on each node").in_unit("N"),
        Key::new("total", Holds::ChangingVector, "the force on all nodes together")
            .in_unit("N")
            .law("Spread evenly over the faces that the nodes make up; nodes without faces share it equally."),
        Key::new("traction", Holds::ChangingVector, "the force per natural area of the faces")
            .in_unit("N/m^2"),
        TIMES,
        Key::new("forces", Holds::List(&Holds::Vector), "the force on each node at these times")
            .in_unit("N"),
        Key::new("totals", Holds::List(&Holds::Vector), "the force on all nodes at these times")
            .in_unit("N"),
        Key::new("tractions", Holds::List(&Holds::Vector), "the traction at these times")
            .in_unit("N/m^2"),
    ],
    "load = [\n\
     \x20   { nodes = \"right\", times = [0.0, 0.1], forces = [[0.0, 0.0], [0.0, -0.01]] },\n\
     \x20   { nodes = \"right\", traction = [0.0, \"-100*sin(20*t)\"] },\n\
     ]",
)
.one_of(&[
    &["force"],
    &["total"],
    &["traction"],
    &["times", "forces"],
    &["times", "totals"],
    &["times", "tractions"],
]);

const PRESSURE: TableKeys = TableKeys::new(
    "pressure",
    "The pressure in a chamber, positive if it blows it up. That of a table runs along straight lines, and is \
     constant before and after.",
    &[
        Key::new("chamber", Holds::Text, "the name of a chamber").required(),
        VALUE,
        TIMES,
        VALUES,
    ],
    "pressure = [{ chamber = \"inside\", times = [0.0, 0.1], values = [0.0, 500.0] }]",
)
.one_of(&[&["value"], &["times", "values"]]);

const VALUE: Key = Key::new("value", Holds::Changing, "the pressure").in_unit("Pa");
const VALUES: Key =
    Key::new("values", Holds::List(&Holds::Number), "pressures at these times").in_unit("Pa");

const PRESSURE_ON: TableKeys = TableKeys::new(
    "pressure_on",
    "A pressure on the faces of the boundary (edges in the plane) between nodes, positive if it presses onto the body. It \
     follows the body: it acts on the deformed area, along its normal.",
    &[NODES, VALUE, TIMES, VALUES],
    "pressure_on = [{ nodes = \"right\", value = \"500*sin(20*t)\" }]",
)
.one_of(&[&["value"], &["times", "values"]]);

const ACTUATE: TableKeys = TableKeys::new(
    "actuate",
    "Forces of the actuators in springs. Those of a table run along straight lines, and \
     are constant before and after.",
    &[
        Key::new("springs", Holds::OneOrMore(&Holds::Text), "names of springs").required(),
        Key::new("force", Holds::Changing, "the force, positive if it extends").in_unit("N"),
        TIMES,
        Key::new("forces", Holds::List(&Holds::Number), "forces at these times").in_unit("N"),
    ],
    "actuate = [{ springs = \"down\", times = [0.2, 0.3], forces = [0.0, -0.8] }]",
)
.one_of(&[&["force"], &["times", "forces"]]);

/// Adds a table inside of a phase.
type Add = fn(Phase, &Table, &Scene) -> Result<Phase, Error>;

/// The tables inside of a phase: what they add.
const PARTS: [(&TableKeys, Add); 9] = [
    (&HOLD, hold),
    (&MOVE, moving),
    (&PATH, path),
    (&ROTATE, rotate),
    (&SYMMETRY, symmetry),
    (&LOAD, load),
    (&PRESSURE, pressure),
    (&PRESSURE_ON, pressure_on),
    (&ACTUATE, actuate),
];

/// The scene with the phase that `value` describes at its end.
pub(super) fn add_phase(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = value.table(&PHASE)?;
    let until = table.required("until", |value| {
        let until = value.number()?;
        check(&scene, &Phase::until(until)).map_err(|error| value.error(error))?;
        Ok(until)
    })?;
    let mut phase = Phase::until(until);
    if let Some(name) = table.optional("name", Value::string)? {
        phase = phase.named(name);
    }
    if let Some(value) = table.get("contact") {
        phase = contact(phase, &value, &scene)?;
    }
    let gravity = table.optional("gravity", |value| value.vector(scene.body().dimension()))?;
    if let Some(gravity) = gravity {
        phase = phase.gravity(gravity);
        check(&scene, &phase).map_err(|error| table.blame(error))?;
    }
    for (keys, add) in PARTS {
        let Some(value) = table.get(keys.name) else { continue };
        for part in value.tables(keys)? {
            phase = add(phase, &part, &scene)?;
            check(&scene, &phase).map_err(|error| part.blame(error))?;
        }
    }
    if table.optional("project_velocity", Value::flag)? == Some(true) {
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
    let formulas = table.optional("displacement", |value| {
        let formulas =
            value.one_or_more()?.iter().map(Value::formula).collect::<Result<Vec<_>, _>>()?;
        match formulas.len() == axes.len() {
            true => Ok(formulas),
            false => {
                let what = number_of(axes.len(), "component");
                Err(value.unexpected(format!("{what}, one per axis")))
            }
        }
    })?;
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

fn load(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let dimension = scene.body().dimension();
    let nodes = nodes(table, scene)?;
    for kind in LoadKind::ALL {
        let one = table.optional(kind.word(), |value| value.vector_signal(dimension))?;
        let many = table.optional(&format!("{}s", kind.word()), |value| {
            value.list_of("vectors, one per time", |vector| vector.vector(dimension))
        })?;
        let value = match (one, many) {
            (Some(value), _) => value,
            (None, Some(values)) => {
                let times = table.required("times", Value::numbers)?;
                VectorSignal::TimeTable(TimeTable::new(times, values))
            }
            (None, None) => continue,
        };
        return Ok(phase.loaded(nodes, kind, value));
    }
    Ok(phase) // one of them is there: the table's groups say so
}

fn pressure(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.chambers().iter().map(|chamber| chamber.name()).collect();
    let chamber = table.required("chamber", |v| named(v, &known))?;
    Ok(phase.pressure(chamber, course(table, "value", "values")?))
}

fn pressure_on(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let nodes = nodes(table, scene)?;
    Ok(phase.pressure_on(nodes, course(table, "value", "values")?))
}

fn actuate(phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let known: Vec<&str> = scene.springs().iter().map(|spring| spring.name()).collect();
    let springs = table.required("springs", |value| names(value, &known))?;
    Ok(phase.actuate(springs, course(table, "force", "forces")?))
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

/// `one` number or formula, or `times` and `many` numbers.
fn course(table: &Table, one: &str, many: &str) -> Result<Signal, Error> {
    Ok(match table.optional(one, Value::signal)? {
        Some(signal) => signal,
        None => Signal::table(
            table.required("times", Value::numbers)?,
            table.required(many, Value::numbers)?,
        ),
    })
}

fn nodes(table: &Table, scene: &Scene) -> Result<Selection, Error> {
    table.required("nodes", |value| selection(value, scene.body().mesh()))
}

/// The named axes; `None` stands for all.
fn axes(table: &Table, scene: &Scene) -> Result<Option<Vec<Axis>>, Error> {
    let known = [("x", Axis::X), ("y", Axis::Y), ("z", Axis::Z)];
    let known = &known[..scene.body().dimension()];
    table.optional("axes", |value| {
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
