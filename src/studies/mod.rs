//! Many runs for one answer: speed against accuracy, recommended models, unknowns fitted to measurements, a scene for
//! many values of its keys, derivatives by the numbers of a scene, and the best of these; and problems with trusted answers for tests.

#[cfg(feature = "study")]
pub mod advise;
#[cfg(feature = "fit")]
pub mod fit;
#[cfg(feature = "gradient")]
pub mod gradient;
#[cfg(feature = "gradient")]
pub mod optimize;
#[cfg(feature = "bodies")]
pub mod reduce;
pub mod samples;
#[cfg(feature = "sweep")]
pub mod sweep;
#[cfg(feature = "study")]
pub mod work_precision;
