//! Scenes of Hirai, *Computing Dynamic Deformation*, with pressure, springs and pairs of forces.

use super::BENT_BEAM_MATERIAL;
use crate::base::input::InputError;
use crate::elements::body::{Body, Strain, Viscosity};
use crate::elements::material::{Material, Plane};
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::forces::{Chamber, Obstacle, Spring};
use crate::scene::timeline::{Phase, Scene};

/// Material of membranes and of the ring with springs: E = 0.1 MPa, c = 40 Pa s, nu = 0.48.
pub const MEMBRANE_MATERIAL: Material = Material { viscosity: 40.0, ..BENT_BEAM_MATERIAL };

/// Fig. 4.8: a membrane of 10 x 1 cm (11 x 2 nodes, 1 cm thick), fixed at its four corners, inflated
/// from below by 2 kPa until 1.5 s and left alone until 3 s.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn membrane() -> Result<Scene, InputError> {
    let mesh = Mesh::rectangle([0.10, 0.01], [11, 2], Cells::Triangles)?;
    let body = Body::new(mesh, MEMBRANE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()?;
    let bottom: Vec<usize> = (1..=11).rev().collect();
    let hold = |until: f64| Phase::until(until).hold([1, 11, 12, 22]);
    Ok(Scene::new(body)
        .chamber(Chamber::within("chamber", bottom))
        .phase(hold(1.5).named("inflated").pressure("chamber", 2000.0))
        .phase(hold(3.0).named("left alone")))
}

/// Fig. 4.8, second scene: a clamped half-ring of radii 4 and 5 cm (21 x 3 nodes, 1 cm thick) over a
/// chamber, inflated by 2 kPa until 1.5 s and left alone until 3 s; Green strain.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn membrane_arch() -> Result<Scene, InputError> {
    let mesh = Mesh::half_ring(0.04, 0.05, [21, 3], Cells::Triangles)?;
    let body = Body::new(mesh, MEMBRANE_MATERIAL).thickness(0.01).strain(Strain::Green).build()?;
    let inner: Vec<usize> = (0..21).map(|station| 3 * station + 1).collect();
    let hold = |until: f64| Phase::until(until).hold("left").hold("right");
    Ok(Scene::new(body)
        .chamber(Chamber::within("chamber", inner))
        .phase(hold(1.5).named("inflated").pressure("chamber", 2000.0))
        .phase(hold(3.0).named("left alone")))
}

/// Fig. 4.12 without its timeline: an elastic ring of radii 4 and 5 cm (32 x 3 nodes, 1 cm thick, Green
/// strain) on a floor; eight springs `A1` to `A8` of 20 N/m and 4 cm join the point "mass" of 1 g at
/// its centre with its inner side, `A1` straight below, then counter-clockwise. It needs a phase.
///
/// Hirai's viscosity is natural, and brakes every rotation.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn spring_ring(viscosity: Viscosity) -> Result<Scene, InputError> {
    let mesh = Mesh::ring(0.04, 0.05, [32, 3], Cells::Triangles)?.translated(&[0.0, 0.05])?;
    let body = Body::new(mesh, MEMBRANE_MATERIAL)
        .thickness(0.01)
        .strain(Strain::Green)
        .viscosity(viscosity)
        .point_mass("mass", [0.0, 0.05], 0.001)
        .build()?;
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]);
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(floor.stiffness(1000.0).tangential_damping(20.0));
    Ok((1..=8).fold(scene, |scene, k| {
        let inner = 12 * (k - 1) + 1;
        let spring = Spring::between([inner], "mass").named(format!("A{k}"));
        scene.spring(spring.stiffness(20.0).length(0.04))
    }))
}

/// Fig. 4.12: the ring settles for 0.2 s, then pairs of opposite springs shrink with `force` (N) one
/// after the other: A2 and A6 until 2 s, A3 and A7 from 2.1 to 6.9 s, A4 and A8 from 7 to 12 s.
/// With 1 N the ring walks to the right. Hirai's 5 N pull springs to length zero.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn ring_springs(force: f64) -> Result<Scene, InputError> {
    Ok(spring_ring(Viscosity::Natural)?
        .phase(Phase::until(0.2).named("settle"))
        .phase(Phase::until(2.0).named("A2 and A6").actuate(["A2", "A6"], -force))
        .phase(Phase::until(2.1).named("relax"))
        .phase(Phase::until(6.9).named("A3 and A7").actuate(["A3", "A7"], -force))
        .phase(Phase::until(7.0).named("relax again"))
        .phase(Phase::until(12.0).named("A4 and A8").actuate(["A4", "A8"], -force)))
}

/// The ring of [`ring_springs`] jumps: A1 and A5 shrink with a force that grows to 1 N within 0.1 s,
/// then everything is released until 1 s.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn ring_jump() -> Result<Scene, InputError> {
    let crouch = Phase::until(0.1).named("crouch");
    Ok(spring_ring(Viscosity::Natural)?
        .phase(crouch.actuate_table(["A1", "A5"], [0.0, 0.1], [0.0, -1.0]))
        .phase(Phase::until(1.0).named("jump")))
}

/// Slides, "Report #8": a rectangle of 6 x 9 cm (7 x 10 nodes, 1 cm thick, Green strain) stands on its
/// fixed bottom. Two opposite forces of 1 N press its sides for half a second, from the left at
/// two thirds of its height and from the right at one third; then it is left alone until 1 s.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn report_8() -> Result<Scene, InputError> {
    let mesh = Mesh::rectangle([0.06, 0.09], [7, 10], Cells::Triangles)?;
    let body = Body::new(mesh, MEMBRANE_MATERIAL).thickness(0.01).strain(Strain::Green).build()?;
    let press = Phase::until(0.5).named("pressed").hold("bottom");
    Ok(Scene::new(body)
        .phase(press.load([43], [1.0, 0.0]).load([28], [-1.0, 0.0]))
        .phase(Phase::until(1.0).named("left alone").hold("bottom")))
}

/// A bending actuator: bellows over a stiff layer, clamped at one end (15 mm wide, plane stress, Green
/// strain), whose chambers are inflated by 5 kPa at once; after 1 s the air is let out, until 2 s. `mesh`
/// has the regions, nodes and walls of `scenes/meshes/bending-actuator.geo`.
///
/// # Errors
/// A mesh without these regions, nodes or walls.
pub fn bending_actuator(mesh: Mesh) -> Result<Scene, InputError> {
    let rubber = Material { density: 1100.0, young: 5e5, poisson: 0.45, viscosity: 1e4 };
    let layer = Material { young: 1e7, viscosity: 2e5, ..rubber };
    let body = Body::new(mesh, rubber)
        .region("strain limiting layer", layer)
        .thickness(0.015)
        .plane(Plane::Stress)
        .strain(Strain::Green)
        .build()?;
    let scene = Scene::new(body)
        .chamber(Chamber::within("air", "chamber"))
        .phase(Phase::until(1.0).named("blown up").hold("clamp").pressure("air", 5000.0))
        .phase(Phase::until(2.0).named("let go").hold("clamp"));
    scene.validate().map(|()| scene)
}
