//! `[[tie]]`.

use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::timeline::Scene;

pub(super) const TIE: TableKeys = TableKeys::new(
    "[[tie]]",
    "Nodes of one body that are glued to another, whose mesh need not match: in all phases each moves with the point at which it is. Of \
     two surfaces either may be named: nodes of the finer one follow the coarser one, and those of a deformable one a rigid one.",
    &[
        Key::new("nodes", ValueType::Nodes, "the nodes").required(),
        Key::new("to", ValueType::Text, "the name of the body that they are glued to").required(),
    ],
    "[[tie]]\nnodes = \"tip/left\"\nto = \"base\"",
);

/// The scene with another tie.
pub(super) fn add_tie(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = value.table(&TIE)?;
    let nodes = table.required("nodes", |value| selection(value, scene.body().mesh()))?;
    let to = table.required("to", Value::string)?;
    let scene = scene.tie(nodes, to);
    scene.tied().map_err(|error| table.blame(error))?;
    Ok(scene)
}
