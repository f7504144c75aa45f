//! The devices of this crate, each in one file: what [`Device`](crate::Device) asks for, by the means that any other crate has.

mod dipole;
mod wind;

pub use dipole::Dipole;
pub use wind::Wind;
