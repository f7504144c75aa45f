//! `mesh` of `[body]`: generators and files.

use super::table::Table;
use super::value::Value;
use crate::error::Error;
use crate::mesh::{Cells, Mesh, SolidCells};

#[derive(Clone, Copy)]
enum Kind {
    Bar,
    Rectangle,
    Ring,
    HalfRing,
    Cuboid,
    Gmsh,
}

const GRID: &[&str] = &["size", "nodes", "cells"];
const ROUND: &[&str] = &["inner", "outer", "nodes", "cells"];

/// The words for them, and their keys.
const KINDS: [(&str, Kind, &[&str]); 6] = [
    ("bar", Kind::Bar, &["length", "nodes"]),
    ("rectangle", Kind::Rectangle, GRID),
    ("ring", Kind::Ring, ROUND),
    ("half-ring", Kind::HalfRing, ROUND),
    ("cuboid", Kind::Cuboid, GRID),
    ("gmsh", Kind::Gmsh, &["file"]),
];

/// The mesh that `value` describes, in a space of `dimension` (default: its own).
pub(super) fn mesh(value: &Value, dimension: Option<&Value>) -> Result<Mesh, Error> {
    let (kind, table) = value.table_of_kind(&KINDS, &["origin"])?;
    let mesh = generate(kind, &table).map_err(|error| table.blame(error))?;
    let mesh = match dimension {
        Some(dimension) => placed(mesh, dimension)?,
        None => mesh,
    };
    let origin = table
        .optional("origin", "the place of the mesh (m)", |value| value.vector(mesh.dimension()))?;
    match origin {
        Some(origin) => mesh.translated(&origin).map_err(|error| table.blame(error)),
        None => Ok(mesh),
    }
}

fn generate(kind: Kind, table: &Table) -> Result<Mesh, Error> {
    Ok(match kind {
        Kind::Bar => Mesh::bar(
            table.required("length", "the length (m)", Value::number)?,
            table.required("nodes", "the number of nodes", Value::count)?,
        )?,
        Kind::Rectangle => Mesh::rectangle(
            table.required("size", "width and height (m)", Value::array)?,
            table.required("nodes", "corner nodes along x and y", Value::counts)?,
            table.required("cells", "how the grid is divided", cells)?,
        )?,
        Kind::Ring | Kind::HalfRing => {
            let inner = table.required("inner", "the inner radius (m)", Value::number)?;
            let outer = table.required("outer", "the outer radius (m)", Value::number)?;
            let meaning = "corner nodes around and along the radius";
            let nodes = table.required("nodes", meaning, Value::counts)?;
            let cells = table.required("cells", "how the grid is divided", cells)?;
            match kind {
                Kind::Ring => Mesh::ring(inner, outer, nodes, cells)?,
                _ => Mesh::half_ring(inner, outer, nodes, cells)?,
            }
        }
        Kind::Cuboid => Mesh::cuboid(
            table.required("size", "lengths along x, y and z (m)", Value::array)?,
            table.required("nodes", "corner nodes along x, y and z", Value::counts)?,
            table.required("cells", "how the grid is divided", solid_cells)?,
        )?,
        Kind::Gmsh => table.required("file", "the path of a Gmsh mesh", |value| {
            let file = value.source.beside(value.string()?);
            Mesh::read_gmsh(file).map_err(|error| value.error(error))
        })?,
    })
}

fn cells(value: &Value) -> Result<Cells, Error> {
    value.word(&Cells::ALL.map(|cells| (cells.name(), cells)))
}

fn solid_cells(value: &Value) -> Result<SolidCells, Error> {
    value.word(&[
        ("tetrahedra", SolidCells::Tetrahedra),
        ("hexahedra", SolidCells::Hexahedra),
        ("tetrahedra10", SolidCells::Tetrahedra10),
    ])
}

/// The mesh in a space of `dimension`: along its first axes, where the mesh has fewer of its own.
fn placed(mesh: Mesh, dimension: &Value) -> Result<Mesh, Error> {
    Ok(match (mesh.dimension(), dimension.count()?) {
        (own, wanted) if own == wanted => mesh,
        (1, 2) => mesh.mapped(|x| [x[0], 0.0])?,
        (1, 3) => mesh.mapped(|x| [x[0], 0.0, 0.0])?,
        (2, 3) => mesh.mapped(|x| [x[0], x[1], 0.0])?,
        (own, _) => {
            let allowed = ["1, 2 or 3", "2 or 3", "3"][own - 1];
            return Err(dimension.unexpected(format!("{allowed} for this mesh")));
        }
    })
}
