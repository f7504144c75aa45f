//! Many runs for one answer: speed against accuracy, what to choose, unknowns fitted to measurements; and
//! problems with trusted answers to try them on.

#[cfg(feature = "study")]
pub mod advise;
#[cfg(feature = "fit")]
pub mod fit;
pub mod samples;
#[cfg(feature = "study")]
pub mod work_precision;
