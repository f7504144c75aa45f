//! Phases: what is held, moved, loaded and touched during a stretch of time.

use std::sync::Arc;

use crate::constraint::{Axes, Axis, Constrained, Constraint, Motion, Prescribed};
use crate::error::Error;
use crate::force::Obstacle;
use crate::mesh::Selection;

/// A stretch of time with its own constraints, loads and contacts. Displacements and velocities
/// carry over from phase to phase.
#[derive(Debug, Clone)]
pub struct Phase {
    pub(crate) name: String,
    pub(crate) until: f64,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) loads: Vec<(Selection, Vec<f64>)>,
    pub(crate) projects_velocity: bool,
    contact: ContactWith,
}

#[derive(Debug, Clone)]
enum ContactWith {
    All,
    These(Vec<String>),
}

impl Phase {
    /// A phase that ends at time `until` (s). Without more it is free motion, in contact with all
    /// obstacles.
    pub fn until(until: f64) -> Self {
        Self {
            name: String::new(),
            until,
            constraints: Vec::new(),
            loads: Vec::new(),
            projects_velocity: false,
            contact: ContactWith::All,
        }
    }

    /// Name of the phase, for messages and tables (default: "phase 1", "phase 2", ...).
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Nodes that stay, in all components, where they are when the phase begins. Where the phase
    /// before prescribed their position, they stay where that should have brought them.
    pub fn hold(self, nodes: impl Into<Selection>) -> Self {
        self.constrain(nodes, Axes::All, Motion::Hold)
    }

    /// As [`hold`](Self::hold), for some components only.
    pub fn hold_axes(
        self,
        nodes: impl Into<Selection>,
        axes: impl IntoIterator<Item = Axis>,
    ) -> Self {
        self.constrain(nodes, Axes::These(axes.into_iter().collect()), Motion::Hold)
    }

    /// Nodes that move on from there with a constant `velocity` (m/s), one component per dimension.
    pub fn move_nodes(self, nodes: impl Into<Selection>, velocity: impl Into<Vec<f64>>) -> Self {
        self.constrain(nodes, Axes::All, Motion::Velocity(velocity.into()))
    }

    /// One component of nodes that moves with a constant `velocity` (m/s); the others are free.
    pub fn move_axis(self, nodes: impl Into<Selection>, axis: Axis, velocity: f64) -> Self {
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Velocity(vec![velocity]))
    }

    /// One component of nodes that follows a smooth path: `path` gives b, b' and b'' at time t.
    pub fn follow(
        self,
        nodes: impl Into<Selection>,
        axis: Axis,
        path: impl Fn(f64) -> Prescribed + Send + Sync + 'static,
    ) -> Self {
        self.constrain(nodes, Axes::These(vec![axis]), Motion::Path(Arc::new(path)))
    }

    /// A linear combination of displacements that keeps the value it has when the phase begins:
    /// `terms` are (node number from 1, axis, coefficient).
    pub fn hold_combination(mut self, terms: impl IntoIterator<Item = (usize, Axis, f64)>) -> Self {
        let what = Constrained::Row(terms.into_iter().collect());
        self.constraints.push(Constraint { what, how: Motion::Hold });
        self
    }

    /// A constant force (N) on each of the nodes.
    pub fn load(mut self, nodes: impl Into<Selection>, force: impl Into<Vec<f64>>) -> Self {
        self.loads.push((nodes.into(), force.into()));
        self
    }

    /// No obstacle acts in this phase.
    pub fn without_contact(self) -> Self {
        self.contact_with::<String>([])
    }

    /// Only the named obstacles act in this phase.
    pub fn contact_with<N: Into<String>>(mut self, obstacles: impl IntoIterator<Item = N>) -> Self {
        self.contact = ContactWith::These(obstacles.into_iter().map(Into::into).collect());
        self
    }

    /// Begins with the velocities nearest to the present ones that the constraints allow (an
    /// inelastic impact). Without it, the default, a jump of b' is worked off by the stabilization
    /// within a time of about 1/alpha.
    pub fn project_velocity(mut self) -> Self {
        self.projects_velocity = true;
        self
    }

    /// Name of the phase.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// End of the phase (s).
    pub fn end(&self) -> f64 {
        self.until
    }

    pub(super) fn or_named(self, name: String) -> Self {
        if self.name.is_empty() { self.named(name) } else { self }
    }

    /// The obstacles that act in this phase.
    pub(super) fn contacts<'a>(
        &self,
        obstacles: &'a [Obstacle],
    ) -> Result<Vec<&'a Obstacle>, Error> {
        let ContactWith::These(names) = &self.contact else {
            return Ok(obstacles.iter().collect());
        };
        let find = |name: &String| {
            obstacles.iter().find(|obstacle| obstacle.name() == name).ok_or_else(|| {
                let known: Vec<&str> = obstacles.iter().map(Obstacle::name).collect();
                let mend = format!("the scene has the obstacles {known:?}");
                Error::input(format!("contact of phase \"{}\"", self.name), name, mend)
            })
        };
        names.iter().map(find).collect()
    }

    fn constrain(mut self, nodes: impl Into<Selection>, axes: Axes, how: Motion) -> Self {
        self.constraints.push(Constraint { what: Constrained::Nodes(nodes.into(), axes), how });
        self
    }
}

pub(super) fn check_vector(
    input: &str,
    vector: &[f64],
    dimension: usize,
    unit: &str,
) -> Result<(), Error> {
    if vector.len() == dimension {
        return Ok(());
    }
    let mend = format!("it needs {dimension} component(s) ({unit})");
    Err(Error::input(input, format!("{vector:?}"), mend))
}
