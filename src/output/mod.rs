//! What is left of a run on disk: tables, pictures and charts, and files for ParaView.
//!
//! | file | for | written by |
//! | --- | --- | --- |
//! | CSV | tables of centre of mass, momentum, energies, tracked nodes | [`write_csv`] |
//! | CSV | tables of all energies and their balance | [`write_energies`] |
//! | JSON | how a result was obtained: method, steps, errors, versions | [`write_report`] |
//! | SVG | the deformed body at chosen times, panel by panel | [`Snapshots`] |
//! | SVG | quantities over time | [`Chart`] |
//! | HTML | the motion, to be played by a web browser | [`write_animation`] |
//! | VTK | ParaView and other viewers of meshes: motion, forces, strain and stress | [`write_vtk`] |
//!
//! Directories are created as needed. A file is written under another name first and renamed when
//! it is complete: what stands under its own name is never half a file.

mod animation;
mod chart;
mod csv;
mod decades;
#[cfg(feature = "study")]
mod png;
mod report;
mod role;
mod svg;
mod vtk;

#[cfg(feature = "play")]
pub(crate) use self::animation::Picture;
pub use self::animation::write_animation;
pub use self::chart::Chart;
pub use self::csv::{GrowingTable, write_csv, write_energies};
#[cfg(feature = "study")]
pub(crate) use self::decades::{power_text, ticks};
#[cfg(feature = "study")]
pub(crate) use self::png::png;
pub use self::report::{write_report, write_static_report};
pub use self::svg::Snapshots;
pub use self::vtk::write_vtk;
pub(crate) use crate::file::write_file;

/// Font of all pictures: what a reader's machine has of these, in this order.
pub(crate) const FONT: &str = "Helvetica Neue, Helvetica, Arial, sans-serif";
/// Colour of titles and labels.
pub(crate) const INK: &str = "#222222";
