//! Options of multirate methods.

use super::coupling::Coupling;
use crate::base::input::InputError;
use crate::integrators::{
    common::{AbsoluteTolerance, check_step},
    sundials::{
        arkode::{OfStages, StageOptions},
        options::{OfOde, SolverOptions},
    },
};

/// Options of the slow part of a [`Multirate`](super::Multirate) method; the fast part has
/// [`ArkodeOptions`](crate::integrators::sundials::ArkodeOptions).
///
/// Slow steps have one size: of the options that all integrators share those for step sizes and signs of unknowns are
/// refused.
pub type MultirateOptions = SolverOptions<OwnOptions>;

/// Options that multirate methods alone have.
#[derive(Clone, Debug)]
pub struct OwnOptions {
    pub(super) slow_step: f64,
    pub(super) coupling: Coupling,
    pub(super) stages: StageOptions,
}

impl OfOde for OwnOptions {}

impl OfStages for OwnOptions {
    fn stages_mut(&mut self) -> &mut StageOptions {
        &mut self.stages
    }
}

impl MultirateOptions {
    /// The explicit method [`Coupling::MisKw3`] with slow steps of this size (negative when integrating backwards),
    /// and these tolerances, by which the iterations of implicit methods end.
    pub fn new(slow_step: f64, rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        let (coupling, stages) = (Coupling::MisKw3, StageOptions::default());
        Self::with(rtol, atol, OwnOptions { slow_step, coupling, stages })
    }

    /// The method. Default: [`Coupling::MisKw3`].
    pub fn coupling(mut self, coupling: Coupling) -> Self {
        self.own.coupling = coupling;
        self
    }

    pub(super) fn check(&self, y0: &[f64]) -> Result<(), InputError> {
        self.check_shared(y0, u32::MAX)?;
        check_step("slow_step", self.own.slow_step)?;
        self.own.stages.check()
    }
}
