//! What model is enough for a scene: the adviser.

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
mod record;
mod reduced;
mod reduced_candidate;
mod rigid;
mod runs;
mod search;
mod smaller_model;

pub use advice::{Advice, Candidate};
pub use adviser::Adviser;
pub use choice::{Choice, RicherCells};
pub use parts::Parts;
pub use reduced_candidate::ReducedCandidate;
pub use smaller_model::{Smaller, SmallerModel};
