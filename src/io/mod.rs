//! Files: scenes, states and reduced models that are read, checkpoints, and results of a motion.

#[cfg(feature = "checkpoint")]
pub(crate) mod checkpoint_file;
#[cfg(any(feature = "checkpoint", feature = "output"))]
pub(crate) mod file;
#[cfg(feature = "output")]
pub mod output;
#[cfg(feature = "checkpoint")]
pub(crate) mod reduced_file;
#[cfg(feature = "scene-file")]
pub mod scene_file;
#[cfg(feature = "checkpoint")]
pub(crate) mod state_file;
