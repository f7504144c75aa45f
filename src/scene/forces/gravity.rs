//! Gravity: the consistent nodal forces M g.

use crate::base::simd::add;
use crate::base::vector::dot;
use crate::elements::body::Body;
use crate::elements::force::{Capabilities, Force, NodalForces, Reservoir};
use crate::integrators::ode::Failure;

/// Weight of a body.
pub(crate) struct Gravity {
    weight: Vec<f64>,
    /// Potential in the undeformed shape: heights count from the origin.
    natural_potential: f64,
}

impl Gravity {
    /// Acceleration `g` (m/s^2), one component per dimension.
    pub(crate) fn new(body: &Body, g: &[f64]) -> Self {
        let weight: Vec<f64> =
            body.nodal_masses().iter().flat_map(|mass| g.iter().map(move |g| mass * g)).collect();
        let natural_potential = -dot(&weight, body.mesh().positions());
        Self { weight, natural_potential }
    }
}

impl Force for Gravity {
    fn add_forces(
        &self,
        _t: f64,
        _u: &[f64],
        _v: &[f64],
        forces: &mut NodalForces,
    ) -> Result<(), Failure> {
        add(&self.weight, &mut forces.conservative);
        Ok(())
    }

    fn is_nonlinear(&self) -> bool {
        false
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        self.natural_potential - dot(&self.weight, u)
    }

    fn reservoir(&self) -> Reservoir {
        Reservoir::Gravity
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { is_steady: true, ..Capabilities::default() }
    }
}
