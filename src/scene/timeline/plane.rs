//! The section of a scene that is the same all along an axis, in a plane.
//!
//! A load keeps its kind where the section shares it out as the sums over the columns are, so that finer
//! meshes of the section have it right, and is a force on each node otherwise. In a mean over nodes each
//! column counts as often as the mean in space has nodes in it (`Reading::counted`). Hexahedra between held
//! ends are the quadrilaterals of the section, to round-off.

mod uniform;

use std::sync::Arc;

#[cfg(any(feature = "scene-file", feature = "study"))]
use super::Smaller;
use super::smaller::SAME;
use super::{Input, LoadKind, Phase, Quantity, Scene};
use crate::base::input::InputError;
use crate::elements::material::Plane;
use crate::elements::mesh::{Prism, Selection};
use crate::scene::constraint::{Axes, Axis, Constrained, Constraint, Motion, Turn};
use crate::scene::forces::{Obstacle, VectorSignal};
use uniform::Uniform;

/// The section of a scene, and which nodes it has of that.
#[derive(Debug, Clone)]
#[cfg_attr(not(any(feature = "scene-file", feature = "study")), allow(dead_code))]
pub(crate) struct InPlane {
    pub(crate) scene: Scene,
    /// The axis that it is across.
    pub(crate) axis: Axis,
    /// Assumption along the axis: plane strain or plane stress.
    pub(crate) plane: Plane,
    pub(crate) prism: Prism,
}

#[cfg(any(feature = "scene-file", feature = "study"))]
impl InPlane {
    /// How it is told.
    pub(crate) fn kind(&self) -> Smaller {
        Smaller::Plane { axis: self.axis, plane: self.plane }
    }

    /// The nodes in the places of these of the scene in space, ascending, and how many of these are in each.
    pub(crate) fn standing_for(&self, nodes: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let mut own: Vec<usize> = nodes.iter().map(|&node| self.prism.columns[node]).collect();
        own.sort_unstable();
        let counts = own.chunk_by(|a, b| a == b).map(<[usize]>::len).collect();
        own.dedup();
        (own, counts)
    }
}

impl Scene {
    /// The section across `axis` of a scene in space that is the same all along it, as a scene in a plane: with as many unknowns as one
    /// layer of nodes has there, or fewer.
    ///
    /// The mesh is a prism of hexahedra or tetrahedra, as those of [`Mesh::cuboid`](crate::Mesh::cuboid) are along all axes. The axes of the plane are
    /// the other two in their order. It is in *plane strain* where both ends of the prism are held along the axis: then it moves as the
    /// scene in space does, as long as that stays the same all along. Otherwise it is in *plane stress*, as thick as the
    /// prism is long: what is thin beside its section moves so up to a part of the order of (thickness/width)^2, but near nodes that are
    /// held along the axis besides, as those of a clamped side. Forces and masses are those of the whole.
    ///
    /// ```
    /// use pliant::{Axis, Body, Material, Mesh, Phase, Plane, Scene, SolidCells};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };
    /// let mesh = Mesh::cuboid([0.1, 0.005, 0.02], [11, 2, 3], SolidCells::Hexahedra)?;
    /// let beam = Scene::new(Body::new(mesh, rubber).build()?)
    ///     .gravity([0.0, 0.0, -9.8])
    ///     .phase(Phase::until(0.5).hold("left"));
    /// let plane = beam.in_plane(Axis::Y)?;
    /// assert_eq!((beam.body().dofs(), plane.body().dofs()), (198, 66));
    /// // gravity pulls along the z axis
    /// assert!(beam.in_plane(Axis::Z).is_err());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// Scenes that [`validate`](Self::validate) refuses. A mesh that is not such a prism; anything that varies along
    /// the axis or points along it: materials, prescribed displacements, loads, pressures on faces, gravity, the start,
    /// obstacles (half-spaces, capsules along the axis and boxes that extend beyond the ends do not vary). Unsupported
    /// features: several bodies, rigid and fibrous materials, point masses, springs and other actuators, chambers,
    /// fluids, bodies that touch, forces that are not of this crate. Material laws without a plane-stress form.
    pub fn in_plane(&self, axis: Axis) -> Result<Self, InputError> {
        Ok(self.section(axis)?.scene)
    }

    /// As [`in_plane`](Self::in_plane), with what stands for what.
    pub(crate) fn section(&self, axis: Axis) -> Result<InPlane, InputError> {
        self.body.single("a section")?;
        self.section_of(self.body.mesh().prism(axis.index())?)
    }

    /// The section of the scene whose mesh is this prism.
    pub(crate) fn section_of(&self, prism: Prism) -> Result<InPlane, InputError> {
        self.validate()?;
        self.start.refuse_branches("a section")?;
        let uniform = Uniform::of(self, prism)?;
        let (prism, plane) = (&uniform.prism, uniform.plane);
        let body = self.body.to_builder().section(prism, plane)?.build()?;
        let mut start = super::start::Start::rest(&body);
        start.displacements = prism.field(self.initial_displacements());
        start.velocities = prism.field(&self.initial_velocities()?);
        let mut scene = self.clone().unreduced();
        (scene.body, scene.start) = (Arc::new(body), start);
        let chosen = |x: &Vec<f64>| prism.axes().map(|i| x[i]).to_vec();
        scene.gravity = self.gravity.as_ref().map(chosen);
        let sections = |obstacles: &[Obstacle], phase: &Phase, since: f64| {
            let all = obstacles.iter().map(|obstacle| uniform.section(obstacle, phase, since));
            all.collect::<Result<Vec<_>, InputError>>()
        };
        let (mut phases, mut time) = (Vec::new(), 0.0);
        for phase in &self.phases {
            let mut own = phase.clone();
            own.gravity = phase.gravity.as_ref().map(chosen);
            own.constraints = uniform.constraints(phase)?;
            own.without_inputs(Quantity::is_known_of_parts);
            for load in phase.loads() {
                own.inputs.extend(scene.section_of_load(self, &uniform, phase, load)?);
            }
            for (selection, pressure) in phase.face_pressures() {
                own = own.pressure_on(uniform.pressed(selection, phase)?, pressure.clone());
            }
            own.redirected = sections(&phase.redirected, phase, time)?;
            scene.obstacles = sections(&self.obstacles, phase, time)?;
            time = phase.until;
            phases.push(own);
        }
        scene.phases = phases;
        scene.validate()?;
        Ok(InPlane { scene, axis: uniform.axis, plane, prism: uniform.prism })
    }

    /// A load on the section: the sum of the parts that the scene in space has in each place. It stays of its kind where the section
    /// shares it out in the same way.
    fn section_of_load(
        &self,
        space: &Scene,
        uniform: &Uniform,
        phase: &Phase,
        (selection, kind, value): (&Selection, LoadKind, &VectorSignal),
    ) -> Result<Vec<Input>, InputError> {
        let prism = &uniform.prism;
        let columns = uniform.whole(selection, &format!("load of phase \"{}\"", phase.name))?;
        let nodes = space.body.mesh().select(selection)?;
        let mut sums = vec![0.0; prism.nodes.len()];
        for (&node, part) in nodes.iter().zip(space.parts(kind, selection, &nodes)?) {
            sums[prism.columns[node]] += part;
        }
        let (own, value) = (Selection::of_nodes(columns.clone()), value.part(prism.axes()));
        if let Ok(parts) = self.parts(kind, &own, &columns) {
            let most = parts.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
            let is_same = |(&k, part): (&usize, &f64)| (sums[k] - part).abs() <= SAME * most;
            if columns.iter().zip(&parts).all(is_same) {
                return Ok(vec![Input::load(own, kind, value)]);
            }
        }
        let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
        for column in columns.into_iter().filter(|&column| sums[column] != 0.0) {
            let part = sums[column];
            match groups.iter_mut().find(|(other, _)| (*other - part).abs() <= SAME * part.abs()) {
                Some((_, nodes)) => nodes.push(column),
                None => groups.push((part, vec![column])),
            }
        }
        let each = |(part, nodes): (f64, Vec<usize>)| {
            Input::load(Selection::of_nodes(nodes), LoadKind::Each, value.times(part))
        };
        Ok(groups.into_iter().map(each).collect())
    }
}

impl Uniform<'_> {
    /// Constraints of the section.
    fn constraints(&self, phase: &Phase) -> Result<Vec<Constraint>, InputError> {
        let input = format!("held and moved nodes of phase \"{}\"", phase.name);
        let mut constraints = Vec::new();
        for Constraint { what, how } in &phase.constraints {
            let (selection, axes) = match what {
                Constrained::Nodes(selection, Axes::All) => (selection, Axis::all(3).to_vec()),
                Constrained::Nodes(selection, Axes::These(axes)) => (selection, axes.clone()),
                Constrained::Along(selection, normal) => (selection, vec![nearest_axis(normal)]),
                // refused before
                Constrained::Row(_) => continue,
            };
            let own: Vec<Axis> = axes.iter().filter_map(|axis| self.own_axis(*axis)).collect();
            if own.is_empty() {
                continue;
            }
            let nodes = Selection::of_nodes(self.whole(selection, &input)?);
            let own = match what {
                Constrained::Nodes(_, Axes::All) => Axes::All,
                _ => Axes::These(own),
            };
            let how = self.motion(how, &axes);
            constraints.push(Constraint { what: Constrained::Nodes(nodes, own), how });
        }
        Ok(constraints)
    }

    /// Axis of the plane for an axis of space; `None` for the axis of the prism.
    fn own_axis(&self, axis: Axis) -> Option<Axis> {
        let place = self.prism.axes().iter().position(|own| *own == axis.index());
        place.map(|place| Axis::all(2)[place])
    }

    /// A motion of nodes along some `axes` of space, as it is in the plane.
    fn motion(&self, how: &Motion, axes: &[Axis]) -> Motion {
        match how {
            Motion::Velocity(velocity) => {
                let own = axes.iter().zip(velocity);
                let own = own.filter(|(axis, _)| self.own_axis(**axis).is_some());
                Motion::Velocity(own.map(|(_, velocity)| *velocity).collect())
            }
            Motion::Turn(turn) => {
                // x and z are a left-handed pair
                let sign = if self.axis == Axis::Y { -1.0 } else { 1.0 };
                Motion::Turn(Arc::new(Turn {
                    centre: self.prism.axes().map(|i| turn.centre[i]).to_vec(),
                    axis: vec![sign * turn.axis[self.axis.index()]],
                    angles: turn.angles.clone(),
                }))
            }
            // the same for all axes
            Motion::Hold | Motion::Path(_) | Motion::Spline(_) | Motion::Formula(_) => how.clone(),
        }
    }

    /// The nodes on which a pressure acts.
    fn pressed(&self, selection: &Selection, phase: &Phase) -> Result<Selection, InputError> {
        let input = format!("pressure on faces of phase \"{}\"", phase.name);
        let nodes = self.mesh().select(selection)?;
        if self.prism.has_end_face(self.mesh(), &nodes) {
            return Err(self.refused(&input, format!("{selection}, on an end of it")));
        }
        self.whole(selection, &input).map(Selection::of_nodes)
    }
}

/// The axis along which a direction is: all rows of what is held along a direction have to be of one.
fn nearest_axis(normal: &[f64]) -> Axis {
    let longer = |a: Axis, b: &Axis| {
        if normal[b.index()].abs() > normal[a.index()].abs() { *b } else { a }
    };
    Axis::all(3).iter().fold(Axis::X, longer)
}
