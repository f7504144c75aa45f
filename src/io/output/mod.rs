//! Results of a run on disk: tables, pictures and charts, and files for ParaView.
//!
//! | file | for | written by |
//! | --- | --- | --- |
//! | CSV | tables of centre of mass, momentum, energies, tracked nodes, sensors, reactions | [`write_csv`] |
//! | CSV | tables of all energies and their balance | [`write_energies`] |
//! | JSON | report of a result: method, steps, errors, versions | [`write_report`] |
//! | SVG | the deformed body at chosen times, panel by panel | [`Snapshots`] |
//! | SVG, PNG | sensors and energies over time, of a motion or of a table that a run has left | [`Plot`] |
//! | SVG, PNG | any series over each other | [`Chart`] |
//! | HTML | the motion, or several side by side, to be played by a web browser | [`write_animation`], [`write_animations`], [`join_animations`] |
//! | VTK | ParaView and other viewers of meshes: motion, forces, strain and stress | [`write_vtk`] |
//!
//! Directories are created as needed. A file is written under another name first and renamed when it is
//! complete: a file under its own name is always complete.

mod acting;
mod animation;
mod chart;
mod columns;
mod csv;
mod figure;
mod plot;
#[cfg(feature = "png")]
mod png;
mod reference;
mod report;
mod role;
mod svg;
mod vtk;

#[cfg(feature = "sweep")]
pub(crate) use self::animation::BASE_STYLE;
#[cfg(feature = "play")]
pub(crate) use self::animation::Picture;
#[cfg(feature = "study")]
pub(crate) use self::animation::{Above, escaped, write_below};
pub use self::animation::{join_animations, write_animation, write_animations};
pub use self::chart::Chart;
#[cfg(feature = "study")]
pub(crate) use self::columns::{DIFFERENCE, OF_SENSOR};
pub use self::csv::{GrowingTable, write_csv, write_energies};
#[cfg(feature = "sweep")]
pub(crate) use self::figure::shade;
#[cfg(feature = "study")]
pub(crate) use self::figure::{Axis, Figure, Mark, Note, Panel, Series, Theme, power_text};
pub use self::plot::{Plot, Table};
pub use self::reference::reference;
#[cfg(feature = "study")]
pub(crate) use self::report::OfIndicator;
pub use self::report::{report, static_report, write_report, write_static_report};
pub use self::svg::Snapshots;
pub use self::vtk::write_vtk;
pub(crate) use crate::io::file::write_file;

/// Font of all pictures: the first of these that the reader's machine has.
pub(crate) const FONT: &str = "Helvetica Neue, Helvetica, Arial, sans-serif";
/// Colour of titles and labels.
pub(crate) const INK: &str = "#222222";
/// Colours that stay apart for colour-blind eyes (Okabe and Ito).
pub(crate) const COLOURS: [&str; 8] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#222222", "#999999"];
/// Strokes that tell lines of one colour apart.
pub(crate) const DASHES: [&str; 4] = ["none", "7 4", "2 3", "9 3 2 3"];
