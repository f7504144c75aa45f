//! The forces of springs, and of the actuators in them.

use super::path::Path;
use crate::base::sparse::BlockMatrix;
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir, StepCheck, Tangents};
use crate::integrators::ode::Failure;
use crate::scene::forces::signal::{self, Signal, finite_at};

/// The force of a spring without that of its actuator.
pub(super) struct Elastic {
    pub(super) path: Path,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
}

/// The force of an actuator along a spring. It is kept apart from that of the spring itself, as it is a load, which
/// statics applies in steps.
pub(super) struct Driven {
    pub(super) path: Path,
    pub(super) force: Vec<Signal>,
}

impl Elastic {
    /// The force that pulls its ends together (N).
    pub(super) fn pull(&self, u: &[f64], v: &[f64]) -> f64 {
        let Self { path, stiffness, damping } = self;
        stiffness * (path.length(u) - path.length) + damping * path.rate(u, v)
    }
}

impl Force for Elastic {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let Self { path, stiffness, damping } = self;
        path.check_lengths(t, u)?;
        let elastic = -stiffness * (path.length(u) - path.length);
        path.add_along(elastic, u, v, &mut forces.conservative);
        path.add_along(-damping * path.rate(u, v), u, v, &mut forces.dissipative);
        Ok(())
    }

    fn add_tangents(
        &self,
        _t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let (slopes, pull) = ([self.stiffness, self.damping], self.pull(u, v));
        self.path.add_tangents(slopes, pull, None, (u, v), stiffness, damping);
        Tangents::Added
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        0.5 * self.stiffness * (self.path.length(u) - self.path.length).powi(2)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Springs
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.path.couplings(true)
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.path.nodes())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { step_check: Some(self), ..Capabilities::default() }
    }
}

impl StepCheck for Elastic {
    fn check_step(&self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Failure> {
        self.path.check_step(t, before, after)
    }
}

impl Force for Driven {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        self.path.check_lengths(t, u)?;
        let force = signal::sum(&self.force, t);
        finite_at(t, format_args!("the actuation of spring \"{}\"", self.path.name), force)?;
        self.path.add_along(force, u, v, &mut forces.applied);
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        v: &[f64],
        stiffness: &mut BlockMatrix,
        damping: &mut BlockMatrix,
    ) -> Tangents {
        let pull = -signal::sum(&self.force, t);
        self.path.add_tangents([0.0; 2], pull, None, (u, v), stiffness, damping);
        Tangents::Added
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        self.path.couplings(false)
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(self.path.nodes())
    }
}
