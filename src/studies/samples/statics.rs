//! Scenes of Hirai, *Computing Dynamic Deformation*, to be brought into equilibrium.

use super::BENT_BEAM_MATERIAL;
use crate::base::input::InputError;
use crate::elements::body::{Body, Strain};
use crate::elements::material::Material;
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::timeline::{Phase, Scene};

/// Slides, "Example (static simulation)": a square of 4 x 4 nodes in unit cells (m), its bottom fixed,
/// nodes 14 and 15 pressed down by 0.3 within a second.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn static_square(strain: Strain) -> Result<Scene, InputError> {
    let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles)?;
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 0.0 };
    let body = Body::new(mesh, rubber).thickness(1.0).strain(strain).build()?;
    let press = Phase::until(1.0).named("pressed").hold("bottom");
    Ok(Scene::new(body).phase(press.move_nodes([14, 15], [0.0, -0.3])))
}

/// Static counterpart of Figs 4.9 and 4.10: a beam of 10 x 2 cm (11 x 3 nodes), 1 cm thick, its left
/// end fixed, under a force on the middle of the other one, node 22, that bends it down by 5.000 cm.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn beam_static(strain: Strain) -> Result<Scene, InputError> {
    let force = match strain {
        Strain::Cauchy => 0.63754,
        Strain::Green => 0.71228,
    };
    let mesh = Mesh::rectangle([0.10, 0.02], [11, 3], Cells::Triangles)?;
    let body = Body::new(mesh, BENT_BEAM_MATERIAL).thickness(0.01).strain(strain).build()?;
    let bend = Phase::until(1.0).named("bent").hold("left");
    Ok(Scene::new(body).phase(bend.load([22], [0.0, -force])))
}
