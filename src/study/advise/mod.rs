//! What model is enough for a scene: the adviser.

mod advice;
mod adviser;
mod answer;
mod choice;
mod ladder;
mod record;
mod search;

pub use advice::{Advice, Candidate};
pub use adviser::Adviser;
pub use choice::Choice;
