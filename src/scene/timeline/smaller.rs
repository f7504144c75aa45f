//! Smaller scenes that stand for a scene: one half of a symmetric one, the section of one that is the same all along an axis.
//!
//! Both are one map of nodes (`elements/mesh/node_map.rs`). The scene is compared with its images node by node (`smaller/same.rs`), and
//! not by the words in which it was written; what the images leave is made of it by `smaller/made.rs`.

mod bodies;
mod components;
mod fields;
mod made;
mod passages;
mod same;

use std::fmt;

use super::Scene;
use crate::base::input::{InputError, four_digits};
use crate::elements::material::Plane;
use crate::elements::mesh::NodeMap;
use crate::scene::constraint::Axis;

/// How a model is smaller than the scene that it is of.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Smaller {
    /// All bodies are rigid.
    Rigid,
    /// One half of a symmetric scene: see [`Scene::symmetric_half`].
    Half {
        /// The axis that the plane of symmetry is normal to.
        axis: Axis,
        /// Where on that axis the plane is (m).
        at: f64,
    },
    /// The section of a scene that is the same all along an axis: see [`Scene::in_plane`].
    Plane {
        /// The axis.
        axis: Axis,
        /// Assumption along the axis: plane strain or plane stress.
        plane: Plane,
    },
    /// A rod in place of a slender solid: see [`Scene::as_rod`].
    Rod {
        /// Number of its elements.
        elements: usize,
    },
}

impl fmt::Display for Smaller {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rigid => f.write_str("all of it rigid"),
            Self::Half { axis, at } => {
                write!(f, "half of it, cut at {} = {} m", axis.word(), four_digits(*at))
            }
            Self::Plane { axis, plane } => {
                write!(f, "in a plane across {} (plane {})", axis.word(), plane.name())
            }
            Self::Rod { elements } => write!(f, "a rod of {elements} elements"),
        }
    }
}

/// Kind of a smaller scene across an axis: one of two mirror images, or the section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shrink {
    Half,
    Section,
}

/// A smaller scene, and which nodes of the whole one its nodes stand for.
#[derive(Debug, Clone)]
pub(crate) struct SmallerScene {
    pub(crate) scene: Scene,
    pub(crate) kind: Smaller,
    pub(crate) map: NodeMap,
}

impl Scene {
    /// The half of a symmetric scene below its plane of symmetry, which is normal to `axis` and goes through the middle of all bodies.
    ///
    /// It moves as the whole scene does, as long as that stays symmetric: a column that buckles does not, nor does a body that leaves an
    /// unstable position by round-off. Nodes on the plane slide in it ([`Phase::symmetry`](crate::Phase::symmetry)), with half of their loads, point masses and
    /// contact stiffness per node; the cut is no surface. Energies and forces are half of those of the whole scene.
    ///
    /// Bodies, ties, touches, springs, cables, muscles, growths, chambers, orifices, pipes and fluids are each their own mirror images, or that of another one with the
    /// same inputs, of which the half has one. A spring or cable in the plane has half of its forces, and the plane closes a chamber that it cuts, which has half of the gas
    /// or liquid, as flows are half of those of the whole. Remanences of magnets and fields are mirrored as arrows are, or both with the opposite sign. A body that the
    /// plane cuts has contact on its own side only: where surfaces touch at the plane and rise towards it, the contribution of facets beyond it is missing.
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
    /// Scenes that do not pass [`validate`](Self::validate). A mesh in which a node has no mirror image, or a cell lies
    /// across the plane; anything else that is not symmetric: materials, prescribed displacements, loads, pressures on
    /// faces, gravity, the start, obstacles, components. Unsupported features: springs that cross the plane, bodies on both sides of it that touch or are tied,
    /// rods, moments and followers, [devices](crate::Device) without an image in a half, forces that are not of this crate.
    pub fn symmetric_half(&self, axis: Axis) -> Result<Self, InputError> {
        Ok(self.by_map(self.map_across(Shrink::Half, axis, false)?)?.scene)
    }

    /// The section across `axis` of a scene in space that is uniform along it, as a scene in the plane: with as many unknowns as one
    /// layer of nodes has there, or fewer.
    ///
    /// The mesh is a prism of hexahedra or tetrahedra, as those of [`Mesh::cuboid`](crate::Mesh::cuboid) are along all axes. The axes of the plane are
    /// the other two in their order. It is in *plane strain* where both ends of the prism are held along the axis: then it moves as the
    /// scene in space does, as long as that stays uniform. Otherwise it is in *plane stress*, with the length of the prism as its
    /// thickness: this holds for bodies that are thin relative to their section, up to a relative error of the order of (thickness/width)^2, except near nodes that are
    /// also held along the axis, as those of a clamped side. Forces and masses are those of the whole body.
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
    /// Scenes that do not pass [`validate`](Self::validate). A mesh that is not such a prism; anything that varies along
    /// the axis or points along it: materials, prescribed displacements, loads, pressures on faces, gravity, the start,
    /// obstacles (half-spaces, capsules along the axis and boxes that extend beyond the ends do not vary). Unsupported
    /// features: several bodies, rigid and fibrous materials, point masses, springs and other actuators, chambers,
    /// fluids, bodies that touch, forces that are not of this crate. Material laws without a plane-stress form.
    pub fn in_plane(&self, axis: Axis) -> Result<Self, InputError> {
        Ok(self.by_map(self.map_across(Shrink::Section, axis, false)?)?.scene)
    }

    /// The map of its mesh to a smaller one; to the half above the plane if `is_upper`.
    ///
    /// # Errors
    /// Several bodies; a mesh of which there is no such map.
    pub(crate) fn map_across(
        &self,
        shrink: Shrink,
        axis: Axis,
        is_upper: bool,
    ) -> Result<NodeMap, InputError> {
        match shrink {
            Shrink::Half => NodeMap::half(&self.body.meshes(), axis.index(), is_upper),
            Shrink::Section => {
                self.body.single("a section")?;
                self.body.mesh().section(axis.index())
            }
        }
    }

    /// The smaller scene by a map of its mesh.
    fn by_map(&self, map: NodeMap) -> Result<SmallerScene, InputError> {
        self.validate()?;
        let same = same::Same { scene: self, map: &map };
        let held = same::check(&same)?;
        let (scene, plane) = made::made(&same, &held)?;
        let axis = Axis::all(3)[map.axis];
        let kind = match plane {
            Some(plane) => Smaller::Plane { axis, plane },
            None => Smaller::Half { axis, at: map.ends[0] },
        };
        Ok(SmallerScene { scene, kind, map })
    }

    /// The smaller scene across an axis, with what `read` makes of it: of both halves that below the plane, unless `read` refuses it.
    #[cfg(any(feature = "scene-file", feature = "study"))]
    pub(crate) fn smaller<T>(
        &self,
        (shrink, axis): (Shrink, Axis),
        read: impl Fn(&SmallerScene) -> Result<T, InputError>,
    ) -> Result<(SmallerScene, T), InputError> {
        let of_side = |is_upper| {
            let smaller = self.by_map(self.map_across(shrink, axis, is_upper)?)?;
            read(&smaller).map(|read| (smaller, read))
        };
        let below = match of_side(false) {
            Err(below) if shrink == Shrink::Half => below,
            made => return made,
        };
        of_side(true).map_err(|above| match below.to_string() == above.to_string() {
            true => below,
            false => {
                let help = format!("{}; of the half above the cut: {above}", below.help);
                InputError { help, ..below }
            }
        })
    }
}
