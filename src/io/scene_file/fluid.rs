//! `[[fluid]]`.

use super::keys::{Key, TableKeys, ValueType};
use super::selection::selection;
use super::surroundings::unique;
use super::value::Value;
use crate::dynamics::error::Error;
use crate::scene::forces::Fluid;
use crate::scene::timeline::Scene;

pub(super) const FLUID: TableKeys = TableKeys::new(
    "[[fluid]]",
    "A fluid around bodies, crudely: what it does to each face of their boundary by itself, without a wake. With the velocity w of the body relative to \
     the fluid, w_n along the normal n and w_t along the face, drag is the traction -(rho/2) (C_n |w_n| w_n n + C_t |w_t| w_t); `added_mass` moves \
     along with the faces in all directions alike; below the `level` there is the pressure rho g times the depth. One of them at least is needed.",
    &[
        Key::new("name", ValueType::Text, "the name of the fluid").default("fluid 1, fluid 2, ..."),
        Key::number("density", "the density rho", "kg/m^3").note("Of water 1000, of air 1.2.").required(),
        Key::number("drag", "the coefficient C_n of drag along the normal", "1")
            .note("Faces at the front and at the back both count: 0.6 to 1 for plates, 0.75 to 0.9 for cylinders across, 0.5 for spheres.")
            .default("0"),
        Key::number("skin_drag", "the coefficient C_t of drag along the face", "1")
            .note("Some 0.003 to 0.01 at Reynolds numbers of 1e4 to 1e6.")
            .default("0"),
        Key::number("added_mass", "the mass of fluid that moves along with the undeformed area", "kg/m^2")
            .note("The density times R/6 for a sphere of radius R, R/2 for a cylinder across, pi c/8 on both sides of a plate of width c.")
            .default("0"),
        Key::new("velocity", ValueType::ChangingVector, "the velocity of the fluid, a current").in_unit("m/s").default("0"),
        Key::number("level", "the height of its surface above the origin, against gravity", "m").default("no pressure by depth"),
        Key::new("nodes", ValueType::Nodes, "the nodes of the faces that it acts on").note("Those inside of bodies do not matter.").default("all"),
    ],
    "[[fluid]]\nname = \"water\"\ndensity = 1000.0\ndrag = 0.8\nskin_drag = 0.005\nadded_mass = 5.0",
);

/// The scene with the fluid that `value` describes.
pub(super) fn add_fluid(scene: Scene, value: &Value) -> Result<Scene, Error> {
    let table = &value.table(&FLUID)?;
    let body = scene.body();
    let mut fluid = Fluid::new(table.required("density", Value::number)?);
    let coefficient = |key: &str| table.optional(key, Value::number);
    let drag = [coefficient("drag")?, coefficient("skin_drag")?];
    let [normal, tangential] = drag.map(Option::unwrap_or_default);
    fluid = fluid.drag(normal, tangential);
    fluid = table.added(fluid, "name", Value::string, Fluid::named)?;
    fluid = table.added(fluid, "added_mass", Value::number, Fluid::added_mass)?;
    let velocity = |value: &Value| value.vector_signal(body.dimension());
    fluid = table.added(fluid, "velocity", velocity, Fluid::flowing)?;
    fluid = table.added(fluid, "level", Value::number, Fluid::level)?;
    fluid = table.added(fluid, "nodes", |value| selection(value, body.mesh()), Fluid::on)?;
    fluid = fluid.or_named(format!("fluid {}", scene.fluids().len() + 1));
    unique(table, fluid.name(), scene.fluids().iter().map(Fluid::name))?;
    // phases, which are read later, say whether there is gravity
    let down = vec![1.0; body.dimension()];
    fluid.force(body, Some(&down)).map_err(|error| table.blame(error))?;
    Ok(scene.fluid(fluid))
}
