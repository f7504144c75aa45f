//! Meshes that are listed in a scene file, node by node: those that programs hand over.

use super::keys::{Key, TableKeys, ValueType};
use super::table::Table;
use super::value::{Value, number_of};
use crate::dynamics::error::Error;
use crate::elements::mesh::{CellKind, Mesh, Selection};

pub(super) const KEYS: &[Key] = &[
    Key::new("positions", ValueType::List(&ValueType::Vector), "where each node is")
        .in_unit("m")
        .required(),
    Key::new(
        "cells",
        ValueType::Word(|| CellKind::ALL.iter().map(|kind| kind.word()).collect()),
        "the kind of the cells",
    )
    .required(),
    Key::new(
        "connectivity",
        ValueType::List(&ValueType::List(&ValueType::Count)),
        "the nodes of each cell, by number (from 1)",
    )
    .note("In the order of VTK: corners counter-clockwise, then the middles of edges.")
    .required(),
    Key::new("sets", ValueType::Tables(&SET), "sets of nodes with names"),
    Key::new("groups", ValueType::Tables(&GROUP), "groups of cells with names, for regions"),
];

const SET: TableKeys = TableKeys::new(
    "sets",
    "A set of nodes of a listed mesh.",
    &[
        Key::new("name", ValueType::Text, "the name of the set").required(),
        Key::new("nodes", ValueType::List(&ValueType::Count), "its nodes, by number (from 1)")
            .required(),
    ],
    "mesh = { kind = \"listed\", positions = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]], cells = \"triangles\", connectivity = [[1, 2, 3]], sets = [{ name = \"tip\", nodes = [2, 3] }] }",
);

const GROUP: TableKeys = TableKeys::new(
    "groups",
    "A group of cells of a listed mesh.",
    &[
        Key::new("name", ValueType::Text, "the name of the group").required(),
        Key::new("cells", ValueType::List(&ValueType::Count), "its cells, by number (from 1)")
            .required(),
    ],
    "mesh = { kind = \"listed\", positions = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]], cells = \"triangles\", connectivity = [[1, 2, 3]], groups = [{ name = \"stiff\", cells = [1] }] }",
);

/// Kinds of cells and their words.
fn kinds() -> Vec<(&'static str, CellKind)> {
    CellKind::ALL.iter().map(|kind| (kind.word(), *kind)).collect()
}

/// The mesh that `table` lists.
pub(super) fn listed(table: &Table) -> Result<Mesh, Error> {
    let mut dimension = None;
    let positions: Vec<Vec<f64>> = table.required("positions", |value| {
        value.list_of("positions", |node| {
            let position = node.numbers()?;
            let dimension = *dimension.get_or_insert(position.len());
            match position.len() == dimension {
                true => Ok(position),
                false => {
                    let needed = number_of(dimension, "number");
                    Err(node.unexpected(format!("{needed} as of the first node")))
                }
            }
        })
    })?;
    let kind = table.required("cells", |value| value.word(&kinds()))?;
    let connectivity = table.required("connectivity", |value| {
        value.list_of("cells", |cell| {
            let nodes = cell.list_of("numbers of nodes", number)?;
            match nodes.len() == kind.nodes() {
                true => Ok(nodes.into_iter().map(|node| node - 1).collect()),
                false => Err(cell.unexpected(number_of(kind.nodes(), "node"))),
            }
        })
    })?;
    let connectivity: Vec<Vec<usize>> = connectivity;
    let mut mesh =
        Mesh::new(dimension.unwrap_or(0), positions.concat(), kind, connectivity.concat())?;
    for set in table.tables("sets", &SET)? {
        let name = set.required("name", Value::string)?;
        let nodes = set.required("nodes", |value| value.list_of("numbers of nodes", number))?;
        mesh =
            mesh.name_nodes(name, Selection::Numbers(nodes)).map_err(|error| set.error(error))?;
    }
    for group in table.tables("groups", &GROUP)? {
        let name = group.required("name", Value::string)?;
        let cells = group.required("cells", |value| value.list_of("numbers of cells", number))?;
        mesh = mesh.name_cells(name, cells).map_err(|error| group.error(error))?;
    }
    Ok(mesh)
}

/// A number that counts from 1.
fn number(value: &Value) -> Result<usize, Error> {
    match value.count()? {
        0 => Err(value.unexpected("a number, 1 or above")),
        number => Ok(number),
    }
}
