//! Bounds on the change of the step size from one step to the next.

use crate::base::input::InputError;

/// Bounds for the ratio of a step size to the one before. Each has a default that suits most problems.
///
/// ```
/// use pliant::sundials::{CvodeOptions, StepControl};
///
/// let options = CvodeOptions::new(1e-6, 1e-9)
///     .step_control(StepControl::new().max_growth(4.0).keep_between(0.9, 1.2));
/// ```
///
/// User guides: "Optional input functions" for the step size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct StepControl {
    pub(super) max_growth: Option<f64>,
    pub(super) first_growth: Option<f64>,
    pub(super) min_reduction: Option<f64>,
    pub(super) kept: Option<(f64, f64)>,
    pub(super) after_error_failure: Option<f64>,
    pub(super) after_convergence_failure: Option<f64>,
}

impl StepControl {
    /// All defaults.
    pub fn new() -> Self {
        Self::default()
    }

    /// Largest ratio after a step (`CVodeSetEtaMax` and `CVodeSetEtaMaxEarlyStep`, `IDASetEtaMax`, `ARKStepSetMaxGrowth`). Default: 10 in CVODE, 2
    /// in IDA (which doubles its steps in any case until one fails or the order falls), 20 in ARKODE.
    pub fn max_growth(mut self, ratio: f64) -> Self {
        self.max_growth = Some(ratio);
        self
    }

    /// Largest ratio after the first step, which may be far too short (`CVodeSetEtaMaxFirstStep`,
    /// `ARKStepSetMaxFirstGrowth`); IDA has none. Default: 10,000.
    pub fn first_growth(mut self, ratio: f64) -> Self {
        self.first_growth = Some(ratio);
        self
    }

    /// Smallest ratio after a step that was accepted (`CVodeSetEtaMin`, `IDASetEtaMin`, `ARKStepSetMinReduction`).
    /// Default: 0.1, in IDA 0.5.
    pub fn min_reduction(mut self, ratio: f64) -> Self {
        self.min_reduction = Some(ratio);
        self
    }

    /// Ratios between these two leave the step size as it is, which spares Newton matrices
    /// (`CVodeSetEtaFixedStepBounds`, `IDASetEtaFixedStepBounds`, `ARKStepSetFixedStepBounds`). Default: 0 and 1.5 in
    /// CVODE, 1 and 2 in IDA, 1 and 1.5 in ARKODE.
    pub fn keep_between(mut self, low: f64, high: f64) -> Self {
        self.kept = Some((low, high));
        self
    }

    /// Smallest ratio after a failed error test in CVODE and IDA (`CVodeSetEtaMinErrFail`, `IDASetEtaMinErrFail`;
    /// default: 0.1 and 0.25), largest one after repeated failures in ARKODE (`ARKStepSetMaxEFailGrowth`; default:
    /// 0.3).
    pub fn after_error_failure(mut self, ratio: f64) -> Self {
        self.after_error_failure = Some(ratio);
        self
    }

    /// Ratio after an iteration that did not converge (`CVodeSetEtaConvFail`, `IDASetEtaConvFail`,
    /// `ARKStepSetMaxCFailGrowth`). Default: 0.25.
    pub fn after_convergence_failure(mut self, ratio: f64) -> Self {
        self.after_convergence_failure = Some(ratio);
        self
    }

    /// Refuses ratios that C would replace by its defaults.
    pub(super) fn check(&self) -> Result<(), InputError> {
        let growths = [("max_growth", self.max_growth), ("first_growth", self.first_growth)];
        let reductions = [
            ("min_reduction", self.min_reduction),
            ("after_error_failure", self.after_error_failure),
            ("after_convergence_failure", self.after_convergence_failure),
        ];
        for (input, ratio) in growths {
            if let Some(ratio) = ratio.filter(|ratio| !(*ratio > 1.0 && ratio.is_finite())) {
                return Err(InputError::new(input, ratio, "it is above 1, such as 10"));
            }
        }
        for (input, ratio) in reductions {
            if let Some(ratio) = ratio.filter(|ratio| !(*ratio > 0.0 && *ratio < 1.0)) {
                return Err(InputError::new(input, ratio, "it lies between 0 and 1, such as 0.2"));
            }
        }
        match self.kept {
            Some((low, high)) if !((0.0..1.0).contains(&low) && high > 1.0 && high.is_finite()) => {
                let help = "the first is at least 0 and below 1, the second above 1";
                Err(InputError::new("keep_between", format!("({low}, {high})"), help))
            }
            _ => Ok(()),
        }
    }
}
