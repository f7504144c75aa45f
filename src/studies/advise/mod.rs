//! Recommended model of a scene: the adviser.
//!
//! The search begins with a first look. A `Choice` is a model of a scene with its settings; its application to
//! a scene and the equivalent `--set` options are side by side, and a test compares them bit for
//! bit. Each run is a line of `runs.jsonl`, by a hash of scene and choice, so that a search continues where
//! another was ended. Motions on which two runs at 1e-11 and 1e-12 do not agree are cut at nine tenths of the
//! time until which they do. The promises are tested against independent runs in `docs/advice.md`.

mod advice;
mod adviser;
mod answer;
mod chart;
mod choice;
mod evidence;
mod ladder;
mod page;
mod parts;
mod record;
mod reduced;
mod reduced_candidate;
mod rigid;
mod runs;
mod search;
mod smaller_model;
mod smaller_run;

pub use advice::{Advice, Candidate};
pub use adviser::Adviser;
pub use choice::{Choice, RicherCells};
pub use parts::Parts;
pub use reduced_candidate::ReducedCandidate;
pub use smaller_model::SmallerModel;

pub use crate::scene::timeline::Smaller;
