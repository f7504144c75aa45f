//! The force of a chamber under a given pressure, and what bursts.
//!
//! A chamber that bursts is checked after each step, as springs that turn are (`StepCheck::check_step`,
//! `Flow::check`): the run ends with what it has computed, and the step is not searched for the moment.

use super::{ChamberForce, Geometry, TURNED};
use crate::base::sparse::BlockMatrix;
use crate::base::vector::distinct;
use crate::elements::force::{
    AlongShapes, Capabilities, Force, GeneralizedForce, NodalForces, StepCheck, Tangents,
};
use crate::integrators::ode::Failure;
use crate::scene::forces::signal::{self, finite_at};

impl ChamberForce {
    /// The same with volumes that are computed from one of its nodes on, wherever that is: where it is far from the origin, their round-off
    /// is no larger.
    pub(crate) fn anchored(mut self) -> Self {
        match &mut self.geometry {
            Geometry::Polygon(polygon, _) => polygon.anchor(),
            Geometry::Surface(surface, _) => surface.anchor(),
            // the axis is where volumes are counted from
            Geometry::Circles(..) => {}
        }
        self
    }

    /// Whether there is a pressure at which it bursts.
    pub(crate) fn can_burst(&self) -> bool {
        self.burst.is_some()
    }

    /// # Errors
    /// A `pressure` (Pa) at time `t` (s) at which it bursts.
    pub(crate) fn check_burst(&self, t: f64, pressure: f64) -> Result<(), Failure> {
        match self.burst.filter(|burst| pressure > *burst) {
            None => Ok(()),
            Some(burst) => Err(Failure::Fatal(
                format!(
                    "chamber \"{}\" bursts at t = {t} s: {pressure:.4e} Pa are in it, which bears {burst} Pa (burst)",
                    self.name
                )
                .into(),
            )),
        }
    }
}

impl Force for ChamberForce {
    fn add_forces(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        let pressure = signal::sum(&self.pressure, t);
        finite_at(t, format_args!("the pressure in chamber \"{}\"", self.name), pressure)?;
        self.add_gradient(pressure, u, &mut forces.applied);
        Ok(())
    }

    fn add_tangents(
        &self,
        t: f64,
        u: &[f64],
        _v: &[f64],
        stiffness: &mut BlockMatrix,
        _damping: &mut BlockMatrix,
    ) -> Tangents {
        self.add_hessian(-signal::sum(&self.pressure, t), u, stiffness);
        Tangents::Added
    }

    fn couplings(&self) -> Vec<[usize; 2]> {
        match &self.geometry {
            Geometry::Polygon(polygon, _) => polygon.couplings(),
            Geometry::Surface(surface, _) => surface.couplings(),
            Geometry::Circles(circles, _) => circles.couplings(),
        }
    }

    fn nodes(&self) -> Option<Vec<usize>> {
        Some(distinct(self.couplings().into_iter().flatten()))
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { step_check: Some(self), along_shapes: Some(self), ..Capabilities::default() }
    }
}

impl StepCheck for ChamberForce {
    /// Pressure in a volume below 0 is refused: it would pull the walls further through each other instead of
    /// pushing them apart.
    fn check_step(&self, t: f64, _before: &[f64], after: &[f64]) -> Result<(), Failure> {
        let pressure = signal::sum(&self.pressure, t);
        if pressure == 0.0 {
            return Ok(());
        }
        self.check_burst(t, pressure)?;
        let volume = self.volume(after);
        if !self.has_room || volume >= 0.0 {
            return Ok(());
        }
        Err(Failure::Recoverable(format!(
            "chamber \"{}\" encloses {volume:.1e} m^3 at t = {t} s under {pressure} Pa: {TURNED}",
            self.name
        )))
    }
}

impl AlongShapes for ChamberForce {
    fn is_exact_along(&self, shapes: usize) -> bool {
        self.is_larger_than(shapes)
    }

    fn generalized(&self, origin: &[f64], shapes: &[&[f64]]) -> Option<Box<dyn GeneralizedForce>> {
        self.is_larger_than(shapes.len())
            .then(|| Box::new(self.along(origin, shapes)) as Box<dyn GeneralizedForce>)
    }
}
