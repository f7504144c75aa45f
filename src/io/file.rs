//! Files that are complete or not there at all.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use crate::dynamics::error::Error;

/// Writes `content` to a file next to `path`, which replaces `path` when it is complete and on the disk.
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
    // after a loss of power there is the old file or the new one, not a new one without content
    file.as_file().sync_all()?;
    file.persist(path)?;
    // the directory is synced, too, so that the new name is on the disk, where the file system supports that
    match File::open(directory)?.sync_all() {
        Err(error) if error.kind() != io::ErrorKind::InvalidInput => Err(error),
        _ => Ok(()),
    }
}
