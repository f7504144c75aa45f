//! Whether a scene is the same all along an axis.

use super::super::smaller::{SAME, check_known, times_of};
use super::super::{Phase, Scene};
use crate::base::input::InputError;
use crate::base::vector::largest;
use crate::elements::material::Plane;
use crate::elements::mesh::{Mesh, Prism, Selection};
use crate::scene::constraint::{Axis, ConstraintRow, PhaseStart, prescribe};
use crate::scene::forces::Obstacle;

/// A scene that is the same all along an axis.
pub(super) struct Uniform<'a> {
    scene: &'a Scene,
    pub(super) axis: Axis,
    pub(super) prism: Prism,
    pub(super) plane: Plane,
}

impl<'a> Uniform<'a> {
    /// The scene whose mesh is this prism.
    ///
    /// # Errors
    /// Quantities that vary along its axis or point along it; unsupported features.
    pub(super) fn of(scene: &'a Scene, prism: Prism) -> Result<Self, InputError> {
        let axis = Axis::all(3)[prism.axis];
        check_known(scene, "a section", SPACE)?;
        let mut uniform = Self { scene, axis, prism, plane: Plane::Strain };
        uniform.check_field("initial displacements", scene.initial_displacements())?;
        uniform.check_field("initial velocities", &scene.initial_velocities()?)?;
        let (mut time, mut reached) = (0.0, scene.initial_displacements().to_vec());
        let mut planes = Vec::new();
        for phase in &scene.phases {
            planes.push(uniform.check_phase(phase, time, &mut reached)?);
            time = phase.until;
        }
        uniform.plane = planes[0];
        match planes.iter().position(|plane| *plane != planes[0]) {
            None => Ok(uniform),
            Some(number) => {
                let input = format!("ends held along {}", axis.word());
                let value = format!("not as in phase \"{}\"", scene.phases[0].name);
                let help = format!(
                    "a plane model is in plane strain or in plane stress all the time: hold them in phase \"{}\" as there, or {SPACE}",
                    scene.phases[number].name
                );
                Err(InputError::new(input, value, help))
            }
        }
    }

    pub(super) fn mesh(&self) -> &Mesh {
        self.scene.body.mesh()
    }

    /// The error for something that is not the same all along.
    pub(super) fn refused(&self, input: &str, value: impl Into<String>) -> InputError {
        let help = format!(
            "it is not the same all along {0}, or points along {0}: {1}",
            self.axis.word(),
            MEND
        );
        InputError::new(input, value.into(), help)
    }

    /// The nodes of the section for a selection that has all nodes in each place.
    pub(super) fn whole(
        &self,
        selection: &Selection,
        input: &str,
    ) -> Result<Vec<usize>, InputError> {
        let nodes = self.mesh().select(selection)?;
        self.prism.whole_columns(&nodes).ok_or_else(|| {
            let help = format!(
                "it has some nodes of a line along {} and leaves others out: name all of them, or {SPACE}",
                self.axis.word()
            );
            InputError::new(input, selection, help)
        })
    }

    /// Refuses vectors at the nodes that differ in one place of the section, or have a component along the axis.
    fn check_field(&self, name: &str, x: &[f64]) -> Result<(), InputError> {
        let (limit, axis) = (SAME * largest(x), self.axis.index());
        for nodes in self.prism.nodes.iter().filter(|nodes| !nodes.is_empty()) {
            for &node in nodes {
                let off = |i: usize| match i == axis {
                    true => x[3 * node + i],
                    false => x[3 * node + i] - x[3 * nodes[0] + i],
                };
                if (0..3).any(|i| off(i).abs() > limit || off(i).is_nan()) {
                    let value = format!("of node {}: {:?}", node + 1, &x[3 * node..][..3]);
                    return Err(self.refused(name, value));
                }
            }
        }
        Ok(())
    }

    /// Checks what is of a phase, and tells whether it is in plane strain; `reached` are the displacements that are prescribed at its start
    /// `time` (s), and then at its end.
    fn check_phase(
        &self,
        phase: &Phase,
        time: f64,
        reached: &mut [f64],
    ) -> Result<Plane, InputError> {
        let named = |what: &str| format!("{what} of phase \"{}\"", phase.name);
        let along = self.axis.index();
        if let Some(gravity) = self.scene.gravity_in(phase)
            && gravity[along].abs() > SAME * largest(gravity)
        {
            return Err(self.refused(&named("gravity"), format!("{gravity:?}")));
        }
        let times = times_of(phase, time);
        for (selection, _, value) in phase.loads() {
            let values = times.iter().map(|&t| value.components(t, 3));
            if let Some(value) = values.into_iter().find(|x| x[along].abs() > SAME * largest(x)) {
                return Err(self.refused(&named("load"), format!("{value:?} on {selection}")));
            }
        }
        self.check_constraints(phase, &times, reached)
    }

    /// Checks that all nodes of a column along the axis have the same prescribed displacements, and that none moves
    /// along the axis. Returns plane strain if all nodes of both ends are held along it, else plane stress.
    fn check_constraints(
        &self,
        phase: &Phase,
        times: &[f64],
        reached: &mut [f64],
    ) -> Result<Plane, InputError> {
        let along = self.axis.index();
        let rows = self.scene.rows(phase, &PhaseStart { time: times[0], u: reached })?;
        let input = format!("held and moved nodes of phase \"{}\"", phase.name);
        let mut by_dof: Vec<Option<(&ConstraintRow, f64)>> = vec![None; reached.len()];
        for row in &rows {
            let Some((dof, coefficient)) = row.nodal() else {
                let help = format!(
                    "a section of what is held in several displacements together is not known: hold axes of nodes, or {SPACE}"
                );
                return Err(InputError::new(input, row.label(3), help));
            };
            by_dof[dof] = Some((row, coefficient));
        }
        let at = |(row, coefficient): (&ConstraintRow, f64), t: f64| {
            row.prescribed(t).displacement / coefficient
        };
        let tolerance = SAME * self.scene.body.size();
        for dof in 0..by_dof.len() {
            let (node, i) = (dof / 3, dof % 3);
            let own = by_dof[dof];
            if i == along {
                if let Some(own) = own
                    && times.iter().any(|&t| at(own, t).abs() > tolerance)
                {
                    return Err(self.refused(&input, own.0.label(3)));
                }
                continue;
            }
            let first = by_dof[3 * self.prism.nodes[self.prism.columns[node]][0] + i];
            let is_same = match (own, first) {
                (None, None) => true,
                (Some(own), Some(first)) => {
                    times.iter().all(|&t| (at(own, t) - at(first, t)).abs() <= tolerance)
                }
                _ => false,
            };
            if !is_same {
                let label = own.or(first).map_or(String::new(), |(row, _)| row.label(3));
                return Err(self.refused(&input, label));
            }
        }
        let end = times.last().copied().unwrap_or_default();
        prescribe(&rows, end, reached);
        let is_at_end = |node: &usize| {
            let x = self.mesh().position(*node)[along];
            self.prism.ends.iter().any(|end| (x - end).abs() <= tolerance)
        };
        let mut ends = (0..self.mesh().node_count()).filter(is_at_end);
        let is_strain = ends.all(|node| by_dof[3 * node + along].is_some());
        Ok(if is_strain { Plane::Strain } else { Plane::Stress })
    }

    /// The section of an obstacle in a phase that begins at `since` (s).
    pub(super) fn section(
        &self,
        obstacle: &Obstacle,
        phase: &Phase,
        since: f64,
    ) -> Result<Obstacle, InputError> {
        let (body, times) = (&self.scene.body, times_of(phase, since));
        let obstacle = &obstacle.validated(3)?;
        let named = || format!("\"{}\"", obstacle.name());
        let (ends, size) = (self.prism.ends, body.size());
        let section = obstacle.section(self.axis.index(), ends, &times, SAME * size);
        let section = section.ok_or_else(|| self.refused("obstacle", named()))?;
        let section = match obstacle.sticks_below(size) {
            Some(speed) => section.sticking_speed(speed),
            None => section,
        };
        if section.is_per_area() {
            return Ok(section);
        }
        // what several nodes in one place have together
        let boundary = self.prism.section.boundary_nodes();
        let mut counts = boundary.iter().map(|&node| self.prism.nodes[node].len());
        let count = counts.next().unwrap_or(1);
        match counts.all(|other| other == count) {
            true => Ok(section.shared_out(count as f64)),
            false => {
                let help = "it is per node, and lines along the axis have different numbers of these: give it per area (stiffness_density)";
                Err(InputError::new("stiffness of obstacle", named(), help))
            }
        }
    }
}

/// Alternatives to a section, for messages.
const MEND: &str = "make it so, or leave the scene in space";
const SPACE: &str = "leave the scene in space";
