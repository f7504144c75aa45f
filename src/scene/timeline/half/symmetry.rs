//! Whether a scene is symmetric.

use std::collections::{BTreeMap, BTreeSet};

use super::super::smaller::{SAME, check_known, times_of};
use super::super::{Phase, Scene};
use crate::base::input::{InputError, four_digits};
use crate::base::vector::largest;
use crate::elements::mesh::Mirror;
use crate::scene::constraint::{Axis, ConstraintRow, PhaseStart, prescribe};
use crate::scene::forces::Signal;

/// A scene with a plane of symmetry.
pub(super) struct Symmetry<'a> {
    scene: &'a Scene,
    axis: Axis,
    pub(super) mirror: Mirror,
}

impl<'a> Symmetry<'a> {
    /// That of `scene`, whose plane is normal to `axis`.
    ///
    /// # Errors
    /// A scene that is not symmetric; unsupported features; an axis that the body does not have.
    pub(super) fn of(scene: &'a Scene, axis: Axis) -> Result<Self, InputError> {
        check_known(
            scene,
            "a half",
            "leave the scene whole, or build the half by hand (Phase::symmetry)",
        )?;
        let (mesh, d) = (scene.body.mesh(), scene.body.dimension());
        if axis.index() >= d {
            let help = format!("the body has {d} dimension(s)");
            return Err(InputError::new("axis of symmetry", format!("{axis:?}"), help));
        }
        let Some(mirror) = mesh.mirror(axis.index()) else {
            let help = format!("a node has no mirror image: {HALF}");
            return Err(InputError::new(
                format!("mesh along {}", axis.word()),
                "not symmetric",
                help,
            ));
        };
        let symmetry = Self { scene, axis, mirror };
        symmetry.check_cells()?;
        let (u, v) = (scene.initial_displacements(), scene.initial_velocities()?);
        symmetry.check_field("initial displacements", u)?;
        symmetry.check_field("initial velocities", &v)?;
        symmetry.check_field("point masses", &symmetry.point_masses())?;
        let (mut time, mut reached) = (0.0, u.to_vec());
        for phase in &scene.phases {
            symmetry.check_phase(phase, time, &mut reached)?;
            time = phase.until;
        }
        Ok(symmetry)
    }

    /// The error for something that is not symmetric.
    fn refused(&self, input: impl Into<String>, value: impl Into<String>) -> InputError {
        let plane = format!("{} = {} m", self.axis.word(), four_digits(self.mirror.at));
        let help = format!("it is not symmetric to the plane {plane}: {HALF}");
        InputError::new(input, value.into(), help)
    }

    /// No cell lies across the plane or in it, and cells of different materials have their images.
    fn check_cells(&self) -> Result<(), InputError> {
        let (mesh, body, Mirror { axis, at, .. }) =
            (self.scene.body.mesh(), &self.scene.body, &self.mirror);
        for (number, cell) in (1..).zip(mesh.cells()) {
            let free = cell.iter().filter(|node| !self.mirror.is_on_plane(**node));
            let mut sides = free.map(|&node| mesh.position(node)[*axis] > *at);
            let first = sides.next();
            if first.is_none() || sides.any(|side| Some(side) != first) {
                let plane = format!("{} = {} m", self.axis.word(), four_digits(*at));
                let help = format!(
                    "it lies across the plane of symmetry {plane} or in it: take an even number of cells across it"
                );
                return Err(InputError::new("cell", number, help));
            }
        }
        let made_of = body.substance_numbers();
        if made_of.iter().all(|number| *number == made_of[0]) {
            return Ok(());
        }
        let images = mesh.mirrored_cells(&self.mirror);
        let images = images.ok_or_else(|| self.refused("cells", "of several materials"))?;
        let substances: Vec<_> = body.substances().collect();
        let differs = |(cell, image): &(usize, &usize)| {
            substances[made_of[*cell]] != substances[made_of[**image]]
        };
        match images.iter().enumerate().find(differs) {
            Some((cell, _)) => Err(self.refused("material of cell", (cell + 1).to_string())),
            None => Ok(()),
        }
    }

    /// Point masses (kg) along the plane, in the place of a vector at each node.
    fn point_masses(&self) -> Vec<f64> {
        let (body, d) = (&self.scene.body, self.scene.body.dimension());
        let own = body.to_builder().own_mesh().node_count();
        let mut masses = vec![0.0; body.dofs()];
        for (node, mass) in body.nodal_masses().iter().enumerate().skip(own) {
            for i in (0..d).filter(|i| *i != self.mirror.axis) {
                masses[node * d + i] = *mass;
            }
        }
        masses
    }

    /// Refuses vectors at the nodes that are not symmetric.
    fn check_field(&self, name: &str, x: &[f64]) -> Result<(), InputError> {
        let (d, Mirror { axis, images, .. }) = (self.scene.body.dimension(), &self.mirror);
        let limit = SAME * largest(x);
        for (node, image) in images.iter().enumerate() {
            for i in 0..d {
                let sign = if i == *axis { -1.0 } else { 1.0 };
                let off = (x[image * d + i] - sign * x[node * d + i]).abs();
                if off > limit || off.is_nan() {
                    let value = format!("of node {}: {:?}", node + 1, &x[node * d..][..d]);
                    return Err(self.refused(name, value));
                }
            }
        }
        Ok(())
    }

    /// Checks what is of a phase; `reached` are the displacements that are prescribed at its start `time` (s), and
    /// then at its end.
    fn check_phase(&self, phase: &Phase, time: f64, reached: &mut [f64]) -> Result<(), InputError> {
        let (scene, axis) = (self.scene, self.mirror.axis);
        let named = |what: &str| format!("{what} of phase \"{}\"", phase.name);
        if let Some(gravity) = scene.gravity_in(phase)
            && gravity[axis].abs() > SAME * largest(gravity)
        {
            return Err(self.refused(named("gravity"), format!("{gravity:?}")));
        }
        let times = times_of(phase, time);
        let plane = (axis, self.mirror.at);
        for obstacle in phase.contacts(&scene.obstacles)? {
            if !obstacle.is_symmetric(plane, &times, SAME * scene.body.size()) {
                return Err(self.refused("obstacle", format!("\"{}\"", obstacle.name())));
            }
        }
        self.check_constraints(phase, &times, reached)?;
        let mut forces = vec![0.0; scene.body.dofs()];
        let d = scene.body.dimension();
        for &t in &times {
            forces.fill(0.0);
            for (node, force) in scene.loads_at(phase, t)? {
                forces[node * d..][..d].iter_mut().zip(force).for_each(|(sum, f)| *sum += f);
            }
            self.check_field(&named("loads"), &forces)?;
        }
        self.check_pressures(phase, &times)
    }

    /// Pressures on faces: each has its image, or is its own. `times` (s) are of the phase.
    fn check_pressures(&self, phase: &Phase, times: &[f64]) -> Result<(), InputError> {
        let mesh = self.scene.body.mesh();
        let sets = phase
            .face_pressures()
            .map(|(nodes, _)| Ok(mesh.select(nodes)?.into_iter().collect::<BTreeSet<usize>>()));
        let sets = sets.collect::<Result<Vec<_>, InputError>>()?;
        for ((nodes, pressure), own) in phase.face_pressures().zip(&sets) {
            let image: BTreeSet<usize> = own.iter().map(|&node| self.mirror.images[node]).collect();
            let is_image = |((_, other), set): ((_, &Signal), &BTreeSet<usize>)| {
                *set == image && times.iter().all(|&t| other.at(t) == pressure.at(t))
            };
            if !phase.face_pressures().zip(&sets).any(is_image) {
                let input = format!("pressure on faces of phase \"{}\"", phase.name);
                return Err(self.refused(input, nodes.to_string()));
            }
        }
        Ok(())
    }

    /// Checks that prescribed displacements are symmetric, node by node.
    fn check_constraints(
        &self,
        phase: &Phase,
        times: &[f64],
        reached: &mut [f64],
    ) -> Result<(), InputError> {
        let d = self.scene.body.dimension();
        let start = PhaseStart { time: times[0], u: reached };
        let rows = self.scene.rows(phase, &start)?;
        let named = |what: &str| format!("{what} of phase \"{}\"", phase.name);
        let mut by_dof = BTreeMap::new();
        for row in &rows {
            let Some((dof, coefficient)) = row.nodal() else {
                let help = "a half of what is held in several displacements together is not known: hold axes of nodes";
                return Err(InputError::new(named("constraint"), row.label(d), help));
            };
            by_dof.insert(dof, (row, coefficient));
        }
        for (dof, (row, coefficient)) in &by_dof {
            let (node, i) = (dof / d, dof % d);
            let sign = if i == self.mirror.axis { -1.0 } else { 1.0 };
            let image = by_dof.get(&(self.mirror.images[node] * d + i));
            let is_same = |(other, of_other): &(&ConstraintRow, f64)| {
                times.iter().all(|&t| {
                    let [own, image] = [(*row, coefficient), (*other, of_other)]
                        .map(|(row, coefficient)| row.prescribed(t).displacement / coefficient);
                    (image - sign * own).abs() <= SAME * self.scene.body.size()
                })
            };
            if !image.is_some_and(is_same) {
                return Err(self.refused(named("held and moved nodes"), row.label(d)));
            }
        }
        let end = times.last().copied().unwrap_or_default();
        prescribe(&rows, end, reached);
        Ok(())
    }
}

/// Alternatives to a half, for messages.
const HALF: &str = "make it so, or leave the scene whole";
