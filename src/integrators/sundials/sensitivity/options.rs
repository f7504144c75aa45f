//! Selection of sensitivities, and options of their computation.

use crate::base::{input::InputError, vector::size_or_one};
use crate::integrators::common::check_finite;

/// Coupling of the equations of the sensitivities with those of the state in their solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SensitivityMethod {
    /// All of one step at once (`CV_SIMULTANEOUS`).
    Simultaneous,
    /// First the state, then all sensitivities (`CV_STAGGERED`).
    Staggered,
    /// First the state, then one sensitivity after the other (`CV_STAGGERED1`); CVODE alone.
    StaggeredOneByOne,
}

/// Source of the right-hand sides or residuals of the sensitivities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SensitivitySource {
    /// The system's own `sensitivity_rhs` or `sensitivity_residual`.
    Supplied,
    /// Central differences along (s, dp): two evaluations of the equations each. Rounding errors of some
    /// 1e-12 in them limit the tolerances that can be met.
    CentralDifferences,
    /// Forward differences along (s, dp): one evaluation each, half the digits.
    ForwardDifferences,
}

/// The sensitivities s = dy/dp of a solution to some parameters p of the system.
///
/// Error control keeps the errors of `pbar s`, with the scale pbar of the parameter, within the tolerances of
/// y.
///
/// ```
/// use pliant::{
///     ode::with_parameters,
///     sundials::{Cvode, CvodeOptions, Integrator, Sensitivities},
/// };
///
/// // y' = -p y, y(0) = 1: dy/dp = -t e^(-p t)
/// let decay = with_parameters(
///     |_t, y, p, ydot| {
///         ydot[0] = -p[0] * y[0];
///         Ok(())
///     },
///     [2.0],
/// );
/// let options = CvodeOptions::new(1e-8, 1e-10).sensitivities(Sensitivities::of([0]).staggered());
/// let mut solver = Cvode::new(decay, 0.0, &[1.0], &options)?;
/// solver.solve_to(1.0)?;
/// assert!((solver.sensitivities()[(0, 0)] + (-2f64).exp()).abs() < 1e-6);
/// # Ok::<(), pliant::sundials::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Sensitivities {
    pub(super) parameters: Vec<usize>,
    pub(super) method: SensitivityMethod,
    pub(super) source: SensitivitySource,
    pub(super) scales: Option<Vec<f64>>,
    pub(super) error_control: bool,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) integrals: bool,
}

impl Sensitivities {
    /// Sensitivities to the parameters at these places among `parameters()` of the system; simultaneous, by
    /// central differences, with error control.
    pub fn of(parameters: impl Into<Vec<usize>>) -> Self {
        Self {
            parameters: parameters.into(),
            method: SensitivityMethod::Simultaneous,
            source: SensitivitySource::CentralDifferences,
            scales: None,
            error_control: true,
            integrals: false,
        }
    }

    /// Method of their solution. Default: simultaneous.
    pub fn method(mut self, method: SensitivityMethod) -> Self {
        self.method = method;
        self
    }

    /// [`SensitivityMethod::Staggered`].
    pub fn staggered(self) -> Self {
        self.method(SensitivityMethod::Staggered)
    }

    /// Source of their equations. Default: central differences.
    pub fn source(mut self, source: SensitivitySource) -> Self {
        self.source = source;
        self
    }

    /// The order of magnitude of each parameter, pbar, for tolerances and increments (`CVodeSetSensParams`).
    /// Default: its size at the start, or 1 for a parameter that is zero.
    pub fn scales(mut self, scales: impl Into<Vec<f64>>) -> Self {
        self.scales = Some(scales.into());
        self
    }

    /// Whether errors of the sensitivities also control the step size (`CVodeSetSensErrCon`). Default: yes.
    pub fn error_control(mut self, on: bool) -> Self {
        self.error_control = on;
        self
    }

    /// Also those of the integrals [`quadratures`](crate::integrators::ode::Ode::quadratures), dq/dp
    /// (`CVodeQuadSensInit`, `IDAQuadSensInit`). Default: not.
    ///
    /// The derivatives of their integrands are differences along (s, dp), two evaluations each at every step, or one with
    /// [`ForwardDifferences`](SensitivitySource::ForwardDifferences). Their errors control the step size where those of the
    /// sensitivities and of the [integrals](super::super::CvodeOptions::quadrature_error_control) do.
    pub fn integrals(mut self) -> Self {
        self.integrals = true;
        self
    }

    /// Whether those of the integrals are wanted.
    pub(crate) fn has_integrals(&self) -> bool {
        self.integrals
    }

    /// Places of the parameters.
    pub(crate) fn parameters(&self) -> &[usize] {
        &self.parameters
    }

    /// Initial derivatives of `count` parameters by each of these: unit vectors.
    pub(crate) fn directions(&self, count: usize) -> Vec<f64> {
        let column = |&place: &usize| (0..count).map(move |k| if k == place { 1.0 } else { 0.0 });
        self.parameters.iter().flat_map(column).collect()
    }

    /// Rejects methods that IDAS does not have.
    pub(in crate::integrators::sundials) fn check_for_dae(&self) -> Result<(), InputError> {
        if self.method == SensitivityMethod::StaggeredOneByOne {
            let help = "IDA has Simultaneous and Staggered";
            return Err(InputError::new("method of sensitivities", "StaggeredOneByOne", help));
        }
        Ok(())
    }

    /// The scales, for a system with these parameters.
    pub(super) fn check(&self, parameters: &[f64]) -> Result<Vec<f64>, InputError> {
        if self.parameters.is_empty() {
            let help = "name at least one, or leave the option out";
            return Err(InputError::new("parameters of sensitivities", "none", help));
        }
        let count = parameters.len();
        if let Some(place) = self.parameters.iter().find(|&&place| place >= count) {
            let help = format!("the system has {count} parameters, counted from 0");
            return Err(InputError::new("parameter of sensitivities", place, help));
        }
        check_finite("parameters", parameters)?;
        let Some(scales) = &self.scales else {
            let scale = |&place: &usize| size_or_one(parameters[place]);
            return Ok(self.parameters.iter().map(scale).collect());
        };
        if scales.len() != self.parameters.len() {
            let help = format!("give one for each of the {} parameters", self.parameters.len());
            return Err(InputError::new("length of scales", scales.len(), help));
        }
        match scales.iter().find(|&&scale| !(scale > 0.0 && scale.is_finite())) {
            Some(scale) => Err(InputError::new("scale", scale, "it is positive and finite")),
            None => Ok(scales.clone()),
        }
    }
}
