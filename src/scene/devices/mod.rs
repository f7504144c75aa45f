//! The devices of this crate, each in one file: what [`Device`](crate::Device) asks for, by the means that any other crate has; beside
//! these, a dipole sees the magnets of its scene, and has keys of its own in phases of scene files.

mod dipole;
mod joint;
mod wind;

pub use dipole::Dipole;
pub use joint::{Joint, JointKind};
pub use wind::Wind;
