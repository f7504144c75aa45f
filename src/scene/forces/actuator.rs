//! Actuators: they exert forces by a number that phases and commands set, directly or through a [lag](super::lag).
//!
//! A kind of them is one file with an implementation of [`Actuator`], and its row in [`ACTUATORS`](super::ACTUATORS). Nothing else knows
//! of a single kind: forces, lags, commands, sliders, saved scenes, checkpoints, sensors, pictures, finer meshes and halves go by the
//! trait.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use super::signal::Signal;
#[cfg(feature = "output")]
use super::surface::weighted;
use crate::base::input::InputError;
use crate::base::vector::distinct;
use crate::elements::body::{Body, CellSelection, Grown};
use crate::elements::force::Forces;
use crate::elements::material::{FibreDirection, Hill};
use crate::elements::mesh::{Mesh, NodeMap, Selection};

/// Facts about the actuators of one kind.
pub(crate) struct ActuatorKind {
    pub(crate) name: &'static str,
    /// The kinds that are named together: key of their names where phases of a scene file actuate them.
    pub(crate) list: &'static str,
    pub(crate) drive: Drive,
    /// Name of what drives it on a slider.
    pub(crate) label: &'static str,
    /// Whether bodies of revolution have it.
    pub(crate) is_axisymmetric: bool,
}

/// The quantity that drives an actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drive {
    Force,
    Length,
    /// The only one that statics treats as a load, in load steps.
    Stress,
    /// That of growth, which changes the strain energy of cells.
    Strain,
}

impl Drive {
    /// Its word in scene files, and its unit.
    const fn facts(self) -> [&'static str; 2] {
        match self {
            Self::Force => ["force", "N"],
            Self::Length => ["length", "m"],
            Self::Stress => ["stress", "Pa"],
            Self::Strain => ["strain", "1"],
        }
    }

    pub(crate) const fn word(self) -> &'static str {
        self.facts()[0]
    }

    pub(crate) const fn unit(self) -> &'static str {
        self.facts()[1]
    }

    /// The value that makes large strains in a body.
    pub(crate) fn large(self, body: &Body) -> f64 {
        match self {
            Self::Force => body.largest_young() * body.volume() / body.size(),
            Self::Length => body.size(),
            Self::Stress => body.largest_young(),
            Self::Strain => 1.0,
        }
    }
}

/// An actuator of a scene.
pub(crate) trait Actuator: Any + fmt::Debug + Send + Sync {
    fn name(&self) -> &str;

    fn kind(&self) -> &'static ActuatorKind;

    /// The forces, driven by the sum of `signals`; the one that these drive is the last.
    ///
    /// # Errors
    /// Nodes and cells that do not exist, numbers out of range.
    fn driven(&self, body: &Body, signals: Vec<Signal>) -> Result<Forces, InputError>;

    /// The function that reads the output of a number, as its kind counts them.
    ///
    /// # Errors
    /// As [`driven`](Self::driven).
    fn gauge(&self, body: &Body) -> Result<ActuatorGauge, InputError>;

    /// Checks a constant `drive`.
    ///
    /// # Errors
    /// A value that it does not have.
    fn check(&self, drive: f64) -> Result<(), InputError> {
        let _ = drive;
        Ok(())
    }

    /// Checks the sum of the `signals` that drive it in a phase, as far as that is known before a run.
    ///
    /// # Errors
    /// Values that it does not have.
    fn check_signals(&self, phase: &str, signals: &[Signal]) -> Result<(), InputError> {
        let _ = phase;
        signals.iter().map(Signal::value).sum::<Option<f64>>().map_or(Ok(()), |sum| self.check(sum))
    }

    /// Hill's law, if its stress obeys that.
    fn hill(&self) -> Option<&Hill> {
        None
    }

    /// The cells whose elasticity it computes in place of the body, after growth by a `strain`.
    ///
    /// # Errors
    /// Cells that do not exist.
    fn grown(&self, body: &Body, strain: f64) -> Result<Option<Grown>, InputError> {
        let _ = (body, strain);
        Ok(None)
    }

    /// The points of the line along which it acts and is drawn; none of an actuator within cells.
    ///
    /// # Errors
    /// Nodes that do not exist.
    fn line(&self, body: &Body) -> Result<Vec<LinePoint>, InputError> {
        let _ = body;
        Ok(Vec::new())
    }

    /// The actuator on another mesh.
    ///
    /// # Errors
    /// Nodes and cells that have no image there.
    fn mapped(&self, map: &ComponentMap<'_>) -> Result<Arc<dyn Actuator>, InputError>;

    /// Where it is, and where its mirror image is.
    ///
    /// # Errors
    /// Nodes and cells that do not exist.
    fn placed(&self, body: &Body, map: &NodeMap) -> Result<Placed, InputError>;
}

/// The function that reads an output by its number.
pub(crate) type ActuatorGauge = Box<dyn Fn(usize, &ActuatorState<'_>) -> f64 + Send + Sync>;

/// A body in motion, and what drives an actuator there, with its rate.
pub(crate) struct ActuatorState<'a> {
    pub(crate) u: &'a [f64],
    pub(crate) v: &'a [f64],
    pub(crate) drive: [f64; 2],
}

/// Nodes and cells of a mesh on another one, and the share of a component's forces there.
pub(crate) struct ComponentMap<'a> {
    pub(crate) nodes: &'a dyn Fn(&Selection) -> Result<Selection, InputError>,
    pub(crate) cells: &'a dyn Fn(&CellSelection) -> Result<CellSelection, InputError>,
    pub(crate) share: f64,
}

/// The position of a component and of its mirror image.
pub(crate) struct Placed {
    /// Its properties except name and position, as a text.
    pub(crate) likeness: String,
    /// Numbers that determine its position, and those of its image; none where that is not known.
    pub(crate) at: [Vec<f64>; 2],
    /// Coordinates (m) of its points on the axis of the map.
    pub(crate) along: Vec<f64>,
    pub(crate) is_line: bool,
}

impl Placed {
    /// A component of some `cells`, along a `course` if it has one.
    pub(super) fn within(
        likeness: String,
        cells: &[usize],
        course: Option<&FibreDirection>,
        mesh: &Mesh,
        map: &NodeMap,
    ) -> Self {
        let numbers = |cells: Vec<usize>, course: Option<FibreDirection>| -> Vec<f64> {
            let cells = distinct(cells).into_iter().map(|cell| cell as f64);
            cells.chain(course.iter().flat_map(FibreDirection::numbers)).collect()
        };
        let images: Option<Vec<usize>> = cells.iter().map(|&cell| map.cell_images[cell]).collect();
        let image = images.map_or_else(Vec::new, |images| {
            numbers(images, course.map(|course| course.mirrored(map.axis, map.ends[0])))
        });
        let all: Vec<&[usize]> = mesh.cells().collect();
        let nodes = cells.iter().flat_map(|&cell| all[cell]);
        Self {
            likeness,
            at: [numbers(cells.to_vec(), course.cloned()), image],
            along: nodes.map(|&node| mesh.position(node)[map.axis]).collect(),
            is_line: false,
        }
    }
}

/// A point of a line: in the mesh, or a point of space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LinePoint {
    /// Its undeformed position (m); components beyond the dimension are 0.
    pub(crate) at: [f64; 3],
    /// The nodes with which it moves, counted from 0, and their shares: none of a point of space.
    pub(crate) shares: Vec<(usize, f64)>,
}

impl LinePoint {
    /// A point that moves with nodes.
    #[cfg(feature = "output")]
    pub(crate) fn carried(mesh: &Mesh, shares: Vec<(usize, f64)>) -> Self {
        Self { at: weighted(shares.iter().copied(), mesh.positions(), mesh.dimension()), shares }
    }

    /// The node that it is, if it is one.
    pub(crate) fn node(&self) -> Option<usize> {
        match self.shares[..] {
            [(node, _)] => Some(node),
            _ => None,
        }
    }
}
