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

use std::fs::{self, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

#[cfg(feature = "play")]
pub(crate) use self::animation::Picture;
pub use self::animation::write_animation;
pub use self::chart::Chart;
pub use self::csv::{write_csv, write_energies};
#[cfg(feature = "study")]
pub(crate) use self::decades::{power_text, ticks};
#[cfg(feature = "study")]
pub(crate) use self::png::png;
pub use self::report::{write_report, write_static_report};
pub use self::svg::Snapshots;
pub use self::vtk::write_vtk;

use crate::error::Error;

/// Font of all pictures: what a reader's machine has of these, in this order.
pub(crate) const FONT: &str = "Helvetica Neue, Helvetica, Arial, sans-serif";
/// Colour of titles and labels.
pub(crate) const INK: &str = "#222222";

/// Has `content` written to a file beside `path`, which takes its place when it is complete.
///
/// # Errors
/// [`Error::Output`] with `path`.
pub(crate) fn write_file(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Error> {
    replace(path, content).map_err(|source| Error::Output { path: path.into(), source })
}

fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(directory)?;
    // readable for all, as the user's mask allows: temporary files are private otherwise
    let mut builder = tempfile::Builder::new();
    let mut file = builder.permissions(Permissions::from_mode(0o666)).tempfile_in(directory)?;
    let mut buffer = BufWriter::new(file.as_file_mut());
    content(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    file.persist(path)?;
    Ok(())
}
