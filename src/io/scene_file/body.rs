//! `[body]`, `[[body.region]]` and `[[point]]`.

use std::collections::BTreeMap;

use super::cells::{BOX, CELLS, GROUP, cells};
use super::contents::AutoRequest;
use super::generators::AutoCells;
use super::keys::{AUTO, Key, TableKeys, ValueType};
use super::material::{MATERIAL, substance};
use super::mesh::{self, MESH};
use super::table::Table;
use super::value::Value;
use crate::base::input::{find, positive};
use crate::dynamics::error::Error;
use crate::elements::body::{
    Body, BodyBuilder, CellSelection, Dilatation, Inertia, Strain, Viscosity,
};
use crate::elements::material::{Plane, Substance};
use crate::elements::mesh::{CellKind, Mesh};
use crate::scene::timeline::Scene;

pub(super) const BODY: TableKeys = TableKeys::new(
    "[body]",
    "What moves: a mesh made of a material. A list of several, `[[body]]`, feel each other where they touch by \
     `[[touch]]`; ties, springs and combinations of displacements that are held join them.",
    &[
        Key::new("name", ValueType::Text, "its name among several bodies")
            .note("It is a node set and a group of cells, and stands before the node sets and groups of the body: `finger/tip`.")
            .default("`body 1`, `body 2` and so on"),
        Key::new("mesh", ValueType::Table(&MESH), "the mesh").required(),
        Key::number("thickness", "the thickness of a body in the plane", "m")
            .default("required in two dimensions; none if axisymmetric"),
        Key::number("area", "the cross section of a string", "m^2")
            .default("required in one dimension"),
        Key::new(
            "strain",
            ValueType::Word(|| STRAINS.map(|(word, _)| word).into()),
            "the measure of strain",
        )
        .note(
            "Cauchy's is linear, right while no cell turns by more than some degrees; Green's follows any rotation, \
             with the law of the material; `auto` is Green's, and the report tells whether Cauchy's would do.",
        )
        .default("auto"),
        Key::new(
            "viscous",
            ValueType::Word(|| VISCOUS.map(|(word, _)| word).into()),
            "the law of viscosity",
        )
        .note("Natural viscosity, -B v, brakes rotations, too; objective viscosity takes the rate of Green's strain.")
        .default("natural with Cauchy strain, objective with Green strain"),
        Key::new(
            "inertia",
            ValueType::Word(|| INERTIA.map(|(word, _)| word).into()),
            "how inertia is shared out",
        )
        .note("Consistent with the shape functions, or lumped at the nodes.")
        .default("consistent"),
        Key::new(
            "plane",
            ValueType::Word(|| PLANE.map(|(word, _)| word).into()),
            "the quantity that is 0 across cells of two dimensions, or that they are turned about the axis",
        )
        .note("Strain: of bodies that are long across the plane. Stress: of sheets, whose thickness changes. Axisymmetric: x is the radius r, 0 or \
              above, and y the height z of a body of revolution about r = 0; it has no thickness, and forces and masses are those of a whole turn.")
        .default("strain in the plane, stress in space (membranes)"),
        Key::new(
            "dilatation",
            ValueType::Word(|| DILATATION.map(|(word, _)| word).into()),
            "the treatment of volumetric strain, against locking",
        )
        .note("At each point of a cell, a nearly incompressible body locks. `linear`: projected onto linear functions of each cell, \
              accurate; for `hexahedra27` and `rectangles9`, for triangles and tetrahedra with `bubbles`, and for `hexahedra20`, whose pressures are not reliable then. `mean`: in the mean over each cell, for \
              `rectangles`, `hexahedra`, `triangles6` and `tetrahedra10`.")
        .default("points, or what goes with `cells = \"auto\"` and `bubbles`"),
        Key::new("material", ValueType::Table(&MATERIAL), "the material").required(),
        Key::new("region", ValueType::Tables(&REGION), "parts with a material of their own"),
        Key::new("velocity", ValueType::Vector, "its initial velocity, in place of that of `[initial]`")
            .in_unit("m/s")
            .default("that of `[initial]`"),
        Key::new(
            "spin",
            ValueType::OneOrMore(&ValueType::Number),
            "its initial angular velocity about its own centre of mass, in addition to that",
        )
        .in_unit("rad/s")
        .note("One number in the plane, counter-clockwise; three in space.")
        .default("0"),
    ],
    "[body]\n\
     mesh = { kind = \"rectangle\", size = [0.1, 0.02], nodes = [11, 3], cells = \"triangles6\" }\n\
     thickness = 0.01\n\
     strain = \"green\"\n\
     material = { density = 1000.0, young = 1.0e5, poisson = 0.48, viscosity = 40.0 }",
);

/// `auto` is Green: it is right however far a body turns, at a small cost.
const STRAINS: [(&str, Strain); 3] =
    [("cauchy", Strain::Cauchy), ("green", Strain::Green), (AUTO, Strain::Green)];
const VISCOUS: [(&str, Viscosity); 2] =
    [("natural", Viscosity::Natural), ("objective", Viscosity::Objective)];
const INERTIA: [(&str, Inertia); 2] =
    [("consistent", Inertia::Consistent), ("lumped", Inertia::Lumped)];
const DILATATION: [(&str, Dilatation); 3] =
    [("points", Dilatation::AtPoints), ("mean", Dilatation::Mean), ("linear", Dilatation::Linear)];
const PLANE: [(&str, Plane); 3] =
    [("strain", Plane::Strain), ("stress", Plane::Stress), ("axisymmetric", Plane::Axisymmetric)];

const REGION: TableKeys = TableKeys::new(
    "[[body.region]]",
    "A part of the body with a material of its own. A cell of several regions has the keys of all of them: where two give the same \
     key, that of the later one in the file counts.",
    &[
        Key::new("name", ValueType::Text, "the name of the region, for who reads the file"),
        BOX,
        GROUP,
        CELLS,
        Key::new("material", ValueType::Table(&MATERIAL), "the keys of the material that differ")
            .required(),
    ],
    "[[body.region]]\n\
     name = \"tough half\"\n\
     box = [[0.0, 0.0], [0.05, 0.02]] # cells whose centroid lies in it\n\
     material = { young = 2.0e5 }",
)
.one_of(&[&["box"], &["group"], &["cells"]]);

pub(super) const POINT: TableKeys = TableKeys::new(
    "[[point]]",
    "A point mass: a node that belongs to no cell. Its name is a node set.",
    &[
        Key::new("name", ValueType::Text, "the name of the point").required(),
        Key::new("position", ValueType::Vector, "its undeformed position").in_unit("m").required(),
        Key::number("mass", "its mass", "kg").required(),
        Key::new("body", ValueType::Text, "the name of the body that it is a node of")
            .default("required with several bodies"),
    ],
    "[[point]]\nname = \"hub\"\nposition = [0.05, 0.05]\nmass = 0.001",
);

/// The body or bodies that `value`, `[body]` or `[[body]]`, describes, with the point masses of `points`; `among_others` if there are rods
/// besides.
pub(super) fn bodies(
    value: &Value,
    dimension: Option<&Value>,
    points: Option<&Value>,
    among_others: bool,
) -> Result<Vec<Body>, Error> {
    let points = points.map(|points| points.tables(&POINT)).transpose()?.unwrap_or_default();
    let tables = value.one_or_more()?;
    if let [single] = &tables[..] {
        let points: Vec<_> = points.iter().collect();
        return Ok(vec![body(single, dimension, &points, among_others)?]);
    }
    let mut names = Vec::with_capacity(tables.len());
    for (number, table) in (1..).zip(&tables) {
        let name = table.table(&BODY)?.optional("name", Value::string)?;
        names.push(name.map_or_else(|| format!("body {number}"), str::to_owned));
    }
    let owners = points.iter().map(|point| {
        let help = "expected the name of the body that it is a node of";
        let owner = point.optional("body", Value::string)?;
        let owner = owner.ok_or_else(|| point.missing("body", help))?;
        find(owner, names.iter().map(String::as_str), "body", "bodies")
            .map_err(|error| point.blame(error))
    });
    let owners = owners.collect::<Result<Vec<usize>, Error>>()?;
    let bodies = tables.iter().enumerate().map(|(number, table)| {
        let own = points.iter().zip(&owners).filter(|(_, owner)| **owner == number);
        let own: Vec<&Table> = own.map(|(point, _)| point).collect();
        body(table, dimension, &own, true)
    });
    bodies.collect()
}

/// The body of a table, with its `points`. One `among_others` is made of its finer mesh at once.
fn body(
    value: &Value,
    dimension: Option<&Value>,
    points: &[&Table],
    among_others: bool,
) -> Result<Body, Error> {
    let table = value.table(&BODY)?;
    let material = table.required("material", |value| substance(value, None))?;
    let plane = table.optional("plane", |value| value.word(&PLANE))?;
    let is_silicone = material.material.is_nearly_incompressible() && plane != Some(Plane::Stress);
    let auto = match is_silicone {
        true => AutoCells::of_silicone(dimension.map(Value::count).transpose()? == Some(3)),
        false => AutoCells::default(),
    };
    let mut mesh = table.required("mesh", |value| {
        let mesh = mesh::mesh(value, dimension, auto)?;
        if among_others { mesh::finer(mesh, value) } else { Ok(mesh) }
    })?;
    let mut body = Body::new(mesh.clone(), material.clone());
    body = table.added(body, "name", Value::string, BodyBuilder::named)?;
    body = table.added(body, "thickness", Value::number, BodyBuilder::thickness)?;
    body = table.added(body, "area", Value::number, BodyBuilder::area)?;
    body = table.added(body, "strain", |value| value.word(&STRAINS), BodyBuilder::strain)?;
    body = table.added(body, "viscous", |value| value.word(&VISCOUS), BodyBuilder::viscosity)?;
    body = table.added(body, "inertia", |value| value.word(&INERTIA), BodyBuilder::inertia)?;
    if let Some(plane) = plane {
        body = body.plane(plane);
    }
    let has_auto_cells = table.required("mesh", mesh::has_auto_cells)?;
    let (gets_mid_nodes, bubbles) = table.required("mesh", mesh::gets_mid_nodes)?;
    match table.optional("dilatation", |value| value.word(&DILATATION))? {
        // it goes with the cells that are to come: see `on_finer_mesh`
        Some(_) if gets_mid_nodes && !among_others => {}
        Some(dilatation) => body = body.dilatation(dilatation),
        None if has_auto_cells
            && matches!(mesh.kind(), CellKind::Quadrilateral9 | CellKind::Hexahedron27) =>
        {
            body = body.dilatation(Dilatation::Linear);
        }
        None if among_others && bubbles && is_silicone => {
            body = body.dilatation(Dilatation::Linear);
        }
        None => {}
    }
    if let Some(regions) = table.get("region") {
        body = add_regions(body, &regions, &mesh, &material)?;
    }
    body = add_points(body, points, &mut mesh)?;
    body.build().map_err(|error| table.blame(error))
}

/// Choices that the bodies leave open, by the word `auto`.
pub(super) fn auto(value: &Value) -> Result<Vec<AutoRequest>, Error> {
    let of_body = |value: &Value| {
        let table = value.table(&BODY)?;
        let strain = table.optional("strain", Value::string)? == Some(AUTO);
        Ok(AutoRequest { strain, cells: table.required("mesh", mesh::has_auto_cells)? })
    };
    value.one_or_more()?.iter().map(of_body).collect()
}

/// The scene in which the bodies move at first as their tables say.
pub(super) fn moving(mut scene: Scene, value: &Value) -> Result<Scene, Error> {
    let names = scene.body().parts().map(|part| part.name.to_owned()).collect::<Vec<_>>();
    let dimension = scene.body().dimension();
    for (name, value) in names.into_iter().zip(value.one_or_more()?) {
        let table = value.table(&BODY)?;
        if let Some(velocity) = table.optional("velocity", |value| value.vector(dimension))? {
            let nodes = if scene.body().is_single() { "all" } else { &name };
            scene = scene.initial_velocity_of(nodes, velocity);
        }
        if let Some(spin) = table.optional("spin", Value::one_or_more_numbers)? {
            scene = scene.spin_of(name, spin);
        }
        scene.initial_velocities().map_err(|error| table.blame(error))?;
    }
    Ok(scene)
}

/// The scene on a finer mesh than the one that its node numbers refer to, if the table of a single body
/// requires that.
pub(super) fn on_finer_mesh(scene: Scene, value: &Value) -> Result<Scene, Error> {
    if !scene.body().is_single() {
        return Ok(scene);
    }
    let tables = value.one_or_more()?;
    let Some(value) = tables.first() else { return Ok(scene) };
    let table = value.table(&BODY)?;
    let scene = table.required("mesh", |value| mesh::on_finer_mesh(scene, value))?;
    let (gets_mid_nodes, bubbles) = table.required("mesh", mesh::gets_mid_nodes)?;
    let dilatation = match table.optional("dilatation", |value| value.word(&DILATATION))? {
        Some(dilatation) if gets_mid_nodes => dilatation,
        None if bubbles && scene.body().can_lock() => Dilatation::Linear,
        _ => return Ok(scene),
    };
    scene.with_body(|body| body.dilatation(dilatation)).map_err(|error| table.blame(error))
}

fn add_regions(
    mut body: BodyBuilder,
    regions: &Value,
    mesh: &Mesh,
    base: &Substance,
) -> Result<BodyBuilder, Error> {
    // what the cells are made of so far, and which of these each has
    let mut substances = vec![base.clone()];
    let mut of_cell = vec![0; mesh.cell_count()];
    for table in regions.tables(&REGION)? {
        table.optional("name", Value::string)?;
        let none = || table.missing("box", "expected either box, group or cells");
        let selection = cells(&table, mesh)?.ok_or_else(none)?;
        let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for cell in selection.cells(mesh).map_err(|error| table.blame(error))? {
            parts.entry(of_cell[cell]).or_default().push(cell);
        }
        let overlaps = parts.keys().any(|&before| before > 0);
        for (before, cells) in parts {
            let material =
                table.required("material", |value| substance(value, Some(&substances[before])))?;
            cells.iter().for_each(|&cell| of_cell[cell] = substances.len());
            substances.push(material.clone());
            body = match overlaps {
                false => body.region(selection.clone(), material),
                true => {
                    let numbers = cells.iter().map(|cell| cell + 1).collect();
                    body.region(CellSelection::Numbers(numbers), material)
                }
            };
        }
    }
    Ok(body)
}

/// Adds the point masses, to `mesh` too.
fn add_points(
    mut body: BodyBuilder,
    points: &[&Table],
    mesh: &mut Mesh,
) -> Result<BodyBuilder, Error> {
    for table in points {
        let name = table.required("name", Value::string)?;
        let position = table.required("position", |value| value.vector(mesh.dimension()))?;
        let mass = table.required("mass", Value::number)?;
        positive("mass", mass, "kg").map_err(|error| table.blame(error))?;
        mesh.push_node(name, &position).map_err(|error| table.blame(error))?;
        body = body.point_mass(name, position, mass);
    }
    Ok(body)
}
