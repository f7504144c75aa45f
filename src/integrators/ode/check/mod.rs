//! Checks of supplied derivatives against central differences, without a solver: for tests of equations.
//!
//! Each function compares at one point, which should be a general one, not zero. Differences are taken with
//! two step sizes, whose results show how accurate they are.
//!
//! ```
//! use pliant::ode::{check, with_jacobian};
//!
//! let mut wrong = with_jacobian(
//!     |_t, y, ydot| {
//!         ydot[0] = y[0] * y[1];
//!         ydot[1] = -y[1];
//!         Ok(())
//!     },
//!     |_t, y, _ydot, mut jacobian| {
//!         jacobian[(0, 0)] = y[1];
//!         jacobian[(0, 1)] = -y[0];
//!         jacobian[(1, 1)] = -1.0;
//!         Ok(())
//!     },
//! );
//! let error = check::jacobian(&mut wrong, 0.0, &[2.0, 3.0], check::Storage::Dense).unwrap_err();
//! assert!(error.to_string().starts_with("dense_jacobian: entry (0, 1) is -2.0"));
//! ```

mod dae;
mod differences;
mod functional;
mod ode;

pub use super::storage::Storage;
pub use dae::{adjoint_residual, dae_adjoint_parameters, dae_jacobian, sensitivity_residual};
pub use differences::CheckError;
pub use functional::functional;
pub use ode::{adjoint_parameters, adjoint_rhs, jacobian, sensitivity_rhs};
