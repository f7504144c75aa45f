//! `[initial]`.

use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::timeline::{Scene, SceneState};

pub(super) const INITIAL: TableKeys = TableKeys::new(
    "[initial]",
    "How the body moves at first. What the first phase holds or moves takes its part of that, as by an impact. In \
     statics nothing moves, and the search begins at the displacements of a state `from`.",
    &[
        Key::new(
            "from",
            ValueType::Text,
            "the state that `pliant run` or `pliant static` has left of bodies with the same meshes: the directory, or its \
             `state.json`, relative to the scene file",
        )
        .note(
            "It gives all unknowns by the names of bodies, chambers, actuators and pipes: displacements, velocities, Maxwell \
             branches, masses of gas and liquid, lags, flow rates; what only one of both has is a warning. All else may \
             differ. Time begins anew, and with it signals and paths: an obstacle is where the scene has it at t = 0.",
        )
        .default("undeformed, at rest"),
        Key::new("velocity", ValueType::Vector, "the velocity of all nodes")
            .in_unit("m/s")
            .note("Not with a state `from` that has velocities.")
            .default("0"),
        Key::new(
            "spin",
            ValueType::OneOrMore(&ValueType::Number),
            "the angular velocity about the centre of mass, on top of that",
        )
        .in_unit("rad/s")
        .note("One number in the plane, counter-clockwise; three in space.")
        .default("0"),
        Key::new("nodes", ValueType::Tables(&OF_NODES), "nodes with velocities of their own instead"),
    ],
    "[initial]\nvelocity = [1.0, 5.0]\nspin = 6.3",
);

const OF_NODES: TableKeys = TableKeys::new(
    "initial.nodes",
    "Nodes with an initial velocity of their own.",
    &[
        Key::new("nodes", ValueType::Nodes, "nodes").required(),
        Key::new("velocity", ValueType::Vector, "their velocity").in_unit("m/s").required(),
    ],
    "[initial]\nnodes = [{ nodes = \"top\", velocity = [1.0, 0.0] }]",
);

/// The scene that starts as `value` says.
pub(super) fn add_initial(mut scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = value.table(&INITIAL)?;
    let dimension = scene.body().dimension();
    let mut moves = false;
    if let Some(value) = table.get("from") {
        let state = SceneState::read(value.source.beside(value.string()?));
        let state = state.map_err(|error| value.error(error))?;
        moves = state.bodies.iter().flat_map(|body| &body.velocities).any(|&v| v != 0.0);
        scene = scene.starting_from(&state);
        scene.initial_velocities().map_err(|error| value.error(error))?;
    }
    if let Some(velocity) = table.optional("velocity", |v| match moves {
        true => Err(v.error("in the state `from` the nodes move already: leave one of both out")),
        false => v.vector(dimension),
    })? {
        scene = scene.initial_velocity(move |_| velocity.clone());
    }
    if let Some(spin) = table.optional("spin", Value::one_or_more_numbers)? {
        scene = scene.spin(spin);
    }
    for part in table.tables("nodes", &OF_NODES)? {
        let nodes = part.required("nodes", |v| selection(v, scene.body().mesh()))?;
        let velocity = part.required("velocity", |v| v.vector(dimension))?;
        scene = scene.initial_velocity_of(nodes, velocity);
    }
    scene.initial_velocities().map_err(|error| table.blame(error))?;
    Ok(scene)
}
