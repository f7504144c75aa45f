//! Options of adjoint gradients.

use crate::base::{input::InputError, vector::size_or_one};
use crate::integrators::common::{AbsoluteTolerance, Tolerances, check_count};

/// Options of the backward run of an [`Adjoint`](super::Adjoint) or a [`DaeAdjoint`](super::DaeAdjoint).
#[derive(Clone, Debug)]
#[must_use]
pub struct AdjointOptions {
    pub(super) tolerances: Tolerances,
    pub(super) gradient_tolerances: Option<Tolerances>,
    pub(super) checkpoint_steps: u32,
    pub(super) supplied_rhs: bool,
    pub(super) supplied_parameters: bool,
}

impl AdjointOptions {
    /// With these tolerances for the adjoint lambda, which is dG/dy(t) for an ODE.
    ///
    /// Its linear solver is that of the forward run, for the transposed matrix. A Krylov method needs
    /// [`supplied_rhs`](Self::supplied_rhs), whose products are those of the transposed matrix.
    pub fn new(rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        Self {
            tolerances: Tolerances::new(rtol, atol),
            gradient_tolerances: None,
            checkpoint_steps: 150,
            supplied_rhs: false,
            supplied_parameters: false,
        }
    }

    /// Tolerances of dG/dp, whose errors also control the step size of the backward run
    /// (`CVodeQuadSVtolerancesB`, `IDAQuadSVtolerancesB`).
    ///
    /// Default: `rtol` of lambda, and its smallest `atol` divided by the size of the parameter, or by 1 for
    /// one that is zero.
    pub fn gradient_tolerances(mut self, rtol: f64, atol: impl Into<AbsoluteTolerance>) -> Self {
        self.gradient_tolerances = Some(Tolerances::new(rtol, atol));
        self
    }

    /// Steps between two checkpoints (`CVodeAdjInit`, `IDAAdjInit`). Default: 150.
    ///
    /// The states between two checkpoints are computed again, and those of so many steps are kept at once.
    pub fn checkpoint_steps(mut self, steps: u32) -> Self {
        self.checkpoint_steps = steps;
        self
    }

    /// Takes (df/dy)^T lambda from [`Ode::adjoint_rhs`](crate::integrators::ode::Ode::adjoint_rhs), or
    /// (dF/dy)^T lambda + (dF/dy')^T lambda' from [`Dae::adjoint_residual`](crate::integrators::ode::Dae::adjoint_residual).
    ///
    /// Default: from the Jacobian, supplied or by difference quotients as for the linear solver of the
    /// forward run.
    pub fn supplied_rhs(mut self) -> Self {
        self.supplied_rhs = true;
        self
    }

    /// Takes (df/dp)^T lambda from [`Ode::adjoint_parameters`](crate::integrators::ode::Ode::adjoint_parameters), or
    /// (dF/dp)^T lambda from [`Dae::adjoint_parameters`](crate::integrators::ode::Dae::adjoint_parameters).
    ///
    /// Default: by central differences, two evaluations for each parameter.
    pub fn supplied_parameters(mut self) -> Self {
        self.supplied_parameters = true;
        self
    }

    /// Checks them for `n` unknowns and so many parameters.
    pub(super) fn check(&self, n: usize, parameters: usize) -> Result<(), InputError> {
        check_count("checkpoint_steps", self.checkpoint_steps)?;
        self.tolerances.check(&vec![0.0; n])?;
        if let Some(tolerances) = &self.gradient_tolerances {
            if parameters == 0 {
                let help = "the system has no parameters";
                return Err(InputError::new("gradient_tolerances", "given", help));
            }
            tolerances.check(&vec![0.0; parameters])?;
        }
        Ok(())
    }

    /// The tolerances of dG/dp, for these parameters.
    pub(super) fn tolerances_for(&self, parameters: &[f64]) -> Tolerances {
        if let Some(tolerances) = &self.gradient_tolerances {
            return tolerances.clone();
        }
        let (rtol, least) = (self.tolerances.rtol, self.tolerances.least_atol());
        Tolerances::new(
            rtol,
            parameters.iter().map(|p| least / size_or_one(*p)).collect::<Vec<_>>(),
        )
    }
}
