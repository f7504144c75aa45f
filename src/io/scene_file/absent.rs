//! Tables that scene files do not have, and their alternatives.

/// By the names that users may try: the missing feature, and its alternative, in words.
const ABSENT: [(&[&str], &str); 8] = [
    (
        &["bodies"],
        "several bodies are a list of tables [[body]], each with a name, a mesh and a material; one of a material with \
         rigid = true is rigid; a rigid shape that stands or follows a path is an [[obstacle]]",
    ),
    (
        &["contact", "contacts", "self_contact", "collision", "collisions"],
        "contact of bodies with each other and with themselves is [[touch]]; rigid shapes, which stand or follow a path, are each an \
         [[obstacle]], among which a phase chooses by contact = [...]",
    ),
    (
        &["friction"],
        "friction is a key of what the body slides on: friction_coefficient in [[obstacle]]",
    ),
    (
        &["rigid", "rigid_body", "rigid_bodies", "wall", "floor", "ground", "gripper", "tool"],
        "a rigid body that forces move is a [[body]] with rigid = true in its material, and a rigid part of a soft one a [[body.region]] with that; a \
         rigid shape that stands or follows a path is an [[obstacle]]; nodes are held, moved or turned by a phase (hold, move, path, rotate)",
    ),
    (
        &["cables", "rope", "tendon", "tendons", "string", "wire", "winch"],
        "a cable is a [[cable]] along a path of nodes and points, driven by a tension or by a winch (winch = true) through actuate of a phase",
    ),
    (
        &["joints", "hinge", "pin", "bearing", "slider", "constraint", "constraints"],
        "a pin, a hinge, a ball joint or a guide between bodies, rods and the world is a [[joint]], with motors, stops and friction; a phase holds, moves and turns \
         nodes (hold, axes, move, path, rotate, symmetry) and ties displacements by hold_combination, and two nodes may have a stiff [[spring]] between them",
    ),
    (
        &[
            "air",
            "water",
            "drag",
            "buoyancy",
            "current",
            "pressure",
            "pump",
            "valve",
            "syringe",
            "tube",
            "hydraulics",
        ],
        "what surrounds bodies, with its drag and its pressure by depth, is a [[fluid]]; a phase gives the pressure in a [[chamber]] over time (pressure = [...]), or \
         there is [[gas]] in it, which flows through an [[orifice]] from a [[supply]], or a [[liquid]], of which a phase lets flow = [...] in, and which a [[pipe]] leads to another chamber",
    ),
    (
        &["motor", "servo", "actuator", "actuators"],
        "a motor is part of a [[joint]], and motor in a phase commands it; what else acts is a force along a [[spring]], the stress of a [[muscle]] or the strain of a [[growth]] (actuate in a phase), a pressure in a [[chamber]], a load, or nodes \
         that follow a path",
    ),
];

/// Replacement for the table `name` of the file, if it is one that does not exist for a reason.
pub(super) fn stand_in(name: &str) -> Option<&'static str> {
    ABSENT.iter().find(|(names, _)| names.contains(&name)).map(|(_, words)| *words)
}
