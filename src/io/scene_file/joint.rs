//! `[[joint]]`, and `motor` in phases.

use std::any::Any;

use super::course::course;
use super::device::device_name;
use super::keys::{Key, PERIOD, TIMES, TableKeys, ValueType};
use super::selection::selection;
use super::table::Table;
use super::value::{Value, named};
use crate::dynamics::error::Error;
use crate::elements::mesh::Selection;
use crate::scene::devices::{Joint, JointKind};
use crate::scene::timeline::{Device, Phase, Scene};
use toml::de::DeValue;

const KINDS: [(&str, JointKind); 6] = [
    ("spherical", JointKind::Spherical),
    ("revolute", JointKind::Revolute),
    ("prismatic", JointKind::Prismatic),
    ("fixed", JointKind::Fixed),
    ("screw", JointKind::Screw),
    ("universal", JointKind::Universal),
];

fn kinds() -> Vec<&'static str> {
    KINDS.iter().map(|(word, _)| *word).collect()
}

pub(super) const JOINT: TableKeys = TableKeys::new(
    "[[joint]]",
    "A joint between two sides: rigid bodies or inserts, cross sections of rods, faces of solids, or the world. `spherical` keeps the place of both together, \
     `revolute` an axis through it as well (in the plane it is a pin), `prismatic` lets the second side slide along an axis of the first without turning, `fixed` \
     lets nothing move, `screw` turns along an axis of the world with a `lead`, `universal` has a cross of two axes. Along the angle or the displacement of the second side from the first act a spring, damping, friction, stops and a motor, \
     which phases command by `motor`.",
    &[
        Key::new("name", ValueType::Text, "the name of the joint").default("joint 1, joint 2, ..."),
        Key::new("kind", ValueType::Word(kinds), "its kind").required(),
        Key::new("between", ValueType::Array(&ValueType::Nodes, 2), "the two sides")
            .note("The name of a rigid body, a node on the axis of a rod, nodes of a face, or `world`, which is fixed in space.")
            .required(),
        Key::vector("at", "its place in the undeformed shape", "m").required(),
        Key::vector("axis", "its axis, of a hinge in space, of a slider and of a screw; of a universal joint that of the cross in the first side", "1"),
        Key::vector("second_axis", "the axis of the cross of a universal joint in the second side", "1"),
        Key::number("lead", "the displacement of a screw per turn; negative for a left-handed thread", "m"),
        Key::number("bearing_stiffness", "the stiffness of a thread, of a cross, or of a guide between two bodies, by which these hold", "N m/rad or N/m"),
        Key::number("bearing_damping", "their damping", "N m s or N s/m").default("0"),
        Key::new("gear", ValueType::Table(&GEAR), "teeth that couple it with another joint"),
        Key::number("stiffness", "the stiffness of the spring along it", "N m/rad or N/m").default("0"),
        Key::number("rest", "the angle or displacement at which the spring is relaxed", "rad or m").default("0"),
        Key::number("damping", "the damping along it", "N m s or N s/m").default("0"),
        Key::new("stops", ValueType::Array(&ValueType::Number, 2), "the lowest and the highest angle or displacement").in_unit("rad or m"),
        Key::number("stop_stiffness", "the stiffness behind the stops", "N m/rad or N/m"),
        Key::number("friction", "the torque or force of Coulomb's friction", "N m or N").default("0"),
        Key::number("sticking_speed", "the speed below which it creeps instead of sticking", "rad/s or m/s")
            .default("0.1 rad/s, 0.001 m/s"),
        Key::number("servo_stiffness", "the torque or force of a servo per difference from its target", "N m/rad or N/m").default("0"),
        Key::number("servo_damping", "its torque or force per difference from the target speed", "N m s or N s/m").default("0"),
        Key::number("motor_limit", "the largest torque or force of the motor, at rest", "N m or N").default("none"),
        Key::number("no_load_speed", "the speed at which the limit has fallen to 0, linearly", "rad/s or m/s").default("none"),
    ],
    "[[joint]]\nname = \"hip\"\nkind = \"revolute\"\nbetween = [\"world\", \"left\"]\nat = [0.0, 0.05]\nservo_stiffness = 2.0\nservo_damping = 0.05",
);

pub(super) const MOTOR: TableKeys = TableKeys::new(
    "motor",
    "What the motor of a `[[joint]]` does in this phase: a torque (of a prismatic joint a force) on the second side, or the angle (displacement) or the speed to which its servo \
     leads. Values of a table are interpolated linearly, and are constant before and after.",
    &[
        Key::new("joint", ValueType::Text, "the name of the joint").required(),
        Key::new("torque", ValueType::Changing, "the torque").in_unit("N m"),
        Key::new("angle", ValueType::Changing, "the angle of the servo").in_unit("rad"),
        Key::new("speed", ValueType::Changing, "the speed of the servo").in_unit("rad/s or m/s"),
        Key::new("force", ValueType::Changing, "the force").in_unit("N"),
        Key::new("displacement", ValueType::Changing, "the displacement of the servo").in_unit("m"),
        TIMES,
        PERIOD,
        Key::new("torques", ValueType::List(&ValueType::Number), "torques at these times").in_unit("N m"),
        Key::new("angles", ValueType::List(&ValueType::Number), "angles at these times").in_unit("rad"),
        Key::new("speeds", ValueType::List(&ValueType::Number), "speeds at these times").in_unit("rad/s or m/s"),
        Key::new("forces", ValueType::List(&ValueType::Number), "forces at these times").in_unit("N"),
        Key::new("displacements", ValueType::List(&ValueType::Number), "displacements at these times").in_unit("m"),
    ],
    "motor = [{ joint = \"hip\", angle = \"0.5*sin(3*t)\" }]",
)
.one_of(&[
    &["torque"],
    &["angle"],
    &["speed"],
    &["force"],
    &["displacement"],
    &["times", "torques"],
    &["times", "angles"],
    &["times", "speeds"],
    &["times", "forces"],
    &["times", "displacements"],
]);

pub(super) const GEAR: TableKeys = TableKeys::new(
    "gear",
    "Teeth, a belt, a rack or a spindle between an earlier revolute joint of the file and this one.",
    &[
        Key::new("joint", ValueType::Text, "the name of that joint").required(),
        Key::new("teeth", ValueType::Array(&ValueType::Number, 2), "the teeth of the wheels on that joint and on this one")
            .note("The wheels turn in opposite directions; with a negative number (a ring gear or a belt) in the same one."),
        Key::number("lead", "the displacement of this sliding joint per turn of the other", "m"),
        Key::number("stiffness", "the stiffness of the teeth at this joint", "N m/rad or N/m").required(),
        Key::number("damping", "their damping", "N m s or N s/m").default("0"),
    ],
    "[[joint]]\nname = \"motor\"\nkind = \"revolute\"\nbetween = [\"world\", \"left\"]\nat = [0.0, 0.05]\n\n\
     [[joint]]\nname = \"wheel\"\nkind = \"revolute\"\nbetween = [\"world\", \"right\"]\nat = [0.1, 0.05]\n\
     gear = { joint = \"motor\", teeth = [12, 60], stiffness = 1.0e3 }",
)
.one_of(&[&["teeth"], &["lead"]]);

/// The joint, geared to an earlier one as `value` says.
fn geared(joint: Joint, value: &Value, scene: &Scene) -> Result<Joint, Error> {
    let table = &value.table(&GEAR)?;
    let joints = scene.devices().iter().filter_map(|device| {
        let device: &dyn Any = &**device;
        device.downcast_ref::<Joint>()
    });
    let joints: Vec<&Joint> = joints.collect();
    let known: Vec<&str> = joints.iter().map(|joint| joint.name()).collect();
    let name = table.required("joint", |value| named(value, &known))?;
    let Some(other) = joints.into_iter().find(|joint| joint.name() == name) else {
        return Ok(joint);
    };
    let stiffness = table.required("stiffness", Value::number)?;
    let damping = table.optional("damping", Value::number)?.unwrap_or_default();
    if let Some(lead) = table.optional("lead", Value::number)? {
        return Ok(joint.driven(other, lead, stiffness, damping));
    }
    let whole =
        |number: f64| (number.fract() == 0.0 && number.abs() < 1e6).then_some(number as i32);
    let teeth = table.required("teeth", |value| {
        let teeth: [f64; 2] = value.array()?;
        let [a, b] = teeth.map(whole);
        a.zip(b).ok_or_else(|| value.unexpected("two whole numbers"))
    })?;
    Ok(joint.geared(other, teeth.into(), stiffness, damping))
}

/// The scene with the joint that `value` describes.
pub(super) fn add_joint(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&JOINT)?;
    let name = device_name(table, &scene, "joint", "joint")?;
    let kind = table.required("kind", |value| value.word(&KINDS))?;
    let side = |value: &Value| match value.value {
        DeValue::String(name) if name == "world" || scene.body().name() == Some(name) => {
            Ok(Selection::Set(name.to_string()))
        }
        _ => selection(value, scene.body().mesh()),
    };
    let between: [Selection; 2] = table.required("between", |value| {
        let sides = value.list()?.iter().map(side).collect::<Result<Vec<_>, _>>()?;
        sides.try_into().map_err(|_| value.unexpected("two sides"))
    })?;
    let dimension = scene.body().dimension();
    let vector = |value: &Value| value.vector(dimension);
    let mut joint = Joint::new(kind, name, between, table.required("at", vector)?);
    joint = table.added(joint, "axis", vector, Joint::axis)?;
    joint = table.added(joint, "second_axis", vector, Joint::second_axis)?;
    joint = table.added(joint, "lead", Value::number, Joint::lead)?;
    let number = |key: &str| table.optional(key, Value::number);
    let damping = number("bearing_damping")?.unwrap_or_default();
    joint = table
        .added(joint, "bearing_stiffness", Value::number, |joint, k| joint.bearing(k, damping))?;
    if let Some(value) = table.get("gear") {
        joint = geared(joint, &value, &scene)?;
    }
    let rest = number("rest")?.unwrap_or_default();
    joint = table.added(joint, "stiffness", Value::number, |joint, k| joint.spring(k, rest))?;
    joint = table.added(joint, "damping", Value::number, Joint::damping)?;
    if let Some(stops) = table.optional("stops", Value::array)? {
        joint = joint.stops(stops, table.required("stop_stiffness", Value::number)?);
    }
    let speed = number("sticking_speed")?;
    joint =
        table.added(joint, "friction", Value::number, |joint, most| joint.friction(most, speed))?;
    let [stiffness, damping] = [number("servo_stiffness")?, number("servo_damping")?];
    joint = joint.servo(stiffness.unwrap_or_default(), damping.unwrap_or_default());
    joint = table.added(joint, "motor_limit", Value::number, Joint::limit)?;
    joint = table.added(joint, "no_load_speed", Value::number, Joint::no_load_speed)?;
    for (key, other) in [
        ("rest", "stiffness"),
        ("stop_stiffness", "stops"),
        ("sticking_speed", "friction"),
        ("bearing_damping", "bearing_stiffness"),
    ] {
        if let (Some(value), None) = (table.get(key), table.get(other)) {
            return Err(
                value.error(format!("it does nothing without {other}: give that, or leave it out"))
            );
        }
    }
    joint.check(scene.body()).map_err(|error| table.blame(error))?;
    let scene = scene.joint(joint);
    scene.check_last_device_undriven().map_err(|error| table.blame(error))?;
    Ok(scene)
}

/// The phase with the motor of a joint.
pub(super) fn motor(mut phase: Phase, table: &Table, scene: &Scene) -> Result<Phase, Error> {
    let joints = scene.devices().iter().filter(|device| device.kind() == "joint");
    let known: Vec<&str> = joints.clone().map(|device| device.name()).collect();
    let name = table.required("joint", |value| named(value, &known))?;
    let given = |word: &str| table.get(word).or_else(|| table.get(&format!("{word}s"))).is_some();
    let words = ["torque", "angle", "speed", "force", "displacement"];
    for word in words.into_iter().filter(|word| given(word)) {
        let input = scene.device_row(&name, word).map_err(|error| table.blame(error))?;
        let value = course(table, phase.end(), word)?;
        phase = phase.device_input(&*name, input, value);
    }
    Ok(phase)
}
