//! One half of a symmetric scene.
//!
//! The scene is compared node by node (`half/symmetry.rs`), and not by the words in which it was written:
//! initial state, point masses, and at 17 times of each phase prescribed motion and the sum of the loads.
//! Shapes of obstacles are known to be symmetric or are refused, as is everything of which no half is known.
//! A load becomes one for all nodes with the same part.

mod symmetry;

use std::sync::Arc;

use super::{Input, LoadKind, Phase, Quantity, Scene};
use crate::base::input::InputError;
use crate::elements::mesh::{Mirror, Selection};
use crate::scene::constraint::{
    Axes, Axis, Constrained, Constraint, ConstraintRow, Motion, PhaseStart, prescribe,
};
use crate::scene::forces::Obstacle;
use symmetry::Symmetry;

/// One half of a symmetric scene, and which nodes it has of the whole one.
#[derive(Debug, Clone)]
#[cfg_attr(not(any(feature = "scene-file", feature = "study")), allow(dead_code))]
pub(crate) struct Half {
    pub(crate) scene: Scene,
    /// The axis that the plane is normal to.
    pub(crate) axis: Axis,
    /// Where the plane is (m).
    pub(crate) at: f64,
    /// Its nodes by their numbers in the whole scene (from 0), ascending.
    pub(crate) nodes: Vec<usize>,
    /// The mirror images of all nodes of the whole scene.
    images: Vec<usize>,
}

#[cfg(any(feature = "scene-file", feature = "study"))]
impl Half {
    /// The numbers (from 0) that some nodes of the whole scene have here; `None` if one of them is on the other side.
    fn numbers(&self, nodes: &[usize]) -> Option<Vec<usize>> {
        nodes.iter().map(|node| self.nodes.binary_search(node).ok()).collect()
    }

    /// The nodes that have the same mean place along the plane as these of the whole scene have: themselves where all are on this
    /// side, and else those of each pair that are. `None` if there are none, or some nodes have no pair, or are on the
    /// plane beside others that are not. The flag is whether they are all themselves.
    pub(crate) fn standing_for(&self, nodes: &[usize]) -> Option<(Selection, bool)> {
        if let Some(own) = self.numbers(nodes) {
            return Some((Selection::of_nodes(own), true));
        }
        let has_pair =
            |node: &usize| self.images[*node] != *node && nodes.contains(&self.images[*node]);
        if !nodes.iter().all(has_pair) {
            return None;
        }
        let own = nodes.iter().filter_map(|node| self.nodes.binary_search(node).ok());
        Some((Selection::of_nodes(own), false))
    }
}

impl Scene {
    /// The half of a symmetric scene below its plane of symmetry, which is normal to `axis` and goes through the middle of the body.
    ///
    /// It moves as the whole scene does, as long as that stays symmetric: a column that buckles does not, nor does what is pushed
    /// by round-off out of an unstable place. Nodes on the plane slide in it ([`Phase::symmetry`]), with half of their loads, point masses and
    /// contact stiffness per node; the cut is no surface. Energies and forces are half of those of the whole scene.
    ///
    /// ```
    /// use pliant::{Axis, Body, Cells, Material, Mesh, Obstacle, Phase, Scene};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    /// let mesh = Mesh::rectangle([0.2, 0.1], [5, 3], Cells::Rectangles)?;
    /// let block = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
    ///     .gravity([0.0, -9.8])
    ///     .obstacle(Obstacle::half_plane([0.0, -0.01], [0.0, 1.0]).stiffness(100.0))
    ///     .phase(Phase::until(0.5));
    /// let half = block.symmetric_half(Axis::X)?;
    /// assert_eq!(half.body().mesh().node_count(), 9);
    /// // gravity pulls along the y axis
    /// assert!(block.symmetric_half(Axis::Y).is_err());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Scenes that [`validate`](Self::validate) refuses. A mesh in which a node has no mirror image, or a cell lies
    /// across the plane; anything else that is not symmetric: materials, prescribed displacements, loads, pressures on
    /// faces, gravity, the start, obstacles. Unsupported features: several bodies, rigid and fibrous materials, springs
    /// and other actuators, chambers, fluids, bodies that touch, forces that are not of this crate.
    pub fn symmetric_half(&self, axis: Axis) -> Result<Self, InputError> {
        Ok(self.half(axis, false)?.scene)
    }

    /// As [`symmetric_half`](Self::symmetric_half), of the side above the plane if `is_upper`.
    pub(crate) fn half(&self, axis: Axis, is_upper: bool) -> Result<Half, InputError> {
        self.validate()?;
        self.start.refuse_branches("a half")?;
        self.body.refuse_around("half of the scene", format!("at a plane across {axis:?}"))?;
        let symmetry = Symmetry::of(self, axis)?;
        let mirror = &symmetry.mirror;
        let mesh = self.body.mesh();
        let along = |node: usize| mesh.position(node)[mirror.axis] - mirror.at;
        let keeps: Vec<bool> = (0..mesh.node_count())
            .map(|node| mirror.is_on_plane(node) || (along(node) > 0.0) == is_upper)
            .collect();
        let body = self.body.to_builder().half(&keeps, |node| mirror.is_on_plane(node))?.build()?;
        let nodes = (0..keeps.len()).filter(|&node| keeps[node]).collect();
        let mut half = Half {
            scene: self.clone().unreduced(),
            axis,
            at: mirror.at,
            nodes,
            images: mirror.images.clone(),
        };
        let d = mesh.dimension();
        let kept =
            |x: &[f64]| half.nodes.iter().flat_map(|node| &x[node * d..][..d]).copied().collect();
        let displacements: Vec<f64> = kept(self.initial_displacements());
        let velocities: Vec<f64> = kept(&self.initial_velocities()?);
        let mut start = super::start::Start::rest(&body);
        (start.displacements, start.velocities) = (displacements, velocities);
        let size = self.body.size();
        let as_here = |obstacle: &Obstacle| match obstacle.sticks_below(size) {
            Some(speed) => obstacle.clone().sticking_speed(speed),
            None => obstacle.clone(),
        };
        let mut phases = Vec::new();
        let (mut time, mut u) = (0.0, self.initial_displacements().to_vec());
        for phase in &self.phases {
            let mut own = phase.clone();
            let rows = self.rows(phase, &PhaseStart { time, u: &u })?;
            own.constraints = self.half_of_constraints(phase, &rows, &half, mirror)?;
            own.without_inputs(Quantity::is_known_of_parts);
            own.inputs.extend(self.half_of_loads(phase, &half, mirror)?);
            for (selection, pressure) in phase.face_pressures() {
                if let Some(nodes) = self.kept_faces(selection, &half, mirror)? {
                    own = own.pressure_on(nodes, pressure.clone());
                }
            }
            own.redirected = phase.redirected.iter().map(as_here).collect();
            prescribe(&rows, phase.until, &mut u);
            time = phase.until;
            phases.push(own);
        }
        let scene = &mut half.scene;
        scene.obstacles = self.obstacles.iter().map(as_here).collect();
        (scene.body, scene.start, scene.phases) = (Arc::new(body), start, phases);
        scene.validate()?;
        Ok(half)
    }

    /// Those nodes of a selection that the half has, if there are any.
    fn kept(&self, nodes: &Selection, half: &Half) -> Result<Option<Selection>, InputError> {
        let own = self.body.mesh().select(nodes)?;
        let own = own.iter().filter_map(|node| half.nodes.binary_search(node).ok());
        let own: Vec<usize> = own.collect();
        Ok((!own.is_empty()).then(|| Selection::of_nodes(own)))
    }

    /// The same, of nodes that name faces: none where only nodes of the plane are left of them.
    fn kept_faces(
        &self,
        nodes: &Selection,
        half: &Half,
        mirror: &Mirror,
    ) -> Result<Option<Selection>, InputError> {
        let own = self.body.mesh().select(nodes)?;
        let is_beside =
            |node: &usize| !mirror.is_on_plane(*node) && half.nodes.binary_search(node).is_ok();
        if own.iter().any(is_beside) { self.kept(nodes, half) } else { Ok(None) }
    }

    /// Constraints of the half, with those of its plane of symmetry.
    fn half_of_constraints(
        &self,
        phase: &Phase,
        rows: &[ConstraintRow],
        half: &Half,
        mirror: &Mirror,
    ) -> Result<Vec<Constraint>, InputError> {
        let d = self.body.dimension();
        let mut constraints = Vec::new();
        for Constraint { what, how } in &phase.constraints {
            let kept = match what {
                Constrained::Nodes(nodes, axes) => {
                    self.kept(nodes, half)?.map(|nodes| Constrained::Nodes(nodes, axes.clone()))
                }
                Constrained::Along(nodes, normal) => {
                    self.kept(nodes, half)?.map(|nodes| Constrained::Along(nodes, normal.clone()))
                }
                // refused before
                Constrained::Row(_) => None,
            };
            constraints.extend(kept.map(|what| Constraint { what, how: how.clone() }));
        }
        let is_held = |node: usize| {
            let dof = node * d + mirror.axis;
            rows.iter().filter_map(|row| row.nodal()).any(|(own, _)| own == dof)
        };
        let free = half.nodes.iter().enumerate();
        let free = free.filter(|(_, node)| mirror.is_on_plane(**node) && !is_held(**node));
        let free: Vec<usize> = free.map(|(number, _)| number).collect();
        if !free.is_empty() {
            let what = Constrained::Nodes(Selection::of_nodes(free), Axes::These(vec![half.axis]));
            constraints.push(Constraint { what, how: Motion::Hold });
        }
        Ok(constraints)
    }

    /// The loads on the half, those on nodes by the part of each: half on the plane.
    fn half_of_loads(
        &self,
        phase: &Phase,
        half: &Half,
        mirror: &Mirror,
    ) -> Result<Vec<Input>, InputError> {
        let mut loads = Vec::new();
        for (selection, kind, value) in phase.loads() {
            if kind == LoadKind::Traction {
                let kept = self.kept_faces(selection, half, mirror)?;
                loads.extend(kept.map(|nodes| Input::load(nodes, kind, value.clone())));
                continue;
            }
            let nodes = self.body.mesh().select(selection)?;
            let parts = self.parts(kind, selection, &nodes)?;
            // nodes with the same part, to round-off, have one load
            let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
            for (node, part) in nodes.iter().zip(parts) {
                let Ok(number) = half.nodes.binary_search(node) else { continue };
                let part = if mirror.is_on_plane(*node) { 0.5 * part } else { part };
                let same =
                    |(other, _): &&mut (f64, _)| (*other - part).abs() <= SAME_PART * part.abs();
                match groups.iter_mut().find(same) {
                    Some((_, numbers)) => numbers.push(number + 1),
                    None => groups.push((part, vec![number + 1])),
                }
            }
            let each = |(part, numbers): (f64, Vec<usize>)| {
                Input::load(numbers.into(), LoadKind::Each, value.times(part))
            };
            loads.extend(groups.into_iter().map(each));
        }
        Ok(loads)
    }
}

/// Parts of a load that differ by less than this, relative to them, are the same but for round-off.
const SAME_PART: f64 = 1e-12;
