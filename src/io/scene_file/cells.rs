//! Cells by a box, a group or their numbers.

use super::keys::{Key, ValueType};
use super::selection::{CORNERS, corners};
use super::table::Table;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::elements::body::CellSelection;
use crate::elements::mesh::Mesh;

pub(super) const BOX: Key = Key::new("box", ValueType::Corners, CORNERS).in_unit("m");
pub(super) const GROUP: Key = Key::new("group", ValueType::Text, "the name of a group of cells")
    .note("A physical group of Gmsh.");
pub(super) const CELLS: Key =
    Key::new("cells", ValueType::List(&ValueType::Count), "numbers of cells, from 1");

/// The cells that one of these keys of `table` selects, if any of them is there.
pub(super) fn cells(table: &Table, mesh: &Mesh) -> Result<Option<CellSelection>, Error> {
    let checked = |value: &Value, cells: CellSelection| match cells.cells(mesh) {
        Ok(_) => Ok(cells),
        Err(error) => Err(value.error(error)),
    };
    let group = table.optional("group", |value| checked(value, value.string()?.into()))?;
    let numbers = table.optional("cells", |value| {
        let numbers = value.list_of("cell numbers", Value::count)?;
        checked(value, CellSelection::Numbers(numbers))
    })?;
    let inside = table.optional("box", |value| {
        let [min, max] = corners(value, mesh)?;
        checked(value, CellSelection::Box { min, max })
    })?;
    let mut all = [group, numbers, inside].into_iter().flatten();
    let first = all.next();
    match all.next() {
        None => Ok(first),
        Some(_) => Err(table.error("expected one alone of box, group and cells")),
    }
}
