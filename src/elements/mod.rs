//! Bodies as finite elements: a mesh and a material become inertia M, stiffness K, damping B and nonlinear
//! forces.
//!
//! [`mesh`] has nodes and cells, `basis` the shape functions and quadrature of one cell, [`material`] the
//! laws at one point, `rod` the elements of rods, [`body`] the loops over cells, and [`force`](mod@force) the trait of all that exerts
//! forces.

pub(crate) mod basis;
pub mod body;
pub mod force;
pub mod material;
pub mod mesh;
pub(crate) mod rod;
