//! Scenes of Hirai, *Computing Dynamic Deformation*.

use crate::base::input::InputError;
use crate::elements::body::{Body, BodyBuilder, CellSelection, Inertia, Strain, Viscosity};
use crate::elements::material::Material;
use crate::elements::mesh::{Cells, Mesh};
use crate::scene::constraint::Axis;
use crate::scene::forces::Obstacle;
use crate::scene::timeline::{Phase, Scene};

/// Material of the square: E = 1 MPa, c = 40 Pa s, nu = 0.48, rho = 1 g/cm^3.
pub const SQUARE_MATERIAL: Material =
    Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };

/// Material of the beam: E = 50 kPa, c = 0.2 kPa s, rho = 1 g/cm^3.
pub const BEAM_MATERIAL: Material =
    Material { density: 1000.0, young: 5e4, poisson: 0.0, viscosity: 200.0 };

/// Material of the bent beam: E = 0.1 MPa, c = 4 Pa s, nu = 0.48, rho = 1 g/cm^3.
pub const BENT_BEAM_MATERIAL: Material =
    Material { density: 1000.0, young: 1e5, poisson: 0.48, viscosity: 4.0 };

/// Figs 4.3 and 4.4: an elastic square of 30 cm, `nodes` x `nodes`, 1 cm thick. Its bottom is
/// fixed and the middle third of its top pressed down at 16 cm/s until 0.5 s, held until 1 s,
/// and released until 2 s.
///
/// # Errors
/// Fewer than 4 nodes: the top has no middle third then.
pub fn square_press(nodes: usize) -> Result<Scene, InputError> {
    let scene = Scene::new(square(nodes, Cells::Triangles)?.build()?);
    Ok(press(scene, nodes).phase(Phase::until(2.0).named("released").hold("bottom")))
}

/// Figs 4.5 and 4.6: the same square, but at 1 s everything is released over a floor, and the
/// square jumps until 1.5 s. [`SquareJump`] has variants.
///
/// # Errors
/// As [`square_press`].
pub fn square_jump(nodes: usize) -> Result<Scene, InputError> {
    SquareJump { nodes, ..SquareJump::default() }.scene()
}

/// The jumping square with other numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareJump {
    /// Nodes along a side, 4 at least. Default: 4 (Fig. 4.5); Fig. 4.6 has 10.
    pub nodes: usize,
    /// Cells of the square. Default: triangles; Fig. 4.7 has rectangles.
    pub cells: Cells,
    /// Default: consistent.
    pub inertia: Inertia,
    /// Stiffness of the floor under all nodes of the bottom together (N/m). Default: 400, Hirai's 100 N/m per
    /// node on 4 nodes and 40 on 10.
    pub floor: f64,
    /// Acceleration of gravity downward (m/s^2). Default: 0, as in Hirai.
    pub gravity: f64,
    /// End of the jump (s), after 1. Default: 1.5.
    pub until: f64,
}

impl Default for SquareJump {
    fn default() -> Self {
        Self {
            nodes: 4,
            cells: Cells::Triangles,
            inertia: Inertia::Consistent,
            floor: 400.0,
            gravity: 0.0,
            until: 1.5,
        }
    }
}

impl SquareJump {
    /// The scene.
    ///
    /// # Errors
    /// Fewer than 4 nodes.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]);
        let body = square(self.nodes, self.cells)?.inertia(self.inertia).build()?;
        let mut scene = Scene::new(body).obstacle(floor.stiffness(self.floor / self.nodes as f64));
        if self.gravity != 0.0 {
            scene = scene.gravity([0.0, -self.gravity]);
        }
        Ok(press(scene, self.nodes).phase(Phase::until(self.until).named("free")))
    }
}

/// Fig. 4.1: an elastic bar of 10 cm and 2 cm^2, 6 nodes, standing on the floor. Its top is
/// pressed with 2 N until 0.2 s; then it jumps off a floor of 0.1 MPa/cm, until 0.6 s, without
/// gravity. [`BeamJump`] has variants.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn beam_jump() -> Result<Scene, InputError> {
    BeamJump::default().scene()
}

/// The jumping beam with other numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamJump {
    /// Acceleration of gravity downward (m/s^2). Default: 0, as in Hirai.
    pub gravity: f64,
    /// End of the jump (s), after 0.2. Default: 0.6.
    pub until: f64,
}

impl Default for BeamJump {
    fn default() -> Self {
        Self { gravity: 0.0, until: 0.6 }
    }
}

impl BeamJump {
    /// The scene.
    ///
    /// # Errors
    /// None: it returns a `Result` as the other scenes do.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let body = Body::new(Mesh::bar(0.10, 6)?, BEAM_MATERIAL)
            .strain(Strain::Cauchy)
            .area(2e-4)
            .build()?;
        let push = Phase::until(0.2).named("push").hold("left").load("right", [-2.0]);
        let mut scene = Scene::new(body)
            .obstacle(Obstacle::half_plane([0.0], [1.0]).stiffness(2000.0))
            .phase(push.without_contact())
            .phase(Phase::until(self.until).named("free"));
        if self.gravity != 0.0 {
            scene = scene.gravity([-self.gravity]);
        }
        Ok(scene)
    }
}

/// Figs 4.9 and 4.10: an elastic beam of 10 x 2 cm (11 x 3 nodes), 1 cm thick, its left end fixed.
/// The middle of its right end, node 22, is pushed down by 5 cm within 5 s, its horizontal component
/// held too if `holds_tip`; then it is released until 6 s. Viscosity is natural, as in Hirai.
///
/// # Errors
/// None: it returns a `Result` as the other scenes do.
pub fn beam_bend(strain: Strain, holds_tip: bool) -> Result<Scene, InputError> {
    let mesh = Mesh::rectangle([0.10, 0.02], [11, 3], Cells::Triangles)?;
    let body = Body::new(mesh, BENT_BEAM_MATERIAL)
        .thickness(0.01)
        .strain(strain)
        .viscosity(Viscosity::Natural)
        .build()?;
    let push = Phase::until(5.0).named("push").hold("left");
    let push = match holds_tip {
        true => push.move_nodes([22], [0.0, -0.01]),
        false => push.move_axis([22], Axis::Y, -0.01),
    };
    Ok(Scene::new(body).phase(push).phase(Phase::until(6.0).named("released").hold("left")))
}

/// Fig. 4.11: an elastic ring, its right half ten times as heavy as its left one, rolls on a floor.
/// Radii 2 and 4 cm, 16 x 3 nodes, 1 cm thick; floor of 1000 N/m and 20 N s/m per node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingRoll {
    /// Default: Green.
    pub strain: Strain,
    /// Default: natural, as in Hirai. It brakes the rotation, and the ring creeps to rest;
    /// with objective viscosity it rolls through and swings.
    pub viscosity: Viscosity,
    /// Tangential damping B_t (N s/m per node). Default: 20.
    pub tangential_damping: f64,
    /// End (s). Default: 5.
    pub until: f64,
}

impl Default for RingRoll {
    fn default() -> Self {
        let (strain, viscosity) = (Strain::Green, Viscosity::Natural);
        Self { strain, viscosity, tangential_damping: 20.0, until: 5.0 }
    }
}

impl RingRoll {
    /// The scene.
    ///
    /// # Errors
    /// Tangential damping or end out of range.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let light = Material { density: 1000.0, young: 1e5, poisson: 0.48, viscosity: 40.0 };
        let heavy = Material { density: 10_000.0, ..light };
        let mesh = Mesh::ring(0.02, 0.04, [16, 3], Cells::Triangles)?.translated(&[0.0, 0.04])?;
        let body = Body::new(mesh, light)
            .region(CellSelection::inside([0.0, -1.0], [1.0, 1.0]), heavy)
            .thickness(0.01)
            .strain(self.strain)
            .viscosity(self.viscosity)
            .build()?;
        let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]);
        let scene = Scene::new(body)
            .gravity([0.0, -9.8])
            .obstacle(floor.stiffness(1000.0).tangential_damping(self.tangential_damping))
            .phase(Phase::until(self.until).named("rolls"));
        scene.validate().map(|()| scene)
    }
}

/// Material of the clamped beam without its viscosity: E = 1.4 MPa, nu = 0.4, rho = 1 g/cm^3.
pub const FLAG_MATERIAL: Material =
    Material { density: 1000.0, young: 1.4e6, poisson: 0.4, viscosity: 0.0 };

/// A beam of 35 x 2 cm, 1 m thick, clamped at its left end, under gravity of 2 m/s^2 that sets in at
/// once: the elastic flag of Turek and Hron ("Proposal for numerical benchmarking of fluid-structure
/// interaction", 2006, test CSM3), clamped along a straight edge. Green strain, plane strain.
///
/// It swings about the static deflection of its tip, 65.6 mm on converged meshes; linear triangles of 35 x 2
/// grid cells lock and give 29 mm. Undamped, it is an example of motions that BDF of order 3 and above
/// handles badly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClampedBeam {
    /// Corner nodes along and across. Default: 36 x 3.
    pub nodes: [usize; 2],
    /// Default: triangles.
    pub cells: Cells,
    /// Viscosity c (Pa s), objective. Default: 0. With 4000 the lowest mode (about 1.1 Hz) has a
    /// damping ratio of about 1 %, omega c / (2 E); higher modes have more, in proportion to their
    /// frequency.
    pub viscosity: f64,
    /// Default: consistent.
    pub inertia: Inertia,
    /// End (s). Default: 2.
    pub until: f64,
}

impl Default for ClampedBeam {
    fn default() -> Self {
        Self {
            nodes: [36, 3],
            cells: Cells::Triangles,
            viscosity: 0.0,
            inertia: Inertia::Consistent,
            until: 2.0,
        }
    }
}

impl ClampedBeam {
    /// The scene.
    ///
    /// # Errors
    /// Fewer than 2 x 2 nodes; viscosity or end out of range.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let &Self { nodes, cells, viscosity, inertia, until } = self;
        let mesh = Mesh::rectangle([0.35, 0.02], nodes, cells)?;
        let material = Material { viscosity, ..FLAG_MATERIAL };
        let body = Body::new(mesh, material).thickness(1.0).strain(Strain::Green);
        let scene = Scene::new(body.inertia(inertia).build()?)
            .gravity([0.0, -2.0])
            .phase(Phase::until(until).named("swings").hold("left"));
        scene.validate().map(|()| scene)
    }
}

/// [`ClampedBeam`] on a mesh of linear triangles with `nodes` corner nodes along and across, with
/// this `viscosity` (Pa s).
///
/// # Errors
/// As [`ClampedBeam::scene`].
pub fn clamped_beam(nodes: [usize; 2], viscosity: f64) -> Result<Scene, InputError> {
    ClampedBeam { nodes, viscosity, ..ClampedBeam::default() }.scene()
}

/// Numbers (from 1) of the nodes in the middle third of the top edge of the square.
pub fn pushed_nodes(nodes: usize) -> Vec<usize> {
    let first = nodes * (nodes - 1);
    (first + nodes / 3 + 1..=first + nodes - nodes / 3).collect()
}

fn square(nodes: usize, cells: Cells) -> Result<BodyBuilder, InputError> {
    if nodes < 4 {
        return Err(InputError::new(
            "nodes",
            nodes,
            "the square needs 4 nodes along a side at least",
        ));
    }
    let mesh = Mesh::rectangle([0.30, 0.30], [nodes, nodes], cells)?;
    Ok(Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01))
}

/// The phases in which the square is pressed and held, bottom fixed.
fn press(scene: Scene, nodes: usize) -> Scene {
    let pushed = pushed_nodes(nodes);
    let push = Phase::until(0.5).named("push").hold("bottom");
    let hold = Phase::until(1.0).named("hold").hold("bottom").hold(pushed.clone());
    scene
        .phase(push.move_nodes(pushed, [0.0, -0.16]).without_contact())
        .phase(hold.without_contact())
}

#[cfg(test)]
mod tests {
    use super::pushed_nodes;

    #[test]
    fn the_middle_third_of_the_top_is_pushed() {
        assert_eq!(pushed_nodes(4), [14, 15]);
        assert_eq!(pushed_nodes(10), [94, 95, 96, 97]);
    }
}
