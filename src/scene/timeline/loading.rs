//! Loads of a phase: forces on nodes, tractions on faces.

use super::input::{Input, LoadKind, Quantity, Target};
use super::phase::Phase;
use crate::elements::mesh::Selection;
use crate::scene::forces::{Signals, TimeTable, VectorSignal, WrenchKind};

impl Phase {
    /// A constant force (N) on each of the nodes.
    pub fn load(self, nodes: impl Into<Selection>, force: impl Into<Vec<f64>>) -> Self {
        self.loaded(nodes, LoadKind::Each, VectorSignal::Constant(force.into()))
    }

    /// A force (N) on each of the nodes that changes with time (s): `force` gives one component
    /// per dimension.
    pub fn load_with<const D: usize>(
        self,
        nodes: impl Into<Selection>,
        force: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        self.loaded(nodes, LoadKind::Each, VectorSignal::function(force))
    }

    /// A force (N) on each of the nodes that has the values `forces`, one component per dimension, at
    /// the `times` (s, ascending). In between it is interpolated linearly; before and after it is
    /// constant.
    pub fn load_table(
        self,
        nodes: impl Into<Selection>,
        times: impl Into<Vec<f64>>,
        forces: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        self.loaded(nodes, LoadKind::Each, table(times, forces))
    }

    /// A constant force (N) on the nodes together.
    ///
    /// Where they make up whole faces of the boundary (edges in the plane) it is spread over these evenly:
    /// the share of each node is the integral of its shape function divided by the area, for linear cells
    /// half as much at the ends of a side as within it. Nodes that make up no faces share it equally.
    pub fn load_total(self, nodes: impl Into<Selection>, force: impl Into<Vec<f64>>) -> Self {
        self.loaded(nodes, LoadKind::Total, VectorSignal::Constant(force.into()))
    }

    /// As [`load_total`](Self::load_total), with a force that has the values `forces` (N) at the `times` (s,
    /// ascending), as [`load_table`](Self::load_table) has it.
    pub fn load_total_table(
        self,
        nodes: impl Into<Selection>,
        times: impl Into<Vec<f64>>,
        forces: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        self.loaded(nodes, LoadKind::Total, table(times, forces))
    }

    /// A constant traction: a force per area (N/m^2) on the faces of the boundary (edges in the plane)
    /// between the nodes.
    ///
    /// The nodes all have to belong to such faces. The area is that of the undeformed shape, and the
    /// direction stays as the body turns (a dead load). A membrane in space is loaded all over or at its rim,
    /// a string at its ends.
    ///
    /// Nodal forces are the integrals of the traction times the shape functions.
    pub fn traction(self, nodes: impl Into<Selection>, traction: impl Into<Vec<f64>>) -> Self {
        self.loaded(nodes, LoadKind::Traction, VectorSignal::Constant(traction.into()))
    }

    /// As [`traction`](Self::traction), with a traction (N/m^2) that changes with time (s): one component per
    /// dimension.
    pub fn traction_with<const D: usize>(
        self,
        nodes: impl Into<Selection>,
        traction: impl Fn(f64) -> [f64; D] + Send + Sync + 'static,
    ) -> Self {
        self.loaded(nodes, LoadKind::Traction, VectorSignal::function(traction))
    }

    /// As [`traction`](Self::traction), with a traction that has the values `tractions` (N/m^2) at the
    /// `times` (s, ascending), as [`load_table`](Self::load_table) has it.
    pub fn traction_table(
        self,
        nodes: impl Into<Selection>,
        times: impl Into<Vec<f64>>,
        tractions: impl IntoIterator<Item: Into<Vec<f64>>>,
    ) -> Self {
        self.loaded(nodes, LoadKind::Traction, table(times, tractions))
    }

    /// A moment (N m) on nodes together, constant or changing with time, whose direction stays: in the plane one component,
    /// counter-clockwise, in space three.
    ///
    /// It is a couple of forces on the nodes, in proportion to their distances from their centre and to the shares that they have of a
    /// [total load](Self::load_total): the nodes stay free to deform, and the moment times their mean angular velocity is its power. They
    /// may be those of a rigid body.
    pub fn moment(self, nodes: impl Into<Selection>, moment: impl Into<Signals>) -> Self {
        self.wrench(nodes, WrenchKind::Moment, moment)
    }

    /// A force (N) on nodes together, one component per dimension, that turns with them, as the thrust of a jet: it is given for the
    /// undeformed shape.
    pub fn follower_force(self, nodes: impl Into<Selection>, force: impl Into<Signals>) -> Self {
        self.wrench(nodes, WrenchKind::FollowerForce, force)
    }

    /// A [moment](Self::moment) (N m) that turns with the nodes; in the plane it is the same.
    pub fn follower_moment(self, nodes: impl Into<Selection>, moment: impl Into<Signals>) -> Self {
        self.wrench(nodes, WrenchKind::FollowerMoment, moment)
    }

    fn wrench(
        self,
        nodes: impl Into<Selection>,
        kind: WrenchKind,
        value: impl Into<Signals>,
    ) -> Self {
        let target = Target::Nodes(nodes.into());
        self.with(Input::new(Quantity::Wrench(kind), target, value.into().0))
    }

    pub(crate) fn loaded(
        self,
        nodes: impl Into<Selection>,
        kind: LoadKind,
        value: VectorSignal,
    ) -> Self {
        self.with(Input::load(nodes.into(), kind, value))
    }
}

fn table(
    times: impl Into<Vec<f64>>,
    values: impl IntoIterator<Item: Into<Vec<f64>>>,
) -> VectorSignal {
    let values = values.into_iter().map(Into::into).collect();
    VectorSignal::TimeTable(TimeTable::new(times.into(), values))
}
