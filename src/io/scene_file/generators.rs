//! Generators and files of meshes in scene files, one row for each: its word, its keys and how they are read.

use super::keys::{AUTO, Key, Kind, ValueType};
use super::listed::{self, listed};
use super::table::Table;
use super::value::Value;
use crate::base::input::{InputError, positive};
use crate::dynamics::error::Error;
use crate::elements::mesh::{Cells, Mesh, SolidCells};

/// A word of `kind` in the table `mesh`.
struct Generator {
    kind: Kind,
    /// The mesh of a table of this kind, in the space of the dimension that the body asks for, with the cells of `auto`.
    read: fn(&Table<'_>, Option<&Value>, AutoCells) -> Result<Mesh, Error>,
}

static GENERATORS: [Generator; 8] = [
    Generator {
        kind: Kind {
            word: "bar",
            about: "segments along x",
            keys: &[
                Key::number("length", "the length", "m").required(),
                Key::new("nodes", ValueType::Count, "the number of nodes").required(),
            ],
        },
        read: |table, _, _| {
            let length = table.required("length", Value::number)?;
            Ok(Mesh::bar(length, table.required("nodes", Value::count)?)?)
        },
    },
    Generator {
        kind: Kind {
            word: "rectangle",
            about: "a grid along x and y",
            keys: &[SIZE, NODES, CELLS, grading(2)],
        },
        read: |table, _, auto| {
            Ok(Mesh::graded_rectangle(
                table.required("size", Value::array)?,
                table.required("nodes", Value::counts)?,
                table.optional("grading", Value::array)?.unwrap_or([1.0; 2]),
                table.required("cells", |value| value.word(&plane_cells(auto)))?,
            )?)
        },
    },
    Generator {
        kind: Kind { word: "ring", about: "a grid around a circle", keys: ROUND },
        read: |table, _, auto| round(table, auto, Mesh::ring),
    },
    Generator {
        kind: Kind { word: "half-ring", about: "its upper half", keys: ROUND },
        read: |table, _, auto| round(table, auto, Mesh::half_ring),
    },
    Generator {
        kind: Kind {
            word: "cuboid",
            about: "a grid along x, y and z",
            keys: &[
                Key::new(
                    "size",
                    ValueType::Array(&ValueType::Number, 3),
                    "lengths along x, y and z",
                )
                .in_unit("m")
                .required(),
                Key::new(
                    "nodes",
                    ValueType::Array(&ValueType::Count, 3),
                    "corner nodes along x, y and z",
                )
                .required(),
                Key::new(
                    "cells",
                    ValueType::Word(|| words(&solid_cells(AutoCells::default()))),
                    "how the grid is divided",
                )
                .note(
                    "`auto` is `tetrahedra10`, quadratic; for a Poisson's ratio of 0.45 or more it is `hexahedra27` with \
                     `dilatation = \"linear\"`, as of silicone.",
                )
                .required(),
                grading(3),
            ],
        },
        read: |table, _, auto| {
            Ok(Mesh::graded_cuboid(
                table.required("size", Value::array)?,
                table.required("nodes", Value::counts)?,
                table.optional("grading", Value::array)?.unwrap_or([1.0; 3]),
                table.required("cells", |value| value.word(&solid_cells(auto)))?,
            )?)
        },
    },
    Generator {
        kind: Kind {
            word: "gmsh",
            about: "a file of Gmsh, of version 4.1 or 2.2; coordinates are metres",
            keys: &[Key::new(
                "file",
                ValueType::Text,
                "the path of a Gmsh mesh, relative to the scene file",
            )
            .required()],
        },
        read: |table, dimension, _| {
            table.required("file", |value| {
                let file = value.source.beside(value.string()?);
                let mesh = match dimension {
                    Some(dimension) => Mesh::read_gmsh_in(file, dimension.count()?),
                    None => Mesh::read_gmsh(file),
                };
                mesh.map_err(|error| value.error(error))
            })
        },
    },
    Generator {
        kind: Kind {
            word: "surface",
            about: "the closed surface of a rigid solid, of triangles: a file STL (text or binary), OBJ or Gmsh",
            keys: &[
                Key::new(
                    "file",
                    ValueType::Text,
                    "the path of a file .stl, .obj or .msh, relative to the scene file",
                )
                .required(),
                Key::number("scale", "the length of which the coordinates are multiples", "m")
                    .note("0.001 of a drawing in millimetres.")
                    .default("1"),
            ],
        },
        read: |table, _, _| {
            let mesh = table.required("file", |value| {
                let file = value.source.beside(value.string()?);
                Mesh::read_surface(file).map_err(|error| value.error(error))
            })?;
            let Some(scale) = table.optional("scale", Value::number)? else { return Ok(mesh) };
            positive("scale", scale, "m").map_err(|error| table.blame(error))?;
            Ok(mesh.mapped(|x| [0, 1, 2].map(|i| scale * x[i]))?)
        },
    },
    Generator {
        kind: Kind {
            word: "listed",
            about: "node by node, as programs hand meshes over",
            keys: listed::KEYS,
        },
        read: |table, _, _| listed(table),
    },
];

/// The words of `kind` with their keys.
pub(super) const KINDS: [Kind; GENERATORS.len()] = {
    let mut kinds = [GENERATORS[0].kind; GENERATORS.len()];
    let mut number = 1;
    while number < GENERATORS.len() {
        kinds[number] = GENERATORS[number].kind;
        number += 1;
    }
    kinds
};

/// The mesh of `table`, in a space of `dimension` (default: its own).
pub(super) fn generate(
    table: &Table<'_>,
    dimension: Option<&Value>,
    auto: AutoCells,
) -> Result<Mesh, Error> {
    let generator = GENERATORS.iter().find(|generator| generator.kind.word == table.kind());
    (generator.unwrap_or(&GENERATORS[0]).read)(table, dimension, auto)
}

/// A mesh around a circle.
fn round(
    table: &Table<'_>,
    auto: AutoCells,
    make: fn(f64, f64, [usize; 2], Cells) -> Result<Mesh, InputError>,
) -> Result<Mesh, Error> {
    let [inner, outer] = ["inner", "outer"].map(|key| table.required(key, Value::number));
    let nodes = table.required("nodes", Value::counts)?;
    let cells = table.required("cells", |value| value.word(&plane_cells(auto)))?;
    Ok(make(inner?, outer?, nodes, cells)?)
}

const SIZE: Key = Key::new("size", ValueType::Array(&ValueType::Number, 2), "width and height")
    .in_unit("m")
    .required();
const NODES: Key =
    Key::new("nodes", ValueType::Array(&ValueType::Count, 2), "corner nodes along x and y")
        .required();
const CELLS: Key = Key::new(
    "cells",
    ValueType::Word(|| words(&plane_cells(AutoCells::default()))),
    "how the grid is divided",
)
.note("Linear `triangles` are too stiff in bending, `crossed` ones less so; `triangles6`, quadratic, bend well, and \
      `auto` is those; for a Poisson's ratio of 0.45 or more in plane strain it is `rectangles9` with `dilatation = \"linear\"`, \
      as of silicone.")
.required();
const fn grading(axes: usize) -> Key {
    let about = "the length of the last cell along each axis by that of the first one";
    Key::new("grading", ValueType::Array(&ValueType::Number, axes), about)
        .in_unit("1")
        .note("Within 1e-4 and 1e4; each cell is longer than the one before it by the same factor. Put the fine end where \
              stress is: a clamp on the left asks for a number above 1.")
        .default("1 along each axis: equal cells")
}
const ROUND: &[Key] = &[
    Key::number("inner", "the inner radius", "m").required(),
    Key::number("outer", "the outer radius", "m").required(),
    Key::new(
        "nodes",
        ValueType::Array(&ValueType::Count, 2),
        "corner nodes around and along the radius",
    )
    .required(),
    CELLS,
];

/// Cells chosen by `auto`, in the plane and in space: quadratic cells, which are not too stiff in bending.
#[derive(Clone, Copy)]
pub(super) struct AutoCells {
    plane: Cells,
    solid: SolidCells,
}

impl Default for AutoCells {
    fn default() -> Self {
        Self { plane: Cells::Triangles6, solid: SolidCells::Tetrahedra10 }
    }
}

impl AutoCells {
    /// Those that keep their volume without locking, with a linear dilatation. A membrane has none.
    pub(super) fn of_silicone(is_membrane: bool) -> Self {
        let plane = if is_membrane { Cells::Triangles6 } else { Cells::Rectangles9 };
        Self { plane, solid: SolidCells::Hexahedra27 }
    }
}

fn plane_cells(auto: AutoCells) -> Vec<(&'static str, Cells)> {
    let named = Cells::ALL.map(|cells| (cells.name(), cells));
    named.into_iter().chain([(AUTO, auto.plane)]).collect()
}
fn solid_cells(auto: AutoCells) -> Vec<(&'static str, SolidCells)> {
    let named = SolidCells::ALL.map(|cells| (cells.name(), cells));
    named.into_iter().chain([(AUTO, auto.solid)]).collect()
}
fn words<T>(named: &[(&'static str, T)]) -> Vec<&'static str> {
    named.iter().map(|(word, _)| *word).collect()
}
