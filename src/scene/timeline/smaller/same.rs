//! Whether a scene is the same in its images: initial state, point masses, materials, and at 17 times of each phase prescribed motion
//! and the sum of the loads.

use std::iter;

use super::super::{Phase, Quantity, Scene};
use crate::base::input::{InputError, four_digits};
use crate::base::vector::{distinct, largest};
use crate::elements::mesh::{Mesh, NodeMap, Selection};
use crate::scene::constraint::{Axis, ConstraintRow, PhaseStart, prescribe, rows};
use crate::scene::forces::{Obstacle, Signal};

/// Differences below this part of the largest value are round-off.
pub(super) const SAME: f64 = 1e-9;
/// Number of times in each phase at which time-dependent quantities are compared.
const TIMES: u32 = 17;

/// Checks that a scene is the same in its images, and returns which nodes are held along the axis in each phase.
///
/// # Errors
/// A part of the scene that differs in its image, or whose image is not known.
pub(super) fn check(same: &Same) -> Result<Vec<Vec<bool>>, InputError> {
    let (scene, map) = (same.scene, same.map);
    let model = if map.is_section() { "a section" } else { "a half" };
    scene.start.refuse_branches(model)?;
    scene.body.refuse_around("half of the scene", format!("at a plane across {}", same.axis()))?;
    same.check_known(model)?;
    same.check_cells()?;
    same.check_bodies()?;
    let (u, v) = (scene.initial_displacements(), scene.initial_velocities()?);
    let d = scene.body.dimension();
    same.check_field("initial displacements", u, 0..d)?;
    same.check_field("initial velocities", &v, 0..d)?;
    same.check_point_masses()?;
    let mut reached = u.to_vec();
    same.phase_starts().map(|(phase, time)| same.check_phase(phase, time, &mut reached)).collect()
}

/// Times (s) of a phase that begins at `start` (s), at which things are compared.
pub(super) fn times(phase: &Phase, start: f64) -> Vec<f64> {
    let part = |k: u32| start + f64::from(k) / f64::from(TIMES - 1) * (phase.until - start);
    (0..TIMES).map(part).collect()
}

/// A scene and the map of its nodes.
pub(super) struct Same<'a> {
    pub(super) scene: &'a Scene,
    pub(super) map: &'a NodeMap,
}

impl<'s> Same<'s> {
    /// The phases with the times (s) at which they start.
    pub(super) fn phase_starts(&self) -> impl Iterator<Item = (&'s Phase, f64)> {
        let phases = &self.scene.phases;
        phases.iter().zip(iter::once(0.0).chain(phases.iter().map(|phase| phase.until)))
    }

    fn axis(&self) -> &'static str {
        Axis::all(3)[self.map.axis].word()
    }

    /// The alternative to the smaller scene, for messages.
    pub(super) fn instead(&self) -> &'static str {
        if self.map.is_section() { "leave the scene in space" } else { "leave the scene whole" }
    }

    /// The error for something that is not the same in its image.
    pub(super) fn refused(&self, input: impl Into<String>, value: impl Into<String>) -> InputError {
        let (axis, instead) = (self.axis(), self.instead());
        let broken = match self.map.is_section() {
            true => format!("it is not the same all along {axis}, or points along {axis}"),
            false => {
                let at = four_digits(self.map.ends[0]);
                format!("it is not symmetric to the plane {axis} = {at} m")
            }
        };
        InputError::new(input, value.into(), format!("{broken}: make it so, or {instead}"))
    }

    /// Refuses what `model`, as in "a half", of is not known.
    fn check_known(&self, model: &str) -> Result<(), InputError> {
        let (scene, body) = (self.scene, &self.scene.body);
        let is_section = self.map.is_section();
        let of_section = |count: usize| if is_section { count } else { 0 };
        let is_known = |quantity: Quantity| {
            let is_set_by_halves = matches!(quantity, Quantity::Field | Quantity::Device(_));
            quantity.is_known_of_parts() || (!is_section && is_set_by_halves)
        };
        let inputs = scene.phases.iter().flat_map(|phase| &phase.inputs);
        let unknown_inputs = inputs.filter(|input| !is_known(input.quantity));
        let actuators = scene.actuators.first().map_or("actuators", |own| own.kind().list);
        let substances = || body.substances();
        let unknown = [
            ("moments, followers and other inputs of phases", unknown_inputs.count()),
            ("forces that are not of this crate", scene.forces.len()),
            (actuators, of_section(scene.actuators.len())),
            ("magnets", of_section(scene.magnets.len())),
            ("fluids", of_section(scene.fluids.len())),
            ("chambers", of_section(scene.chambers.len())),
            ("touches", of_section(scene.touches.len())),
            ("devices", of_section(scene.devices.len())),
            ("rigid materials", of_section(substances().filter(|of| of.is_rigid).count())),
            ("families of fibres", of_section(substances().map(|of| of.fibres.len()).sum())),
        ];
        match unknown.iter().find(|(_, count)| *count > 0) {
            Some((name, count)) => {
                let help = format!("{model} does not support them: {}", self.instead());
                Err(InputError::new(*name, count, help))
            }
            None => Ok(()),
        }
    }

    /// No cell lies across the plane of symmetry or in it.
    fn check_cells(&self) -> Result<(), InputError> {
        let (map, body) = (self.map, &self.scene.body);
        for (number, cell) in (1..).zip(body.mesh().cells()) {
            let mut sides = cell.iter().filter(|&&node| !map.is_on_plane(node));
            let first = sides.next().map(|&node| map.numbers[node].is_some());
            if first.is_none() || sides.any(|&node| Some(map.numbers[node].is_some()) != first) {
                let (axis, at) = (self.axis(), four_digits(map.ends[0]));
                let help = format!(
                    "it lies across the plane of symmetry {axis} = {at} m or in it: take an even number of cells across it"
                );
                return Err(InputError::new("cell", number, help));
            }
        }
        Ok(())
    }

    /// Refuses vectors at the nodes that differ from their images along some `axes`.
    fn check_field(
        &self,
        name: &str,
        x: &[f64],
        axes: std::ops::Range<usize>,
    ) -> Result<(), InputError> {
        let (d, limit) = (self.scene.body.dimension(), SAME * largest(x));
        for dof in (0..x.len()).filter(|dof| axes.contains(&(dof % d))) {
            let (image, factor) = self.map.image(dof, d);
            let off = (x[dof] - factor * x[image]).abs();
            if off > limit || off.is_nan() {
                let node = dof / d;
                let value = format!("of node {}: {:?}", node + 1, &x[node * d..][..d]);
                return Err(self.refused(name, value));
            }
        }
        Ok(())
    }

    /// Checks what is of a phase, and returns which nodes are held along the axis; `reached` are the displacements that are prescribed at
    /// its start `time` (s), and then at its end.
    fn check_phase(
        &self,
        phase: &Phase,
        time: f64,
        reached: &mut [f64],
    ) -> Result<Vec<bool>, InputError> {
        let (scene, axis, d) = (self.scene, self.map.axis, self.scene.body.dimension());
        let named = |what: &str| format!("{what} of phase \"{}\"", phase.name);
        if let Some(gravity) = scene.gravity_in(phase)
            && gravity[axis].abs() > SAME * largest(gravity)
        {
            return Err(self.refused(named("gravity"), format!("{gravity:?}")));
        }
        let times = times(phase, time);
        for obstacle in phase.contacts(&scene.obstacles)? {
            self.obstacle(obstacle, &times)?;
        }
        let held = self.check_constraints(phase, &times, reached)?;
        // what nodes of a line along the axis share is added up, however they share it
        let axes = if self.map.is_section() { axis..axis + 1 } else { 0..d };
        let mut forces = vec![0.0; scene.body.dofs()];
        for &t in &times {
            forces.fill(0.0);
            for (node, force) in scene.loads_at(phase, t)? {
                forces[node * d..][..d].iter_mut().zip(force).for_each(|(sum, f)| *sum += f);
            }
            self.check_field(&named("loads"), &forces, axes.clone())?;
        }
        self.check_pressures(phase, &times)?;
        Ok(held)
    }

    /// Pressures on faces: each has its image, or is its own. `times` (s) are of the phase.
    fn check_pressures(&self, phase: &Phase, times: &[f64]) -> Result<(), InputError> {
        let mesh = self.scene.body.mesh();
        let all = phase.face_pressures().map(|(selection, pressure)| {
            let nodes = distinct(mesh.select(selection)?);
            Ok((selection, pressure, self.map.images_of(&nodes), nodes))
        });
        let all = all.collect::<Result<Vec<(&Selection, &Signal, _, _)>, InputError>>()?;
        for (selection, pressure, image, nodes) in &all {
            let is_image = |(_, other, _, nodes): &(&Selection, &Signal, _, Vec<usize>)| {
                image.as_ref() == Some(nodes)
                    && times.iter().all(|&t| other.at(t) == pressure.at(t))
            };
            let is_at_end = self.map.is_section() && self.has_end_face(nodes);
            if is_at_end || !all.iter().any(is_image) {
                let value = match is_at_end {
                    true => format!("{selection}, on an end of it"),
                    false => selection.to_string(),
                };
                let input = format!("pressure on faces of phase \"{}\"", phase.name);
                return Err(self.refused(input, value));
            }
        }
        Ok(())
    }

    /// Whether some nodes (from 0) have one in each place of a cell of a section.
    fn has_end_face(&self, nodes: &[usize]) -> bool {
        let Some(section) = &self.map.meshes[0] else { return false };
        // middles that stand for no node are there, too
        let mut is_there = vec![true; section.node_count()];
        self.map.numbers.iter().flatten().for_each(|&number| is_there[number] = false);
        nodes.iter().filter_map(|&node| self.map.numbers[node]).for_each(|k| is_there[k] = true);
        section.cells().any(|cell| cell.iter().all(|&node| is_there[node]))
    }

    /// Checks that prescribed displacements are those of their images, node by node, and returns which nodes have one along the axis.
    fn check_constraints(
        &self,
        phase: &Phase,
        times: &[f64],
        reached: &mut [f64],
    ) -> Result<Vec<bool>, InputError> {
        let (d, input) = (
            self.scene.body.dimension(),
            format!("held and moved nodes of phase \"{}\"", phase.name),
        );
        // those of ties are looked at by themselves, and devices of halves have none
        let start = PhaseStart { time: times[0], u: reached };
        let rows = rows(phase.constraints.iter(), &self.scene.body, &phase.name, &start)?;
        let mut by_dof: Vec<Option<(&ConstraintRow, f64)>> = vec![None; reached.len()];
        for row in &rows {
            let Some((dof, coefficient)) = row.nodal() else {
                let instead = self.instead();
                let help = format!(
                    "smaller scenes do not support constraints on several displacements together: hold axes of nodes, or {instead}"
                );
                return Err(InputError::new(input, row.label(d), help));
            };
            by_dof[dof] = Some((row, coefficient));
        }
        let at = |(row, coefficient): (&ConstraintRow, f64), t: f64| {
            row.prescribed(t).displacement / coefficient
        };
        let tolerance = SAME * self.scene.body.size();
        for (dof, own) in by_dof.iter().enumerate() {
            let (image, factor) = self.map.image(dof, d);
            // along the axis of a section some may be free
            let other = if factor == 0.0 { own } else { &by_dof[image] };
            let is_same = match (own, other) {
                (Some(own), Some(other)) => {
                    times.iter().all(|&t| (at(*own, t) - factor * at(*other, t)).abs() <= tolerance)
                }
                _ => own.is_none() && other.is_none(),
            };
            if let (false, Some((row, _))) = (is_same, own.or(*other)) {
                return Err(self.refused(input, row.label(d)));
            }
        }
        prescribe(&rows, phase.until, reached);
        Ok((0..reached.len() / d).map(|node| by_dof[node * d + self.map.axis].is_some()).collect())
    }

    /// An obstacle in the smaller scene.
    ///
    /// # Errors
    /// One that is not known to be the same in its image at some `times` (s).
    pub(super) fn obstacle(
        &self,
        obstacle: &Obstacle,
        times: &[f64],
    ) -> Result<Obstacle, InputError> {
        let (map, size) = (self.map, self.scene.body.size());
        let named = || format!("\"{}\"", obstacle.name());
        let own = obstacle.by_map(map, times, SAME * size);
        let mut own = own.ok_or_else(|| self.refused("obstacle", named()))?;
        if let Some(speed) = obstacle.sticks_below(size) {
            own = own.sticking_speed(speed);
        }
        if own.is_per_area() || !map.is_section() {
            return Ok(own);
        }
        // what several nodes in one place have together
        let section = map.meshes.iter().flatten();
        let mut counts = vec![0; section.clone().map(Mesh::node_count).sum()];
        map.numbers.iter().flatten().for_each(|&node| counts[node] += 1);
        let mut counts = section.flat_map(Mesh::boundary_nodes).map(|&node| counts[node]);
        let count = counts.next().unwrap_or(1);
        if counts.all(|other| other == count) {
            return Ok(own.shared_out(f64::from(count)));
        }
        let help = "it is per node, and lines along the axis have different numbers of these: give it per area (stiffness_density)";
        Err(InputError::new("stiffness of obstacle", named(), help))
    }
}
