//! A fluid around bodies, crudely: its drag and added mass on faces, its pressure by depth.
//!
//! It acts at quadrature points of faces in the deformed shape (`followed.rs`). Drag is a traction of n J and
//! the relative velocity alone; the derivative of n J by a node is a cross product, so that tangents are
//! exact, and those by velocities symmetric and not negative. Pressure by depth on a closed surface is the
//! gradient of a sum, with a symmetric tangent: statics finds how a body floats by falling energy. Tractions
//! p n at points would have no potential where the surface of the fluid crosses a face, and a part across
//! gravity that pushes a floating body on for ever. Surfaces with a rim, recognized by the derivatives of the
//! vector area, have no such potential and get p n.
//!
//! Added mass is integrated over the undeformed faces once and added to M = m (x) I (`Capabilities::carried`,
//! `Matrices::carry`). It acts in all directions alike, because along normals alone it would turn with the
//! faces, and M would not be constant. The body's own mass (weight, momentum, mass damping) is not changed.

mod force;
mod rods;
#[cfg(test)]
mod tests;
mod traction;

use std::collections::BTreeMap;

pub(crate) use force::FluidForce;
use rods::RodDrag;
use traction::{Depth, Drag};

use super::actuator::Placed;
use super::faces::{loaded_faces, on_no_face};
use super::followed::FollowedFaces;
use super::signal::VectorSignal;
use super::time_table::TimeTable;
use crate::base::input::{InputError, finite, not_negative, positive};
use crate::base::vector::{cross, distinct, norm, padded};
use crate::elements::body::{Body, Inertia};
use crate::elements::mesh::{Mesh, NodeMap, Selection};
use crate::elements::rod::TubePiece;

/// A fluid at rest, or in uniform flow, around the bodies of a scene: a local model of its forces on each face of their boundary.
///
/// This is crude: the flow is not computed, so that there are no wakes, and faces do not shield each other. There are three terms, each of
/// which may be omitted; areas and normals of the first and the last are those of the deformed faces.
///
/// - [Drag](Self::drag): with the velocity w of the body relative to the fluid, its part w_n along the normal n and w_t along the face, the
///   traction -(rho/2) (C_n |w_n| w_n n + C_t |w_t| w_t).
/// - [Added mass](Self::added_mass): a mass per area that moves with the faces, in all directions.
/// - Pressure by depth below a [level](Self::level): rho g times the depth, 0 above.
///
/// Rods with a round section have drag by their diameter, with 4/3 C_n normal to their axis, and added mass on their surface; pressure by depth does not act on them.
///
/// The work of drag counts as dissipated, that of a current as supplied. Over a closed surface pressure by depth has an energy, which counts as
/// gravitational; on other faces its work counts as supplied.
///
/// ```
/// use pliant::{
///     Body, Cells, Fluid, Material, Mesh, Phase, Sampling, Scene, Settings, simulate::Reading,
/// };
///
/// // a block half as dense as water, which is let go with its lower half in it, stays there
/// let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles)?;
/// let block = Body::new(mesh, Material::rigid(500.0)).thickness(0.1).build()?;
/// let water = Fluid::new(1000.0).drag(1.0, 0.01).added_mass(10.0).level(0.05);
/// let scene = Scene::new(block).gravity([0.0, -9.8]).fluid(water).phase(Phase::until(0.2));
/// let motion = scene.simulate(
///     &Settings::default(),
///     &Sampling::phase_ends().read("force", Reading::fluid_force("fluid 1")),
/// )?;
/// assert!((motion.last().sensors[1] - 0.5 * 9.8).abs() < 1e-9); // N, its weight
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fluid {
    name: String,
    density: f64,
    drag: [f64; 2],
    added_mass: f64,
    velocity: Option<VectorSignal>,
    level: Option<f64>,
    nodes: Option<Selection>,
}

impl Fluid {
    /// A fluid of that `density` (kg/m^3) on all faces of the boundary, without any force yet.
    pub fn new(density: f64) -> Self {
        Self {
            name: String::new(),
            density,
            drag: [0.0; 2],
            added_mass: 0.0,
            velocity: None,
            level: None,
            nodes: None,
        }
    }

    /// Name of the fluid (default: "fluid 1", "fluid 2", ... in the order of the scene).
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Coefficients of drag, C_n along the normal of a face and C_t along the face (1; default: 0).
    ///
    /// By the area that is seen from the front, a body in a flow along e has C_n times the integral of |n . e|^3 over its surface by that area: 2 C_n
    /// is the coefficient of a plate, as its front and its back both count, 4/3 C_n that of a cylinder across, C_n that of a sphere. So
    /// C_n is 0.6 to 1 for plates (1.2 to 2), 0.75 to 0.9 for cylinders (1.0 to 1.2) and 0.5 for spheres (0.5). A membrane has each face once. C_t is
    /// some 0.003 to 0.01 at Reynolds numbers of 1e4 to 1e6.
    pub fn drag(self, normal: f64, tangential: f64) -> Self {
        Self { drag: [normal, tangential], ..self }
    }

    /// Mass of the fluid (kg/m^2, per undeformed area) that moves with the faces (default: 0).
    ///
    /// It is density times the thickness of a layer. That of a sphere of radius R is R/6, of a long cylinder in cross-flow R/2, each on all of its
    /// surface; of a long plate of width c, which moves along its normal, pi c/8 on both of its sides. It acts on motion in all directions,
    /// although added mass in reality acts along the normal only. It has no weight.
    pub fn added_mass(self, per_area: f64) -> Self {
        Self { added_mass: per_area, ..self }
    }

    /// Velocity (m/s) of the fluid, a current (default: 0). Drag alone depends on it.
    pub fn velocity(self, velocity: impl Into<Vec<f64>>) -> Self {
        self.flowing(VectorSignal::Constant(velocity.into()))
    }

    /// A velocity (m/s) that changes with time (s). The inertia of the current is neglected.
    pub fn velocity_with<const D: usize>(
        self,
        velocity: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        self.flowing(VectorSignal::function(velocity))
    }

    /// A velocity that is `velocities` (m/s) at the `times` (s, ascending). In between it is interpolated linearly; before and after it is constant.
    pub fn velocity_table(
        self,
        times: impl Into<Vec<f64>>,
        velocities: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        let velocities = velocities.into_iter().map(Into::into).collect();
        self.flowing(VectorSignal::TimeTable(TimeTable::new(times.into(), velocities)))
    }

    pub(crate) fn flowing(self, velocity: VectorSignal) -> Self {
        Self { velocity: Some(velocity), ..self }
    }

    /// Height (m) of the surface above the origin, against [gravity](crate::Scene::gravity): faces below it are under pressure.
    ///
    /// On a membrane, each cell of which is one face, it presses on one side alone: that to which the normal points, from which the nodes run
    /// counter-clockwise.
    pub fn level(self, height: f64) -> Self {
        Self { level: Some(height), ..self }
    }

    /// The nodes of the faces that it acts on, those of the boundary all of whose nodes are given (default: all). Nodes inside of bodies do not
    /// matter. Where several fluids have a face, all of them act on it.
    pub fn on(self, nodes: impl Into<Selection>) -> Self {
        Self { nodes: Some(nodes.into()), ..self }
    }

    /// Name of the fluid.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Height of its surface (m), if it has one.
    pub fn surface(&self) -> Option<f64> {
        self.level
    }

    pub(crate) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The same on the nodes that `change` makes of those it was given.
    pub(crate) fn with_nodes(
        &self,
        change: impl Fn(&Selection) -> Result<Selection, InputError>,
    ) -> Result<Self, InputError> {
        Ok(Self { nodes: self.nodes.as_ref().map(change).transpose()?, ..self.clone() })
    }

    /// Where it is, with its velocities at some `times` (s), and where its mirror image is.
    ///
    /// # Errors
    /// Nodes that do not exist.
    pub(crate) fn placed(
        &self,
        mesh: &Mesh,
        map: &NodeMap,
        times: &[f64],
    ) -> Result<Placed, InputError> {
        let nodes = match &self.nodes {
            None => mesh.boundary_nodes().to_vec(),
            Some(nodes) => distinct(mesh.select(nodes)?),
        };
        let velocities = self.velocity.iter().flat_map(|velocity| {
            times.iter().flat_map(|t| velocity.components(*t, mesh.dimension()))
        });
        let own: Vec<f64> = velocities.collect();
        let mut mirrored = own.clone();
        mirrored.iter_mut().skip(map.axis).step_by(mesh.dimension()).for_each(|x| *x = -*x);
        let numbers = |nodes: &[usize], velocities: Vec<f64>| {
            nodes.iter().map(|node| *node as f64).chain(velocities).collect()
        };
        let images = map.images_of(&nodes).unwrap_or_default();
        let (name, velocity, of_nodes) = (String::new(), None, None);
        let rest = Self { name, velocity, nodes: of_nodes, ..self.clone() };
        Ok(Placed {
            likeness: format!("{rest:?}"),
            at: [numbers(&nodes, own), numbers(&images, mirrored)],
            along: nodes.iter().map(|&node| mesh.position(node)[map.axis]).collect(),
            is_line: false,
        })
    }

    /// Its velocity (m/s), if it flows.
    pub(crate) fn flow(&self) -> Option<&VectorSignal> {
        self.velocity.as_ref()
    }

    /// Times (s) at which its velocity changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        self.velocity.as_ref().map_or(&[], VectorSignal::breaks)
    }

    /// Its force on `body` in a phase with the acceleration of `gravity` (m/s^2), if there is any.
    ///
    /// # Errors
    /// Numbers out of range; a level without gravity; nodes between which there are no faces, or faces without a normal.
    pub(crate) fn force(
        &self,
        body: &Body,
        gravity: Option<&[f64]>,
    ) -> Result<FluidForce, InputError> {
        let input = |key: &str| format!("fluid \"{}\" {key}", self.name);
        let density = positive(&input("density"), self.density, "kg/m^3")?;
        for (value, key) in self.drag.into_iter().zip(["drag", "skin_drag"]) {
            not_negative(&input(key), value, "no unit")?;
        }
        not_negative(&input("added_mass"), self.added_mass, "kg/m^2")?;
        if let Some(velocity) = &self.velocity {
            velocity.validate(&input("velocity"), body.dimension(), "m/s")?;
        }
        if self.drag == [0.0; 2] && self.added_mass == 0.0 && self.level.is_none() {
            let help = "it does nothing: give drag, skin_drag, added_mass or a level";
            return Err(InputError::new(
                format!("fluid \"{}\"", self.name),
                "without effect",
                help,
            ));
        }
        let (nodes, of_rods) = self.nodes_on(body)?;
        let faces = self.faces(body, &nodes, !of_rods.is_empty())?;
        let pieces = self.pieces(body, &of_rods)?;
        let depth = match self.level {
            None => None,
            Some(level) => {
                finite(&input("level"), &[level])?;
                let strength = gravity.map_or(0.0, norm);
                let Some(gravity) = gravity.filter(|_| strength > 0.0) else {
                    let help = "there is no gravity, which says where it is deep: give gravity, or leave the level out";
                    return Err(InputError::new(input("level"), format!("{level} m"), help));
                };
                let along = |i: usize| gravity.get(i).map_or(0.0, |g| g / strength);
                let weight = density * strength;
                Some(Depth { weight, level, down: std::array::from_fn(along) })
            }
        };
        let rest = vec![0.0; body.dofs()];
        Ok(FluidForce {
            input: input("velocity"),
            is_closed: depth.is_some() && faces.is_closed(&rest, body.mesh().plane_of_symmetry()),
            carried: [self.carried(body, &faces, &rest), self.carried_by(&pieces, body)].concat(),
            rods: self.rods(body, &pieces),
            drag: Drag::new(density, self.drag),
            velocity: self.velocity.clone(),
            depth,
            faces,
        })
    }

    /// The nodes that it acts on: of faces, and of the axes of rods.
    fn nodes_on(&self, body: &Body) -> Result<(Vec<usize>, Vec<usize>), InputError> {
        let boundary = body.mesh().boundary_nodes();
        let mut nodes = match &self.nodes {
            None => boundary.to_vec(),
            Some(nodes) => body.mesh().select(nodes).map_err(|error| self.blamed(error))?,
        };
        nodes.retain(|node| boundary.binary_search(node).is_ok());
        Ok(nodes.into_iter().partition(|node| !body.is_of_rod(*node)))
    }

    /// The elements of rods with both ends among these nodes of their axes.
    ///
    /// # Errors
    /// A rod that is not round, a rod below a level.
    fn pieces(&self, body: &Body, on: &[usize]) -> Result<Vec<TubePiece>, InputError> {
        let mut pieces = Vec::new();
        let is_on = |node: &usize| on.contains(node);
        for part in body.parts().filter(|part| part.nodes.clone().any(|node| is_on(&node))) {
            let refused = |word: &str, help: &str| {
                let input = format!("fluid \"{}\" {word}", self.name);
                Err(InputError::new(input, format!("on rod \"{}\"", part.name), help))
            };
            if self.level.is_some() {
                return refused(
                    "level",
                    "pressure by depth does not act on rods: give them a fluid of their own, without a level",
                );
            }
            let Some(Some(own)) = body.tube_pieces(&part.nodes) else {
                return refused(
                    "nodes",
                    "rods are dragged by their diameter, and this one is not round: leave it out of the nodes",
                );
            };
            let own = own.into_iter();
            pieces.extend(own.filter(|piece| piece.ends.iter().all(|(node, _)| is_on(node))));
        }
        Ok(pieces)
    }

    /// The drag on pieces of rods.
    fn rods(&self, body: &Body, pieces: &[TubePiece]) -> Vec<RodDrag> {
        let drag = |piece: &TubePiece| {
            let places = piece.ends.map(|(node, _)| padded(body.mesh().position(node)));
            RodDrag::new(piece, places, body.dimension(), self.density, self.drag)
        };
        pieces.iter().filter(|_| self.drag != [0.0; 2]).map(drag).collect()
    }

    /// The mass (kg) that moves along with nodes of rods: half of that of each piece with each of its ends.
    fn carried_by(&self, pieces: &[TubePiece], body: &Body) -> Vec<([usize; 2], f64)> {
        let around = if body.dimension() == 2 { 2.0 } else { std::f64::consts::PI };
        let carried = pieces.iter().filter(|_| self.added_mass > 0.0).flat_map(|piece| {
            let mass = 0.5 * self.added_mass * around * piece.width * piece.length;
            piece.ends.map(|(node, _)| ([node; 2], mass))
        });
        carried.collect()
    }

    /// The faces between `nodes` that it acts on; there may be none if it acts on rods.
    fn faces(
        &self,
        body: &Body,
        nodes: &[usize],
        has_rods: bool,
    ) -> Result<FollowedFaces, InputError> {
        let (mesh, input) = (body.mesh(), || format!("fluid \"{}\" nodes", self.name));
        let said = || self.nodes.as_ref().map_or_else(|| "all".into(), |nodes| nodes.to_string());
        let bad = |help: String| InputError::new(input(), said(), help);
        if nodes.is_empty() && !has_rods {
            return Err(bad("none of them is on the boundary, which the fluid touches".into()));
        }
        let loaded = match nodes.is_empty() {
            true => Vec::new(),
            false => loaded_faces(body, nodes).map_err(|loose| bad(on_no_face(&loose)))?,
        };
        let faces = FollowedFaces::new(mesh, loaded);
        faces.map_err(|help| {
            bad(format!("{help}, as bars and strings have none: name those of other bodies"))
        })
    }

    fn blamed(&self, error: InputError) -> InputError {
        InputError { input: format!("fluid \"{}\" {}", self.name, error.input), ..error }
    }

    /// The mass (kg) that moves along with pairs of nodes: that of the shape functions or, on bodies whose inertia is lumped, of the nodes alone, by
    /// the scaled diagonal of each face.
    fn carried(&self, body: &Body, faces: &FollowedFaces, rest: &[f64]) -> Vec<([usize; 2], f64)> {
        if self.added_mass == 0.0 {
            return Vec::new();
        }
        let mut by_face: BTreeMap<Vec<usize>, Vec<([usize; 2], f64)>> = BTreeMap::new();
        faces.each_point(rest, |at| {
            let mass =
                self.added_mass * at.point.weight * norm(&cross(&at.tangents[0], &at.tangents[1]));
            let shares = || at.nodes.iter().copied().zip(at.point.values);
            let pairs = shares().flat_map(|(a, share)| {
                shares().map(move |(b, other)| ([a, b], mass * share * other))
            });
            by_face.entry(at.nodes.to_vec()).or_default().extend(pairs);
        });
        let mut carried = Vec::new();
        for (nodes, mut pairs) in by_face {
            if body.part_of(nodes[0]).body.inertia_kind() == Inertia::Lumped {
                let whole: f64 = pairs.iter().map(|(_, mass)| mass).sum();
                pairs.retain(|([a, b], _)| a == b);
                let trace: f64 = pairs.iter().map(|(_, mass)| mass).sum();
                pairs.iter_mut().for_each(|(_, mass)| *mass *= whole / trace);
            }
            carried.extend(pairs);
        }
        carried
    }
}
