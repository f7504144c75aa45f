//! Node selections, wherever `nodes` stands.

use toml::de::DeValue;

use super::keys::{Key, Meaning, TableKeys, ValueType};
use super::value::{Value, number_of};
use crate::dynamics::error::Error;
use crate::elements::mesh::{Mesh, Selection};

/// The nodes that a value names: a set, a number or a list of them, or a box. All of them are nodes
/// of `mesh`.
pub(super) fn selection(value: &Value, mesh: &Mesh) -> Result<Selection, Error> {
    let selection = match value.value {
        DeValue::String(name) => match (mesh.sets().contains_key(&**name), one_of(name, mesh)) {
            (true, _) => Selection::Set(name.to_string()),
            (false, Some((nodes, number))) => {
                match number.checked_sub(1).and_then(|k| nodes.get(k)) {
                    Some(node) => Selection::Numbers(vec![node + 1]),
                    None => {
                        return Err(value.unexpected(format!(
                            "one of the nodes 1 to {} of the set",
                            nodes.len()
                        )));
                    }
                }
            }
            (false, None) => {
                let known: Vec<&str> = mesh.sets().keys().map(String::as_str).collect();
                return Err(value.unknown(name, &known));
            }
        },
        DeValue::Integer(_) | DeValue::Array(_) => {
            let numbers = value.one_or_more()?.into_iter().map(number);
            Selection::Numbers(numbers.collect::<Result<_, Error>>()?)
        }
        DeValue::Table(_) => {
            let table = value.table(&BOX)?;
            let [min, max] = table.required("box", |value| corners(value, mesh))?;
            Selection::Box { min, max }
        }
        _ => {
            return Err(value.unexpected("a set name, node numbers, or { box = [[..], [..]] }"));
        }
    };
    match mesh.select(&selection) {
        Ok(_) => Ok(selection),
        Err(error) => Err(value.error(error)),
    }
}

/// The set and the number in a name as `top/3`, one node of a set in its order, from 1.
fn one_of<'a>(name: &str, mesh: &'a Mesh) -> Option<(&'a [usize], usize)> {
    let (set, number) = name.rsplit_once('/')?;
    Some((mesh.sets().get(set)?, number.parse().ok()?))
}

fn number(value: Value) -> Result<usize, Error> {
    match value.value {
        DeValue::String(name) => Err(value.error(format!(
            "a list holds node numbers: name the set alone, \"{name}\", without a list around it"
        ))),
        _ => {
            let meaning = Meaning { text: "the number of a node, from 1", unit: "" };
            Value { meaning, ..value }.count()
        }
    }
}

/// The nodes in a box.
pub(super) const BOX: TableKeys = TableKeys::new(
    "box",
    "All nodes within a box.",
    &[Key::new("box", ValueType::Corners, CORNERS).in_unit("m").required()],
    "hold = [{ nodes = { box = [[0.0, 0.0], [0.1, 0.02]] } }]",
);

/// Description of the two corners of a box.
pub(super) const CORNERS: &str = "the lower and the upper corner";

/// The two corners of a box.
pub(super) fn corners(value: &Value, mesh: &Mesh) -> Result<[Vec<f64>; 2], Error> {
    let corners =
        value.list_of("two corners", |corner| corner.list_of("numbers", Value::number))?;
    let dimension = mesh.dimension();
    let fits = |corner: &Vec<f64>| {
        corner.len() == dimension && !corner.iter().any(|number| number.is_nan())
    };
    match <[Vec<f64>; 2]>::try_from(corners) {
        Ok(corners) if corners.iter().all(fits) => Ok(corners),
        _ => {
            let numbers = number_of(dimension, "number");
            Err(value.unexpected(format!("[min, max], two corners of {numbers} each")))
        }
    }
}
