//! What all rooms use and what knows nothing of mechanics: vectors, small tensors, SIMD registers, matrices
//! over pairs of nodes, points sorted by place, few shapes of many states, weights that are not negative, formulas of time, roots of functions, the nearest rotation, the error of an input.

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
