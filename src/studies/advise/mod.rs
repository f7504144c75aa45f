//! Recommended model of a scene: the adviser.

mod advice;
mod adviser;
mod answer;
mod chart;
mod choice;
mod found;
mod half;
mod ladder;
mod page;
mod parts;
mod plane;
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
