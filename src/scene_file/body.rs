//! `[body]`, `[[body.region]]` and `[[point]]`.

use super::selection::{BOX, corners};
use super::value::Value;
use crate::body::{Body, BodyBuilder, CellSelection, Inertia, Strain, Viscosity};
use crate::error::Error;
use crate::input::positive;
use crate::material::{Material, Plane};
use crate::mesh::Mesh;

const BODY: &[&str] =
    &["mesh", "thickness", "area", "strain", "plane", "viscous", "inertia", "material", "region"];

/// The body that `value`, the table `[body]`, describes, with the point masses of `points`.
pub(super) fn body(
    value: &Value,
    dimension: Option<&Value>,
    points: Option<&Value>,
) -> Result<Body, Error> {
    let table = value.table(BODY)?;
    let mut mesh = table
        .required("mesh", "the mesh: { kind = .. }", |value| super::mesh::mesh(value, dimension))?;
    let material =
        table.required("material", "what the body is made of", |value| material(value, None))?;
    let mut body = Body::new(mesh.clone(), material);
    if let Some(thickness) = table.optional("thickness", "the thickness (m)", Value::number)? {
        body = body.thickness(thickness);
    }
    if let Some(area) = table.optional("area", "the cross section (m^2)", Value::number)? {
        body = body.area(area);
    }
    body =
        body.strain(table.optional("strain", "the measure of strain", strain)?.unwrap_or_default());
    if let Some(viscosity) = table.optional("viscous", "the law of viscosity", |value| {
        value.word(&[("natural", Viscosity::Natural), ("objective", Viscosity::Objective)])
    })? {
        body = body.viscosity(viscosity);
    }
    if let Some(inertia) = table.optional("inertia", "how inertia is shared out", |value| {
        value.word(&[("consistent", Inertia::Consistent), ("lumped", Inertia::Lumped)])
    })? {
        body = body.inertia(inertia);
    }
    if let Some(plane) = table.optional("plane", "what is 0 across the plane", |value| {
        value.word(&[("strain", Plane::Strain), ("stress", Plane::Stress)])
    })? {
        body = body.plane(plane);
    }
    if let Some(regions) = table.get("region", "parts with a material of their own") {
        body = add_regions(body, &regions, &mesh, material)?;
    }
    if let Some(points) = points {
        body = add_points(body, points, &mut mesh)?;
    }
    body.build().map_err(|error| table.blame(error))
}

/// `auto` is Green: it is right however far a body turns, at a small cost.
fn strain(value: &Value) -> Result<Strain, Error> {
    value.word(&[("cauchy", Strain::Cauchy), ("green", Strain::Green), ("auto", Strain::Green)])
}

/// A material; keys that are missing are those of `base`, if there is one.
fn material(value: &Value, base: Option<Material>) -> Result<Material, Error> {
    let table = value.table(&["density", "young", "poisson", "viscosity"])?;
    let number = |key: &str, meaning: &'static str, base: Option<f64>| {
        let given = table.optional(key, meaning, Value::number)?;
        given.or(base).ok_or_else(|| table.missing(key, format!("expected {meaning}")))
    };
    let material = Material {
        density: number("density", "the density (kg/m^3)", base.map(|m| m.density))?,
        young: number("young", "Young's modulus (Pa)", base.map(|m| m.young))?,
        poisson: number("poisson", "Poisson's ratio (no unit)", base.map(|m| m.poisson))?,
        viscosity: number("viscosity", "the viscous modulus (Pa s)", base.map(|m| m.viscosity))?,
    };
    material.validate().map_err(|error| table.blame(error))?;
    Ok(material)
}

fn add_regions(
    mut body: BodyBuilder,
    regions: &Value,
    mesh: &Mesh,
    base: Material,
) -> Result<BodyBuilder, Error> {
    for table in regions.tables(&["name", "box", "group", "material"])? {
        table.optional("name", "the name of the region", Value::string)?;
        let checked = |value: &Value, cells: CellSelection| match cells.cells(mesh) {
            Ok(_) => Ok(cells),
            Err(error) => Err(value.error(error)),
        };
        let group = table.optional("group", "a group of cells of the mesh", |value| {
            checked(value, value.string()?.into())
        })?;
        let inside = table.optional("box", BOX, |value| {
            let [min, max] = corners(value, mesh)?;
            checked(value, CellSelection::Box { min, max })
        })?;
        let cells = match (group, inside) {
            (Some(cells), None) | (None, Some(cells)) => cells,
            (None, None) => return Err(table.missing("box", format!("expected {BOX}; or `group`"))),
            (Some(_), Some(_)) => return Err(table.error("expected `box` or `group`, not both")),
        };
        let meaning = "the keys of the material that differ";
        let material = table.required("material", meaning, |value| material(value, Some(base)))?;
        body = body.region(cells, material);
    }
    Ok(body)
}

/// Adds the point masses, to `mesh` too.
fn add_points(
    mut body: BodyBuilder,
    points: &Value,
    mesh: &mut Mesh,
) -> Result<BodyBuilder, Error> {
    for table in points.tables(&["name", "position", "mass"])? {
        let name = table.required("name", "the name of the point", Value::string)?;
        let position = table.required("position", "its natural position (m)", |value| {
            value.vector(mesh.dimension())
        })?;
        let mass = table.required("mass", "its mass (kg)", Value::number)?;
        positive("mass", mass, "kg").map_err(|error| table.blame(error))?;
        mesh.push_node(name, &position).map_err(|error| table.blame(error))?;
        body = body.point_mass(name, position, mass);
    }
    Ok(body)
}
