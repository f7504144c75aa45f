//! Shared tools without mechanics: vectors, small tensors, SIMD registers, sparse matrices over pairs of nodes, spatial grids,
//! proper orthogonal decomposition, non-negative least squares, formulas of time, roots of functions, the nearest rotation, input
//! errors.

#[cfg(feature = "bodies")]
pub(crate) mod formula;
#[cfg(feature = "bodies")]
pub(crate) mod grid;
pub(crate) mod input;
pub(crate) mod lane;
#[cfg(feature = "bodies")]
pub(crate) mod nnls;
#[cfg(feature = "bodies")]
pub(crate) mod pod;
pub(crate) mod root;
#[cfg(feature = "bodies")]
pub(crate) mod rotation;
pub(crate) mod simd;
#[cfg(feature = "bodies")]
pub mod sparse;
pub(crate) mod tensor;
pub(crate) mod vector;
