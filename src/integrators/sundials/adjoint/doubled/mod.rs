//! Products of Hessians with directions v of the parameters, by the adjoint of a derivative along v ("forward over
//! adjoint").
//!
//! The equations of y are integrated together with those of s = (dy/dp) v, which are derivatives of the former along a
//! line. The adjoint gradient of (dG/dp)^T v, a functional of y and s, is the product. It needs second derivatives of the
//! equations: differences along the line of their first ones.
//!
//! D. B. Ozyurt and P. I. Barton, SIAM J. Sci. Comput. 26 (2005) 1725-1743.

mod equations;
mod first;
mod functional;
mod line;
mod options;

pub(super) use equations::Doubled;
pub(super) use first::System;
pub(super) use functional::Along;
pub(super) use line::Line;
