//! A scene whose slender solid is a rod.
//!
//! Each cross section of the solid at a node of the rod is the cross section of the rod there. A force on a node of the solid
//! is shared out among nodes of the rod as the motion of the point is made of theirs, so that it does the same work.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::start::Start;
use super::{Input, LoadKind, Phase, Quantity, Scene, Smaller};
use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::elements::mesh::Selection;
use crate::elements::rod::SolidAxis;
use crate::scene::constraint::{Constrained, Constraint};

/// Shares below this part of the largest are round-off.
const ROUND_OFF: f64 = 1e-9;
const INSTEAD: &str = "leave it a solid";

/// A scene with a rod in place of a solid, and the axis of that.
#[derive(Debug, Clone)]
pub(crate) struct RodScene {
    pub(crate) scene: Scene,
    pub(crate) axis: SolidAxis,
    pub(crate) kind: Smaller,
}

impl Scene {
    /// The scene with a rod of so many `elements` in place of its slender solid, whose cross sections stay plane and keep their shape.
    ///
    /// The solid is one body in the plane or in space, with the same cross section all along a straight axis, which need not be one of
    /// space. Area, second moments, Saint-Venant's constant of torsion and shear areas are cut from its cells; the law is linear
    /// in the strains of the rod, with the moduli at small strains. Loads, gravity and Maxwell branches without a yield stress stay. Held and
    /// moved nodes make up whole cross sections at nodes of the rod: its ends, and with 10 elements its middle.
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh, Phase, Scene, SolidCells};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    /// let mesh = Mesh::cuboid([0.2, 0.01, 0.01], [41, 3, 3], SolidCells::Hexahedra)?;
    /// let beam = Scene::new(Body::new(mesh, rubber).build()?)
    ///     .gravity([0.0, 0.0, -9.8])
    ///     .phase(Phase::until(0.5).hold("left"));
    /// let rod = beam.as_rod(10)?;
    /// assert_eq!((beam.body().dofs(), rod.body().dofs()), (1107, 99));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Scenes that [`validate`](Self::validate) refuses. A solid that is not slender, whose section changes, or with its centre of shear
    /// beside the centroid. Unsupported features: several bodies, regions, fibres, rigid materials, mass damping, point masses, obstacles and
    /// touches, pressures on faces, moments and followers, initial displacements, initial velocities that differ from node to node, all
    /// components and devices, forces that are not of this crate.
    pub fn as_rod(&self, elements: usize) -> Result<Self, InputError> {
        Ok(self.rod_scene(elements)?.scene)
    }

    /// The same with the axis of the solid.
    pub(crate) fn rod_scene(&self, elements: usize) -> Result<RodScene, InputError> {
        self.validate()?;
        self.check_for_rod()?;
        let (body, axis) = self.body.as_rod(elements)?;
        let mut start = Start::rest(&body);
        start.velocities = self.uniform_velocity()?.repeat(body.mesh().node_count());
        let phases = self.phases.iter().map(|phase| {
            let mut own = phase.clone();
            let constraints = phase.constraints.iter();
            own.constraints = constraints
                .map(|constraint| self.of_sections(constraint, phase, &axis))
                .collect::<Result<_, _>>()?;
            own.inputs = self.shared_loads(phase, &axis)?;
            Ok(own)
        });
        let phases = phases.collect::<Result<_, InputError>>()?;
        let scene = Self { body: Arc::new(body), start, phases, ..self.clone() }.unreduced();
        scene.validate()?;
        Ok(RodScene { scene, axis, kind: Smaller::Rod { elements } })
    }

    /// Refuses what is not known of rods that stand for solids.
    fn check_for_rod(&self) -> Result<(), InputError> {
        self.start.refuse_branches("a rod")?;
        let inputs = self.phases.iter().flat_map(|phase| &phase.inputs);
        let others = inputs.filter(|input| !matches!(input.quantity, Quantity::Load(_)));
        let unknown = [
            ("moments, followers, pressures and other inputs of phases", others.count()),
            ("forces that are not of this crate", self.forces.len()),
            (
                self.actuators.first().map_or("actuators", |own| own.kind().list),
                self.actuators.len(),
            ),
            ("magnets", self.magnets.len()),
            ("fluids", self.fluids.len()),
            ("chambers", self.chambers.len()),
            ("obstacles", self.obstacles.len()),
            ("touches", self.touches.len()),
            ("devices", self.devices.len()),
        ];
        if let Some((name, count)) = unknown.iter().find(|(_, count)| *count > 0) {
            let help = format!(
                "they act on the surface or the inside of a solid, of which a rod has none: {INSTEAD}"
            );
            return Err(InputError::new(*name, count, help));
        }
        let moved = largest(self.initial_displacements());
        if moved > 0.0 {
            let help = format!("a rod that stands for a solid starts undeformed: {INSTEAD}");
            return Err(InputError::new("initial displacements", format!("{moved:e} m"), help));
        }
        Ok(())
    }

    /// The initial velocity that all nodes have.
    fn uniform_velocity(&self) -> Result<Vec<f64>, InputError> {
        let v = self.initial_velocities()?;
        let first = &v[..self.body.dimension()];
        if v.chunks_exact(first.len()).any(|own| own != first) {
            let help = format!("a rod that stands for a solid starts with one velocity: {INSTEAD}");
            return Err(InputError::new("initial velocities", "not the same at all nodes", help));
        }
        Ok(first.into())
    }

    /// A constraint on whole cross sections of the solid, on those of the rod.
    fn of_sections(
        &self,
        constraint: &Constraint,
        phase: &Phase,
        axis: &SolidAxis,
    ) -> Result<Constraint, InputError> {
        let input = || format!("held and moved nodes of phase \"{}\"", phase.name);
        let own = |selection: &Selection| {
            let sections = self.sections_of(selection, axis, true, input)?;
            let nodes = sections.into_iter().flat_map(|section| axis.nodes(section));
            Ok::<_, InputError>(Selection::of_nodes(nodes))
        };
        let what = match &constraint.what {
            Constrained::Nodes(selection, axes) => {
                Constrained::Nodes(own(selection)?, axes.clone())
            }
            Constrained::Along(selection, normal) => {
                Constrained::Along(own(selection)?, normal.clone())
            }
            Constrained::Row(_) => {
                let help =
                    format!("a row of several displacements is not known of a rod: {INSTEAD}");
                return Err(InputError::new(input(), "in a row of their own", help));
            }
        };
        Ok(Constraint { what, how: constraint.how.clone() })
    }

    /// The cross sections of the rod, ascending, in which nodes of the solid are; of these all nodes, if it `is_whole`.
    ///
    /// # Errors
    /// Nodes elsewhere; parts of sections.
    pub(crate) fn sections_of(
        &self,
        selection: &Selection,
        axis: &SolidAxis,
        is_whole: bool,
        input: impl Fn() -> String,
    ) -> Result<Vec<usize>, InputError> {
        let mesh = self.body.mesh();
        let section_at = |node: usize| axis.section_at(mesh.position(node));
        let nodes = mesh.select(selection)?;
        let mut counts = BTreeMap::new();
        for &node in &nodes {
            let Some(section) = section_at(node) else {
                let help = format!(
                    "node {} is in none of the cross sections between the elements of the rod: choose a number of elements with one there, or {INSTEAD}",
                    node + 1
                );
                return Err(InputError::new(input(), selection, help));
            };
            *counts.entry(section).or_insert(0) += 1;
        }
        if is_whole {
            let mut all = BTreeMap::new();
            for section in (0..mesh.node_count()).filter_map(section_at) {
                *all.entry(section).or_insert(0) += 1;
            }
            if let Some((section, count)) = counts.iter().find(|(own, count)| all[*own] != **count)
            {
                let help = format!(
                    "these are {count} of the {} nodes of a cross section, which moves as a whole in a rod: name all of them, or {INSTEAD}",
                    all[section]
                );
                return Err(InputError::new(input(), selection, help));
            }
        }
        Ok(counts.into_keys().collect())
    }

    /// The loads of a phase on nodes of the rod.
    fn shared_loads(&self, phase: &Phase, axis: &SolidAxis) -> Result<Vec<Input>, InputError> {
        let (mesh, mut inputs) = (self.body.mesh(), Vec::new());
        for (selection, kind, value) in phase.loads() {
            let nodes = mesh.select(selection)?;
            let mut sums = BTreeMap::new();
            for (&node, part) in nodes.iter().zip(self.parts(kind, selection, &nodes)?) {
                for (own, share) in axis.shares(mesh.position(node)) {
                    *sums.entry(own).or_insert(0.0) += part * share;
                }
            }
            let most = sums.values().fold(0.0_f64, |most: f64, sum: &f64| most.max(sum.abs()));
            let own = sums.into_iter().filter(|(_, sum)| sum.abs() > ROUND_OFF * most);
            inputs.extend(own.map(|(node, sum)| {
                Input::load(Selection::of_nodes([node]), LoadKind::Each, value.times(sum))
            }));
        }
        Ok(inputs)
    }
}
