//! Forward sensitivities: derivatives of the solution with respect to parameters, computed along with it.

mod callbacks;
mod integrals;
mod options;
mod rhs;
mod solve;

pub(super) use callbacks::{all_residuals, dae_integrands, integrands, one_rhs};
pub use options::{Sensitivities, SensitivityMethod, SensitivitySource};
pub(super) use rhs::{Access, SensitivityRhs, move_along};
pub use solve::CarriesSensitivities;
