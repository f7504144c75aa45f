//! Systems of equations for integrators: ordinary differential equations (ODE), differential-algebraic
//! equations (DAE), and equations of [second order](SecondOrder).
//!
//! The same traits serve [`crate::integrators::sundials`] and the internal methods `rk` and `rosenbrock`. Any
//! closure `FnMut(t, y, ydot) -> Result<(), Failure>` is an [`Ode`]; [`with_jacobian`] and
//! [`with_sparse_jacobian`] bundle it with a second closure for the Jacobian, [`with_parameters`] with
//! parameters, [`with_mass`] with a mass matrix, [`split`] with a part that is not stiff; a struct implements
//! the trait to supply root functions or its own linear solver. An integrator owns its system; [`Borrowed`]
//! lends it one instead. [`check`] compares supplied derivatives with differences.

mod band;
mod borrowed;
pub(crate) mod call;
pub mod check;
mod closures;
mod dae;
pub(crate) mod delegate;
mod entries;
mod failure;
mod first_order;
mod functional;
mod mass;
mod second_order;
mod split;
mod storage;
mod with_mass;

pub use band::BandMut;
pub use borrowed::{Borrowed, Boxed};
pub use closures::{
    WithJacobian, WithParameters, WithSparseJacobian, dae_with_parameters, with_jacobian,
    with_parameters, with_sparse_jacobian,
};
pub use dae::Dae;
pub(crate) use entries::Entries;
pub use failure::Failure;
pub use first_order::Ode;
pub use functional::{Functional, Slopes};
pub use mass::MassKind;
pub use second_order::{EnergyBalance, Kick, Rates, SecondOrder};
pub use split::{Split, split};
pub use storage::Storage;
pub use with_mass::{MassMatrix, WithMass, with_mass};
