//! Explicit central differences, in the form of velocity Verlet, with displacements u, velocities v
//! and forces f:
//!
//! ```text
//! w       = v_n + (h/2) M^-1 f_n
//! u_(n+1) = u_n + h w
//! f_(n+1) = f(t_(n+1), u_(n+1), 2 w - v_n)
//! v_(n+1) = w + (h/2) M^-1 f_(n+1)
//! ```
//!
//! One evaluation of the forces per step, order 2. Without damping the method is symplectic: a modified
//! energy is conserved, and the energy itself does not drift (T. Belytschko et al., *Nonlinear Finite
//! Elements for Continua and Structures*, chapter 6; E. Hairer, C. Lubich, G. Wanner, Acta Numerica 12 (2003)
//! 399-450). It is fastest with lumped inertia, where M^-1 is a division.
//!
//! ```
//! use pliant::central_difference::{CentralDifference, Integrator, Options};
//! use pliant::ode::{Failure, Kick, Rates, SecondOrder};
//!
//! /// Masses of 1 kg in a row, with springs of stiffness `k` (N/m) between neighbours and to both walls.
//! struct Chain {
//!     k: f64,
//! }
//!
//! impl SecondOrder for Chain {
//!     fn forces(&mut self, _t: f64, u: &[f64], _v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
//!         for i in 0..u.len() {
//!             let left = if i == 0 { 0.0 } else { u[i - 1] };
//!             let right = u.get(i + 1).copied().unwrap_or(0.0);
//!             f[i] = self.k * (left - 2.0 * u[i] + right);
//!         }
//!         Ok(())
//!     }
//!
//!     fn accelerations(&mut self, kick: &Kick<'_>, a: &mut [f64]) {
//!         a.copy_from_slice(kick.force); // masses of 1 kg
//!     }
//!
//!     fn rates(&mut self, _t: f64, _u: &[f64], _v: &[f64]) -> Rates {
//!         Rates { frequency: 2.0 * self.k.sqrt(), decay: 0.0 }
//!     }
//! }
//!
//! // the slowest vibration of 9 masses, of frequency 2 sqrt(k) sin(pi/20), at rest at its largest
//! let k = 100.0_f64;
//! let shape: Vec<f64> = (1..=9).map(|i| (std::f64::consts::PI * f64::from(i) / 10.0).sin()).collect();
//! let start = [shape.as_slice(), &[0.0; 9]].concat();
//! let options = Options::new(1e-6, 1e-6);
//! let mut solver = CentralDifference::new(Chain { k }, 0.0, &start, &options)?;
//! solver.solve_to(1.0)?;
//! let omega = 2.0 * k.sqrt() * (std::f64::consts::PI / 20.0).sin();
//! assert!((solver.y()[4] - omega.cos()).abs() < 1e-4);
//! # Ok::<(), pliant::central_difference::Error>(())
//! ```
//!
//! **Damping.** Viscous forces are evaluated with the velocity 2 w - v_n = v_n + h v_n', extrapolated to the
//! end of the step. Taking w instead, as is often done, allows twice the step where damping dominates, but
//! makes the method first order.
//!
//! **Stability.** For a vibration of frequency omega and damping rate r (u'' + r u' + omega^2 u = 0) the
//! growth factors s solve
//!
//! ```text
//! s (s - 1)^2 + (h r/2) (3 s - 1) (s - 1) + (h omega)^2 s^2 = 0,
//! ```
//!
//! and none exceeds 1 in size as long as (h omega)^2 + 4 h r <= 4, so up to
//!
//! ```text
//! h = 2 / (r + sqrt(r^2 + omega^2)).
//! ```
//!
//! With the largest omega and the largest r of a whole body, each taken by itself, this is a bound for the
//! body.
//!
//! **Constraints** g(u) = 0 that are not linear are met at the end of each step, by positions and velocities, as
//! multipliers along their gradients act in both halves of it (RATTLE: H. C. Andersen, J. Comput. Phys. 52 (1983)
//! 24-34). The method stays symmetric and symplectic (E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical
//! Integration*, section VII.1.4).
//!
//! **Energies.** The kinetic energy changes in one step by h w . (f_n + f_(n+1))/2, up to a bounded
//! remainder. So the trapezoidal rule for the powers of damping and applied forces gives the work that these
//! forces do in the scheme. The work of the constraint forces is summed up in the kicks.

mod control;
mod solver;
mod stability;
mod trial;

pub use solver::CentralDifference;
pub use stability::longest_step;

pub use crate::integrators::common::{
    Error, ExplicitOptions as Options, Integrator, Reached, Statistics,
};
