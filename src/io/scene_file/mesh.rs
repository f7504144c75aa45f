//! `mesh` of `[body]`: a generator or a file (`generators.rs`), put in its place and made finer.

use super::generators::{AutoCells, KINDS, generate};
use super::keys::{AUTO, Key, Kind, TableKeys, ValueType};
use super::selection::selection;
use super::table::Table;
use super::value::Value;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::elements::body::CellSelection;
use crate::elements::mesh::Mesh;
use crate::scene::timeline::Scene;

pub(super) const MESH: TableKeys = TableKeys::new(
    "mesh",
    "The mesh of the body, made by a generator or read from a file. Generated meshes name the node sets `left`, \
     `right`, `bottom`, `top` (in space `front` and `back`, too), rings `inner` and `outer`; those of Gmsh have the \
     names of physical groups.",
    &[
        Key::new("origin", ValueType::Vector, "the position of the lower corner, or of the centre of a ring")
            .in_unit("m")
            .default("the origin"),
        Key::new(
            "turn",
            ValueType::OneOrMore(&ValueType::Number),
            "the angle by which the mesh is rotated about the origin before it is moved to `origin`",
        )
        .in_unit("rad")
        .note("One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone: boxes, and \
              directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after it.")
        .default("0"),
        Key::new("quadratic", ValueType::Flag, "whether cells get mid nodes")
            .note(FINER)
            .default("false"),
        Key::new("halved", ValueType::Count, "how often each cell is divided at the middles of its edges")
            .note("After `quadratic`, and like it.")
            .default("0"),
        Key::new("halved_in", ValueType::Tables(&HALVED_IN), "where triangles and tetrahedra are divided further")
            .note("After `halved`, and like it.")
            .default("nowhere"),
        Key::new("bubbles", ValueType::Flag, "whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face")
            .note("With `dilatation = \"linear\"`, which goes with them, they are the cells for nearly incompressible bodies of any \
                  shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.")
            .default("false"),
    ],
    "mesh = { kind = \"ring\", inner = 0.04, outer = 0.05, nodes = [32, 3], cells = \"crossed\", origin = [0.0, 0.05] }",
)
.kinds(&KINDS);

const HALVED_IN: TableKeys = TableKeys::new(
    "halved_in",
    "A place where cells are divided further, as sharp corners and clamps need it: those that have one of the nodes, and cells around \
     them as far as it takes for no node to hang on an edge.",
    &[
        Key::new("nodes", ValueType::Nodes, "nodes of the mesh that there is by then"),
        Key::new("times", ValueType::Count, "how often cells that have one of the nodes are divided")
            .note("Goes with `nodes`.")
            .default("1"),
        Key::new("cells", ValueType::List(&ValueType::Count), "numbers of cells, from 1, of the mesh that there is by then")
            .note("`pliant static --refine` writes such lists."),
    ],
    "mesh = { kind = \"rectangle\", size = [0.1, 0.02], nodes = [11, 3], cells = \"triangles6\", halved_in = [{ nodes = \"left\", times = 2 }] }",
)
.one_of(&[&["nodes"], &["cells"]]);

const FINER: &str = "Triangles, tetrahedra and hexahedra; quadrilaterals are divided into triangles first. Numbers of nodes in the file are \
     those of the mesh without this; new nodes of rings are on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces \
     on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared out.";

/// The mesh that `value` describes, in a space of `dimension` (default: its own).
pub(super) fn mesh(
    value: &Value,
    dimension: Option<&Value>,
    auto: AutoCells,
) -> Result<Mesh, Error> {
    let table = value.table(&MESH)?;
    let mesh = generate(&table, dimension, auto).map_err(|error| table.blame(error))?;
    mesh.notes().iter().for_each(|note| value.source.note(format!("{}: {note}", mesh.origin())));
    let mesh = match dimension {
        Some(dimension) => placed(mesh, dimension)?,
        None => mesh,
    };
    let mesh = match table.optional("turn", Value::one_or_more_numbers)? {
        Some(turn) => mesh.turned(&turn).map_err(|error| table.blame(error))?,
        None => mesh,
    };
    let origin = table.optional("origin", |value| value.vector(mesh.dimension()))?;
    match origin {
        Some(origin) => mesh.translated(&origin).map_err(|error| table.blame(error)),
        None => Ok(mesh),
    }
}

/// The scene on a finer mesh, if `value` requires one.
pub(super) fn on_finer_mesh(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = value.table(&MESH)?;
    let steps = [Scene::quadratic, Scene::halved, Scene::with_bubbles];
    made_finer(scene, &table, steps, |scene| {
        table.tables("halved_in", &HALVED_IN)?.iter().try_fold(scene, halved_in)
    })
}

/// The mesh of one of several bodies, made finer at once if `value` requires that: node numbers are those of the
/// finer mesh.
pub(super) fn finer(mesh: Mesh, value: &Value) -> Result<Mesh, Error> {
    let table = value.table(&MESH)?;
    if let Some(value) = table.get("halved_in") {
        return Err(value.error("cells are halved in places of a single body only: grade its mesh"));
    }
    let steps = [Mesh::quadratic, |mesh: &Mesh| Ok(mesh.halved()), Mesh::with_bubbles];
    made_finer(mesh, &table, steps, Ok)
}

/// A step to a finer mesh, or to a scene on it.
type Step<T> = fn(&T) -> Result<T, InputError>;

/// A mesh, or a scene, as `quadratic`, `halved`, `halved_in` and `bubbles` of `table` require, in this order.
fn made_finer<T>(
    mut coarse: T,
    table: &Table,
    [quadratic, halved, with_bubbles]: [Step<T>; 3],
    halved_in: impl FnOnce(T) -> Result<T, Error>,
) -> Result<T, Error> {
    let blame = |error: InputError| table.blame(error);
    if table.flag("quadratic")? {
        coarse = quadratic(&coarse).map_err(blame)?;
    }
    for _ in 0..table.optional("halved", Value::count)?.unwrap_or(0) {
        coarse = halved(&coarse).map_err(blame)?;
    }
    let finer = halved_in(coarse)?;
    if table.flag("bubbles")? { with_bubbles(&finer).map_err(blame) } else { Ok(finer) }
}

fn halved_in(mut scene: Scene, place: &Table) -> Result<Scene, Error> {
    let blame = |error: InputError| place.blame(error);
    let times = place.optional("times", Value::count)?;
    if let Some(value) = place.get("cells") {
        if times.is_some() {
            let help = "times goes with nodes: after a division cells have other numbers";
            return Err(place.error(help));
        }
        let numbers = CellSelection::Numbers(value.list_of("cell numbers", Value::count)?);
        let cells = numbers.cells(scene.body().mesh()).map_err(|error| value.error(error))?;
        return scene.halved_in(&cells).map_err(blame);
    }
    for _ in 0..times.unwrap_or(1) {
        let mesh = scene.body().mesh();
        let nodes = place.required("nodes", |value| selection(value, mesh))?;
        let cells = mesh.cells_at(nodes).map_err(blame)?;
        scene = scene.halved_in(&cells).map_err(blame)?;
    }
    Ok(scene)
}

/// Whether cells get nodes in the middle of edges, faces or themselves, and whether these bring bubbles.
pub(super) fn gets_mid_nodes(value: &Value) -> Result<(bool, bool), Error> {
    let table = value.table(&MESH)?;
    let [quadratic, bubbles] = [table.flag("quadratic")?, table.flag("bubbles")?];
    Ok((quadratic || bubbles, bubbles))
}

/// Whether the cells of a generated mesh are left to be chosen.
pub(super) fn has_auto_cells(value: &Value) -> Result<bool, Error> {
    let table = value.table(&MESH)?;
    let has_cells =
        |kind: &Kind| kind.word == table.kind() && kind.keys.iter().any(|key| key.name == "cells");
    if !KINDS.iter().any(has_cells) {
        return Ok(false);
    }
    let word = table.get("cells").and_then(|cells| cells.string().ok());
    Ok(word == Some(AUTO))
}

/// The mesh in a space of `dimension`: along its first axes, where the mesh has fewer of its own.
fn placed(mesh: Mesh, dimension: &Value) -> Result<Mesh, Error> {
    Ok(match (mesh.dimension(), dimension.count()?) {
        (own, wanted) if own == wanted => mesh,
        (1, 2) => mesh.mapped(|x| [x[0], 0.0])?,
        (1, 3) => mesh.mapped(|x| [x[0], 0.0, 0.0])?,
        (2, 3) => mesh.in_space()?,
        (own, _) => {
            let allowed = ["1, 2 or 3", "2 or 3", "3"][own - 1];
            return Err(dimension.unexpected(format!("{allowed} for this mesh")));
        }
    })
}
