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
//! One evaluation of the forces per step, order 2. Without damping the method is symplectic: a
//! modified energy is conserved, and the energy proper does not drift (T. Belytschko et al.,
//! *Nonlinear Finite Elements for Continua and Structures*, chapter 6; E. Hairer, C. Lubich, G. Wanner,
//! Acta Numerica 12 (2003) 399-450). It pays with lumped inertia, where M^-1 is no work.
//!
//! **Damping.** Viscous forces see the velocity 2 w - v_n = v_n + h v_n', extrapolated to the end of
//! the step. Taking w instead, as is often done, allows twice the step where damping rules, but makes the
//! method first order.
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
//! The largest omega and the largest r, each by itself, make that a bound for a whole body.
//!
//! **Energies.** The kinetic energy changes in one step by h w . (f_n + f_(n+1))/2, but for a bounded
//! remainder. So the trapezoidal rule for the powers of damping and applied forces is the work that
//! these forces do in the scheme. That of the constraint forces is what the kicks book.

mod control;
mod solver;
mod stability;
mod trial;

pub(crate) use solver::CentralDifference;
pub(crate) use stability::longest_step;

/// Order of the method.
pub(crate) const ORDER: u32 = 2;

/// What has been done so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Statistics {
    pub(crate) steps: usize,
    pub(crate) evaluations: usize,
    pub(crate) rejected_steps: usize,
    pub(crate) refused_steps: usize,
    pub(crate) last_step: f64,
}
