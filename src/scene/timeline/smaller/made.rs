//! The smaller scene: what is left of a scene that is the same in its images.
//!
//! A load keeps its kind where the smaller scene shares it out as the sums of the shares are, so that finer
//! meshes have it right, and is a force on each node otherwise. In a mean over nodes each node counts as
//! often as the mean in the whole has nodes that it stands for (`Reading::counted`). Hexahedra between held
//! ends are the quadrilaterals of the section, to round-off.

use std::sync::Arc;

use super::super::start::Start;
use super::super::{Input, LoadKind, Phase, Quantity, Scene};
use super::same::{SAME, Same};
use crate::base::input::InputError;
use crate::base::vector::axes_across;
use crate::elements::material::Plane;
use crate::elements::mesh::Selection;
use crate::scene::constraint::{Axes, Axis, Constrained, Constraint, Motion, Turn};
use crate::scene::forces::Obstacle;

/// Parts of a load that differ by less than this, relative to them, are the same but for round-off.
const SAME_PART: f64 = 1e-12;

/// The smaller scene by a map, in plane strain or plane stress if it is a section; `held` are the nodes that are held along its axis in
/// each phase.
pub(super) fn made(same: &Same, held: &[Vec<bool>]) -> Result<(Scene, Option<Plane>), InputError> {
    let (whole, map) = (same.scene, same.map);
    let plane = map.is_section().then(|| same.plane(held)).transpose()?;
    let body = whole.body.to_builder().by_map(map, plane)?.build()?;
    let mut start = Start::rest(&body);
    start.displacements = map.field(whole.initial_displacements());
    start.velocities = map.field(&whole.initial_velocities()?);
    let mut scene = whole.clone().unreduced();
    (scene.body, scene.start) = (Arc::new(body), start);
    scene.gravity = whole.gravity.as_ref().map(|gravity| map.vector(gravity));
    // those that act have been checked; others may be none of the smaller scene
    let obstacles = |all: &[Obstacle]| {
        all.iter().filter_map(|obstacle| same.obstacle(obstacle, &[]).ok()).collect()
    };
    scene.obstacles = obstacles(&whole.obstacles);
    let components = same.components()?;
    same.keep(&components, &mut scene)?;
    (scene.ties, scene.touches) = (same.ties()?, same.touches()?);
    (scene.magnets, scene.devices) = (same.magnets()?, same.devices()?);
    let phases = whole.phases.iter().zip(held).map(|(phase, held)| {
        let mut own = phase.clone();
        own.gravity = phase.gravity.as_ref().map(|gravity| map.vector(gravity));
        own.constraints = same.constraints(phase, held)?;
        own.without_inputs(Quantity::is_known_of_parts);
        own.inputs.extend(same.loads(phase, &scene)?);
        own.inputs.extend(same.driven(phase, &components));
        for (selection, pressure) in phase.face_pressures() {
            if let Some(nodes) = same.faces(selection, phase)? {
                own = own.pressure_on(nodes, pressure.clone());
            }
        }
        own.redirected = obstacles(&phase.redirected);
        Ok(own)
    });
    scene.phases = phases.collect::<Result<_, InputError>>()?;
    scene.validate()?;
    Ok((scene, plane))
}

impl Same<'_> {
    /// Plane strain if all nodes of both ends are `held` along the axis, else plane stress.
    fn plane(&self, held: &[Vec<bool>]) -> Result<Plane, InputError> {
        let (mesh, tolerance) = (self.scene.body.mesh(), SAME * self.scene.body.size());
        let is_at_end = |node: &usize| {
            let x = mesh.position(*node)[self.map.axis];
            self.map.ends.iter().any(|end| (x - end).abs() <= tolerance)
        };
        let ends: Vec<usize> = (0..mesh.node_count()).filter(is_at_end).collect();
        let is_strain = |held: &Vec<bool>| ends.iter().all(|&node| held[node]);
        let phases = &self.scene.phases;
        if let Some(other) = held.iter().position(|own| is_strain(own) != is_strain(&held[0])) {
            let input = format!("ends held along {}", Axis::all(3)[self.map.axis].word());
            let value = format!("not as in phase \"{}\"", phases[0].name);
            let help = format!(
                "a plane model is in plane strain or in plane stress all the time: hold them in phase \"{}\" as there, or {}",
                phases[other].name,
                self.instead()
            );
            return Err(InputError::new(input, value, help));
        }
        Ok(if is_strain(&held[0]) { Plane::Strain } else { Plane::Stress })
    }

    /// The nodes that stand for those of a selection (from 0).
    ///
    /// # Errors
    /// Parts of lines along the axis of a section.
    fn nodes(&self, selection: &Selection, input: &str) -> Result<Vec<usize>, InputError> {
        let nodes = self.scene.body.mesh().select(selection)?;
        self.map.whole(&nodes).ok_or_else(|| {
            let help = format!(
                "it has some nodes of a line along {} and leaves others out: name all of them, or {}",
                Axis::all(3)[self.map.axis].word(),
                self.instead()
            );
            InputError::new(input, selection, help)
        })
    }

    /// The same of nodes that name faces: none where only nodes of a plane of symmetry are left of them.
    fn faces(&self, nodes: &Selection, phase: &Phase) -> Result<Option<Selection>, InputError> {
        let all = self.scene.body.mesh().select(nodes)?;
        let is_beside =
            |&node: &usize| !self.map.is_on_plane(node) && self.map.numbers[node].is_some();
        let own = self.nodes(nodes, &format!("pressure on faces of phase \"{}\"", phase.name))?;
        Ok(all.iter().any(is_beside).then(|| Selection::of_nodes(own)))
    }

    /// Constraints of the smaller scene, with those of a plane of symmetry whose nodes are not `held` along its axis.
    fn constraints(&self, phase: &Phase, held: &[bool]) -> Result<Vec<Constraint>, InputError> {
        let input = format!("held and moved nodes of phase \"{}\"", phase.name);
        let (map, d) = (self.map, self.scene.body.dimension());
        let own_axis = |axis: &Axis| {
            let place = map.axes().iter().position(|own| *own == axis.index());
            place.map(|place| Axis::all(3)[place])
        };
        let mut constraints = Vec::new();
        for Constraint { what, how } in &phase.constraints {
            let (selection, axes) = match what {
                Constrained::Nodes(selection, Axes::All) => (selection, Axis::all(d).to_vec()),
                Constrained::Nodes(selection, Axes::These(axes)) => (selection, axes.clone()),
                // each of its rows is of one axis
                Constrained::Along(selection, normal) => {
                    let length = |axis: &Axis| normal[axis.index()].abs();
                    let longest =
                        Axis::all(d).iter().max_by(|a, b| length(a).total_cmp(&length(b)));
                    (selection, longest.copied().into_iter().collect())
                }
                // refused before
                Constrained::Row(_) => continue,
            };
            let own: Vec<Axis> = axes.iter().filter_map(own_axis).collect();
            if own.is_empty() {
                continue;
            }
            let nodes = self.nodes(selection, &input)?;
            let how = match how {
                Motion::Velocity(velocity) => {
                    let own =
                        axes.iter().zip(velocity).filter(|(axis, _)| own_axis(axis).is_some());
                    Motion::Velocity(own.map(|(_, velocity)| *velocity).collect())
                }
                Motion::Turn(turn) if map.is_section() => {
                    // x and z are a left-handed pair
                    let sign = if map.axis == 1 { -1.0 } else { 1.0 };
                    Motion::Turn(Arc::new(Turn {
                        centre: map.vector(&turn.centre),
                        axis: vec![sign * turn.axis[map.axis]],
                        angles: turn.angles.clone(),
                    }))
                }
                // the same for all axes
                how => how.clone(),
            };
            if !nodes.is_empty() {
                let what = Constrained::Nodes(Selection::of_nodes(nodes), Axes::These(own));
                constraints.push(Constraint { what, how });
            }
        }
        let free = (0..held.len()).filter(|&node| map.is_on_plane(node) && !held[node]);
        let free = Selection::of_nodes(free.filter_map(|node| map.numbers[node]));
        if free != Selection::of_nodes([]) {
            let axis = Axes::These(vec![Axis::all(3)[map.axis]]);
            let what = Constrained::Nodes(free, axis);
            constraints.push(Constraint { what, how: Motion::Hold });
        }
        Ok(constraints)
    }

    /// Loads on the smaller `scene`: the sums of the shares that the whole has in each place. A load stays of its kind where the smaller
    /// scene shares it out in the same way.
    fn loads(&self, phase: &Phase, scene: &Scene) -> Result<Vec<Input>, InputError> {
        let (map, input) = (self.map, format!("loads of phase \"{}\"", phase.name));
        let mut loads = Vec::new();
        for (selection, kind, value) in phase.loads() {
            let own = self.nodes(selection, &input)?;
            let nodes = self.scene.body.mesh().select(selection)?;
            let mut sums = vec![0.0; scene.body.mesh().node_count()];
            for (&node, part) in nodes.iter().zip(self.scene.parts(kind, selection, &nodes)?) {
                if let Some(number) = map.numbers[node] {
                    sums[number] += map.share(node) * part;
                }
            }
            let value = match map.is_section() {
                true => value.part(axes_across(map.axis)),
                false => value.clone(),
            };
            let selection = Selection::of_nodes(own.clone());
            if let Ok(parts) = scene.parts(kind, &selection, &own) {
                let most = parts.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
                let is_same =
                    |(&node, part): (&usize, &f64)| (sums[node] - part).abs() <= SAME * most;
                if !own.is_empty() && own.iter().zip(&parts).all(is_same) {
                    loads.push(Input::load(selection, kind, value));
                    continue;
                }
            }
            // nodes with the same part, to round-off, have one load
            let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
            for node in own.into_iter().filter(|&node| sums[node] != 0.0) {
                let part = sums[node];
                let is_same =
                    |(other, _): &&mut (f64, _)| (*other - part).abs() <= SAME_PART * part.abs();
                match groups.iter_mut().find(is_same) {
                    Some((_, nodes)) => nodes.push(node),
                    None => groups.push((part, vec![node])),
                }
            }
            loads.extend(groups.into_iter().map(|(part, nodes)| {
                Input::load(Selection::of_nodes(nodes), LoadKind::Each, value.times(part))
            }));
        }
        Ok(loads)
    }
}
