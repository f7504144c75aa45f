//! The keys of `[[phase]]` and of the tables in it.

use super::device::DRIVE;
use super::joint::MOTOR;
use super::keys::{Key, PERIOD, TIMES, TableKeys, ValueType};

pub(super) const PHASE: TableKeys = TableKeys::new(
    "[[phase]]",
    "A stretch of time with its own constraints, loads and contacts. Displacements and velocities carry over from \
     phase to phase. Times in it are those of the scene.",
    &[
        Key::new("name", ValueType::Text, "the name of the phase").default("phase 1, ..."),
        Key::number("until", "the end of the phase", "s").required(),
        Key::new("end", ValueType::Table(&END), "a sensor that ends the phase before")
            .default("at `until` alone"),
        Key::new("gravity", ValueType::Vector, "the acceleration of gravity in this phase")
            .in_unit("m/s^2")
            .default("that of the file"),
        part(&HOLD, "nodes that stay where they are"),
        part(&MOVE, "nodes that move on"),
        part(&PATH, "nodes that follow a path"),
        part(&ROTATE, "nodes that turn"),
        part(&SYMMETRY, "nodes on planes of symmetry"),
        part(&HOLD_COMBINATION, "sums of displacements that stay as they are"),
        part(&LOAD, "forces on nodes, tractions on faces"),
        part(&MOMENT, "moments on nodes"),
        part(&FOLLOWER, "forces and moments that turn with nodes"),
        part(&PRESSURE, "pressures in chambers"),
        part(&PRESSURE_ON, "pressures on faces"),
        part(&OPEN, "openings of orifices"),
        part(&FLOW, "flows of liquids into chambers"),
        part(&ACTUATE, "forces in springs and cables, stresses of muscles, strains of growth"),
        part(&DRIVE, "positions and moments of external magnets"),
        part(&MOTOR, "motors of joints"),
        part(&STEER, "inputs of devices, such as winds"),
        Key::new("magnetic_field", ValueType::Table(&MAGNETIC_FIELD), "the magnetic field"),
        Key::new(
            "contact",
            ValueType::Either(&[ValueType::Flag, ValueType::OneOrMore(&ValueType::Text)]),
            "the obstacles that act",
        )
        .note("All, none, or those of these names; if none, bodies do not touch each other either.")
        .default("true"),
        Key::new("touch", ValueType::Flag, "whether bodies touch each other")
            .default("as `contact` is not `false`"),
        Key::new(
            "project_velocity",
            ValueType::Flag,
            "whether the phase begins with velocities that its constraints allow",
        )
        .note("The removed kinetic energy is lost, as in a perfectly plastic impact.")
        .default("false"),
    ],
    "[[phase]]\nname = \"push\"\nuntil = 0.5\nhold = [{ nodes = \"bottom\" }]\ncontact = false",
);

pub(super) const END: TableKeys = TableKeys::new(
    "end",
    "A sensor that ends the phase as its reading passes a level, at `until` at the latest. One that begins beyond the level \
     does not count before it has been on the other side. The next phase begins at once, and ends at its own `until`; the last \
     phase has no such end.",
    &[
        Key::new("sensor", ValueType::Text, "the name of the sensor, of one with several columns that of the column: `tip.y`").required(),
        Key::number("above", "the level above which it rises, in the unit of the sensor", ""),
        Key::number("below", "the level below which it falls", ""),
    ],
    "[[sensor]]\nname = \"height\"\nkind = \"position\"\nnodes = \"top\"\ncomponent = \"y\"\n\n\
     [[phase]]\nuntil = 0.7\nend = { sensor = \"height\", below = 0.05 }\n\n\
     [[phase]]\nuntil = 1.0",
)
.one_of(&[&["above"], &["below"]]);

const fn part(keys: &'static TableKeys, meaning: &'static str) -> Key {
    Key::new(keys.name, ValueType::Tables(keys), meaning)
}

const NODES: Key = Key::new("nodes", ValueType::Nodes, "nodes").required();
const AXES: Key =
    Key::new("axes", ValueType::Axes, "the axes that are prescribed").default("all of them");
pub(super) const HOLD: TableKeys = TableKeys::new(
    "hold",
    "Nodes stay where they are when the phase begins.",
    &[
        NODES,
        AXES,
        Key::new(
            "rotation",
            ValueType::Flag,
            "whether the cross sections of rods at these nodes are held as well",
        )
        .note("A rod that is held without rotation turns freely, as in a ball joint.")
        .default("false"),
    ],
    "hold = [{ nodes = \"left\" }, { nodes = 3, axes = \"y\" }]",
);

pub(super) const MOVE: TableKeys = TableKeys::new(
    "move",
    "Nodes move on, with a constant velocity, from where they are when the phase begins.",
    &[
        NODES,
        AXES,
        Key::new("velocity", ValueType::Along, "the velocity").in_unit("m/s").required(),
    ],
    "move = [{ nodes = \"right\", velocity = [0.0, -0.16] }]",
);

pub(super) const PATH: TableKeys = TableKeys::new(
    "path",
    "Nodes run smoothly (a cubic spline) through points, and begin and end at rest; before and after they stay. Or they \
     follow a formula without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.",
    &[
        NODES,
        AXES,
        TIMES,
        Key::new(
            "displacements",
            ValueType::List(&ValueType::Along),
            "displacements from the undeformed position at these times",
        )
        .note("Not from where the nodes are when the phase begins: a path that begins elsewhere draws them there at once, which is warned of.")
        .in_unit("m"),
        Key::new(
            "displacement",
            ValueType::OneOrMore(&ValueType::Changing),
            "the displacement from the undeformed position, for each of the axes",
        )
        .in_unit("m"),
    ],
    "path = [\n\
     \x20   { nodes = \"right\", axes = \"x\", times = [0.0, 0.1, 0.3], displacements = [0.0, 0.01, 0.0] },\n\
     \x20   { nodes = \"left\", displacement = [\"0.01*sin(20*t)\", 0.0] },\n\
     ]",
)
.one_of(&[&["times", "displacements"], &["displacement"]]);

pub(super) const ROTATE: TableKeys = TableKeys::new(
    "rotate",
    "Nodes turn about a point (in space, an axis) from where they are when the phase begins: at a constant rate, or \
     smoothly (a cubic spline that begins and ends at rest) by what the angle has changed since then.",
    &[
        NODES,
        Key::new("centre", ValueType::Vector, "the point, or one of the axis").in_unit("m").required(),
        Key::new("axis", ValueType::Array(&ValueType::Number, 3), "the direction of the axis")
            .in_unit("1")
            .note("In space only; in the plane nodes turn counter-clockwise."),
        Key::number("rate", "the angular velocity", "rad/s"),
        TIMES,
        Key::new("angles", ValueType::List(&ValueType::Number), "angles at these times").in_unit("rad"),
    ],
    "rotate = [{ nodes = \"left\", centre = [0.0, 0.01], times = [0.0, 0.5], angles = [0.0, 1.5708] }]",
)
.one_of(&[&["rate"], &["times", "angles"]]);

pub(super) const SYMMETRY: TableKeys = TableKeys::new(
    "symmetry",
    "Nodes on a plane of symmetry keep their displacement along its normal, and slide freely in it. What is given \
     node by node there has to be halved: loads, point masses, springs, `stiffness` of obstacles.",
    &[
        NODES,
        Key::new("normal", ValueType::Vector, "the normal of the plane, of any length")
            .in_unit("1")
            .required(),
    ],
    "symmetry = [{ nodes = \"left\", normal = [1.0, 0.0] }]",
);

pub(super) const HOLD_COMBINATION: TableKeys = TableKeys::new(
    "hold_combination",
    "A row of constraints: the sum of displacements, each times a coefficient, keeps the value that it has when the phase \
     begins. Two nodes with 1 and -1 move alike along an axis.",
    &[Key::new("terms", ValueType::Tables(&TERMS), "the displacements").required()],
    "hold_combination = [{ terms = [\n\
     \x20   { node = 3, axis = \"x\", coefficient = 1.0 },\n\
     \x20   { node = 6, axis = \"x\", coefficient = -1.0 },\n\
     ] }]",
);

pub(super) const TERMS: TableKeys = TableKeys::new(
    "terms",
    "One displacement of a row.",
    &[
        Key::new("node", ValueType::Count, "the number of the node, from 1").required(),
        Key::new("axis", ValueType::Word(|| vec!["x", "y", "z"]), "the axis").required(),
        Key::number("coefficient", "the coefficient, other than 0", "1").required(),
    ],
    "hold_combination = [{ terms = [{ node = 3, axis = \"y\", coefficient = 1.0 }] }]",
);

pub(super) const LOAD: TableKeys = TableKeys::new(
    "load",
    "Forces on nodes, and tractions on the faces of the boundary (edges in the plane) between them. Those of tables are \
     interpolated linearly, and constant before and after. Directions stay as the body turns.",
    &[
        NODES,
        Key::new("force", ValueType::ChangingVector, "the force on each node").in_unit("N"),
        Key::new("total", ValueType::ChangingVector, "the force on all nodes together")
            .in_unit("N")
            .note("Spread evenly over the faces that the nodes make up; nodes without faces share it equally."),
        Key::new("traction", ValueType::ChangingVector, "the force per undeformed area of the faces")
            .in_unit("N/m^2"),
        Key::new("moment", ValueType::Either(&[ValueType::Changing, ValueType::ChangingVector]), "a moment as in `moment`, alone or with a force")
            .in_unit("N m"),
        TIMES,
        PERIOD,
        Key::new("forces", ValueType::List(&ValueType::Vector), "the force on each node at these times")
            .in_unit("N"),
        Key::new("totals", ValueType::List(&ValueType::Vector), "the force on all nodes at these times")
            .in_unit("N"),
        Key::new("tractions", ValueType::List(&ValueType::Vector), "the traction at these times")
            .in_unit("N/m^2"),
        Key::new("moments", ValueType::List(&ValueType::Vector), "moments at these times, with forces")
            .in_unit("N m"),
    ],
    "load = [\n\
     \x20   { nodes = \"right\", times = [0.0, 0.1], forces = [[0.0, 0.0], [0.0, -0.01]] },\n\
     \x20   { nodes = \"right\", traction = [0.0, \"-100*sin(20*t)\"] },\n\
     ]",
)
.one_of(&[
    &["force"],
    &["total"],
    &["moment"],
    &["force", "moment"],
    &["total", "moment"],
    &["traction"],
    &["times", "forces"],
    &["times", "totals"],
    &["times", "tractions"],
]);

pub(super) const MOMENT: TableKeys = TableKeys::new(
    "moment",
    "Moments on nodes together, whose direction stays: couples of forces on the nodes, which stay free to deform. The nodes may be those \
     of a rigid body. Moments of a table are interpolated linearly, and constant before and after.",
    &[
        NODES,
        Key::new("moment", ValueType::Either(&[ValueType::Changing, ValueType::ChangingVector]), "the moment")
            .in_unit("N m")
            .note("In the plane a number, counter-clockwise; in space a vector."),
        TIMES,
        PERIOD,
        Key::new("moments", ValueType::List(&ValueType::Vector), "moments at these times").in_unit("N m"),
    ],
    "moment = [{ nodes = \"right\", times = [0.0, 0.1], moments = [[0.0], [0.001]] }]",
)
.one_of(&[&["moment"], &["times", "moments"]]);

pub(super) const FOLLOWER: TableKeys = TableKeys::new(
    "follower",
    "Forces and moments on nodes together that turn with them, as the thrust of a jet at a tip: they are given for the undeformed \
     shape. Those of a table are interpolated linearly, and constant before and after.",
    &[
        NODES,
        Key::new("force", ValueType::ChangingVector, "the force on all nodes together").in_unit("N"),
        Key::new("moment", ValueType::Either(&[ValueType::Changing, ValueType::ChangingVector]), "the moment, in the plane a number")
            .in_unit("N m"),
        TIMES,
        PERIOD,
        Key::new("forces", ValueType::List(&ValueType::Vector), "forces at these times").in_unit("N"),
        Key::new("moments", ValueType::List(&ValueType::Vector), "moments at these times").in_unit("N m"),
    ],
    "follower = [{ nodes = \"right\", force = [\"-0.01*min(t/0.1, 1)\", 0.0] }]",
)
.one_of(&[&["force"], &["moment"], &["times", "forces"], &["times", "moments"]]);

pub(super) const PRESSURE: TableKeys = TableKeys::new(
    "pressure",
    "The pressure in a chamber, positive if it blows it up. That of a table is interpolated linearly, and is \
     constant before and after.",
    &[
        Key::new("chamber", ValueType::Text, "the name of a chamber").required(),
        VALUE,
        TIMES,
        PERIOD,
        VALUES,
    ],
    "pressure = [{ chamber = \"inside\", times = [0.0, 0.1], values = [0.0, 500.0] }]",
)
.one_of(&[&["value"], &["times", "values"]]);

const VALUE: Key = Key::new("value", ValueType::Changing, "the pressure").in_unit("Pa");
const VALUES: Key =
    Key::new("values", ValueType::List(&ValueType::Number), "pressures at these times")
        .in_unit("Pa");

pub(super) const PRESSURE_ON: TableKeys = TableKeys::new(
    "pressure_on",
    "A pressure on the faces of the boundary (edges in the plane) between nodes, positive if it presses onto the body. It \
     follows the body: it acts on the deformed area, along its normal.",
    &[NODES, VALUE, TIMES, PERIOD, VALUES],
    "pressure_on = [{ nodes = \"right\", value = \"500*sin(20*t)\" }]",
)
.one_of(&[&["value"], &["times", "values"]]);

pub(super) const OPEN: TableKeys = TableKeys::new(
    "open",
    "How far an orifice is open, from 0 (shut) to 1. The opening of a table is interpolated linearly, and is constant before and \
     after.",
    &[
        Key::new("orifice", ValueType::Text, "the name of an orifice").required(),
        Key::new("opening", ValueType::Changing, "how far it is open").in_unit("1"),
        TIMES,
        PERIOD,
        Key::new("openings", ValueType::List(&ValueType::Number), "openings at these times").in_unit("1"),
    ],
    "open = [{ orifice = \"valve\", times = [0.0, 0.1], openings = [0.0, 1.0] }]",
)
.one_of(&[&["opening"], &["times", "openings"]]);

pub(super) const FLOW: TableKeys = TableKeys::new(
    "flow",
    "How much liquid flows into a chamber, as from a syringe or a pump; below 0 it flows out. That of a table is interpolated linearly, and is \
     constant before and after.",
    &[
        Key::new("chamber", ValueType::Text, "the name of a chamber with a liquid").required(),
        Key::new("rate", ValueType::Changing, "the volume, without pressure, that flows in per time").in_unit("m^3/s"),
        TIMES,
        PERIOD,
        Key::new("rates", ValueType::List(&ValueType::Number), "rates at these times").in_unit("m^3/s"),
    ],
    "flow = [{ chamber = \"inside\", times = [0.0, 0.1], rates = [0.0, 1.0e-6] }]",
)
.one_of(&[&["rate"], &["times", "rates"]]);

pub(super) const ACTUATE: TableKeys = TableKeys::new(
    "actuate",
    "Forces of the actuators in springs, tensions of cables, lengths that winches have drawn in, stresses of muscles, strains of growth, and powers of what is heated. Those of a table are \
     interpolated linearly, and are constant before and after.",
    &[
        Key::new("springs", ValueType::OneOrMore(&ValueType::Text), "names of springs and cables"),
        Key::new("muscles", ValueType::OneOrMore(&ValueType::Text), "names of muscles"),
        Key::new("growths", ValueType::OneOrMore(&ValueType::Text), "names of growths"),
        Key::new("heated", ValueType::OneOrMore(&ValueType::Text), "names of springs, cables, muscles and growths that a `[[lag]]` heats"),
        Key::new("force", ValueType::Changing, "the force: of a spring positive if it extends, of a cable if it pulls").in_unit("N"),
        Key::new("length", ValueType::Changing, "of a winch: the length that it has drawn in").in_unit("m"),
        Key::new("stress", ValueType::Changing, "of a muscle: the force per section of the undeformed shape by which it pulls; below 0 it pushes")
            .in_unit("Pa"),
        Key::new("strain", ValueType::Changing, "of a growth: the strain of unconstrained cells; for thermal expansion the coefficient times the change of temperature")
            .in_unit("1"),
        Key::new("power", ValueType::Changing, "the heating power of each of them").in_unit("W"),
        TIMES,
        PERIOD,
        Key::new("forces", ValueType::List(&ValueType::Number), "forces at these times").in_unit("N"),
        Key::new("lengths", ValueType::List(&ValueType::Number), "lengths at these times").in_unit("m"),
        Key::new("strains", ValueType::List(&ValueType::Number), "strains at these times").in_unit("1"),
        Key::new("stresses", ValueType::List(&ValueType::Number), "stresses at these times").in_unit("Pa"),
        Key::new("powers", ValueType::List(&ValueType::Number), "powers at these times").in_unit("W"),
    ],
    "actuate = [{ springs = \"down\", times = [0.2, 0.3], forces = [0.0, -0.8] }]",
)
.one_of(&[
    &["springs", "force"],
    &["springs", "length"],
    &["springs", "times", "forces"],
    &["springs", "times", "lengths"],
    &["muscles", "stress"],
    &["muscles", "times", "stresses"],
    &["growths", "strain"],
    &["growths", "times", "strains"],
    &["heated", "power"],
    &["heated", "times", "powers"],
]);

pub(super) const STEER: TableKeys = TableKeys::new(
    "steer",
    "An input of a device by its word: the `velocity` of a `[[wind]]`. A number or a vector, as the input is. Values of a table are interpolated linearly, and are \
     constant before and after.",
    &[
        Key::new("device", ValueType::Text, "the name of the device").required(),
        Key::new("input", ValueType::Text, "the word of the input").required(),
        Key::new("value", ValueType::Either(&[ValueType::Changing, ValueType::ChangingVector]), "its value, in the unit of the input"),
        TIMES,
        PERIOD,
        Key::new(
            "values",
            ValueType::Either(&[ValueType::List(&ValueType::Number), ValueType::List(&ValueType::Vector)]),
            "its values at these times",
        ),
    ],
    "steer = [{ device = \"gust\", input = \"velocity\", value = [\"5*sin(3*t)\", 0.0] }]",
)
.one_of(&[&["value"], &["times", "values"]]);

pub(super) const MAGNETIC_FIELD: TableKeys = TableKeys::new(
    "magnetic_field",
    "The magnetic field that acts on the magnets: `field` everywhere, and `gradient` (x - `centre`) beside it. That of a table is interpolated linearly, and constant \
     before and after.",
    &[
        Key::new("field", ValueType::ChangingVector, "the field").in_unit("T"),
        TIMES,
        PERIOD,
        Key::new("fields", ValueType::List(&ValueType::Vector), "the field at these times").in_unit("T"),
        Key::new("gradient", ValueType::List(&ValueType::Vector), "rows of dB_i/dx_j, a symmetric matrix, in space without trace").in_unit("T/m"),
        Key::new("centre", ValueType::Vector, "where the gradient adds nothing").in_unit("m").default("the origin"),
    ],
    "magnetic_field = { field = [0.0, \"0.01*sin(20*t)\"] }",
)
.one_of(&[&["field"], &["times", "fields"]]);
